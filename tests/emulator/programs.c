#include "programs.h"

#include <string.h>

enum { ZERO, RA, A0 = 4, A1, A2, A3, A4, A5, T0 = 12, T1, T2 };

#define COUNT(ARRAY) (sizeof(ARRAY) / sizeof *(ARRAY))
#define J(RD, OFFSET) trax_encode((trax_inst){TRAX_OP_JAL, RD, 0, 0, OFFSET})
#define R1(OP, RD, RA) trax_encode((trax_inst){TRAX_OP_##OP, RD, RA, 0, 0})
#define FUNCTION(NAME, WORDS) {NAME, TEXT, (uint32_t)(WORDS) * 4, STT_FUNC, STB_GLOBAL}
#define OBJECT(NAME, ADDRESS, BYTES) {NAME, ADDRESS, BYTES, STT_OBJECT, STB_GLOBAL}

static struct elf_file simple(const uint32_t *text, size_t words, const char *data, size_t data_bytes, bool debug) {
  const struct elf_symbol symbols[] = {FUNCTION("outer", words), OBJECT("text", DATA, (uint32_t)data_bytes)};
  return elf_write(&(struct elf_program){.text = text,
                                         .words = words,
                                         .data = data,
                                         .data_bytes = data_bytes,
                                         .zero_bytes = 64,
                                         .symbols = symbols,
                                         .symbol_count = COUNT(symbols),
                                         .debug = debug});
}

static struct elf_file hello(void) {
  const uint32_t text[] = {U(LUI, A0, 1), T(A0, TRAX_TRAP_PUTS), T(ZERO, TRAX_TRAP_EXIT)};
  return simple(text, COUNT(text), "hello\n", 7, false);
}

static struct elf_file exit3(void) {
  const uint32_t text[] = {I(ADDI, A0, ZERO, 3), T(A0, TRAX_TRAP_EXIT)};
  return simple(text, COUNT(text), "", 1, false);
}

static struct elf_file null(void) {
  const uint32_t text[] = {I(ADDI, A1, ZERO, 8), I(ADDI, RA, ZERO, 0), I(LW, A0, A1, 0), HALT};
  return simple(text, COUNT(text), "abc", 4, true);
}

static struct elf_file abort_program(void) {
  const uint32_t text[] = {U(LUI, A0, 1), T(A0, TRAX_TRAP_ABORT), HALT, HALT};
  return simple(text, COUNT(text), "out of luck\n", 13, true);
}

static struct elf_file spin(void) {
  const uint32_t text[] = {I(ADDI, A0, ZERO, 1), T(A0, TRAX_TRAP_ITEMS), J(ZERO, -4)};
  return simple(text, COUNT(text), "", 1, false);
}

static struct elf_file idle(void) {
  const uint32_t text[] = {I(ADDI, A0, A0, 1), J(ZERO, -4)};
  return simple(text, COUNT(text), "", 1, false);
}

static struct elf_file print(void) {
  const uint32_t text[] = {I(ADDI, A0, ZERO, '.'), T(A0, TRAX_TRAP_PUTC), J(ZERO, -4)};
  return simple(text, COUNT(text), "", 1, false);
}

static struct elf_file items(void) {
  const uint32_t text[] = {I(ADDI, A0, ZERO, 1), I(ADDI, A1, ZERO, 1000), T(A0, TRAX_TRAP_ITEMS),
                           I(ADDI, A1, A1, -1),  B(BNE, A1, ZERO, -8),    HALT};
  return simple(text, COUNT(text), "", 1, false);
}

static struct elf_file copy(void) {
  const uint32_t text[] = {U(LUI, A0, 1),      I(LW, A1, A0, 0),    I(LW, A2, A0, 4), I(LW, A3, A0, 8),
                           R(ADD, A2, A1, A2), B(BGEU, A1, A2, 24), I(LW, A4, A1, 0), S(SW, A4, A3, 0),
                           I(ADDI, A1, A1, 4), I(ADDI, A3, A3, 4),  J(ZERO, -20),     HALT};
  const struct elf_symbol symbols[] = {
      {"input", DATA, 4, STT_OBJECT, STB_LOCAL}, /* another file's; the global one is meant */
      FUNCTION("_start", COUNT(text)),
      {"label", TEXT + 8, 0, STT_NOTYPE, STB_LOCAL},
      OBJECT("input", COPY_INPUT, 8),
      OBJECT("output", COPY_OUTPUT, 8),
      OBJECT("__trax_heap", COPY_HEAP, 4),
      OBJECT("__trax_heap_end", COPY_HEAP_END, 4),
      OBJECT("last", DATA + 120, 4)};
  const char data[24] = {0};
  return elf_write(&(struct elf_program){.text = text,
                                         .words = COUNT(text),
                                         .data = data,
                                         .data_bytes = sizeof data,
                                         .zero_bytes = 100, /* the segment ends at DATA + 124 */
                                         .symbols = symbols,
                                         .symbol_count = COUNT(symbols)});
}

