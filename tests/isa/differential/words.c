#include "words.h"

#include "generate.h"

static bool has(trax_op op, unsigned field) { /* of the format: whatever the instruction does with the register */
  const trax_inst inst = {.op = op};
  trax_inst other = inst;
  *(field == 0 ? &other.rd : field == 1 ? &other.ra : &other.rb) = 31;
  return trax_encode(other) != trax_encode(inst);
}

static void put(FILE *out, uint32_t word) {
  if (trax_decode(word).op == TRAX_OP_ILLEGAL)
    return;
  const uint8_t bytes[] = {(uint8_t)word, (uint8_t)(word >> 8), (uint8_t)(word >> 16), (uint8_t)(word >> 24)};
  fwrite(bytes, 1, sizeof bytes, out);
}

void write_words(FILE *out, const uint32_t *words, size_t count) {
  for (size_t i = 0; i < count; i++)
    put(out, words[i]);
}

/* The bits of the immediate, in the lowest places of a word as every format has them. */
static uint32_t immediate_bits(trax_op op) {
  const trax_op_info *info = &trax_op_table[op];
  const uint32_t variable = ~info->mask;
  uint32_t bits = 0;
  for (uint32_t bit = 1; bit && variable & bit; bit <<= 1)
    bits |= bit;
  for (unsigned field = 0; field < 3; field++) { /* less those of registers that reach down to it */
    trax_inst inst = {.op = op};
    const uint32_t without = trax_encode(inst);
    *(field == 0 ? &inst.rd : field == 1 ? &inst.ra : &inst.rb) = 31;
    bits &= ~(trax_encode(inst) ^ without);
  }
  return bits;
}

static void write_immediates(FILE *out, uint32_t word, uint32_t bits) {
  static const uint32_t patterns[] = {0, 1, 2, 3, 5, 6, 0x55555555, 0xAAAAAAAA, 0xFFFFFFFE, 0xFFFFFFFF};
  for (size_t i = 0; i < sizeof patterns / sizeof *patterns; i++)
    put(out, word | (patterns[i] & bits));
  for (uint32_t bit = 1; bit & bits; bit <<= 1) { /* each bit alone, all up to it, and all but it */
    put(out, word | bit);
    put(out, word | (bit - 1));
    put(out, word | (bits & ~bit));
    put(out, word | (bits & ~(bit - 1)));
  }
}

void write_extreme_words(FILE *out) {
  static const uint8_t registers[] = {0, 1, 2, 4, 8, 15, 16, 30, 31};
  enum { REGISTERS = sizeof registers };
  for (trax_op op = TRAX_OP_ILLEGAL + 1; op < TRAX_OP_COUNT; op++) {
    const unsigned rds = has(op, 0) ? REGISTERS : 1, ras = has(op, 1) ? REGISTERS : 1, rbs = has(op, 2) ? REGISTERS : 1;
    for (unsigned i = 0; i < rds * ras * rbs; i++) {
      const trax_inst inst = {
          .op = op, .rd = registers[i % rds], .ra = registers[i / rds % ras], .rb = registers[i / rds / ras]};
      write_immediates(out, trax_encode(inst), immediate_bits(op));
    }
  }
}

void write_random_words(FILE *out, unsigned count) {
  for (trax_op op = TRAX_OP_ILLEGAL + 1; op < TRAX_OP_COUNT; op++)
    for (unsigned i = 0; i < count; i++) {
      uint32_t word = any(0, 0xFFFF) << 16;
      word |= any(0, 0xFFFF);
      put(out, trax_op_table[op].match | (word & ~trax_op_table[op].mask));
    }
}
