/* The window as a pipeline in the format of the viewer Konata ("Kanata", version 0004): instructions with the cycles in
   which they were fetched, waited, and were issued. The format is ordered by cycle, so the events are collected and
   sorted at the end. */
#include "explain/places.h"
#include "explain/span.h"
#include "explain/table.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

enum stage { FETCH, WAIT, UNIT, QUEUE, EXECUTE, RETIRE, STAGES };
static const char *const stage_names[STAGES] = {
    [FETCH] = "F", [WAIT] = "W", [UNIT] = "U", [QUEUE] = "Q", [EXECUTE] = "X"};

struct event {
  uint64_t cycle;
  uint32_t instruction; /* in the order of issue */
  uint8_t stage;
  bool first; /* of the instruction */
};

struct instruction {
  uint32_t pc, word, result, address, thread, id; /* id: its number in the file, from its first event on */
};

struct konata {
  struct trax_explain *explain;
  struct event *events;
  size_t event_count, event_capacity;
  struct instruction *instructions;
  size_t instruction_count, instruction_capacity;
  bool out_of_memory;
};

static enum stage stage_of(trax_cause cause) {
  switch (cause) {
  case TRAX_CAUSE_ICACHE_BANK:
  case TRAX_CAUSE_ICACHE_MISS:
    return FETCH;
#define REFUSED(X, ID, ...) case TRAX_CAUSE_##ID:
    TRAX_SHARED_UNITS(REFUSED, )
#undef REFUSED
  case TRAX_CAUSE_DCACHE_BANK:
    return UNIT;
  case TRAX_CAUSE_MEMORY_QUEUE:
    return QUEUE;
  default:
    return WAIT;
  }
}

static void add_event(struct konata *konata, uint64_t cycle, enum stage stage, bool *first) {
  const struct trax_explain_options *options = &konata->explain->options;
  if (!trax_grow((void **)&konata->events, konata->event_count, &konata->event_capacity, sizeof *konata->events)) {
    konata->out_of_memory = true;
    return;
  }
  konata->events[konata->event_count++] =
      (struct event){.cycle = cycle > options->window_begin ? cycle : options->window_begin,
                     .instruction = (uint32_t)konata->instruction_count,
                     .stage = (uint8_t)stage,
                     .first = *first};
  *first = false;
}

static void add_span(void *self, const struct trax_span *span) {
  struct konata *konata = self;
  const struct trax_explain_options *options = &konata->explain->options;
  const struct trax_issue *issue = span->issue;
  if (!issue || !trax_window_has(options, span->tm, span->tp, issue->cycle, issue->cycle + 1))
    return;
  if (!trax_grow((void **)&konata->instructions, konata->instruction_count, &konata->instruction_capacity,
                 sizeof *konata->instructions)) {
    konata->out_of_memory = true;
    return;
  }
  bool first = true;
  for (size_t i = 0; i < span->count; i++) {
    const struct trax_charge *charge = &span->charges[i];
    if (charge->cause != TRAX_CAUSE_BRANCH && charge->since + charge->cycles > options->window_begin)
      add_event(konata, charge->since, stage_of(charge->cause), &first);
  }
  add_event(konata, issue->cycle, EXECUTE, &first);
  add_event(konata, issue->cycle + 1, RETIRE, &first);
  konata->instructions[konata->instruction_count++] = (struct instruction){
      .pc = issue->pc, .word = issue->word, .result = issue->result, .address = issue->address, .thread = span->thread};
}

static int by_cycle(const void *a, const void *b) {
  const struct event *x = a, *y = b;
  if (x->cycle != y->cycle)
    return x->cycle < y->cycle ? -1 : 1;
  if (x->instruction != y->instruction)
    return x->instruction < y->instruction ? -1 : 1;
  return x->stage - y->stage; /* RETIRE is the last stage of a cycle */
}

static void put_event(struct konata *konata, const struct event *event, uint32_t *ids, uint32_t *retired, FILE *out) {
  struct instruction *instruction = &konata->instructions[event->instruction];
  const trax_inst inst = trax_decode(instruction->word);
  const trax_op_info *op = &trax_op_table[inst.op];
  if (event->first) {
    char disassembly[128], symbol[256];
    instruction->id = (*ids)++;
    trax_disassemble(instruction->word, instruction->pc, disassembly, sizeof disassembly);
    fprintf(out, "I\t%u\t%u\t%u\n", instruction->id, event->instruction, instruction->thread);
    fprintf(out, "L\t%u\t0\t%08x: %s\n", instruction->id, instruction->pc, disassembly);
    fprintf(out, "L\t%u\t1\t%s", instruction->id,
            trax_places_symbol(konata->explain->places, instruction->pc, symbol, sizeof symbol));
    if (op->flags & TRAX_WRITES_RD && inst.rd && !(op->flags & TRAX_IS_ATOMIC))
      fprintf(out, ", result %08x", instruction->result);
    if (op->flags & (TRAX_IS_LOAD | TRAX_IS_STORE))
      fprintf(out, ", address %08x", instruction->address);
    fputc('\n', out);
  }
  if (event->stage == RETIRE)
    fprintf(out, "R\t%u\t%u\t0\n", instruction->id, (*retired)++);
  else
    fprintf(out, "S\t%u\t0\t%s\n", instruction->id, stage_names[event->stage]);
}

static trax_status finish(void *self, trax_error *error) {
  struct konata *konata = self;
  trax_output output;
  if (konata->out_of_memory)
    return trax_fail(error, "out of memory for the pipeline; a smaller --window needs less");
  if (trax_output_open(&output, konata->explain->options.konata, error) != TRAX_OK)
    return TRAX_ERROR;
  if (konata->event_count)
    qsort(konata->events, konata->event_count, sizeof *konata->events, by_cycle);
  uint64_t cycle = konata->explain->options.window_begin;
  uint32_t ids = 0, retired = 0;
  fprintf(output.file, "Kanata\t0004\nC=\t%" PRIu64 "\n", cycle);
  for (size_t i = 0; i < konata->event_count; i++) {
    const struct event *event = &konata->events[i];
    if (event->cycle != cycle)
      fprintf(output.file, "C\t%" PRIu64 "\n", event->cycle - cycle);
    cycle = event->cycle;
    put_event(konata, event, &ids, &retired, output.file);
  }
  return trax_output_commit(&output, error);
}

static void destroy(void *self) {
  struct konata *konata = self;
  free(konata->events);
  free(konata->instructions);
  free(konata);
}

trax_status trax_konata_create(struct trax_explain *explain, struct trax_reader *reader, trax_error *error) {
  if (!explain->options.window_end)
    return trax_fail(error, "a pipeline for Konata needs a window of cycles");
  struct konata *konata = calloc(1, sizeof *konata);
  if (!konata)
    return trax_fail(error, "out of memory");
  konata->explain = explain;
  *reader = (struct trax_reader){.self = konata, .span = add_span, .finish = finish, .destroy = destroy};
  return TRAX_OK;
}
