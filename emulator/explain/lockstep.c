/* The issue slots that the run's items would take on a SIMD machine: the instructions of each item are replayed in
   warps of threads that share one program counter.

   A warp of width W has W items that are consecutive in the order in which the program took them. An item's number is
   the value of the last atomic increment that its thread executed before the item ended. The warp executes the
   instruction at the lowest address of its threads' pcs, for the threads that are at it. If code is laid out in the
   order of its control flow, threads reconverge as early as possible (Collange, "Stack-less SIMT reconvergence at low
   cost", ENS Lyon 2011). Memory and units take no time. So the result is the use of issue slots alone, an upper bound
   for a lockstep machine that does not repack its warps. */
#include "explain/step.h"
#include "explain/table.h"

#include <inttypes.h>
#include <stdlib.h>

/* A sequence of instructions without a taken jump. */
struct run {
  uint32_t pc, count;
};

struct recording {
  struct run *runs;
  size_t count, capacity;
  uint32_t number; /* the item's number */
};

struct lockstep {
  struct trax_explain *explain;
  trax_output output;
  struct recording *threads;
  struct recording *items;
  size_t count, capacity;
  bool out_of_memory;
};

static void end_item(struct lockstep *lockstep, struct recording *thread) {
  if (!trax_grow((void **)&lockstep->items, lockstep->count, &lockstep->capacity, sizeof *lockstep->items)) {
    lockstep->out_of_memory = true;
    return;
  }
  lockstep->items[lockstep->count++] = *thread;
  *thread = (struct recording){.number = thread->number};
}

static void add_step(void *self, const struct trax_step *step) {
  struct lockstep *lockstep = self;
  struct recording *thread = &lockstep->threads[step->thread];
  if (!step->issue)
    return; /* instructions after a thread's last item belong to no item */
  struct run *last = thread->count ? &thread->runs[thread->count - 1] : NULL;
  if (last && last->pc + 4 * last->count == step->pc) {
    last->count++;
  } else if (trax_grow((void **)&thread->runs, thread->count, &thread->capacity, sizeof *thread->runs)) {
    thread->runs[thread->count++] = (struct run){step->pc, 1};
  } else {
    lockstep->out_of_memory = true;
  }
  if (step->inst.op == TRAX_OP_TRAP && step->inst.imm == TRAX_TRAP_ITEMS)
    end_item(lockstep, thread);
}

static void arrive(void *self, const struct trax_arrival *arrival) {
  struct lockstep *lockstep = self;
  lockstep->threads[arrival->tm * lockstep->explain->machine->config.chip.tps_per_tm + arrival->tp].number =
      arrival->value;
}

/* --- the warps --- */

enum { WIDEST = 64 };

struct cursor {
  const struct run *at, *end;
  uint32_t done; /* instructions of *at that have been executed */
};

static uint32_t pc_of(const struct cursor *cursor) {
  return cursor->at == cursor->end ? UINT32_MAX : cursor->at->pc + 4 * cursor->done;
}

/* Returns the issue slots that the warp takes. Adds the instructions of its threads to *executed, and those of the
   longest thread to *longest. */
static uint64_t run_warp(const struct recording *items, size_t count, uint64_t *executed, uint64_t *longest) {
  struct cursor cursors[WIDEST];
  uint64_t slots = 0, most = 0;
  for (size_t i = 0; i < count; i++) {
    uint64_t instructions = 0;
    cursors[i] = (struct cursor){items[i].runs, items[i].runs + items[i].count, 0};
    for (const struct run *run = items[i].runs; run < cursors[i].end; run++)
      instructions += run->count;
    *executed += instructions;
    most = instructions > most ? instructions : most;
  }
  *longest += most;
  for (;;) {
    /* The threads at the lowest address advance together up to the first jump or the next thread's pc. */
    uint32_t lowest = UINT32_MAX, next = UINT32_MAX, steps = UINT32_MAX;
    for (size_t i = 0; i < count; i++) {
      const uint32_t pc = pc_of(&cursors[i]);
      if (pc < lowest)
        next = lowest, lowest = pc;
      else if (pc > lowest && pc < next)
        next = pc;
    }
    if (lowest == UINT32_MAX)
      return slots;
    for (size_t i = 0; i < count; i++)
      if (pc_of(&cursors[i]) == lowest && cursors[i].at->count - cursors[i].done < steps)
        steps = cursors[i].at->count - cursors[i].done;
    if (next != UINT32_MAX && (next - lowest) / 4 < steps)
      steps = (next - lowest) / 4;
    for (size_t i = 0; i < count; i++)
      if (pc_of(&cursors[i]) == lowest) {
        cursors[i].done += steps;
        if (cursors[i].done == cursors[i].at->count)
          cursors[i].at++, cursors[i].done = 0;
      }
    slots += steps;
  }
}

static int by_number(const void *a, const void *b) {
  const struct recording *one = a, *other = b;
  return (one->number > other->number) - (one->number < other->number);
}

static trax_status finish(void *self, trax_error *error) {
  struct lockstep *lockstep = self;
  if (lockstep->out_of_memory)
    return trax_fail(error, "out of memory for the instructions of %zu items", lockstep->count);
  qsort(lockstep->items, lockstep->count, sizeof *lockstep->items, by_number);
  fprintf(lockstep->output.file, "width,warps,instructions,slots,utilisation,longest\n");
  for (size_t width = 1; width <= WIDEST; width *= 2) {
    uint64_t slots = 0, executed = 0, longest = 0, warps = 0;
    for (size_t first = 0; first < lockstep->count; first += width, warps++) {
      const size_t rest = lockstep->count - first;
      slots += run_warp(&lockstep->items[first], rest < width ? rest : width, &executed, &longest);
    }
    fprintf(lockstep->output.file, "%zu,%" PRIu64 ",%" PRIu64 ",%" PRIu64 ",%.6f,%.6f\n", width, warps, executed, slots,
            slots ? (double)executed / ((double)width * (double)slots) : 0,
            longest ? (double)executed / ((double)width * (double)longest) : 0);
  }
  return trax_output_commit(&lockstep->output, error);
}

static void destroy(void *self) {
  struct lockstep *lockstep = self;
  trax_output_discard(&lockstep->output);
  for (size_t i = 0; i < lockstep->count; i++)
    free(lockstep->items[i].runs);
  for (uint64_t i = 0; lockstep->threads && i < lockstep->explain->machine->stats.threads; i++)
    free(lockstep->threads[i].runs);
  free(lockstep->items);
  free(lockstep->threads);
  free(lockstep);
}

trax_status trax_lockstep_create(struct trax_explain *explain, struct trax_reader *reader, trax_error *error) {
  struct lockstep *lockstep = calloc(1, sizeof *lockstep);
  if (!lockstep)
    return trax_fail(error, "out of memory");
  lockstep->explain = explain;
  lockstep->threads = calloc(explain->machine->stats.threads, sizeof *lockstep->threads);
  if (!lockstep->threads)
    trax_fail(error, "out of memory for the threads");
  if (!lockstep->threads || trax_output_open(&lockstep->output, explain->options.lockstep, error) != TRAX_OK) {
    destroy(lockstep);
    return TRAX_ERROR;
  }
  *reader =
      (struct trax_reader){.self = lockstep, .step = add_step, .arrival = arrive, .finish = finish, .destroy = destroy};
  return TRAX_OK;
}
