/* The host's part of a machine: the program's image and the buffers bound to it. */
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
  uint64_t free_address; /* the end of image and buffers, a multiple of 64; at most memory_end */
  uint64_t memory_end;   /* the end of image, buffers and heap: the lower end of the lowest stack, or of memory */
  uint32_t stack_bytes;  /* size of each thread's stack in global memory; 0: stacks are in local memory */
};

/* docs/abi.md, "Registers" */
extern const char *const trax_register_names[TRAX_NUM_REGISTERS];

/* The machine's host part; NULL before a program is loaded. */
static inline struct trax_host *trax_host_of(const struct trax_machine *machine) {
  return machine->host;
}

#endif
