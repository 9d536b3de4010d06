/* The cost of each item, and the place of its result. */
#include "explain/kinds.h"
#include "explain/page.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

struct item_thread {
  uint64_t cycles[TRAX_CAUSE_COUNT]; /* of the current item */
  uint64_t rays[TRAX_RAY_KIND_COUNT];
  uint64_t begin, until;
  uint32_t place;
};

struct items {
  struct trax_explain *explain;
  trax_output output; /* of options.items, if wanted */
  struct item_thread *threads;
  uint32_t buffer_begin, buffer_bytes;
  void (*item)(void *context, const struct trax_item_cost *cost, bool last);
  void *item_context;
};

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

static void end_item(struct items *items, uint32_t number, uint64_t end, bool last) {
  struct item_thread *thread = &items->threads[number];
  const struct trax_item_cost cost = {.thread = number,
                                      .place = last ? TRAX_NO_PLACE : thread->place,
                                      .begin = thread->begin,
                                      .end = end,
                                      .instructions = thread->cycles[TRAX_CAUSE_ISSUED],
                                      .cycles = thread->cycles,
                                      .rays = thread->rays};
  if (items->item)
    items->item(items->item_context, &cost, last);
  if (items->explain->pixels)
    trax_pixels_add(items->explain->pixels, &cost, last);
  if (items->output.file)
    write_item(items->output.file, &cost, last);
  *thread = (struct item_thread){.begin = end, .until = end, .place = TRAX_NO_PLACE};
}

/* Counts the rays that a trap reports. */
static void add_rays(struct item_thread *thread, const struct trax_span *span) {
  if (span->inst.imm == TRAX_TRAP_RAYS)
    thread->rays[TRAX_RAY_KIND_COUNT - 1] += span->issue->result;
  for (unsigned kind = 0; span->inst.imm == TRAX_TRAP_KINDS && kind < TRAX_RAY_KIND_COUNT; kind++)
    thread->rays[kind] += span->issue->result >> kind * TRAX_KIND_BITS & ((1u << TRAX_KIND_BITS) - 1);
}

static void add_span(void *self, const struct trax_span *span) {
  struct items *items = self;
  struct item_thread *thread = &items->threads[span->thread];
  for (size_t i = 0; i < span->count; i++) {
    thread->cycles[span->charges[i].cause] += span->charges[i].cycles;
    thread->until += span->charges[i].cycles;
  }
  if (!span->issue) {
    end_item(items, span->thread, thread->until, true);
    return;
  }
  thread->cycles[TRAX_CAUSE_ISSUED]++;
  thread->until++;
  if (span->inst.op == TRAX_OP_TRAP)
    add_rays(thread, span);
  if (trax_ends_item(span))
    end_item(items, span->thread, thread->until, false);
  else if (trax_op_table[span->inst.op].flags & TRAX_IS_STORE &&
           span->issue->address - items->buffer_begin < items->buffer_bytes)
    thread->place = (span->issue->address - items->buffer_begin) / items->explain->options.item_bytes;
}

static trax_status finish(void *self, trax_error *error) {
  struct items *items = self;
  return items->output.file ? trax_output_commit(&items->output, error) : TRAX_OK;
}

static void destroy(void *self) {
  struct items *items = self;
  trax_output_discard(&items->output);
  free(items->threads);
  free(items);
}

void trax_explain_items(struct trax_explain *explain,
                        void (*item)(void *context, const struct trax_item_cost *cost, bool last), void *context) {
  for (unsigned i = 0; i < explain->reader_count; i++)
    if (explain->readers[i].span == add_span) {
      struct items *items = explain->readers[i].self;
      items->item = item;
      items->item_context = context;
    }
}

/* Finds the buffer to which the items store. */
static trax_status find_buffer(struct items *items, trax_error *error) {
  const struct trax_explain_options *options = &items->explain->options;
  const struct trax_host *host = trax_host_of(items->explain->machine);
  if (!options->item_buffer)
    return TRAX_OK;
  for (size_t i = 0; host && i < host->buffer_count; i++)
    if (strcmp(host->buffers[i].symbol, options->item_buffer) == 0) {
      items->buffer_begin = host->buffers[i].address;
      items->buffer_bytes = host->buffers[i].bytes;
      if (options->explore &&
          !(items->explain->pixels = trax_pixels_create(host->buffers[i].bytes / options->item_bytes)))
        return trax_fail(error, "out of memory for the cost of %u pixels",
                         host->buffers[i].bytes / options->item_bytes);
      return TRAX_OK;
    }
  return trax_fail(error, "no buffer %s is bound, to which items store", options->item_buffer);
}

trax_status trax_items_create(struct trax_explain *explain, struct trax_reader *reader, trax_error *error) {
  struct items *items = calloc(1, sizeof *items);
  const uint64_t threads = explain->machine->stats.threads;
  if (!items)
    return trax_fail(error, "out of memory");
  items->explain = explain;
  if (!explain->options.item_bytes)
    explain->options.item_bytes = 4;
  items->threads = calloc(threads, sizeof *items->threads);
  if (!items->threads)
    trax_fail(error, "out of memory for the items");
  if (!items->threads || find_buffer(items, error) != TRAX_OK ||
      (explain->options.items && trax_output_open(&items->output, explain->options.items, error) != TRAX_OK)) {
    destroy(items);
    return TRAX_ERROR;
  }
  for (uint64_t i = 0; i < threads; i++)
    items->threads[i].place = TRAX_NO_PLACE;
  if (items->output.file) {
    fprintf(items->output.file, "kind,thread,place,begin,end,instructions");
    for (unsigned cause = TRAX_CAUSE_ISSUED + 1; cause < TRAX_CAUSE_COUNT; cause++)
      fprintf(items->output.file, ",%s", trax_cause_names[cause]);
    fputc('\n', items->output.file);
  }
  *reader = (struct trax_reader){.self = items, .span = add_span, .finish = finish, .destroy = destroy};
  return TRAX_OK;
}
