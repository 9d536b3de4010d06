/* Warps of 2 to 64 lanes against the functional engine: random programs without races, on random machines, have the
   same results. And every run's charges add up. Some machines have so little memory bandwidth that a program takes
   billions of cycles: what has not ended after MOST_CYCLES is only looked at twice.

     TRAX_RANDOM_ROUNDS=100 simt-widths-test */
#include "compare.h"

enum { WIDTHS = 6, MOST_INSTRUCTIONS = 2000000, MOST_CYCLES = 3000000 };

/* A machine that has warps of the width. */
static struct trax_config any_warps(uint32_t width) {
  const uint32_t most = 64 / width;
  struct trax_config config = any_machine(any(1, 2), width * any(1, most < 3 ? most : 3));
  config.ray.units_per_group += config.ray.units_per_group == 0; /* the programs may need them */
  config.simt.width = width;
  config.simt.patience = any(0, 2) ? config.simt.patience : any(1, 200);
  return config;
}

static void compare_with_functional(struct difference *to, const struct run *warps, const struct run *functional) {
  const struct trax_machine *x = warps->bench.machine, *y = functional->bench.machine;
  (void)(different_number(to, "status", warps->bench.status, functional->bench.status) ||
         different_bytes(to, "instructions by operation", x->stats.total.instructions, y->stats.total.instructions,
                         sizeof x->stats.total.instructions) ||
         different_effects(to, warps, functional));
}

static void same_results(void **state) {
  (void)state;
  const unsigned rounds = setting("TRAX_RANDOM_ROUNDS", 2);
  unsigned narrower = 0, ended = 0;
  for (unsigned round = 0; round < rounds; round++)
    for (unsigned i = 1; i <= WIDTHS; i++) {
      random_state = 0x9E3779B97F4A7C15u * (WIDTHS * round + i);
      const struct trax_config config = any_warps(1u << i);
      uint32_t words[BODY + 64];
      const size_t count = any_program(words);
      struct run warps = run_alone(&config, words, count, NULL, MOST_CYCLES, 1),
                 functional = run_alone(&config, words, count, "functional", MOST_INSTRUCTIONS, 1);
      struct difference difference = {""};
      if (warps.bench.status != TRAX_STUCK) {
        compare_with_functional(&difference, &warps, &functional);
        ended++;
      }
      if (difference.text[0])
        fail_msg("round %u, width %u: %s", round, config.simt.width, difference.text);
      struct run observed = run(&config, words, count, "simt", true, MOST_CYCLES);
      expect_same(&warps, &observed);
      const struct trax_tm_stats *total = &warps.bench.machine->stats.total;
      narrower += total->cycles[TRAX_CAUSE_DIVERGENCE] > 0 && total->cycles[TRAX_CAUSE_LOCKSTEP] > 0;
      end(&warps);
      end(&functional);
      end(&observed);
    }
  assert_true(ended >= rounds * WIDTHS * 3 / 4);
  assert_true(narrower >= rounds * WIDTHS / 2); /* or the programs prove little */
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(same_results)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