static struct elf_file lines(void) {
#define LOAD(LINE) I(LW, A1, A0, 64 * (LINE)), R(ADD, A1, A1, A1)
  enum { A, B, C, D, E };
  const uint32_t text[] = {U(LUI, A0, 1), LOAD(A), LOAD(B), LOAD(C), LOAD(D), LOAD(B),
                           LOAD(A),       LOAD(E), LOAD(C), LOAD(D), HALT};
#undef LOAD
  const char data[5 * 64] = {0};
  return simple(text, COUNT(text), data, sizeof data, false);
}

static struct elf_file mix(void) {
  const uint32_t text[] = {U(LUI, A0, 1), I(ADDI, A1, ZERO, 50), I(ADDI, A2, ZERO, 1), U(LUI, A3, 0x3F80), /* 1.0f */
                           /* the loop */
                           I(AINC, T0, A0, 0), I(LW, T1, A0, 64), R(FADD, T0, T1, A3), R(FSUB, T1, T0, A3),
                           R(FMUL, T1, T0, A3), R(FDIV, T2, T0, A3), R1(FRSQRT, T0, A3), R(FMIN, T0, T0, A3),
                           R(MUL, T1, T1, A1), S(SW, T1, ZERO, -4), I(LW, T1, ZERO, -4), S(SW, T1, A0, 128),
                           S(SWNT, T1, A0, 132), I(LWNT, T1, A0, 136), T(A2, TRAX_TRAP_RAYS), I(ADDI, A1, A1, -1),
                           B(BNE, A1, ZERO, -64), T(ZERO, TRAX_TRAP_EXIT)};
  char data[256] = {0};
  return simple(text, COUNT(text), data, sizeof data, false);
}

/* More instructions than the fast engine knows lines of, forty times. */
static struct elf_file long_program(void) {
  enum { LENGTH = 1500 };
  uint32_t text[LENGTH + 5];
  size_t n = 0;
  text[n++] = I(ADDI, A1, ZERO, 40);
  while (n < LENGTH + 1)
    text[n++] = I(ADDI, T0, T0, 1);
  text[n++] = I(ADDI, A1, A1, -1);
  text[n++] = B(BEQ, A1, ZERO, 8);
  text[n++] = J(ZERO, -4 * (LENGTH + 2));
  text[n++] = T(ZERO, TRAX_TRAP_EXIT);
  return simple(text, COUNT(text), "", 1, false);
}

static struct elf_file signature(void) {
  const uint32_t text[] = {U(LUI, A0, 1),
                           I(ADDI, A1, ZERO, 42),
                           U(LUI, A2, 0xFEDD),
                           I(ADDI, A2, A2, -0x4568),
                           S(SW, A1, A0, 8),
                           S(SW, A2, A0, 4),
                           I(LW, A3, ZERO, 4),
                           S(SW, ZERO, A0, 4),
                           HALT};
  const struct elf_symbol symbols[] = {FUNCTION("_start", COUNT(text)),
                                       {"begin_signature", DATA + 4, 0, STT_NOTYPE, STB_GLOBAL},
                                       {"end_signature", DATA + 12, 0, STT_NOTYPE, STB_GLOBAL}};
  const char data[16] = {0};
  return elf_write(&(struct elf_program){.text = text,
                                         .words = COUNT(text),
                                         .data = data,
                                         .data_bytes = sizeof data,
                                         .symbols = symbols,
                                         .symbol_count = COUNT(symbols)});
}

static const struct {
  const char *name;
  struct elf_file (*make)(void);
} programs[] = {{"hello", hello},      {"exit3", exit3}, {"null", null}, {"abort", abort_program},
                {"spin", spin},        {"items", items}, {"copy", copy}, {"mix", mix},
                {"lines", lines},      {"print", print}, {"idle", idle}, {"signature", signature},
                {"long", long_program}};

const char *const program_names[] = {"hello", "exit3", "null",  "abort", "spin",      "items", "copy",
                                     "mix",   "lines", "print", "idle",  "signature", "long",  NULL};

struct elf_file program_file(const char *name) {
  for (size_t i = 0; i < COUNT(programs); ++i)
    if (strcmp(programs[i].name, name) == 0)
      return programs[i].make();
  return (struct elf_file){0};
}
