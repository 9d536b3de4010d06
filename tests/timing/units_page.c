#define _GNU_SOURCE /* open_memstream */
/* The tables of docs/timing.md, "Units", as machine/units.h has them.

     timing-units-page              prints them
     timing-units-page FILE         ends with status 1 if those of FILE are others; --update behind it puts them there
 */
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
                        const char *latency, const char *interval) {
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
  fprintf(out, " | ");
  print_keys(out, interval);
  fprintf(out, " |\n");
}

static void print_classes(FILE *out) {
  bool told[TRAX_OP_COUNT] = {false};
#define CLASS(ID, UNIT, FLAG, ASKS, WORDS, LATENCY, INTERVAL, ...)                                                     \
  print_class(out, TRAX_UNIT_##UNIT, FLAG, told, WORDS, #LATENCY, #INTERVAL);
  TRAX_CLASSES(CLASS)
#undef CLASS
}

static void print_unit(FILE *out, const char *name, const char *words, const char *size, const char *count) {
  fprintf(out, "| %s | ", words);
  print_keys(out, count);
  fprintf(out, " | ");
  print_keys(out, size);
  fprintf(out, " | `%s_conflict` |\n", name);
}

static void print_units(FILE *out) {
  fprintf(out, "| unit | units of a group | TPs of a group | conflict |\n| --- | --- | --- | --- |\n");
#define UNIT(X, ID, NAME, SIZE, COUNT, AREA, WORDS, ...) print_unit(out, #NAME, WORDS, #SIZE, #COUNT);
  TRAX_SHARED_UNITS(UNIT, )
#undef UNIT
}

/* The tables, and the text of the page that each of them follows; a blank line is behind it. */
static const struct {
  void (*print)(FILE *out);
  const char *before;
} tables[] = {
    {print_classes, "| loads and stores of local memory | the TP's own | `tp.local_latency_cycles` | |\n"},
    {print_units, "The TPs of a group share units of each kind:\n\n"},
};
enum { TABLES = sizeof tables / sizeof *tables };

static void fail(const char *path, const char *what) {
  fprintf(stderr, "timing-units-page: %s: %s\n", path, what);
  exit(EXIT_FAILURE);
}

static char *print_table(unsigned i) {
  char *text = NULL;
  size_t size;
  FILE *out = open_memstream(&text, &size);
  if (!out)
    fail("a table", "out of memory");
  tables[i].print(out);
  fclose(out);
  return text;
}

static char *read_file(const char *path) {
  FILE *file = fopen(path, "rb");
  char *text = calloc(1, 1 << 20);
  if (!file || !text || !fread(text, 1, (1 << 20) - 1, file))
    fail(path, "cannot be read");
  fclose(file);
  return text;
}

/* Prints the page with the tables as they are to be. */
static void print_page(FILE *out, const char *path, const char *page) {
  for (unsigned i = 0; i < TABLES; i++) {
    const char *begin = strstr(page, tables[i].before);
    begin = begin ? begin + strlen(tables[i].before) : NULL;
    const char *end = begin ? strstr(begin, "\n\n") : NULL;
    if (!end)
      fail(path, "has lost a table");
    char *table = print_table(i);
    fprintf(out, "%.*s%s", (int)(begin - page), page, table);
    free(table);
    page = end + 1;
  }
  fputs(page, out);
}

int main(int count, char **arguments) {
  if (count < 2) {
    for (unsigned i = 0; i < TABLES; i++)
      tables[i].print(stdout);
    return EXIT_SUCCESS;
  }
  char *page = read_file(arguments[1]), *expected = NULL;
  size_t size;
  FILE *out = open_memstream(&expected, &size);
  if (!out)
    fail(arguments[1], "out of memory");
  print_page(out, arguments[1], page);
  fclose(out);
  if (count > 2 && strcmp(arguments[2], "--update") == 0) {
    FILE *file = fopen(arguments[1], "wb");
    if (!file || fputs(expected, file) < 0 || fclose(file))
      fail(arguments[1], "cannot be written");
  } else if (strcmp(page, expected) != 0) {
    fail(arguments[1], "its tables of units are not those of emulator/machine/units.h; --update puts them there");
  }
  free(page);
  free(expected);
  return EXIT_SUCCESS;
}
