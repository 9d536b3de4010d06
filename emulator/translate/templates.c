/* Templates of translated code: each instruction, from its semantics, as a function that extract-templates (extract.c)
   takes out of the object file at build time. A template receives its operands in registers of the host,
   and ends with a jump to a symbol that stands for the place where the translation goes on: translate.c copies the
   template and fills in these places, the immediate and the pc.

   The calling convention is that of Windows, since it keeps more registers than any other: translate.c has registers of
   the thread in them. An operand is in the general or the floating-point register of its position. Of each instruction
   there is a template for each choice; translate.c takes the shortest one. */
#include "translate/burst.h"
#include "translate/state.h"

#include "machine/address_space.h"
#include "trax/isa.h"
#define inline __inline__ __attribute__((always_inline)) /* a template calls nothing */
#include "trax/semantics.h"
#undef inline

#define TEMPLATE __attribute__((ms_abi)) void

/* The targets at which a template continues. */
TEMPLATE trax_goes_on(void);
TEMPLATE trax_goes_on_int(uint32_t rd);
TEMPLATE trax_goes_on_float(float rd);
TEMPLATE trax_jumps(void);            /* to pc + imm */
TEMPLATE trax_links_int(uint32_t rd); /* the same, with a result */
TEMPLATE trax_links_float(float rd);
TEMPLATE trax_jumps_to_int(uint32_t rd, uint32_t next_pc);
TEMPLATE trax_jumps_to_float(float rd, uint32_t next_pc);
TEMPLATE trax_is_slow(void); /* the interpreter must execute this instruction; nothing has happened yet */

/* Constants, as addresses of symbols. They are weak, so that the compiler does not take them for other than 0. */
extern const char trax_imm[] __attribute__((weak)), trax_pc[] __attribute__((weak)),
    trax_precision[] __attribute__((weak)), trax_step[] __attribute__((weak)), trax_bank_mask[] __attribute__((weak)),
    trax_local_step[] __attribute__((weak));
#define CONSTANT(SYMBOL) ((uint32_t)(uintptr_t)(SYMBOL))

/* A member of the state, to which rbx points; split.awk refuses templates that use rbx otherwise, too. Instructions
   that read groups of registers have the state as an operand. */
#define STATE(MEMBER)                                                                                                  \
  (__extension__({                                                                                                     \
    __typeof__(((struct trax_translated *)NULL)->MEMBER) value_;                                                       \
    __asm__("mov %c1(%%rbx), %0 # state" : "=r"(value_) : "i"(offsetof(struct trax_translated, MEMBER)));              \
    value_;                                                                                                            \
  }))

/* Whether the address is in trax_space.input; of bursts: in the part of it that is not written. The constants are
   operands. */
static inline bool is_input(uint32_t address, const bool burst) {
  uint32_t offset;
  bool below;
  __asm__("lea trax_minus_input(%q1), %k0" : "=r"(offset) : "r"(address));
  if (burst)
    return offset < STATE(input_bytes);
  __asm__("cmp $trax_input_bytes, %1" : "=@ccb"(below) : "r"(offset));
  return below;
}

static inline uint32_t from_int(uint32_t value) {
  return value;
}
#define from_float trax_from_float

static inline uint32_t read_bytes(const uint8_t *from, unsigned bytes) {
  uint8_t byte;
  uint16_t half;
  uint32_t word;
  if (bytes == 1)
    return memcpy(&byte, from, sizeof byte), byte;
  if (bytes == 2)
    return memcpy(&half, from, sizeof half), half;
  return memcpy(&word, from, sizeof word), word;
}

/* --- what bursts record: r14 points to the burst, and r15 is the number of the sequence's first step --- */

/* Adds the address to the burst's loads, and its bank to the step. */
static inline void record_load(uint32_t address) {
  const uint32_t step = (address << (TRAX_STEP_BANK_SHIFT - 2) & CONSTANT(trax_bank_mask)) | CONSTANT(trax_step);
  uint64_t load;
  __asm__ volatile("mov %c2(%%r14), %k0 # state\n\tmov %1, %c3(%%r14,%0,8) # state\n\tincl %c2(%%r14) # state"
                   : "=&r"(load)
                   : "r"(address), "i"(offsetof(struct trax_burst, load_count)),
                     "i"(offsetof(struct trax_burst, access))
                   : "memory");
  __asm__ volatile("movw %w0, trax_step_at(%%r14,%%r15,2) # state" : : "r"(step) : "memory");
}

