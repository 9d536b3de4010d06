/* Calls and frames. A function's frame is the bytes below the stack pointer at its entry, as many as the compiler has
   stated, and what alloca takes below them. It is undefined at the entry. */
#include "explain/memory_check.h"
#include "trax/grow.h"

#include <stdlib.h>
#include <string.h>

enum { SP = 2, MAX_DEPTH = 4096, MOST_CONTEXTS = 1 << 20 };

struct trax_memory_event trax_memory_event_of(const struct trax_memory_check *check, const struct trax_span *span) {
  return (struct trax_memory_event){.cycle = span->issue->cycle,
                                    .thread = span->thread,
                                    .pc = span->pc,
                                    .context = check->threads[span->thread].context};
}

/* A stack in local memory begins at 0 and grows down, so 0 is above all other addresses. */
static bool is_below(uint32_t stack_pointer, uint32_t other) {
  return stack_pointer - 1 < other - 1;
}

/* The bytes of the frame below `high` become undefined. */
static void open_frame(struct trax_memory_check *check, uint32_t thread, uint32_t low, uint32_t high) {
  uint32_t begin, end;
  trax_memory_stack_of(check, thread, &begin, &end);
  if (is_below(high, begin) || is_below(end, high) || !is_below(low, high))
    return;
  low = is_below(low, begin) ? begin : low;
  trax_memory_define(check, thread, low, high - low, true);
}

static void enter(struct trax_memory_check *check, const struct trax_span *span,
                  const struct trax_memory_event *event) {
  struct trax_memory_thread *thread = &check->threads[span->thread];
  const struct trax_memory_frame *frame =
      (const struct trax_memory_frame *)trax_map_find(&check->functions, sizeof *frame, span->issue->next_pc);
  const uint32_t stack_pointer = thread->reg[SP].bits;
  const int32_t bytes = frame ? frame->bytes : -1;
  thread->low = bytes < 0 ? MEMORY_NO_FRAME : stack_pointer - (uint32_t)bytes;
  if (bytes > 0)
    open_frame(check, span->thread, thread->low, stack_pointer);
  if (frame && frame->function && !thread->function)
    trax_memory_heap_enter(check, span->thread, frame->function, event);
}

/* Returns the call chain of a call. A recursive program may have as many as calls: beyond a number, a new one is left
   out. */
static uint32_t context_of(struct trax_memory_check *check, uint32_t parent, uint32_t pc) {
  const uint64_t key = (uint64_t)parent << 32 | pc;
  if (check->context_count >= MOST_CONTEXTS && !trax_map_find(&check->context_of, sizeof(struct trax_map_entry), key))
    return parent;
  struct trax_map_entry *entry = trax_map_put(&check->context_of, sizeof *entry, key, (uint32_t)check->context_count);
  if (!entry ||
      !trax_grow((void **)&check->contexts, check->context_count, &check->context_capacity, sizeof *check->contexts)) {
    check->reader.explain->out_of_memory = true;
    return 0;
  }
  if (entry->value == check->context_count)
    check->contexts[check->context_count++] = (struct trax_memory_context){parent, pc};
  return entry->value;
}

void trax_memory_call(struct trax_memory_check *check, const struct trax_span *span) {
  struct trax_memory_thread *thread = &check->threads[span->thread];
  const struct trax_memory_event event = trax_memory_event_of(check, span);
  if (thread->depth < MAX_DEPTH &&
      trax_grow((void **)&thread->calls, thread->depth, &thread->capacity, sizeof *thread->calls)) {
    thread->calls[thread->depth++] =
        (struct trax_memory_call){span->pc + 4, thread->reg[SP].bits, thread->context, thread->low};
    thread->context = context_of(check, thread->context, span->pc);
  }
  enter(check, span, &event);
}

static void leave(struct trax_memory_thread *thread) {
  thread->depth--;
  thread->context = thread->calls[thread->depth].context;
  thread->low = thread->calls[thread->depth].low;
}

/* Whether a jump leads into the midst of another function, as that of longjmp does. */
static bool leads_into_function(const struct trax_memory_check *check, const struct trax_span *span) {
  struct trax_places *places = check->reader.explain->places;
  const struct trax_place *from = trax_places_at(places, span->index),
                          *to = trax_places_at(places, trax_places_index(places, span->issue->next_pc));
  return to->symbol && to->offset && to->symbol != from->symbol;
}

