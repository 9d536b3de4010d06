/* The timing emulator as a library. One machine runs one program once:

     trax_config *config = trax_config_create();             the default: one TP
     trax_config_preset(config, "4x32", &error);
     trax_config_set(config, "memory.bandwidth_gbps", "16", &error);
     trax_machine *machine = trax_machine_create(config, &error);
     trax_machine_load_elf(machine, "program", &error);
     trax_machine_bind(machine, "scene", bytes, size, &error);
     trax_machine_run(machine, &options, &error);
     trax_machine_read_buffer(machine, "image", ...);
     trax_stats_write_json(machine, "stats.json", &error);

   Functions return TRAX_OK, or another status with the reason in *error; the library never exits and prints nothing but
   what the guest prints through options.output. */
#ifndef TRAX_EMULATOR_H
#define TRAX_EMULATOR_H

#include "trax/processors.h" /* trax_host_processors */
#include "trax/status.h" /* trax_status, trax_error */

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#ifdef __cplusplus
extern "C" {
#endif

/* --- configuration: emulator/host/config.c; keys are listed by trax_config_describe and in docs/emulator.md --- */
typedef struct trax_config trax_config;

trax_config *trax_config_create(void); /* 1 TM of 1 TP, everything else as in the paper */
void trax_config_destroy(trax_config *config);
/* One of the paper's fifteen chips by name ("1x32" ... "8x64"), or a libconfig file if the name is none of them. */
trax_status trax_config_load(trax_config *config, const char *preset_or_path, trax_error *error);
trax_status trax_config_preset(trax_config *config, const char *name, trax_error *error);
/* key as "memory.latency_cycles"; the value is checked for type and range, the message says what is allowed. */
trax_status trax_config_set(trax_config *config, const char *key, const char *value, trax_error *error);
/* Checks that hold between keys; trax_machine_create calls it. */
trax_status trax_config_check(const trax_config *config, trax_error *error);
void trax_config_print(const trax_config *config, FILE *out); /* a file that trax_config_load reads back */
void trax_config_describe(FILE *out);                         /* every key: type, range, default, unit, meaning */
const char *const *trax_config_presets(void);                 /* NULL-terminated */
bool trax_config_is_preset(const char *name);

/* --- machine --- */
typedef struct trax_machine trax_machine;

trax_machine *trax_machine_create(const trax_config *config, trax_error *error); /* copies config */
void trax_machine_destroy(trax_machine *machine);
trax_status trax_machine_load_elf(trax_machine *machine, const char *path, trax_error *error);

/* Fills the trax_buffer object called symbol (docs/abi.md). bytes may be NULL for zeros. */
trax_status trax_machine_bind(trax_machine *machine, const char *symbol, const void *bytes, uint32_t size,
                              trax_error *error);
trax_status trax_machine_bind_file(trax_machine *machine, const char *symbol, const char *path, trax_error *error);
/* The bytes of a bound buffer, valid until the machine is destroyed. */
trax_status trax_machine_read_buffer(trax_machine *machine, const char *symbol, const uint8_t **bytes, uint32_t *size,
                                     trax_error *error);

typedef struct trax_progress {
  uint64_t cycle;
  uint64_t instructions;
  uint64_t items;                             /* counted by the program's "items" trap */
  uint64_t total_items;                       /* from options; 0 if unknown */
  uint64_t items_before, instructions_before; /* of these, what was done before a run that was resumed */
  double host_seconds;
} trax_progress;

#define TRAX_MAX_SLOT_QUEUES 64

/* Slot-sampled simulation (docs/emulator.md): for a program whose threads take numbered pieces of work, slots, by the
   atomic increment of one word, until the number is `slots` or more; or from several queues, each with its word, of
   which queue q has every tile q, q + queues, q + 2 * queues and so on, and a thread whose queue is empty goes on with
   another one. A slot's place is then how many the queues have handed out together. 0 is the default. */
typedef struct trax_slot_sampling {
  uint32_t counter; /* address of the word, of the first one of several */
  uint32_t slots;   /* how many there are; of several queues whole tiles */
  uint32_t queues;  /* at most TRAX_MAX_SLOT_QUEUES */
  uint32_t tile;    /* slots of a tile; of one queue without meaning */
  double fraction;  /* of the slots that is simulated, above 0 to 1; 1: the exact run */
  double error;     /* instead: half of the 95 % interval wanted, relative to the estimate */
  uint32_t unit;    /* slots of a range that is measured */
  uint32_t warm_up; /* slots before it that are simulated but not measured */
  uint64_t seed;    /* of the choice of ranges */
  /* What is known or guessed of the slots' costs: [slots / block rounded up + 1], sums of all before each block and of
     all, in any unit. NULL: all are alike. A bad guess makes intervals wide, not wrong. */
  const double *costs;
  uint32_t block; /* slots of a block; the unit is a multiple of it */
  /* [as costs, times queues]: how many slots each queue is thought to have handed out where a block begins. NULL: they
     keep step. */
  const uint32_t *handed_out;
  uint64_t rays, items; /* what the whole program will report; 0: not known, to be estimated */
} trax_slot_sampling;

typedef struct trax_run_options {
  FILE *output;                                                 /* guest output; NULL discards it */
  uint64_t max_cycles;                                          /* 0: no limit */
  uint64_t total_items;                                         /* for progress */
  void (*progress)(void *context, const trax_progress *status); /* about ten times a second; may be NULL */
  void *progress_context;
  const volatile int *interrupt; /* polled; may be NULL (a signal handler's sig_atomic_t fits) */
  /* "fast" (NULL), "reference" or "functional". The first two give the same: every cycle, every count, every byte; the
     reference is written to be read beside docs/timing.md, and many times slower. The third knows no time: its cycles
     are 0, and max_cycles limits the instructions of a thread. "fast-any", "fast-avx2" and "fast-avx512" are the fast
     engine as it is compiled for some hosts. */
  const char *engine;
  unsigned host_threads;           /* of the fast engine, whose results they do not change; 0: trax_host_processors */
  const trax_slot_sampling *slots; /* NULL: everything is simulated */
} trax_run_options;

/* Runs the program to its end; options may be NULL. Errors: no program, a second run, a fault of the program (TRAX_FAULT),
   max_cycles passed (TRAX_STUCK), an interrupt (TRAX_INTERRUPTED). */
trax_status trax_machine_run(trax_machine *machine, const trax_run_options *options, trax_error *error);

/* --- a run in parts: the same cycles, counts and bytes as in one --- */
/* trax_machine_run is trax_machine_begin and trax_machine_advance(machine, UINT64_MAX, ...). What pointers in the options
   lead to must outlive the run. */
trax_status trax_machine_begin(trax_machine *machine, const trax_run_options *options, trax_error *error);
/* Goes on until all cycles before `cycle` are over. *ended: the run is over, and the result is that of trax_machine_run;
   else it is TRAX_OK, and the run can go on. The functional engine, which has no cycles, runs to its end. */
trax_status trax_machine_advance(trax_machine *machine, uint64_t cycle, bool *ended, trax_error *error);

/* Whoever looks at a machine between cycles: all cycles before `cycle` are over. *next receives the cycle before which it
   looks again, UINT64_MAX for never. False ends the run with TRAX_INTERRUPTED. */
typedef bool trax_look(void *context, trax_machine *machine, uint64_t cycle, uint64_t *next);
/* From now on look is called, for the first time before cycle `cycle` or when the run begins. Error: out of memory. */
trax_status trax_machine_look(trax_machine *machine, uint64_t cycle, trax_look *look, void *context, trax_error *error);

/* While a run is between cycles (after trax_machine_advance, and in a trax_look) these tell what is so then; statistics
   (below) too. */
uint64_t trax_machine_cycle(const trax_machine *machine); /* the next one; of a run that has ended: its length */
/* Registers r0 to r31 and pc of a thread, TM * TPs + TP. Errors: no run under way, no such thread. */
trax_status trax_machine_read_registers(const trax_machine *machine, uint32_t thread, uint32_t registers[32],
                                        uint32_t *pc, trax_error *error);
/* The bytes of an object of the program by its symbol, at any time, valid until the machine is destroyed. Errors: no such
   symbol, or one that is not in global memory. */
trax_status trax_machine_read_symbol(const trax_machine *machine, const char *symbol, const uint8_t **bytes,
                                     uint32_t *size, trax_error *error);

int trax_machine_exit_status(const trax_machine *machine);
/* What a conformance test compares (docs/isa.md, "Signatures"): the words from the symbol begin_signature to
   end_signature as eight hexadecimal digits a line, and the fault that ended the run. The first asks, before the run,
   whether the program has the two; the second writes path, which appears only when it is complete. */
trax_status trax_machine_check_signature(const trax_machine *machine, trax_error *error);
trax_status trax_machine_write_signature(const trax_machine *machine, const char *path, trax_error *error);
/* The report of the fault that ended the run: address, instruction, symbol, source line, thread, TM, cycle, registers.
 */
void trax_machine_print_fault(const trax_machine *machine, FILE *out);

/* --- statistics: declared once in emulator/machine/stats.h; names are stable --- */
/* A single figure by its JSON name ("cycles", "mrps", "dcache.hits"); false if there is none of that name. */
bool trax_stats_get(const trax_machine *machine, const char *name, double *value);
void trax_stats_print(const trax_machine *machine, FILE *out);
/* path "-" is standard output; a file appears only when it is complete. */
trax_status trax_stats_write_json(const trax_machine *machine, const char *path, trax_error *error);
void trax_stats_describe(FILE *out); /* every member of the JSON: name, unit, meaning */

#ifdef __cplusplus
}
#endif
#endif
