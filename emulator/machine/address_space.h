/* Global memory: one flat block of host memory, which the host allocates page by page on first use, with permissions
   for every 64 bytes. The engines keep local memory with each thread. Every guest address is checked by
   trax_space_check before it is used. */
#ifndef TRAX_MACHINE_ADDRESS_SPACE_H
#define TRAX_MACHINE_ADDRESS_SPACE_H

#include "machine/fault.h"
#include "trax/emulator.h"

#include <stddef.h>
#include <stdint.h>

enum { TRAX_PERMIT_READ = 1, TRAX_PERMIT_WRITE = 2, TRAX_PERMIT_EXECUTE = 4 };

#define TRAX_GRANULE 64u /* bytes with the same permissions */

struct trax_segment {
  uint32_t address, bytes; /* as mapped; permissions cover whole granules */
  unsigned permissions;
};

/* Memory that no program may access. */
struct trax_hole {
  uint64_t begin, end; /* end is a multiple of 64; the rest of the word in which the hole begins can be read */
};

struct trax_space {
  uint8_t *bytes;        /* bytes[address]; includes the null page, which the guest cannot access */
  uint64_t size;         /* end of global memory */
  uint8_t *restrictions; /* per granule; 0 permits reads and writes, also where no segment is */
  struct trax_segment *segments;
  size_t segment_count;
  struct trax_hole *holes;
  size_t hole_count;
  size_t mapped_bytes, restriction_bytes;
  uint32_t input, input_bytes; /* the largest buffer filled by the host, in whole words; programs mostly read it */
};

/* TRAX_HAS_HOLE: all or a part of the granule is in a hole. */
enum { TRAX_RESTRICT_WRITE = 1, TRAX_MAPPED = 2, TRAX_STACK_END = 4, TRAX_HAS_HOLE = 8 };

trax_status trax_space_create(struct trax_space *space, uint64_t size, trax_error *error);
void trax_space_destroy(struct trax_space *space);

/* Makes [address, address + bytes) a segment and returns its zeroed bytes in *host. address is a multiple of 64, at or
   above 0x1000; segments do not overlap; a segment is not both writable and executable. */
trax_status trax_space_map(struct trax_space *space, uint32_t address, uint32_t bytes, unsigned permissions,
                           uint8_t **host, trax_error *error);

/* Makes [address, address + bytes) the guard of a stack: a write to it is a stack overflow. The range lies in global
   memory outside all segments; both numbers are multiples of 64. */
void trax_space_guard(struct trax_space *space, uint32_t address, uint32_t bytes);

/* Makes [begin, end) a hole: an access to it is one to an unmapped address. The range lies outside all segments. */
trax_status trax_space_dig(struct trax_space *space, uint64_t begin, uint64_t end, trax_error *error);
/* Whether an access to [address, address + bytes) touches a hole. */
bool trax_space_in_hole(const struct trax_space *space, uint32_t address, uint64_t bytes, bool write);
/* The end of the accessible bytes that begin at a global address: of memory, or the next hole's beginning. */
uint64_t trax_space_end(const struct trax_space *space, uint32_t address);

/* The kind of fault of a global access that is out of bounds or misaligned. */
trax_fault_kind trax_space_why(const struct trax_space *space, uint32_t address, uint32_t bytes);

/* The kind of fault of an aligned access to a granule with restrictions; TRAX_FAULT_NONE if none forbids it. */
trax_fault_kind trax_space_why_restricted(const struct trax_space *space, uint32_t address, uint32_t bytes, bool write);

/* TRAX_FAULT_NONE if an access of 1, 2 or 4 bytes to global memory is allowed. */
static inline trax_fault_kind trax_space_check(const struct trax_space *space, uint32_t address, uint32_t bytes,
                                               bool write) {
  /* An aligned access whose first byte is below the end (a multiple of 4096) ends below it too. */
  if (address - TRAX_NULL_END >= space->size - TRAX_NULL_END || (address & (bytes - 1)))
    return trax_space_why(space, address, bytes);
  if (space->restrictions[address / TRAX_GRANULE] & (write ? TRAX_RESTRICT_WRITE | TRAX_HAS_HOLE : TRAX_HAS_HOLE))
    return trax_space_why_restricted(space, address, bytes, write);
  return TRAX_FAULT_NONE;
}

/* Copies the NUL-terminated string at a global address, truncated to size - 1 characters. False: the string reaches the
   end of global memory, or a hole, before its NUL. */
bool trax_space_string(const struct trax_space *space, uint32_t address, char *text, size_t size);

#endif
