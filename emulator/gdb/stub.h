/* The parts of the stub: stub.c runs and stops, breaks.c knows where, commands.c answers packets, target.c gives
   threads, registers and memory, imagine.c tells where a thread will go, monitor.c has what GDB has no words for. */
#ifndef TRAX_GDB_STUB_H
#define TRAX_GDB_STUB_H

#include "engine/run.h"
#include "gdb/gdb.h"

enum { TRAX_GDB_BREAKS = 4096, TRAX_GDB_WATCHES = 64 }; /* at most */

/* Signals by GDB's numbers. */
enum trax_gdb_signal {
  TRAX_GDB_SIGINT = 2,
  TRAX_GDB_SIGILL = 4,
  TRAX_GDB_SIGTRAP = 5,
  TRAX_GDB_SIGABRT = 6,
  TRAX_GDB_SIGBUS = 10,
  TRAX_GDB_SIGSEGV = 11,
  TRAX_GDB_SIGXCPU = 24
};

/* What a thread may stop for. */
enum { TRAX_GDB_STEPPED = 1, TRAX_GDB_AT_BREAK = 2, TRAX_GDB_ACCESSED = 4 };

struct trax_gdb_thread {
  bool told;      /* the debugger knows of it at this pc: a breakpoint here is not hit again before it has issued */
  bool stepping;  /* stops when it has issued an instruction, and is outside the range */
  uint8_t events; /* of TRAX_GDB_STEPPED ... */
  uint8_t
      passed;  /* the debugger has seen it behind so many of its next instructions: it is told of no breakpoint there */
  char access; /* of TRAX_GDB_ACCESSED: the watchpoint's type */
  uint32_t accessed;
};

struct trax_gdb_break {
  uint32_t address;
  bool removed; /* since the run was last resumed */
};

struct trax_gdb_watch {
  char type; /* 2 write, 3 read, 4 access, as in the packet */
  uint32_t address, bytes;
  uint32_t thread; /* whose local memory */
};

/* An atomic increment of a watched word, under way. */
struct trax_gdb_atomic {
  uint32_t thread, rd, address;
};

struct trax_gdb {
  trax_machine *machine;
  struct trax_run *run; /* from the first look to the end */
  struct trax_gdb_wire wire;
  const volatile int *interrupt;
  struct trax_watch watch;
  struct trax_observer observer;
  const struct trax_observer *observed_before; /* who is told too */

  enum { GDB_STOPPED, GDB_RUNNING, GDB_DETACHED, GDB_KILLED, GDB_INTERRUPTED } phase;
  bool begun;         /* it has been asked once */
  bool over;          /* the run has ended: going on means the end */
  bool changed;       /* registers or memory since the stop */
  bool knows_swbreak; /* as a reason for a stop */
  uint64_t cycle;     /* the next one */
  uint64_t listen_at; /* the cycle in which the debugger is listened to again */

  uint32_t threads, tps;          /* of the chip, of a TM */
  struct trax_gdb_thread *thread; /* [threads] */
  uint32_t selected;              /* for registers and memory (Hg) */
  uint32_t continued;             /* for s (Hc) */
  uint32_t stopped;               /* by whom the last stop is reported */
  uint32_t listed;                /* the next of a list in parts */
  char reason[160];               /* the last stop's packet */

  struct trax_gdb_break breaks[TRAX_GDB_BREAKS];
  uint32_t break_count;
  struct trax_gdb_watch watches[TRAX_GDB_WATCHES];
  uint32_t watch_count;
  bool named_only; /* when the run was resumed only some threads were: breakpoints that are removed hold for others */
  unsigned
      ahead; /* the thread that stopped last is shown at ahead_pc, so many instructions from where it is (stub.c) */
  uint32_t ahead_pc;
  unsigned owed;  /* it steps on from there: these instructions first */
  bool insisting; /* until it has stepped, no other's event counts */
  bool eventful;  /* some thread has an event */
  uint32_t range_begin, range_end;
  struct trax_gdb_atomic *atomics; /* [threads * TRAX_NUM_REGISTERS] */
  uint32_t atomic_count;
};

/* --- stub.c --- */
/* The threads marked as stepping step, the others go on; named_only: they were not named. */
void trax_gdb_resume(struct trax_gdb *gdb, bool named_only);

/* --- commands.c --- */
/* Answers the packet in gdb->wire. */
void trax_gdb_command(struct trax_gdb *gdb);

/* --- breaks.c --- */
/* Packets Z and z. False: no such thing, or no room. */
bool trax_gdb_insert(struct trax_gdb *gdb, char type, uint32_t address, uint32_t bytes);
bool trax_gdb_remove(struct trax_gdb *gdb, char type, uint32_t address, uint32_t bytes);
void trax_gdb_forget_breaks(struct trax_gdb *gdb);
/* A breakpoint at pc that holds. */
bool trax_gdb_breaks_at(const struct trax_gdb *gdb, uint32_t pc);
/* The watchpoint that the access of a thread touches, or NULL. */
const struct trax_gdb_watch *trax_gdb_watched(const struct trax_gdb *gdb, uint32_t thread, uint32_t address,
                                              uint32_t bytes, bool reads, bool writes);
/* What an instruction and an arrival mean for watchpoints. */
void trax_gdb_note_access(struct trax_gdb *gdb, uint32_t thread, const struct trax_issue *issue);
void trax_gdb_note_arrival(struct trax_gdb *gdb, uint32_t thread, uint32_t rd);

/* --- imagine.c --- */
/* Where the thread's next so many instructions will lead it. */
uint32_t trax_gdb_pc_after(const struct trax_gdb *gdb, uint32_t thread, unsigned instructions);

/* --- target.c --- */
uint32_t trax_gdb_pc(const struct trax_gdb *gdb, uint32_t thread);
bool trax_gdb_is_alive(const struct trax_gdb *gdb, uint32_t thread);
/* number is the debugger's (registers.h). */
uint32_t trax_gdb_register(const struct trax_gdb *gdb, uint32_t thread, unsigned number);
bool trax_gdb_set_register(struct trax_gdb *gdb, uint32_t thread, unsigned number, uint32_t value);
/* How many of the bytes at address a thread can read; they begin at *bytes. */
size_t trax_gdb_memory(const struct trax_gdb *gdb, uint32_t thread, uint32_t address, size_t size, uint8_t **bytes);
/* All of them or none: not outside memory, and not into text, which has been decoded. */
bool trax_gdb_write_memory(struct trax_gdb *gdb, uint32_t thread, uint32_t address, const void *bytes, size_t size);
void trax_gdb_thread_name(const struct trax_gdb *gdb, uint32_t thread, char *name, size_t size);
/* Documents of qXfer, to be freed; NULL if there is no memory. */
char *trax_gdb_target_description(void);
char *trax_gdb_thread_list(const struct trax_gdb *gdb);

/* --- monitor.c --- */
/* GDB's command `monitor`. False if it is unknown; what it prints has been sent. */
bool trax_gdb_monitor(struct trax_gdb *gdb, const char *command);

#endif
