/* What the host side keeps beside a machine: the program's image and the buffers bound to it. */
#ifndef TRAX_HOST_HOST_H
#define TRAX_HOST_HOST_H

#include "core/machine.h"
#include "image.h"

struct trax_bound_buffer {
  char *symbol;
  uint32_t address, bytes;
};

struct trax_host {
  trax_image *image;
  struct trax_bound_buffer *buffers;
  size_t buffer_count;
  uint64_t free_address; /* behind the image and the buffers, a multiple of 64; up to the end of memory */
};

/* The machine's host side; NULL before a program is loaded. */
static inline struct trax_host *trax_host_of(const struct trax_machine *machine) {
  return machine->host;
}

#endif
