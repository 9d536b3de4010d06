/* The instruction trace: a line for each issue in the window. */
#define _POSIX_C_SOURCE 200809L /* strdup */
#include "explain/places.h"
#include "explain/span.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

struct trace {
  struct trax_reader reader;
  char **text; /* [places]: symbol, word and disassembly; NULL until needed */
};

static const char *text_of(struct trace *trace, uint32_t index, uint32_t pc, uint32_t word) {
  struct trax_places *places = trace->reader.explain->places;
  char **text = &trace->text[index];
  if (!*text) {
    char symbol[256], disassembly[128], line[512];
    trax_disassemble(word, pc, disassembly, sizeof disassembly);
    snprintf(line, sizeof line, "%-24s %08x  %-24s", trax_places_symbol(places, pc, symbol, sizeof symbol), word,
             disassembly);
    *text = strdup(line);
  }
  return *text ? *text : "";
}

static void put_place(const struct trace *trace, uint64_t cycle, uint32_t tm, uint32_t tp) {
  fprintf(trace->reader.out, "%10" PRIu64 " %4u %2u.%-2u ", cycle,
          tm * trace->reader.explain->machine->config.chip.tps_per_tm + tp, tm, tp);
}

static void put_outcome(FILE *out, unsigned outcome) {
  static const char *const names[] = {"hit", "miss", "merged", "combined"};
  for (unsigned i = 0; i < sizeof names / sizeof *names; i++)
    if (outcome >> i & 1)
      fprintf(out, " %s", names[i]);
}

static void add_span(void *self, const struct trax_span *span) {
  struct trace *trace = self;
  const struct trax_issue *issue = span->issue;
  FILE *out = trace->reader.out;
  if (!issue || !trax_window_has(&trace->reader.explain->options, span->tm, span->tp, issue->cycle, issue->cycle + 1))
    return;
  const unsigned flags = trax_op_table[span->inst.op].flags;
  put_place(trace, issue->cycle, span->tm, span->tp);
  fprintf(out, "%08x  %s", issue->pc, text_of(trace, span->index, issue->pc, issue->word));
  if (flags & TRAX_WRITES_RD && span->inst.rd && !(flags & TRAX_IS_ATOMIC))
    fprintf(out, "  r%u=%08x", span->inst.rd, issue->result);
  else if (flags & TRAX_IS_STORE || span->inst.op == TRAX_OP_TRAP)
    fprintf(out, "  %08x", issue->result);
  if (flags & (TRAX_IS_LOAD | TRAX_IS_STORE))
    fprintf(out, " [%08x]", issue->address);
  put_outcome(out, issue->outcome);
  if (flags & TRAX_IS_BRANCH && issue->next_pc != issue->pc + 4)
    fprintf(out, "  to %08x", issue->next_pc);
  fputc('\n', out);
}

static void add_arrival(void *self, const struct trax_arrival *arrival) {
  struct trace *trace = self;
  if (!arrival->rd || arrival->rd >= TRAX_NUM_REGISTERS ||
      !trax_window_has(&trace->reader.explain->options, arrival->tm, arrival->tp, arrival->cycle, arrival->cycle + 1))
    return;
  put_place(trace, arrival->cycle, arrival->tm, arrival->tp);
  fprintf(trace->reader.out, "arrival   r%u=%08x\n", arrival->rd, arrival->value);
}

static trax_status open_trace(void *self, trax_error *error) {
  struct trace *trace = self;
  fprintf(trace->reader.out,
          "#    cycle thread TM.TP pc     symbol                 word      instruction               result or value, "
          "address, cache, jump\n");
  trace->text =
      trax_explain_array((size_t)trax_places_count(trace->reader.explain->places) + 2, sizeof *trace->text, error);
  return trace->text ? TRAX_OK : TRAX_ERROR;
}

static void close_trace(void *self) {
  struct trace *trace = self;
  for (uint32_t i = 0; trace->text && i < trax_places_count(trace->reader.explain->places) + 2; i++)
    free(trace->text[i]);
  free(trace->text);
}

const struct trax_reader_kind trax_trace_reader = {.bytes = sizeof(struct trace),
                                                   .files = {{.path = TRAX_EXPLAIN_PATH(trace)}},
                                                   .open = open_trace,
                                                   .span = add_span,
                                                   .arrival = add_arrival,
                                                   .close = close_trace};
