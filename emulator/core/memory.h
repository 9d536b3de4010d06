/* The memory controller: the bus, and the order in which the TMs' requests get it (docs/timing.md, "Memory
 * controller"). */
#ifndef TRAX_CORE_MEMORY_H
#define TRAX_CORE_MEMORY_H

#include "core/arbiter.h"
#include "core/config.h"

struct trax_tm;
struct trax_space;

struct trax_memory {
  /* Bus time in units: a cycle has units_per_cycle of them, a byte takes units_per_byte. B = MB/s / MHz bytes per
     cycle, so with the fraction in lowest terms these are its numerator and denominator. */
  uint64_t units_per_cycle, units_per_byte;
  uint64_t free_from; /* f, in units */
  uint32_t latency;
  uint64_t waiting_tms; /* mask: TMs whose queues hold waiting requests */
  trax_arbiter turn;
  void (*before_increment)(void *context, uint32_t address); /* of a word; may be NULL */
  void *context;
};

void trax_memory_create(struct trax_memory *memory, const struct trax_config *config);

/* The controller learns of the TM's oldest request that it does not know of. */
void trax_memory_show(struct trax_memory *memory, struct trax_tm *tm);

/* Step 3 of cycle t: starts transfers. Lowers tm[].next_cycle where a completion comes sooner. */
void trax_memory_cycle(struct trax_memory *memory, struct trax_tm *tm, struct trax_space *space, uint64_t t);

/* First cycle after t in which a transfer starts if no request is added; UINT64_MAX if none waits. */
uint64_t trax_memory_next_cycle(const struct trax_memory *memory, uint64_t t);

/* First cycle in which the bus is idle. */
uint64_t trax_memory_idle_from(const struct trax_memory *memory);

#endif
