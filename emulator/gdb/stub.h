/* The parts of the stub: stub.c stops and resumes the run, breaks.c has breakpoints and watchpoints, commands.c,
   resume.c and queries.c handle packets, target.c accesses threads, registers and memory, predict.c predicts a thread's
   pc, and monitor.c has the commands of `monitor`. */
#ifndef TRAX_GDB_STUB_H
#define TRAX_GDB_STUB_H

#include "engine/run.h"
#include "gdb/gdb.h"

enum { TRAX_GDB_BREAKS = 4096, TRAX_GDB_WATCHES = 64 }; /* limits */

/* Signals in GDB's numbering. */
enum trax_gdb_signal {
  TRAX_GDB_SIGINT = 2,
  TRAX_GDB_SIGILL = 4,
  TRAX_GDB_SIGTRAP = 5,
  TRAX_GDB_SIGABRT = 6,
  TRAX_GDB_SIGBUS = 10,
  TRAX_GDB_SIGSEGV = 11,
  TRAX_GDB_SIGXCPU = 24
};

/* The events for which a thread stops. */
enum { TRAX_GDB_STEPPED = 1, TRAX_GDB_AT_BREAK = 2, TRAX_GDB_ACCESSED = 4 };

struct trax_gdb_thread {
  bool reported;       /* a stop at this pc has been reported: its breakpoint is not hit again before an issue */
  bool stepping;       /* it stops after an issue if its pc is outside the range */
  uint8_t events;      /* a mask of TRAX_GDB_STEPPED ... */
  uint8_t skip_breaks; /* after pretended steps: the number of instructions whose breakpoints are not reported */
  char access;         /* of TRAX_GDB_ACCESSED: the watchpoint's type */
  uint32_t accessed;   /* and its address */
};

struct trax_gdb_break {
  uint32_t address;
  bool removed; /* since the run was last resumed; see trax_gdb.named_only */
};

struct trax_gdb_watch {
  char type; /* 2 write, 3 read, 4 access, as in the packet */
  uint32_t address, bytes;
  uint32_t thread; /* the thread to whose local memory the address refers */
  bool removed;    /* since the run was last resumed. GDB removes and inserts at each stop: the thread stays the same */
};

/* An issued atomic increment of a watched word that has not arrived. With rd r0 no arrival is notified; the word has
   changed from `before` then. */
struct trax_gdb_atomic {
  uint32_t thread, rd, address, before;
};

struct trax_gdb {
  trax_machine *machine;
  struct trax_run *run; /* set by the first inspection */
  struct trax_gdb_wire wire;
  const volatile int *interrupt;
  struct trax_watch watch;
  struct trax_observer observer;
  struct trax_observer *next_observer; /* the observer set before, which is notified, too; may be NULL */

  enum { GDB_STOPPED, GDB_RUNNING, GDB_DETACHED, GDB_KILLED, GDB_INTERRUPTED } phase;
  bool begun;         /* the first stop has been made */
  bool over;          /* the run has ended: a resume ends the session */
  bool changed;       /* registers or memory have been changed since the stop */
  bool knows_swbreak; /* GDB accepts swbreak as the reason for a stop */
  uint64_t cycle;     /* the next one */
  uint64_t listen_at; /* the next cycle in which the debugger is polled */

  uint32_t threads, tps;          /* of the chip, of a TM */
  struct trax_gdb_thread *thread; /* [threads] */
  uint32_t selected;              /* the thread for registers and memory (Hg) */
  uint32_t continued;             /* the thread for s (Hc) */
  uint32_t stopped;               /* the thread of the latest stop */
  uint32_t listed;                /* the next thread of a list that is sent in parts */
  char reason[160];               /* the packet of the latest stop */

