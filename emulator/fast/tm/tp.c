#include "fast/tm/tp.h"

#include "fast/chip.h"
#include "fast/store_buffer.h"
#include "machine/traps.h"
#include "trax/semantics.h"

#include <string.h>

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "guest words are copied as host words");

trax_cause trax_tp_wait(const struct trax_tp *tp, uint64_t t, uint64_t *until, unsigned *rd) {
  const struct {
    unsigned first, count;
  } groups[] = {
      {tp->inst->wait_ra, tp->inst->more_ra + 1u}, {tp->inst->wait_rb, tp->inst->more_rb + 1u}, {tp->inst->wait_rd, 1}};
  const bool all = tp->inst->resource == TRAX_RESOURCE_FENCE;
  for (unsigned i = 0; i < (all ? 1 : 3); i++)
    for (unsigned n = 0; n < (all ? TRAX_NUM_REGISTERS : groups[i].count); n++) {
      const unsigned number = (all ? n : groups[i].first + n) % TRAX_NUM_REGISTERS;
      if (tp->usable[number] > t) {
        *until = tp->usable[number];
        *rd = number;
        return (trax_cause)tp->usable_cause[number];
      }
    }
  return TRAX_CAUSE_ISSUED;
}

/* --- effects: addresses have been checked --- */

static uint8_t *place(struct trax_tm *tm, struct trax_tp *tp, uint32_t address) {
  return address >= TRAX_LOCAL_BASE ? tp->local + (address - TRAX_LOCAL_BASE) : tm->machine->space.bytes + address;
}

static uint32_t load(struct trax_tm *tm, struct trax_tp *tp, uint32_t address, unsigned bytes) {
  uint32_t value = 0;
  if (tm->buffer && address < TRAX_LOCAL_BASE) {
    struct trax_overlay_line *const line = trax_store_buffer_line(tm->buffer, address);
    return line ? trax_store_buffer_load(line, &tm->machine->space, address, bytes) : 0;
  }
  memcpy(&value, place(tm, tp, address), bytes);
  return value;
}

static void store(struct trax_tm *tm, struct trax_tp *tp, uint32_t address, uint32_t value, unsigned bytes) {
  if (tm->buffer && address < TRAX_LOCAL_BASE)
    trax_fast_store_in_epoch(&tm->chip->blocks, tm->buffer, tm->now, address, value, bytes);
  else
    memcpy(place(tm, tp, address), &value, bytes);
}

uint32_t trax_tp_special_register(const struct trax_tm *tm, unsigned tp, uint32_t number, uint64_t t) {
  return trax_special_register(tm->config, tm->number * tm->tps + tp, number, t);
}

/* Performs a trap. False: it faulted. */
static bool trap(struct trax_tm *tm, unsigned number, uint32_t value, int32_t code, uint64_t t) {
  tm->progressed = t + 1;
  if (code == TRAX_TRAP_EXIT) {
    trax_tm_end_thread(tm, number, t + 1, (int32_t)value);
    return true;
  }
  if (tm->buffer && code == TRAX_TRAP_PUTC) {
    trax_store_buffer_record(tm->buffer, (struct trax_store_buffer_entry){t, 0, value, TRAX_PRINT});
    return true;
  }
  if (tm->buffer && (code == TRAX_TRAP_PUTS || code == TRAX_TRAP_HOST)) {
    tm->buffer->stop = true; /* what they read and write depends on the order of all threads, cycle by cycle */
    return true;
  }
  const trax_fault_kind fault = trax_trap(tm->machine, tm->tp[number].local, tm->stats, tm->output, value, code);
  if (fault)
    trax_tm_fault(tm, number, t, fault, value);
  return !fault;
}

static void fence(struct trax_tm *tm, uint32_t kind) {
  if (kind & TRAX_FENCE_R) {
    tm->stats->dropped_lines += trax_dcache_drop(&tm->dcache);
    tm->load_hits = 0;
  }
}

bool trax_tp_execute(struct trax_tm *tm, unsigned number, uint64_t t) {
  struct trax_tp *tp = &tm->tp[number];
  const struct trax_decoded *inst = tp->inst;
  const uint32_t pc = tp->pc;
  uint32_t *const reg = tp->reg;
  uint32_t next_pc = pc + 4;
  bool alive = true;

#include "machine/semantics_begin.h"
#define PC pc
#define PRECISION tm->config->special.precision_bits
#define LOAD(ADDRESS, BYTES) load(tm, tp, ADDRESS, BYTES)
#define STORE(ADDRESS, VALUE, BYTES) store(tm, tp, ADDRESS, VALUE, BYTES)
#define ATOMIC_INC(ADDRESS) ((void)(ADDRESS), RD) /* the controller increments, and the arrival sets the register */
#define SPECIAL_REGISTER(NUMBER) trax_tp_special_register(tm, number, NUMBER, t)
#define TRAP(VALUE, CODE) (alive = trap(tm, number, VALUE, (int32_t)(CODE), t))
#define FENCE(KIND) fence(tm, KIND)
#define HALT() (tm->progressed = t + 1, trax_tm_end_thread(tm, number, t + 1, 0))
#include "machine/semantics_switch.h"

  if (!alive)
    return false;
  if (next_pc == pc + 4)
    tp->inst++;
  else
    tp->inst = trax_text_at(tm->chip->text, next_pc);
  tp->pc = next_pc;
  return true;
}
