/* Transfers: what the memory controller takes from the TMs and the second-level cache for off-chip memory
   (docs/timing-memory.md, "Memory controller"). A run without a listener pays nothing for this.

   An engine calls `transfer` in the order of (cycle, channel), those of one cycle and channel in the order in which the
   channel takes them, by the host thread that called trax_machine_run. Calls may come later than the cycle, but none
   after trax_run_advance has returned. */
#ifndef TRAX_MACHINE_TRANSFERS_H
#define TRAX_MACHINE_TRANSFERS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Identifier, word in traces. The numbers are those of the binary trace. */
#define TRAX_TRANSFER_KINDS(X)                                                                                         \
  X(INSTRUCTION_LINE, "instruction_line") /* for an instruction cache */                                               \
  X(DATA_LINE, "data_line")               /* for a data cache */                                                       \
  X(LOAD, "load")                         /* past the cache */                                                         \
  X(WRITE, "write")                                                                                                    \
  X(ATOMIC, "atomic")   /* an increment, which without DRAM moves the word */                                          \
  X(L2_LINE, "l2_line") /* for the second-level cache */

typedef enum trax_transfer_kind {
#define TRAX_TRANSFER_KIND(ID, WORD) TRAX_TRANSFER_##ID,
  TRAX_TRANSFER_KINDS(TRAX_TRANSFER_KIND)
#undef TRAX_TRANSFER_KIND
      TRAX_TRANSFER_KIND_COUNT
} trax_transfer_kind;

enum { TRAX_TRANSFER_NO_TM = -1 }; /* of TRAX_TRANSFER_L2_LINE */

struct trax_transfer {
  uint64_t cycle;   /* in which the channel takes it: it begins, or comes to the DRAM's queue */
  uint32_t address; /* of the first byte that was asked for */
  uint32_t bytes;   /* as the statistics count them */
  int16_t tm;
  uint8_t kind, channel;
};

struct trax_transfers {
  void *context;
  void (*transfer)(void *context, const struct trax_transfer *transfer);
  bool lost; /* set by the engine: memory ran out, and transfers were lost */
};

/* The transfers of an engine that may go back and repeat them. While it holds them, the listener does not learn of
 * them.
 */
struct trax_transfer_log {
  struct trax_transfers *to;
  bool holds;
  struct trax_transfer *held; /* [count] */
  size_t count, capacity;
};

void trax_transfer_log_add(struct trax_transfer_log *log, const struct trax_transfer *transfer);
/* Hands the held ones over, which will not be repeated. */
void trax_transfer_log_release(struct trax_transfer_log *log);
/* Discards the held ones: the engine goes back. */
void trax_transfer_log_discard(struct trax_transfer_log *log);
void trax_transfer_log_destroy(struct trax_transfer_log *log);

#endif
