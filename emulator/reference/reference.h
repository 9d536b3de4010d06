/* The machine of docs/timing.md. Each chapter of that page is a file of this folder, and the names here are its nouns.

   Every TP is visited in every step of every cycle and charged in the step that refuses it. No TP sleeps, no cycle is
   skipped, and nothing is stored that can be looked up. TPs, TMs, banks and units are numbered from 0; cycles are
   uint64_t and called t. The reference shares with the other engines only what the page does not describe: the
   configuration, the instructions' semantics, global memory and its permissions, the record of a fault, the names of
   the statistics. */
#ifndef TRAX_REFERENCE_H
#define TRAX_REFERENCE_H

#include "dram/dram.h"
#include "machine/machine.h"
#include "machine/timing.h"
#include "trax/isa.h"

#include <assert.h>

enum { MOST = 64 }; /* the configuration's limit of TMs, TPs of a TM, banks and units */

#define UNKNOWN UINT64_MAX /* an arrival or completion whose cycle is not known yet */

/* --- Words --- */

/* The pointer of an arbiter. */
typedef uint32_t trax_ref_pointer;

/* Round robin over positions 0..n-1: returns the winner among those that ask and moves the pointer past it; -1: none
   asks. */
int trax_ref_arbitrate(trax_ref_pointer *pointer, const bool *asks, uint32_t n);

/* --- The machine --- */

/* The lines a cache holds (Fetch, Data cache). */
struct trax_ref_lines {
  uint32_t line_bytes, ways, sets;
  enum trax_replacement policy;
  struct trax_ref_line {
    bool present;
    uint32_t number;
    uint64_t used;   /* the number of its latest use, from `uses` */
  } *line;           /* [sets][ways] */
  uint32_t *pointer; /* [sets]: the way of the next arriving line, if first in, first out */
  uint64_t uses;     /* number of uses of any line so far */
};

struct trax_ref_icache {
  struct trax_ref_lines lines;
  trax_ref_pointer bank[MOST]; /* over the cache's TPs */
};

typedef enum trax_ref_kind { INSTRUCTION_LINE, DATA_LINE, LOAD_PAST_CACHE, WRITE, ATOMIC } trax_ref_kind;

struct trax_ref_request {
  trax_ref_kind kind;
  uint32_t bytes;
  uint32_t address;
  uint32_t tm;
  uint32_t icache, line; /* lines; icache: INSTRUCTION_LINE only */
  uint32_t tp;           /* LOAD_PAST_CACHE, WRITE, ATOMIC: the TP that made it */
  uint32_t rd;           /* LOAD_PAST_CACHE, ATOMIC: the register that waits */
  bool passing;          /* DATA_LINE: it does not enter the cache */
  uint32_t old_value;    /* ATOMIC */
  uint32_t channel;
  /* AT_BANK: it waits for its second-level bank; AT_CHANNEL: for its channel; IN_DRAM: in a queue of the DRAM */
  enum { AT_BANK, AT_CHANNEL, IN_DRAM, SERVED } stage;
  uint64_t came;       /* AT_CHANNEL, with a second-level cache, and IN_DRAM: its number of trax_ref_controller.came */
  uint32_t l2_line;    /* SERVED by a second-level line that is on its way: the line's number */
  uint64_t completion; /* SERVED: the cycle, UNKNOWN until the arrival of l2_line is known */
};

/* A register in the scoreboard (Operands). */
struct trax_ref_register {
  uint64_t usable;  /* the cycle from which it is usable; UNKNOWN until the arrival */
  trax_cause cause; /* of a wait for it */
  uint32_t line;    /* of the data cache, if it waits for one (awaits_data) */
};

struct trax_ref_tp {
  uint32_t number;
  uint32_t pc, reg[TRAX_NUM_REGISTERS];
  struct trax_ref_register scoreboard[TRAX_NUM_REGISTERS];
  uint32_t awaits_data; /* registers that wait for lines of the data cache, as a set */
  uint8_t local[TRAX_LOCAL_SIZE];
  uint32_t run_begin, run_end; /* the run in the write-combining buffer; equal: empty */

  bool holds; /* it holds an instruction, inst */
  trax_inst inst;
  uint32_t address; /* of its memory access, from step 2 on */
  uint8_t outcome;  /* of that access, for an observer: TRAX_OUTCOME_... */

  bool ended;
  bool awaits_line;     /* it waits for a line of its instruction cache */
  uint64_t bubble_ends; /* the first cycle after the latest branch bubble */

  bool charged; /* for this cycle: it does nothing in the later steps */
};

/* A group of TPs that share units of a kind (Units). */
struct trax_ref_group {
  trax_ref_pointer pointer;
  uint64_t free_from[MOST]; /* by unit */
};

