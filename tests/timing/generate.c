#include "generate.h"

#include <math.h>
#include <string.h>

uint64_t random_state;

uint32_t any(uint32_t least, uint32_t most) { /* xorshift64* */
  random_state ^= random_state >> 12;
  random_state ^= random_state << 25;
  random_state ^= random_state >> 27;
  return least + (uint32_t)((random_state * 0x2545F4914F6CDD1Du) >> 33) % (most - least + 1);
}

/* An operation and registers. (In an initialiser compilers would draw in an order of their own.) */
static trax_inst any_fields(void) {
  trax_inst inst = {.op = (trax_op)any(1, TRAX_OP_COUNT - 1)};
  inst.rd = (uint8_t)any(0, 31);
  inst.ra = (uint8_t)any(0, 31);
  inst.rb = (uint8_t)any(0, 31);
  return inst;
}

uint32_t any_power(uint32_t least, uint32_t most) {
  uint32_t value = least;
  while (value < most && any(0, 2))
    value *= 2;
  return value;
}

/* --- programs --- */

static uint32_t any_fence(void) {
  return trax_encode((trax_inst){.op = TRAX_OP_FENCE, .imm = (int32_t)any(TRAX_FENCE_R, TRAX_FENCE_RW)});
}

/* An address of local memory. */
static uint32_t any_local_word(unsigned rd, unsigned rb, int32_t offset) {
  switch (any(0, 7)) {
  case 0:
    return S(SWNT, rb, 0, offset);
  case 1:
    return I(LWNT, rd, 0, offset);
  case 2:
  case 3:
  case 4:
    return S(SW, rb, 0, offset);
  default:
    return I(LW, rd, 0, offset);
  }
}

static uint32_t any_operation(unsigned left) {
  static const trax_op plain[] = {TRAX_OP_ADD,    TRAX_OP_SUB,   TRAX_OP_XOR,  TRAX_OP_SLL,   TRAX_OP_SLT,
                                  TRAX_OP_CMOVNZ, TRAX_OP_CMOVZ, TRAX_OP_MUL,  TRAX_OP_MULHU, TRAX_OP_FADD,
                                  TRAX_OP_FSUB,   TRAX_OP_FMUL,  TRAX_OP_FMIN, TRAX_OP_FLE,   TRAX_OP_FDIV,
                                  TRAX_OP_FADD,   TRAX_OP_FMUL,  TRAX_OP_FBOX, TRAX_OP_FTRI};
  static const trax_op single[] = {TRAX_OP_FRSQRT, TRAX_OP_FCVT_W_S, TRAX_OP_FCVT_S_W};
  static const trax_op loads[] = {TRAX_OP_LB, TRAX_OP_LBU, TRAX_OP_LH, TRAX_OP_LHU, TRAX_OP_LW};
  static const trax_op stores[] = {TRAX_OP_SB, TRAX_OP_SH, TRAX_OP_SW};
  const unsigned rd = any(0, 15), ra = any(0, 15), rb = any(0, 15);
  const int32_t own = (int32_t)any(0, 31) * 4;
  switch (any(0, 13)) {
  case 0:
    return I(ADDI, rd, ra, (int32_t)any(0, 65535) - 32768);
  case 1:
    return U(LUI, rd, (int32_t)any(0, 65535));
  case 2:
    return trax_encode((trax_inst){single[any(0, 2)], rd, ra, 0, 0});
  case 3:
    return trax_encode((trax_inst){loads[any(0, 4)], rd, BASE, 0, own});
  case 4:
    return I(LW, rd, SHARED, (int32_t)any(0, 2047) * 4);
  case 5:
    return I(LW, rd, SHARED, (int32_t)any(0, 15) * 4);
  case 6:
    return trax_encode((trax_inst){stores[any(0, 2)], 0, BASE, rb, own});
  case 7:
    return any(0, 1) ? S(SWNT, rb, BASE, own) : I(LWNT, rd, BASE, own);
  case 8:
    return any_local_word(rd, rb, -4 - own);
  case 9:
    return any(0, 7) ? any(0, 2) ? NOP : any_fence() : I(AINC, rd, COUNTER, 0);
  case 10:
    return B(BLT, ra, rb, 4 * (int32_t)any(1, left < 12 ? left : 12)); /* forward, within the body */
  default:
    return R(ADD, rd, ra, rb) ^ R(ADD, 0, 0, 0) ^
           trax_encode((trax_inst){plain[any(0, sizeof plain / sizeof *plain - 1)], 0, 0, 0, 0});
  }
}

