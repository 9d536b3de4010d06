/* trax-accuracy: the accuracy of the runtime's binary32 functions. accuracy.py keeps the results.

     --sample N [FUNCTION...]   a row for the first N operands of a sequence that begins with special values
     --whole [FUNCTION...]      a row for all 2^32 operands, or 2^28 sets of several
     --results                  for each function the operands of --whole, and a hash of its results
     --errors                   the error for each line of standard input, "FUNCTION OPERAND..."

   Exit status: 0, or 1 if the arguments are wrong or the host's functions are worse than assumed. */
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

static uint64_t whole_count(const struct function *function) {
  return function->operands == 1 ? WHOLE : PAIRS;
}

/* A hash of the results over the first operands of the sample: it tells whether a function has changed. */
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

static void print_row(const struct function *function, const struct measured *m) {
  char at[32] = "";
  if (m->worst > 0)
    operand_text(at, sizeof at, function, m->worst_operand);
  printf("%s,%" PRIu64 ",%.6f,%s,%" PRIu64 ",%" PRIu64 ",%" PRIu64 ",%" PRIu64 ",%.2f,%016" PRIx64 "\n", function->name,
         m->count, m->worst, at, m->wrong, m->beyond_one, m->special, m->disorder, m->host, fingerprint(function));
  fflush(stdout);
  if (m->special) {
    operand_text(at, sizeof at, function, m->special_operand);
    fprintf(stderr, "%s: the first wrong special value is at %s\n", function->name, at);
  }
}

static const struct function *find_function(const char *name, size_t length) {
  for (size_t f = 0; f < function_count; f++)
    if (strlen(functions[f].name) == length && !memcmp(functions[f].name, name, length))
      return &functions[f];
  return NULL;
}

static void print_errors(void) {
  char line[256];
  for (int number = 1; fgets(line, sizeof line, stdin); number++) {
    uint32_t operand[3] = {0};
    const size_t length = strcspn(line, " \n");
    const struct function *function = find_function(line, length);
    if (!function)
      fail("standard input:%d: no such function: %.*s", number, (int)length, line);
    sscanf(line + length, "%" SCNx32 " %" SCNx32 " %" SCNx32, &operand[0], &operand[1], &operand[2]);
    printf("%.6f\n", error_at(function, operand));
  }
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
  uint64_t sample = 0;
  bool whole = false, any = false;
  long jobs = sysconf(_SC_NPROCESSORS_ONLN);
  jobs = jobs < 1 ? 1 : jobs > 64 ? 64 : jobs;
  bool *chosen = calloc(function_count, sizeof *chosen);
  if (!chosen)
    fail("out of memory");
  for (int i = 1; i < argc; i++) {
    const struct function *function = find_function(argv[i], strlen(argv[i]));
    if (!strcmp(argv[i], "--whole")) {
      whole = true;
    } else if (!strcmp(argv[i], "--version")) {
      puts("trax-accuracy " TRAX_VERSION);
      return 0;
    } else if (!strcmp(argv[i], "--results")) {
      for (size_t f = 0; f < function_count; f++)
        printf("%s,%" PRIu64 ",%016" PRIx64 "\n", functions[f].name, whole_count(&functions[f]),
               fingerprint(&functions[f]));
      return 0;
    } else if (!strcmp(argv[i], "--errors")) {
      print_errors();
      judge_finish();
      return 0;
    } else if (!strcmp(argv[i], "--sample")) {
      sample = number_argument(argv[i], argv[i + 1], CHUNK, WHOLE - 1);
      i++;
    } else if (!strcmp(argv[i], "--jobs")) {
      jobs = (long)number_argument(argv[i], argv[i + 1], 1, 64);
      i++;
    } else if (function) {
      chosen[function - functions] = any = true;
    } else {
      fail("%s: no such %s", argv[i], argv[i][0] == '-' ? "option" : "function");
    }
  }
  if (whole == (sample != 0))
    fail("give either --whole or --sample N (see the head of main.c)");
  progress.start = now();
  for (size_t f = 0; f < function_count; f++) {
    chosen[f] |= !any;
    progress.all += chosen[f] ? whole ? whole_count(&functions[f]) : sample : 0;
  }
  fputs(HEADER, stdout);
  for (size_t f = 0; f < function_count; f++) {
    if (!chosen[f])
      continue;
    struct measured m = measure(&functions[f], whole ? whole_count(&functions[f]) : sample, jobs);
    if (isatty(2))
      fprintf(stderr, "\r%70s\r", "");
    print_row(&functions[f], &m);
  }
  free(chosen);
  judge_finish();
  return 0;
}
