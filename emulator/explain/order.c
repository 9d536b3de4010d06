/* The first load that may return an old value (docs/debugging.md, "Checking the order").

   The engines' memory is never stale, so a program's results do not show which order it relies on. A cached load of a
   value that another thread has stored is right if that thread has executed `fence w` since the store and one of three
   holds: both threads are in one TM; the loading thread has executed `fence r` since that fence; or no thread of its TM
   had loaded the line before that fence. */
#include "explain/span.h"
#include "report/place.h"
#include "trax/grow.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

enum { PAGE_SHIFT = 12, PAGE = 1 << PAGE_SHIFT, THREAD_BITS = 12 };

_Static_assert(TRAX_MAX_TMS *TRAX_MAX_TPS_PER_TM <= 1 << THREAD_BITS, "a moment holds any thread");

/* The cycle and thread of an issue, ordered as issues are: cycle << THREAD_BITS | thread. 0 is never. */
typedef uint64_t moment;
#define NOT_YET UINT64_MAX

struct thread {
  moment acquired;  /* its latest `fence r` */
  moment *released; /* [count]: each `fence w`, the earliest first */
  size_t count, capacity;
};

/* The latest store to each byte of a page. */
struct stores {
  moment when[PAGE];
  uint32_t pc[PAGE];
};

struct order {
  struct trax_reader reader;
  const trax_machine *machine;
  uint32_t tps, line_bytes;
  struct thread *threads; /* [machine->stats.threads] */
  size_t pages;
  struct stores **stores; /* [pages] */
  moment **loaded;        /* [TM * pages + page]: the first load of each of its lines */

  bool found; /* a load that may return an old value: */
  struct trax_issue load;
  uint32_t bytes, address, store_pc;
  moment store, release, held; /* the store, the `fence w` after it, the first load of the line by the TM */
};

static uint32_t thread_of(moment when) {
  return (uint32_t)(when & ((1 << THREAD_BITS) - 1));
}

static uint64_t cycle_of(moment when) {
  return when >> THREAD_BITS;
}

static moment moment_of(const struct order *order, const struct trax_issue *issue) {
  return issue->cycle << THREAD_BITS | (issue->tm * order->tps + issue->tp);
}

/* NULL: out of memory. */
static void *page_at(struct order *order, void **page, size_t size) {
  if (!*page && !(*page = calloc(1, size)))
    order->reader.explain->out_of_memory = true;
  return *page;
}

static void note_fence(struct order *order, const struct trax_issue *issue, int32_t kind) {
  const moment now = moment_of(order, issue);
  struct thread *thread = &order->threads[thread_of(now)];
  if (kind & TRAX_FENCE_R)
    thread->acquired = now;
  if (!(kind & TRAX_FENCE_W))
    return;
  if (trax_grow((void **)&thread->released, thread->count, &thread->capacity, sizeof *thread->released))
    thread->released[thread->count++] = now;
  else
    order->reader.explain->out_of_memory = true;
}

static void note_store(struct order *order, const struct trax_issue *issue, uint32_t bytes) {
  struct stores *page = page_at(order, (void **)&order->stores[issue->address >> PAGE_SHIFT], sizeof **order->stores);
  for (uint32_t i = issue->address % PAGE; page && i < issue->address % PAGE + bytes; i++) {
    page->when[i] = moment_of(order, issue);
    page->pc[i] = issue->pc;
  }
}

/* Returns the storing thread's first `fence w` after the store, or NOT_YET. */
static moment release_of(const struct order *order, moment store) {
  const struct thread *thread = &order->threads[thread_of(store)];
  size_t low = 0, high = thread->count;
  while (low < high) {
    const size_t middle = (low + high) / 2;
    if (thread->released[middle] > store)
      high = middle;
    else
      low = middle + 1;
  }
  return low < thread->count ? thread->released[low] : NOT_YET;
}

/* Whether a load may not see the store. held: the first load of the line by the TM; 0 if this load is the first. */
static bool may_miss(const struct order *order, const struct trax_issue *load, moment store, moment held) {
  const uint32_t reader = thread_of(moment_of(order, load)), writer = thread_of(store);
  if (!store || writer == reader)
    return false;
  const moment release = release_of(order, store);
  if (release == NOT_YET)
    return true;
  return writer / order->tps != load->tm && order->threads[reader].acquired < release && held && held < release;
}

static void check_load(struct order *order, const struct trax_issue *issue, uint32_t bytes) {
  const size_t number = issue->address >> PAGE_SHIFT, lines = (PAGE + order->line_bytes - 1) / order->line_bytes;
  moment *page = page_at(order, (void **)&order->loaded[issue->tm * order->pages + number], lines * sizeof *page);
  if (!page)
    return;
  moment *held = &page[issue->address % PAGE / order->line_bytes];
  const struct stores *stores = order->stores[number];
  for (uint32_t i = issue->address % PAGE; stores && !order->found && i < issue->address % PAGE + bytes; i++)
    if (may_miss(order, issue, stores->when[i], *held)) {
      order->found = true;
      order->load = *issue;
      order->bytes = bytes;
      order->store = stores->when[i];
      order->store_pc = stores->pc[i];
      order->release = release_of(order, order->store);
      order->held = *held;
    }
  if (!*held)
    *held = moment_of(order, issue);
}

