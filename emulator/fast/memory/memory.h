/* The memory controller: its channels, and the arbitration of the TMs' requests (docs/timing-memory.md, "Memory
   controller"). There may be a second-level cache between it and the TMs (fast/memory/l2.h). TMs influence each other's
   timing only here. */
#ifndef TRAX_FAST_MEMORY_H
#define TRAX_FAST_MEMORY_H

#include "dram/dram.h"
#include "fast/tm/arbiter.h"
#include "fast/tm/queue.h"
#include "machine/config.h"
#include "machine/stats.h"
#include "machine/transfers.h"

struct trax_tm;
struct trax_l2;

/* Identifies a request in a list: TM << TRAX_REQUEST_BITS | place in the TM's queue. The requests of the second-level
   cache count as those of a TM with number TRAX_MAX_TMS. */
typedef uint32_t trax_request_id;
#define TRAX_REQUEST_BITS 12
#define TRAX_LINE_REQUEST ((trax_request_id)TRAX_MAX_TMS << TRAX_REQUEST_BITS)

/* A first-in, first-out list, linked by trax_request.next. */
#define TRAX_REQUEST_LIST_STATE(X, S)                                                                                  \
  X(S, trax_request_id, first, ) /* TRAX_NO_REQUEST if the list is empty */                                            \
  X(S, trax_request_id, last, )
struct trax_request_list {
  TRAX_REQUEST_LIST_STATE(TRAX_FIELD, )
};
static const struct trax_request_list trax_empty_list = {.first = TRAX_NO_REQUEST, .last = TRAX_NO_REQUEST};

/* The requests that wait for a channel or for a bank of the second-level cache, with the arbiter over the TMs. */
#define TRAX_WAITING_STATE(X, S)                                                                                       \
  X(S, trax_arbiter, arbiter, )                                                                                        \
  X(S, struct trax_request_list, list, [TRAX_MAX_TMS])
struct trax_waiting {
  TRAX_WAITING_STATE(TRAX_FIELD, )
  uint64_t tms; /* mask of the TMs with waiting requests */
};

/* An instant: whole cycles, and units of the next cycle, fewer than units_per_cycle. A number of units alone would
   exceed 64 bits after some 10^10 cycles. */
#define TRAX_INSTANT_STATE(X, S)                                                                                       \
  X(S, uint64_t, cycle, )                                                                                              \
  X(S, uint64_t, units, )
struct trax_instant {
  TRAX_INSTANT_STATE(TRAX_FIELD, )
};

#define TRAX_CHANNEL_STATE(X, S)                                                                                       \
  X(S, struct trax_instant, free_from, ) /* f of docs/timing.md; without DRAM */                                       \
  X(S, uint64_t, unit_free_from, )       /* of the increment unit */
struct trax_channel {
  TRAX_CHANNEL_STATE(TRAX_FIELD, )
  struct trax_waiting waiting; /* requests that a second-level cache has passed count as TM 0's */
};

struct trax_memory {
  uint32_t waiting; /* number of requests that wait for channels or in the DRAM's queues */
  /* Bus time is counted in units: a cycle has units_per_cycle of them, and a byte takes units_per_byte. They are the
     numerator and the denominator of B = MB/s / MHz / channels bytes per cycle, in lowest terms. */
  uint64_t units_per_cycle, units_per_byte;
  uint32_t latency;        /* cycles, of every transfer */
  uint32_t atomic_latency; /* cycles added for an atomic increment */
  uint32_t unit_interval;  /* cycles between the increments of a channel */
  uint32_t channels, interleave_shift;
  struct trax_channel channel[TRAX_MAX_CHANNELS];
  struct trax_l2 *l2;     /* NULL: there is none */
  struct trax_dram *dram; /* NULL unless memory.model is dram */
  struct trax_memory_stats *stats;
  struct trax_transfer_log *transfers;                    /* NULL: nobody listens */
  unsigned side;                                          /* of trax_queue.served, for requests that are served now */
  uint32_t (*increment)(void *context, uint32_t address); /* increments a word, and returns what it was */
  void *context;
};

/* Returns a number of cycles d, at least 1, such that no request of cycle t completes before t + d; the largest such
   number if that is below a million. */
