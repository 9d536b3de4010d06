/* The table of functions: the runtime's, compiled for the host, as loops over a chunk. */
#include "../operands.h"
#include "accuracy.h"
#include "adapted.h"
#include "functions.h"
#include "reference.h"

#define OURS_1(name, ours)                                                                                             \
  static void ours_##name(struct chunk *c) {                                                                           \
    for (size_t i = 0; i <= CHUNK; i++)                                                                                \
      c->got[i] = ours(float_of(c->operand[0][i]));                                                                    \
  }
#define OURS_2(name, ours)                                                                                             \
  static void ours_##name(struct chunk *c) {                                                                           \
    for (size_t i = 0; i <= CHUNK; i++)                                                                                \
      c->got[i] = ours(float_of(c->operand[0][i]), float_of(c->operand[1][i]));                                        \
  }
#define OURS_3(name, ours)                                                                                             \
  static void ours_##name(struct chunk *c) {                                                                           \
    for (size_t i = 0; i <= CHUNK; i++)                                                                                \
      c->got[i] = ours(float_of(c->operand[0][i]), float_of(c->operand[1][i]), float_of(c->operand[2][i]));            \
  }
#define PLAIN_1(name, host, exact, low, high)                                                                          \
  float rt_##name(float);                                                                                              \
  OURS_1(name, rt_##name)
#define PLAIN_2(name, host, exact, low, high)                                                                          \
  float rt_##name(float, float);                                                                                       \
  OURS_2(name, rt_##name)
#define PLAIN_3(name, host, exact, low, high)                                                                          \
  float rt_##name(float, float, float);                                                                                \
  OURS_3(name, rt_##name)
#define ADAPTED_1(name, host, exact, low, high) OURS_1(name, adapted_##name)
#define ADAPTED_2(name, host, exact, low, high) OURS_2(name, adapted_##name)
EXACT_FUNCTIONS(PLAIN_1)
ADAPTED_FUNCTIONS(ADAPTED_1)
TRANSCENDENTAL_FUNCTIONS(PLAIN_1)
EXACT_PAIRS(PLAIN_2)
ADAPTED_PAIRS(ADAPTED_2)
TRANSCENDENTAL_PAIRS(PLAIN_2)
TRIPLES(PLAIN_3)

#define ENTRY_1(name, host, exact, low, high) {#name, 1, ours_##name, host_##name##_chunk, exact_##name},
#define ENTRY_2(name, host, exact, low, high) {#name, 2, ours_##name, host_##name##_chunk, exact_##name},
#define ENTRY_3(name, host, exact, low, high) {#name, 3, ours_##name, host_##name##_chunk, exact_##name},
const struct function functions[] = {EXACT_FUNCTIONS(ENTRY_1) ADAPTED_FUNCTIONS(ENTRY_1) TRANSCENDENTAL_FUNCTIONS(
    ENTRY_1) EXACT_PAIRS(ENTRY_2) ADAPTED_PAIRS(ENTRY_2) TRANSCENDENTAL_PAIRS(ENTRY_2) TRIPLES(ENTRY_3)};
const size_t function_count = COUNT(functions);
