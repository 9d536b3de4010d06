/* DRAM behind the memory controller (docs/timing-memory.md, "DRAM"): which of the requests that a channel holds is
   served next, and when its data are over. Both timed engines use it: they bring requests in the same order and ask for
   the same cycles. Time is counted in ticks, cycles of the DRAM's clock. */
#ifndef TRAX_DRAM_H
#define TRAX_DRAM_H

#include "machine/config.h"
#include "machine/section.h"
#include "machine/stats.h"

enum trax_dram_queue { TRAX_DRAM_READ, TRAX_DRAM_WRITE, TRAX_DRAM_QUEUES };

#define TRAX_DRAM_NO_ROW UINT32_MAX
enum { TRAX_DRAM_WINDOW = 4 }; /* activations in tFAW */

#define TRAX_DRAM_REQUEST_STATE(X, S)                                                                                  \
  X(S, uint64_t, came, ) /* the first tick of the cycle in which it came */                                            \
  X(S, uint32_t, id, )   /* the engine's name for it */                                                                \
  X(S, uint32_t, row, )                                                                                                \
  X(S, uint32_t, bank, ) /* rank * banks + bank */                                                                     \
  X(S, uint32_t, bursts, )
struct trax_dram_request {
  TRAX_DRAM_REQUEST_STATE(TRAX_FIELD, )
};

#define TRAX_DRAM_BANK_STATE(X, S)                                                                                     \
  X(S, uint64_t, activate_from, )  /* after a refresh */                                                               \
  X(S, uint64_t, access_from, )    /* of the open row */                                                               \
  X(S, uint64_t, precharge_from, ) /* of the open row */                                                               \
  X(S, uint32_t, row, )            /* the open one, or TRAX_DRAM_NO_ROW */
struct trax_dram_bank {
  TRAX_DRAM_BANK_STATE(TRAX_FIELD, )
};

#define TRAX_DRAM_RANK_STATE(X, S)                                                                                     \
  X(S, uint64_t, activate_from, )                 /* by tRRD */                                                        \
  X(S, uint64_t, window_from, [TRAX_DRAM_WINDOW]) /* by tFAW, after each of the last four activations */               \
  X(S, uint64_t, activations, )                   /* so far; modulo four the place of the oldest of these */           \
  X(S, uint64_t, read_from, )                     /* by tWTR */                                                        \
  X(S, uint64_t, refresh_due, )
struct trax_dram_rank {
  TRAX_DRAM_RANK_STATE(TRAX_FIELD, )
};

#define TRAX_DRAM_CHANNEL_STATE(X, S)                                                                                  \
  X(S, uint64_t, free_from, )                   /* f of docs/timing.md, in ticks */                                    \
  X(S, uint32_t, last_rank, )                   /* of the latest data */                                               \
  X(S, uint32_t, last_queue, )                  /* of the latest data */                                               \
  X(S, uint32_t, batch, )                       /* writes left of the batch */                                         \
  X(S, uint32_t, count, [TRAX_DRAM_QUEUES])     /* requests held */                                                    \
  X(S, uint32_t, overtaken, [TRAX_DRAM_QUEUES]) /* how often the oldest one has been overtaken */
struct trax_dram_channel {
  TRAX_DRAM_CHANNEL_STATE(TRAX_FIELD, )
  struct trax_dram_request *request[TRAX_DRAM_QUEUES]; /* [capacity], the oldest first */
  struct trax_dram_rank *rank;                         /* [ranks] */
  struct trax_dram_bank *bank;                         /* [ranks * banks] */
};

/* The commands of a request. */
struct trax_dram_commands {
  bool activates, precharges;
  uint64_t precharge, activate, access, data, over; /* ticks; access: the first of its bursts */
};

struct trax_dram_served {
  uint32_t id;
  uint64_t over; /* the cycle in which its data are over */
  struct trax_dram_commands commands;
};

struct trax_dram {
  const struct trax_config *config;
  struct trax_dram_map map;
  uint64_t ticks, cycles;      /* so many ticks are so many cycles of the chip, in lowest terms */
  uint32_t burst_bytes, burst; /* bytes and ticks of a burst */
  uint32_t ahead;              /* ticks before the bus is free in which the next request is chosen */
  uint32_t capacity[TRAX_DRAM_QUEUES];
  struct trax_dram_channel *channel; /* [memory.channels] */
  struct trax_dram_stats *stats;
};

/* NULL, with a message: out of memory. The configuration must be valid. */
struct trax_dram *trax_dram_create(const struct trax_config *config, struct trax_dram_stats *stats, trax_error *error);
void trax_dram_destroy(struct trax_dram *dram); /* may be NULL */

uint32_t trax_dram_channel_of(const struct trax_dram *dram, uint32_t address);

/* Whether the channel holds less requests of the kind than it can. */
static inline bool trax_dram_has_place(const struct trax_dram *dram, uint32_t channel, enum trax_dram_queue queue) {
  return dram->channel[channel].count[queue] < dram->capacity[queue];
}
/* Brings a request in cycle t. There must be a place for it. */
void trax_dram_bring(struct trax_dram *dram, enum trax_dram_queue queue, uint32_t id, uint32_t address, uint32_t bytes,
                     uint64_t t);
/* Serves a request in cycle t. False: the channel serves none in cycle t any more. */
bool trax_dram_serve(struct trax_dram *dram, uint32_t channel, uint64_t t, struct trax_dram_served *served);

/* The first cycle in which the channel serves one of the requests that it holds, which may be over; UINT64_MAX: it
   holds none. */
uint64_t trax_dram_next_cycle(const struct trax_dram *dram, uint32_t channel);
/* The first cycle in which the channel's bus is idle. */
uint64_t trax_dram_idle_from(const struct trax_dram *dram, uint32_t channel);

/* Whether the channel's state, read from a file, is one that at most so many requests can have led to by cycle t, as
   far as safety depends on it. The ids are not checked. */
bool trax_dram_check(const struct trax_dram *dram, uint32_t channel, uint64_t t, uint64_t requests);

struct trax_visitor;
/* Visits the state as sections (machine/section.h). */
void trax_dram_visit(const struct trax_dram *dram, const struct trax_visitor *visitor);

#endif