uint32_t trax_memory_least_latency(const struct trax_config *config);

trax_status trax_memory_create(struct trax_memory *memory, const struct trax_config *config,
                               struct trax_memory_stats *stats, trax_error *error);
void trax_memory_destroy(struct trax_memory *memory);

/* Makes what follows from the lists and from the queues of the `count` TMs. */
void trax_memory_import(struct trax_memory *memory, struct trax_tm *tm, unsigned count);

/* Submits the TM's request in a place of its queue, which waits from now on. Those of a TM are submitted in the order
   in which they are made. */
void trax_memory_submit(struct trax_memory *memory, struct trax_tm *tm, uint32_t place);

/* Step 3 of cycle t: serves requests and starts transfers. TMs have to receive what has been served. */
void trax_memory_cycle(struct trax_memory *memory, struct trax_tm *tm, uint64_t t);

/* Returns the first cycle after t in which a transfer can start if no request is added; UINT64_MAX if none waits. */
uint64_t trax_memory_next_cycle(const struct trax_memory *memory, uint64_t t);

/* Whether a request waits for a bank of the second-level cache or for a channel. */
bool trax_memory_has_waiting(const struct trax_memory *memory);

/* Returns the first cycle in which all buses are idle. */
uint64_t trax_memory_idle_from(const struct trax_memory *memory);

/* --- between the files of this folder --- */
struct trax_request *trax_memory_request(const struct trax_memory *memory, struct trax_tm *tm, trax_request_id id);
void trax_memory_append(const struct trax_memory *memory, struct trax_tm *tm, struct trax_request_list *list,
                        trax_request_id id);
trax_request_id trax_memory_take_first(const struct trax_memory *memory, struct trax_tm *tm,
                                       struct trax_request_list *list);
/* Makes what follows from the list's links, and returns the number of its requests. */
uint32_t trax_memory_import_list(const struct trax_memory *memory, struct trax_tm *tm, struct trax_request_list *list);
/* The same for all lists of the TMs. */
uint32_t trax_waiting_import(const struct trax_memory *memory, struct trax_tm *tm, struct trax_waiting *waiting);
/* Empties all lists. */
void trax_waiting_begin(struct trax_waiting *waiting);
/* Appends a request to the list of TM `number`. */
void trax_waiting_add(const struct trax_memory *memory, struct trax_tm *tms, struct trax_waiting *waiting,
                      unsigned number, trax_request_id id);
/* Returns the winner among the TMs with waiting requests, and moves the arbiter's pointer past it. */
unsigned trax_waiting_arbitrate(struct trax_waiting *waiting);
/* Removes and returns the oldest request of TM `number`. */
trax_request_id trax_waiting_take(struct trax_memory *memory, struct trax_tm *tm, struct trax_waiting *waiting,
                                  unsigned number);
/* Passes a request to the channel of its address. */
void trax_memory_pass(struct trax_memory *memory, struct trax_tm *tm, trax_request_id id);
/* Sets the completion of a TM's request. */
void trax_memory_complete(const struct trax_memory *memory, struct trax_tm *tm, trax_request_id id,
                          uint64_t completion);
/* Tells who listens that a channel takes a request in cycle t. */
void trax_memory_notify(struct trax_memory *memory, unsigned channel, trax_request_id id,
                        const struct trax_request *request, uint64_t t);
/* Counts a transfer. */
void trax_memory_count(const struct trax_memory *memory, unsigned channel, uint32_t bytes);
/* Performs an atomic increment whose transfer is over in cycle `over`. Returns the cycle in which the channel's unit
   has done it. */
uint64_t trax_memory_increment(struct trax_memory *memory, unsigned channel, struct trax_request *request,
                               uint64_t over);
/* A request has been served; `back`: the cycle in which its transfer is over, and memory.latency_cycles. */
void trax_memory_finish(struct trax_memory *memory, struct trax_tm *tm, unsigned channel, trax_request_id id,
                        uint64_t back);
/* Serves requests of a channel of DRAM in cycle t. */
void trax_memory_serve_dram(struct trax_memory *memory, struct trax_tm *tm, unsigned channel, uint64_t t);

#endif