struct trax_ref_tm {
  uint32_t number, tps;
  const struct trax_config *config;
  struct trax_machine *machine;
  FILE *output;                             /* the guest's, or NULL */
  struct trax_timing timing[TRAX_OP_COUNT]; /* as of trax_timing_of */
  struct trax_shared_kind kind[TRAX_SHARED_COUNT];
  struct trax_ref_tp tp[MOST];
  struct trax_ref_icache icache[MOST];
  struct trax_ref_group group[TRAX_SHARED_COUNT][MOST];
  struct trax_ref_lines dcache;
  trax_ref_pointer dcache_bank[MOST];
  uint64_t dcache_fills_end[MOST]; /* by bank */
  struct trax_ref_request *queue;  /* [places], the oldest first */
  uint32_t places;                 /* number of places taken */
  trax_ref_pointer queue_pointer;
  struct trax_tm_stats *stats;
};

/* The second-level cache. All members are 0 without one. */
struct trax_ref_l2 {
  struct trax_ref_lines lines;
  trax_ref_pointer bank[MOST]; /* over the TMs */
  struct trax_ref_miss {
    uint32_t line, channel;
    uint64_t came;    /* as trax_ref_request.came */
    uint64_t arrival; /* UNKNOWN while it waits for its channel or in a queue of the DRAM */
    uint64_t begun;   /* transfers of lines that had begun before its own */
    bool in_dram;     /* it is or has been in one */
  } *miss;            /* [misses]: the miss registers in use */
  uint32_t misses;
  uint64_t begun; /* transfers of lines that have begun */
};

/* Bus time is counted in units: a cycle has units_per_cycle of them, and a byte takes units_per_byte. A cycle may have
   10^9 units, so 64 bits would overflow after some 10^10 cycles. */
__extension__ typedef unsigned __int128 trax_ref_units;

struct trax_ref_controller {
  uint64_t units_per_cycle, units_per_byte;
  struct trax_ref_channel {
    trax_ref_units free_from; /* f */
    trax_ref_pointer pointer; /* over the TMs */
    uint64_t unit_free_from;  /* of the increment unit */
  } channel[MOST];
  uint64_t came;          /* number of requests that have come to any channel or the DRAM so far */
  struct trax_dram *dram; /* NULL unless memory.model is dram */
};

struct trax_ref_chip {
  struct trax_machine *machine;
  struct trax_ref_tm *tm; /* [tms] */
  uint32_t tms;
  const struct trax_config *config;
  struct trax_memory_stats *stats;
  struct trax_ref_l2 l2;
  struct trax_ref_controller controller;
};

/* --- What an instruction is --- */

static inline const trax_op_info *trax_ref_info(const struct trax_ref_tp *tp) {
  return &trax_op_table[tp->inst.op];
}

static inline bool trax_ref_is(const struct trax_ref_tp *tp, unsigned flag) {
  return (trax_ref_info(tp)->flags & flag) != 0;
}

/* Whether the TP holds an instruction that no step of this cycle has refused so far. */
static inline bool trax_ref_active(const struct trax_ref_tp *tp) {
  return tp->holds && !tp->charged;
}

static inline bool trax_ref_accesses_memory(const struct trax_ref_tp *tp) {
  return trax_ref_info(tp)->unit == TRAX_UNIT_MEMORY;
}

/* Whether the instruction accesses local memory; its address must be known. An increment of local memory faults. */
static inline bool trax_ref_accesses_local(const struct trax_ref_tp *tp) {
  return trax_ref_accesses_memory(tp) && tp->address >= TRAX_LOCAL_BASE && !trax_ref_is(tp, TRAX_IS_ATOMIC);
}

/* The timing of an instruction that does not access memory. */
static inline const struct trax_timing *trax_ref_timing(const struct trax_ref_tm *tm, const struct trax_ref_tp *tp) {
  return &tm->timing[tp->inst.op];
}

/* halt and the exit trap. */
static inline bool trax_ref_ends_thread(const struct trax_ref_tp *tp) {
  return tp->inst.op == TRAX_OP_HALT || (tp->inst.op == TRAX_OP_TRAP && tp->inst.imm == TRAX_TRAP_EXIT);
}

/* fence r, w or rw. `kinds`: TRAX_FENCE_... */
static inline bool trax_ref_fences(const struct trax_ref_tp *tp, unsigned kinds) {
  return tp->inst.op == TRAX_OP_FENCE && ((unsigned)tp->inst.imm & kinds) != 0;
}

/* --- Start and end: run.c --- */
/* False: out of memory. The chip must be destroyed after that, too. */
bool trax_ref_create(struct trax_ref_chip *chip, struct trax_machine *machine, FILE *output);
void trax_ref_destroy(struct trax_ref_chip *chip);
/* Whether the run has ended: every thread has ended, no request waits, and the buses are idle. */
bool trax_ref_is_over(const struct trax_ref_chip *chip, uint64_t t);

