/* One machine: configuration, memory, program, watches, and the outcome of its run. It knows no engine. Internal to the
   library; emulator/program adds the program's symbols and buffers by the member `loaded`. */
#ifndef TRAX_MACHINE_MACHINE_H
#define TRAX_MACHINE_MACHINE_H

#include "machine/address_space.h"
#include "machine/config.h"
#include "machine/fault.h"
#include "machine/host_call.h"
#include "machine/observer.h"
#include "machine/slow_paths.h"
#include "machine/stats.h"
#include "machine/transfers.h"
#include "trax/emulator.h"

struct trax_ray_cycles;
struct trax_run;
struct trax_watch;

struct trax_machine {
  struct trax_config config; /* a copy */
  struct trax_space space;
  uint32_t entry;       /* at which thread 0 starts */
  uint32_t other_entry; /* at which the others start */
  bool has_program;     /* trax_machine_set_entry was called */
  bool has_run;

  /* Owned by emulator/program: symbols, lines, buffers. Destroyed with the machine if not NULL. */
  void *loaded;
  void (*loaded_destroy)(void *loaded);

  struct trax_watch *watches; /* the first; NULL: none (machine/watch.h) */

  struct trax_host_calls calls; /* of the trap `host` */

  struct trax_observer *observer;   /* of the run; NULL: none (machine/observer.h) */
  struct trax_transfers *transfers; /* the same of transfers (machine/transfers.h) */

  /* Called before the first cycle if not NULL: may restore the state of another run (engine/engine.h). */
  trax_status (*prepare)(void *context, struct trax_run *run, trax_error *error);
  void *prepare_context;

  /* The outcome; valid after trax_machine_run. */
  trax_status status; /* of the run */
  bool at_limit;      /* TRAX_STUCK: max_cycles was reached; otherwise a watch ended the run */
  struct trax_fault fault;
  struct trax_stats stats;
  struct trax_tm_stats *tm_stats;     /* [tms] */
  struct trax_tp_stats *tp_stats;     /* [threads], by thread number */
  int32_t *exit_statuses;             /* [threads] */
  struct trax_ray_cycles *ray_cycles; /* NULL: not counted (machine/ray_cycles.h) */

  struct trax_slow_paths slow_paths;

  struct trax_run *run; /* from the beginning to the end of a run; else NULL */
  void (*run_destroy)(struct trax_machine *machine);
};

/* Makes [address, address + bytes) a segment of global memory; *host receives the address of its zeroed bytes. Errors:
   out of range, not 64-byte aligned, overlapping, both writable and executable, or after the run. */
trax_status trax_machine_map(struct trax_machine *machine, uint32_t address, uint32_t bytes, unsigned permissions,
                             uint8_t **host, trax_error *error);
/* Sets the address at which all threads start. Error: it is not a multiple of 4 in an executable segment. */
trax_status trax_machine_set_entry(struct trax_machine *machine, uint32_t entry, trax_error *error);

static inline uint32_t trax_machine_entry_of(const struct trax_machine *machine, uint32_t thread) {
  return thread ? machine->other_entry : machine->entry;
}

/* Adds the counts that follow from the operations issued. To be called once, at the run's end. */
void trax_stats_derive(struct trax_tm_stats *stats, const struct trax_config *config);
/* Between cycles, after trax_run_settle: sets total and instructions of *stats to the counts so far. */
void trax_stats_sum(const struct trax_machine *machine, struct trax_stats *stats);
/* After the run: sums up the TMs' statistics and checks that every thread is charged exactly once for every cycle.
   charged: the charges are exact; otherwise they are estimates, or there are none. Error: the check fails. */
trax_status trax_stats_collect(struct trax_machine *machine, bool charged, trax_error *error);

/* The fault that ended the run; its kind is TRAX_FAULT_NONE if there was none. */
const struct trax_fault *trax_machine_fault(const struct trax_machine *machine);

#endif
