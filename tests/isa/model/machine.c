/* Threads in turn, one instruction each. */
#define _DEFAULT_SOURCE /* MAP_ANONYMOUS, MAP_NORESERVE */
#include "semantics.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

bool model_fail(struct model_error *error, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  if (error)
    vsnprintf(error->message, sizeof error->message, format, arguments);
  va_end(arguments);
  return false;
}

const char *model_fault_word(enum model_fault_kind kind) {
  static const char *const words[] = {
#define WORD(ID, TEXT) [MODEL_FAULT_##ID] = TEXT,
      MODEL_FAULTS(WORD)
#undef WORD
  };
  return words[kind];
}

struct model_machine *model_create(const struct model_isa *isa, uint32_t tms, uint32_t tps, uint64_t size,
                                   struct model_error *error) {
  struct model_machine *machine = calloc(1, sizeof *machine);
  struct model_thread *threads = calloc((size_t)tms * tps, sizeof *threads);
  /* The host gives pages when they are touched. */
  void *memory = mmap(NULL, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (!machine || !threads || memory == MAP_FAILED) {
    free(machine);
    free(threads);
    if (memory != MAP_FAILED)
      munmap(memory, size);
    model_fail(error, "out of memory");
    return NULL;
  }
  *machine = (struct model_machine){.isa = isa,
                                    .tms = tms,
                                    .tps = tps,
                                    .precision = 24,
                                    .memory = memory,
                                    .size = size,
                                    .threads = threads,
                                    .thread_count = tms * tps};
  for (uint32_t i = 0; i < machine->thread_count; i++) {
    threads[i].number = i;
    threads[i].tm = i / tps;
    threads[i].tp = i % tps;
  }
  return machine;
}

void model_destroy(struct model_machine *machine) {
  if (!machine)
    return;
  munmap(machine->memory, machine->size);
  free(machine->segments);
  free(machine->threads);
  free(machine);
}

void model_set_entry(struct model_machine *machine, uint32_t pc) {
  for (uint32_t i = 0; i < machine->thread_count; i++)
    machine->threads[i].pc = pc;
}

static enum model_fault_kind fetch(const struct model_machine *machine, uint32_t pc, uint32_t *word) {
  if (pc % 4)
    return MODEL_FAULT_MISALIGNED_PC;
  for (size_t i = 0; i < machine->segment_count; i++) {
    const struct model_segment *segment = &machine->segments[i];
    if (!(segment->permissions & MODEL_EXECUTE) || pc < segment->address || segment->bytes < 4 ||
        pc - segment->address > segment->bytes - 4)
      continue;
    const uint8_t *byte = machine->memory + pc;
    *word = byte[0] | (uint32_t)byte[1] << 8 | (uint32_t)byte[2] << 16 | (uint32_t)byte[3] << 24;
    return MODEL_FAULT_NONE;
  }
  return MODEL_FAULT_FETCH;
}

static void fault(struct model_machine *machine, struct model_thread *thread, enum model_fault_kind kind,
                  uint32_t address) {
  thread->ended = true;
  thread->status = 1;
  if (!machine->fault.kind)
    machine->fault = (struct model_fault){kind, thread->pc, address, thread->number};
}

bool model_step(struct model_machine *machine, struct model_thread *thread, struct model_error *error) {
  struct model_execution execution = {.machine = machine, .thread = thread, .next_pc = thread->pc + 4};
  uint32_t word = 0;
  enum model_fault_kind kind = fetch(machine, thread->pc, &word);
  if (kind) {
    fault(machine, thread, kind, thread->pc);
    return true;
  }
  execution.instruction = model_decode(machine->isa, word);
  if (!execution.instruction) {
    fault(machine, thread, MODEL_FAULT_ILLEGAL, 0);
    return true;
  }
  model_operands(execution.instruction, word, execution.operand);
  model_execute(&execution, execution.instruction->semantics);
  machine->instructions++;
  if (execution.undefined)
    return model_fail(error, "the semantics of %s, word 0x%08x at 0x%08x, have %s", execution.instruction->mnemonic,
                      word, thread->pc, execution.undefined);
  if (execution.fault)
    fault(machine, thread, execution.fault, execution.fault_address);
  else
    thread->pc = execution.next_pc;
  return true;
}

enum model_end model_run(struct model_machine *machine, uint64_t limit, struct model_error *error) {
  for (bool running = true; running; machine->turns++) {
    running = false;
    for (uint32_t i = 0; i < machine->thread_count; i++) {
      if (machine->threads[i].ended)
        continue;
      if (limit && machine->instructions == limit)
        return MODEL_LIMIT;
      if (!model_step(machine, &machine->threads[i], error))
        return MODEL_ERROR;
      running = true;
    }
    if (machine->fault.kind) /* the others have had their turn */
      return MODEL_FAULTED;
  }
  return MODEL_ENDED;
}

uint32_t model_status(const struct model_machine *machine) {
  for (uint32_t i = 0; i < machine->thread_count; i++)
    if (machine->threads[i].status)
      return machine->threads[i].status;
  return 0;
}