/* A loop of BODY operations, and stores of the registers after it. */
static size_t add_loop(uint32_t *words, size_t n, uint32_t (*operation)(unsigned left)) {
  words[n++] = U(RDSR, 3, TRAX_SR_THREAD);
  words[n++] = I(ADDI, LOOP, 0, (int32_t)any(1, 4));
  const size_t begin = n;
  for (unsigned i = 0; i < BODY; i++)
    words[n++] = operation(BODY - i);
  words[n++] = I(ADDI, LOOP, LOOP, -1);
  words[n] = B(BNE, LOOP, 0, ((int32_t)begin - (int32_t)n) * 4);
  n++;
  for (unsigned reg = 1; reg < 16; reg++)
    words[n++] = S(SW, reg, BASE, (int32_t)(128 + 4 * reg));
  return n;
}

size_t any_program(uint32_t *words) {
  size_t n = 0;
  words[n++] = U(RDSR, BASE, TRAX_SR_THREAD);
  words[n++] = I(SLLI, COUNTER, BASE, 2);
  words[n++] = I(SLLI, BASE, BASE, 8);
  words[n++] = U(LUI, 1, 1);
  words[n++] = R(ADD, BASE, BASE, 1);
  words[n++] = R(ADD, COUNTER, COUNTER, 1);
  words[n++] = U(LUI, 2, 1);
  words[n++] = I(ORI, SHARED, 2, 0x6000);
  words[n++] = I(ADDI, SHARED, SHARED, 0x6000);
  words[n++] = I(ADDI, COUNTER, COUNTER, 0x7000);
  words[n++] = I(ADDI, COUNTER, COUNTER, 0x7000);
  n = add_loop(words, n, any_operation);
  words[n++] = HALT;
  return n;
}

static int32_t rays_trap(unsigned ra) {
  return ra & 1 ? TRAX_TRAP_KINDS : TRAX_TRAP_RAYS;
}

/* Bases into four pages of DATA, at most one of them the thread's own. */
static uint32_t any_racing_operation(unsigned left) {
  const unsigned rd = any(0, 15), ra = any(0, 15), base = any(16, 19);
  const int32_t offset = (int32_t)any(0, any(0, 3) ? 3 : 200) * 4;
  switch (any(0, 15)) {
  case 0:
  case 1:
    return I(LW, rd, base, offset);
  case 2:
    return any(0, 1) ? I(LHU, rd, base, offset + 2) : I(LB, rd, base, offset + 3);
  case 3:
    return any(0, 3)   ? S(SW, ra, 0, -4 - offset % 512)
           : any(0, 1) ? S(SW, ra, base, offset)
                       : S(SB, ra, base, offset + 1);
  case 4:
    return any(0, 2) ? any_local_word(rd, ra, -4 - offset % 512) : S(SB, ra, 0, -4 - offset % 512);
  case 5:
    return any(0, 3) ? NOP : any(0, 1) ? S(SWNT, ra, base, offset) : I(LWNT, rd, base, offset);
  case 6:
    return any(0, 3) ? NOP : I(AINC, any(0, 3) ? rd : 0, base, offset);
  case 7:
    return any(0, 1) ? any(0, 2) ? NOP : any_fence() : U(RDSR, rd, (int32_t)any(0, 5));
  case 8:
    if (any(0, 19) == 0) /* a call that there is not, or reads or writes nothing: its result is stored */
      return T(base, TRAX_TRAP_HOST);
    return any(0, 5) ? NOP : T(ra, any(0, 2) ? any(0, 1) ? rays_trap(ra) : TRAX_TRAP_ITEMS : TRAX_TRAP_PUTC);
  case 9:
    return any(0, 60) ? NOP : any(0, 1) ? T(ra, TRAX_TRAP_EXIT) : HALT;
  default:
    return any_operation(left);
  }
}