/* --- Fetch: fetch.c, lines.c --- */
void trax_ref_fetch(struct trax_ref_tm *tm, uint64_t t);
/* Looks up the line of a TP that won its bank. True: it is there. False: the TP awaits the line, or is charged. */
bool trax_ref_look_up(struct trax_ref_tm *tm, struct trax_ref_tp *tp, uint64_t t);
void trax_ref_instruction_arrives(struct trax_ref_tm *tm, uint32_t icache, uint32_t line);

bool trax_ref_lines_create(struct trax_ref_lines *lines, uint32_t bytes, uint32_t line_bytes, uint32_t ways,
                           enum trax_replacement policy);
void trax_ref_lines_destroy(struct trax_ref_lines *lines);
/* Whether the line is present. */
bool trax_ref_lines_have(const struct trax_ref_lines *lines, uint32_t line);
/* The same, and counts as a use of the line. */
bool trax_ref_lines_use(struct trax_ref_lines *lines, uint32_t line);
/* Enters an arriving line into the cache. */
void trax_ref_lines_install(struct trax_ref_lines *lines, uint32_t line);
/* Drops all lines and returns their number. */
uint32_t trax_ref_lines_drop(struct trax_ref_lines *lines);

/* --- Operands: operands.c --- */
void trax_ref_check_operands(struct trax_ref_tm *tm, uint64_t t);
/* Charges a TP for the first register that is not usable, and returns it; 0: there is none. */
unsigned trax_ref_wait_for_registers(struct trax_ref_tm *tm, struct trax_ref_tp *tp, uint64_t t);
/* Computes the address of a memory access. A TP whose access is not allowed faults. */
void trax_ref_find_address(struct trax_ref_tm *tm, struct trax_ref_tp *tp, uint64_t t);
/* The destination register of the TP's instruction is usable from `cycle` on. */
void trax_ref_result(struct trax_ref_tp *tp, uint64_t cycle, trax_cause cause);

/* --- Units: units.c --- */
void trax_ref_grant_units(struct trax_ref_tm *tm, uint64_t t);

/* --- Data cache: data_cache.c --- */
void trax_ref_grant_data_banks(struct trax_ref_tm *tm, uint64_t t);
bool trax_ref_asks_for_bank(const struct trax_ref_tp *tp);
uint32_t trax_ref_data_banks(const struct trax_ref_tm *tm);
/* Serves a load in step 4. False: it needs a place or a miss register and gets none. */
bool trax_ref_load(struct trax_ref_tm *tm, struct trax_ref_tp *tp, uint64_t t);
void trax_ref_data_arrives(struct trax_ref_tm *tm, const struct trax_ref_request *request, uint64_t t);

/* --- Stores and write combining: stores.c. False: it needs a place and gets none. --- */
bool trax_ref_store(struct trax_ref_tm *tm, struct trax_ref_tp *tp);
/* Writes the run in the buffer, if there is one. */
bool trax_ref_write_run(struct trax_ref_tm *tm, struct trax_ref_tp *tp);

/* --- Memory queue: queue.c --- */
void trax_ref_arrivals(struct trax_ref_tm *tm, uint64_t t);
void trax_ref_grant_places(struct trax_ref_tm *tm, uint64_t t);
/* The turn of an active TP. */
void trax_ref_take_turn(struct trax_ref_tm *tm, struct trax_ref_tp *tp, uint64_t t);
/* Takes a place for the request. False: there is none. */
bool trax_ref_request(struct trax_ref_tm *tm, struct trax_ref_request request);
/* The number of lines of that kind that are on their way. */
uint32_t trax_ref_lines_on_their_way(const struct trax_ref_tm *tm, trax_ref_kind kind);
/* The request for a line that is on its way; NULL: there is none. */
const struct trax_ref_request *trax_ref_on_its_way(const struct trax_ref_tm *tm, trax_ref_kind kind, uint32_t icache,
                                                   uint32_t line);

/* The TM's oldest request that waits for that bank or channel; NULL: there is none. */
struct trax_ref_request *trax_ref_oldest_at_bank(struct trax_ref_tm *tm, uint32_t bank);
struct trax_ref_request *trax_ref_oldest_at_channel(struct trax_ref_tm *tm, uint32_t channel);

/* --- Fences: fences.c --- */
/* Whether the TP's fence must wait for requests of the TP. */
bool trax_ref_fence_waits(const struct trax_ref_tm *tm, const struct trax_ref_tp *tp);
/* Performs the effect of a fence at its issue. */
void trax_ref_fence(struct trax_ref_tm *tm, const struct trax_ref_tp *tp);

