/* The greatest errors of the binary64 functions: which functions, which operands, and what an error is. */
#ifndef TRAX_WORST_H
#define TRAX_WORST_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <mpfr.h>

/* The interval of |x| where a function has something to compute, and where its implementation changes its way. */
struct function {
  const char *name;
  double (*ours_1)(double);
  double (*ours_2)(double, double);
  int (*exact_1)(mpfr_t, const mpfr_t, mpfr_rnd_t);
  int (*exact_2)(mpfr_t, const mpfr_t, const mpfr_t, mpfr_rnd_t);
  long double (*near_1)(long double);
  long double (*near_2)(long double, long double);
  enum { BOTH_SIGNS, POSITIVE, NEGATIVE } signs;
  double low, high;       /* of |x|, for operands whose logarithm is uniform */
  double from, to;        /* of x, for operands that are uniform */
  double least_unit;      /* a unit of the error is that of this magnitude at least; 0: of the result */
  double breakpoints[12]; /* ended by 0 */
};

extern const struct function functions[];
extern const size_t function_count;

struct operand {
  double x, y;
};

/* In units in the last place of the true result, which MPFR computes; INFINITY for a wrong NaN, infinity or sign of
   infinity. An infinite result counts as 2^1024. */
double exact_error(const struct function *f, struct operand o);
/* The same from the host's long double: nearly as good, and fast. */
double near_error(const struct function *f, struct operand o);

/* The error from MPFR where it is greater than interesting, or control; else from long double. *failed becomes true if
   they differ. */
double error_of(const struct function *f, struct operand o, double interesting, bool control, bool *failed);
/* False for signalling NaNs, which C leaves open, and for arguments that another entry has. */
bool is_defined(const struct function *f, struct operand o);

/* An operand of any kind, from random bits. */
struct operand new_operand(const struct function *f, uint64_t *state);
/* An operand near this one. */
struct operand neighbour(const struct function *f, struct operand o, uint64_t *state);

/* The worst operands of a function in a file of lines as the search prints them, the very worst first. */
enum { MOST_FOUND = 16 };
struct found {
  size_t count;
  double error[MOST_FOUND];
  struct operand operand[MOST_FOUND];
};
bool read_found(const char *path, const char *function, struct found *found);

/* x from the doubles below 2^1024 that are closest to multiples of pi/2, one or two for each exponent. */
double near_quarter_turn(uint64_t *state);

#endif
