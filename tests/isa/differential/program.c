#include "program.h"

#include <string.h>

#include "trax/abi.h"

const char *const program_kind_names[PROGRAM_KINDS] = {"one thread", "threads", "words of any bits"};

/* DATA: KB for each thread, then words that nobody writes, then counters that all threads increment. */
enum {
  OWN_BYTES = 1024,    /* of a thread: */
  OWN_WORDS = 256,     /* bytes that it loads and stores, */
  OWN_COUNTERS = 64,   /* bytes behind them that it increments, */
  OWN_REGISTERS = 512, /* where its registers are at the end */
  COMMON = 0x8000,     /* offset in DATA: 16 kB of corner values */
  COMMON_BYTES = 0x4000,
  COMMON_COUNTERS = 0xC000, /* offset in DATA: 64 bytes */
  REGION = 60,              /* elements of the outermost region */
  MOST_ELEMENTS = 64,
  ENOUGH = MOST_WORDS / 2 /* words: no further elements */
};
_Static_assert(MOST_PROGRAM_THREADS *OWN_BYTES <= COMMON, "a thread's KB");

/* Registers with a purpose; the others, r0 too, are values. Which they are differs from program to program. */
enum role { OWN, CONSTANTS, OUTER_LOOP, INNER_LOOP, ROLES };

struct program {
  uint32_t *words;
  size_t count;
  enum program_kind kind;
  uint32_t memory_end;
  uint8_t role[ROLES];
};

static bool one_in(unsigned times) {
  return any(1, times) == 1;
}

static uint32_t any_bits(void) {
  const uint32_t high = any(0, 0xFFFF);
  return high << 16 | any(0, 0xFFFF);
}

/* --- corner values --- */

static uint32_t any_corner(void) {
  static const uint32_t corners[] = {
      0, 1, 2, 3, 4, 31, 32, 33, 0x7F, 0x80, 0xFF, 0x100, 0x7FFF, 0x8000, 0xFFFF, 0x10000, 0x7FFFFFFF, 0x80000000,
      0x80000001, 0xFFFFFFFE, 0xFFFFFFFF, 0xFFFF8000, 0xFFFFFF80, 0x55555555, 0xAAAAAAAA,
      /* floats: infinities, NaNs quiet and signalling, the ends of subnormal and normal numbers, one and its neighbours
       */
      0x7F800000, 0xFF800000, 0x7FC00000, 0xFFC00000, 0x7F800001, 0xFFBFFFFF, 0x7FFFFFFF, 0x00000001, 0x007FFFFF,
      0x80000001, 0x807FFFFF, 0x00800000, 0x80800000, 0x7F7FFFFF, 0xFF7FFFFF, 0x3F800000, 0xBF800000, 0x3F7FFFFF,
      0x3F800001, 0x40000000, 0x3F000000, 0x3EFFFFFF, 0x3FC00000, 0x40200000,
      /* where conversions saturate, and where floats leave out integers */
      0x4B000000, 0x4B7FFFFF, 0x4B800000, 0x4EFFFFFF, 0x4F000000, 0xCF000000, 0xCF000001, 0x4F7FFFFF, 0x4F800000,
      0x01000001, 0x01000003, 0x7FFFFFBF, 0x7FFFFFC0, 0xFFFFFF7F, 0xFFFFFF80, 0xFEFFFFFF};
  static const uint32_t foremost[] = {0,          1,          0xFFFFFFFF, 0x80000000, 0x7FFFFFFF,
                                      32,         0x7F800000, 0xFF800000, 0x7FC00000, 0x7F800001,
                                      0x3F800000, 0x00000001, 0x7F7FFFFF, 0x00800000};
  const uint32_t power = 1u << any(0, 31);
  if (one_in(2))
    return foremost[any(0, sizeof foremost / sizeof *foremost - 1)];
  switch (any(0, 7)) {
  case 0:
    return power;
  case 1:
    return power - 1;
  case 2:
    return ~power;
  case 3: /* a float of moderate size: sums cancel, products do not overflow */
    return any(0, 1) << 31 | any(117, 137) << 23 | (any_bits() & 0x7FFFFF);
  case 4: /* any float, its last bits likely equal */
    return any(0, 1) << 31 | any(0, 255) << 23 | (any(0, 1) ? any(0, 3) : 0x7FFFFF - any(0, 3));
  case 5:
    return any_bits();
  default:
    return corners[any(0, sizeof corners / sizeof *corners - 1)];
  }
}

