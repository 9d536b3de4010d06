/* The debugger's access to threads, registers and memory. */
#define _POSIX_C_SOURCE 200809L /* open_memstream */
#include "gdb/registers.h"
#include "gdb/stub.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Our registers in the places of x0 to x31, and RISC-V's names of these. */
static const uint8_t roles[TRAX_NUM_REGISTERS] = TRAX_DWARF_REGISTERS;
static const char *const role_names[TRAX_NUM_REGISTERS] = {
    "zero", "ra", "sp", "gp", "tp", "t0", "t1", "t2", "fp", "s1", "a0",  "a1",  "a2", "a3", "a4", "a5",
    "a6",   "a7", "s2", "s3", "s4", "s5", "s6", "s7", "s8", "s9", "s10", "s11", "t3", "t4", "t5", "t6"};

/* --- threads --- */

bool trax_gdb_is_alive(const struct trax_gdb *gdb, uint32_t thread) {
  const struct trax_fault *fault = &gdb->machine->fault;
  return !trax_run_thread(gdb->run, thread).ended || (fault->kind && fault->thread == thread);
}

uint32_t trax_gdb_pc(const struct trax_gdb *gdb, uint32_t thread) {
  return trax_run_thread(gdb->run, thread).pc;
}

void trax_gdb_thread_name(const struct trax_gdb *gdb, uint32_t thread, char *name, size_t size) {
  snprintf(name, size, "TM %u TP %u", thread / gdb->tps, thread % gdb->tps);
}

/* --- registers --- */

uint32_t trax_gdb_register(const struct trax_gdb *gdb, uint32_t thread, unsigned number) {
  const struct trax_thread state = trax_run_thread(gdb->run, thread);
  if (number == TRAX_GDB_PC)
    return gdb->pretence.steps && thread == gdb->stopped ? gdb->pretence.pc : state.pc;
  const unsigned own = number < TRAX_GDB_PC ? roles[number] : number - TRAX_GDB_OWN;
  return own ? state.reg[own] : 0;
}

/* Moves the thread to another pc. False: pc is no text. */
static bool set_pc(struct trax_gdb *gdb, uint32_t thread, uint32_t pc) {
  if (trax_text_at(&gdb->run->text, pc)->resource == TRAX_RESOURCE_NO_TEXT)
    return false;
  gdb->thread[thread].skip_breaks = 0;
  if (thread == gdb->stopped)
    gdb->pretence.steps = 0;
  if (pc == trax_gdb_pc(gdb, thread))
    return true;
  gdb->run->engine->set_pc(gdb->run->chip, thread, pc);
  gdb->thread[thread].reported = true;
  return true;
}

bool trax_gdb_set_register(struct trax_gdb *gdb, uint32_t thread, unsigned number, uint32_t value) {
  if (gdb->over || !trax_gdb_is_alive(gdb, thread))
    return false;
  gdb->changed = true;
  if (number == TRAX_GDB_PC)
    return set_pc(gdb, thread, value);
  const unsigned own = number < TRAX_GDB_PC ? roles[number] : number - TRAX_GDB_OWN;
  if (own)
    trax_run_thread(gdb->run, thread).reg[own] = value;
  return own || !value;
}

/* --- memory --- */

size_t trax_gdb_memory(const struct trax_gdb *gdb, uint32_t thread, uint32_t address, size_t size, uint8_t **bytes) {
  const struct trax_space *space = &gdb->machine->space;
  uint64_t end = space->size;
  if (address >= TRAX_LOCAL_BASE) {
    *bytes = trax_run_thread(gdb->run, thread).local + (address - TRAX_LOCAL_BASE);
    end = (uint64_t)TRAX_LOCAL_BASE + TRAX_LOCAL_SIZE;
  } else if (address >= TRAX_NULL_END && address < end) {
    *bytes = space->bytes + address;
  } else {
    return 0;
  }
  return size < end - address ? size : (size_t)(end - address);
}

bool trax_gdb_write_memory(struct trax_gdb *gdb, uint32_t thread, uint32_t address, const void *bytes, size_t size) {
  uint8_t *place;
  if (size == 0)
    return true;
  if (gdb->over || trax_gdb_memory(gdb, thread, address, size, &place) != size)
    return false;
  for (size_t i = 0; i < gdb->run->text.count; i++) {
    const struct trax_text_segment *segment = &gdb->run->text.segments[i];
    if (address < segment->end && (uint64_t)address + size > segment->begin)
      return false;
  }
  memcpy(place, bytes, size);
  gdb->changed = true;
  return true;
}

/* --- documents --- */

char *trax_gdb_target_description(void) {
  char *text = NULL;
  size_t size;
  FILE *out = open_memstream(&text, &size);
  if (!out)
    return NULL;
  fprintf(out,
          "<?xml version=\"1.0\"?>\n<!DOCTYPE target SYSTEM \"gdb-target.dtd\">\n<target version=\"1.0\">\n"
          "<architecture>riscv:rv32</architecture>\n<osabi>none</osabi>\n<feature name=\"org.gnu.gdb.riscv.cpu\">\n");
  for (unsigned i = 0; i < TRAX_NUM_REGISTERS; i++)
    fprintf(out, "<reg name=\"%s\" bitsize=\"32\" type=\"%s\" regnum=\"%u\"/>\n", role_names[i],
            i == 1             ? "code_ptr"
            : i == 2 || i == 8 ? "data_ptr"
                               : "int",
            i);
  fprintf(out,
          "<reg name=\"pc\" bitsize=\"32\" type=\"code_ptr\" regnum=\"%u\"/>\n</feature>\n"
          "<feature name=\"trax.own\">\n",
          TRAX_GDB_PC);
  for (unsigned i = 0; i < TRAX_NUM_REGISTERS; i++)
    fprintf(out, "<reg name=\"r%u\" bitsize=\"32\" type=\"int\" regnum=\"%u\" group=\"trax\"/>\n", i, TRAX_GDB_OWN + i);
  fprintf(out, "</feature>\n</target>\n");
  if (fclose(out) != 0) {
    free(text);
    return NULL;
  }
  return text;
}

char *trax_gdb_thread_list(const struct trax_gdb *gdb) {
  char *text = NULL, name[32];
  size_t size;
  FILE *out = open_memstream(&text, &size);
  if (!out)
    return NULL;
  fprintf(out, "<?xml version=\"1.0\"?>\n<threads>\n");
  for (uint32_t thread = 0; thread < gdb->threads; thread++)
    if (trax_gdb_is_alive(gdb, thread)) {
      trax_gdb_thread_name(gdb, thread, name, sizeof name);
      fprintf(out, "<thread id=\"%x\" core=\"%u\" name=\"%s\"/>\n", thread + 1, thread / gdb->tps, name);
    }
  fprintf(out, "</threads>\n");
  if (fclose(out) != 0) {
    free(text);
    return NULL;
  }
  return text;
}
