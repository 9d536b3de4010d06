// clang-format off
// RUN: %run_c %s %t --levels -O2 --also -O0 --cflags "-mstack=global -fopenmp" --simflags "--set chip.tms=2 --set chip.tps_per_tm=8 --main-on 0 --max-cycles 20000000"
// RUN: %run_c %s %t --levels -O2 --cflags "-mstack=global -fopenmp" --simflags "--max-cycles 20000000"
// RUN: %trax_sim --set chip.tms=2 --set chip.tps_per_tm=8 --main-on 0 --check-races %t-O2 > %t.out
// clang-format on
// OpenMP: what is printed does not depend on the number of threads, and is the host's without OpenMP.
#include <stdio.h>
#include <string.h>
#ifdef _OPENMP
#include <omp.h>
#endif
#ifdef __trax__
#include <trax.h>
void __trax_wait(void);
extern unsigned __trax_waiting;
#endif

enum { N = 500 };
static int values[N], other[N];
static long long wide[N];
static float sums[N];
static int counter;
#pragma omp threadprivate(counter)

static unsigned hash(const void *memory, unsigned size) {
  unsigned h = 1;
  for (unsigned i = 0; i < size; i++)
    h = h * 31 + ((const unsigned char *)memory)[i];
  return h;
}

static void clear(void) {
  memset(values, 0, sizeof values);
}

static void loops(int n) {
#pragma omp parallel for
  for (int i = 0; i < n; i++)
    values[i] += i * 3;
#pragma omp parallel for schedule(static, 7)
  for (int i = n - 1; i >= 0; i -= 3)
    values[i] += i;
#pragma omp parallel for schedule(dynamic)
  for (unsigned i = 5; i < (unsigned)n; i += 2)
    values[i] += 7;
#pragma omp parallel for schedule(dynamic, 13)
  for (long long i = n - 1; i >= 0; i--)
    values[i] ^= 21;
#pragma omp parallel for schedule(guided)
  for (int i = 0; i < n; i++)
    wide[i] = (long long)values[i] << 30;
#pragma omp parallel for schedule(guided, 11)
  for (unsigned long long i = 0; i < (unsigned long long)n; i++)
    wide[i] -= (long long)i;
#pragma omp parallel for schedule(runtime)
  for (int i = 0; i < n; i++)
    other[i] = values[n - 1 - i];
#pragma omp parallel for schedule(static, 1 << 28)
  for (int i = 0; i < n; i++) /* other threads' parts would begin behind 2^31 */
    other[i] += 5 * i;
#pragma omp parallel for schedule(static, 200)
  for (unsigned i = 0; i < (unsigned)n; i++)
    other[i] ^= 9;
#pragma omp parallel for simd collapse(2) schedule(static)
  for (int i = 0; i < 20; i++)
    for (int j = 0; j < 25; j++)
      sums[i * 25 + j] = (float)(i - j);
#pragma omp parallel for
  for (int i = n; i < n; i++) /* no iteration */
    values[0] = -1;
}

static void many_loops(int n) {
  int last = -1, total = 0;
#pragma omp parallel num_threads(5)
  {
    for (int round = 0; round < 9; round++) {
#pragma omp for schedule(dynamic, 2) nowait
      for (int i = 0; i < n; i++)
        values[i] += round;
#pragma omp for schedule(static, 9)
      for (int i = 0; i < n; i++)
        other[i] -= round * i;
#pragma omp for schedule(guided) lastprivate(last)
      for (int i = 0; i < n; i++)
        last = values[i] + other[i];
#pragma omp for schedule(static, 3) reduction(+ : total)
      for (int i = 0; i < n; i++)
        total += i ^ round;
    }
  }
  printf("many loops: %d %d\n", last, total);
}

static void reductions(int n) {
  int sum = 5, most = -1, bits = 0, all = 1;
  long long product = 1;
  double real = 0.5;
#pragma omp parallel for reduction(+ : sum, real) reduction(max : most) reduction(| : bits) reduction(&& : all)                 \
    reduction(* : product)
  for (int i = 0; i < n; i++) {
    sum += i;
    real += i * 0.25;
    most = i % 97 > most ? i % 97 : most;
    bits |= i & 36;
    all = all && i < n;
    if (i % 100 == 99)
      product *= i;
  }
  printf("reductions: %d %.2f %d %d %d %lld\n", sum, real, most, bits, all, product);
}

/* A thread goes on while others may still add its part. */
static void reduced_again(int n) {
  int total = 0;
#pragma omp parallel
  for (int round = 0; round < 4; round++) {
#pragma omp for reduction(+ : total) nowait
    for (int i = 0; i < n; i++)
      total += i + round;
  }
  printf("again: %d\n", total);
}