void program_data(uint8_t *bytes) {
  for (uint32_t at = 0; at < DATA_BYTES; at += 4) {
    const uint32_t word = any_corner();
    memcpy(bytes + at, &word, 4);
  }
}

/* --- single instructions --- */

static void emit(struct program *program, uint32_t word) {
  assert_true(program->count < MOST_WORDS);
  program->words[program->count++] = word;
}

static unsigned any_register(void) {
  return any(0, 31);
}

static bool may_be_written(const struct program *program, unsigned reg) {
  bool free = reg != 0;
  for (unsigned i = 0; i < ROLES; i++)
    free &= reg != program->role[i];
  return free;
}

/* One that may be written: not a role's. Once in a while r0. */
static unsigned any_destination(const struct program *program) {
  while (true) {
    const unsigned reg = any_register();
    if (reg == 0 || may_be_written(program, reg))
      return reg;
  }
}

static unsigned any_value_register(const struct program *program) {
  unsigned reg;
  do
    reg = any_destination(program);
  while (reg == 0);
  return reg;
}

static void emit_constant(struct program *program, unsigned reg, uint32_t value) {
  const int32_t low = (int32_t)(value & 0xFFFF) - (value & 0x8000 ? 0x10000 : 0);
  if (value + 0x8000 < 0x10000) {
    emit(program, I(ADDI, reg, 0, low));
    return;
  }
  emit(program, U(LUI, reg, (int32_t)((value + 0x8000) >> 16 & 0xFFFF)));
  if (low)
    emit(program, I(ADDI, reg, reg, low));
}

static int32_t any_immediate(trax_op op) {
  static const int32_t corners[] = {0, 1, -1, 2, -2, 4, 255, 256, -256, 32767, -32768, 32766, -32767};
  const bool is_unsigned = trax_op_table[op].format == TRAX_FORMAT_U;
  if (trax_op_table[op].format == TRAX_FORMAT_SH)
    return (int32_t)any(0, 31);
  const int32_t value = one_in(2)   ? corners[any(0, sizeof corners / sizeof *corners - 1)]
                        : one_in(2) ? (int32_t)(1u << any(0, 14))
                                    : (int32_t)any(0, 65535) - 32768;
  return is_unsigned ? value & 0xFFFF : value;
}

/* An instruction that computes a register from registers and immediate. */
static bool computes(trax_op op) {
  const trax_op_info *info = &trax_op_table[op];
  return info->flags & TRAX_WRITES_RD && !info->access_bytes && !(info->flags & TRAX_IS_BRANCH) && op != TRAX_OP_RDSR;
}

static void emit_corner(struct program *program, unsigned reg) {
  if (one_in(3))
    emit_constant(program, reg, any_corner());
  else
    emit(program, I(LW, reg, program->role[CONSTANTS], 4 * (int32_t)any(0, COMMON_BYTES / 4 - 1)));
}

/* Returns the first of registers that follow one another. If possible, all may be written, and none is in `taken`. */
static uint8_t any_group(const struct program *program, unsigned count, uint32_t taken) {
  unsigned first = 0;
  for (unsigned tries = 0, good = 0; tries < 64 && good < count; tries++) {
    first = any_register();
    for (good = 0; good < count && may_be_written(program, (first + good) % TRAX_NUM_REGISTERS) &&
                   !(taken >> (first + good) % TRAX_NUM_REGISTERS & 1);)
      good++;
  }
  return (uint8_t)first;
}

static uint32_t upper_half(int32_t value) {
  const float as_float = (float)value;
  uint32_t word;
  memcpy(&word, &as_float, sizeof word);
  return word >> 16;
}

/* Upper halves of floats, in the order of ftri's groups. */
struct ray_and_triangle {
  uint32_t origin[3], way[3], corners[3][3];
};