/* Hardly anything but loads, stores and arithmetic: on the thread's own 16 words, on those of the next thread, on words
   of all threads in two pages, and on local memory. */
static uint32_t any_writing_operation(unsigned left) {
  static const trax_op loads[] = {TRAX_OP_LB, TRAX_OP_LHU, TRAX_OP_LW, TRAX_OP_LW, TRAX_OP_LW};
  static const trax_op stores[] = {TRAX_OP_SB, TRAX_OP_SH, TRAX_OP_SW, TRAX_OP_SW, TRAX_OP_SW};
  const uint8_t rd = (uint8_t)any(0, 15), ra = (uint8_t)any(0, 15);
  const uint8_t base = any(0, 2) ? BASE : (uint8_t)any(16, 17);
  const int32_t offset = 4 * (int32_t)any(0, base == BASE ? 15 : any(0, 1) ? 7 : 63);
  switch (any(0, 11)) {
  case 0:
  case 1:
  case 2:
    return trax_encode((trax_inst){loads[any(0, 4)], rd, base, 0, offset});
  case 3:
  case 4:
  case 5:
    return trax_encode((trax_inst){stores[any(0, 4)], 0, base, ra, offset});
  case 6:
    return any(0, 1) ? I(LW, rd, BASE, 256 + offset) : I(LW, rd, SHARED, 0x6000 + offset);
  case 7:
    return any(0, 3) == 0 ? S(SWNT, ra, base, offset)
           : any(0, 1)    ? S(SW, ra, 0, -4 - offset)
                          : I(LW, rd, 0, -4 - offset);
  case 8:
    return any(0, 7) ? R(FDIV, rd, ra, any(0, 15)) : any_racing_operation(left);
  case 9:
    return any(0, 2) ? R(MUL, rd, ra, any(0, 15)) : B(BLT, rd, ra, 4 * (int32_t)any(1, left < 12 ? left : 12));
  default:
    return R(ADD, rd, ra, any(0, 15));
  }
}

static size_t any_program_of(uint32_t *words, uint32_t (*any_operation_of)(unsigned left)) {
  size_t n = 0;
  words[n++] = U(RDSR, BASE, TRAX_SR_THREAD);
  words[n++] = I(SLLI, COUNTER, BASE, 2);
  words[n++] = I(SLLI, BASE, BASE, 8);
  words[n++] = U(LUI, 1, 1);
  words[n++] = R(ADD, BASE, BASE, 1);
  words[n++] = R(ADD, COUNTER, COUNTER, 1);
  words[n++] = R(ADD, SHARED, 1, 0);
  words[n++] = I(ADDI, 16, 1, 0x4000);
  for (unsigned base = 17; base < 20; base++) /* pages apart */
    words[n++] = I(ADDI, base, base - 1, 0x1000);
  n = add_loop(words, n, any_operation_of);
  words[n++] = any(0, 4) ? HALT : any(0, 1) ? T(1, TRAX_TRAP_ABORT) : I(LW, 1, 0, 0);
  return n;
}

size_t any_racing_program(uint32_t *words) {
  return any_program_of(words, any_racing_operation);
}

size_t any_writing_program(uint32_t *words) {
  return any_program_of(words, any_writing_operation);
}

void any_words(uint32_t *words, size_t count) {
  for (size_t i = 0; i < count; i++) {
    words[i] = any(0, 0x7FFFFFFF) << 1;
    words[i] |= any(0, 1);
    if (any(0, 3)) { /* mostly legal: a random operation with random fields */
      trax_inst inst = any_fields();
      inst.imm = (int32_t)any(0, 63) * 4;
      words[i] = trax_encode(inst);
    }
  }
}

