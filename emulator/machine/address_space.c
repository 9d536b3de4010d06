#define _DEFAULT_SOURCE /* MAP_ANONYMOUS, MAP_NORESERVE */
#include "machine/address_space.h"

#include "machine/machine.h"

#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

/* An access at most this many bytes below local memory is called a stack overflow, one farther away a wild pointer. */
#define STACK_OVERFLOW_WINDOW 0x10000u

static void *allocate_lazily(size_t bytes) {
  void *block = mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  return block == MAP_FAILED ? NULL : block;
}

trax_status trax_space_create(struct trax_space *space, uint64_t size, trax_error *error) {
  memset(space, 0, sizeof *space);
  space->size = size;
  space->mapped_bytes = size;
  space->restriction_bytes = size / TRAX_GRANULE;
  space->bytes = allocate_lazily(space->mapped_bytes);
  space->restrictions = allocate_lazily(space->restriction_bytes);
  if (!space->bytes || !space->restrictions) {
    trax_space_destroy(space);
    return trax_fail(error, "cannot reserve %llu MiB of host memory for memory.size_mib",
                     (unsigned long long)(size >> 20));
  }
  return TRAX_OK;
}

void trax_space_destroy(struct trax_space *space) {
  if (space->bytes)
    munmap(space->bytes, space->mapped_bytes);
  if (space->restrictions)
    munmap(space->restrictions, space->restriction_bytes);
  free(space->segments);
  free(space->holes);
  memset(space, 0, sizeof *space);
}

trax_status trax_space_map(struct trax_space *space, uint32_t address, uint32_t bytes, unsigned permissions,
                           uint8_t **host, trax_error *error) {
  const uint64_t end = (uint64_t)address + bytes;
  if (address < TRAX_NULL_END)
    return trax_fail(error, "segment at 0x%08x lies in the null page", address);
  if (address % TRAX_GRANULE)
    return trax_fail(error, "segment at 0x%08x is not aligned to %u bytes", address, TRAX_GRANULE);
  if (end > space->size)
    return trax_fail(error, "segment 0x%08x..0x%08llx does not fit into memory, which ends at 0x%08llx", address,
                     (unsigned long long)end, (unsigned long long)space->size);
  if ((permissions & TRAX_PERMIT_WRITE) && (permissions & TRAX_PERMIT_EXECUTE))
    return trax_fail(error, "segment at 0x%08x is both writable and executable", address);

  const uint64_t first = address / TRAX_GRANULE, last = (end + TRAX_GRANULE - 1) / TRAX_GRANULE;
  for (uint64_t granule = first; granule < last; granule++)
    if (space->restrictions[granule] & TRAX_MAPPED)
      return trax_fail(error, "segment 0x%08x..0x%08llx overlaps another one at 0x%08llx", address,
                       (unsigned long long)end, (unsigned long long)(granule * TRAX_GRANULE));

  struct trax_segment *segments = realloc(space->segments, (space->segment_count + 1) * sizeof *segments);
  if (!segments)
    return trax_fail(error, "out of memory");
  space->segments = segments;
  segments[space->segment_count++] = (struct trax_segment){address, bytes, permissions};
  const uint8_t restriction = TRAX_MAPPED | (permissions & TRAX_PERMIT_WRITE ? 0 : TRAX_RESTRICT_WRITE);
  if (last > first)
    memset(space->restrictions + first, restriction, last - first);
  if (host)
    *host = space->bytes + address;
  return TRAX_OK;
}

void trax_space_guard(struct trax_space *space, uint32_t address, uint32_t bytes) {
  memset(space->restrictions + address / TRAX_GRANULE, TRAX_RESTRICT_WRITE | TRAX_STACK_END, bytes / TRAX_GRANULE);
}

trax_status trax_space_dig(struct trax_space *space, uint64_t begin, uint64_t end, trax_error *error) {
  if (begin >= end)
    return TRAX_OK;
  struct trax_hole *holes = realloc(space->holes, (space->hole_count + 1) * sizeof *holes);
  if (!holes)
    return trax_fail(error, "out of memory");
  space->holes = holes;
  holes[space->hole_count++] = (struct trax_hole){begin, end};
  for (uint64_t granule = begin / TRAX_GRANULE; granule < end / TRAX_GRANULE; granule++)
    space->restrictions[granule] |= TRAX_HAS_HOLE;
  return TRAX_OK;
}

bool trax_space_in_hole(const struct trax_space *space, uint32_t address, uint64_t bytes, bool write) {
  for (size_t i = 0; i < space->hole_count; i++) {
    const uint64_t begin = write ? space->holes[i].begin : (space->holes[i].begin + 3) / 4 * 4;
    if (address < space->holes[i].end && address + bytes > begin)
      return true;
  }
  return false;
}

uint64_t trax_space_end(const struct trax_space *space, uint32_t address) {
  uint64_t end = space->size;
  for (size_t i = 0; i < space->hole_count; i++)
    if (space->holes[i].end > address && space->holes[i].begin < end)
      end = space->holes[i].begin;
  return end;
}

trax_fault_kind trax_space_why_restricted(const struct trax_space *space, uint32_t address, uint32_t bytes,
                                          bool write) {
  const uint8_t restrictions = space->restrictions[address / TRAX_GRANULE];
  if (restrictions & TRAX_HAS_HOLE && trax_space_in_hole(space, address, bytes, write))
    return TRAX_FAULT_UNMAPPED;
  if (!write || !(restrictions & TRAX_RESTRICT_WRITE))
    return TRAX_FAULT_NONE;
  return restrictions & TRAX_STACK_END ? TRAX_FAULT_STACK_OVERFLOW : TRAX_FAULT_READ_ONLY;
}

trax_fault_kind trax_space_why(const struct trax_space *space, uint32_t address, uint32_t bytes) {
  if (address < TRAX_NULL_END)
    return TRAX_FAULT_NULL_PAGE;
  if (address >= space->size && address < TRAX_LOCAL_BASE)
    return address >= TRAX_LOCAL_BASE - STACK_OVERFLOW_WINDOW ? TRAX_FAULT_STACK_OVERFLOW : TRAX_FAULT_UNMAPPED;
  if (address < TRAX_LOCAL_BASE && trax_space_in_hole(space, address, 1, false))
    return TRAX_FAULT_UNMAPPED;
  return address & (bytes - 1) ? TRAX_FAULT_MISALIGNED : TRAX_FAULT_NOT_GLOBAL;
}

bool trax_space_string(const struct trax_space *space, uint32_t address, char *text, size_t size) {
  if (size)
    text[0] = 0;
  for (size_t i = 0;; i++) {
    if (trax_space_check(space, (uint32_t)(address + i), 1, false) != TRAX_FAULT_NONE)
      return false;
    const char c = (char)space->bytes[(uint32_t)(address + i)];
    if (i + 1 < size) {
      text[i] = c;
      text[i + 1] = 0;
    }
    if (!c)
      return true;
  }
}