/* A ray that meets a triangle inside it, on an edge or in a corner: small integers, so nothing is rounded. */
static void meet_exactly(struct ray_and_triangle *values) {
  const int32_t along = (int32_t)any(0, 4), up = (int32_t)any(0, 4 - (uint32_t)along), far = (int32_t)any(1, 3);
  for (unsigned axis = 0; axis < 3; axis++) {
    const int32_t corner = (int32_t)any(0, 8) - 4, a = (int32_t)any(0, 4) - 2, b = (int32_t)any(0, 4) - 2;
    const int32_t step = (int32_t)any(0, 6) - 3;
    values->origin[axis] = upper_half(corner + along * a + up * b - far * step);
    values->way[axis] = upper_half(step);
    values->corners[0][axis] = upper_half(corner);
    values->corners[1][axis] = upper_half(corner + 4 * a);
    values->corners[2][axis] = upper_half(corner + 4 * b);
  }
}

/* A ray along an axis through the first corner: it meets both edges there, however their area is rounded. */
static void meet_corner(struct ray_and_triangle *values) {
  const unsigned along = any(0, 2);
  for (unsigned axis = 0; axis < 3; axis++)
    if (axis != along)
      values->origin[axis] = values->corners[0][axis], values->way[axis] = 0;
}

/* Groups of small floats, so that rays meet boxes and triangles. */
static void emit_groups(struct program *program, trax_inst *inst) {
  union {
    struct ray_and_triangle meeting;
    uint32_t all[sizeof(struct ray_and_triangle) / 4];
  } values;
  const unsigned flags = trax_op_table[inst->op].flags, first = trax_group_a(flags), second = trax_group_b(flags);
  uint32_t taken = 1u << inst->rd;
  inst->rb = any_group(program, second, taken); /* the longer one, while there is room */
  for (unsigned i = 0; i < second; i++)
    taken |= 1u << (inst->rb + i) % TRAX_NUM_REGISTERS;
  inst->ra = any_group(program, first, taken);
  for (unsigned i = 0; i < sizeof values / 4; i++)
    values.all[i] = any(0, 1) << 15 | any(122, 129) << 7 | any(0, 127);
  const unsigned kind = inst->op == TRAX_OP_FTRI ? any(0, 2) : 0;
  if (kind == 1)
    meet_exactly(&values.meeting);
  else if (kind == 2)
    meet_corner(&values.meeting);
  for (unsigned i = 0; i < first + second; i++) {
    const unsigned reg = (i < first ? inst->ra + i : inst->rb + i - first) % TRAX_NUM_REGISTERS;
    if (may_be_written(program, reg))
      emit(program, U(LUI, reg, (int32_t)values.all[i]));
  }
  if (inst->rd)
    emit_constant(program, inst->rd, 0x7F800000);
}

/* Corner values come as often as results of earlier instructions, which soon have none. */
static void emit_computation(struct program *program) {
  trax_op op;
  do
    op = (trax_op)any(1, TRAX_OP_COUNT - 1);
  while (!computes(op));
  trax_inst inst = {.op = op, .imm = 0};
  inst.rd = (uint8_t)any_destination(program);
  inst.ra = (uint8_t)(one_in(6) ? inst.rd : any_register());
  inst.rb = (uint8_t)(one_in(6) ? inst.ra : one_in(6) ? inst.rd : any_register());
  const trax_format format = trax_op_table[op].format;
  if (format == TRAX_FORMAT_I || format == TRAX_FORMAT_U || format == TRAX_FORMAT_SH)
    inst.imm = any_immediate(op);
  if (format == TRAX_FORMAT_I && one_in(4)) { /* beside the immediate */
    inst.ra = (uint8_t)any_value_register(program);
    emit_constant(program, inst.ra, (uint32_t)inst.imm + any(0, 2) - 1);
  } else if (one_in(2)) {
    inst.ra = (uint8_t)any_value_register(program);
    emit_corner(program, inst.ra);
  }
  if (trax_op_table[op].flags & TRAX_READS_RB && one_in(2)) {
    inst.rb = (uint8_t)any_value_register(program);
    emit_corner(program, inst.rb);
  }
  const unsigned flags = trax_op_table[op].flags;
  if (trax_group_b(flags) > 1 && one_in(2))
    emit_groups(program, &inst);
  emit(program, trax_encode(inst));
}

