/* Atomic operations for which the machine has no instruction, under a lock made from its atomic increment. The
   functions are those of GCC's and LLVM's libatomic. An object's address selects one of a few locks.

   Objects of 1 to 8 bytes are read past the cache, so that only an order of acquire or more empties it. A
   read-modify-write that does not change the value stores nothing, and so waits for no store. */
#include "../internal/machine.h"

#include <stdbool.h>
#include <stddef.h>
#include <string.h>

#ifdef __trax__

#define LOCKS 8

static struct ticket_lock locks[LOCKS];

static inline struct ticket_lock *lock_of(const volatile void *p) {
  return &locks[(uintptr_t)p >> 3 & (LOCKS - 1)];
}

/* The fences before and after an operation of this order. */
static inline void begin(int order) {
  if (order >= __ATOMIC_RELEASE)
    release_fence();
}
static inline void end(int order) {
  if (order != __ATOMIC_RELAXED && order != __ATOMIC_RELEASE)
    acquire_fence();
}

/* Reads the object past the cache. */
static inline uint8_t read_1(const volatile uint8_t *p) {
  return __atomic_load_n(p, __ATOMIC_RELAXED);
}
static inline uint16_t read_2(const volatile uint16_t *p) {
  return __atomic_load_n(p, __ATOMIC_RELAXED);
}
static inline uint32_t read_4(const volatile uint32_t *p) {
  return __atomic_load_n(p, __ATOMIC_RELAXED);
}
static inline uint64_t read_8(const volatile uint64_t *p) { /* under its lock */
  const volatile uint32_t *word = (const volatile uint32_t *)p;
  const uint32_t low = read_4(word);
  return (uint64_t)read_4(word + 1) << 32 | low;
}

/* Clang takes these names for its own generic builtins, so they get them from the assembler. */
#define NAMED(name) __asm__(#name)

void trax_atomic_load(size_t size, const volatile void *from, void *to, int order) NAMED(__atomic_load);
void trax_atomic_store(size_t size, volatile void *to, const void *from, int order) NAMED(__atomic_store);
void trax_atomic_exchange(size_t size, volatile void *p, const void *value, void *old, int order)
    NAMED(__atomic_exchange);
bool trax_atomic_compare_exchange(size_t size, volatile void *p, void *expected, const void *desired, int success,
                                  int failure) NAMED(__atomic_compare_exchange);
bool trax_atomic_is_lock_free(size_t size, const volatile void *p) NAMED(__atomic_is_lock_free);

void trax_atomic_load(size_t size, const volatile void *from, void *to, int order) {
  begin(order);
  struct ticket_lock *l = lock_of(from);
  lock(l);
  memcpy(to, (const void *)from, size);
  unlock(l);
}

void trax_atomic_store(size_t size, volatile void *to, const void *from, int order) {
  begin(order);
  struct ticket_lock *l = lock_of(to);
  lock(l);
  memcpy((void *)to, from, size);
  unlock(l);
}

void trax_atomic_exchange(size_t size, volatile void *p, const void *value, void *old, int order) {
  begin(order);
  struct ticket_lock *l = lock_of(p);
  lock(l);
  memcpy(old, (const void *)p, size);
  memcpy((void *)p, value, size);
  unlock(l);
}

bool trax_atomic_compare_exchange(size_t size, volatile void *p, void *expected, const void *desired, int success,
                                  int failure) {
  (void)failure;
  begin(success);
  struct ticket_lock *l = lock_of(p);
  lock(l);
  bool equal = memcmp((const void *)p, expected, size) == 0;
  if (equal)
    memcpy((void *)p, desired, size);
  else
    memcpy(expected, (const void *)p, size);
  unlock(l);
  return equal;
}

bool trax_atomic_is_lock_free(size_t size, const volatile void *p) {
  return (size == 1 || size == 2 || size == 4) && ((uintptr_t)p & (size - 1)) == 0;
}

/* A fetch-and-change of one size: the old value is returned, the new one is an expression of old and value. */
#define CHANGE(bytes, type, expression, order)                                                                         \
  {                                                                                                                    \
    begin(order);                                                                                                      \
    struct ticket_lock *l = lock_of(p);                                                                                \
    enter(l);                                                                                                          \
    const type old = (type)read_##bytes((const volatile void *)p), changed = (type)(expression);                       \
    if (changed != old) {                                                                                              \
      *p = changed;                                                                                                    \
      release_fence();                                                                                                 \
    }                                                                                                                  \
    leave(l);                                                                                                          \
    end(order);                                                                                                        \
    return old;                                                                                                        \
  }
#define FETCH(name, bytes, type, expression)                                                                           \
  type trax_##name##_##bytes(volatile type *p, type value, int order) NAMED(__##name##_##bytes);                       \
  type trax_##name##_##bytes(volatile type *p, type value, int order) CHANGE(bytes, type, expression, order)
