/* Export and import of the engine's state (docs/fast-engine.md): between cycles, watches and checkpoints find no
   bursts. While it simulates, the engine also has data that follow from the rest. */
#include "fast/time/head.h"

#include <string.h>

static void find_resident_lines(struct trax_tm *tm) {
  memset(tm->resident, 0, tm->icaches * sizeof *tm->resident);
  for (uint32_t i = 0; i < tm->icaches; i++) {
    const struct trax_cache_tags *tags = &tm->icache[i].tags;
    for (size_t place = 0; place < ((size_t)tags->set_mask + 1) * tags->ways; place++)
      if (tags->lines[place])
        trax_fast_set_resident(tm, i, tags->lines[place] - 1, true);
  }
}

/* Finds the registers that wait for atomic increments. The increments' words count as written, so that no burst loads
   them before they are incremented. */
static void find_atomics(struct trax_tm *tm) {
  const struct trax_queue *queue = &tm->queue;
  for (uint32_t i = 0; i < queue->depth; i++) {
    const struct trax_request *request = &queue->requests[i];
    if (queue->requests[i].bytes && request->kind == TRAX_REQUEST_ATOMIC) {
      tm->tp[request->tp].atomics |= (uint64_t)1 << request->rd;
      trax_fast_set_written(&tm->chip->blocks, request->address, TRAX_BLOCK_SHARED);
    }
  }
}

static void import_tp(struct trax_tm *tm, unsigned number, uint64_t t) {
  const uint64_t bit = (uint64_t)1 << number;
  struct trax_tp *tp = &tm->tp[number];
  tp->resume = trax_fast_inst_at(&tm->chip->program, tp->pc);
  tp->resume_pc = tp->pc;
  tm->heads.at[number] = tm->heads.last[number] = 0;
  tm->busy_registers[number] = 0;
  tm->busy &= ~bit;
  for (unsigned rd = 0; rd < TRAX_NUM_REGISTERS; rd++)
    if (tp->usable[rd] > t)
      trax_fast_set_busy(tm, number, rd);
  trax_fast_advance(tm, number);
}

static void import_tm(struct trax_tm *tm, uint64_t t) {
  find_resident_lines(tm);
  tm->ready = tm->no_text = tm->wheel_occupied = 0;
  tm->executes_at_issue = tm->ended; /* ended threads have no bursts */
  tm->running = tm->tps - (uint32_t)__builtin_popcountll(tm->ended);
  tm->recheck = tm->awake & tm->holding;
  tm->next_cycle = t;
  for (unsigned slot = 0; slot < TRAX_WHEEL; slot++)
    tm->wheel_occupied |= (uint64_t)(tm->wheel[slot] != 0) << slot;
  for (unsigned tp = 0; tp < tm->tps; tp++)
    if (!(tm->ended >> tp & 1))
      import_tp(tm, tp, t);
}

void trax_fast_import(struct trax_chip *chip, uint64_t t) {
  chip->alone = false;
  trax_memory_import(&chip->memory, chip->tm, chip->tms);
  for (uint32_t i = 0; i < chip->tms; i++) {
    for (unsigned tp = 0; tp < chip->tm[i].tps; tp++)
      chip->tm[i].tp[tp].atomics = 0;
    find_atomics(&chip->tm[i]);
  }
  for (uint32_t i = 0; i < chip->tms; i++)
    import_tm(&chip->tm[i], t);
}
