// Mutual exclusion between the machine's threads in libc++'s terms. A waiting thread polls.
#include "../internal/machine.h"

#include <__chrono/steady_clock.h>
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <ratio>
#include <system_error>
#include <type_traits>

#include <time.h>

_LIBCPP_BEGIN_NAMESPACE_STD

namespace {

ticket_lock *guard_of(__libcpp_mutex_t &mutex) {
  return reinterpret_cast<ticket_lock *>(&mutex.__next);
}
static_assert(sizeof(ticket_lock) == offsetof(__libcpp_mutex_t, __taken));

bool try_take(__libcpp_mutex_t &mutex) {
  if (load_shared(&mutex.__taken))
    return false;
  ticket_lock *guard = guard_of(mutex);
  enter(guard);
  const bool was_free = load_shared(&mutex.__taken) == 0;
  if (was_free)
    store_shared(&mutex.__taken, 1);
  ::unlock(guard);
  if (was_free)
    acquire_fence();
  return was_free;
}

void take(__libcpp_mutex_t &mutex) {
  while (!try_take(mutex))
    ;
}

void give(__libcpp_mutex_t &mutex) {
  release_fence();
  store_shared(&mutex.__taken, 0);
}

bool try_take(__libcpp_recursive_mutex_t &mutex) {
  const unsigned self = trax_thread() + 1;
  if (load_shared(&mutex.__owner) != self) {
    if (!try_take(mutex.__mutex))
      return false;
    store_shared(&mutex.__owner, self);
  }
  mutex.__depth++;
  return true;
}

} // namespace

void mutex::lock() {
  take(__m_);
}
bool mutex::try_lock() noexcept {
  return try_take(__m_);
}
void mutex::unlock() noexcept {
  give(__m_);
}

recursive_mutex::recursive_mutex() : __m_{} {}
recursive_mutex::~recursive_mutex() = default;
void recursive_mutex::lock() {
  while (!try_take(__m_))
    ;
}
bool recursive_mutex::try_lock() noexcept {
  return try_take(__m_);
}
void recursive_mutex::unlock() noexcept {
  if (--__m_.__depth)
    return;
  store_shared(&__m_.__owner, 0);
  give(__m_.__mutex);
}

void condition_variable::wait(unique_lock<mutex> &lock) noexcept {
  unsigned *notified = &__cv_.__notified;
  const unsigned before = load_shared(notified);
  lock.unlock();
  while (load_shared(notified) == before)
    ;
  lock.lock();
}
void condition_variable::notify_one() noexcept {
  trax_atomic_inc(&__cv_.__notified); // all waiting threads see it and try again
}
void condition_variable::notify_all() noexcept {
  trax_atomic_inc(&__cv_.__notified);
}

void __call_once(volatile once_flag::_State_type &state, void *argument, void (*function)(void *)) {
  static ticket_lock guard;
  auto *word = reinterpret_cast<unsigned *>(const_cast<once_flag::_State_type *>(&state));
  static_assert(sizeof(once_flag::_State_type) == sizeof *word);
  enter(&guard);
  const bool first = load_shared(word) == once_flag::_Unset;
  if (first)
    store_shared(word, once_flag::_Pending);
  ::unlock(&guard);
  if (first) {
    function(argument);
    release_fence();
    store_shared(word, once_flag::_Complete);
  }
  while (load_shared(word) != once_flag::_Complete)
    ;
  acquire_fence();
}

// std::atomic's wait and notify: the headers poll.
void __cxx_atomic_notify_one(void const volatile *) noexcept {}
void __cxx_atomic_notify_all(void const volatile *) noexcept {}
void __cxx_atomic_notify_one(__cxx_atomic_contention_t const volatile *) noexcept {}
void __cxx_atomic_notify_all(__cxx_atomic_contention_t const volatile *) noexcept {}
__cxx_contention_t __libcpp_atomic_monitor(void const volatile *) noexcept {
  return 0;
}
__cxx_contention_t __libcpp_atomic_monitor(__cxx_atomic_contention_t const volatile *) noexcept {
  return 0;
}
void __libcpp_atomic_wait(void const volatile *, __cxx_contention_t) noexcept {}
void __libcpp_atomic_wait(__cxx_atomic_contention_t const volatile *, __cxx_contention_t) noexcept {}

chrono::steady_clock::time_point chrono::steady_clock::now() noexcept {
  static_assert(is_same_v<period, ratio<1, CLOCKS_PER_SEC>>);
  const clock_t now = clock();
  if (now < 0)
    machine_abort("std::chrono::steady_clock: the loader did not say what the chip's clock is");
  return time_point(duration(now));
}

void __throw_system_error(int, const char *what) {
  machine_abort(what);
}

_LIBCPP_END_NAMESPACE_STD
