/* trax-accuracy: how accurate the runtime's binary32 functions are; docs/results/functions.md has the results.

     trax-accuracy --output FILE [FUNCTION...]   all 2^32 operands, or 2^28 sets of several; rows that FILE already has
   and that still hold are kept, so a run that was stopped goes on where it was trax-accuracy --sample N [FUNCTION...]
   the first N operands of a sequence that begins with special values; prints rows trax-accuracy --check FILE [--sample
   N]     compares a sample with FILE, and the greatest errors where FILE has them

   Exit status: 0, or 1 if the arguments are wrong, a check fails or the host's functions are worse than assumed. */
#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "../operands.h"
#include "accuracy.h"
#include "trax/version.h"

static void fail(const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  fputs("trax-accuracy: ", stderr);
  vfprintf(stderr, format, arguments);
  fputc('\n', stderr);
  va_end(arguments);
  exit(1);
}

#define HEADER                                                                                                         \
  "function,operands,max_ulp,at,not_rounded_correctly,beyond_1_ulp,wrong_special_values,wrong_order,host_ulp,"         \
  "results\n"
#define WHOLE ((uint64_t)1 << 32)
#define PAIRS ((uint64_t)1 << 28)
enum { ROW = 256 };

struct row {
  char text[ROW]; /* the line of the file */
  bool present;
};

/* The part of a row that a short run can tell: the results over the first operands of the sample. */
static uint64_t fingerprint(const struct function *function) {
  static struct chunk chunk;
  uint64_t hash = 0xCBF29CE484222325u; /* FNV-1a */
  for (uint64_t number = 0; number < 256; number++) {
    operands_fill(&chunk, function, number, false);
    function->ours(&chunk);
    for (size_t i = 0; i < CHUNK; i++) {
      float got = chunk.got[i];
      hash = (hash ^ (got == got ? float_bits_of(got) : 0x7FC00000u)) * 0x100000001B3u;
    }
  }
  return hash;
}

/*--- the threads ---*/

struct work {
  const struct function *function;
  uint64_t chunks;
  bool whole;
  atomic_uint_fast64_t next;
  struct measured total;
  pthread_mutex_t lock;
};

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + (double)t.tv_nsec * 1e-9;
}

static struct {
  double start;
  uint64_t all, before; /* operands in the whole run, and of the functions that are done */
} progress;

static void show_progress(const struct work *work, uint64_t chunk) {
  double done = (double)progress.before + (double)chunk * CHUNK, part = done / (double)progress.all;
  double seconds = now() - progress.start;
  fprintf(stderr, "\r%-12s %3.0f %% of it, %5.1f %% of all, %3.0f s left ", work->function->name,
          100.0 * (double)chunk / (double)work->chunks, 100 * part, part > 0 ? seconds / part - seconds : 0);
}

static void *measure_part(void *argument) {
  struct work *work = argument;
  struct measured part = {0};
  struct chunk *chunk = malloc(sizeof *chunk);
  if (!chunk)
    fail("out of memory");
  enum { BATCH = 64 };
  for (;;) {
    uint64_t first = atomic_fetch_add(&work->next, BATCH);
    if (first >= work->chunks)
      break;
    if (isatty(2) && first % (BATCH * 64) == 0)
      show_progress(work, first);
    for (uint64_t number = first; number < first + BATCH && number < work->chunks; number++) {
      operands_fill(chunk, work->function, number, work->whole);
      measure_chunk(work->function, chunk, &part);
    }
  }
  pthread_mutex_lock(&work->lock);
  measure_merge(&work->total, &part);
  pthread_mutex_unlock(&work->lock);
  free(chunk);
  judge_finish();
  return NULL;
}

/* The error at the given operands as MPFR has it. */
static double error_at(const struct function *function, const uint32_t *operand) {
  struct chunk *chunk = calloc(1, sizeof *chunk);
  if (!chunk)
    fail("out of memory");
  for (int n = 0; n < 3; n++)
    chunk->operand[n][0] = operand[n];
  function->ours(chunk);
  double error = judge(function, chunk, 0).error;
  free(chunk);
  return error;
}

static struct measured measure(const struct function *function, uint64_t count, long jobs) {
  struct work work = {.function = function,
                      .chunks = (count + CHUNK - 1) / CHUNK,
                      .whole = function->operands == 1 && count == WHOLE,
                      .total.worst_number = UINT64_MAX};
  pthread_mutex_init(&work.lock, NULL);
  pthread_t thread[64];
  for (long i = 0; i < jobs; i++)
    if (pthread_create(&thread[i], NULL, measure_part, &work))
      fail("cannot start %ld threads", jobs);
  for (long i = 0; i < jobs; i++)
    pthread_join(thread[i], NULL);
  progress.before += count;
  if (work.total.host > HOST_ERROR * 0x1p53)
    fail("the host's function for %s is %.1f units of binary64's last place off: more than this program assumes",
         function->name, work.total.host);
  if (work.total.worst > 0) {
    double exact = error_at(function, work.total.worst_operand);
    if (fabs(exact - work.total.worst) > 0x1p-20)
      fail("%s: the host says %.9f units at %08" PRIx32 ", MPFR %.9f", function->name, work.total.worst,
           work.total.worst_operand[0], exact);
    work.total.worst = exact;
  }
  return work.total;
}

