/* The trace of transfers (docs/traces.md): what leaves for off-chip memory, written while the run goes on. */
#include "explain/memory_trace.h"

#include "machine/dram_mapping.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

enum { BLOCK_BYTES = 64 }; /* what a line in another simulator's format transfers; with DRAM it is a burst */

struct trax_memory_trace {
  struct trax_transfers transfers;
  struct trax_explain *explain;
  trax_output output;
  struct trax_dram_map map; /* with DRAM */
  uint32_t block_bytes;     /* what a line in another simulator's format transfers */
  uint64_t ticks, cycles;   /* `ticks` cycles of that simulator's clock take as long as `cycles` of the chip's */
};

static const char *const kind_names[TRAX_TRANSFER_KIND_COUNT] = {
#define NAME(ID, WORD) WORD,
    TRAX_TRANSFER_KINDS(NAME)
#undef NAME
};

/* --- our formats --- */

static void put_number(uint8_t *to, uint64_t value, unsigned bytes) {
  for (unsigned i = 0; i < bytes; i++)
    to[i] = (uint8_t)(value >> 8 * i);
}

static void put_record(FILE *out, const struct trax_transfer *transfer) {
  uint8_t record[TRAX_MEMORY_TRACE_RECORD];
  put_number(record, transfer->cycle, 8);
  put_number(record + 8, transfer->address, 4);
  put_number(record + 12, transfer->bytes, 4);
  put_number(record + 16, (uint16_t)transfer->tm, 2);
  record[18] = transfer->kind;
  record[19] = transfer->channel;
  fwrite(record, sizeof record, 1, out);
}

static void add_binary(void *context, const struct trax_transfer *transfer) {
  const struct trax_memory_trace *trace = context;
  put_record(trace->output.file, transfer);
}

static void add_csv(void *context, const struct trax_transfer *transfer) {
  const struct trax_memory_trace *trace = context;
  fprintf(trace->output.file, "%" PRIu64 ",%" PRIu32 ",%" PRIu32 ",%s,%d,%u\n", transfer->cycle, transfer->address,
          transfer->bytes, kind_names[transfer->kind], transfer->tm, transfer->channel);
}

static void begin_binary(const struct trax_memory_trace *trace) {
  uint8_t header[16] = "traxmem1";
  put_number(header + 8, TRAX_MEMORY_TRACE_RECORD, 4);
  fwrite(header, sizeof header, 1, trace->output.file);
}

static void begin_csv(const struct trax_memory_trace *trace) {
  fputs("cycle,address,bytes,kind,tm,channel\n", trace->output.file);
}

/* --- other simulators' formats: a line for each block --- */

static bool is_write(const struct trax_transfer *transfer) {
  return transfer->kind == TRAX_TRANSFER_WRITE;
}

static uint32_t first_block(const struct trax_memory_trace *trace, const struct trax_transfer *transfer) {
  return transfer->address / trace->block_bytes * trace->block_bytes;
}

static uint32_t blocks(const struct trax_memory_trace *trace, const struct trax_transfer *transfer) {
  return (transfer->bytes + trace->block_bytes - 1) / trace->block_bytes;
}

static void add_dramsim3(void *context, const struct trax_transfer *transfer) {
  const struct trax_memory_trace *trace = context;
  const uint64_t tick = (transfer->cycle * trace->ticks + trace->cycles - 1) / trace->cycles;
  for (uint32_t i = 0; i < blocks(trace, transfer); i++)
    fprintf(trace->output.file, "0x%" PRIX32 " %s %" PRIu64 "\n", first_block(trace, transfer) + i * trace->block_bytes,
            is_write(transfer) ? "WRITE" : "READ", tick);
}

static void add_load_store(void *context, const struct trax_transfer *transfer) {
  const struct trax_memory_trace *trace = context;
  for (uint32_t i = 0; i < blocks(trace, transfer); i++)
    fprintf(trace->output.file, "%s 0x%" PRIx32 "\n", is_write(transfer) ? "ST" : "LD",
            first_block(trace, transfer) + i * trace->block_bytes);
}