#define SYNC(name, bytes, type, expression)                                                                            \
  type trax_##name##_##bytes(volatile type *p, type value) NAMED(__##name##_##bytes);                                  \
  type trax_##name##_##bytes(volatile type *p, type value) CHANGE(bytes, type, expression, __ATOMIC_SEQ_CST)

/* Loads and stores of one aligned word or less are atomic by themselves; 8 bytes need the lock. */
#define OPERATIONS(bytes, type)                                                                                        \
  type trax_atomic_load_##bytes(const volatile type *p, int order) NAMED(__atomic_load_##bytes);                       \
  type trax_atomic_load_##bytes(const volatile type *p, int order) {                                                   \
    struct ticket_lock *l = lock_of(p);                                                                                \
    if (bytes > 4)                                                                                                     \
      enter(l);                                                                                                        \
    const type value = read_##bytes(p);                                                                                \
    if (bytes > 4)                                                                                                     \
      unlock(l); /* the value has arrived before the next owner changes it */                                          \
    end(order);                                                                                                        \
    return value;                                                                                                      \
  }                                                                                                                    \
  void trax_atomic_store_##bytes(volatile type *p, type value, int order) NAMED(__atomic_store_##bytes);               \
  void trax_atomic_store_##bytes(volatile type *p, type value, int order) {                                            \
    begin(order);                                                                                                      \
    struct ticket_lock *l = lock_of(p);                                                                                \
    enter(l);                                                                                                          \
    *p = value;                                                                                                        \
    unlock(l);                                                                                                         \
  }                                                                                                                    \
  bool trax_atomic_compare_exchange_##bytes(volatile type *p, type *expected, type desired, int success, int failure)  \
      NAMED(__atomic_compare_exchange_##bytes);                                                                        \
  bool trax_atomic_compare_exchange_##bytes(volatile type *p, type *expected, type desired, int success,               \
                                            int failure) {                                                             \
    begin(success);                                                                                                    \
    struct ticket_lock *l = lock_of(p);                                                                                \
    enter(l);                                                                                                          \
    const type old = read_##bytes(p);                                                                                  \
    const bool equal = old == *expected;                                                                               \
    if (equal && desired != old) {                                                                                     \
      *p = desired;                                                                                                    \
      release_fence();                                                                                                 \
    }                                                                                                                  \
    leave(l);                                                                                                          \
    end(equal ? success : failure);                                                                                    \
    if (!equal)                                                                                                        \
      *expected = old;                                                                                                 \
    return equal;                                                                                                      \
  }                                                                                                                    \
  type trax_sync_val_compare_and_swap_##bytes(volatile type *p, type expected, type desired)                           \
      NAMED(__sync_val_compare_and_swap_##bytes);                                                                      \
  type trax_sync_val_compare_and_swap_##bytes(volatile type *p, type expected, type desired) {                         \
    trax_atomic_compare_exchange_##bytes(p, &expected, desired, __ATOMIC_SEQ_CST, __ATOMIC_SEQ_CST);                   \
    return expected;                                                                                                   \
  }                                                                                                                    \
  FETCH(atomic_exchange, bytes, type, value)                                                                           \
  FETCH(atomic_fetch_add, bytes, type, old + value)                                                                    \
  FETCH(atomic_fetch_sub, bytes, type, old - value)                                                                    \
  FETCH(atomic_fetch_and, bytes, type, old &value)                                                                     \
  FETCH(atomic_fetch_or, bytes, type, old | value)                                                                     \
  FETCH(atomic_fetch_xor, bytes, type, old ^ value)                                                                    \
  FETCH(atomic_fetch_nand, bytes, type, ~(old & value))                                                                \
  SYNC(sync_lock_test_and_set, bytes, type, value)                                                                     \
  SYNC(sync_fetch_and_add, bytes, type, old + value)                                                                   \
  SYNC(sync_fetch_and_sub, bytes, type, old - value)                                                                   \
  SYNC(sync_fetch_and_and, bytes, type, old &value)                                                                    \
  SYNC(sync_fetch_and_or, bytes, type, old | value)                                                                    \
  SYNC(sync_fetch_and_xor, bytes, type, old ^ value)                                                                   \
  SYNC(sync_fetch_and_nand, bytes, type, ~(old & value))                                                               \
  SYNC(sync_fetch_and_umax, bytes, type, old > value ? old : value)                                                    \
  SYNC(sync_fetch_and_umin, bytes, type, old < value ? old : value)

OPERATIONS(1, uint8_t)
OPERATIONS(2, uint16_t)
OPERATIONS(4, uint32_t)
OPERATIONS(8, uint64_t)

#define SIGNED_OPERATIONS(bytes, type)                                                                                 \
  SYNC(sync_fetch_and_max, bytes, type, old > value ? old : value)                                                     \
  SYNC(sync_fetch_and_min, bytes, type, old < value ? old : value)

SIGNED_OPERATIONS(1, int8_t)
SIGNED_OPERATIONS(2, int16_t)
SIGNED_OPERATIONS(4, int32_t)
SIGNED_OPERATIONS(8, int64_t)

#endif
