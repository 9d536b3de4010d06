/* The report of a fault: its kind, its place in the program and the source, the thread, and the registers. */
#include <inttypes.h>
#include <string.h>

#include "machine/timing.h"
#include "program/program.h"
#include "report/backtrace.h"
#include "report/place.h"
#include "trax/isa.h"

const char *const trax_register_names[TRAX_NUM_REGISTERS] = {
#define NAME(NUMBERED, BY_ROLE, NUMBER) BY_ROLE,
    TRAX_REGISTERS(NAME)
#undef NAME
};
enum { RA = 1, SP = 2 };

/* "28 bytes behind the buffer image (100 bytes from 0x00012000)". False: there is no buffer as near as its guard. */
static bool print_nearest_buffer(const struct trax_loaded *loaded, const struct trax_fault *fault, FILE *out) {
  const struct trax_bound_buffer *nearest = NULL;
  uint64_t least = TRAX_BUFFER_GUARD + 1;
  const char *where = "";
  for (size_t i = 0; loaded && i < loaded->buffer_count; ++i) {
    const struct trax_bound_buffer *buffer = &loaded->buffers[i];
    const uint64_t begin = buffer->address, end = begin + buffer->bytes, at = fault->address;
    const uint64_t distance = at < begin ? begin - at : at > end ? at - end : 0;
    if (distance >= least)
      continue;
    least = distance;
    nearest = buffer;
    where = at < begin ? "before" : at > end ? "behind" : at == end ? "directly behind" : "across the end of";
  }
  if (!nearest)
    return false;
  fprintf(out, ", ");
  if (least)
    fprintf(out, "%" PRIu64 " byte%s ", least, least == 1 ? "" : "s");
  fprintf(out, "%s the buffer %s (%u bytes from 0x%08x)", where, nearest->symbol, nearest->bytes, nearest->address);
  return true;
}

/* Pointers to the data of buffers without contents are null. */
static void print_unbound_buffers(const trax_machine *machine, const struct trax_fault *fault, FILE *out) {
  enum { MOST = 4 };
  size_t from = 0, count = 0;
  if (fault->kind != TRAX_FAULT_NULL_PAGE && fault->kind != TRAX_FAULT_READ_ONLY)
    return;
  for (const char *name; count < MOST && (name = trax_loaded_unbound(machine, &from)); ++count)
    fprintf(out, "  %-*snothing is bound to %s: --alloc %s=BYTES or --bind %s=FILE\n", TRAX_LABEL, "buffer", name, name,
            name);
}

/* "store of 4 bytes to 0x00001010 (table+0x10)" */
static void print_access(const trax_machine *machine, const struct trax_fault *fault, FILE *out) {
  if (!fault->bytes)
    return;
  fprintf(out, "  %-*s%s of %u byte%s %s 0x%08x", TRAX_LABEL, "access", fault->write ? "store" : "load", fault->bytes,
          fault->bytes == 1 ? "" : "s", fault->write ? "to" : "from", fault->address);
  const struct trax_loaded *loaded = trax_loaded_of(machine);
  const struct trax_symbol *symbol = loaded ? trax_image_symbol_at(loaded->image, fault->address) : NULL;
  if (symbol) {
    fprintf(out, " (");
    trax_print_symbol(symbol, fault->address, out);
    fprintf(out, ")");
  }
  if (fault->kind == TRAX_FAULT_UNMAPPED && !print_nearest_buffer(loaded, fault, out))
    fprintf(out, "; memory ends at 0x%08" PRIx64, machine->space.size);
  const uint32_t stack = loaded ? loaded->stack_bytes : 0;
  const uint64_t top = machine->space.size - fault->thread * ((uint64_t)stack + TRAX_STACK_GUARD);
  if (fault->kind == TRAX_FAULT_STACK_OVERFLOW && stack)
    fprintf(out,
            "; the thread's stack is 0x%08" PRIx64 " to 0x%08" PRIx64
            ", %u bytes, sp is 0x%08x; -mstack-size= makes it larger",
            top - stack, top - 1, stack, fault->registers[SP]);
  else if (fault->kind == TRAX_FAULT_STACK_OVERFLOW)
    fprintf(out, "; local memory is 0x%08x to 0xffffffff, %u bytes, sp is 0x%08x; -mstack=global has more room",
            TRAX_LOCAL_BASE, TRAX_LOCAL_SIZE, fault->registers[SP]);
  fprintf(out, "\n");
  print_unbound_buffers(machine, fault, out);
}

/* Prints the message of an abort. Characters that cannot be printed are shown as codes. */
static void print_message(const trax_machine *machine, const struct trax_fault *fault, FILE *out) {
  char text[1024];
  if (fault->kind != TRAX_FAULT_ABORT || fault->address == 0)
    return;
  if (!trax_space_string(&machine->space, fault->address, text, sizeof text)) {
    fprintf(out, "  %-*s(no string at 0x%08x)\n", TRAX_LABEL, "message", fault->address);
    return;
  }
  fprintf(out, "  %-*s", TRAX_LABEL, "message");
  for (const unsigned char *c = (const unsigned char *)text; *c; ++c)
    if (*c >= 0x20 && *c != 0x7F)
      fputc(*c, out);
    else if (c[1]) /* a newline at the end is dropped */
      fprintf(out, "\\x%02x", *c);
  fprintf(out, "\n");
}

