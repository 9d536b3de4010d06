#define _GNU_SOURCE /* open_memstream */
/* The tables of docs/timing.md, "Units", as machine/units.h has them.

     timing-units-page              prints them
     timing-units-page FILE         ends with status 1 if FILE does not contain them */
#include "machine/units.h"
#include "trax/isa.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* An expression over C in the page's words: C->a.b is the key `a.b`, and trax_or(x, y) is x, with y if that is 0. */
static void print_keys(FILE *out, const char *text) {
  while (*text) {
    const size_t key = strncmp(text, "C->", 3) == 0 ? strspn(text + 3, "abcdefghijklmnopqrstuvwxyz0123456789_.") : 0;
    if (key) {
      fprintf(out, "`%.*s`", (int)key, text + 3);
      text += 3 + key;
    } else if (strncmp(text, "trax_or(", 8) == 0) {
      text += 8;
    } else if (strncmp(text, ", ", 2) == 0) {
      fprintf(out, " (0: ");
      text += 2;
    } else {
      fputc(*text++, out);
    }
  }
}

static void print_class(FILE *out, unsigned unit, unsigned flag, bool *told, const char *executes_on,
                        const char *latency) {
  const char *before = "| ";
  for (unsigned op = TRAX_OP_ILLEGAL + 1; op < TRAX_OP_COUNT; op++) {
    if (told[op] || trax_op_table[op].unit != unit || (flag && !(trax_op_table[op].flags & flag)))
      continue;
    told[op] = true;
    fprintf(out, "%s%s", before, trax_op_table[op].mnemonic);
    before = ", ";
  }
  fprintf(out, " | %s | ", executes_on);
  print_keys(out, latency);
  fprintf(out, " |\n");
}

static void print_classes(FILE *out) {
  bool told[TRAX_OP_COUNT] = {false};
#define CLASS(ID, UNIT, FLAG, ASKS, WORDS, LATENCY, ...)                                                               \
  print_class(out, TRAX_UNIT_##UNIT, FLAG, told, WORDS, #LATENCY);
  TRAX_CLASSES(CLASS)
#undef CLASS
}

static void print_unit(FILE *out, const char *name, const char *words, const char *size, const char *count,
                       const char *pipelined) {
  fprintf(out, "| %s | ", words);
  print_keys(out, count);
  fprintf(out, " | ");
  print_keys(out, size);
  fprintf(out, " | ");
  print_keys(out, strcmp(pipelined, "true") == 0 ? "always" : pipelined);
  fprintf(out, " | `%s_conflict` |\n", name);
}

static void print_units(FILE *out) {
  fprintf(out,
          "| unit | units of a group | TPs of a group | pipelined | conflict |\n| --- | --- | --- | --- | --- |\n");
#define UNIT(X, ID, NAME, SIZE, COUNT, PIPELINED, AREA, WORDS, ...)                                                    \
  print_unit(out, #NAME, WORDS, #SIZE, #COUNT, #PIPELINED);
  TRAX_SHARED_UNITS(UNIT, )
#undef UNIT
}

static void (*const tables[])(FILE *out) = {print_classes, print_units};
enum { TABLES = sizeof tables / sizeof *tables };

static char *read_file(const char *path) {
  FILE *file = fopen(path, "rb");
  char *text = calloc(1, 1 << 20);
  if (!file || !text || !fread(text, 1, (1 << 20) - 1, file)) {
    fprintf(stderr, "timing-units-page: cannot read %s\n", path);
    exit(EXIT_FAILURE);
  }
  fclose(file);
  return text;
}

int main(int count, char **arguments) {
  int status = EXIT_SUCCESS;
  char *page = count > 1 ? read_file(arguments[1]) : NULL;
  for (unsigned i = 0; i < TABLES; i++) {
    char *text = NULL;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    if (!out)
      return EXIT_FAILURE;
    tables[i](out);
    fclose(out);
    if (!page) {
      printf("%s\n", text);
    } else if (!strstr(page, text)) {
      fprintf(stderr, "%s has not got:\n%s", arguments[1], text);
      status = EXIT_FAILURE;
    }
    free(text);
  }
  free(page);
  return status;
}