void trax_memory_jump(struct trax_memory_check *check, const struct trax_span *span) {
  struct trax_memory_thread *thread = &check->threads[span->thread];
  const uint32_t next = span->issue->next_pc, stack_pointer = thread->reg[SP].bits;
  if (span->inst.op == TRAX_OP_JALR) {
    while (thread->depth && is_below(thread->calls[thread->depth - 1].stack_pointer, stack_pointer))
      leave(thread);
    if (thread->depth && thread->calls[thread->depth - 1].stack_pointer == stack_pointer &&
        (thread->calls[thread->depth - 1].return_pc == next || leads_into_function(check, span)))
      leave(thread);
    if (thread->function && thread->return_pc == next && thread->stack_pointer == stack_pointer)
      trax_memory_heap_leave(check, span->thread);
  }
  const struct trax_place *place = trax_places_at(check->reader.explain->places, span->index);
  const bool is_loop = place->symbol && span->pc - place->offset == next; /* to the function's own beginning */
  if (!is_loop && trax_map_find(&check->functions, sizeof(struct trax_memory_frame), next)) { /* a tail call */
    const struct trax_memory_event event = trax_memory_event_of(check, span);
    enter(check, span, &event);
  }
}

/* A copy to the stack pointer that lowers it is alloca's, or of an array of variable length: the register that is
   copied then points to memory of its own. */
void trax_memory_move_stack(struct trax_memory_check *check, const struct trax_span *span, uint32_t before) {
  struct trax_memory_thread *it = &check->threads[span->thread];
  const uint32_t now = it->reg[SP].bits;
  if (span->inst.op == TRAX_OP_ADDI && !span->inst.imm && is_below(now, before)) {
    open_frame(check, span->thread, now, before);
    it->reg[span->inst.ra].tag = trax_memory_object_add(check, &(struct trax_memory_object){.kind = MEMORY_LOCAL,
                                                                                            .begin = now,
                                                                                            .end = before,
                                                                                            .name = "memory of alloca",
                                                                                            .own_begin = now,
                                                                                            .own_end = before});
  } else if (it->low != MEMORY_NO_FRAME && is_below(now, it->low)) {
    open_frame(check, span->thread, now, it->low);
  }
  if (it->low != MEMORY_NO_FRAME && is_below(now, it->low))
    it->low = now;
}

static void add_frame(void *context, uint32_t function, uint32_t bytes) {
  struct trax_memory_check *check = context;
  struct trax_memory_frame *frame =
      (struct trax_memory_frame *)trax_map_put(&check->functions, sizeof *frame, function, 0);
  if (!frame)
    check->reader.explain->out_of_memory = true;
  else if (frame->bytes < (int32_t)bytes)
    frame->bytes = (int32_t)bytes;
}

/* The frame of the function in which a thread begins: nobody calls it. */
static void begin_thread(struct trax_memory_check *check, uint32_t thread) {
  const struct trax_memory_frame *frame = (const struct trax_memory_frame *)trax_map_find(
      &check->functions, sizeof *frame, trax_machine_entry_of(check->machine, thread));
  uint32_t begin, end;
  trax_memory_stack_of(check, thread, &begin, &end);
  if (frame && frame->bytes >= 0)
    check->threads[thread].low = end - (uint32_t)frame->bytes;
}

trax_status trax_memory_calls_open(struct trax_memory_check *check, trax_error *error) {
  static const char *const names[] = {"malloc", "calloc", "realloc", "aligned_alloc", "free", "malloc_usable_size"};
  size_t count;
  context_of(check, 0, 0); /* that of the program's start */
  if (!check->loaded)
    return TRAX_OK;
  const struct trax_symbol *symbols = trax_image_symbols(check->loaded->image, &count);
  trax_image_frames(check->loaded->image, add_frame, check);
  for (size_t i = 0; i < count; i++)
    if (symbols[i].type == TRAX_SYMBOL_FUNCTION) {
      const size_t before = check->functions.count;
      struct trax_memory_frame *frame =
          (struct trax_memory_frame *)trax_map_put(&check->functions, sizeof *frame, symbols[i].address, 0);
      if (!frame)
        return trax_fail(error, "out of memory for the check of memory");
      if (check->functions.count > before)
        frame->bytes = -1;
      for (unsigned name = 0; name < sizeof names / sizeof *names; name++)
        if (strcmp(symbols[i].name, names[name]) == 0)
          frame->function = MEMORY_MALLOC + name;
    }
  for (uint32_t i = 0; i < check->machine->stats.threads; i++)
    begin_thread(check, i);
  return TRAX_OK;
}
