#include "fast/chip.h"

#include "engine/poll.h"
#include "sampling/slots.h"
#include "fast/engine.h"
#include "functional/functional.h"
#include "fast/windows.h"
#include "reference/run.h"

#include <assert.h>
#include <string.h>

trax_status trax_chip_create(struct trax_chip *chip, struct trax_machine *machine, const trax_run_options *options,
                             trax_error *error) {
  memset(chip, 0, sizeof *chip);
  chip->machine = machine;
  chip->tms = machine->config.chip.tms;
  if (trax_memory_create(&chip->memory, &machine->config, &machine->stats.memory, error))
    return TRAX_ERROR;
  if (trax_text_create(&chip->text, &machine->space, &machine->config, error))
    return TRAX_ERROR;
  chip->tm = calloc(chip->tms, sizeof *chip->tm);
  if (!chip->tm)
    return trax_fail(error, "out of memory");
  for (uint32_t i = 0; i < chip->tms; i++)
    if (trax_tm_create(&chip->tm[i], i, machine, &chip->text, options->output, error))
      return TRAX_ERROR;
  if (options->engine == TRAX_ENGINE_FUNCTIONAL)
    return (chip->functional = trax_functional_create(chip, error)) ? TRAX_OK : TRAX_ERROR;
  chip->engine = trax_fast_best_engine();
  if (chip->engine->create(chip, error))
    return TRAX_ERROR;
  if (options->slots && !(chip->slots = trax_slots_create(chip, options->slots, error)))
    return TRAX_ERROR;
  return trax_windows_create(chip, options->host_threads, error);
}

void trax_chip_destroy(struct trax_chip *chip) {
  trax_windows_destroy(chip->windows);
  if (chip->engine)
    chip->engine->destroy(chip->fast);
  trax_functional_destroy(chip->functional);
  trax_slots_destroy(chip->slots);
  for (uint32_t i = 0; chip->tm && i < chip->tms; i++)
    trax_tm_destroy(&chip->tm[i]);
  free(chip->tm);
  trax_text_destroy(&chip->text);
  trax_memory_destroy(&chip->memory);
}

uint32_t trax_chip_queued(const struct trax_chip *chip, uint32_t tm, uint64_t t) {
  if (chip->reference)
    return trax_reference_queued(chip->reference, tm);
  const struct trax_queue *queue = &chip->tm[tm].queue;
  uint32_t arrived = 0; /* at a TM that looks no more: the run waits for the last transfers only */
  for (uint32_t i = 0; i < queue->started; i++) {
    const uint32_t place = queue->heap ? queue->heap[i] : (queue->oldest + i) % queue->depth;
    arrived += queue->requests[place].completion < t;
  }
  return queue->count - arrived;
}

void trax_chip_settle(struct trax_chip *chip, uint64_t cycles) {
  if (!chip->tm)
    return; /* the reference engine charges at once */
  for (uint32_t i = 0; i < chip->tms && !chip->machine->fault.kind; i++)
    chip->machine->fault = chip->tm[i].fault;
  if (chip->functional) {
    trax_functional_collect(chip->functional);
    return;
  }
  if (chip->engine)
    chip->engine->settle(chip->fast);
  for (uint32_t i = 0; i < chip->tms; i++) {
    trax_tm_settle(&chip->tm[i], cycles);
    chip->tm[i].stats->queue_peak = chip->tm[i].queue.peak;
  }
}

void trax_chip_gather(struct trax_chip *chip) {
  if (chip->engine)
    chip->engine->gather(chip->fast);
}

void trax_chip_scatter(struct trax_chip *chip, uint64_t t) {
  if (chip->engine)
    chip->engine->scatter(chip->fast, t);
}

static void collect_fast(void *context) {
  const struct trax_chip *chip = context;
  chip->engine->collect(chip->fast);
}

static void collect_functional(void *context) {
  trax_functional_collect(((const struct trax_chip *)context)->functional);
}

static bool poll_without_time(void *poll, uint64_t instructions) {
  (void)instructions;
  return trax_poll_now(poll, 0);
}

trax_status trax_chip_look(struct trax_chip *chip, uint64_t t, uint64_t *next) {
  trax_status status = TRAX_OK;
  *next = TRAX_NEVER;
  for (struct trax_watch *watch = chip->machine->watches; watch && !status; watch = watch->others) {
    if (watch->next <= t) {
      status = watch->look(watch, chip, t);
      assert(status || watch->next > t);
    }
    if (watch->next < *next)
      *next = watch->next;
  }
  return status;
}

trax_status trax_chip_run(struct trax_chip *chip, const trax_run_options *options, uint64_t *cycles) {
  const uint64_t asked = options->max_cycles ? options->max_cycles : TRAX_NEVER;
  const uint64_t limit = asked > chip->begin ? asked : chip->begin; /* a resumed run may be beyond it already */
  struct trax_poll poll;
  trax_poll_begin(&poll, chip->machine, options);
  poll.context = chip;
  poll.collect = chip->functional ? collect_functional : collect_fast;
  if (chip->functional) {
    *cycles = 0;
    return trax_functional_run(chip->functional, limit, poll_without_time, &poll);
  }
  uint64_t t = chip->begin, watched = 0;
  while (true) {
    if (t >= watched) {
      const trax_status status = trax_chip_look(chip, t, &watched);
      if (chip->windows)
        trax_windows_forget(chip->windows);
      if (status) {
        *cycles = t;
        return status;
      }
    }
    if (t >= limit) {
      *cycles = limit;
      return TRAX_STUCK;
    }
    if (trax_poll(&poll, t)) {
      *cycles = t;
      return TRAX_INTERRUPTED;
    }
    const uint64_t begin = t;
    if (chip->windows && trax_windows_advance(chip->windows, &t, limit < watched ? limit : watched)) {
      trax_poll_pass(&poll, t > begin ? t - begin : 0);
      continue;
    }

    bool faulted = false;
    for (uint32_t i = 0; i < chip->tms; i++)
      if (chip->tm[i].next_cycle <= t) {
        chip->engine->cycle(chip->fast, i, t);
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
    if (!trax_chip_running(chip) && !trax_memory_has_waiting(&chip->memory)) {
      t++;
      break;
    }
    if (next > watched)
      next = watched > t + 1 ? watched : t + 1;
    if (next > limit)
      next = limit;
    chip->machine->fast_path.single_cycles += chip->tms > 1 ? next - t : 0;
    t = next; /* never TRAX_NEVER: whoever has not ended is awake, in a wheel, or waits for a request */
  }
  const uint64_t idle_from = trax_memory_idle_from(&chip->memory), end = idle_from > t ? idle_from : t;
  for (uint64_t now = watched > t ? watched : t; now < end && now <= limit; now = watched > now ? watched : now + 1) {
    const trax_status status = trax_chip_look(chip, now, &watched); /* nothing happens any more */
    if (status) {
      *cycles = now;
      return status;
    }
  }
  *cycles = end < limit ? end : limit;
  return end > limit ? TRAX_STUCK : TRAX_OK;
}
