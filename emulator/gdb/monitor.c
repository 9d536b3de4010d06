/* The commands of GDB's `monitor`. */
#define _POSIX_C_SOURCE 200809L /* open_memstream */
#include "gdb/stub.h"
#include "program/program.h"
#include "report/backtrace.h"
#include "report/place.h"
#include "report/statistics.h"
#include "trax/isa.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool print_cycle(struct trax_gdb *gdb, const char *arguments, FILE *out) {
  fprintf(out, "%" PRIu64 "\n", gdb->cycle);
  return !*arguments;
}

static void print_figure(void *context, const struct trax_figure *figure) {
  if (figure->value != 0)
    fprintf(context, "%-32s %.*g %s\n", figure->name, figure->whole ? 20 : 6, figure->value, figure->unit);
}

static bool print_statistics(struct trax_gdb *gdb, const char *arguments, FILE *out) {
  struct trax_stats stats = gdb->machine->stats;
  stats.cycles = gdb->cycle;
  trax_run_settle(gdb->run, gdb->cycle);
  trax_stats_sum(gdb->machine, &stats);
  trax_figures_visit(&stats, NULL, &gdb->machine->config, print_figure, out);
  return !*arguments;
}

static bool print_registers(struct trax_gdb *gdb, const char *arguments, FILE *out) {
  const struct trax_thread state = trax_run_thread(gdb->run, gdb->selected);
  for (unsigned i = 0; i < TRAX_NUM_REGISTERS; i++)
    fprintf(out, "r%-2u %-4s %08x%s", i, trax_register_names[i], state.reg[i], i % 4 == 3 ? "\n" : "   ");
  fprintf(out, "pc       %08x\n", state.pc);
  return !*arguments;
}

/* Arguments: [ADDRESS [COUNT]]; by default from the selected thread's pc. */
static bool print_instructions(struct trax_gdb *gdb, const char *arguments, FILE *out) {
  char *end = (char *)arguments;
  const unsigned long address = *arguments ? strtoul(arguments, &end, 0) : trax_gdb_pc(gdb, gdb->selected);
  const unsigned long count = *end ? strtoul(end, &end, 0) : 10;
  if (*end || address > UINT32_MAX || address % 4 || count > 1000)
    return false;
  for (uint32_t pc = (uint32_t)address, i = 0; i < count; i++, pc += 4) {
    uint8_t *bytes;
    uint32_t word;
    if (trax_gdb_memory(gdb, gdb->selected, pc, sizeof word, &bytes) < sizeof word)
      break;
    memcpy(&word, bytes, sizeof word);
    fprintf(out, "%s 0x%08x  ", pc == trax_gdb_pc(gdb, gdb->selected) ? "=>" : "  ", pc);
    trax_print_instruction(word, pc, out);
    fputc('\n', out);
  }
  return true;
}

static bool print_where(struct trax_gdb *gdb, const char *arguments, FILE *out) {
  trax_print_backtrace(gdb->run, gdb->selected, out);
  return !*arguments;
}

static bool print_threads(struct trax_gdb *gdb, const char *arguments, FILE *out) {
  trax_print_threads(gdb->run, out);
  return !*arguments;
}

static bool print_help(struct trax_gdb *gdb, const char *arguments, FILE *out);

static const struct {
  const char *name, *meaning;
  bool (*print)(struct trax_gdb *gdb, const char *arguments, FILE *out); /* returns false for bad arguments */
} commands[] = {
    {"cycle", "the next cycle", print_cycle},
    {"stats", "statistics up to the current cycle", print_statistics},
    {"registers", "the selected thread's registers by their TRaX names", print_registers},
    {"disassemble", "[ADDRESS [COUNT]]  instructions from ADDRESS or the selected thread's pc on", print_instructions},
    {"where", "the selected thread's callers", print_where},
    {"threads", "call chains of all threads, and the threads of each", print_threads},
    {"help", "this list", print_help},
};
enum { COMMANDS = sizeof commands / sizeof *commands };

static bool print_help(struct trax_gdb *gdb, const char *arguments, FILE *out) {
  (void)gdb;
  for (size_t i = 0; i < COMMANDS; i++)
    fprintf(out, "monitor %-12s %s\n", commands[i].name, commands[i].meaning);
  return !*arguments;
}

/* Sends text for the debugger's terminal, in as many packets as it needs. */
static void send_text(struct trax_gdb_wire *wire, const char *text, size_t size) {
  while (size) {
    const size_t part = size < TRAX_GDB_PACKET / 4 ? size : TRAX_GDB_PACKET / 4;
    trax_gdb_begin(wire);
    trax_gdb_add(wire, "O");
    trax_gdb_add_hex(wire, text, part);
    trax_gdb_send(wire);
    text += part;
    size -= part;
  }
}

bool trax_gdb_monitor(struct trax_gdb *gdb, const char *command) {
  const size_t length = strcspn(command, " ");
  const char *arguments = command + length + strspn(command + length, " ");
  char *text = NULL;
  size_t size = 0;
  FILE *out = open_memstream(&text, &size);
  if (!out)
    return false;
  bool known = false;
  for (size_t i = 0; i < COMMANDS; i++)
    if (strlen(commands[i].name) == length && strncmp(commands[i].name, command, length) == 0)
      known = commands[i].print(gdb, arguments, out);
  if (!known) {
    fprintf(out, "not understood: %s\n", command);
    print_help(gdb, "", out);
  }
  if (fclose(out) == 0)
    send_text(&gdb->wire, text, size);
  free(text);
  return true;
}
