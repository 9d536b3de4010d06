// RUN: %run_c %s %t --turns -O0,-O2 --cflags "-mstack=global" --simflags "--config 1x32"
// Objects that threads share and that each has of its own: when they begin and end. (Expected output by hand.)
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <trax.h>

static std::atomic<int> made, owned_made, owned_ended, arrived, registered;

struct Shared {
  int value;
  explicit Shared(int value) : value(value) {
    for (volatile int i = 0; i < 300; i = i + 1) // others arrive meanwhile
      ;
    made++;
  }
  ~Shared() {
    std::printf("~Shared: made %d, owned %d, ended %d\n", made.load(), owned_made.load(), owned_ended.load());
  }
};

struct Own {
  unsigned thread = trax_thread();
  int uses = 0;
  Own() { owned_made++; }
  ~Own() {
    if (uses == 3 && thread == trax_thread())
      owned_ended++;
  }
};

static Shared &shared() {
  static Shared object(41);
  return object;
}
static thread_local Own own;
static thread_local int own_initialised = 5;

static void at_end() {
  std::puts("atexit");
}

int main() {
  if (trax_thread() == trax_threads() / 2) {
    std::atexit(at_end);
    registered++;
  }
  while (registered.load() == 0)
    ;
  bool right = shared().value == 41;
  for (int i = 0; i < 3; i++)
    own.uses++;
  own_initialised += static_cast<int>(trax_thread());
  right &= own.thread == trax_thread() && own_initialised == 5 + static_cast<int>(trax_thread()) && made.load() == 1;
  arrived++;
  while (arrived.load() < static_cast<int>(trax_threads()))
    ;
  if (trax_thread() % 2)
    std::exit(!right);
  return !right;
}
