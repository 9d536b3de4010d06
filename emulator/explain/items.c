/* The cost of each item, and the place of its result. */
#include "explain/page.h"
#include "explain/places.h"
#include "explain/ray_kinds.h"
#include "explain/stories.h"
#include "trax/grow.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

struct item_mark {
  unsigned kind;
  uint64_t cycles, instructions; /* of the item, before the ray */
};

struct item_thread {
  uint64_t cycles[TRAX_CAUSE_COUNT]; /* of the thread at the begin of the item */
  uint64_t rays[TRAX_RAY_KIND_COUNT];
  uint64_t begin;
  uint32_t place;
  struct item_mark *marks; /* of the traps that counted one ray each */
  size_t mark_count, mark_capacity;
};

struct items {
  struct trax_reader reader;
  struct item_thread *threads;
  uint32_t buffer_begin, buffer_bytes;
  void (*item)(void *context, const struct trax_item_cost *cost, bool last);
  void *item_context;
};

/* The cycle after the passage. */
static uint64_t until(const struct trax_passage *passage) {
  uint64_t sum = 0;
  for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++)
    sum += passage->cycles[cause];
  return sum;
}

static void write_item(void *context, const struct trax_item_cost *cost, bool last) {
  FILE *out = context;
  fprintf(out, "%s,%u,", last ? "rest" : "item", cost->thread);
  if (cost->place != TRAX_NO_PLACE)
    fprintf(out, "%u", cost->place);
  fprintf(out, ",%" PRIu64 ",%" PRIu64 ",%" PRIu64, cost->begin, cost->end, cost->instructions);
  for (unsigned cause = TRAX_CAUSE_ISSUED + 1; cause < TRAX_CAUSE_COUNT; cause++)
    fprintf(out, ",%" PRIu64, cost->cycles[cause]);
  fputc('\n', out);
}

static void end_rays(struct trax_explain *explain, const struct item_thread *thread,
                     const struct trax_item_cost *cost) {
  for (size_t i = 0; i < thread->mark_count; i++) {
    const struct item_mark *mark = &thread->marks[i];
    const bool last = i + 1 == thread->mark_count;
    const uint64_t cycles = last ? cost->end - cost->begin : mark[1].cycles,
                   instructions = last ? cost->instructions : mark[1].instructions;
    if (!trax_pixel_rays_add(explain->pixel_rays, cost->place, mark->kind, cycles - mark->cycles,
                             instructions - mark->instructions))
      explain->out_of_memory = true;
  }
}

static void end_item(struct items *items, const struct trax_passage *passage, bool last) {
  const uint32_t number = passage->thread;
  struct item_thread *thread = &items->threads[number];
  const uint64_t end = until(passage);
  uint64_t cycles[TRAX_CAUSE_COUNT];
  for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++)
    cycles[cause] = passage->cycles[cause] - thread->cycles[cause];
  const struct trax_item_cost cost = {.thread = number,
                                      .place = last ? TRAX_NO_PLACE : thread->place,
                                      .begin = thread->begin,
                                      .end = end,
                                      .instructions = cycles[TRAX_CAUSE_ISSUED],
                                      .cycles = cycles,
                                      .rays = thread->rays};
  if (items->item)
    items->item(items->item_context, &cost, last);
  if (items->reader.explain->pixels)
    trax_pixels_add(items->reader.explain->pixels, &cost, last);
  if (items->reader.out)
    write_item(items->reader.out, &cost, last);
  if (items->reader.explain->stories)
    trax_stories_end(items->reader.explain->stories, &cost, last);
  if (items->reader.explain->pixel_rays && !last && cost.place != TRAX_NO_PLACE)
    end_rays(items->reader.explain, thread, &cost);
  *thread = (struct item_thread){
      .begin = end, .place = TRAX_NO_PLACE, .marks = thread->marks, .mark_capacity = thread->mark_capacity};
  memcpy(thread->cycles, passage->cycles, sizeof thread->cycles);
}

static void add_mark(struct items *items, struct item_thread *thread, const struct trax_passage *passage) {
  const unsigned kind = trax_counted_kind(passage);
  if (kind == TRAX_NO_RAY)
    return;
  if (!trax_grow((void **)&thread->marks, thread->mark_count, &thread->mark_capacity, sizeof *thread->marks)) {
    items->reader.explain->out_of_memory = true;
    return;
  }
  thread->marks[thread->mark_count++] = /* the trap belongs to the ray */
      (struct item_mark){kind, until(passage) - 1 - thread->begin,
                         passage->cycles[TRAX_CAUSE_ISSUED] - thread->cycles[TRAX_CAUSE_ISSUED] - 1};
}

/* Counts the rays that a trap reports. */
static void add_rays(struct item_thread *thread, const struct trax_passage *passage) {
  if (passage->inst.imm == TRAX_TRAP_RAYS)
    thread->rays[TRAX_RAY_KIND_COUNT - 1] += passage->result;
  for (unsigned kind = 0; passage->inst.imm == TRAX_TRAP_KINDS && kind < TRAX_RAY_KIND_COUNT; kind++)
    thread->rays[kind] += passage->result >> kind * TRAX_KIND_BITS & ((1u << TRAX_KIND_BITS) - 1);
}

