/* The memory controller: its channels, and the order in which the TMs' requests get them (docs/timing.md, "Memory
   controller"). Between it and the TMs there may be a second-level cache (fast/l2.h). All that TMs have to do with each
   other in time happens here. */
#ifndef TRAX_FAST_MEMORY_H
#define TRAX_FAST_MEMORY_H

#include "fast/arbiter.h"
#include "fast/queue.h"
#include "machine/config.h"
#include "machine/stats.h"

struct trax_tm;
struct trax_space;
struct trax_l2;

/* Requests of all TMs in lists: TM << TRAX_REQUEST_BITS | place in its queue; the lines that the second-level cache
   requests follow as if they were TRAX_MAX_TMS's. */
typedef uint32_t trax_request_id;
#define TRAX_REQUEST_BITS 12
#define TRAX_LINE_REQUEST ((trax_request_id)TRAX_MAX_TMS << TRAX_REQUEST_BITS)

/* First in, first out; linked by trax_request.next. */
#define TRAX_REQUEST_LIST_STATE(X, S)                                                                                  \
  X(S, trax_request_id, first, ) /* TRAX_NO_REQUEST if the list is empty */                                            \
  X(S, trax_request_id, last, )
struct trax_request_list {
  TRAX_REQUEST_LIST_STATE(TRAX_FIELD, )
};
static const struct trax_request_list trax_empty_list = {.first = TRAX_NO_REQUEST, .last = TRAX_NO_REQUEST};

/* Who waits for a channel or a bank of the second-level cache. */
#define TRAX_WAITING_STATE(X, S)                                                                                       \
  X(S, uint64_t, tms, ) /* mask: whose list is not empty */                                                            \
  X(S, trax_arbiter, arbiter, )                                                                                        \
  X(S, struct trax_request_list, list, [TRAX_MAX_TMS])
struct trax_waiting {
  TRAX_WAITING_STATE(TRAX_FIELD, )
};

/* An instant: whole cycles, and units of the next one, fewer than units_per_cycle. In units alone it would not fit in
   64 bits after some 10^10 cycles. */
#define TRAX_INSTANT_STATE(X, S)                                                                                       \
  X(S, uint64_t, cycle, )                                                                                              \
  X(S, uint64_t, units, )
struct trax_instant {
  TRAX_INSTANT_STATE(TRAX_FIELD, )
};

#define TRAX_CHANNEL_STATE(X, S)                                                                                       \
  X(S, struct trax_instant, free_from, )   /* f */                                                                     \
  X(S, struct trax_request_list, passed, ) /* by the second-level cache */
struct trax_channel {
  TRAX_CHANNEL_STATE(TRAX_FIELD, )
  struct trax_waiting *waiting; /* without a second-level cache, unless the TMs' queues are rings; else NULL */
};

/* `keeps_order`: one channel and nothing else; then the TMs' queues are rings. */
#define TRAX_MEMORY_STATE(X, S)                                                                                        \
  X(S, trax_arbiter, arbiter, ) /* of the channel, if keeps_order */                                                   \
  X(S, uint64_t, tms, )         /* mask: TMs with requests that wait for it */                                         \
  X(S, uint32_t, waiting, )     /* requests that wait for channels; unless keeps_order */

struct trax_memory {
  TRAX_MEMORY_STATE(TRAX_FIELD, )
  /* Bus time in units: a cycle has units_per_cycle of them, a byte takes units_per_byte. B = MB/s / MHz / channels
     bytes per cycle, so with the fraction in lowest terms these are its numerator and denominator. */
  uint64_t units_per_cycle, units_per_byte;
  uint32_t latency;        /* of everything, and */
  uint32_t atomic_latency; /* of atomic increments besides */
  uint32_t channels, interleave_shift;
  struct trax_channel channel[TRAX_MAX_CHANNELS];
  bool keeps_order;
  struct trax_l2 *l2; /* NULL: there is none */
  struct trax_memory_stats *stats;
  void (*before_increment)(void *context, uint32_t address); /* of a word; may be NULL */
  void *context;
};

/* Whether each TM gets back what it requests in the order in which it requests it. */
bool trax_memory_keeps_order(const struct trax_config *config);
/* A number of cycles d, at least 1, such that nothing a TM requests in cycle t comes back to it before t + d; the
   largest one, if that is below a million. */
uint32_t trax_memory_least_latency(const struct trax_config *config);

trax_status trax_memory_create(struct trax_memory *memory, const struct trax_config *config,
                               struct trax_memory_stats *stats, trax_error *error);
void trax_memory_destroy(struct trax_memory *memory);

/* The memory learns of the TM's oldest request that it does not know of: it waits from now on. */
void trax_memory_submit(struct trax_memory *memory, struct trax_tm *tm);

/* Step 3 of cycle t: takes requests and starts transfers. Lowers tm[].next_cycle where a completion comes sooner. */
void trax_memory_cycle(struct trax_memory *memory, struct trax_tm *tm, struct trax_space *space, uint64_t t);

/* Before cycle t: starts all transfers of t and the cycles behind it, up to `end`, that are the same whatever the
   `count` TMs request from now on, if each does nothing before its next_cycle. Returns the first cycle, `end` or a
   later one if they all are, in which a transfer may start that was not. */
uint64_t trax_memory_run_ahead(struct trax_memory *memory, struct trax_tm *tm, unsigned count, struct trax_space *space,
                               uint64_t t, uint64_t end);

/* First cycle after t in which something can start if no request is added; UINT64_MAX if nothing waits. */
uint64_t trax_memory_next_cycle(const struct trax_memory *memory, uint64_t t);

/* Whether a request waits for a bank of the second-level cache or for a channel. */
bool trax_memory_has_waiting(const struct trax_memory *memory);

/* First cycle in which all buses are idle. */
uint64_t trax_memory_idle_from(const struct trax_memory *memory);

/* --- for fast/l2.c --- */
struct trax_request *trax_memory_request(const struct trax_memory *memory, struct trax_tm *tm, trax_request_id id);
void trax_memory_append(const struct trax_memory *memory, struct trax_tm *tm, struct trax_request_list *list,
                        trax_request_id id);
trax_request_id trax_memory_take_first(const struct trax_memory *memory, struct trax_tm *tm,
                                       struct trax_request_list *list);
/* `count` of them, empty; NULL if there is no memory. */
struct trax_waiting *trax_waiting_create(uint32_t count);
/* Whose turn it is, of those who wait. */
unsigned trax_waiting_arbitrate(struct trax_waiting *waiting);
/* Takes the oldest request of TM `number`. */
trax_request_id trax_waiting_take(struct trax_memory *memory, struct trax_tm *tm, struct trax_waiting *waiting,
                                  unsigned number);
/* The request waits for the channel of its address from now on. */
void trax_memory_pass(struct trax_memory *memory, struct trax_tm *tm, trax_request_id id);
/* A TM's request comes back in `completion`. */
void trax_memory_complete(struct trax_tm *tm, trax_request_id id, uint64_t completion);

#endif
