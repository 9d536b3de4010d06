/* The interpreter of bursts, included by burst.c twice: with EXACTLY 0, a burst ends before a chunk that may not fit;
   with EXACTLY 1, it executes exactly `limit` instructions unless one of them ends it, or needs a register that an
   increment under way will write. */
static unsigned BURST(struct trax_chip *chip, struct trax_tm *tm, unsigned number, unsigned limit,
                      const void *const **operations) {
  __extension__ static const void *const places[] = {
#define TRAX_SEMANTICS(NAME, ...) [TRAX_OP_##NAME] = &&do_##NAME,
#include "trax/semantics.inc"
#undef TRAX_SEMANTICS
      [TRAX_OP_ILLEGAL] = &&stop, [TRAX_OP_COUNT] = &&chunk};
  if (!tm) {
    *operations = places;
    return 0;
  }
  struct trax_tp *const tp = &tm->tp[number];
  uint32_t *const reg = tp->reg;
  uint8_t *const local = tp->local, *const global = chip->machine->space.bytes;
  const struct trax_fast_program *const program = &chip->program;
  struct trax_burst *const burst = &tp->burst;
  const struct trax_fast_inst *inst = tp->resume;
  const struct trax_config *const config = tm->config;
  const uint16_t slow_local = config->tp.local_latency_cycles > 1 ? TRAX_STEP_SLOW : 0;
  const uint16_t slow_jump = config->tp.branch_bubble_cycles > 0 ? TRAX_STEP_SLOW : 0;
  const uint32_t banks = tm->dcache.banks, bank_mask = banks & (banks - 1) ? 0 : banks - 1;
  uint8_t *const blocks = chip->blocks.state;
  const uint64_t accessible = chip->machine->space.size - TRAX_NULL_END;
  const uint32_t input = chip->blocks.input, input_bytes = chip->blocks.input_bytes;
  uint32_t address, word, jumps = 0;
  unsigned loads = 0;
  uint64_t resume_pc = tp->resume_pc; /* the latest jump's target, needed if it is no text */
  int64_t *const count_deltas = tm->count_deltas;
  uint64_t lines = 0;
  struct trax_overlay_line *line = NULL;
  /* A burst that is executed again may have loaded from a block before it was SHARED. Its limit is less. */
  const bool alone = tp->alone;
  const uint8_t last_loadable = limit < TRAX_BURST || alone ? TRAX_BLOCK_SHARED : TRAX_BLOCK_WRITTEN;
  burst->undo_begin = TRAX_BURST + 1;
  const uint32_t first = burst->first = (uint32_t)(inst - program->inst);
  tm->watched[number] = tp->stores[0] = tp->stores[1] = tp->stored = 0;
  /* The number of inst's step is its distance from `begin`, which changes with each jump. */
  uintptr_t begin = (uintptr_t)inst;
  unsigned at;
  count_deltas[inst - program->inst]++;
  goto chunk;

#define AT ((unsigned)(((uintptr_t)inst - begin) / sizeof *inst))
#include "machine/semantics_begin.h"
#define PRECISION config->special.precision_bits
#define PC (program->timing[inst - program->inst].pc)
#define LOAD(ADDRESS, BYTES)                                                                                           \
  (__extension__({                                                                                                     \
    address = (ADDRESS);                                                                                               \
    at = AT;                                                                                                           \
    word = 0;                                                                                                          \
    burst->access[loads].address = address;                                                                            \
    if (address & (BYTES - 1))                                                                                         \
      goto stop;                                                                                                       \
    if (LIKELY(address - input < input_bytes) || address - TRAX_NULL_END < accessible) {                               \
      memcpy(&word, global + address, BYTES);                                                                          \
      if (!LIKELY(address - input < input_bytes)) {                                                                    \
        uint8_t *const block = &blocks[address >> TRAX_BLOCK_SHIFT];                                                   \
        const uint8_t state = __atomic_load_n(block, __ATOMIC_RELAXED);                                                \
        if (state != TRAX_BLOCK_LOADED) {                                                                              \
          if (state > last_loadable)                                                                                   \
            goto stop;                                                                                                 \
          if (!state && !alone) {                                                                                      \
            __atomic_store_n(block, TRAX_BLOCK_LOADED, __ATOMIC_RELAXED);                                              \
          } else if (!alone) {                                                                                         \
            const uint64_t written = load_written(tm, number, loads, address, BYTES, &line);                           \
            if (written == NOWHERE)                                                                                    \
              goto stop;                                                                                               \
            word = (uint32_t)written;                                                                                  \
          }                                                                                                            \
        }                                                                                                              \
      }                                                                                                                \
      loads++;                                                                                                         \
      burst->step[at] |= (uint16_t)(TRAX_STEP_BANK | data_bank(banks, bank_mask, address) << TRAX_STEP_BANK_SHIFT);    \
    } else if (address >= TRAX_LOCAL_BASE) {                                                                           \
      memcpy(&word, local + (address - TRAX_LOCAL_BASE), BYTES);                                                       \
      burst->step[at] |= slow_local;                                                                                   \
    } else {                                                                                                           \
      goto stop;                                                                                                       \
    }                                                                                                                  \
    word;                                                                                                              \
  }))
#define STORE(ADDRESS, VALUE, BYTES)                                                                                   \
  do {                                                                                                                 \
    address = (ADDRESS);                                                                                               \
    word = (VALUE);                                                                                                    \
    if (EXACTLY)                                                                                                       \
      burst->access[loads].address = address; /* for an observer */                                                    \
    if (address >= TRAX_LOCAL_BASE && !(address & (BYTES - 1))) {                                                      \
      struct trax_burst_access *const undo = &burst->access[--burst->undo_begin];                                      \
      uint8_t *const place = local + ((address - TRAX_LOCAL_BASE) & ~3u);                                              \
      undo->address = address & ~3u;                                                                                   \
      memcpy(&undo->word, place, sizeof undo->word);                                                                   \
      memcpy(place + (address & 3), &word, BYTES);                                                                     \
    } else if (alone ? store_ahead(chip, tp, loads, address, word, BYTES)                                              \
                     : store_later(tm, tp, loads, address, word, BYTES)) {                                             \
      at = AT;                                                                                                         \
      burst->access[loads++].address = address;                                                                        \
      burst->step[at] |=                                                                                               \
          (uint16_t)(TRAX_STEP_BANK | TRAX_STEP_SLOW | data_bank(banks, bank_mask, address) << TRAX_STEP_BANK_SHIFT);  \
    } else {                                                                                                           \
      goto stop;                                                                                                       \
    }                                                                                                                  \
  } while (0)
#define ATOMIC_INC(ADDRESS)                                                                                            \
  (__extension__({                                                                                                     \
    (void)(ADDRESS);                                                                                                   \
    goto stop;                                                                                                         \
    0u;                                                                                                                \
  }))
#define SPECIAL_REGISTER(NUMBER) trax_tp_special_register(tm, number, NUMBER, 0) /* the cycle ends a burst */
#define TRAP(VALUE, CODE) goto stop
#define FENCE(KIND) goto stop
#define HALT() goto stop

/* Each operation jumps to the next one by itself, which the host's branch predictor learns far better than one switch
   for all operations. */
#if EXACTLY
#define GO_ON() goto chunk
#else
#define GO_ON() __extension__({ goto * inst->operation; })
#endif
#define TRAX_SEMANTICS(NAME, ...)                                                                                      \
  do_##NAME : {                                                                                                        \
    uint64_t next_pc = NOWHERE;                                                                                        \
    __VA_ARGS__                                                                                                        \
    /* A relative jump's target is imm / 4 away and not the next one: all others end bursts (jumps_oddly). */          \
    const bool is_relative = (TRAX_FLAGS_##NAME & TRAX_IS_RELATIVE) != 0;                                              \
    if (next_pc != NOWHERE && (is_relative || (uint32_t)next_pc != PC + 4)) {                                          \
      jumps++;                                                                                                         \
      at = AT;                                                                                                         \
      burst->step[at] |= slow_jump;                                                                                    \
      count_deltas[inst + 1 - program->inst]--;                                                                        \
      if (is_relative) {                                                                                               \
        inst += inst->imm / 4;                                                                                         \
      } else {                                                                                                         \
        inst = trax_fast_inst_at(program, (uint32_t)next_pc);                                                          \
        resume_pc = next_pc;                                                                                           \
      }                                                                                                                \
      count_deltas[inst - program->inst]++;                                                                            \
      begin = (uintptr_t)inst - (at + 1) * sizeof *inst;                                                               \
      goto chunk;                                                                                                      \
    } else {                                                                                                           \
      inst++;                                                                                                          \
    }                                                                                                                  \
    GO_ON();                                                                                                           \
  }
#include "trax/semantics.inc"
#undef TRAX_SEMANTICS
#include "machine/semantics_end.h"

chunk:
  at = AT;
  const uint32_t index = (uint32_t)(inst - program->inst);
  lines |= program->chunk_lines[index];
  if (index - first + TRAX_REACH > 2 * TRAX_REACH)
    goto stop;
#if EXACTLY
  if (at == limit || (program->timing[index].waits & (uint32_t)tp->atomics))
    goto stop;
  record(burst, at, program, index, 1);
#else
  if (at + TRAX_CHUNK - index % TRAX_CHUNK > limit)
    goto stop;
  record(burst, at, program, index, TRAX_CHUNK); /* also steps that are not reached */
#endif
  __extension__({ goto *places[inst->op]; });

stop:
  count_deltas[inst - program->inst]--;
  tp->resume = inst;
  tp->resume_pc = inst == program->no_text ? (uint32_t)resume_pc : program->timing[inst - program->inst].pc;
  burst->jumps = jumps;
  burst->lines = lines;
  burst->load_count = loads;
  return AT;
}

#undef BURST
#undef EXACTLY
#undef AT
#undef GO_ON
