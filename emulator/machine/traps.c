#include "machine/traps.h"

#include <string.h>

/* Prints the string at an address of global memory or of the thread's local memory. Returns a fault and prints nothing
   if the string reaches the end of memory, or a hole, before its NUL. */
static trax_fault_kind put_string(const struct trax_machine *machine, const uint8_t *local, uint32_t address,
                                  FILE *output) {
  const struct trax_space *space = &machine->space;
  const char *text, *end;
  if (address >= TRAX_LOCAL_BASE) {
    text = (const char *)local + (address - TRAX_LOCAL_BASE);
    end = (const char *)local + TRAX_LOCAL_SIZE;
  } else {
    const trax_fault_kind kind = trax_space_check(space, address, 1, false);
    if (kind)
      return kind;
    text = (const char *)space->bytes + address;
    end = (const char *)space->bytes + trax_space_end(space, address);
  }
  const char *nul = memchr(text, 0, (size_t)(end - text));
  if (!nul)
    return TRAX_FAULT_UNMAPPED;
  trax_host_print(machine, output, text, (size_t)(nul - text));
  if (output)
    fflush(output);
  return TRAX_FAULT_NONE;
}

static void count_kinds(struct trax_tm_stats *stats, uint32_t counts) {
  const uint32_t field = (1u << TRAX_KIND_BITS) - 1;
#define COUNT(X, ID, NAME, NUMBER, MEANING)                                                                            \
  stats->rays_##NAME += counts >> TRAX_KIND_BITS * NUMBER & field;                                                     \
  stats->rays += counts >> TRAX_KIND_BITS * NUMBER & field;
  TRAX_RAY_KINDS(COUNT, )
#undef COUNT
}

trax_fault_kind trax_trap(const struct trax_machine *machine, uint8_t *local, struct trax_tm_stats *stats, FILE *output,
                          uint32_t value, int32_t code) {
  switch (code) {
  case TRAX_TRAP_PUTC:
    trax_host_print(machine, output, &(char){(char)value}, 1);
    break;
  case TRAX_TRAP_ABORT:
    return TRAX_FAULT_ABORT;
  case TRAX_TRAP_RAYS:
    stats->rays += value;
    stats->rays_other += value;
    break;
  case TRAX_TRAP_ITEMS:
    stats->items += value;
    break;
  case TRAX_TRAP_PUTS:
    return put_string(machine, local, value, output);
  case TRAX_TRAP_KINDS:
    count_kinds(stats, value);
    break;
  case TRAX_TRAP_HOST:
    return trax_host_trap(machine, local, value);
  }
  return TRAX_FAULT_NONE;
}

uint32_t trax_special_register(const struct trax_config *config, uint32_t thread, uint32_t number, uint64_t t) {
  switch (number) {
  case TRAX_SR_THREAD:
    return thread;
  case TRAX_SR_TM:
    return thread / config->chip.tps_per_tm;
  case TRAX_SR_TP:
    return thread % config->chip.tps_per_tm;
  case TRAX_SR_THREADS:
    return config->chip.tms * config->chip.tps_per_tm;
  case TRAX_SR_CYCLE:
    return (uint32_t)t;
  default: /* TRAX_SR_CYCLEH; others are illegal */
    return (uint32_t)(t >> 32);
  }
}