static void print_instruction(const trax_machine *machine, const struct trax_fault *fault, FILE *out) {
  fprintf(out, "  %-*s0x%08x", TRAX_LABEL, "at", fault->pc);
  if (fault->kind == TRAX_FAULT_EXECUTE || fault->kind == TRAX_FAULT_MISALIGNED_PC) {
    fprintf(out, "\n");
    return;
  }
  fprintf(out, "  ");
  trax_print_instruction(fault->word, fault->pc, out);
  if (fault->kind == TRAX_FAULT_ILLEGAL && trax_lacks_unit(trax_decode(fault->word).op, &machine->config))
    fprintf(out, " (this machine has no %s)",
            trax_shared_words(trax_timing_of(trax_decode(fault->word).op, &machine->config).unit));
  fprintf(out, "\n");
}

/* Prints the return address if there is no frame information. ra is valid directly after a jump to an address that is
   no text; otherwise the function may have called another one since. Returns 1, with the caller's frame in *frame, if
   it is valid; else 0. */
static size_t print_return_address(const struct trax_loaded *loaded, const struct trax_fault *fault,
                                   struct trax_frame *frame, FILE *out) {
  const bool is_fresh = fault->kind == TRAX_FAULT_EXECUTE || fault->kind == TRAX_FAULT_MISALIGNED_PC;
  frame->pc = fault->registers[RA];
  frame->is_caller = true;
  if (frame->pc >= TRAX_NULL_END + 4)
    trax_print_place(loaded, is_fresh ? "called by" : "ra behind", trax_frame_place(frame), out);
  return is_fresh;
}

static void print_callers(const trax_machine *machine, const struct trax_fault *fault, FILE *out) {
  enum { DEPTH = 4096, INNERMOST = 24, OUTERMOST = 4 };
  const struct trax_loaded *loaded = trax_loaded_of(machine);
  const struct trax_thread_memory memory = {&machine->space, fault->local};
  struct trax_frame frame = {.pc = fault->pc};
  enum trax_unwound last;
  uint32_t places[DEPTH];
  if (!loaded)
    return;
  memcpy(frame.registers, fault->registers, sizeof frame.registers);
  size_t count = trax_callers(loaded->image, &frame, &memory, places, DEPTH, &last);
  if (count == 0 && last == TRAX_NO_FRAME_INFO && print_return_address(loaded, fault, &frame, out))
    count = trax_callers(loaded->image, &frame, &memory, places, DEPTH, &last);
  for (size_t i = 0; i < count; ++i) {
    trax_print_place(loaded, "called by", places[i], out);
    if (i + 1 == INNERMOST && count > INNERMOST + OUTERMOST + 1) {
      fprintf(out, "  %-*s%zu frames\n", TRAX_LABEL, "...", count - INNERMOST - OUTERMOST);
      i = count - OUTERMOST - 1;
    }
  }
}

/* Advice for the kinds of faults whose reports have none in other lines. */
static void print_advice(const trax_machine *machine, const struct trax_fault *fault, FILE *out) {
  static const char debugger[] =
      "--gdb 0 and a breakpoint before it show where the value comes from (docs/debugging.md)";
  static const char *const advice[TRAX_FAULT_COUNT] = {
      [TRAX_FAULT_NULL_PAGE] = debugger,
      [TRAX_FAULT_UNMAPPED] = debugger,
      [TRAX_FAULT_MISALIGNED] = "memcpy, or a structure with __attribute__((packed)), for data at any address",
      [TRAX_FAULT_READ_ONLY] = "copy what is constant before it is changed",
      [TRAX_FAULT_NOT_GLOBAL] = "count in a global variable, or compile with -mstack=global",
      [TRAX_FAULT_EXECUTE] = debugger,
      [TRAX_FAULT_MISALIGNED_PC] = debugger};
  size_t from = 0;
  if (fault->kind == TRAX_FAULT_ILLEGAL && trax_lacks_unit(trax_decode(fault->word).op, &machine->config))
    fprintf(out, "  %-*sa machine that has the unit: --help-config lists its keys\n", TRAX_LABEL, "try");
  else if (advice[fault->kind] && !(advice[fault->kind] == debugger && trax_loaded_unbound(machine, &from)))
    fprintf(out, "  %-*s%s\n", TRAX_LABEL, "try", advice[fault->kind]);
}

void trax_machine_print_fault(const trax_machine *machine, FILE *out) {
  const struct trax_fault *fault = trax_machine_fault(machine);
  if (fault->kind == TRAX_FAULT_NONE)
    return;
  const struct trax_loaded *loaded = trax_loaded_of(machine);
  fprintf(out, "fault: %s\n", trax_fault_text(fault->kind));
  print_message(machine, fault, out);
  print_access(machine, fault, out);
  print_instruction(machine, fault, out);
  trax_print_place(loaded, "in", fault->pc, out);
  print_callers(machine, fault, out);
  print_advice(machine, fault, out);
  fprintf(out, "  %-*s%u (TM %u, TP %u), cycle %" PRIu64 "\n", TRAX_LABEL, "thread", fault->thread, fault->tm,
          fault->tp, fault->cycle);
  for (unsigned i = 0; i < TRAX_NUM_REGISTERS; ++i) {
    fprintf(out, "%sr%-2u %-4s %08x%s", i % 4 ? "   " : "  ", i, trax_register_names[i], fault->registers[i],
            i % 4 == 3 ? "\n" : "");
  }
}