static bool is_store(trax_op op) {
  return (trax_op_table[op].flags & TRAX_IS_STORE) != 0;
}

/* A load or store: no ainc, which no later access of the word may overtake. */
static trax_op any_access(bool must_load) {
  while (true) {
    const trax_op op = (trax_op)any(1, TRAX_OP_COUNT - 1);
    const trax_op_info *info = &trax_op_table[op];
    if (info->access_bytes && !(info->flags & TRAX_IS_ATOMIC) && !(must_load && is_store(op)))
      return op;
  }
}

/* An access to a register's value plus offset. The result of an ainc is waited for, before the thread does anything
   that depends on whether the increment has happened. */
static void emit_access(struct program *program, trax_op op, unsigned base, int32_t offset) {
  trax_inst inst = {.op = op, .imm = offset};
  inst.ra = (uint8_t)base;
  if (is_store(op))
    inst.rb = (uint8_t)any_register();
  else
    inst.rd = (uint8_t)(op == TRAX_OP_AINC ? any_value_register(program) : any_destination(program));
  emit(program, trax_encode(inst));
  if (op == TRAX_OP_AINC)
    emit(program, R(ADD, any_destination(program), inst.rd, any_register()));
}

/* The same through an address and an immediate that add up, the immediate anything. */
static void emit_far_access(struct program *program, trax_op op, unsigned base, int32_t offset) {
  const unsigned address = any_value_register(program);
  const int32_t immediate = any_immediate(op);
  emit_constant(program, address, (uint32_t)offset - (uint32_t)immediate);
  if (base)
    emit(program, R(ADD, address, address, base));
  emit_access(program, op, address, immediate);
}

static void emit_memory(struct program *program) {
  const bool local = one_in(3), common = !local && one_in(3);
  const trax_op op = any_access(common);
  const int32_t bytes = (int32_t)trax_op_table[op].access_bytes;
  const unsigned base = local ? 0 : program->role[common ? CONSTANTS : OWN];
  int32_t offset = bytes * (int32_t)any(0, (uint32_t)((local    ? (int)TRAX_LOCAL_SIZE
                                                       : common ? COMMON_BYTES
                                                                : OWN_WORDS) /
                                                      bytes) -
                                               1);
  if (one_in(4)) /* the same words often */
    offset &= 31;
  if (local)
    offset -= (int32_t)TRAX_LOCAL_SIZE;
  if (one_in(4))
    emit_far_access(program, op, base, offset);
  else
    emit_access(program, op, base, offset);
}

static void emit_increment(struct program *program) {
  if (program->kind == PROGRAM_TOGETHER && one_in(2))
    emit(program, I(AINC, 0, program->role[CONSTANTS], COMMON_COUNTERS - COMMON + 4 * (int32_t)any(0, 15)));
  else
    emit_access(program, TRAX_OP_AINC, program->role[OWN], OWN_WORDS + 4 * (int32_t)any(0, OWN_COUNTERS / 4 - 1));
}

static void emit_fence(struct program *program) {
  const trax_inst fence = {.op = TRAX_OP_FENCE, .imm = (int32_t)any(TRAX_FENCE_R, TRAX_FENCE_RW)};
  emit(program, trax_encode(fence));
}

static void emit_special_register(struct program *program) {
  emit(program, U(RDSR, any_destination(program), (int32_t)any(TRAX_SR_THREAD, TRAX_SR_THREADS)));
}

