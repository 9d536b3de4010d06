/* The transfers of the fast engine, for a listener (machine/transfers.h). Those since a snapshot are held until it is
   given up, since a roll back repeats them. */
#ifndef TRAX_FAST_TRANSFERS_H
#define TRAX_FAST_TRANSFERS_H

#include "fast/tm/queue.h"
#include "machine/transfers.h"

#include <stddef.h>

struct trax_transfer_log {
  struct trax_transfers *to;
  bool holds; /* there is a snapshot */
  struct trax_transfer *held;
  size_t count, capacity;
};

/* The channel takes the request of a TM in `cycle`; TRAX_MAX_TMS stands for the second-level cache. */
void trax_transfer_log_add(struct trax_transfer_log *log, uint64_t cycle, unsigned channel, uint32_t tm,
                           const struct trax_request *request);
/* Hands the held ones over, which no roll back repeats any more. */
void trax_transfer_log_release(struct trax_transfer_log *log);
/* A roll back: discards the held ones. */
void trax_transfer_log_discard(struct trax_transfer_log *log);
void trax_transfer_log_destroy(struct trax_transfer_log *log);

#endif
