/* The check of memory (docs/checking.md) follows every instruction: it keeps the shadow of each thread's registers and
   of every word, the calls, and the frames. */
#include "explain/memory_check.h"
#include "trax/grow.h"
#include "trax/host_calls.h"

#include <stdlib.h>
#include <string.h>

enum { SP = 2 };

/* Accesses of the heap's own functions are not reported. */
static void note(struct trax_memory_check *check, const struct trax_span *span, enum trax_memory_finding finding,
                 uint32_t address, uint32_t bytes, bool write, uint32_t object) {
  const struct trax_memory_event event = trax_memory_event_of(check, span);
  if (check->threads[span->thread].function == MEMORY_OTHER)
    trax_memory_note(check, finding, &event, address, bytes, write, object);
}

/* Reports that undefined bits have an effect, and takes them as defined from now on. */
static void note_undefined(struct trax_memory_check *check, const struct trax_span *span,
                           enum trax_memory_finding finding, struct trax_memory_value *value) {
  note(check, span, finding, value->from, 4, false, trax_memory_block_at(check, value->from));
  value->undefined = 0;
}

static bool is_in(const struct trax_memory_check *check, const struct trax_span *span, const char *function) {
  const char *symbol = trax_places_at(check->reader.explain->places, span->index)->symbol;
  return symbol && strcmp(symbol, function) == 0;
}

/* --- accesses --- */

static struct trax_memory_value load(const struct trax_memory_check *check, const struct trax_span *span,
                                     uint32_t bytes) {
  const uint32_t address = span->issue->address;
  struct trax_memory_value value = {.bits = span->issue->result, .from = address};
  for (uint32_t i = 0; i < bytes; i++)
    value.undefined |= (uint32_t)trax_memory_undefined_byte(check, span->thread, address + i) << 8 * i;
  if ((span->inst.op == TRAX_OP_LB && value.undefined & 0x80) ||
      (span->inst.op == TRAX_OP_LH && value.undefined & 0x8000))
    value.undefined |= ~0u << 8 * bytes;
  if (bytes == 4 && !value.undefined)
    value.tag = trax_memory_tag_at(check, span->thread, address);
  if (value.tag == MEMORY_PRIVATE)
    value.tag = MEMORY_NO_TAG;
  return value;
}

static void store(struct trax_memory_check *check, const struct trax_span *span, uint32_t bytes,
                  const struct trax_memory_value *value) {
  struct trax_memory_thread *thread = &check->threads[span->thread];
  const uint32_t address = span->issue->address;
  uint32_t tag = bytes == 4 ? value->tag : MEMORY_NO_TAG;
  uint8_t *undefined;
  if (thread->function && !tag && (address < check->heap_begin || address >= check->heap_end))
    tag = MEMORY_PRIVATE;
  if (address >= TRAX_LOCAL_BASE) {
    memcpy(thread->local + (address - TRAX_LOCAL_BASE), &value->bits, bytes); /* both are little endian */
    undefined = thread->local_undefined + (address - TRAX_LOCAL_BASE);
    thread->local_tags[address % TRAX_LOCAL_SIZE / 4] = tag;
  } else {
    struct trax_memory_page *page = check->pages[address >> MEMORY_PAGE_SHIFT];
    if (!page && ((!value->undefined && !tag && !check->fresh[address >> MEMORY_PAGE_SHIFT]) ||
                  !(page = trax_memory_page_of(check, address))))
      return;
    undefined = page->undefined + address % MEMORY_PAGE;
    page->tags[address % MEMORY_PAGE / 4] = tag;
  }
  for (uint32_t i = 0; i < bytes; i++)
    undefined[i] = (uint8_t)(value->undefined >> 8 * i);
}

/* A word load may reach beyond its object: in string functions behind a string; around an atomic byte or half word. */
static bool is_partial(struct trax_memory_check *check, const struct trax_span *span) {
  const uint32_t tag = check->threads[span->thread].reg[span->inst.ra].tag;
  uint32_t object;
  const bool atomic = span->inst.op == TRAX_OP_LWNT;
  bool some = false;
  if (!atomic && !(span->inst.op == TRAX_OP_LW && (is_in(check, span, "strlen") || is_in(check, span, "strcmp"))))
    return false;
  for (uint32_t i = 0; i < (atomic ? 4 : 1); i++)
    some |= trax_memory_check_access(check, span->thread, tag, span->inst.imm, span->issue->address + i, 1, &object) ==
            MEMORY_NOTHING;
  return some;
}