/* --- programs of every instruction --- */

enum {
  READ_ONLY = 24, /* register: RODATA */
  NOWHERE = 25,   /* register: unmapped */
  RACED = 16      /* the first of four registers: pages of DATA that all threads write */
};

static bool seldom(unsigned times) { /* one in so many */
  return any(1, times) == 1;
}

/* An address of `bytes` bytes that `inst` may access, mostly. */
static trax_inst with_address(trax_inst inst, int32_t bytes) {
  const unsigned flags = trax_op_table[inst.op].flags;
  const bool local = !(flags & TRAX_IS_ATOMIC);
  const int32_t within = bytes == 1 ? (int32_t)any(0, 3) : bytes == 2 ? 2 * (int32_t)any(0, 1) : 0;
  switch (any(0, 9)) {
  case 0:
  case 1: /* local memory, or all threads the same word */
    inst.ra = local ? 0 : SHARED;
    inst.imm = local ? -4 - 4 * (int32_t)any(0, 127) : 0;
    break;
  case 2:
  case 3:
    inst.ra = (uint8_t)any(RACED, RACED + 3);
    inst.imm = 4 * (int32_t)any(0, seldom(4) ? 200 : 3);
    break;
  case 4:
    inst.ra = SHARED;
    inst.imm = 4 * (int32_t)any(0, 4000);
    break;
  default:
    inst.ra = BASE;
    inst.imm = 4 * (int32_t)any(0, 31);
    break;
  }
  inst.imm += within;
  if (seldom(400))
    inst.imm += 1; /* misaligned, perhaps */
  else if (seldom(800)) {
    static const uint8_t bases[] = {0, READ_ONLY, NOWHERE};
    inst.ra = bases[any(0, 2)];
    inst.imm = seldom(2) ? 8 : -4 * (int32_t)any(129, 2000); /* below local memory: the stack's overflow */
  }
  return inst;
}

/* Instruction `at` of a body that ends at `end`; jumps go forward within it. */
static uint32_t any_instruction(unsigned at, unsigned end) {
  const unsigned left = end - at;
  trax_inst inst = any_fields();
  inst.rd &= 15;
  inst.ra &= 15;
  inst.rb &= 15;
  inst.imm = (int32_t)any(0, 65535) - 32768;
  const trax_op_info *info = &trax_op_table[inst.op];
  const int32_t ahead = 4 * (int32_t)any(1, left < 12 ? left : 12);
  if (info->access_bytes)
    return trax_encode(with_address(inst, (int32_t)info->access_bytes));
  if (info->flags & TRAX_IS_BRANCH) {
    inst.imm = ahead;
    if (inst.op == TRAX_OP_JALR) { /* to an address that r0 reaches */
      inst.ra = 0;
      inst.imm += (int32_t)TEXT + 4 * (int32_t)at + (seldom(300) ? 2 : seldom(300) ? 0x6000 : 0);
    }
    return trax_encode(inst);
  }
  switch (inst.op) {
  case TRAX_OP_RDSR:
    inst.imm = (int32_t)any(0, seldom(200) ? 31 : TRAX_SR_COUNT - 1);
    return trax_encode(inst);
  case TRAX_OP_TRAP:
    inst.imm = seldom(200) ? (int32_t)any(0, TRAX_TRAP_COUNT)
               : seldom(3) ? TRAX_TRAP_PUTC
                           : (int32_t)any(TRAX_TRAP_RAYS, TRAX_TRAP_ITEMS);
    if (inst.imm == TRAX_TRAP_RAYS)
      inst.imm = rays_trap(inst.ra);
    if (inst.imm == TRAX_TRAP_PUTS && seldom(2)) /* of memory rather than of a random address */
      inst.ra = SHARED;
    return trax_encode(inst);
  case TRAX_OP_HALT:
    return seldom(40) ? HALT : NOP;
  case TRAX_OP_FENCE:
    return seldom(400) ? trax_encode(inst) : any_fence();
  default:
    break;
  }
  if (info->format == TRAX_FORMAT_SH)
    inst.imm &= 31;
  if (info->format == TRAX_FORMAT_U)
    inst.imm &= 0xFFFF;
  return trax_encode(inst);
}