static inline void record_local_load(void) {
  const uint32_t step = CONSTANT(trax_local_step);
  __asm__ volatile("movw %w0, trax_step_at(%%r14,%%r15,2) # state" : : "r"(step) : "memory");
}

/* Records a word of local memory before a store to it. */
static inline void record_undo(uint32_t address, const uint8_t *place) {
  uint64_t undo;
  uint32_t word;
  memcpy(&word, place, sizeof word);
  __asm__ volatile("mov %c3(%%r14), %k0 # state\n\tdec %k0\n\tmov %1, %c4(%%r14,%0,8) # state\n\t"
                   "mov %2, %c4+4(%%r14,%0,8) # state\n\tmov %k0, %c3(%%r14) # state"
                   : "=&r"(undo)
                   : "r"(address), "r"(word), "i"(offsetof(struct trax_burst, undo_begin)),
                     "i"(offsetof(struct trax_burst, access))
                   : "memory");
}

/* Whether a burst can load from the address without being watched; then its block is LOADED. */
static inline bool is_loadable(uint32_t address) {
  uint8_t *const block = STATE(blocks) + (address >> TRAX_BLOCK_SHIFT);
  const uint8_t state = __atomic_load_n(block, __ATOMIC_RELAXED);
  if (state == 0)
    __atomic_store_n(block, TRAX_BLOCK_LOADED, __ATOMIC_RELAXED);
  return state <= TRAX_BLOCK_LOADED;
}

#define SLOW()                                                                                                         \
  (__extension__({                                                                                                     \
    trax_is_slow();                                                                                                    \
    return;                                                                                                            \
    0u;                                                                                                                \
  }))

#include "machine/semantics_begin.h"
#undef RD
#undef RA
#undef RB
#undef GROUP_A
#undef GROUP_B
#undef IMM
#undef LOAD32_NONTEMPORAL
#undef STORE32_NONTEMPORAL
#define RD rd
#define RA ra
#define RB rb
#define GROUP_A(N) state->reg[TRAX_GROUP_A_AT + (N)]
#define GROUP_B(N) state->reg[TRAX_GROUP_B_AT + (N)]
#define IMM CONSTANT(trax_imm)
#define PC CONSTANT(trax_pc)
#define PRECISION CONSTANT(trax_precision)
#define LOAD(ADDRESS, BYTES)                                                                                           \
  (__extension__({                                                                                                     \
    const uint32_t address = (ADDRESS);                                                                                \
    uint32_t word;                                                                                                     \
    if (__builtin_expect((address & (BYTES - 1)) != 0, 0))                                                             \
      SLOW();                                                                                                          \
    if (__builtin_expect(is_input(address, burst), 1)) {                                                               \
      word = read_bytes(STATE(global) + address, BYTES);                                                               \
      if (burst)                                                                                                       \
        record_load(address);                                                                                          \
    } else if (address - TRAX_NULL_END < STATE(accessible) &&                                                          \
               (burst ? is_loadable(address) : !(STATE(restrictions)[address / TRAX_GRANULE] & TRAX_HAS_HOLE))) {      \
      word = read_bytes(STATE(global) + address, BYTES);                                                               \
      if (burst)                                                                                                       \
        record_load(address);                                                                                          \
    } else if (address >= TRAX_LOCAL_BASE) {                                                                           \
      word = read_bytes(STATE(local) + (address - TRAX_LOCAL_BASE), BYTES);                                            \
      if (burst)                                                                                                       \
        record_local_load();                                                                                           \
    } else {                                                                                                           \
      SLOW();                                                                                                          \
    }                                                                                                                  \
    word;                                                                                                              \
  }))
#define STORE(ADDRESS, VALUE, BYTES)                                                                                   \
  do {                                                                                                                 \
    const uint32_t address = (ADDRESS);                                                                                \
    const uint32_t word = (VALUE);                                                                                     \
    if (__builtin_expect((address & (BYTES - 1)) != 0, 0))                                                             \
      SLOW();                                                                                                          \
    if (__builtin_expect(address >= TRAX_LOCAL_BASE, 1)) {                                                             \
      if (burst)                                                                                                       \
        record_undo(address & ~3u, STATE(local) + ((address & ~3u) - TRAX_LOCAL_BASE));                                \
      memcpy(STATE(local) + (address - TRAX_LOCAL_BASE), &word, BYTES);                                                \
    } else if (burst)                                                                                                  \
      SLOW();                                                                                                          \
    else if (address - TRAX_NULL_END < STATE(accessible) &&                                                            \
             !(STATE(restrictions)[address / TRAX_GRANULE] & (TRAX_RESTRICT_WRITE | TRAX_HAS_HOLE)))                   \
      memcpy(STATE(global) + address, &word, BYTES);                                                                   \
    else                                                                                                               \
      SLOW();                                                                                                          \
  } while (0)
