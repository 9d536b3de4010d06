/* The encodings as the manual draws them against the decoder that the description generates.

     isa-model-decode-test                     17 million words all over
     isa-model-decode-test --all               all 2^32 */
#include "model.h"
#include "trax/isa.h"

#include <inttypes.h>
#include <pthread.h>
#include <string.h>
#include <unistd.h>

enum { MOST_THREADS = 64 };
#define FEW 257u /* one word of 257, so that all low bits vary */

struct part {
  const struct model_isa *isa;
  uint64_t first, step;
  uint64_t words, legal, different;
  uint32_t example;
};

static bool same(const struct model_isa *isa, uint32_t word, bool *legal) {
  const struct model_instruction *instruction = model_decode(isa, word);
  const trax_inst inst = trax_decode(word);
  *legal = instruction != NULL;
  if (!instruction || inst.op == TRAX_OP_ILLEGAL)
    return !instruction && inst.op == TRAX_OP_ILLEGAL;
  uint32_t operand[MODEL_FIELDS];
  model_operands(instruction, word, operand);
  return strcmp(instruction->mnemonic, trax_op_table[inst.op].mnemonic) == 0 && operand[MODEL_FIELD_RD] == inst.rd &&
         operand[MODEL_FIELD_RA] == inst.ra && operand[MODEL_FIELD_RB] == inst.rb &&
         operand[MODEL_FIELD_IMM] == (uint32_t)inst.imm;
}

static void *compare(void *argument) {
  struct part *part = argument;
  for (uint64_t word = part->first; word < UINT64_C(1) << 32; word += part->step) {
    bool legal;
    part->words++;
    if (!same(part->isa, (uint32_t)word, &legal)) {
      part->different++;
      part->example = (uint32_t)word;
    }
    part->legal += legal;
  }
  return NULL;
}

int main(int argc, char **argv) {
  struct model_error error;
  struct model_isa *isa = model_isa_read(MODEL_MANUAL, &error);
  const bool all = argc == 2 && strcmp(argv[1], "--all") == 0;
  if (!isa || (argc > 1 && !all)) {
    fprintf(stderr, "isa-model-decode-test: %s\n", isa ? "the only option is --all" : error.message);
    return 1;
  }
  const long cores = sysconf(_SC_NPROCESSORS_ONLN);
  const unsigned threads = cores < 1 ? 1 : cores > MOST_THREADS ? MOST_THREADS : (unsigned)cores;
  pthread_t thread[MOST_THREADS];
  struct part part[MOST_THREADS] = {0}, sum = {0};
  const uint64_t step = all ? 1 : FEW;
  for (unsigned i = 0; i < threads; i++) {
    part[i] = (struct part){.isa = isa, .first = i * step, .step = threads * step};
    if (pthread_create(&thread[i], NULL, compare, &part[i])) {
      perror("isa-model-decode-test");
      return 1;
    }
  }
  for (unsigned i = 0; i < threads; i++) {
    pthread_join(thread[i], NULL);
    sum.words += part[i].words;
    sum.legal += part[i].legal;
    sum.different += part[i].different;
    if (part[i].different)
      sum.example = part[i].example;
  }
  printf("%" PRIu64 " words, %" PRIu64 " of them instructions: %" PRIu64 " are not what the manual says\n", sum.words,
         sum.legal, sum.different);
  if (sum.different)
    printf("for example 0x%08" PRIx32 "\n", sum.example);
  const bool good = sum.different == 0 && sum.legal > 0 && isa->count == TRAX_OP_COUNT - 1;
  model_isa_free(isa);
  return !good;
}
