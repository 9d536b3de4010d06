/* Debugging over GDB's remote serial protocol (GDB's manual, appendix "GDB Remote Serial Protocol"). docs/debugging.md
   describes it for users.

   The stub observes every issue and inspects the machine between cycles, so all threads stop between the same two
   cycles. If the debugger changes nothing, a run that is stopped and continued takes the same cycles as one that is
   not. */
#ifndef TRAX_GDB_GDB_H
#define TRAX_GDB_GDB_H

#include "gdb/wire.h"
#include "trax/emulator.h"

struct trax_gdb;

/* Attaches to a machine that has a program and has not run. The run will stop before cycle 0. interrupt, which may be
   NULL, is that of the run's options. link's context and machine must stay valid until trax_gdb_destroy. NULL: out of
   memory. */
struct trax_gdb *trax_gdb_create(trax_machine *machine, const struct trax_gdb_link *link, const volatile int *interrupt,
                                 trax_error *error);
/* To be called after the run. gdb may be NULL. */
void trax_gdb_destroy(struct trax_gdb *gdb);
/* Whether the debugger has ended the run by its command `kill`. */
bool trax_gdb_killed(const struct trax_gdb *gdb);

/* --- listen.c: a TCP port of the loopback interface --- */

struct trax_gdb_port {
  int listener, connection; /* file descriptors; -1: none */
  unsigned number;
  const volatile int *interrupt; /* since trax_gdb_accept */
};

/* Opens a port; 0 is any free one. port->number receives its number. */
trax_status trax_gdb_listen(struct trax_gdb_port *port, unsigned number, trax_error *error);
/* Waits for one debugger. TRAX_INTERRUPTED: *interrupt became nonzero meanwhile. */
trax_status trax_gdb_accept(struct trax_gdb_port *port, const volatile int *interrupt, trax_error *error);
struct trax_gdb_link trax_gdb_port_link(struct trax_gdb_port *port);
void trax_gdb_port_close(struct trax_gdb_port *port);

#endif
