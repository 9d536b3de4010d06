/* The interpreter loop, included by functional.c. Each operation jumps to the next one by itself, which the host's
   branch predictor learns far better than one switch for all operations. */

enum stop { STOP_SLICE, STOP_SLOW };

/* Executes instructions from thread->pc on, until a jump after which the thread has executed `end` instructions or
   more, or until execute() must execute the next one (STOP_SLOW). If thread is NULL, it only sets *operations to the
   labels of all operations. */
static enum stop run_slice(struct chip *chip, struct thread *thread, uint64_t end, const void *const **operations) {
  __extension__ static const void *const places[] = {
#define TRAX_SEMANTICS(NAME, ...) [TRAX_OP_##NAME] = &&do_##NAME,
#include "trax/semantics.inc"
#undef TRAX_SEMANTICS
      [TRAX_OP_ILLEGAL] = &&slow};
  if (!thread) {
    *operations = places;
    return STOP_SLICE;
  }
  const struct trax_space *const space = &chip->machine->space;
  const uint64_t accessible = space->size - TRAX_NULL_END;
  const unsigned bits = chip->machine->config.special.precision_bits;
  uint32_t *const reg = thread->reg;
  uint8_t *const local = thread->local;
  const struct text *const text = &chip->text;
  int64_t *const deltas = chip->deltas[thread->tm];
  const struct instruction *const base = text->inst;
  const struct segment *const first = text->segments;
  const struct instruction *inst = inst_at(text, thread->pc), *begin = inst;
  uint64_t count = thread->executed;
  uint32_t address, word, pc = thread->pc;
  if (inst == text->not_text)
    return STOP_SLOW;
  deltas[inst - base]++;
  __extension__({ goto * inst->operation; });

/* The pc of inst; pc is the target of the latest jump. */
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
    if (address - TRAX_NULL_END < accessible && !(space->restrictions[address / TRAX_GRANULE] & TRAX_HAS_HOLE))        \
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
             !(space->restrictions[address / TRAX_GRANULE] & (TRAX_RESTRICT_WRITE | TRAX_HAS_HOLE)))                   \
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
#define SPECIAL_REGISTER(NUMBER)                                                                                       \
  trax_special_register(&chip->machine->config, thread->number, NUMBER, count + (uint64_t)(inst - begin))
#define TRAP(VALUE, CODE) goto slow
#define FENCE(KIND) goto slow
#define HALT() goto slow
#define NOWHERE UINT64_MAX
#define TRAX_SEMANTICS(NAME, ...)                                                                                      \
  do_##NAME : {                                                                                                        \
    uint64_t next_pc = NOWHERE;                                                                                        \
    __VA_ARGS__                                                                                                        \
    if (next_pc != NOWHERE) {                                                                                          \
      deltas[inst + 1 - base]--;                                                                                       \
      count += (uint64_t)(inst + 1 - begin);                                                                           \
      pc = (uint32_t)next_pc;                                                                                          \
      begin = inst =                                                                                                   \
          pc % 4 == 0 && pc - first->begin < first->bytes ? first->inst + (pc - first->begin) / 4 : inst_at(text, pc); \
      if (count >= end || inst == text->not_text)                                                                      \
        goto jumped;                                                                                                   \
      deltas[inst - base]++;                                                                                           \
    } else {                                                                                                           \
      inst++;                                                                                                          \
    }                                                                                                                  \
    __extension__({ goto * inst->operation; });                                                                        \
  }
#include "trax/semantics.inc"
#undef TRAX_SEMANTICS
#include "machine/semantics_end.h"
#undef NOWHERE

slow:
  deltas[inst - base]--;
  pc = HERE;
#undef HERE
  thread->executed = count + (uint64_t)(inst - begin);
  thread->pc = pc;
  return STOP_SLOW;

jumped:
  thread->executed = count;
  thread->pc = pc;
  return inst == text->not_text ? STOP_SLOW : STOP_SLICE;
}