static void access(struct trax_memory_check *check, const struct trax_span *span, const trax_op_info *op) {
  struct trax_memory_thread *thread = &check->threads[span->thread];
  struct trax_memory_value *base = &thread->reg[span->inst.ra];
  const uint32_t address = span->issue->address, bytes = op->access_bytes;
  const bool write = op->flags & (TRAX_IS_STORE | TRAX_IS_ATOMIC);
  uint32_t object;
  if (base->undefined)
    note_undefined(check, span, MEMORY_ADDRESS, base);
  if (!thread->function) {
    const enum trax_memory_finding finding =
        trax_memory_check_access(check, span->thread, base->tag, span->inst.imm, address, bytes, &object);
    if (finding && !is_partial(check, span))
      note(check, span, finding, address, bytes, write, object);
  }
  if (op->flags & TRAX_IS_STORE) {
    struct trax_memory_value value = thread->reg[span->inst.rb];
    value.bits = span->issue->result;
    store(check, span, bytes, &value);
    thread->recent[thread->stores % MEMORY_RECENT].address = address;
    thread->recent[thread->stores++ % MEMORY_RECENT].value = value.bits;
  } else if (span->inst.rd) {
    thread->reg[span->inst.rd] = load(check, span, bytes);
    if (thread->read.bytes && address == thread->read.block) {
      const uint32_t result = span->issue->result; /* a number of bytes, or negative */
      trax_memory_define(check, span->thread, thread->read.address, result <= thread->read.bytes ? result : 0, false);
      thread->read.bytes = 0;
    }
  }
}

/* --- traps --- */

static void check_output(struct trax_memory_check *check, const struct trax_span *span, uint32_t address,
                         uint32_t bytes) {
  uint32_t object;
  for (uint32_t i = 0; i < bytes; i++) {
    uint8_t byte;
    if (!trax_memory_byte(check, span->thread, address + i, &byte))
      return;
    const enum trax_memory_finding finding =
        trax_memory_check_access(check, span->thread, MEMORY_NO_TAG, 0, address + i, 1, &object);
    if (finding) {
      note(check, span, finding, address + i, 1, false, object);
      return;
    }
    if (trax_memory_undefined_byte(check, span->thread, address + i)) {
      struct trax_memory_value value = {.undefined = 0xFF, .from = address + i};
      note_undefined(check, span, MEMORY_OUTPUT, &value);
      return;
    }
  }
}

/* The number of a host call has been replaced by its result, so it is taken from the thread's own stores. */
static uint32_t host_call_number(const struct trax_memory_thread *thread, uint32_t block) {
  for (unsigned i = 1; i <= MEMORY_RECENT && i <= thread->stores; i++)
    if (thread->recent[(thread->stores - i) % MEMORY_RECENT].address == block)
      return thread->recent[(thread->stores - i) % MEMORY_RECENT].value;
  return TRAX_HOST_READ;
}

static void host_call(struct trax_memory_check *check, const struct trax_span *span, uint32_t block) {
  const uint32_t number = host_call_number(&check->threads[span->thread], block);
  uint32_t address = 0, bytes = 0;
  if (!trax_memory_word(check, span->thread, block + 8, &address) ||
      !trax_memory_word(check, span->thread, block + 12, &bytes))
    return;
  trax_memory_define(check, span->thread, block, 4, false);
  if (number == TRAX_HOST_WRITE)
    check_output(check, span, address, bytes);
  else if (number == TRAX_HOST_READ || number == TRAX_HOST_LIST || number == TRAX_HOST_FOLDER)
    check->threads[span->thread].read = (struct trax_memory_read){block, address, bytes};
  else if (number == TRAX_HOST_SEEK || number == TRAX_HOST_STAT || number == TRAX_HOST_FSTAT)
    trax_memory_define(check, span->thread, address, number == TRAX_HOST_SEEK ? 8 : 4 * TRAX_STAT_WORDS, false);
}

static void trap(struct trax_memory_check *check, const struct trax_span *span) {
  struct trax_memory_value *operand = &check->threads[span->thread].reg[span->inst.ra];
  const int32_t code = span->inst.imm;
  if (operand->undefined & (code == TRAX_TRAP_PUTC ? 0xFF : ~0u))
    note_undefined(check, span, MEMORY_OUTPUT, operand);
  uint32_t length = 0;
  uint8_t byte;
  if (code == TRAX_TRAP_PUTS) {
    while (trax_memory_byte(check, span->thread, operand->bits + length, &byte) && byte)
      length++;
    check_output(check, span, operand->bits, length + 1);
  } else if (code == TRAX_TRAP_HOST) {
    host_call(check, span, operand->bits);
  }
}

/* --- the reader --- */

static void branch(struct trax_memory_check *check, const struct trax_span *span) {
  struct trax_memory_thread *thread = &check->threads[span->thread];
  struct trax_memory_value *a = &thread->reg[span->inst.ra], *b = &thread->reg[span->inst.rb];
  if (!trax_memory_branch_is_undefined(thread, span->inst))
    return;
  /* strcmp compares whole words before it looks for the end in them. */
  if (!((a->undefined | b->undefined) & 0xFF) && is_in(check, span, "strcmp"))
    return;
  note_undefined(check, span, MEMORY_BRANCH, a->undefined ? a : b);
  a->undefined = b->undefined = 0;
}