/* A few stores one beside the other, up or down, such as buffers combine. */
static size_t any_stores(uint32_t *words, size_t most) {
  static const trax_op stores[] = {TRAX_OP_SB, TRAX_OP_SH, TRAX_OP_SW, TRAX_OP_SWNT};
  const trax_op op = stores[any(0, 3)];
  const int32_t bytes = (int32_t)trax_op_table[op].access_bytes, step = seldom(4) ? -bytes : bytes;
  const size_t count = any(2, most < 18 ? (uint32_t)most : 18);
  int32_t offset = bytes * (int32_t)any(18, 40);
  for (size_t i = 0; i < count; i++, offset += step)
    words[i] = trax_encode((trax_inst){op, 0, BASE, (uint8_t)any(0, 15), offset});
  return count;
}

size_t any_isa_program(uint32_t *words) {
  size_t n = 0;
  words[n++] = U(RDSR, BASE, TRAX_SR_THREAD);
  words[n++] = I(SLLI, BASE, BASE, 8);
  words[n++] = U(LUI, 1, 1);
  words[n++] = R(ADD, BASE, BASE, 1);
  words[n++] = R(ADD, SHARED, 1, 0);
  words[n++] = I(ADDI, RACED, 1, 0x4000);
  for (unsigned base = RACED + 1; base < RACED + 4; base++)
    words[n++] = I(ADDI, base, base - 1, 0x1000);
  words[n++] = U(LUI, READ_ONLY, RODATA >> 16);
  words[n++] = U(LUI, NOWHERE, 0x5000);
  words[n++] = U(RDSR, 3, TRAX_SR_THREAD);
  for (unsigned reg = 4; reg < 10; reg++)
    words[n++] = I(LW, reg, BASE, 4 * (int32_t)reg);
  const uint32_t body = any(4, BODY);
  words[n++] = I(ADDI, LOOP, 0, (int32_t)any(1, seldom(8) ? 40 : 4));
  const size_t begin = n;
  while (n < begin + body)
    if (seldom(30) && begin + body - n >= 2)
      n += any_stores(words + n, begin + body - n);
    else {
      words[n] = any_instruction((unsigned)n, (unsigned)(begin + body));
      n++;
    }
  words[n++] = I(ADDI, LOOP, LOOP, -1);
  words[n] = B(BNE, LOOP, 0, ((int32_t)begin - (int32_t)n) * 4);
  n++;
  for (unsigned reg = 1; reg < 16; reg++)
    words[n++] = S(SW, reg, BASE, (int32_t)(128 + 4 * reg));
  words[n++] = any(0, 5) ? HALT : any(0, 2) ? T(1, TRAX_TRAP_EXIT) : NOP; /* what follows the program faults */
  return n;
}

/* --- configurations --- */

/* The fields in any order, and some of the column's bits below all others. */
static double any_mapping(void) {
  unsigned fields[] = {TRAX_DRAM_ROW, TRAX_DRAM_RANK, TRAX_DRAM_BANK, TRAX_DRAM_COLUMN, TRAX_DRAM_CHANNEL};
  double mapping = TRAX_DRAM_PART(5, TRAX_DRAM_COLUMN, any(1, 6));
  for (unsigned i = 0; i < 5; i++) {
    const unsigned other = any(i, 4), field = fields[other];
    fields[other] = fields[i];
    fields[i] = field;
    mapping += TRAX_DRAM_PART(i, field, 0);
  }
  return mapping;
}

