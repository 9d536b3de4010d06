#include "cases.h"

#include <string.h>

const char *const case_kind_names[CASE_KINDS] = {"any instruction", "races",     "races near the defaults",
                                                 "own words",       "any words", "functional mode"};

/* --- cases --- */

static struct trax_config near_the_defaults(uint32_t tms, uint32_t tps) {
  struct trax_config config = TRAX_CONFIG_DEFAULT;
  config.chip.tms = tms;
  config.chip.tps_per_tm = tps;
  config.memory.latency_cycles = any(0, 100);
  config.memory.size_mib = 1;
  config.ray.units_per_group = any(0, 7) ? 1 : 0;
  return config;
}

/* The number of the cycle is not the same without time. */
static void leave_out_cycles(uint32_t *words, size_t count) {
  for (size_t i = 0; i < count; i++) {
    const trax_inst inst = trax_decode(words[i]);
    words[i] = inst.op == TRAX_OP_RDSR && inst.imm == TRAX_SR_CYCLE ? NOP : words[i];
  }
}

struct random_case case_of_seed(unsigned seed) {
  struct random_case c = {0};
  random_state = 0x9E3779B97F4A7C15u * (seed + 1);
  const uint32_t tms = any(1, any(0, 3) ? 4 : 8);
  const uint32_t most = any(0, 1) ? 12 : MAX_THREADS / tms;
  const uint32_t tps = any(1, most > 64 ? 64 : most);
  /* The reference looks at every thread in every cycle; so much time is a second or so. */
  const uint64_t limit = 4000000 / (tms * tps);
  c.max_cycles = any(0, 7) ? limit : any(1, 5000);
  switch ((enum case_kind)(seed % CASE_KINDS)) {
  case CASE_ISA:
    c.config = any_machine(tms, tps);
    c.count = any_isa_program(c.words);
    break;
  case CASE_RACES:
    c.config = any_machine(tms, tps);
    c.count = any(0, 1) ? any_racing_program(c.words) : any_writing_program(c.words);
    break;
  case CASE_RACES_NEAR_DEFAULTS:
    c.config = near_the_defaults(tms, tps);
    c.count = any(0, 2) == 0 ? any_racing_program(c.words)
              : any(0, 1)    ? any_writing_program(c.words)
                             : any_isa_program(c.words);
    break;
  case CASE_OWN_WORDS:
    c.config = any_machine(tms, tps);
    c.config.ray.units_per_group += c.config.ray.units_per_group == 0;
    c.count = any_program(c.words);
    break;
  case CASE_WORDS: /* endless loops are possible */
    c.config = any_machine(tms % 2 + 1, tps % 4 + 1);
    any_words(c.words, c.count = 32);
    c.max_cycles = 5000;
    break;
  case CASE_FUNCTIONAL:
    c.functional_mode = true;
    if (any(0, 3)) { /* one thread, anything */
      c.one_thread = true;
      c.config = any_machine(1, 1);
      any_words(c.words, c.count = 32);
      leave_out_cycles(c.words, c.count);
      c.max_cycles = 5000;
    } else { /* many that do not meet */
      c.config = any_machine(tms, tps);
      c.config.ray.units_per_group += c.config.ray.units_per_group == 0;
      c.count = any_program(c.words);
      c.max_cycles = 10 * limit;
    }
    break;
  case CASE_KINDS:
    break;
  }
  return c;
}

/* --- comparisons --- */

/* Rules of docs/timing.md for every run. */
static bool violates_accounting(struct difference *to, const struct trax_machine *machine) {
  uint64_t sum = 0;
  for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++)
    sum += machine->stats.total.cycles[cause];
  return different_number(to, "charges, and threads x cycles", sum, machine->stats.threads * machine->stats.cycles);
}

const char *tested_engine = "fast";

