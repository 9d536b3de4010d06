/* The common parts of trax-accuracy, which measures the runtime's binary32 functions. */
#ifndef TRAX_TEST_ACCURACY_H
#define TRAX_TEST_ACCURACY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <mpfr.h>

enum { CHUNK = 1024 };

/* Loops over a chunk are compiled for the host's widest registers too; without that they, and not the functions, would
   take most of the time. Sanitizers cannot be ready when the choice is made. */
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) &&               \
    !defined(__SANITIZE_THREAD__)
#define WIDEST __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define WIDEST
#endif

/* The host's binary64 functions are taken to be right within this part of the result, 64 units of binary64's last
   place; glibc promises 10 at most, 4 where it computes several at once. In units of binary32's last place this is
   2^-23. */
#define HOST_ERROR 0x1p-47

/* Operands and results of one chunk, and the next operand, for the order of neighbours. A function of one operand uses
   operand[0] alone. */
struct chunk {
  uint64_t first; /* its number in the whole sequence */
  uint32_t operand[3][CHUNK + 1];
  float got[CHUNK + 1];
  double want[CHUNK + 1];
};

struct function {
  const char *name;
  int operands;
  void (*ours)(struct chunk *chunk);                   /* fills got */
  void (*host)(struct chunk *chunk);                   /* fills want, to HOST_ERROR unless it is 0, infinite or a NaN */
  void (*exact)(mpfr_t result, const mpfr_t *operand); /* to result's precision */
};

extern const struct function functions[];
extern const size_t function_count;

/* operands.c: the sequences of operands. Functions of one operand: all of them in order, or, if whole is not set, a
   sequence that begins with special values and goes on with runs of 64 neighbours scattered over all floats. Several
   operands: special ones in all combinations, then such as are hard for the function. */
void operands_fill(struct chunk *chunk, const struct function *function, uint64_t number, bool whole);

/* exact.c */
struct verdict {
  bool wrong;   /* not the correctly rounded result */
  bool special; /* and so far off that no number of units says how far: NaN, infinity, zero or sign */
  double error; /* in units of the last place of the true result, else */
  double host;  /* the host's error in units of binary64's last place; 0 where that has no meaning */
};
/* Judges result number i of the chunk by MPFR. */
struct verdict judge(const struct function *function, const struct chunk *chunk, size_t i);
/* Frees what the calling thread's judgements have allocated. */
void judge_finish(void);
/* The sign of the true difference of result i + 1 and result i. */
int true_order(const struct function *function, const struct chunk *chunk, size_t i);

/* measure.c */
struct measured {
  uint64_t count, wrong, beyond_one, special, disorder;
  double worst;          /* as the host's binary64 sees it while measuring, as MPFR sees it in the end */
  uint64_t worst_number; /* in the sequence */
  uint32_t worst_operand[3];
  uint32_t special_operand[3]; /* of the first with special set */
  uint64_t special_number;
  double host; /* the host's greatest error where MPFR was asked, in units of binary64's last place */
};
void measure_chunk(const struct function *function, struct chunk *chunk, struct measured *into);
void measure_merge(struct measured *into, const struct measured *from);

#endif