static void add_span(void *self, const struct trax_span *span) {
  struct trax_memory_check *check = self;
  const trax_op_info *op = &trax_op_table[span->inst.op];
  if (!span->issue || check->reader.explain->out_of_memory)
    return;
  struct trax_memory_thread *thread = &check->threads[span->thread];
  const uint32_t stack_pointer = thread->reg[SP].bits;
  if (op->access_bytes) {
    access(check, span, op);
  } else if (span->inst.op == TRAX_OP_JAL || span->inst.op == TRAX_OP_JALR) {
    struct trax_memory_value *target = &thread->reg[span->inst.ra];
    if (span->inst.op == TRAX_OP_JALR && target->undefined)
      note_undefined(check, span, MEMORY_ADDRESS, target);
    if (span->inst.rd)
      thread->reg[span->inst.rd] = (struct trax_memory_value){.bits = span->issue->result};
    if (span->inst.rd && span->issue->next_pc != span->pc + 4) /* else a call of a weak function that is not defined */
      trax_memory_call(check, span);
    else if (!span->inst.rd)
      trax_memory_jump(check, span);
  } else if (op->flags & TRAX_IS_BRANCH) {
    branch(check, span);
  } else if (span->inst.op == TRAX_OP_TRAP) {
    trap(check, span);
  } else if (op->flags & TRAX_WRITES_RD && span->inst.rd) {
    thread->reg[span->inst.rd] = trax_memory_result(check, thread, span);
  }
  if (thread->reg[SP].bits != stack_pointer)
    trax_memory_move_stack(check, span, stack_pointer);
}

static void add_arrival(void *self, const struct trax_arrival *arrival) {
  struct trax_memory_check *check = self;
  if (arrival->rd)
    check->threads[arrival->tm * check->tps + arrival->tp].reg[arrival->rd].bits = arrival->value;
}

/* An observer does not see the instruction that faults. If it is an access, its address may be an error of memory. */
static void check_fault(struct trax_memory_check *check) {
  const struct trax_fault *fault = trax_machine_fault(check->machine);
  if (!check->loaded || fault->kind == TRAX_FAULT_NONE || !fault->bytes)
    return;
  const struct trax_memory_thread *thread = &check->threads[fault->thread];
  const trax_inst inst = trax_decode(fault->word);
  const struct trax_memory_value *base = &thread->reg[inst.ra];
  const struct trax_memory_event event = {fault->cycle, fault->thread, fault->pc, thread->context};
  uint32_t object;
  if (!trax_op_table[inst.op].access_bytes || thread->function)
    return;
  if (base->undefined)
    trax_memory_note(check, MEMORY_ADDRESS, &event, base->from, 4, false, trax_memory_block_at(check, base->from));
  const enum trax_memory_finding finding =
      trax_memory_check_access(check, fault->thread, base->tag, inst.imm, fault->address, fault->bytes, &object);
  if (finding && object && check->objects[object].kind != MEMORY_BUFFER) /* the fault itself names a buffer */
    trax_memory_note(check, finding, &event, fault->address, fault->bytes, fault->write, object);
}

static trax_status end(void *self, trax_error *error) {
  struct trax_memory_check *check = self;
  check_fault(check);
  if (check->loaded && check->machine->status == TRAX_OK && check->heap_end &&
      trax_memory_find_leaks(check, error) != TRAX_OK)
    return TRAX_ERROR;
  if (!check->site_count)
    return TRAX_OK;
  fflush(stdout);
  trax_memory_print(check, stderr);
  return trax_fail(error, "the program has %zu error%s of memory (--check-memory)", check->site_count,
                   check->site_count == 1 ? "" : "s");
}

static trax_status open_check(void *self, trax_error *error) {
  struct trax_memory_check *check = self;
  check->machine = check->reader.explain->machine;
  check->loaded = trax_loaded_of(check->machine);
  check->tps = check->machine->config.chip.tps_per_tm;
  check->page_count = (size_t)(check->machine->space.size >> MEMORY_PAGE_SHIFT);
  if (!(check->threads = trax_explain_array(check->machine->stats.threads, sizeof *check->threads, error)) ||
      !(check->pages = trax_explain_array(check->page_count, sizeof *check->pages, error)) ||
      !(check->fresh = trax_explain_array(check->page_count, sizeof *check->fresh, error)))
    return TRAX_ERROR;
  for (uint64_t i = 0; i < check->machine->stats.threads; i++)
    check->threads[i].low = MEMORY_NO_FRAME;
  return trax_memory_objects_open(check, error) == TRAX_OK && trax_memory_calls_open(check, error) == TRAX_OK
             ? TRAX_OK
             : TRAX_ERROR;
}

static void close_check(void *self) {
  struct trax_memory_check *check = self;
  for (uint64_t i = 0; check->threads && i < check->machine->stats.threads; i++)
    free(check->threads[i].calls);
  free(check->threads);
  free(check->contexts);
  free(check->sites);
  trax_map_free(&check->functions);
  trax_map_free(&check->context_of);
  trax_map_free(&check->site_of);
  trax_memory_objects_close(check);
}

static bool is_wanted(const struct trax_explain_options *options) {
  return options->check_memory;
}

const struct trax_reader_kind trax_memory_check_reader = {.bytes = sizeof(struct trax_memory_check),
                                                          .is_wanted = is_wanted,
                                                          .open = open_check,
                                                          .span = add_span,
                                                          .arrival = add_arrival,
                                                          .end = end,
                                                          .close = close_check};