#define LOAD32_NONTEMPORAL(ADDRESS) SLOW()
#define STORE32_NONTEMPORAL(ADDRESS, VALUE) SLOW()
#define ATOMIC_INC(ADDRESS) SLOW()
#define SPECIAL_REGISTER(NUMBER) SLOW()
#define TRAP(VALUE, CODE) SLOW()
#define FENCE(KIND) SLOW()
#define HALT() SLOW()
#define NOWHERE UINT64_MAX

#define TRAX_TEMPLATE(KIND, BURST, NAME, A, B, D, ...)                                                                 \
  TEMPLATE trax_##KIND##_##NAME##_##A##_##B##_##D(A##_t a, B##_t b, D##_t d, const struct trax_translated *state) {    \
    const bool burst = BURST;                                                                                          \
    const uint32_t ra = from_##A(a), rb = from_##B(b);                                                                 \
    uint32_t rd = from_##D(d);                                                                                         \
    uint64_t next_pc = NOWHERE;                                                                                        \
    (void)ra, (void)rb, (void)state, (void)burst;                                                                      \
    if (burst && !(TRAX_FLAGS_##NAME & (TRAX_IS_LOAD | TRAX_IS_STORE))) {                                              \
      trax_is_slow(); /* as a burst's template, it is not used */                                                      \
      return;                                                                                                          \
    }                                                                                                                  \
    __VA_ARGS__                                                                                                        \
    if (next_pc != NOWHERE && !(TRAX_FLAGS_##NAME & TRAX_WRITES_RD))                                                   \
      trax_jumps();                                                                                                    \
    else if (next_pc != NOWHERE && (TRAX_FLAGS_##NAME & TRAX_IS_RELATIVE))                                             \
      trax_links_##D(to_##D(rd));                                                                                      \
    else if (next_pc != NOWHERE)                                                                                       \
      trax_jumps_to_##D(to_##D(rd), (uint32_t)next_pc);                                                                \
    else if (!(TRAX_FLAGS_##NAME & TRAX_WRITES_RD))                                                                    \
      trax_goes_on();                                                                                                  \
    else                                                                                                               \
      trax_goes_on_##D(to_##D(rd));                                                                                    \
  }
typedef uint32_t int_t;
#define to_int(VALUE) (VALUE)
#define to_float trax_to_float
#define TRAX_TEMPLATES(KIND, BURST, NAME, ...)                                                                         \
  TRAX_TEMPLATE(KIND, BURST, NAME, int, int, int, __VA_ARGS__)                                                         \
  TRAX_TEMPLATE(KIND, BURST, NAME, int, int, float, __VA_ARGS__)                                                       \
  TRAX_TEMPLATE(KIND, BURST, NAME, int, float, int, __VA_ARGS__)                                                       \
  TRAX_TEMPLATE(KIND, BURST, NAME, int, float, float, __VA_ARGS__)                                                     \
  TRAX_TEMPLATE(KIND, BURST, NAME, float, int, int, __VA_ARGS__)                                                       \
  TRAX_TEMPLATE(KIND, BURST, NAME, float, int, float, __VA_ARGS__)                                                     \
  TRAX_TEMPLATE(KIND, BURST, NAME, float, float, int, __VA_ARGS__)                                                     \
  TRAX_TEMPLATE(KIND, BURST, NAME, float, float, float, __VA_ARGS__)
#define TRAX_SEMANTICS(NAME, ...)                                                                                      \
  TRAX_TEMPLATES(template, false, NAME, __VA_ARGS__)                                                                   \
  TRAX_TEMPLATES(burst, true, NAME, __VA_ARGS__)
#include "trax/semantics.inc"
#undef TRAX_SEMANTICS
#include "machine/semantics_end.h"

/* Finds the target of a jump to a register's value: its byte in the first segment. */
TEMPLATE trax_template_LOOKUP_int_int_int(uint32_t pc, uint32_t b, uint32_t d) {
  const uint32_t offset = pc - STATE(begin);
  (void)b, (void)d;
  __asm__ volatile("mov %0, %c1(%%rbx) # state" : : "r"(pc), "i"(offsetof(struct trax_translated, pc)));
  if (__builtin_expect(offset >= STATE(bytes) || offset % 4, 0))
    trax_is_slow();
  else
    trax_goes_on_int(offset);
}
