/* Fuzzes the debugger's stub: each line of a case is the text of a packet, and a line with only ^C is an interrupt. A
   case that begins with a NUL is the debugger's stream of bytes instead. The debugged program runs on four threads. */
#include "fuzz_case.h"
#include "gdb/gdb.h"
#include "machine/machine.h"
#include "trax/isa.h"

#include <stdlib.h>
#include <string.h>

struct stream {
  uint8_t *bytes;
  size_t size, at;
};

static void put(struct stream *stream, const void *bytes, size_t size) {
  memcpy(stream->bytes + stream->size, bytes, size);
  stream->size += size;
}

static void put_packet(struct stream *stream, const uint8_t *bytes, size_t size) {
  char end[4];
  unsigned sum = 0;
  for (size_t i = 0; i < size; i++)
    sum += bytes[i];
  snprintf(end, sizeof end, "#%02x", sum & 255);
  put(stream, "$", 1);
  put(stream, bytes, size);
  put(stream, end, 3);
}

static void frame(struct stream *stream, const uint8_t *bytes, size_t size) {
  if (size && bytes[0] == 0) {
    put(stream, bytes + 1, size - 1);
    return;
  }
  while (size) {
    const uint8_t *newline = memchr(bytes, '\n', size);
    const size_t length = newline ? (size_t)(newline - bytes) : size, taken = newline ? length + 1 : length;
    if (length == 1 && bytes[0] == 3)
      put(stream, bytes, 1);
    else
      put_packet(stream, bytes, length);
    bytes += taken;
    size -= taken;
  }
}

/* While the program runs, only an interrupt can be received, since a debugger waits for the stop. */
static int receive(void *context, uint8_t *bytes, size_t capacity, int milliseconds) {
  struct stream *stream = context;
  if (stream->at == stream->size)
    return -1;
  if (milliseconds == 0 && stream->bytes[stream->at] != 3)
    return 0;
  const size_t left = stream->size - stream->at, size = milliseconds == 0 ? 1 : left < capacity ? left : capacity;
  size_t got = 0;
  do /* stops before an interrupt, so that it arrives while the program runs */
    bytes[got++] = stream->bytes[stream->at++];
  while (got < size && stream->bytes[stream->at] != 3);
  return (int)got;
}

static bool transmit(void *context, const void *bytes, size_t size) {
  static volatile uint8_t sum;
  (void)context;
  for (size_t i = 0; i < size; i++)
    sum ^= ((const uint8_t *)bytes)[i];
  return true;
}

/* A loop over a call, with loads and stores of global and local memory, an increment, and at the end a fault of one
   thread. */
static trax_machine *make_machine(void) {
#define I(OP, RD, RA, IMM) trax_encode((trax_inst){TRAX_OP_##OP, RD, RA, 0, IMM})
#define S(OP, RB, RA, IMM) trax_encode((trax_inst){TRAX_OP_##OP, 0, RA, RB, IMM})
  const uint32_t text[] = {
      trax_encode((trax_inst){TRAX_OP_LUI, 4, 0, 0, 1}), /* data */
      I(ADDI, 5, 0, 20),
      I(LW, 6, 4, 0), /* loop */
      trax_encode((trax_inst){TRAX_OP_JAL, 1, 0, 0, 24}),
      S(SW, 6, 4, 4),
      trax_encode((trax_inst){TRAX_OP_AINC, 7, 4, 0, 0}),
      I(ADDI, 5, 5, -1),
      trax_encode((trax_inst){TRAX_OP_BNE, 0, 5, 0, -20}),
      I(LW, 6, 0, 8),
      S(SW, 6, 0, -8), /* the function */
      I(LW, 6, 0, -8),
      I(JALR, 0, 1, 0),
  };
  trax_error error;
  uint8_t *host;
  trax_config *config = trax_config_create();
  trax_machine *machine = NULL;
  if (!config || trax_config_set(config, "chip.tms", "2", &error) ||
      trax_config_set(config, "chip.tps_per_tm", "2", &error) ||
      trax_config_set(config, "memory.size_mib", "1", &error) || !(machine = trax_machine_create(config, &error)) ||
      trax_machine_map(machine, 0x1000, sizeof text, TRAX_PERMIT_READ | TRAX_PERMIT_EXECUTE, &host, &error))
    abort();
  memcpy(host, text, sizeof text);
  if (trax_machine_map(machine, 0x10000, 64, TRAX_PERMIT_READ | TRAX_PERMIT_WRITE, &host, &error) ||
      trax_machine_set_entry(machine, 0x1000, &error))
    abort();
  trax_config_destroy(config);
  return machine;
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
  trax_error error = {.message = ""};
  struct stream stream = {.bytes = malloc(5 * size + 5)};
  if (!stream.bytes)
    abort();
  frame(&stream, bytes, size);
  trax_machine *machine = make_machine();
  const struct trax_gdb_link link = {&stream, receive, transmit};
  struct trax_gdb *gdb = trax_gdb_create(machine, &link, NULL, &error);
  if (!gdb || trax_machine_run(machine, &(trax_run_options){.max_cycles = 20000}, &error) == TRAX_ERROR) {
    fprintf(stderr, "%s\n", error.message); /* such as a violation of the rule of accounting */
    abort();
  }
  trax_gdb_destroy(gdb);
  trax_machine_destroy(machine);
  free(stream.bytes);
  return 0;
}