static void emit_trap(struct program *program) {
  if (program->kind == PROGRAM_TOGETHER || one_in(2)) /* output is in the order of time */
    emit(program, T(any_register(), (int32_t)any(TRAX_TRAP_RAYS, TRAX_TRAP_ITEMS)));
  else if (one_in(2))
    emit(program, T(any_register(), TRAX_TRAP_PUTC));
  else { /* a string in the thread's words or in local memory, made sure to end */
    const unsigned address = any_value_register(program);
    const bool local = one_in(2);
    emit(program, S(SB, 0, local ? 0 : program->role[OWN], local ? -1 : OWN_WORDS - 1));
    emit(program, I(ADDI, address, local ? 0 : program->role[OWN],
                    local ? -(int32_t)any(1, TRAX_LOCAL_SIZE) : (int32_t)any(0, OWN_WORDS - 1)));
    emit(program, T(address, TRAX_TRAP_PUTS));
  }
}

/* --- faults --- */

static uint32_t any_illegal_word(void) {
  while (true) {
    uint32_t word = any_bits();
    if (one_in(2)) { /* one bit from a legal one */
      trax_inst inst = {.op = (trax_op)any(1, TRAX_OP_COUNT - 1)};
      inst.rd = (uint8_t)any_register();
      word = trax_encode(inst) ^ 1u << any(0, 31);
    }
    if (trax_decode(word).op == TRAX_OP_ILLEGAL)
      return word;
  }
}

static void emit_access_to(struct program *program, trax_op op, uint32_t address) {
  emit_far_access(program, op, 0, (int32_t)address);
}

static uint32_t any_between(uint32_t first, uint32_t last) {
  const uint64_t offset = any_bits() % ((uint64_t)last - first + 1);
  return one_in(4) ? first : one_in(4) ? last : first + (uint32_t)offset;
}

static trax_op any_memory_op(void) {
  trax_op op;
  do
    op = (trax_op)any(1, TRAX_OP_COUNT - 1);
  while (!trax_op_table[op].access_bytes);
  return op;
}

/* Something that the machine does not allow, mostly. */
static void emit_fault(struct program *program) {
  const trax_op op = any_memory_op();
  const unsigned reg = any_value_register(program);
  switch (any(0, 12)) {
  case 0: /* null */
    emit_access_to(program, op, any_between(0, TRAX_NULL_END - 1));
    break;
  case 1: /* stack */
    emit_access_to(program, op, any_between(TRAX_LOCAL_BASE - 0x10000, TRAX_LOCAL_BASE - 1));
    break;
  case 2: /* unmapped */
    emit_access_to(program, op, any_between(program->memory_end, TRAX_LOCAL_BASE - 0x10001));
    break;
  case 3: /* misaligned, or not */
    emit_access(program, op, program->role[OWN], (int32_t)any(0, OWN_WORDS - 4));
    break;
  case 4: /* read-only */
    emit_access_to(program, one_in(2) ? TRAX_OP_SB : op,
                   one_in(2) ? any_between(RODATA, RODATA + 63) : any_between(TEXT, TEXT + 255));
    break;
  case 5: /* local, or misaligned */
    emit_access_to(program, TRAX_OP_AINC,
                   any_between(TRAX_LOCAL_BASE, 0xFFFFFFFF) & (one_in(4) ? 0xFFFFFFFF : 0xFFFFFFFC));
    break;
  case 6: /* a jump to nowhere, or to data */
    emit_constant(program, reg, one_in(3) ? any_corner() : any_between(TEXT - 8, TEXT + 4 * MOST_WORDS));
    emit(program, I(JALR, any_destination(program), reg, any_immediate(TRAX_OP_JALR)));
    break;
  case 7:
    emit(program, one_in(2) ? J(any_destination(program), 4 * ((int32_t)any(0, 0x1FFFFF) - 0x100000))
                            : B(BGEU, any_register(), 0, 4 * ((int32_t)any(0, 0xFFFF) - 0x8000)));
    break;
  case 8:
    emit(program, any_illegal_word());
    break;
  case 9:
    emit(program, T(any_register(), TRAX_TRAP_ABORT));
    break;
  case 10: /* a string that leaves memory, at either end */
    emit_constant(program, reg, one_in(2) ? program->memory_end - 1 : 0xFFFFFFFF);
    emit(program, S(SB, one_in(2) ? reg : 0, reg, 0));
    emit(program, T(reg, TRAX_TRAP_PUTS));
    break;
  case 11:
    emit(program, T(any_register(), TRAX_TRAP_PUTS));
    break;
  default: /* the first and last bytes of memory */
    emit_access_to(program, op,
                   one_in(2)   ? any_between(program->memory_end - 8, program->memory_end + 3)
                   : one_in(2) ? any_between(TRAX_LOCAL_BASE - 4, TRAX_LOCAL_BASE + 4)
                               : any_between(0xFFFFFFF8, 0xFFFFFFFF));
    break;
  }
}

