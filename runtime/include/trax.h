/* The machine's services for programs. On the TP each function is one or two instructions. Compiled for the host (the
   native twin, see docs/runtime.md), the same calls work on a per-thread context, so device sources run on both
   unchanged. */
#ifndef TRAX_H
#define TRAX_H

#include <stddef.h>
#include <trax/ray_kinds.h>

/* A buffer that the host fills or reads, by the name of the object (trax-sim --bind, --alloc, --dump). */
struct trax_buffer {
  void *data;
  unsigned size; /* bytes */
};

/* Kinds of rays: TRAX_RAY_PRIMARY, _SHADOW, _OCCLUSION, _DIFFUSE, _GLOSSY, _MIRROR, _GLASS and _OTHER. TRAX_RAY_KINDS
   has the list (docs/isa.md, "Traps"). */
enum trax_ray_kind {
#define TRAX_RAY_KIND(X, ID, name, number, meaning) TRAX_RAY_##ID = number,
  TRAX_RAY_KINDS(TRAX_RAY_KIND, )
#undef TRAX_RAY_KIND
};

/* n rays of a kind, at most 15, for trax_count_kinds. Terms of different kinds may be added. */
#define TRAX_RAYS(kind, n) ((unsigned)(n) << TRAX_KIND_BITS * (kind))

#ifdef __trax__

#include <trax/numbers.h> /* of special registers and traps */

#define TRAX_INLINE static inline __attribute__((always_inline, unused))

TRAX_INLINE unsigned trax_thread(void) {
  return __builtin_trax_rdsr(TRAX_SR_THREAD);
} /* 0 .. trax_threads() - 1 */
TRAX_INLINE unsigned trax_tm(void) {
  return __builtin_trax_rdsr(TRAX_SR_TM);
} /* number of this thread's TM */
TRAX_INLINE unsigned trax_tp(void) {
  return __builtin_trax_rdsr(TRAX_SR_TP);
} /* number of this TP within its TM */
TRAX_INLINE unsigned trax_threads(void) {
  return __builtin_trax_rdsr(TRAX_SR_THREADS);
} /* threads of the chip */
TRAX_INLINE unsigned trax_cycles(void) {
  return __builtin_trax_rdsr(TRAX_SR_CYCLE);
} /* cycle counter modulo 2^32 */

/* Starts the function on all other threads, which wait until then and end with the function. For thread 0, with
   trax-sim --main-on 0. Returns the number of these threads; 0 if all threads call main, and for a second call. */
unsigned trax_start_threads(void (*function)(void));

/* The whole cycle counter. The halves are read in different cycles; a carry in between changes the upper half. */
TRAX_INLINE unsigned long long trax_cycles64(void) {
  unsigned high, low;
  do {
    high = __builtin_trax_rdsr(TRAX_SR_CYCLEH);
    low = __builtin_trax_rdsr(TRAX_SR_CYCLE);
  } while (high != __builtin_trax_rdsr(TRAX_SR_CYCLEH));
  return (unsigned long long)high << 32 | low;
}

/* 1 / sqrt(x), correctly rounded: +-0 gives +-infinity, a negative number NaN (IEEE 754-2019 rSqrt). */
TRAX_INLINE float trax_rsqrt(float x) {
  return __builtin_trax_rsqrt(x);
}

/* Adds 1 to a word of global memory and returns the previous value: the machine's only atomic read-modify-write. It
   orders nothing: a later access may come before it, unless the returned value has been used, and earlier stores may
   become visible later. To count arrivals, put __atomic_thread_fence before and after it, or use a C11 atomic. */
TRAX_INLINE unsigned trax_atomic_inc(unsigned *p) {
  return __builtin_trax_ainc(p);
}

/* Word accesses that bypass the data cache and order nothing. The compiler may move and merge them like any others. A
   loop that waits for another thread uses __atomic_load_n, which is executed each time. */
TRAX_INLINE void trax_store_nt(unsigned *p, unsigned value) {
  __builtin_nontemporal_store(value, p);
}
TRAX_INLINE unsigned trax_load_nt(const unsigned *p) {
  return __builtin_nontemporal_load(p);
}

/* Ends this thread with status 0. */
__attribute__((noreturn)) TRAX_INLINE void trax_halt(void) {
  __builtin_trax_halt();
}