/* Mostly small, sometimes anything; between least and most. */
static double any_value(const struct trax_config_key *key) {
  const bool time = strcmp(key->unit, "cycles") == 0 || strcmp(key->unit, "ticks") == 0;
  const double most = time && key->most > 300 ? 300 : key->most;
  switch (key->kind) {
  case TRAX_KIND_FLAG:
    return any(0, 1);
  case TRAX_KIND_POLICY:
    return any(0, TRAX_REPLACEMENT_COUNT - 1);
  case TRAX_KIND_MODEL:
    return any(0, TRAX_MEMORY_MODEL_COUNT - 1);
  case TRAX_KIND_MAPPING:
    return any_mapping();
  case TRAX_KIND_POWER:
    if (key->least == 0) /* what may be absent */
      return any(0, 1) ? 0 : (double)(1u << any(0, 16));
    return any_power((uint32_t)key->least, (uint32_t)(seldom(4) || key->least * 64 > most ? most : key->least * 64));
  case TRAX_KIND_REAL:
    return exp2(any(0, 160) / 10.0) / 100; /* 0.01 to 655 */
  default:
    return any((uint32_t)key->least, (uint32_t)(seldom(4) || key->least + 20 > most ? most : key->least + 20));
  }
}

static void set_value(struct trax_config *config, const struct trax_config_key *key, double value) {
  trax_config_put(config, key, key->kind == TRAX_KIND_REAL ? round(value * 1000) / 1000 : value);
}

struct trax_config any_machine(uint32_t tms, uint32_t tps) {
  struct trax_config config = TRAX_CONFIG_DEFAULT;
  config.chip.tms = tms;
  config.chip.tps_per_tm = tps;
  config.memory.size_mib = 1;
  const unsigned change = any(1, 4); /* so many keys in four have another value than by default */
  for (size_t i = 0; i < trax_config_key_count; i++) {
    const struct trax_config_key *key = &trax_config_keys[i];
    if (strcmp(key->component, "simt") == 0) /* not of the engines that are compared on it */
      continue;
    if (any(1, 4) > change || strcmp(key->name, "chip.tms") == 0 || strcmp(key->name, "chip.tps_per_tm") == 0 ||
        strcmp(key->name, "memory.size_mib") == 0)
      continue;
    const struct trax_config before = config;
    for (unsigned tries = 0; tries < 20; tries++) {
      set_value(&config, key, any_value(key));
      if (trax_config_validate(&config, NULL) == TRAX_OK)
        break;
      config = before; /* it does not go with the others */
    }
  }
  if (!config.ray.units_per_group && !seldom(8))
    config.ray.units_per_group = 1; /* else most programs end soon, by an illegal instruction */
  if (config.tp.branch_bubble_cycles % 3 == 2)
    config.tp.branch_bubble_cycles =
        1; /* seldom met by chance, and a case of its own: no step may be taken for quick */
  return config;
}

static uint32_t seldom_large(uint32_t least, uint32_t small, uint32_t most) {
  return seldom(4) ? any(least, most) : any(least, small);
}

/* DRAM with any timing; the caches may be any. */
static void any_dram(struct trax_config *config) {
  const struct trax_config before = *config;
  for (unsigned tries = 0; tries < 50; tries++) {
    *config = before;
    config->memory.model = TRAX_MEMORY_DRAM;
    config->memory.channels = any_power(1, 8);
    config->dram.mtps = seldom(3) ? any(1, 8000) : 400 * any(1, 8);
    config->dram.bus_bits = any_power(8, 128);
    config->dram.burst_length = any_power(2, 32);
    config->dram.ranks = any_power(1, 4);
    config->dram.banks = any_power(1, 16);
    config->dram.row_bytes = any_power(64, 8192);
    config->dram.mapping = any(0, 1) ? any_mapping() : config->dram.mapping;
    config->dram.trcd = seldom_large(1, 20, 300);
    config->dram.trp = seldom_large(1, 20, 300);
    config->dram.tcl = seldom_large(1, 20, 300);
    config->dram.tcwl = seldom_large(1, 20, 300);
    config->dram.tras = seldom_large(1, 50, 300);
    config->dram.trrd = seldom_large(1, 10, 300);
    config->dram.tfaw = seldom_large(1, 50, 300);
    config->dram.twtr = seldom_large(1, 10, 300);
    config->dram.twr = seldom_large(1, 20, 300);
    config->dram.trtp = seldom_large(1, 10, 300);
    config->dram.tturn = seldom_large(0, 4, 300);
    config->dram.trfc = seldom_large(1, 100, 500);
    config->dram.trefi = seldom(3) ? 0 : config->dram.trfc + any(1, 3000);
    config->dram.reads = seldom_large(1, 8, TRAX_DRAM_MAX_QUEUE);
    config->dram.writes = seldom_large(1, 8, TRAX_DRAM_MAX_QUEUE);
    config->dram.batch_from = any(1, config->dram.writes);
    config->dram.batch_to = any(0, config->dram.batch_from - 1);
    config->dram.write_wait = seldom_large(0, 200, 5000);
    config->dram.cap = seldom_large(0, 4, 100);
    if (trax_config_validate(config, NULL) == TRAX_OK)
      return;
  }
  *config = before;
}