/* The place of a later store to the buffer counts. */
static void find_place(const struct items *items, struct item_thread *thread, const struct trax_passage *passage) {
  const struct trax_places *places = items->reader.explain->places;
  for (size_t i = 0; passage->stores && i < passage->accessed_count; i++) {
    const uint32_t offset = passage->accessed[i].address - items->buffer_begin,
                   index = trax_passage_index(passage, passage->accessed[i].at);
    if (offset < items->buffer_bytes && trax_op_table[trax_places_inst(places, index)->op].flags & TRAX_IS_STORE)
      thread->place = offset / items->reader.explain->options.item_bytes;
  }
}

static void add_passage(void *self, const struct trax_passage *passage) {
  struct items *items = self;
  struct item_thread *thread = &items->threads[passage->thread];
  if (items->reader.explain->stories)
    trax_stories_add(items->reader.explain->stories, passage);
  if (!passage->count) {
    end_item(items, passage, true);
    return;
  }
  if (passage->inst.op == TRAX_OP_TRAP)
    add_rays(thread, passage);
  if (passage->inst.op == TRAX_OP_TRAP && items->reader.explain->pixel_rays)
    add_mark(items, thread, passage);
  if (trax_ends_item(passage))
    end_item(items, passage, false);
  else
    find_place(items, thread, passage);
}

void trax_explain_items(struct trax_explain *explain,
                        void (*item)(void *context, const struct trax_item_cost *cost, bool last), void *context) {
  for (unsigned i = 0; i < explain->reader_count; i++)
    if (explain->readers[i]->kind == &trax_items_reader) {
      struct items *items = (struct items *)explain->readers[i];
      items->item = item;
      items->item_context = context;
    }
}

static trax_status create_pixels(struct trax_explain *explain, uint32_t bytes) {
  explain->pixels = trax_pixels_create(bytes / explain->options.item_bytes);
  explain->stories = trax_stories_create(explain);
  explain->pixel_rays = trax_pixel_rays_create();
  return explain->pixels && explain->stories && explain->pixel_rays ? TRAX_OK : TRAX_ERROR;
}

/* Finds the buffer to which the items store. */
static trax_status find_buffer(struct items *items, trax_error *error) {
  struct trax_explain *explain = items->reader.explain;
  const struct trax_explain_options *options = &explain->options;
  const struct trax_loaded *loaded = trax_loaded_of(explain->machine);
  if (!options->item_buffer)
    return TRAX_OK;
  for (size_t i = 0; loaded && i < loaded->buffer_count; i++)
    if (strcmp(loaded->buffers[i].symbol, options->item_buffer) == 0) {
      items->buffer_begin = loaded->buffers[i].address;
      items->buffer_bytes = loaded->buffers[i].bytes;
      if ((options->explore || options->story) && create_pixels(explain, loaded->buffers[i].bytes) != TRAX_OK)
        return trax_fail(error, "out of memory for the cost of %u pixels",
                         loaded->buffers[i].bytes / options->item_bytes);
      return TRAX_OK;
    }
  return trax_fail(error, "no buffer %s is bound, to which items store", options->item_buffer);
}

static trax_status open_items(void *self, trax_error *error) {
  struct items *items = self;
  const uint64_t threads = items->reader.explain->machine->stats.threads;
  FILE *out = items->reader.out;
  if (!items->reader.explain->options.item_bytes)
    items->reader.explain->options.item_bytes = 4;
  if (!(items->threads = trax_explain_array(threads, sizeof *items->threads, error)) ||
      find_buffer(items, error) != TRAX_OK)
    return TRAX_ERROR;
  for (uint64_t i = 0; i < threads; i++)
    items->threads[i].place = TRAX_NO_PLACE;
  if (!out)
    return TRAX_OK;
  fprintf(out, "kind,thread,place,begin,end,instructions");
  for (unsigned cause = TRAX_CAUSE_ISSUED + 1; cause < TRAX_CAUSE_COUNT; cause++)
    fprintf(out, ",%s", trax_cause_names[cause]);
  fputc('\n', out);
  return TRAX_OK;
}

static bool has_buffer(const struct trax_explain_options *options) {
  return options->item_buffer != NULL;
}

static trax_status put_stories(void *self, FILE *out, trax_error *error) {
  (void)error;
  trax_stories_put_member(((struct trax_reader *)self)->explain, out);
  return TRAX_OK;
}

static void close_items(void *self) {
  struct items *items = self;
  for (uint64_t i = 0; items->threads && i < items->reader.explain->machine->stats.threads; i++)
    free(items->threads[i].marks);
  free(items->threads);
}

const struct trax_reader_kind trax_items_reader = {
    .bytes = sizeof(struct items),
    .files = {{.path = TRAX_EXPLAIN_PATH(items)}, {.path = TRAX_EXPLAIN_PATH(story), .put = trax_stories_put}},
    .is_wanted = has_buffer,
    .open = open_items,
    .passage = add_passage,
    .put_members = put_stories,
    .close = close_items};