/* Adds to the run's counters of rays, of rays by kind, and of finished items (pixels). A thread that counts rays of one
   kind then works for that kind, until its next count of rays or items (trax-sim --ray-kinds). */
TRAX_INLINE void trax_count_rays(unsigned n) { /* of kind TRAX_RAY_OTHER */
  __builtin_trax_trap(n, TRAX_TRAP_RAYS);
}
TRAX_INLINE void trax_count_kinds(unsigned rays) { /* a sum of TRAX_RAYS(kind, n) */
  __builtin_trax_trap(rays, TRAX_TRAP_KINDS);
}
TRAX_INLINE void trax_count_items(unsigned n) {
  __builtin_trax_trap(n, TRAX_TRAP_ITEMS);
}

/* Stops the machine with a fault report that shows message (in global memory; NULL for none). */
__attribute__((noreturn)) TRAX_INLINE void trax_abort(const char *message) {
  __builtin_trax_trap((unsigned)message, TRAX_TRAP_ABORT);
  __builtin_trax_halt();
}

#else /* the native twin */

#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#define TRAX_INLINE static inline __attribute__((unused))

/* The special registers and counters of one host thread. The code that starts the threads fills it in. */
struct trax_native {
  unsigned thread, tm, tp, threads;
  unsigned long long rays, items;
  unsigned long long kinds[TRAX_RAY_KIND_COUNT]; /* they add up to rays */
};

#ifdef __cplusplus
extern "C" {
#endif
extern _Thread_local struct trax_native trax_native;
__attribute__((weak)) _Thread_local struct trax_native trax_native = {0, 0, 0, 1, 0, 0, {0}};
#ifdef __cplusplus
}
#endif

TRAX_INLINE unsigned trax_thread(void) {
  return trax_native.thread;
}
TRAX_INLINE unsigned trax_tm(void) {
  return trax_native.tm;
}
TRAX_INLINE unsigned trax_tp(void) {
  return trax_native.tp;
}
TRAX_INLINE unsigned trax_threads(void) {
  return trax_native.threads;
}

/* Nanoseconds replace cycles. */
TRAX_INLINE unsigned long long trax_cycles64(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (unsigned long long)now.tv_sec * 1000000000u + (unsigned long long)now.tv_nsec;
}
TRAX_INLINE unsigned trax_cycles(void) {
  return (unsigned)trax_cycles64();
}

/* Correctly rounded: no binary32 operand brings the binary64 quotient close enough to a rounding boundary of binary32
   to cross it. tests/numerics checks every significand of both exponent parities. */
TRAX_INLINE float trax_rsqrt(float x) {
  if (!(x >= 0))
    return __builtin_nanf("");
  return (float)(1.0 / sqrt((double)x));
}

TRAX_INLINE unsigned trax_start_threads(void (*function)(void)) {
  (void)function;
  return 0;
}

TRAX_INLINE unsigned trax_atomic_inc(unsigned *p) {
  return __atomic_fetch_add(p, 1u, __ATOMIC_SEQ_CST);
}
TRAX_INLINE void trax_store_nt(unsigned *p, unsigned value) {
  *p = value;
}
TRAX_INLINE unsigned trax_load_nt(const unsigned *p) {
  return *p;
}
__attribute__((noreturn)) TRAX_INLINE void trax_halt(void) {
  pthread_exit(NULL);
}
TRAX_INLINE void trax_count_rays(unsigned n) {
  trax_native.rays += n;
  trax_native.kinds[TRAX_RAY_OTHER] += n;
}
TRAX_INLINE void trax_count_kinds(unsigned rays) {
  for (int kind = 0; kind < TRAX_RAY_KIND_COUNT; kind++) {
    trax_native.rays += rays >> TRAX_KIND_BITS * kind & ((1u << TRAX_KIND_BITS) - 1);
    trax_native.kinds[kind] += rays >> TRAX_KIND_BITS * kind & ((1u << TRAX_KIND_BITS) - 1);
  }
}
TRAX_INLINE void trax_count_items(unsigned n) {
  trax_native.items += n;
}
__attribute__((noreturn)) TRAX_INLINE void trax_abort(const char *message) {
  fprintf(stderr, "abort: %s\n", message ? message : "");
  abort();
}

#endif

#undef TRAX_INLINE
#endif
