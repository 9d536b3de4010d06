// RUN: %run_c %s %t --turns -O0,-O1 --cflags "-DPURE -fno-inline" --status 134 --fault "call of a pure virtual"
// RUN: %run_c %s %t --levels -O2 --cflags "-DMEMORY" --status 134 --fault "operator new: no memory left"
// RUN: %run_c %s %t --levels -O2 --cflags "-DSELF" \
// RUN:   --status 134 --fault "the initialisation of a function-local static object enters itself"
// RUN: %run_c %s %t --levels -O2 --cflags "-DTERMINATE" --status 134 --fault "std::terminate"
// RUN: %run_c %s %t --levels -O2 --cflags "-DEMPTY -mstack=global" \
// RUN:   --status 134 --fault "bad_optional_access was thrown in -fno-exceptions mode"
// RUN: %run_c %s %t --levels -O2 --status 134 --fault "vector[] index out of bounds" \
// RUN:   --cflags "-DINDEX -mstack=global -D_LIBCPP_HARDENING_MODE=_LIBCPP_HARDENING_MODE_FAST"
// A C++ program that ends itself says why.
#if defined(TERMINATE)
#include <exception>
#elif defined(EMPTY)
#include <optional>
#elif defined(INDEX)
#include <vector>
#else
#include <new>
#endif

struct Base {
  Base() { call(); }
  __attribute__((noinline)) void call() { pure(); }
  virtual void pure() = 0;
  virtual ~Base() = default;
};
struct Derived : Base {
  void pure() override {}
};

int recursive(int n) {
  if (n == 0)
    return 0;
  static int value = recursive(n - 1);
  return value;
}

int main() {
#ifdef PURE
  Derived object;
#elif defined(MEMORY)
  if (new (std::nothrow) char[0x70000000] != nullptr)
    return 1;
  for (;;)
    *new volatile char[0x1000000] = 1;
#elif defined(SELF)
  return recursive(3);
#elif defined(TERMINATE)
  std::terminate();
#elif defined(EMPTY)
  std::optional<int> nothing;
  return nothing.value();
#elif defined(INDEX)
  std::vector<int> v(3);
  return v[static_cast<unsigned>(v.size())];
#endif
}
