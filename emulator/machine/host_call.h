/* The trap `host`: a program's call of the host (docs/abi.md, "Host calls"). The machine knows only how a call reads
   and writes the program's memory; emulator/calls/ serves them. */
#ifndef TRAX_MACHINE_HOST_CALL_H
#define TRAX_MACHINE_HOST_CALL_H

#include "machine/address_space.h"
#include "trax/host_calls.h"

#include <stdio.h>

struct trax_machine;

/* A call under way. */
struct trax_host_call {
  const struct trax_machine *machine;
  uint8_t *local;                  /* of the calling thread */
  uint32_t words[TRAX_HOST_WORDS]; /* of its block: the number, and the arguments */
};

struct trax_host_calls {
  /* Returns the result: not negative, or an error number times -1. NULL: all calls fail with TRAX_HOST_NO_CALL. */
  int32_t (*serve)(void *context, struct trax_host_call *call);
  void *context;
  /* Takes what traps print instead of the run's output; NULL: nothing does. */
  void (*print)(void *context, const uint8_t *bytes, size_t count);
  void (*destroy)(void *context); /* called with the machine's end */

  /* Set by an engine that executes loads before their time, for the time of its run: called before bytes of global
     memory are written. */
  void (*before_write)(void *engine, uint32_t address, uint32_t bytes);
  void *engine;
};

/* Returns the bytes of the program's memory from `address` on, which it may read or, with `write`, write; NULL if there
   are not so many. 0 bytes are always there. */
uint8_t *trax_host_call_bytes(const struct trax_host_call *call, uint32_t address, uint32_t bytes, bool write);

/* Prints what a trap or an epoch gives: to the run's output, which may be NULL, or where descriptor 1 goes. */
void trax_host_print(const struct trax_machine *machine, FILE *output, const char *bytes, size_t count);

/* Performs the trap. A fault says that the block is not in the program's memory. */
trax_fault_kind trax_host_trap(const struct trax_machine *machine, uint8_t *local, uint32_t block);

#endif
