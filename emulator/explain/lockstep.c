/* The issue slots that the run's items, or its rays by kind, would take on a SIMD machine: the instructions of each
   item or ray are replayed in warps of threads that share one program counter.

   A warp of width W has W items that are consecutive in the order in which the program took them from its queues, one
   queue after the other. An item's queue is the address of the last atomic increment that its thread executed before
   the item ended, and its number is the value. The warp executes the instruction at the lowest address of its threads'
   pcs, for the threads that are at it. If code is laid out in the
   order of its control flow, threads reconverge as early as possible (Collange, "Stack-less SIMT reconvergence at low
   cost", ENS Lyon 2011). Memory and units take no time. So the result is the use of issue slots alone, an upper bound
   for a lockstep machine that does not repack its warps.

   A warp of rays has W rays of one kind and generation, of consecutive items. A ray's generation is the number of rays
   of its kind that its item had before it. So rays are compacted into full warps before they begin, as between the
   kernels of a wavefront path tracer (Laine, Karras and Aila, "Megakernels Considered Harmful", HPG 2013), and no lane
   is lost to an item that has no such ray. A ray's instructions are those from the trap that counts it to the next trap
   that counts rays or items: its traversal and the shading of its hit. The share of lanes that are active in an issue
   slot is the SIMD efficiency of Aila and Laine, "Understanding the Efficiency of Ray Traversal on GPUs" (HPG 2009). */
#include "explain/ray_kinds.h"
#include "explain/span.h"
#include "trax/grow.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

/* A sequence of instructions without a taken jump. */
struct run {
  uint32_t pc, count;
};

struct recording {
  struct run *runs;
  size_t count, capacity;
  uint32_t queue, number; /* of the item: the address that was incremented, and the value */
  unsigned kind;          /* of a ray; TRAX_NO_RAY for an item */
  uint32_t generation;
  size_t end; /* the number of items or rays that had ended before: makes the order total */
};

struct lockstep {
  struct trax_reader reader;
  bool by_ray;
  struct recording *threads;
  uint32_t (*generations)[TRAX_RAY_KIND_COUNT]; /* [threads], if by ray */
  struct recording *items;
  size_t count, capacity;
};

static void end_item(struct lockstep *lockstep, struct recording *thread) {
  if (!trax_grow((void **)&lockstep->items, lockstep->count, &lockstep->capacity, sizeof *lockstep->items)) {
    lockstep->reader.explain->out_of_memory = true;
    return;
  }
  thread->end = lockstep->count;
  lockstep->items[lockstep->count++] = *thread;
  *thread = (struct recording){.queue = thread->queue, .number = thread->number, .kind = TRAX_NO_RAY};
}

/* Called before the instruction is recorded. */
static void begin_ray(struct lockstep *lockstep, struct recording *thread, const struct trax_span *span) {
  const unsigned kind = trax_counted_kind(span);
  if (kind == TRAX_NO_RAY)
    return;
  if (thread->kind != TRAX_NO_RAY)
    end_item(lockstep, thread);
  thread->kind = kind;
  thread->generation = lockstep->generations[span->thread][kind]++;
}

static void add_span(void *self, const struct trax_span *span) {
  struct lockstep *lockstep = self;
  struct recording *thread = &lockstep->threads[span->thread];
  if (!span->issue)
    return; /* instructions after a thread's last item belong to no item */
  if (trax_op_table[span->inst.op].flags & TRAX_IS_ATOMIC)
    thread->queue = span->issue->address;
  if (lockstep->by_ray) {
    begin_ray(lockstep, thread, span);
    if (thread->kind == TRAX_NO_RAY)
      return;
  }
  struct run *last = thread->count ? &thread->runs[thread->count - 1] : NULL;
  if (last && last->pc + 4 * last->count == span->pc) {
    last->count++;
  } else if (trax_grow((void **)&thread->runs, thread->count, &thread->capacity, sizeof *thread->runs)) {
    thread->runs[thread->count++] = (struct run){span->pc, 1};
  } else {
    lockstep->reader.explain->out_of_memory = true;
  }
  if (trax_ends_item(span)) {
    end_item(lockstep, thread);
    if (lockstep->by_ray)
      memset(lockstep->generations[span->thread], 0, sizeof *lockstep->generations);
  }
}