/* --- Second-level cache: l2.c --- */
bool trax_ref_l2_create(struct trax_ref_l2 *l2, const struct trax_config *config);
void trax_ref_l2_destroy(struct trax_ref_l2 *l2);
void trax_ref_l2_cycle(struct trax_ref_chip *chip, uint64_t t);
uint32_t trax_ref_bank_of(const struct trax_config *config, uint32_t address);
/* The cost of a line's transfer, in bytes. */
uint32_t trax_ref_l2_line_cost(const struct trax_config *config);
/* The transfer of a line has begun; the line arrives in the cycle `arrival`. */
void trax_ref_l2_started(struct trax_ref_chip *chip, struct trax_ref_miss *miss, uint64_t arrival);

/* --- Memory controller: controller.c --- */
bool trax_ref_controller_create(struct trax_ref_controller *controller, const struct trax_config *config,
                                struct trax_memory_stats *stats);
/* With DRAM: dram.c. */
void trax_ref_serve_dram(struct trax_ref_chip *chip, uint32_t channel, uint64_t t);
/* Performs an atomic increment whose transfer is over in cycle `over`. Returns the cycle in which the channel's unit
   has done it. */
uint64_t trax_ref_increment(struct trax_ref_chip *chip, struct trax_ref_request *request, uint64_t over);
/* The request or the miss that came to the channel first and waits for it. False: there is none. */
bool trax_ref_first_at_channel(struct trax_ref_chip *chip, uint32_t channel, struct trax_ref_request **request,
                               struct trax_ref_miss **miss);
void trax_ref_controller_cycle(struct trax_ref_chip *chip, uint64_t t);
uint32_t trax_ref_channel_of(const struct trax_config *config, uint32_t address);
/* Whether all buses are idle in cycle t. */
bool trax_ref_buses_idle(const struct trax_ref_chip *chip, uint64_t t);

/* --- Issue, step 5: issue.c --- */
void trax_ref_issue(struct trax_ref_tm *tm, uint64_t t);
/* The issue of an active TP. */
void trax_ref_issue_of(struct trax_ref_tm *tm, struct trax_ref_tp *tp, uint64_t t);

/* --- Faults: faults.c --- */
/* Ends the thread in cycle t with a fault, which is recorded if it is the cycle's first in (TM, TP) order. */
void trax_ref_fault(struct trax_ref_tm *tm, struct trax_ref_tp *tp, uint64_t t, trax_fault_kind kind, uint32_t address);
/* Checks the access of the TP's instruction to its address. */
trax_fault_kind trax_ref_check_access(const struct trax_ref_tm *tm, const struct trax_ref_tp *tp);
/* Reads the word at pc if it is text, else returns the fault of a fetch from there. */
trax_fault_kind trax_ref_text(const struct trax_ref_tm *tm, uint32_t pc, uint32_t *word);

/* --- For an observer (machine/observer.h): observe.c --- */
/* rd: the register that the TP waits for; 0: none. */
void trax_ref_notify_charge(const struct trax_ref_tm *tm, const struct trax_ref_tp *tp, uint64_t t, trax_cause cause,
                            unsigned rd);
/* The TP has issued the instruction at pc. */
void trax_ref_notify_issue(const struct trax_ref_tm *tm, const struct trax_ref_tp *tp, uint32_t pc, uint64_t t);
void trax_ref_notify_arrival(const struct trax_ref_tm *tm, const struct trax_ref_request *atomic, uint64_t t);
/* The channel takes a request, or a miss of the second-level cache (machine/transfers.h). */
void trax_ref_notify_request(const struct trax_ref_chip *chip, const struct trax_ref_request *request, uint64_t t);
void trax_ref_notify_miss(const struct trax_ref_chip *chip, const struct trax_ref_miss *miss, uint64_t t);

/* --- Accounting: accounting.c --- */

/* Charges the TP for cycle t. At most one call per cycle. rd: the register that it waits for; 0: none. */
static inline void trax_ref_charge_of(struct trax_ref_tm *tm, struct trax_ref_tp *tp, uint64_t t, trax_cause cause,
                                      unsigned rd) {
  assert(!tp->charged);
  tp->charged = true;
  tm->machine->tp_stats[tm->number * tm->tps + tp->number].cycles[cause]++;
  if (tm->machine->observer)
    trax_ref_notify_charge(tm, tp, t, cause, rd);
}

static inline void trax_ref_charge(struct trax_ref_tm *tm, struct trax_ref_tp *tp, uint64_t t, trax_cause cause) {
  trax_ref_charge_of(tm, tp, t, cause, 0);
}

/* Charges a TP that waits for a register. */
static inline void trax_ref_charge_wait(struct trax_ref_tm *tm, struct trax_ref_tp *tp, uint64_t t, unsigned rd) {
  trax_ref_charge_of(tm, tp, t, tp->scoreboard[rd].cause, rd);
}

/* Charges the TPs that are idle because they have ended or are in a branch bubble. */
void trax_ref_charge_idle(struct trax_ref_tm *tm, uint64_t t);

#endif