static uint32_t longer(uint32_t a, uint32_t b) {
  return a > b ? a : b;
}

/* A second-level cache, several channels, or both; units that are shared in other ways. */
static void beyond_the_paper(struct trax_config *config) {
  config->fpu.adders_per_cluster = any(0, 1) ? 1 : any(1, 4);
  config->fpu.multipliers_per_cluster = any(0, 1) ? 1 : any(1, 4);
  config->fpu.mul_tps_per_cluster = any(0, 1) ? 0 : any(1, 20);
  config->fpu.convert_latency_cycles = any(1, 3);
  config->int_mul.units_per_group = any(0, 1) ? 1 : any(1, 4);
  config->special.rsqrt_latency_cycles = any(0, 1) ? 0 : any(1, 20);
  config->dcache.replacement = any(0, TRAX_REPLACEMENT_COUNT - 1);
  const uint32_t l1_line = longer(config->icache.line_bytes, config->dcache.line_bytes);
  if (any(0, 2)) {
    config->l2.line_bytes = any_power(l1_line, 1024);
    config->l2.bytes = any_power(config->l2.line_bytes, 32768);
    config->l2.ways = any_power(1, config->l2.bytes / config->l2.line_bytes);
    if (config->l2.ways > 64)
      config->l2.ways = 64;
    config->l2.replacement = any(0, TRAX_REPLACEMENT_COUNT - 1);
    config->l2.banks = any(1, 12);
    config->l2.latency_cycles = any(1, 40);
    config->l2.mshrs = any(0, 1) ? any(1, 8) : any(1, 300);
  }
  if (any(0, 2)) {
    config->memory.channels = any(1, 6);
    config->memory.interleave_bytes =
        any_power(longer(64, longer(l1_line, config->l2.bytes ? config->l2.line_bytes : 0)), 4096);
  }
  if (!any(0, 2))
    config->memory.atomic_latency_cycles = any(1, 60);
}

