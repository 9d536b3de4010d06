/* Searches the binary64 functions for their greatest errors.

     math64-worst                                  a quick look: 100,000 operands of each function
     math64-worst --count 30000000                 more; worst.py keeps the results
     math64-worst --count 30000000 --seed 2 sinh   one function, other operands
     math64-worst --start found.csv                starts from the operands in a file of earlier output

   Half of the operands are new (operands.c), half are neighbours of the worst ones so far. The worst are kept by cells,
   so that a hill elsewhere is still climbed. The host's long double finds candidates; MPFR confirms each. Prints lines
   of comma-separated values: function, operands, share not correctly rounded of the new ones, and the worst operands of
   several cells with their errors. The same seed and count give the same lines. */
#include "worst.h"

#include "../operands.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
  CELLS = 1 << 16,
  HILLS = 128,     /* cells whose neighbourhood is searched */
  ELITE = 32,      /* operands likewise */
  REPORTED = 6,    /* worst operands of so many cells are printed */
  RANKING = 65536, /* operands between two choices of hills */
  CONTROL = 65536, /* one of so many operands is given to MPFR in any case */
};

struct cell {
  struct operand operand;
  double error;
};
static struct cell cells[CELLS];
static struct cell elite[ELITE]; /* the worst ones, wherever they are */
static size_t elite_count;
static struct cell *hills[HILLS];
static size_t hill_count;

/* 16 cells a binade for one argument. For two, the exponents' difference and the leading digits matter most. */
static struct cell *cell_of(const struct function *f, struct operand o) {
  uint64_t x = bits_of(o.x), key = x >> 48;
  if (f->ours_2)
    key = ((x >> 52) - (bits_of(o.y) >> 52)) << 12 | (x >> 61) << 10 | (bits_of(o.y) >> 50 & 3) << 2 | (x >> 50 & 3);
  return &cells[(key * 0x9E3779B97F4A7C15u) >> 48];
}

static int by_error(const void *a, const void *b) {
  const struct cell *p = *(struct cell *const *)a, *q = *(struct cell *const *)b;
  return p->error != q->error ? (p->error < q->error) - (p->error > q->error) : (p > q) - (p < q);
}

static void rank(void) {
  static struct cell *all[CELLS];
  size_t count = 0;
  for (size_t i = 0; i < CELLS; i++)
    if (cells[i].error > 0)
      all[count++] = &cells[i];
  qsort(all, count, sizeof all[0], by_error);
  hill_count = count < HILLS ? count : HILLS;
  memcpy(hills, all, hill_count * sizeof all[0]);
}

static bool failed;

static void keep(const struct function *f, struct operand o, double error) {
  struct cell *cell = cell_of(f, o);
  if (error > cell->error)
    *cell = (struct cell){o, error};
  if (error == 0 || (elite_count == ELITE && error <= elite[ELITE - 1].error))
    return;
  size_t i = elite_count < ELITE ? elite_count++ : ELITE - 1;
  for (; i > 0 && elite[i - 1].error < error; i--)
    elite[i] = elite[i - 1];
  elite[i] = (struct cell){o, error};
}

/* Near an operand found before: the first of two random choices is the worse one. */
static struct operand climb(const struct function *f, uint64_t *state) {
  bool from_elite = random64(state) & 1;
  size_t count = from_elite ? elite_count : hill_count;
  size_t a = random64(state) % count, b = random64(state) % count, i = a < b ? a : b;
  return neighbour(f, from_elite ? elite[i].operand : hills[i]->operand, state);
}

static void search(const struct function *f, uint64_t seed, uint64_t count, const char *start) {
  uint64_t state = seed, fresh = 0, wrong = 0;
  double worst = 0;
  memset(cells, 0, sizeof cells);
  hill_count = elite_count = 0;
  struct found found;
  if (start && read_found(start, f->name, &found))
    for (size_t i = 0; i < found.count; i++)
      keep(f, found.operand[i], exact_error(f, found.operand[i]));
  for (uint64_t i = 0; i < count; i++) {
    if (i >= count / 16 && i % RANKING == 0)
      rank();
    bool climbing = hill_count > 0 && i & 1;
    struct operand o = climbing ? climb(f, &state) : new_operand(f, &state);
    double error = error_of(f, o, worst, i % CONTROL == 0, &failed);
    if (!climbing) {
      fresh++;
      wrong += error > 0.5;
    }
    keep(f, o, error);
    if (error > worst)
      worst = error;
  }
  rank();
  printf("%s,%llu,%llu,%.2g", f->name, (unsigned long long)seed, (unsigned long long)count,
         100 * (double)wrong / (double)fresh);
  for (size_t i = 0; i < hill_count && i < REPORTED; i++) {
    struct operand o = hills[i]->operand;
    printf(",%.4f %016llX", exact_error(f, o), (unsigned long long)bits_of(o.x));
    if (f->ours_2)
      printf(" %016llX", (unsigned long long)bits_of(o.y));
  }
  putchar('\n');
  fflush(stdout);
}

static uint64_t number(const char *text) {
  char *end;
  unsigned long long value = strtoull(text ? text : "", &end, 0);
  if (!text || *end || value == 0) {
    fprintf(stderr, "math64-worst: '%s' is not a number above 0\n", text ? text : "");
    exit(1);
  }
  return value;
}

static bool is_named(const struct function *f, char **names) {
  bool any = false;
  for (; *names; names++) {
    if (!strcmp(*names, f->name))
      return true;
    any = true;
  }
  return !any;
}

static bool is_known(const char *name) {
  for (size_t k = 0; k < function_count; k++)
    if (!strcmp(name, functions[k].name))
      return true;
  return false;
}

int main(int argc, char **argv) {
  uint64_t count = 100000, seed = 1;
  const char *start = NULL;
  int i = 1;
  for (; i < argc && !strncmp(argv[i], "--", 2); i += 2) {
    if (!strcmp(argv[i], "--count"))
      count = number(argv[i + 1]);
    else if (!strcmp(argv[i], "--seed"))
      seed = number(argv[i + 1]);
    else if (!strcmp(argv[i], "--start") && argv[i + 1])
      start = argv[i + 1];
    else {
      fprintf(stderr, "usage: math64-worst [--count N] [--seed N] [--start FILE] [FUNCTION...]\n");
      return 1;
    }
  }
  FILE *file = start ? fopen(start, "r") : NULL;
  if (start && !file) {
    fprintf(stderr, "math64-worst: '%s' cannot be read\n", start);
    return 1;
  }
  if (file)
    fclose(file);
  for (char **name = argv + i; *name; name++)
    if (!is_known(*name)) {
      fprintf(stderr, "math64-worst: there is no function '%s'\n", *name);
      return 1;
    }
  for (size_t k = 0; k < function_count; k++)
    if (is_named(&functions[k], argv + i))
      search(&functions[k], seed, count, start);
  return failed;
}
