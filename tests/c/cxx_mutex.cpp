// RUN: %run_c %s %t --slow --cflags "-mstack=global -std=c++20" --simflags "--config 1x32"
// RUN: not %clangxx -DSTART -c %s -o %t.o 2>&1 | FileCheck %s --check-prefix=START
// START: error: {{.*}}the machine's threads are all there from the start: none can be started
// libc++'s mutexes, condition variables, call_once and shared pointers between threads. (Expected output by hand.)
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <memory>
#include <mutex>
#include <thread>
#include <trax.h>

static std::mutex mutex;
static std::recursive_mutex recursive;
static std::once_flag once;
static std::condition_variable changed;
static int counted, nested, called, tried;
static bool open;
static std::atomic<int> destroyed, ready, gone, late;
static std::shared_ptr<int> common;
static std::weak_ptr<int> weak;

struct Count {
  void operator()(int *value) const {
    destroyed++;
    delete value;
  }
};

static void nest(int depth) {
  std::lock_guard lock(recursive);
  nested++;
  if (depth)
    nest(depth - 1);
}

int main() {
#ifdef START
  std::thread([] {}).join();
#endif
  std::call_once(once, [] {
    called++;
    common = std::shared_ptr<int>(new int(5), Count());
    weak = common;
  });
  for (int i = 0; i < 5; i++) {
    std::scoped_lock lock(mutex);
    counted++;
  }
  nest(2);
  if (std::unique_lock lock(mutex, std::try_to_lock); lock)
    tried++;
  for (int i = 0; i < 5; i++) {
    std::shared_ptr<int> copy = common, other = weak.lock();
    if (*copy + *other != 10)
      late++;
  }
  ready++;
  if (trax_thread() == trax_threads() - 1) {
    while (ready.load() < static_cast<int>(trax_threads()))
      ;
    common.reset();
    std::lock_guard lock(mutex);
    open = true;
    changed.notify_all();
  } else {
    std::unique_lock lock(mutex);
    changed.wait(lock, [] { return open; });
  }
  if (weak.lock())
    late++;
  gone++;
  if (trax_thread())
    return 0;
  int seen;
  while ((seen = gone.load()) != static_cast<int>(trax_threads()))
    gone.wait(seen);
  const auto now = std::chrono::steady_clock::now().time_since_epoch().count();
  std::printf("%d %d %d %d %d %d %d\n", counted, nested, called, tried > 0, destroyed.load(), late.load(), now > 1000);
  return 0;
}