/*--- rows ---*/

static void operand_text(char *text, size_t size, const struct function *function, const uint32_t *operand) {
  size_t length = 0;
  for (int n = 0; n < function->operands; n++)
    length += (size_t)snprintf(text + length, size - length, "%s%08" PRIx32, n ? " " : "", operand[n]);
}

static void make_row(struct row *row, const struct function *function, const struct measured *m) {
  char at[32] = "";
  if (m->worst > 0)
    operand_text(at, sizeof at, function, m->worst_operand);
  snprintf(row->text, sizeof row->text,
           "%s,%" PRIu64 ",%.6f,%s,%" PRIu64 ",%" PRIu64 ",%" PRIu64 ",%" PRIu64 ",%.2f,%016" PRIx64, function->name,
           m->count, m->worst, at, m->wrong, m->beyond_one, m->special, m->disorder, m->host, fingerprint(function));
  row->present = true;
}

/* The number of the field, from 0, of a row; false if the row has not so many. */
static bool field(const struct row *row, int number, char *text, size_t size) {
  const char *p = row->text;
  while (number-- > 0) {
    p = strchr(p, ',');
    if (!p)
      return false;
    p++;
  }
  size_t length = strcspn(p, ",");
  if (length >= size)
    return false;
  memcpy(text, p, length);
  text[length] = 0;
  return true;
}

static void read_rows(struct row *rows, const char *path, bool must_exist) {
  FILE *file = fopen(path, "r");
  if (!file) {
    if (must_exist || errno != ENOENT)
      fail("%s: %s", path, strerror(errno));
    return;
  }
  char line[ROW];
  for (int number = 1; fgets(line, sizeof line, file); number++) {
    if (number == 1) {
      if (strcmp(line, HEADER) != 0)
        fail("%s:1: not a table of this program", path);
      continue;
    }
    size_t length = strcspn(line, "\n"), i = 0;
    if (line[length] != '\n')
      fail("%s:%d: the line is too long or not complete", path, number);
    line[length] = 0;
    while (i < function_count &&
           (strncmp(line, functions[i].name, strlen(functions[i].name)) != 0 || line[strlen(functions[i].name)] != ','))
      i++;
    if (i == function_count)
      fail("%s:%d: no such function: %.*s", path, number, (int)strcspn(line, ","), line);
    memcpy(rows[i].text, line, length + 1);
    rows[i].present = true;
    char last[ROW];
    if (!field(&rows[i], 9, last, sizeof last))
      fail("%s:%d: not ten fields", path, number);
  }
  fclose(file);
}

static void write_rows(const struct row *rows, const char *path) {
  char temporary[4096];
  if (snprintf(temporary, sizeof temporary, "%s.new", path) >= (int)sizeof temporary)
    fail("%s: the name is too long", path);
  FILE *file = fopen(temporary, "w");
  if (!file)
    fail("%s: %s", temporary, strerror(errno));
  fputs(HEADER, file);
  for (size_t i = 0; i < function_count; i++)
    if (rows[i].present)
      fprintf(file, "%s\n", rows[i].text);
  if (fclose(file) || rename(temporary, path))
    fail("%s: %s", path, strerror(errno));
}

/* Whether the row is of a run over so many operands, of functions that still give the same results. */
static bool holds(const struct row *row, const struct function *function, uint64_t count) {
  char operands[32], results[32], hash[32];
  if (!row->present || !field(row, 1, operands, sizeof operands) || !field(row, 9, results, sizeof results))
    return false;
  snprintf(hash, sizeof hash, "%016" PRIx64, fingerprint(function));
  return strtoull(operands, NULL, 10) == count && !strcmp(results, hash);
}

/*--- a sample against the rows ---*/

