#include "machine/traps.h"

#include "fast/ahead.h"
#include "fast/tm.h"

#include <string.h>

trax_fault_kind trax_put_string(const struct trax_space *space, const uint8_t *local, uint32_t address, FILE *output) {
  const char *text, *end;
  if (address >= TRAX_LOCAL_BASE) {
    text = (const char *)local + (address - TRAX_LOCAL_BASE);
    end = (const char *)local + TRAX_LOCAL_SIZE;
  } else {
    const trax_fault_kind kind = trax_space_check(space, address, 1, false);
    if (kind)
      return kind;
    text = (const char *)space->bytes + address;
    end = (const char *)space->bytes + space->size;
  }
  const char *nul = memchr(text, 0, (size_t)(end - text));
  if (!nul)
    return TRAX_FAULT_UNMAPPED;
  if (output) {
    fwrite(text, 1, (size_t)(nul - text), output);
    fflush(output);
  }
  return TRAX_FAULT_NONE;
}

bool trax_trap(struct trax_tm *tm, unsigned tp, uint32_t value, int32_t code, uint64_t t) {
  trax_fault_kind fault = TRAX_FAULT_NONE;
  if (tm->ahead && (code == TRAX_TRAP_PUTC || code == TRAX_TRAP_PUTS)) {
    tm->ahead->stop = true; /* output is in the order of all threads */
    return true;
  }
  switch (code) {
  case TRAX_TRAP_EXIT:
    trax_tm_end_thread(tm, tp, t + 1, (int32_t)value);
    break;
  case TRAX_TRAP_PUTC:
    if (tm->output)
      fputc((int)(value & 0xFF), tm->output);
    break;
  case TRAX_TRAP_ABORT:
    fault = TRAX_FAULT_ABORT;
    break;
  case TRAX_TRAP_RAYS:
    tm->stats->rays += value;
    break;
  case TRAX_TRAP_ITEMS:
    tm->stats->items += value;
    break;
  case TRAX_TRAP_PUTS:
    fault = trax_put_string(&tm->machine->space, tm->tp[tp].local, value, tm->output);
    break;
  }
  if (fault)
    trax_tm_fault(tm, tp, t, fault, value);
  return !fault;
}