static void add_span(void *self, const struct trax_span *span) {
  struct order *order = self;
  const trax_op_info *op = &trax_op_table[span->inst.op];
  if (!span->issue || order->found || order->reader.explain->out_of_memory)
    return;
  if (span->inst.op == TRAX_OP_FENCE)
    note_fence(order, span->issue, span->inst.imm);
  else if (!op->access_bytes || span->issue->address >= TRAX_LOCAL_BASE)
    return;
  else if (op->flags & (TRAX_IS_STORE | TRAX_IS_ATOMIC))
    note_store(order, span->issue, op->access_bytes);
  else if (!(op->flags & TRAX_IS_NONTEMPORAL))
    check_load(order, span->issue, op->access_bytes);
}

/* --- the report --- */

static void print_who(const struct order *order, const char *label, uint32_t thread, uint64_t cycle, FILE *out) {
  fprintf(out, "  %-*s%u (TM %u, TP %u), cycle %" PRIu64 "\n", TRAX_LABEL, label, thread, thread / order->tps,
          thread % order->tps, cycle);
}

static void print_instruction(const struct order *order, const char *label, uint32_t pc, FILE *out) {
  uint32_t word;
  memcpy(&word, order->machine->space.bytes + pc, sizeof word);
  fprintf(out, "  %-*s0x%08x  ", TRAX_LABEL, label, pc);
  trax_print_instruction(word, pc, out);
  fputc('\n', out);
  trax_print_place(trax_loaded_of(order->machine), "in", pc, out);
}

static void print(const struct order *order, FILE *out) {
  const struct trax_issue *load = &order->load;
  const struct trax_loaded *loaded = trax_loaded_of(order->machine);
  const struct trax_symbol *symbol = loaded ? trax_image_symbol_at(loaded->image, load->address) : NULL;
  const uint32_t reader = load->tm * order->tps + load->tp, writer = thread_of(order->store);
  fprintf(out, "trax-sim: order: a load may return an old value\n");
  fprintf(out, "  %-*sload of %u byte%s from 0x%08x", TRAX_LABEL, "access", order->bytes, order->bytes == 1 ? "" : "s",
          load->address);
  if (symbol) {
    fprintf(out, " (");
    trax_print_symbol(symbol, load->address, out);
    fputc(')', out);
  }
  fputc('\n', out);
  print_instruction(order, "at", load->pc, out);
  print_who(order, "thread", reader, load->cycle, out);
  print_instruction(order, "stored at", order->store_pc, out);
  print_who(order, "by thread", writer, cycle_of(order->store), out);
  if (order->release == NOT_YET)
    fprintf(out, "  %-*sa `fence w` of thread %u after its store\n", TRAX_LABEL, "missing", writer);
  else
    fprintf(out,
            "  %-*sa `fence r` of thread %u since thread %u's `fence w` in cycle %" PRIu64
            "; TM %u may hold the line since cycle %" PRIu64 "\n",
            TRAX_LABEL, "missing", reader, writer, cycle_of(order->release), load->tm, cycle_of(order->held));
}

static trax_status end_order(void *self, trax_error *error) {
  const struct order *order = self;
  if (!order->found)
    return TRAX_OK;
  fflush(stdout);
  print(order, stderr);
  return trax_fail(error, "the program relies on more order than the machine promises (--check-order)");
}

static trax_status open_order(void *self, trax_error *error) {
  struct order *order = self;
  const trax_machine *machine = order->machine = order->reader.explain->machine;
  order->tps = machine->config.chip.tps_per_tm;
  order->line_bytes = machine->config.dcache.line_bytes;
  order->pages = (size_t)(machine->space.size >> PAGE_SHIFT);
  if (!(order->threads = trax_explain_array(machine->stats.threads, sizeof *order->threads, error)) ||
      !(order->stores = trax_explain_array(order->pages, sizeof *order->stores, error)) ||
      !(order->loaded = trax_explain_array(order->pages * machine->config.chip.tms, sizeof *order->loaded, error)))
    return TRAX_ERROR;
  return TRAX_OK;
}

static void close_order(void *self) {
  struct order *order = self;
  for (size_t i = 0; order->threads && i < order->machine->stats.threads; i++)
    free(order->threads[i].released);
  for (size_t i = 0; order->stores && i < order->pages; i++)
    free(order->stores[i]);
  for (size_t i = 0; order->loaded && i < order->pages * order->machine->config.chip.tms; i++)
    free(order->loaded[i]);
  free(order->threads);
  free(order->stores);
  free(order->loaded);
}

static bool is_wanted(const struct trax_explain_options *options) {
  return options->check_order;
}

const struct trax_reader_kind trax_order_reader = {.bytes = sizeof(struct order),
                                                   .is_wanted = is_wanted,
                                                   .open = open_order,
                                                   .span = add_span,
                                                   .end = end_order,
                                                   .close = close_order};