/* --- regions: elements one behind the other, branches between them --- */

static void emit_region(struct program *program, unsigned elements, unsigned depth);

/* Counts down by one, and goes back as one of the branches says; a few turns. */
static void emit_loop(struct program *program, unsigned depth) {
  const unsigned counter = program->role[depth == 0 ? OUTER_LOOP : INNER_LOOP], constants = program->role[CONSTANTS];
  const struct {
    unsigned base; /* the counter begins so far above this register's value, */
    int32_t above;
    trax_op back; /* and these compare it in the end */
    unsigned ra, rb;
  } loops[] = {{0, (int32_t)any(1, 5), TRAX_OP_BNE, counter, 0},
               {0, 1, TRAX_OP_BEQ, counter, 0},
               {0, (int32_t)any(1, 5), TRAX_OP_BLT, 0, counter},
               {0, (int32_t)any(1, 5), TRAX_OP_BGE, counter, 0},
               {0, (int32_t)any(1, 5), TRAX_OP_BLTU, 0, counter},
               {constants, (int32_t)any(1, 5), TRAX_OP_BGEU, counter, constants}};
  const unsigned kind = any(0, sizeof loops / sizeof *loops - 1);
  emit(program, I(ADDI, counter, loops[kind].base, loops[kind].above));
  const size_t begin = program->count;
  emit_region(program, any(1, 8), depth + 1);
  emit(program, I(ADDI, counter, counter, -1));
  emit(program, trax_encode((trax_inst){.op = loops[kind].back,
                                        .ra = (uint8_t)loops[kind].ra,
                                        .rb = (uint8_t)loops[kind].rb,
                                        .imm = 4 * ((int32_t)begin - (int32_t)program->count)}));
}

/* A call of what is behind the next instructions, through a register: the link of a jal, and a distance in two parts.
 */
static void emit_call(struct program *program) {
  const unsigned link = any_value_register(program);
  const unsigned skipped = any(0, 3);
  const int32_t distance = 8 + 4 * (int32_t)skipped, some = any_immediate(TRAX_OP_ADDI);
  const int32_t part = distance - some < -32768 || distance - some > 32767 ? 0 : some;
  emit(program, J(link, 4));
  emit(program, I(ADDI, link, link, part));
  emit(program, I(JALR, any_destination(program), link, distance - part));
  for (unsigned i = 0; i < skipped; i++)
    emit_computation(program);
}

static void emit_element(struct program *program, unsigned depth) {
  switch (any(0, 19)) {
  case 0:
  case 1:
  case 2:
  case 3:
    emit_memory(program);
    break;
  case 4:
    emit_corner(program, any_value_register(program));
    break;
  case 6:
    emit_increment(program);
    break;
  case 7:
    if (one_in(3))
      emit_fence(program);
    else
      emit_special_register(program);
    break;
  case 8:
    emit_trap(program);
    break;
  case 9:
    emit_call(program);
    break;
  case 10:
    if (depth < 2)
      emit_loop(program, depth);
    break;
  default:
    for (unsigned left = any(1, 5); left; left--)
      emit_computation(program);
  }
}

static bool is_relative(trax_op op) {
  return trax_op_table[op].flags & TRAX_IS_BRANCH && op != TRAX_OP_JALR;
}

/* A branch or jal whose target is set later. */
static void emit_branch(struct program *program) {
  trax_inst inst = {.op = TRAX_OP_JAL};
  if (!one_in(6))
    do
      inst.op = (trax_op)any(1, TRAX_OP_COUNT - 1);
    while (!is_relative(inst.op));
  if (trax_op_table[inst.op].flags & TRAX_WRITES_RD)
    inst.rd = (uint8_t)any_destination(program);
  else {
    inst.ra = (uint8_t)any_register();
    inst.rb = (uint8_t)(one_in(4) ? inst.ra : any_register());
  }
  emit(program, trax_encode(inst));
}

