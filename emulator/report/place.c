#include "report/place.h"

#include "program/program.h"
#include "trax/isa.h"

enum { INLINE_DEPTH = 16 };

void trax_print_symbol(const struct trax_symbol *symbol, uint32_t address, FILE *out) {
  fprintf(out, "%s", symbol->name);
  if (address != symbol->address)
    fprintf(out, "+0x%x", address - symbol->address);
}

static void print_line(const struct trax_source_line *line, FILE *out) {
  fprintf(out, "%s:%d", line->file, line->line);
  if (line->column)
    fprintf(out, ":%d", line->column);
}

void trax_print_instruction(uint32_t word, uint32_t pc, FILE *out) {
  char text[128];
  trax_disassemble(word, pc, text, sizeof text);
  for (char *c = text; *c; ++c)
    if (*c == '\t')
      *c = ' ';
  fprintf(out, "%08x  %s", word, text);
}

void trax_print_place(const struct trax_loaded *loaded, const char *label, uint32_t pc, FILE *out) {
  if (!loaded)
    return;
  const struct trax_symbol *symbol = trax_image_symbol_at(loaded->image, pc);
  struct trax_source_line lines[INLINE_DEPTH];
  size_t count = trax_image_lines(loaded->image, pc, lines, INLINE_DEPTH);
  if (!symbol && !count)
    return;
  fprintf(out, "  %-*s", TRAX_LABEL, label);
  if (symbol)
    trax_print_symbol(symbol, pc, out);
  for (size_t i = 0; i < count; ++i) {
    if (i)
      fprintf(out, "\n  %-*sinlined into %s", TRAX_LABEL, "", lines[i].function ? lines[i].function : "its caller");
    else if (count > 1 && lines[0].function)
      fprintf(out, ", %s", lines[0].function);
    fprintf(out, " at ");
    print_line(&lines[i], out);
  }
  fprintf(out, "\n");
}