static void synchronised(void) {
  int in_section = 0, in_atomic = 0, single = 0, master = 0, wrong = 0, sections = 0, captured = 0;
  static int before[256];
#pragma omp parallel
  {
    int self = 0, threads = 1, copied = 0;
#ifdef _OPENMP
    self = omp_get_thread_num();
    threads = omp_get_num_threads();
#endif
    for (int i = 0; i < 3; i++) {
#pragma omp critical
      in_section++;
#pragma omp critical(other)
      in_section += 0;
#pragma omp atomic
      in_atomic += 2;
      int old;
#pragma omp atomic capture
      old = captured++;
      if (old < 0)
#pragma omp atomic
        wrong++;
      before[self] = i + 1;
#pragma omp barrier
      if (before[(self + 1) % threads] != i + 1)
#pragma omp atomic
        wrong++;
#pragma omp single
      single++;
#pragma omp master
      master++;
#pragma omp barrier
    }
    if (self == 1) { /* late, and copies alone */
      for (volatile int i = 0; i < 300; i++)
        ;
#pragma omp parallel
      {
        int alone = 0;
#pragma omp single copyprivate(alone)
        alone = 5;
        if (alone != 5)
#pragma omp atomic
          wrong++;
      }
    }
#pragma omp single copyprivate(copied)
    copied = 77;
    if (copied != 77)
#pragma omp atomic
      wrong++;
    counter += self + 1;
#pragma omp sections
    {
#pragma omp section
        {
#pragma omp atomic
            sections += 1;
  }
#pragma omp section
  {
#pragma omp atomic
    sections += 10;
  }
}
#pragma omp critical
{
  in_section -= 3;
  in_atomic -= 6;
  captured -= 3;
}
}
printf("synchronised: %d %d %d %d %d %d %d\n", in_section, in_atomic, captured, single, master, wrong, sections);
#pragma omp parallel
{
  int self = 0;
#ifdef _OPENMP
  self = omp_get_thread_num();
#endif
  if (counter != self + 1)
#pragma omp atomic
    wrong++;
}
printf("threadprivate: %d\n", wrong);
}

/* A region within a region, and one whose condition is false, have one thread. */
static void nested(int n) {
  int sum = 0;
#pragma omp parallel for schedule(dynamic) reduction(+ : sum)
  for (int i = 0; i < 20; i++) {
    int inner = 0;
#pragma omp parallel for schedule(dynamic, 3) reduction(+ : inner)
    for (int j = 0; j < n; j++)
      inner += j;
    sum += inner + i;
  }
  int alone = 0;
#pragma omp parallel for if (n > 1000) schedule(dynamic)
  for (int i = 0; i < n; i++)
    alone += i; /* no reduction: it is one thread's */
  printf("nested: %d %d\n", sum, alone);
}

static void many_variables(void) {
  int a = 1, b = 2, c = 3, d = 4, e = 5, f = 6, g = 7, h = 8, i = 9, j = 10, k = 11, l = 12;
  long long m = 13;
  double o = 14;
  float p = 15;
#pragma omp parallel firstprivate(a, b, c, d, m, o, p)
  {
#pragma omp critical
    {
      if (a + b + c + d + (int)m + (int)o + (int)p == 52)
        e = 6, f = 7, g = 8, h = 9, i = 10, j = 11, k = 12, l = 13;
      a = b = c = d = 0;
    }
  }
  printf("variables: %d %d\n", e + f + g + h + i + j + k + l, (int)(o + p));
}

int main(void) {
#ifdef __trax__
  if (trax_thread() != 0) { /* a machine without --main-on 0 */
    __trax_wait();
    return 0;
  }
  __trax_waiting = trax_threads() - 1;
#endif
  for (int round = 0; round < 2; round++) {
    clear();
    loops(N - 7 * round);
    printf("loops: %08x %08x %08x %08x\n", hash(values, sizeof values), hash(wide, sizeof wide),
           hash(other, sizeof other), hash(sums, sizeof sums));
  }
  clear();
  many_loops(83);
  reductions(N);
  reduced_again(N);
  synchronised();
  nested(30);
  many_variables();
#ifdef _OPENMP
  omp_lock_t lock;
  omp_init_lock(&lock);
  omp_set_lock(&lock);
  int right = !omp_test_lock(&lock) && omp_get_num_threads() == 1 && !omp_in_parallel();
  omp_unset_lock(&lock);
  omp_set_num_threads(3);
  int threads = 0;
#pragma omp parallel
#pragma omp atomic
  threads++;
  right = right && threads == (omp_get_num_procs() == 1 ? 1 : 3) && omp_get_max_threads() == threads;
  if (!right)
    printf("omp.h: %d threads\n", threads);
#endif
  return 0;
}