/* Forward within the region, so that no loop is entered in its middle. */
static void emit_region(struct program *program, unsigned elements, unsigned depth) {
  size_t begin[MOST_ELEMENTS + 1];
  bool branches[MOST_ELEMENTS] = {false};
  for (unsigned i = 0; i < elements; i++) {
    begin[i] = program->count;
    if (program->count > ENOUGH) {
      elements = i;
      break;
    }
    branches[i] = one_in(6);
    if (branches[i])
      emit_branch(program);
    else
      emit_element(program, depth);
  }
  begin[elements] = program->count;
  for (unsigned i = 0; i < elements; i++)
    if (branches[i]) {
      const unsigned target = any(i + 1, elements < i + 6 ? elements : i + 6);
      trax_inst inst = trax_decode(program->words[begin[i]]);
      inst.imm = 4 * ((int32_t)begin[target] - (int32_t)begin[i]);
      program->words[begin[i]] = trax_encode(inst);
    }
}

/* --- programs --- */

static void choose_roles(struct program *program) {
  for (unsigned i = 0; i < ROLES; i++) {
    bool taken = true;
    while (taken) {
      program->role[i] = (uint8_t)any(1, 31);
      taken = false;
      for (unsigned j = 0; j < i; j++)
        taken |= program->role[i] == program->role[j];
    }
  }
}

static void emit_prologue(struct program *program) {
  const unsigned own = program->role[OWN], constants = program->role[CONSTANTS], scratch = program->role[INNER_LOOP];
  for (unsigned i = 0; i < 4; i++) /* the registers after reset */
    emit(program, S(SW, any_register(), 0, -4 - 4 * (int32_t)any(0, 127)));
  emit(program, U(RDSR, own, TRAX_SR_THREAD));
  emit(program, I(SLLI, own, own, 10));
  emit(program, U(LUI, scratch, DATA >> 16));
  emit(program, R(ADD, own, own, scratch));
  emit_constant(program, constants, DATA + COMMON);
  for (unsigned i = 0; i < 12; i++)
    emit_corner(program, any_value_register(program));
}

static void emit_epilogue(struct program *program) {
  for (unsigned reg = 0; reg < TRAX_NUM_REGISTERS; reg++)
    emit(program, S(SW, reg, program->role[OWN], (int32_t)(OWN_REGISTERS + 4 * reg)));
}

static void emit_end(struct program *program) {
  const bool may_fault = program->kind == PROGRAM_ALONE;
  if (may_fault && one_in(2))
    emit_fault(program);
  if (may_fault && one_in(8))
    return; /* the memory after the program is no text */
  emit(program, one_in(2) ? HALT : T(any_register(), TRAX_TRAP_EXIT));
}

static size_t any_words_alone(uint32_t *words) {
  enum { WORDS = 48 };
  any_words(words, WORDS);
  for (size_t i = 0; i < WORDS; i++) {
    const trax_inst inst = trax_decode(words[i]);
    const bool is_time = inst.op == TRAX_OP_RDSR && (inst.imm == TRAX_SR_CYCLE || inst.imm == TRAX_SR_CYCLEH);
    if (is_time || inst.op == TRAX_OP_AINC) /* their results depend on time */
      words[i] = NOP;
  }
  return WORDS;
}

size_t any_differential_program(enum program_kind kind, uint32_t memory_end, uint32_t *words, size_t *prologue) {
  struct program program = {.words = words, .kind = kind, .memory_end = memory_end};
  *prologue = 0;
  if (kind == PROGRAM_WORDS)
    return any_words_alone(words);
  choose_roles(&program);
  emit_prologue(&program);
  *prologue = program.count;
  emit_region(&program, any(8, REGION), 0);
  if (kind == PROGRAM_ALONE && one_in(3)) {
    emit_fault(&program);
    emit_region(&program, any(1, 8), 0);
  }
  emit_epilogue(&program);
  emit_end(&program);
  return program.count;
}