struct trax_config any_config(uint32_t tms, uint32_t tps) {
  struct trax_config config = TRAX_CONFIG_DEFAULT;
  config.chip.tms = tms;
  config.chip.tps_per_tm = tps;
  config.chip.clock_mhz = any(1, 3) * 250;
  config.tp.int_latency_cycles = any(0, 3) ? 1 : any(1, 5);
  config.tp.local_latency_cycles = any(1, 3);
  config.tp.branch_bubble_cycles = any(0, 1) ? 0 : any(0, 100);
  config.icache.line_bytes = any_power(16, 256);
  config.icache.bytes = any_power(config.icache.line_bytes < 64 ? 64 : config.icache.line_bytes, 4096);
  config.icache.ways = any_power(1, config.icache.bytes / config.icache.line_bytes);
  config.icache.banks = any(1, 20);
  config.icache.ports_per_bank = any(1, 3);
  config.icache.tps_per_cache = any(1, 32);
  config.fpu.tps_per_cluster = any(1, 20);
  config.fpu.add_latency_cycles = any(1, 5);
  config.fpu.mul_latency_cycles = any(1, 80);
  config.fpu.compare_units = any(0, 1);
  config.fpu.compare_latency_cycles = any(1, 3);
  config.int_mul.tps_per_unit = any(1, 20);
  config.int_mul.latency_cycles = any(1, 4);
  config.special.units_per_tm = any(1, 3);
  config.special.latency_cycles = any(1, 20);
  config.special.pipelined = any(0, 1);
  config.ray.units_per_group = any(1, 3);
  config.ray.tps_per_group = any(1, 20);
  config.ray.box_latency_cycles = any(1, 30);
  config.ray.box_interval_cycles = any(0, 1) ? 1 : any(1, 10);
  config.ray.triangle_latency_cycles = any(1, 60);
  config.ray.triangle_interval_cycles = any(0, 1) ? 4 : any(1, 30);
  config.dcache.line_bytes = any_power(4, 256);
  config.dcache.bytes = any_power(config.dcache.line_bytes < 64 ? 64 : config.dcache.line_bytes, 16384);
  config.dcache.ways = any_power(1, config.dcache.bytes / config.dcache.line_bytes);
  if (config.dcache.ways > 64)
    config.dcache.ways = 64;
  if (config.icache.ways > 64)
    config.icache.ways = 64;
  config.dcache.tps_per_bank = any(1, 16);
  config.dcache.hit_latency_cycles = any(1, 4);
  config.dcache.mshrs = any(1, 40);
  config.memory.bandwidth_gbps = any(1, 20000) / 1000.0;
  config.memory.latency_cycles = any(0, 200);
  config.memory.queue_depth = any(1, 60);
  config.memory.size_mib = 1;
  config.memory.min_transfer_bytes = any_power(1, 64);
  config.memory.atomic_bytes = any(1, 64);
  config.memory.write_combining = any(0, 1);
  if (any(0, 1))
    beyond_the_paper(&config);
  config.dcache.fill_cycles = seldom(3) ? any(1, 8) : 0;
  config.memory.atomic_interval_cycles = seldom(4) ? any(1, 40) : 0;
  if (seldom(3))
    any_dram(&config);
  return config;
}

size_t item_program(uint32_t *words) {
  size_t n = 0;
  words[n++] = U(RDSR, 1, TRAX_SR_THREAD);
  words[n++] = U(LUI, 2, 1);
  words[n++] = I(ADDI, 11, 0, ITEMS);
  words[n++] = U(LUI, 12, ITEM_COUNTER >> 16);
  const size_t next = n;
  words[n++] = I(AINC, 10, 12, 0);
  const size_t leave = n;
  words[n++] = 0;
  words[n++] = I(SLLI, 1, 10, 6);
  words[n++] = I(ANDI, 20, 10, 31);
  words[n++] = I(ADDI, 20, 20, 10);
  const size_t loop = n;
  words[n++] = I(ANDI, 4, 1, 0x5FFC);
  words[n++] = R(ADD, 4, 4, 2);
  words[n++] = I(LW, 5, 4, 0);
  words[n++] = R(FMUL, 6, 5, 5);
  words[n++] = R(FADD, 7, 6, 5);
  words[n++] = R(ADD, 1, 1, 5);
  words[n++] = I(ANDI, 9, 5, 3);
  words[n++] = B(BNE, 9, 0, 16);
  words[n++] = R(FMUL, 6, 6, 7);
  words[n++] = R(FADD, 7, 6, 7);
  words[n++] = R(ADD, 8, 8, 7);
  words[n++] = I(ADDI, 20, 20, -1);
  words[n] = B(BNE, 20, 0, ((int32_t)loop - (int32_t)n) * 4);
  n++;
  words[n++] = T(3, TRAX_TRAP_ITEMS);
  words[n] = B(BEQ, 0, 0, ((int32_t)next - (int32_t)n) * 4);
  words[leave] = B(BGE, 10, 11, ((int32_t)++n - (int32_t)leave) * 4);
  words[n++] = HALT;
  return n;
}
