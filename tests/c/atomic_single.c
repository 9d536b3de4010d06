// RUN: %run_c %s %t --cflags "-Wno-atomic-alignment"
// Every atomic read-modify-write of every size, by one thread: results as the host's.
#include <stdatomic.h>
#include <stdio.h>

static unsigned long long hash;
static void mix(unsigned long long x) {
  hash = hash * 31 + x;
}

/* In pieces: one function with all of this, not optimised, would not fit the stack. */
#define TEST(type, name)                                                                                               \
  static _Atomic type name##_object;                                                                                   \
  __attribute__((noinline)) static void name##_changes(type by) {                                                      \
    mix((unsigned long long)atomic_fetch_add(&name##_object, by));                                                     \
    mix((unsigned long long)atomic_fetch_sub(&name##_object, (type)(by * 3)));                                         \
    mix((unsigned long long)atomic_fetch_or(&name##_object, (type)(by << 2)));                                         \
    mix((unsigned long long)atomic_fetch_and(&name##_object, (type)~by));                                              \
  }                                                                                                                    \
  __attribute__((noinline)) static void name##_more(type start) {                                                      \
    mix((unsigned long long)atomic_fetch_xor(&name##_object, (type)-1));                                               \
    mix((unsigned long long)atomic_fetch_add(&name##_object, 1));                                                      \
    mix((unsigned long long)atomic_exchange(&name##_object, (type)(start + 7)));                                       \
  }                                                                                                                    \
  __attribute__((noinline)) static void name##_compare(type start, type expected) {                                    \
    mix((unsigned)atomic_compare_exchange_strong(&name##_object, &expected, start));                                   \
    mix((unsigned)atomic_compare_exchange_strong(&name##_object, &expected, start));                                   \
    mix((unsigned long long)expected);                                                                                 \
  }                                                                                                                    \
  __attribute__((noinline)) static void name##_operators(void) {                                                       \
    mix((unsigned long long)++name##_object);                                                                          \
    mix((unsigned long long)(name##_object *= 3));                                                                     \
  }                                                                                                                    \
  static void name(type start, type by) {                                                                              \
    hash = 0;                                                                                                          \
    atomic_store(&name##_object, start);                                                                               \
    name##_changes(by);                                                                                                \
    name##_more(start);                                                                                                \
    name##_compare(start, by);                                                                                         \
    name##_operators();                                                                                                \
    printf("%llx %llx\n", hash, (unsigned long long)atomic_load(&name##_object));                                      \
  }

TEST(unsigned char, u8)
TEST(short, s16)
TEST(int, s32)
TEST(unsigned, u32)
TEST(unsigned long long, u64)

int main(void) {
  u8(200, 77);
  s16(-30000, 1234);
  s32(-5, 1000000);
  u32(4000000000u, 0x10001);
  u64(0xFEDCBA9876543210ull, 0x123456789ull);
  _Atomic float f = 1.5f;
  float old = atomic_exchange(&f, 2.5f);
  printf("%g %g %d\n", (double)old, (double)f, atomic_is_lock_free(&f) != 0);
  return 0;
}
