/* One thread's turn of the functional mode; a part of functional.c.

   Executes the TP's instructions from tp->pc on until `turn` are over, or the next one is for execute_slowly. Without a
   TP: *operations receives the places of all operations. */
static enum stop execute_turn(struct trax_functional *functional, struct trax_tm *tm, struct trax_tp *tp, int64_t turn,
                              uint64_t *executed, const void *const **operations) {
  __extension__ static const void *const places[] = {
#define TRAX_SEMANTICS(NAME, ...) [TRAX_OP_##NAME] = &&do_##NAME,
#include "trax/semantics.inc"
#undef TRAX_SEMANTICS
      [TRAX_OP_ILLEGAL] = &&slow};
  if (!tp) {
    *operations = places;
    return STOP_TURN;
  }
  const struct text *const text = &functional->text;
  const struct trax_space *const space = &functional->chip->machine->space;
  const uint64_t accessible = space->size - TRAX_NULL_END;
  const unsigned bits = tm->config->special.precision_bits;
  const unsigned number = (unsigned)(tp - tm->tp);
  uint32_t *const reg = tp->reg;
  uint8_t *const local = tp->local;
  int64_t *const changes = functional->changes[tm->number];
  const struct instruction *const base = text->inst;
  const struct section *const first = text->sections;
  const struct instruction *inst = inst_at(text, tp->pc), *begin = inst;
  const int64_t end = (int64_t)*executed + turn;
  uint64_t count = *executed;
  uint32_t address, word, pc = tp->pc;
  if (inst == text->outside)
    return STOP_SLOW;
  changes[inst - base]++;
  __extension__({ goto * inst->operation; });

/* The pc of an instruction of the section in which the thread is; pc is that of the last jump's target. */
#define HERE (pc + (uint32_t)(inst - begin) * 4)
#include "machine/semantics_begin.h"
#define PC HERE
#define PRECISION bits
#define LOAD(ADDRESS, BYTES)                                                                                           \
  (__extension__({                                                                                                     \
    address = (ADDRESS);                                                                                               \
    word = 0;                                                                                                          \
    if (address & (BYTES - 1))                                                                                         \
      goto slow;                                                                                                       \
    if (address - TRAX_NULL_END < accessible)                                                                          \
      memcpy(&word, space->bytes + address, BYTES);                                                                    \
    else if (address >= TRAX_LOCAL_BASE)                                                                               \
      memcpy(&word, local + (address - TRAX_LOCAL_BASE), BYTES);                                                       \
    else                                                                                                               \
      goto slow;                                                                                                       \
    word;                                                                                                              \
  }))
#define STORE(ADDRESS, VALUE, BYTES)                                                                                   \
  do {                                                                                                                 \
    address = (ADDRESS);                                                                                               \
    word = (VALUE);                                                                                                    \
    if (address & (BYTES - 1))                                                                                         \
      goto slow;                                                                                                       \
    if (address >= TRAX_LOCAL_BASE)                                                                                    \
      memcpy(local + (address - TRAX_LOCAL_BASE), &word, BYTES);                                                       \
    else if (address - TRAX_NULL_END < accessible &&                                                                   \
             !(space->restrictions[address / TRAX_GRANULE] & TRAX_RESTRICT_WRITE))                                     \
      memcpy(space->bytes + address, &word, BYTES);                                                                    \
    else                                                                                                               \
      goto slow;                                                                                                       \
  } while (0)
#define ATOMIC_INC(ADDRESS)                                                                                            \
  (__extension__({                                                                                                     \
    (void)(ADDRESS);                                                                                                   \
    goto slow;                                                                                                         \
    0u;                                                                                                                \
  }))
#define SPECIAL_REGISTER(NUMBER) trax_tp_special_register(tm, number, NUMBER, count + (uint64_t)(inst - begin))
#define TRAP(VALUE, CODE) goto slow
#define FENCE(KIND) goto slow
#define HALT() goto slow
#define NOWHERE UINT64_MAX
#define TRAX_SEMANTICS(NAME, ...)                                                                                      \
  do_##NAME : {                                                                                                        \
    uint64_t next_pc = NOWHERE;                                                                                        \
    __VA_ARGS__                                                                                                        \
    if (next_pc != NOWHERE) {                                                                                          \
      changes[inst + 1 - base]--;                                                                                      \
      count += (uint64_t)(inst + 1 - begin);                                                                           \
      pc = (uint32_t)next_pc;                                                                                          \
      begin = inst =                                                                                                   \
          pc % 4 == 0 && pc - first->begin < first->bytes ? first->inst + (pc - first->begin) / 4 : inst_at(text, pc); \
      if ((int64_t)count >= end || inst == text->outside)                                                              \
        goto jumped;                                                                                                   \
      changes[inst - base]++;                                                                                          \
    } else {                                                                                                           \
      inst++;                                                                                                          \
    }                                                                                                                  \
    __extension__({ goto * inst->operation; });                                                                        \
  }
#include "trax/semantics.inc"
#undef TRAX_SEMANTICS
#include "machine/semantics_end.h"

slow:
  changes[inst - base]--;
  pc = HERE;
  count += (uint64_t)(inst - begin);
  *executed = count;
  tp->pc = pc;
  return STOP_SLOW;

jumped:
  *executed = count;
  tp->pc = pc;
  return inst == text->outside ? STOP_SLOW : STOP_TURN;
}

#undef HERE
#undef NOWHERE
