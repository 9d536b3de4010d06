/* precision-units: the error of frsqrt and fdiv for each precision of the special unit, b = 1 to 24 bits; precision.py
   calls it.

     precision-units [STRIDE]   every significand, or every STRIDE-th

   frsqrt over all significands of x in [1, 2) and [2, 4), both parities of the exponent; fdiv over all significands of
   the divisor in [1, 2) for the dividends below. Other exponents only scale the results. Errors are against the
   quotient or root in binary64, in units of the last place of binary32 and relative. Prints CSV: operation, bits, the
   latency of either design, greatest and mean error in units, relative. */
#include <math.h>
#include <pthread.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <trax/semantics.h>

/* The latency in cycles of a unit for results of b bits, for two simple designs (Ercegovac and Lang, "Digital
   Arithmetic", 2004). Both take the paper's 8 cycles for 24 bits.
   A digit recurrence of radix 16, four bits per cycle: two bits more than the result has, for rounding, and one cycle
   to normalise and round (chapters 5 and 6). */
static unsigned latency_digits(unsigned bits) {
  return (bits + 2 + 3) / 4 + 1;
}

/* A table of 8 bits, two cycles for the table and the rounding, and steps of Newton's iteration, each of which doubles
   the bits in three cycles: two products and a difference (chapter 7). */
static unsigned latency_newton(unsigned bits) {
  unsigned cycles = 2;
  for (unsigned precision = 8; precision < bits; precision *= 2)
    cycles += 3;
  return cycles;
}

enum { BITS = 24, BLOCKS = 64, JOBS = 2 };

/* 1, its neighbour, sqrt(2), 3/2, and the last before 2. */
static const uint32_t dividends[] = {0x3F800000, 0x3F800001, 0x3FB504F3, 0x3FC00000, 0x3FFFFFFF};
enum { DIVIDENDS = sizeof dividends / sizeof dividends[0] };

struct error {
  double greatest, sum, greatest_relative, sum_relative;
};

struct block {
  struct error rsqrt[BITS + 1], div[BITS + 1];
  uint64_t rsqrts, divs;
};

static struct block blocks[BLOCKS];
static uint32_t stride = 1;

static void add(struct error *errors, uint32_t exact, double truth) {
  double unit = ldexp(1, 23 - ilogb(truth));
  for (unsigned bits = 1; bits <= BITS; bits++) {
    double difference = fabs((double)trax_to_float(trax_reduce_precision(exact, bits)) - truth);
    double ulp = difference * unit, relative = difference / truth;
    struct error *e = &errors[bits];
    e->greatest = ulp > e->greatest ? ulp : e->greatest;
    e->greatest_relative = relative > e->greatest_relative ? relative : e->greatest_relative;
    e->sum += ulp;
    e->sum_relative += relative;
  }
}

static void measure(struct block *block, uint32_t first, uint32_t end) {
  for (uint32_t m = first; m < end; m += stride) {
    for (uint32_t odd = 0; odd < 2; odd++, block->rsqrts++) {
      uint32_t x = (0x3F800000u | m) + (odd << 23);
      add(block->rsqrt, trax_frsqrt(x), 1 / sqrt((double)trax_to_float(x)));
    }
    uint32_t divisor = 0x3F800000u | m;
    for (int i = 0; i < DIVIDENDS; i++, block->divs++)
      add(block->div, trax_fdiv(dividends[i], divisor),
          (double)trax_to_float(dividends[i]) / (double)trax_to_float(divisor));
  }
}

/* Blocks are summed in order whoever computed them, so the result does not depend on the threads. */
static void *work(void *argument) {
  for (size_t i = *(const size_t *)argument; i < BLOCKS; i += JOBS)
    measure(&blocks[i], (uint32_t)i << 17, ((uint32_t)i + 1) << 17);
  return NULL;
}

static void print(const char *operation, unsigned bits, struct error e, uint64_t count) {
  printf("%s,%u,%u,%u,%.9g,%.9g,%.9g,%.9g\n", operation, bits, latency_digits(bits), latency_newton(bits), e.greatest,
         e.sum / (double)count, e.greatest_relative, e.sum_relative / (double)count);
}

static void merge(struct error *into, const struct error *from) {
  into->greatest = fmax(into->greatest, from->greatest);
  into->greatest_relative = fmax(into->greatest_relative, from->greatest_relative);
  into->sum += from->sum;
  into->sum_relative += from->sum_relative;
}

int main(int argc, char **argv) {
  char *end = NULL;
  unsigned long chosen = argc > 1 ? strtoul(argv[1], &end, 10) : 1;
  if (argc > 2 || (end && *end) || chosen < 1 || chosen > 1 << 17) {
    fprintf(stderr, "usage: precision-units [STRIDE], 1 to 131072\n");
    return 1;
  }
  stride = (uint32_t)chosen;
  pthread_t threads[JOBS];
  size_t numbers[JOBS];
  for (size_t i = 0; i < JOBS; i++) {
    numbers[i] = i;
    if (pthread_create(&threads[i], NULL, work, &numbers[i])) {
      fprintf(stderr, "precision-units: cannot start a thread\n");
      return 1;
    }
  }
  for (size_t i = 0; i < JOBS; i++)
    pthread_join(threads[i], NULL);
  puts("operation,bits,digits,newton,max_ulp,mean_ulp,max_relative,mean_relative");
  for (unsigned bits = 1; bits <= BITS; bits++) {
    struct block total = {0};
    for (size_t i = 0; i < BLOCKS; i++) {
      merge(&total.rsqrt[bits], &blocks[i].rsqrt[bits]);
      merge(&total.div[bits], &blocks[i].div[bits]);
      total.rsqrts += blocks[i].rsqrts;
      total.divs += blocks[i].divs;
    }
    print("frsqrt", bits, total.rsqrt[bits], total.rsqrts);
    print("fdiv", bits, total.div[bits], total.divs);
  }
  return 0;
}