static void compare_engines(const struct random_case *c, struct comparison *to) {
  static const unsigned host_threads[] = {1, 2, 3, 8};
  struct run reference = run(&c->config, c->words, c->count, "reference", true, c->max_cycles);
  const struct trax_machine *machine = reference.bench.machine;
  struct difference *difference = &to->difference;
  to->status = reference.bench.status;
  to->fault = machine->fault.kind;
  to->cycles = machine->stats.cycles;
  to->instructions = machine->stats.instructions;
  bool different = to->status == TRAX_ERROR ? differs(difference, "error: %s", reference.bench.error.message)
                                            : violates_accounting(difference, machine);
  for (unsigned i = 0; !different && i < sizeof host_threads / sizeof *host_threads; i++) {
    struct run fast = run_alone(&c->config, c->words, c->count, tested_engine, c->max_cycles, host_threads[i]);
    different = different_runs(difference, &reference, &fast) || different_transfers(difference, &reference, &fast);
    end(&fast);
    if (c->config.chip.tms == 1)
      break; /* more threads have nothing to do */
  }
  for (unsigned stretches = 0; !different && stretches < 2; stretches++) {
    bench_stretches = stretches;
    if (stretches)
      reduce_issues(&reference.bench.issues);
    struct run observed = run(&c->config, c->words, c->count, tested_engine, true, c->max_cycles);
    bench_stretches = false;
    if (stretches) /* an engine may tell more */
      reduce_issues(&observed.bench.issues);
    different = different_issues(difference, &reference.bench.issues, &observed.bench.issues) ||
                different_charges(difference, &reference.bench, &observed.bench) ||
                different_runs(difference, &reference, &observed) ||
                different_transfers(difference, &reference, &observed);
    end(&observed);
  }
  end(&reference);
}

/* Results that do not depend on time. */
static void compare_functional_mode(const struct random_case *c, struct comparison *to) {
  struct run timed = run_alone(&c->config, c->words, c->count, tested_engine, c->max_cycles, 1),
             functional = run_alone(&c->config, c->words, c->count, "functional", c->max_cycles, 1);
  const struct trax_machine *x = timed.bench.machine, *y = functional.bench.machine;
  to->status = timed.bench.status;
  to->fault = x->fault.kind;
  to->cycles = x->stats.cycles;
  to->instructions = x->stats.instructions;
  struct difference *difference = &to->difference;
  if (to->status == TRAX_ERROR || functional.bench.status == TRAX_ERROR)
    differs(difference, "error: %s%s", timed.bench.error.message, functional.bench.error.message);
  else if (to->status == TRAX_STUCK || functional.bench.status == TRAX_STUCK)
    to->status = TRAX_STUCK; /* neither counts the time of an endless loop as the other does */
  else if (to->status == TRAX_FAULT && x->stats.threads > 1)
    different_number(difference, "status", timed.bench.status, functional.bench.status); /* the rest depends on time */
  else
    (void)(different_number(difference, "status", timed.bench.status, functional.bench.status) ||
           different_number(difference, "cycles of the functional mode, and", y->stats.cycles, 0) ||
           different_bytes(difference, "instructions by operation", x->stats.total.instructions,
                           y->stats.total.instructions, sizeof x->stats.total.instructions) ||
           different_number(difference, "rays", x->stats.total.rays, y->stats.total.rays) ||
           different_bytes(difference, "rays by kind", &x->stats.total.rays_primary, &y->stats.total.rays_primary,
                           TRAX_RAY_KIND_COUNT * sizeof x->stats.total.rays_primary) ||
           different_number(difference, "items", x->stats.total.items, y->stats.total.items) ||
           different_number(difference, "kind of fault", x->fault.kind, y->fault.kind) ||
           different_number(difference, "pc of the fault", x->fault.pc, y->fault.pc) ||
           different_number(difference, "address of the fault", x->fault.address, y->fault.address) ||
           different_bytes(difference, "registers of the fault", x->fault.registers, y->fault.registers,
                           sizeof x->fault.registers) ||
           different_effects(difference, &timed, &functional));
  end(&timed);
  end(&functional);
}

struct comparison compare_case(const struct random_case *c) {
  struct comparison comparison = {0};
  if (c->functional_mode)
    compare_functional_mode(c, &comparison);
  else
    compare_engines(c, &comparison);
  return comparison;
}