  struct trax_gdb_break breaks[TRAX_GDB_BREAKS]; /* in the order of addresses */
  uint32_t break_count;
  struct trax_gdb_watch watches[TRAX_GDB_WATCHES];
  uint32_t watch_count;
  bool named_only; /* the latest resume named single threads: removed breakpoints still stop the other threads */
  /* Steps of the stopped thread that were reported to GDB and not made (stub.c, pretend_step). While the run is
     stopped, `steps` and `pc` count. A resume that steps the same thread moves `steps` to `catch_up`: the thread issues
     these instructions before its next step counts. Any other resume, and a change of its pc, forget them. */
  struct {
    unsigned steps;
    uint32_t pc;       /* at which the thread is shown */
    unsigned catch_up; /* instructions to issue before the next step counts */
    bool step_first;   /* the thread must step before another thread's event counts */
  } pretence;
  bool eventful;   /* some thread has an event */
  bool step_ended; /* a stepping thread has ended */
  uint32_t range_begin, range_end;
  struct trax_gdb_atomic *atomics; /* [threads * TRAX_NUM_REGISTERS] */
  uint32_t atomic_count;
};

/* --- stub.c --- */
/* Resumes the run: threads marked as stepping step, the others continue. named_only: the packet named threads. */
void trax_gdb_resume(struct trax_gdb *gdb, bool named_only);

/* --- commands.c --- */
/* Handles the packet in gdb->wire and sends the reply. */
void trax_gdb_command(struct trax_gdb *gdb);

/* --- breaks.c --- */
/* Packets Z and z. False: an unknown type, a bad address, or too many. */
bool trax_gdb_insert(struct trax_gdb *gdb, char type, uint32_t address, uint32_t bytes);
bool trax_gdb_remove(struct trax_gdb *gdb, char type, uint32_t address, uint32_t bytes);
void trax_gdb_forget_breaks(struct trax_gdb *gdb);
/* Whether there is a valid breakpoint at pc. */
bool trax_gdb_breaks_at(const struct trax_gdb *gdb, uint32_t pc);
/* Returns the watchpoint that a thread's access hits, or NULL. */
const struct trax_gdb_watch *trax_gdb_watched(const struct trax_gdb *gdb, uint32_t thread, uint32_t address,
                                              uint32_t bytes, bool reads, bool writes);
/* Adds the events of watchpoints that an issue or the arrival of an atomic increment hits. */
void trax_gdb_note_access(struct trax_gdb *gdb, uint32_t thread, const struct trax_issue *issue);
void trax_gdb_note_arrival(struct trax_gdb *gdb, uint32_t thread, uint32_t rd);
/* The same for increments whose arrival is not notified. */
void trax_gdb_note_changes(struct trax_gdb *gdb);

/* --- predict.c --- */
/* Predicts the thread's pc after its next instructions, as far as it depends on the thread alone. */
uint32_t trax_gdb_pc_after(const struct trax_gdb *gdb, uint32_t thread, unsigned instructions);

/* --- target.c --- */
uint32_t trax_gdb_pc(const struct trax_gdb *gdb, uint32_t thread);
bool trax_gdb_is_alive(const struct trax_gdb *gdb, uint32_t thread);
/* number: in the debugger's numbering (registers.h). */
uint32_t trax_gdb_register(const struct trax_gdb *gdb, uint32_t thread, unsigned number);
bool trax_gdb_set_register(struct trax_gdb *gdb, uint32_t thread, unsigned number, uint32_t value);
/* Returns how many of `size` bytes at an address a thread can read, and sets *bytes to them. */
size_t trax_gdb_memory(const struct trax_gdb *gdb, uint32_t thread, uint32_t address, size_t size, uint8_t **bytes);
/* Writes all bytes or none. False: outside memory, or in text, which has been decoded before the run. */
bool trax_gdb_write_memory(struct trax_gdb *gdb, uint32_t thread, uint32_t address, const void *bytes, size_t size);
void trax_gdb_thread_name(const struct trax_gdb *gdb, uint32_t thread, char *name, size_t size);
/* Documents of qXfer, from malloc; NULL: out of memory. */
char *trax_gdb_target_description(void);
char *trax_gdb_thread_list(const struct trax_gdb *gdb);

/* --- monitor.c --- */
/* Executes a command of `monitor` and sends its output. False: out of memory. */
bool trax_gdb_monitor(struct trax_gdb *gdb, const char *command);

#endif
