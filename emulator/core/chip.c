#define _POSIX_C_SOURCE 200809L /* clock_gettime */
#include "core/chip.h"

#include "fast/engine.h"
#include "fast/functional.h"

#include <string.h>
#include <time.h>

/* How often, in simulated events, the host's clock and the interrupt flag are looked at. */
#define POLL_INTERVAL 4096
#define PROGRESS_SECONDS 0.1

trax_status trax_chip_create(struct trax_chip *chip, struct trax_machine *machine, const trax_run_options *options,
                             trax_error *error) {
  memset(chip, 0, sizeof *chip);
  chip->machine = machine;
  chip->tms = machine->config.chip.tms;
  chip->running = chip->tms * machine->config.chip.tps_per_tm;
  trax_memory_create(&chip->memory, &machine->config);
  if (trax_text_create(&chip->text, &machine->space, &machine->config, error))
    return TRAX_ERROR;
  chip->tm = calloc(chip->tms, sizeof *chip->tm);
  if (!chip->tm)
    return trax_fail(error, "out of memory");
  for (uint32_t i = 0; i < chip->tms; i++)
    if (trax_tm_create(&chip->tm[i], i, machine, &chip->text, options->output, error))
      return TRAX_ERROR;
  if (options->engine == TRAX_ENGINE_FUNCTIONAL)
    return trax_functional_create(chip, error);
  chip->engine = options->engine == TRAX_ENGINE_FAST ? trax_fast_best_engine() : NULL;
  return chip->engine ? chip->engine->create(chip, error) : TRAX_OK;
}

void trax_chip_destroy(struct trax_chip *chip) {
  if (chip->engine)
    chip->engine->destroy(chip->fast);
  trax_functional_destroy(chip->functional);
  for (uint32_t i = 0; chip->tm && i < chip->tms; i++)
    trax_tm_destroy(&chip->tm[i]);
  free(chip->tm);
  trax_text_destroy(&chip->text);
}

void trax_chip_settle(struct trax_chip *chip, uint64_t cycles) {
  if (chip->functional) {
    trax_functional_collect(chip->functional);
    return;
  }
  if (chip->engine)
    chip->engine->settle(chip->fast);
  for (uint32_t i = 0; i < chip->tms; i++)
    trax_tm_settle(&chip->tm[i], cycles);
}

static double host_seconds(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

struct poll {
  double begun, reported;
  unsigned countdown;
};

static void report_progress(const struct trax_chip *chip, const struct trax_run_options *options, struct poll *poll,
                            uint64_t t) {
  const double now = host_seconds();
  if (now - poll->reported < PROGRESS_SECONDS)
    return;
  poll->reported = now;
  if (chip->engine)
    chip->engine->collect(chip->fast);
  if (chip->functional)
    trax_functional_collect(chip->functional);
  trax_progress progress = {.cycle = t, .total_items = options->total_items, .host_seconds = now - poll->begun};
  for (uint32_t i = 0; i < chip->tms; i++) {
    progress.items += chip->tm[i].stats->items;
    for (unsigned op = 0; op < TRAX_OP_COUNT; op++)
      progress.instructions += chip->tm[i].stats->instructions[op];
  }
  options->progress(options->progress_context, &progress);
}

/* True if the run is to stop. */
static bool poll_host(const struct trax_chip *chip, const struct trax_run_options *options, struct poll *poll,
                      uint64_t t) {
  if (--poll->countdown)
    return false;
  poll->countdown = POLL_INTERVAL;
  if (options->progress)
    report_progress(chip, options, poll, t);
  return options->interrupt && *options->interrupt;
}

struct functional_poll {
  const struct trax_chip *chip;
  const trax_run_options *options;
  struct poll poll;
};

static bool poll_without_time(void *context, uint64_t instructions) {
  struct functional_poll *it = context;
  (void)instructions;
  it->poll.countdown = 1;
  return poll_host(it->chip, it->options, &it->poll, 0);
}

/* Calls those who look at the machine before cycle t. *next receives the cycle in which someone looks again. */
static trax_status look(struct trax_chip *chip, uint64_t t, uint64_t *next) {
  trax_status status = TRAX_OK;
  *next = TRAX_NEVER;
  for (struct trax_watch *watch = chip->machine->watches; watch && !status; watch = watch->others) {
    if (watch->next <= t)
      status = watch->look(watch, chip);
    if (watch->next < *next)
      *next = watch->next;
  }
  return status;
}

trax_status trax_chip_run(struct trax_chip *chip, const trax_run_options *options, uint64_t *cycles) {
  const uint64_t limit = options->max_cycles ? options->max_cycles : TRAX_NEVER;
  const double begun = host_seconds();
  struct poll poll = {begun, begun, 1};
  if (chip->functional) {
    struct functional_poll context = {chip, options, poll};
    *cycles = 0;
    return trax_functional_run(chip->functional, limit, poll_without_time, &context);
  }
  uint64_t t = 0, watched = chip->machine->watches ? 0 : TRAX_NEVER;
  while (true) {
    if (t >= watched) {
      const trax_status status = look(chip, t, &watched);
      if (status) {
        *cycles = t;
        return status;
      }
    }
    if (t >= limit) {
      *cycles = limit;
      return TRAX_STUCK;
    }
    if (poll_host(chip, options, &poll, t)) {
      *cycles = t;
      return TRAX_INTERRUPTED;
    }

    bool faulted = false;
    for (uint32_t i = 0; i < chip->tms; i++)
      if (chip->tm[i].next_cycle <= t) {
        if (chip->engine)
          chip->engine->cycle(chip->fast, i, t);
        else
          trax_tm_cycle(&chip->tm[i], t);
        faulted |= chip->tm[i].fault.kind != TRAX_FAULT_NONE;
      }
    trax_memory_cycle(&chip->memory, chip->tm, &chip->machine->space, t);
    if (faulted) {
      *cycles = t + 1;
      return TRAX_FAULT;
    }

    uint64_t next = trax_memory_next_cycle(&chip->memory, t);
    for (uint32_t i = 0; i < chip->tms; i++)
      if (chip->tm[i].next_cycle < next)
        next = chip->tm[i].next_cycle;
    if (!chip->running && !chip->memory.waiting_tms) {
      t++;
      break;
    }
    if (next > watched)
      next = watched > t + 1 ? watched : t + 1;
    t = next; /* never TRAX_NEVER: whoever has not ended is awake, in a wheel, or waits for a request */
  }
  const uint64_t idle_from = trax_memory_idle_from(&chip->memory);
  *cycles = idle_from > t ? idle_from : t;
  return TRAX_OK;
}