static void arrive(void *self, const struct trax_arrival *arrival) {
  struct lockstep *lockstep = self;
  lockstep->threads[arrival->tm * lockstep->reader.explain->machine->config.chip.tps_per_tm + arrival->tp].number =
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
    uint32_t lowest = UINT32_MAX, next = UINT32_MAX, together = UINT32_MAX;
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
      if (pc_of(&cursors[i]) == lowest && cursors[i].at->count - cursors[i].done < together)
        together = cursors[i].at->count - cursors[i].done;
    if (next != UINT32_MAX && (next - lowest) / 4 < together)
      together = (next - lowest) / 4;
    for (size_t i = 0; i < count; i++)
      if (pc_of(&cursors[i]) == lowest) {
        cursors[i].done += together;
        if (cursors[i].done == cursors[i].at->count)
          cursors[i].at++, cursors[i].done = 0;
      }
    slots += together;
  }
}

/* In the order of kind, generation, queue, number. Items have no kind, and their generation is 0. */
static int by_place(const void *a, const void *b) {
  const struct recording *one = a, *other = b;
  if (one->kind != other->kind)
    return one->kind < other->kind ? -1 : 1;
  if (one->generation != other->generation)
    return one->generation < other->generation ? -1 : 1;
  if (one->queue != other->queue)
    return one->queue < other->queue ? -1 : 1;
  if (one->number != other->number)
    return one->number < other->number ? -1 : 1;
  return one->end < other->end ? -1 : one->end > other->end;
}

/* Writes a row for each width. The items of a warp are of one generation. */
static void write_rows(FILE *out, const char *name, const struct recording *items, size_t count) {
  for (size_t width = 1; width <= WIDEST; width *= 2) {
    uint64_t slots = 0, executed = 0, longest = 0, warps = 0;
    for (size_t first = 0, size; first < count; first += size, warps++) {
      for (size = 1; size < width && first + size < count;)
        if (items[first + size].generation != items[first].generation)
          break;
        else
          size++;
      slots += run_warp(&items[first], size, &executed, &longest);
    }
    fprintf(out, "%s%zu,%" PRIu64 ",%" PRIu64 ",%" PRIu64 ",%.6f,%.6f\n", name, width, warps, executed, slots,
            slots ? (double)executed / ((double)width * (double)slots) : 0,
            longest ? (double)executed / ((double)width * (double)longest) : 0);
  }
}

static trax_status put_table(void *self, FILE *out, trax_error *error) {
  struct lockstep *lockstep = self;
  (void)error;
  if (lockstep->count) /* qsort's array is not to be NULL */
    qsort(lockstep->items, lockstep->count, sizeof *lockstep->items, by_place);
  fprintf(out, "%swidth,warps,instructions,slots,utilisation,longest\n", lockstep->by_ray ? "kind,rays," : "");
  if (!lockstep->by_ray)
    write_rows(out, "", lockstep->items, lockstep->count);
  for (size_t first = 0, end; lockstep->by_ray && first < lockstep->count; first = end) {
    const unsigned kind = lockstep->items[first].kind;
    char name[64];
    for (end = first; end < lockstep->count && lockstep->items[end].kind == kind;)
      end++;
    snprintf(name, sizeof name, "%s,%zu,", trax_ray_kind_names[kind], end - first);
    write_rows(out, name, lockstep->items + first, end - first);
  }
  return TRAX_OK;
}

static trax_status open_lockstep(void *self, trax_error *error) {
  struct lockstep *lockstep = self;
  const uint64_t threads = lockstep->reader.explain->machine->stats.threads;
  lockstep->by_ray = lockstep->reader.kind == &trax_lockstep_rays_reader;
  if (!(lockstep->threads = trax_explain_array(threads, sizeof *lockstep->threads, error)) ||
      !(lockstep->generations = trax_explain_array(threads, sizeof *lockstep->generations, error)))
    return TRAX_ERROR;
  for (uint64_t i = 0; i < threads; i++)
    lockstep->threads[i].kind = TRAX_NO_RAY;
  return TRAX_OK;
}

static void close_lockstep(void *self) {
  struct lockstep *lockstep = self;
  for (size_t i = 0; i < lockstep->count; i++)
    free(lockstep->items[i].runs);
  for (uint64_t i = 0; lockstep->threads && i < lockstep->reader.explain->machine->stats.threads; i++)
    free(lockstep->threads[i].runs);
  free(lockstep->items);
  free(lockstep->generations);
  free(lockstep->threads);
}

#define KIND(FILE)                                                                                                     \
  {                                                                                                                    \
    .bytes = sizeof(struct lockstep), .files = {{.path = TRAX_EXPLAIN_PATH(FILE), .put = put_table}},                  \
    .open = open_lockstep, .span = add_span, .arrival = arrive, .close = close_lockstep                                \
  }
const struct trax_reader_kind trax_lockstep_reader = KIND(lockstep);
const struct trax_reader_kind trax_lockstep_rays_reader = KIND(lockstep_rays);
