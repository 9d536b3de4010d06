/* The trace of transfers (docs/traces.md): the requests to off-chip memory, written during the run. */
#include "explain/span.h"

#include <inttypes.h>

enum { RECORD_BYTES = 20 }; /* of the binary trace */

struct memory_trace {
  struct trax_reader reader;
  struct trax_transfers transfers;
};

static const char *const kind_names[TRAX_TRANSFER_KIND_COUNT] = {
#define NAME(ID, WORD) WORD,
    TRAX_TRANSFER_KINDS(NAME)
#undef NAME
};

static void put_number(uint8_t *to, uint64_t value, unsigned bytes) {
  for (unsigned i = 0; i < bytes; i++)
    to[i] = (uint8_t)(value >> 8 * i);
}

static void put_record(FILE *out, const struct trax_transfer *transfer) {
  uint8_t record[RECORD_BYTES];
  put_number(record, transfer->cycle, 8);
  put_number(record + 8, transfer->address, 4);
  put_number(record + 12, transfer->bytes, 4);
  put_number(record + 16, (uint16_t)transfer->tm, 2);
  record[18] = transfer->kind;
  record[19] = transfer->channel;
  fwrite(record, sizeof record, 1, out);
}

static void add_binary(void *context, const struct trax_transfer *transfer) {
  put_record(context, transfer);
}

static void add_csv(void *context, const struct trax_transfer *transfer) {
  fprintf(context, "%" PRIu64 ",%" PRIu32 ",%" PRIu32 ",%s,%d,%u\n", transfer->cycle, transfer->address,
          transfer->bytes, kind_names[transfer->kind], transfer->tm, transfer->channel);
}

static trax_status open_memory_trace(void *self, trax_error *error) {
  struct memory_trace *trace = self;
  const bool csv = trax_output_has_ending(trace->reader.explain->options.memory_trace, "csv");
  uint8_t header[16] = "traxmem1";
  (void)error;
  put_number(header + 8, RECORD_BYTES, 4);
  if (csv)
    fputs("cycle,address,bytes,kind,tm,channel\n", trace->reader.out);
  else
    fwrite(header, sizeof header, 1, trace->reader.out);
  trace->transfers = (struct trax_transfers){.context = trace->reader.out, .transfer = csv ? add_csv : add_binary};
  trace->reader.explain->machine->transfers = &trace->transfers;
  return TRAX_OK;
}

static trax_status end_memory_trace(void *self, trax_error *error) {
  const struct memory_trace *trace = self;
  return trace->transfers.lost ? trax_fail(error, "out of memory: %s is incomplete and not written",
                                           trace->reader.explain->options.memory_trace)
                               : TRAX_OK;
}

static void close_memory_trace(void *self) {
  ((struct memory_trace *)self)->reader.explain->machine->transfers = NULL;
}

const struct trax_reader_kind trax_memory_trace_reader = {.bytes = sizeof(struct memory_trace),
                                                          .files = {{.path = TRAX_EXPLAIN_PATH(memory_trace)}},
                                                          .open = open_memory_trace,
                                                          .end = end_memory_trace,
                                                          .close = close_memory_trace};
