/* Debugging over GDB's remote serial protocol (GDB's manual, appendix "GDB Remote Serial Protocol"); docs/debugging.md
   says what a user sees.

   A debugged run observes every issue and looks at the machine between cycles (fast/chip.h), so a stop falls between
   two cycles, of all threads alike. What the debugger does not change, it does not disturb: a run that is stopped and
   continued takes the cycles of one that is not. */
#ifndef TRAX_GDB_GDB_H
#define TRAX_GDB_GDB_H

#include "gdb/wire.h"
#include "trax/emulator.h"

struct trax_gdb;

/* Attaches to a machine that has a program and has not run; it will stop before cycle 0. interrupt, which may be NULL,
   is that of the run's options. What link refers to, and machine, must live as long as the result. */
struct trax_gdb *trax_gdb_create(trax_machine *machine, const struct trax_gdb_link *link, const volatile int *interrupt,
                                 trax_error *error);
/* After the run. */
void trax_gdb_destroy(struct trax_gdb *gdb);
/* The debugger ended the run. */
bool trax_gdb_killed(const struct trax_gdb *gdb);

/* --- listen.c: a TCP port of the loopback interface --- */

struct trax_gdb_port {
  int listener, connection; /* file descriptors; -1: none */
  unsigned number;
};

/* number 0 is any free port; port->number receives which. */
trax_status trax_gdb_listen(struct trax_gdb_port *port, unsigned number, trax_error *error);
/* Waits for one debugger. TRAX_INTERRUPTED if *interrupt becomes true meanwhile. */
trax_status trax_gdb_accept(struct trax_gdb_port *port, const volatile int *interrupt, trax_error *error);
struct trax_gdb_link trax_gdb_port_link(struct trax_gdb_port *port);
void trax_gdb_port_close(struct trax_gdb_port *port);

/* --- symbols.c --- */

/* Writes a copy of an executable that a debugger for RISC-V reads: its machine, and the registers in its debug
   information, are what the debugger is shown (registers.h). */
trax_status trax_gdb_write_symbols(const char *executable, const char *path, trax_error *error);

#endif
