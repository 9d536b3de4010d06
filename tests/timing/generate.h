/* Random programs and configurations. */
#ifndef TRAX_TIMING_GENERATE_H
#define TRAX_TIMING_GENERATE_H

#include "bench.h"

enum {
  BASE = 20,    /* register: the thread's words at DATA + 256 * thread */
  LOOP = 21,    /* register: turns left */
  SHARED = 22,  /* register: words nobody writes */
  COUNTER = 23, /* register: the thread's atomic counter */
  BODY = 120,   /* instructions of the loop */
  MAX_THREADS = 128
};

extern uint64_t random_state;
uint32_t any(uint32_t least, uint32_t most);
/* A power of two times least. */
uint32_t any_power(uint32_t least, uint32_t most);

/* A thread touches only its own words, and others' only through atomic increments of its own counter. At most BODY + 64
   instructions. */
size_t any_program(uint32_t *words);
/* Threads race: for shared words, with the cycle counter and traps in between. At most BODY + 64 instructions. */
size_t any_racing_program(uint32_t *words);
/* Threads load and store in turn: mostly their own words, some words of others and of all. At most BODY + 64
   instructions. */
size_t any_writing_program(uint32_t *words);
/* Random words, most of them legal. */
void any_words(uint32_t *words, size_t count);

/* Every instruction of the ISA, with addresses, branches, calls, runs of stores and, seldom, faults that belong to it.
   At most BODY + 64 instructions. */
size_t any_isa_program(uint32_t *words);

enum { ITEMS = 6000, ITEM_COUNTER = 0x40000 }; /* where nothing is loaded: it begins with 0 */

/* Threads take ITEMS items by an atomic increment, each of them a loop with misses, conflicts and branches by what was
   loaded, and of another length. At most BODY + 64 instructions. */
size_t item_program(uint32_t *words);

/* Not every key. */
struct trax_config any_config(uint32_t tms, uint32_t tps);
/* Any value of every key, but 1 MiB of memory, and latencies of at most 300 cycles. */
struct trax_config any_machine(uint32_t tms, uint32_t tps);

#endif
