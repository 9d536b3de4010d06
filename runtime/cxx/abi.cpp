// Functions that compiled C++ calls (Itanium C++ ABI, sections 3.2.6 and 3.3.3): for the initialisation of
// function-local statics, and for calls of pure virtual and deleted functions.
#include "../internal/machine.h"

// A guard is two words. The first byte tells whether the object is initialised. The next three hold the number plus 1
// of the thread that initialises it. The second word counts the threads that called, by the atomic increment: the first
// one initialises.
namespace {

constexpr unsigned initialised = 1;

unsigned owned() {
  return (trax_thread() + 1) << 8;
}

} // namespace

extern "C" int __cxa_guard_acquire(unsigned *guard) {
  unsigned state = load_shared(guard);
  if (state & initialised) {
    acquire_fence();
    return 0;
  }
  if (trax_atomic_inc(&guard[1]) == 0) {
    store_shared(guard, owned());
    return 1;
  }
  while (!((state = load_shared(guard)) & initialised))
    if (state == owned())
      machine_abort("the initialisation of a function-local static object enters itself");
  acquire_fence();
  return 0;
}

extern "C" void __cxa_guard_release(unsigned *guard) {
  release_fence();
  store_shared(guard, initialised);
}

extern "C" [[noreturn]] void __cxa_pure_virtual() {
  machine_abort("call of a pure virtual function");
}

extern "C" [[noreturn]] void __cxa_deleted_virtual() {
  machine_abort("call of a deleted virtual function");
}

namespace std {
[[noreturn]] void terminate() noexcept;
[[noreturn]] void terminate() noexcept {
  machine_abort("std::terminate");
}
} // namespace std
