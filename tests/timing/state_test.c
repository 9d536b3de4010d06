/* The fast engine's state between cycles: to export and import it changes nothing.

   TRAX_RANDOM_ROUNDS and TRAX_RANDOM_SEED make it longer and different. */
#include "compare.h"

#include <stdlib.h>

/* At random cycles, further and further apart. */
struct disturbance {
  struct trax_watch watch;
  uint64_t t;
  unsigned times;
  bool take_up;
};

static trax_status disturb(struct trax_watch *watch, struct trax_run *run, uint64_t t) {
  struct disturbance *it = watch->context;
  it->t = t;
  trax_run_export(run);
  if (it->take_up)
    trax_run_import(run, it->t);
  it->times++;
  const uint64_t saved = random_state; /* the programs of a seed stay the same */
  random_state = 0x9E3779B97F4A7C15u * (it->t + 1);
  watch->next = it->t + any(1, 4 + (uint32_t)it->t / 8);
  random_state = saved;
  return TRAX_OK;
}

static void each(size_t (*generate)(uint32_t *), unsigned rounds) {
  const unsigned seed = setting("TRAX_RANDOM_SEED", 1);
  rounds = setting("TRAX_RANDOM_ROUNDS", rounds);
  unsigned times = 0;
  for (unsigned round = 0; round < rounds; round++) {
    random_state = 0xD1B54A32D192ED03u * (seed + round);
    uint32_t program[BODY + 64];
    const size_t count = generate(program);
    const uint32_t tms = any(1, 4), tps = any(1, MAX_THREADS / tms > 64 ? 64 : MAX_THREADS / tms);
    struct trax_config config = any_config(tms, tps);
    if (round % 2) { /* near the defaults, so that much runs ahead */
      const struct trax_config initial = TRAX_CONFIG_DEFAULT;
      config = initial;
      config.chip.tms = tms;
      config.chip.tps_per_tm = tps;
      config.memory.size_mib = 1;
    }
    const uint64_t limit = any(0, 3) ? 0 : any(1, 5000);
    struct run undisturbed = run(&config, program, count, "fast", false, limit);
    for (unsigned take_up = 0; take_up < 2; take_up++) {
      struct disturbance disturbance = {.watch = {.next = any(0, 100), .inspect = disturb}, .take_up = take_up};
      disturbance.watch.context = &disturbance;
      struct run disturbed = run_watched(&config, program, count, "fast", false, limit, &disturbance.watch);
      expect_same(&undisturbed, &disturbed);
      times += disturbance.times;
      end(&disturbed);
    }
    end(&undisturbed);
  }
  assert_true(times > 10 * rounds);
}

static void own_words(void **state) {
  (void)state;
  each(any_program, 15);
}

static void races(void **state) {
  (void)state;
  each(any_racing_program, 30);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(own_words),
      cmocka_unit_test(races),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
