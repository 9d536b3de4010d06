/* What the host side keeps beside a machine: the program's image and the buffers bound to it. */
#ifndef TRAX_PROGRAM_PROGRAM_H
#define TRAX_PROGRAM_PROGRAM_H

#include "program/image.h"
#include "machine/machine.h"

struct trax_bound_buffer {
  char *symbol;
  uint32_t address, bytes;
};

struct trax_host {
  trax_image *image;
  struct trax_bound_buffer *buffers;
  size_t buffer_count;
  uint64_t free_address; /* behind the image and the buffers, a multiple of 64; up to memory_end */
  uint64_t memory_end;   /* of what image, buffers and heap have: the end of memory, or of the lowest stack */
  uint32_t stack_bytes;  /* of each thread's stack in global memory, from the end of memory down; 0: they are local */
};

/* docs/abi.md, "Registers" */
extern const char *const trax_register_names[TRAX_NUM_REGISTERS];

/* The machine's host side; NULL before a program is loaded. */
static inline struct trax_host *trax_host_of(const struct trax_machine *machine) {
  return machine->host;
}

#endif
