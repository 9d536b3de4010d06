/* The timing emulator as a library. A machine runs one program once:

     trax_config *config = trax_config_create();             the default: one TP
     trax_config_preset(config, "4x32", &error);
     trax_config_set(config, "memory.bandwidth_gbps", "16", &error);
     trax_machine *machine = trax_machine_create(config, &error);
     trax_machine_load_elf(machine, "program", &error);
     trax_machine_bind(machine, "scene", bytes, size, &error);
     trax_machine_run(machine, &options, &error);
     trax_machine_read_buffer(machine, "image", ...);
     trax_stats_write_json(machine, "stats.json", &error);

   Functions return TRAX_OK, or another status with the reason in *error, which may be NULL. The library never exits,
   and prints only the guest's output, to options.output. */
#ifndef TRAX_EMULATOR_H
#define TRAX_EMULATOR_H

#include "trax/processors.h" /* trax_host_processors */
#include "trax/status.h"     /* trax_status, trax_error */

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#ifdef __cplusplus
extern "C" {
#endif

#pragma GCC visibility push(default) /* of the shared library */

/* --- configuration: trax_config_describe and docs/trax-sim.md list the keys --- */
typedef struct trax_config trax_config;

/* The defaults: 1 TM of 1 TP, everything else as in the paper. NULL: out of memory. */
trax_config *trax_config_create(void);
/* NULL: out of memory. */
trax_config *trax_config_copy(const trax_config *config);
void trax_config_destroy(trax_config *config);
/* Sets one of the presets by name ("1x32" ... "8x64"), or reads a libconfig file if there is no preset of that name.
   Errors: the file cannot be read, a syntax error, an unknown key, a value out of range. The message names file and
   line. */
trax_status trax_config_load(trax_config *config, const char *preset_or_path, trax_error *error);
/* Error: there is no preset of that name. */
trax_status trax_config_preset(trax_config *config, const char *name, trax_error *error);
/* Sets a key such as "memory.latency_cycles". Errors: an unknown key; a value of the wrong type or out of range, for
   which the message lists the allowed values. */
trax_status trax_config_set(trax_config *config, const char *key, const char *value, trax_error *error);
/* Checks the relations between keys; trax_machine_create calls it. */
trax_status trax_config_check(const trax_config *config, trax_error *error);
/* Prints every key, as a file that trax_config_load reads. */
void trax_config_print(const trax_config *config, FILE *out);
/* Prints every key's type, range, default, unit and meaning. */
void trax_config_describe(FILE *out);
/* The presets' names, ended by NULL. */
const char *const *trax_config_presets(void);
bool trax_config_is_preset(const char *name);
/* Print the names of all keys, and of all presets, with blanks between. */
void trax_config_list_keys(FILE *out);
void trax_config_list_presets(FILE *out);
/* Returns the value of a key, 0 or 1 for a flag, NaN if there is no such key. */
double trax_config_get(const trax_config *config, const char *key);
/* Returns the value of a key with words as values, such as "dcache.replacement", valid until the thread's next call.
   NULL: there is no such key. */
const char *trax_config_word(const trax_config *config, const char *key);
/* Returns the first key after `after` (NULL: of all) with another value than the default. NULL: there is none. */
const char *trax_config_next_change(const trax_config *config, const char *after);

/* --- machine --- */
typedef struct trax_machine trax_machine;

/* Copies config. NULL: the configuration is invalid, or out of memory. */
trax_machine *trax_machine_create(const trax_config *config, trax_error *error);
const trax_config *trax_machine_config(const trax_machine *machine);
/* machine may be NULL. */
void trax_machine_destroy(trax_machine *machine);
/* Loads the one program of the machine. Errors: the file is not a valid TRaX executable, the program does not fit into
   memory, or the machine already has a program. */
trax_status trax_machine_load_elf(trax_machine *machine, const char *path, trax_error *error);
/* Loads the bytes of such a file. path: for messages, and the program's name. */
trax_status trax_machine_load_bytes(trax_machine *machine, const char *path, const void *bytes, size_t size,
                                    trax_error *error);

/* Allocates `size` bytes of global memory, fills them with `bytes` (NULL: zeros), and stores address and size to the
   trax_buffer object named symbol (docs/abi.md, "Buffers"). Errors: no program, no such object, bound twice, memory too
   small, or after the run. */
trax_status trax_machine_bind(trax_machine *machine, const char *symbol, const void *bytes, uint32_t size,
                              trax_error *error);
trax_status trax_machine_bind_file(trax_machine *machine, const char *symbol, const char *path, trax_error *error);
/* Sets *bytes to the contents of a bound buffer, valid until the machine is destroyed. Error: no such buffer. */
trax_status trax_machine_read_buffer(trax_machine *machine, const char *symbol, const uint8_t **bytes, uint32_t *size,
                                     trax_error *error);

/* Gives main its arguments. The first is the program's name. Without this call main gets only that name, the name of
   the file. To be called before the run. Errors: there are others and main has no parameters; out of memory. */
trax_status trax_machine_set_arguments(trax_machine *machine, const char *const *arguments, size_t count,
                                       trax_error *error);
/* Allows the program to read and write files in a folder of the host, which it sees as `name`. Error: there is no such
   folder. */
trax_status trax_machine_allow(trax_machine *machine, const char *folder, const char *name, trax_error *error);
/* Lets only thread 0 call main; the others wait for trax_start_threads or, in a program without it, end. To be called
   before the run. Error: the program does not begin with the library's start code. */
trax_status trax_machine_main_on_thread_0(trax_machine *machine, trax_error *error);

/* Finds a bound buffer before the run, for a caller that computes addresses or fills it in place. */
trax_status trax_machine_buffer(trax_machine *machine, const char *symbol, uint32_t *address, uint8_t **bytes,
                                uint32_t *size, trax_error *error);
/* Finds a symbol of the program: its address and its size (0: unknown). False: there is none. */
bool trax_machine_find_symbol(const trax_machine *machine, const char *symbol, uint32_t *address, uint32_t *size);
/* Reads the ELF file that was loaded, up to the end that its headers give. Error: none is loaded. */
trax_status trax_machine_read_program(const trax_machine *machine, const uint8_t **bytes, size_t *size,
                                      trax_error *error);

typedef struct trax_progress {
  uint64_t cycle;
  uint64_t instructions;
  uint64_t items;                             /* reported by the program's "items" trap */
  uint64_t total_items;                       /* from the options; 0: unknown */
  uint64_t items_before, instructions_before; /* the part of them that was done before a resumed run */
  double host_seconds;                        /* wall time of the run so far */
} trax_progress;

#define TRAX_MAX_SLOT_QUEUES 64

/* Slot-sampled simulation (docs/sampling.md) estimates the run of a program whose threads take numbered pieces of work,
   called slots, by the atomic increment of a counter, until the number is `slots` or more. The program may have several
   queues of slots, each with its counter: queue q has the tiles q, q + queues, q + 2 * queues and so on, and a thread
   whose queue is empty goes on with another queue. A slot's place is the number of slots that all queues have handed
   out before it. A member that is 0 has its default. */
typedef struct trax_slot_sampling {
  uint32_t counter; /* address of the counter; of several, the first of consecutive words */
  uint32_t slots;   /* number of slots; with several queues a multiple of `tile` */
  uint32_t queues;  /* at most TRAX_MAX_SLOT_QUEUES */
  uint32_t tile;    /* slots of a tile; unused with one queue */
  double fraction;  /* the part of the slots to simulate, above 0 to 1; 1: the exact run */
  double error;     /* instead of fraction: the wanted half width of the 95 % interval, relative to the estimate */
  uint32_t unit;    /* slots of a measured range */
  uint32_t warm_up; /* slots before a range that are simulated but not measured */
  uint64_t seed;    /* of the choice of ranges */
  /* Predicted costs of the slots, in any unit: [slots / block rounded up + 1], the sums of the costs before each block,
     then the sum of all. NULL: all slots cost the same. A bad prediction widens the interval, but does not
     invalidate it. */
  const double *costs;
  uint32_t block; /* slots of a block, of which `unit` is a multiple */
  /* [as costs][queues]: the predicted number of slots that each queue has handed out at the beginning of each block.
     NULL: the queues advance at the same rate. */
  const uint32_t *handed_out;
  uint64_t rays, items;  /* the totals that the whole program reports; 0: unknown, to be estimated */
  const uint64_t *kinds; /* [kinds of rays, in the order of the statistics]: whose sum `rays` is; NULL: unknown */
} trax_slot_sampling;

typedef struct trax_run_options {
  FILE *output;                                                 /* guest output; NULL discards it */
  FILE *input;                                                  /* of trax_host_calls; read past stdio; NULL: empty */
  FILE *errors;                                                 /* standard error of these; NULL: output */
  uint64_t max_cycles;                                          /* 0: no limit */
  uint64_t total_items;                                         /* for progress */
  void (*progress)(void *context, const trax_progress *status); /* about ten times a second; may be NULL */
  void *progress_context;
  const volatile int *interrupt; /* polled; nonzero stops the run; may be NULL; may point to a sig_atomic_t */
  /* "fast", "reference", "functional" or "simt". NULL: simt if simt.width is more than 1, else fast. The first two have
     the same results: every cycle, count and byte. The reference engine is docs/timing.md as a program and many times
     slower; simt is docs/simt.md. The functional engine simulates no time: its cycles are 0, and max_cycles limits the
     instructions of each thread. "fast-any" is the fast engine without AVX2. */
  const char *engine;
  unsigned host_threads; /* of the fast engine; results do not depend on their number; 0: trax_host_processors */
  const trax_slot_sampling *slots; /* NULL: everything is simulated */
  bool ray_cycles;                 /* also counts the thread-cycles of the rays of each kind (engines fast, simt) */
} trax_run_options;

/* Runs the program to its end; options may be NULL. Returns TRAX_ERROR without a program, for a second run and for bad
   options, TRAX_FAULT after a fault of the program, TRAX_STUCK if max_cycles was reached, TRAX_INTERRUPTED if
   *interrupt became nonzero. */
trax_status trax_machine_run(trax_machine *machine, const trax_run_options *options, trax_error *error);

/* --- a run in parts: the same cycles, counts and bytes as in one --- */
/* trax_machine_run is trax_machine_begin followed by trax_machine_advance(machine, UINT64_MAX, ...). All that the
   options point to must stay valid until the run has ended. */
trax_status trax_machine_begin(trax_machine *machine, const trax_run_options *options, trax_error *error);
/* Runs until all cycles before `cycle` are over. If *ended, the run has ended, and the status is that of
   trax_machine_run; otherwise the status is TRAX_OK, and the run can be continued. The functional engine, which has no
   cycles, runs to its end. */
trax_status trax_machine_advance(trax_machine *machine, uint64_t cycle, bool *ended, trax_error *error);

/* A callback between cycles: all cycles before `cycle` are over. It sets *next to the cycle before which it is called
   again, UINT64_MAX for never. If it returns false, the run ends with TRAX_INTERRUPTED. */
typedef bool trax_look(void *context, trax_machine *machine, uint64_t cycle, uint64_t *next);
/* Adds a callback, first called before cycle `cycle`, or at the run's beginning if later. Error: out of memory. */
trax_status trax_machine_look(trax_machine *machine, uint64_t cycle, trax_look *look, void *context, trax_error *error);

/* Between cycles (after trax_machine_advance, and in a trax_look), these functions and the statistics below return the
   state at that time. */
uint64_t trax_machine_cycle(const trax_machine *machine); /* the next cycle; after the run, its length in cycles */
/* Reads registers r0 to r31 and the pc of thread TM * TPs + TP. Errors: no run is under way, no such thread. */
trax_status trax_machine_read_registers(const trax_machine *machine, uint32_t thread, uint32_t registers[32],
                                        uint32_t *pc, trax_error *error);
/* Sets *bytes and *size to an object of the program, by its symbol, at any time; valid until the machine is destroyed.
   Errors: no such symbol, or it is not in global memory. */
trax_status trax_machine_read_symbol(const trax_machine *machine, const char *symbol, const uint8_t **bytes,
                                     uint32_t *size, trax_error *error);

/* 1 after a fault, 134 after an abort; otherwise the first exit status of a thread, in the order of threads, that is
   not 0, or 0. */
int trax_machine_exit_status(const trax_machine *machine);
/* A signature is the result that a conformance test compares (docs/isa.md, "Signatures"): the words from the symbol
   begin_signature to end_signature, eight hexadecimal digits a line, and the fault that ended the run. The first
   function checks, before the run, that the program has both symbols; the second writes the file, which appears only
   when it is complete. */
trax_status trax_machine_check_signature(const trax_machine *machine, trax_error *error);
trax_status trax_machine_write_signature(const trax_machine *machine, const char *path, trax_error *error);
/* Prints the fault that ended the run: address, instruction, symbol, source line, thread, TM, cycle, registers. Prints
   nothing if there was none. */
void trax_machine_print_fault(const trax_machine *machine, FILE *out);

/* --- statistics: declared once in emulator/machine/stats.h; names are stable --- */
/* Reads a figure by its JSON name ("cycles", "mrps", "dcache.hits"; of a sampled run also "sampled.cycles_low",
   "cycles_high", "windows", "slots", "detailed_slots", "predicted_cycles"). False: there is none of that name. */
bool trax_stats_get(const trax_machine *machine, const char *name, double *value);
/* The name of a cause of thread-cycles, by number: 0 is "issued", the last is "halted", and NULL follows. */
const char *trax_stats_cause(unsigned number);
/* Prints all statistics as text. */
void trax_stats_print(const trax_machine *machine, FILE *out);
/* Writes all statistics as JSON. path "-" is standard output; a file appears only when it is complete. */
trax_status trax_stats_write_json(const trax_machine *machine, const char *path, trax_error *error);
/* Writes the same to a stream; without what the simulation took of the host unless `host`. */
trax_status trax_stats_put_json(const trax_machine *machine, bool host, FILE *out, trax_error *error);
/* After a run with ray_cycles: writes the thread-cycles of the rays of each kind by cause, as CSV. After a sampled run
   these are estimates, and the parts that were simulated follow (docs/explaining.md). A file appears only when it is
   complete. */
trax_status trax_ray_cycles_write(const trax_machine *machine, const char *path, trax_error *error);
/* Prints name, unit and meaning of every member of the JSON. */
void trax_stats_describe(FILE *out);

#pragma GCC visibility pop

#ifdef __cplusplus
}
#endif
#endif
