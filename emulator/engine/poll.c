#define _POSIX_C_SOURCE 200809L /* clock_gettime */
#include "engine/poll.h"

#include <time.h>

#define PROGRESS_SECONDS 0.1

static double host_seconds(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void count(const struct trax_machine *machine, uint64_t *items, uint64_t *instructions) {
  *items = *instructions = 0;
  for (uint32_t tm = 0; tm < machine->config.chip.tms; tm++) {
    const struct trax_tm_stats *stats = &machine->tm_stats[tm];
    *items += stats->items;
    for (unsigned op = 0; op < TRAX_OP_COUNT; op++)
      *instructions += stats->instructions[op];
  }
}

void trax_poll_begin(struct trax_poll *poll, const struct trax_machine *machine, const trax_run_options *options) {
  const double now = host_seconds();
  *poll = (struct trax_poll){.machine = machine, .options = options, .begun = now, .reported = now};
  count(machine, &poll->items_before, &poll->instructions_before);
}

static void report_progress(struct trax_poll *poll, uint64_t t) {
  const double now = host_seconds();
  if (now - poll->reported < PROGRESS_SECONDS)
    return;
  poll->reported = now;
  poll->collect(poll->context);
  trax_progress progress = {.cycle = t,
                            .total_items = poll->options->total_items,
                            .items_before = poll->items_before,
                            .instructions_before = poll->instructions_before,
                            .host_seconds = now - poll->begun};
  count(poll->machine, &progress.items, &progress.instructions);
  poll->options->progress(poll->options->progress_context, &progress);
}

bool trax_poll_now(struct trax_poll *poll, uint64_t t) {
  poll->countdown = TRAX_POLL_INTERVAL;
  if (poll->options->progress)
    report_progress(poll, t);
  return poll->options->interrupt && *poll->options->interrupt;
}