static bool check(const struct row *row, const struct function *function, const struct measured *m) {
  char text[5][64], hash[32];
  static const int numbers[] = {2, 3, 6, 7, 9};
  if (!row->present) {
    printf("%-12s has no row  FAILED\n", function->name);
    return false;
  }
  for (int i = 0; i < 5; i++)
    if (!field(row, numbers[i], text[i], sizeof text[i]))
      fail("the row of %s is damaged", function->name);
  snprintf(hash, sizeof hash, "%016" PRIx64, fingerprint(function));
  uint32_t operand[3] = {0};
  sscanf(text[1], "%" SCNx32 " %" SCNx32 " %" SCNx32, &operand[0], &operand[1], &operand[2]);
  double bound = strtod(text[0], NULL);
  char there[32];
  snprintf(there, sizeof there, "%.6f", text[1][0] ? error_at(function, operand) : 0);
  const char *bad = m->worst > bound + 0.5e-6                   ? "a greater error"
                    : m->special > strtoull(text[2], NULL, 10)  ? "more wrong special values"
                    : m->disorder > strtoull(text[3], NULL, 10) ? "more neighbours in wrong order"
                    : strcmp(there, text[0]) != 0               ? "another error at the recorded operand"
                    : strcmp(hash, text[4]) != 0                ? "other results: measure it again"
                                                                : NULL;
  printf("%-12s %.6f of %.6f ulp, %" PRIu64 " wrong special values%s%s\n", function->name, m->worst, bound, m->special,
         bad ? "  FAILED: " : "", bad ? bad : "");
  if (m->special) {
    char at[32];
    operand_text(at, sizeof at, function, m->special_operand);
    printf("%-12s first wrong special value at %s\n", "", at);
  }
  return !bad;
}

static uint64_t number_argument(const char *option, const char *text, uint64_t least, uint64_t most) {
  char *end;
  errno = 0;
  uint64_t value = text ? strtoull(text, &end, 0) : 0;
  if (!text || end == text || *end || errno || value < least || value > most)
    fail("%s needs a number from %" PRIu64 " to %" PRIu64, option, least, most);
  return value;
}

int main(int argc, char **argv) {
  const char *output = NULL, *against = NULL;
  uint64_t sample = 0;
  long jobs = sysconf(_SC_NPROCESSORS_ONLN);
  jobs = jobs < 1 ? 1 : jobs > 64 ? 64 : jobs;
  bool *chosen = calloc(function_count, sizeof *chosen), any = false, ok = true;
  struct row *rows = calloc(function_count, sizeof *rows);
  if (!chosen || !rows)
    fail("out of memory");
  for (int i = 1; i < argc; i++) {
    if (!strcmp(argv[i], "--output") && i + 1 < argc) {
      output = argv[++i];
    } else if (!strcmp(argv[i], "--check") && i + 1 < argc) {
      against = argv[++i];
    } else if (!strcmp(argv[i], "--version")) {
      puts("trax-accuracy " TRAX_VERSION);
      return 0;
    } else if (!strcmp(argv[i], "--sample")) {
      sample = number_argument(argv[i], argv[i + 1], CHUNK, WHOLE - 1);
      i++;
    } else if (!strcmp(argv[i], "--jobs")) {
      jobs = (long)number_argument(argv[i], argv[i + 1], 1, 64);
      i++;
    } else {
      size_t f = 0;
      while (f < function_count && strcmp(argv[i], functions[f].name) != 0)
        f++;
      if (f == function_count)
        fail("%s: no such %s", argv[i], argv[i][0] == '-' ? "option, or its argument is missing" : "function");
      chosen[f] = any = true;
    }
  }
  if (!output && !against && !sample)
    fail("give --output FILE, --check FILE or --sample N (see the head of main.c)");
  if (output && (against || sample))
    fail("--output goes with neither --check nor --sample");
  if (against && !sample)
    sample = 1 << 20;
  if (output || against)
    read_rows(rows, output ? output : against, against != NULL);
  progress.start = now();
  if (output)
    write_rows(rows, output); /* rather now than after hours */
  for (size_t f = 0; f < function_count; f++) {
    chosen[f] |= !any;
    uint64_t count = sample ? sample : functions[f].operands == 1 ? WHOLE : PAIRS;
    if (output && chosen[f] && holds(&rows[f], &functions[f], count))
      chosen[f] = false;
    progress.all += chosen[f] ? count : 0;
  }
  if (!against)
    fputs(HEADER, stdout);
  for (size_t f = 0; f < function_count; f++) {
    if (!chosen[f])
      continue;
    uint64_t count = sample ? sample : functions[f].operands == 1 ? WHOLE : PAIRS;
    struct measured m = measure(&functions[f], count, jobs);
    if (isatty(2))
      fprintf(stderr, "\r%70s\r", "");
    if (against) {
      ok &= check(&rows[f], &functions[f], &m);
    } else {
      make_row(&rows[f], &functions[f], &m);
      printf("%s\n", rows[f].text);
    }
    fflush(stdout);
    if (output)
      write_rows(rows, output);
  }
  free(chosen);
  free(rows);
  judge_finish();
  return !ok;
}
