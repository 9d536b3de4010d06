/* The frame of a sweep (numerics/sweep.c, isa/oracle/sweep.c), included last: main for the TP, where all threads share
   the blocks, and for the host. A sweep defines

     BLOCK           operands that a thread takes at a time
     MOST_ROUTINES   how many routines there are at most
     sweep_block     adds the results of some operands to the routines' hashes, or prints every result
     routine_names   the names of the routines, and *count of them

   A program is told WHICH FIRST COUNT VERBOSE: WHICH routines, or how, from which operands on, how many, and whether to
   print every result. It prints a line for each routine. */
#ifndef TRAX_TEST_SWEEP_MAIN_H
#define TRAX_TEST_SWEEP_MAIN_H

struct parameters {
  uint32_t which, first, count, verbose;
};

static void sweep_block(const struct parameters *p, uint64_t first, uint32_t count, uint32_t *hashes);
static const char *const *routine_names(const struct parameters *p, int *count);

static inline void add(uint32_t *hash, uint64_t value) {
  uint32_t h = (*hash ^ (uint32_t)value) * 0x9E3779B1u;
  h = ((h ^ h >> 15) ^ (uint32_t)(value >> 32)) * 0x85EBCA6Bu;
  *hash = h ^ h >> 13;
}

/* A block's hash goes into the sum multiplied by an odd number of its own, so that no order of the blocks is asked for.
 */
static void sum_block(const struct parameters *p, uint32_t done, uint32_t *hashes, uint64_t *sums) {
  const uint64_t first = (uint64_t)p->first + done;
  for (int i = 0; i < MOST_ROUTINES; i++)
    hashes[i] = 0;
  sweep_block(p, first, p->count - done < BLOCK ? p->count - done : BLOCK, hashes);
  for (int i = 0; i < MOST_ROUTINES; i++)
    sums[i] += (uint64_t)hashes[i] * (2 * first + 1);
}

static void print_sums(const struct parameters *p, const uint64_t *sums) {
  int count;
  const char *const *names = routine_names(p, &count);
  for (int i = 0; i < count && !p->verbose; i++)
    printf("%s %016llx\n", names[i], (unsigned long long)sums[i]);
}

#ifdef __trax__

#define MOST_THREADS 64

struct trax_buffer parameters;
static uint32_t hashes[MOST_THREADS][MOST_ROUTINES];
static uint64_t sums[MOST_THREADS][MOST_ROUTINES];
static unsigned next_block, finished;

int main(void) {
  const struct parameters *p = parameters.data;
  unsigned thread = trax_thread(), threads = trax_threads();
  if (threads > MOST_THREADS)
    abort();
  for (uint32_t done; (done = trax_atomic_inc(&next_block) * BLOCK) < p->count;)
    sum_block(p, done, hashes[thread], sums[thread]);
  if (trax_atomic_inc(&finished) != threads - 1)
    return 0;
  for (unsigned t = 1; t < threads; t++)
    for (int i = 0; i < MOST_ROUTINES; i++)
      sums[0][i] += sums[t][i];
  print_sums(p, sums[0]);
  return 0;
}

#else

int main(int argc, char **argv) {
  uint32_t n[4];
  if (argc != 5) {
    fprintf(stderr, "usage: sweep WHICH FIRST COUNT VERBOSE\n");
    return 1;
  }
  for (int i = 0; i < 4; i++)
    n[i] = (uint32_t)strtoul(argv[i + 1], NULL, 10);
  const struct parameters p = {n[0], n[1], n[2], n[3]};
  uint32_t hashes[MOST_ROUTINES];
  uint64_t sums[MOST_ROUTINES] = {0};
  for (uint64_t done = 0; done < p.count; done += BLOCK)
    sum_block(&p, (uint32_t)done, hashes, sums);
  print_sums(&p, sums);
  return 0;
}

#endif

#endif