static void add_read_write(void *context, const struct trax_transfer *transfer) {
  const struct trax_memory_trace *trace = context;
  for (uint32_t i = 0; i < blocks(trace, transfer); i++) {
    const struct trax_dram_place place =
        trax_dram_place_of(&trace->map, first_block(trace, transfer) + i * trace->block_bytes);
    fprintf(trace->output.file, "%s %" PRIu32 ",%" PRIu32 ",%" PRIu32 ",%" PRIu32 ",%" PRIu32 "\n",
            is_write(transfer) ? "W" : "R", place.field[TRAX_DRAM_CHANNEL], place.field[TRAX_DRAM_RANK],
            place.field[TRAX_DRAM_BANK], place.field[TRAX_DRAM_ROW], place.field[TRAX_DRAM_COLUMN]);
  }
}

/* --- creation and end --- */

static const struct {
  void (*begin)(const struct trax_memory_trace *trace);
  void (*add)(void *context, const struct trax_transfer *transfer);
} formats[TRAX_MEMORY_TRACE_FORMATS] = {
    [TRAX_MEMORY_TRACE_BINARY] = {begin_binary, add_binary},
    [TRAX_MEMORY_TRACE_CSV] = {begin_csv, add_csv},
    [TRAX_MEMORY_TRACE_DRAMSIM3] = {NULL, add_dramsim3},
    [TRAX_MEMORY_TRACE_RAMULATOR2_LOADSTORE] = {NULL, add_load_store},
    [TRAX_MEMORY_TRACE_RAMULATOR2_READWRITE] = {NULL, add_read_write},
};

const char *const trax_memory_trace_formats[TRAX_MEMORY_TRACE_FORMATS + 1] = {
    "auto", "binary", "csv", "dramsim3", "ramulator2-loadstore", "ramulator2-readwrite", NULL};

static enum trax_memory_trace_format format_of(const struct trax_explain_options *options) {
  if (options->memory_trace_format)
    return options->memory_trace_format;
  return trax_output_has_ending(options->memory_trace, "csv") ? TRAX_MEMORY_TRACE_CSV : TRAX_MEMORY_TRACE_BINARY;
}

static trax_status begin(struct trax_memory_trace *trace, const struct trax_config *config, trax_error *error) {
  const struct trax_explain_options *options = &trace->explain->options;
  const enum trax_memory_trace_format format = format_of(options);
  const bool dram = config->memory.model == TRAX_MEMORY_DRAM;
  trace->block_bytes = dram ? config->dram.burst_length * config->dram.bus_bits / 8 : BLOCK_BYTES;
  trace->ticks = dram ? config->dram.mtps : 1;
  trace->cycles = dram ? 2 * (uint64_t)config->chip.clock_mhz : 1;
  if (format == TRAX_MEMORY_TRACE_RAMULATOR2_READWRITE && !dram)
    return trax_fail(error,
                     "%s: the format %s has channels, ranks, banks, rows and columns: it needs "
                     "memory.model = dram, whose mapping says them",
                     options->memory_trace, trax_memory_trace_formats[format]);
  if (dram && trax_dram_map_create(&trace->map, config, error) != TRAX_OK)
    return TRAX_ERROR;
  if (trax_output_open(&trace->output, options->memory_trace, error) != TRAX_OK)
    return TRAX_ERROR;
  if (formats[format].begin)
    formats[format].begin(trace);
  trace->transfers = (struct trax_transfers){.context = trace, .transfer = formats[format].add};
  trace->explain->machine->transfers = &trace->transfers;
  return TRAX_OK;
}

trax_status trax_memory_trace_create(struct trax_memory_trace **result, struct trax_explain *explain,
                                     trax_error *error) {
  struct trax_memory_trace *trace = *result = calloc(1, sizeof *trace);
  if (!trace)
    return trax_fail(error, "out of memory");
  trace->explain = explain;
  return begin(trace, &explain->machine->config, error);
}

trax_status trax_memory_trace_finish(struct trax_memory_trace *trace, trax_error *error) {
  if (trace->transfers.lost)
    return trax_fail(error, "out of memory: %s is incomplete and not written", trace->explain->options.memory_trace);
  return trax_output_commit(&trace->output, error);
}

void trax_memory_trace_destroy(struct trax_memory_trace *trace) {
  if (!trace)
    return;
  trace->explain->machine->transfers = NULL;
  trax_output_discard(&trace->output);
  free(trace);
}
