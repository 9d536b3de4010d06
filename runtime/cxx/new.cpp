// operator new and delete: malloc and free. There are no exceptions: without memory the program ends; the nothrow forms
// return a null pointer.
#include "../internal/machine.h"

#include <stdlib.h>

namespace std {
struct nothrow_t {
  explicit nothrow_t() = default;
};
extern const nothrow_t nothrow;
const nothrow_t nothrow{};
enum class align_val_t : size_t {};
} // namespace std

using std::align_val_t;
using std::nothrow_t;

static void *checked(void *memory) {
  if (!memory)
    machine_abort("operator new: no memory left");
  return memory;
}

static void *allocate(size_t size) {
  return malloc(size);
}

static void *allocate(size_t size, align_val_t alignment) {
  return aligned_alloc(static_cast<size_t>(alignment), size);
}

__attribute__((weak)) void *operator new(size_t size) {
  return checked(allocate(size));
}
__attribute__((weak)) void *operator new(size_t size, align_val_t alignment) {
  return checked(allocate(size, alignment));
}
__attribute__((weak)) void *operator new(size_t size, const nothrow_t &) noexcept {
  return allocate(size);
}
__attribute__((weak)) void *operator new(size_t size, align_val_t alignment, const nothrow_t &) noexcept {
  return allocate(size, alignment);
}
__attribute__((weak)) void operator delete(void *memory) noexcept {
  free(memory);
}

// The others are defined by these, so that a program which replaces one of these replaces them all.
__attribute__((weak)) void *operator new[](size_t size) {
  return operator new(size);
}
__attribute__((weak)) void *operator new[](size_t size, align_val_t alignment) {
  return operator new(size, alignment);
}
__attribute__((weak)) void *operator new[](size_t size, const nothrow_t &tag) noexcept {
  return operator new(size, tag);
}
__attribute__((weak)) void *operator new[](size_t size, align_val_t alignment, const nothrow_t &tag) noexcept {
  return operator new(size, alignment, tag);
}
__attribute__((weak)) void operator delete(void *memory, align_val_t) noexcept {
  operator delete(memory);
}
__attribute__((weak)) void operator delete(void *memory, size_t) noexcept {
  operator delete(memory);
}
__attribute__((weak)) void operator delete(void *memory, size_t, align_val_t) noexcept {
  operator delete(memory);
}
__attribute__((weak)) void operator delete(void *memory, const nothrow_t &) noexcept {
  operator delete(memory);
}
__attribute__((weak)) void operator delete(void *memory, align_val_t, const nothrow_t &) noexcept {
  operator delete(memory);
}
__attribute__((weak)) void operator delete[](void *memory) noexcept {
  operator delete(memory);
}
__attribute__((weak)) void operator delete[](void *memory, align_val_t) noexcept {
  operator delete[](memory);
}
__attribute__((weak)) void operator delete[](void *memory, size_t) noexcept {
  operator delete[](memory);
}
__attribute__((weak)) void operator delete[](void *memory, size_t, align_val_t) noexcept {
  operator delete[](memory);
}
__attribute__((weak)) void operator delete[](void *memory, const nothrow_t &) noexcept {
  operator delete[](memory);
}
__attribute__((weak)) void operator delete[](void *memory, align_val_t, const nothrow_t &) noexcept {
  operator delete[](memory);
}
