/* The C library's interface to the machine. It also runs on the host, where the tests supply these functions. */
#ifndef TRAX_RUNTIME_MACHINE_H
#define TRAX_RUNTIME_MACHINE_H

#include <stdint.h>

#include "inline.h"

#ifdef __trax__

#include <trax.h>

INLINE void machine_put_char(int c) {
  __builtin_trax_trap((unsigned)c, TRAX_TRAP_PUTC);
}
INLINE void machine_put_string(const char *s) {
  __builtin_trax_trap((unsigned)s, TRAX_TRAP_PUTS);
}
__attribute__((noreturn)) INLINE void machine_abort(const char *message) {
  trax_abort(message);
}
__attribute__((noreturn)) INLINE void machine_exit(int status) {
  __builtin_trax_trap((unsigned)status, TRAX_TRAP_EXIT);
  __builtin_trax_halt();
}
INLINE unsigned long long machine_cycles(void) {
  return trax_cycles64();
}
INLINE unsigned machine_thread(void) {
  return trax_thread();
}
INLINE unsigned machine_threads(void) {
  return trax_threads();
}
/* The host reads strings from global memory only; this one may be on the stack. */
INLINE int machine_is_local(const void *p) {
  return (uintptr_t)p >= 0xFFFFFE00u;
}

/* The machine orders nothing by itself (docs/isa.md, "Order"). Release: this thread's earlier stores are in memory
   before its later ones. Acquire: its later loads give no older values than its earlier ones. */
INLINE void release_fence(void) {
  __atomic_thread_fence(__ATOMIC_RELEASE);
}
INLINE void acquire_fence(void) {
  __atomic_thread_fence(__ATOMIC_ACQUIRE);
}

/* A ticket lock. The atomic increment draws a ticket. The owner alone writes the number that is served. Accesses bypass
   the caches, because a TM's cache does not see the stores of others. */
struct ticket_lock {
  unsigned next, serving;
};

/* Loads the word on each call, as volatile would: the builtin for such loads drops volatile. */
INLINE unsigned load_shared(const unsigned *p) {
  unsigned value;
  __asm__ volatile("lwnt %0, 0(%1)" : "=r"(value) : "r"(p) : "memory");
  return value;
}
INLINE void store_shared(unsigned *p, unsigned value) {
  __asm__ volatile("swnt %0, 0(%1)" : : "r"(value), "r"(p) : "memory");
}

/* Takes the lock without a fence, which would empty the cache: for a lock that protects no memory, or memory that is
   read past the cache. */
INLINE void enter(struct ticket_lock *l) {
  unsigned ticket = trax_atomic_inc(&l->next);
  while (load_shared(&l->serving) != ticket)
    ;
}
INLINE void leave(struct ticket_lock *l) {
  store_shared(&l->serving, load_shared(&l->serving) + 1);
}

INLINE void lock(struct ticket_lock *l) {
  enter(l);
  acquire_fence();
}
INLINE void unlock(struct ticket_lock *l) {
  release_fence();
  leave(l);
}

#else

void host_put_char(int c);
unsigned long long host_cycles(void);
void host_put_string(const char *s);
__attribute__((noreturn)) void host_abort(const char *message);
__attribute__((noreturn)) void host_exit(int status);

INLINE void machine_put_char(int c) {
  host_put_char(c);
}
INLINE void machine_put_string(const char *s) {
  host_put_string(s);
}
__attribute__((noreturn)) INLINE void machine_abort(const char *message) {
  host_abort(message);
}
__attribute__((noreturn)) INLINE void machine_exit(int status) {
  host_exit(status);
}
INLINE unsigned long long machine_cycles(void) {
  return host_cycles();
}
INLINE unsigned machine_thread(void) {
  return 0;
}
INLINE unsigned machine_threads(void) {
  return 1;
}
INLINE int machine_is_local(const void *p) {
  (void)p;
  return 0;
}

struct ticket_lock {
  unsigned next, serving;
};

INLINE void lock(struct ticket_lock *l) {
  unsigned ticket = __atomic_fetch_add(&l->next, 1, __ATOMIC_SEQ_CST);
  while (__atomic_load_n(&l->serving, __ATOMIC_SEQ_CST) != ticket)
    ;
}

INLINE void unlock(struct ticket_lock *l) {
  __atomic_fetch_add(&l->serving, 1, __ATOMIC_SEQ_CST);
}

INLINE void enter(struct ticket_lock *l) {
  lock(l);
}
INLINE void leave(struct ticket_lock *l) {
  unlock(l);
}

#endif
#endif
