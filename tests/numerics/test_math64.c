/* The binary64 functions, compiled for the host, at their worst.

     test-math64 found.csv               100,000 operands of each function, the worst ones known, and special values
     test-math64 found.csv 1000000 sin   more, of one function

   The file is what worst/worst.py keeps of the search for the greatest errors: every operand in it must have the error
   that it says, and no operand a greater one. The compiled arithmetic is the host's, which is as exact as the TP's:
   sweep.py has the TP compute the same bits. Exits with status 1 if a function exceeds the greatest error found or a
   special value is not what annex F of C17 asks for. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "operands.h"
#include "worst/worst.h"

static bool failed;
enum { MOST_REPORTED = 10 }; /* operands of each function */
static int reported;

/* Annex F: a special argument and its value; the sign of zeros counts. */
static const struct {
  const char *name;
  double x, y, want;
} specials[] = {
#define ODD(name) {#name, 0.0, 0, 0.0}, {#name, -0.0, 0, -0.0}
#define INFINITE(name, below, above)                                                                                   \
  {#name, -INFINITY, 0, below}, {                                                                                      \
    #name, INFINITY, 0, above                                                                                          \
  }
    ODD(sin),
    INFINITE(sin, NAN, NAN),
    ODD(tan),
    INFINITE(tan, NAN, NAN),
    INFINITE(cos, NAN, NAN),
    {"cos", -0.0, 0, 1},
    ODD(asin),
    INFINITE(asin, NAN, NAN),
    {"asin", 1.5, 0, NAN},
    {"acos", 1, 0, 0.0},
    {"acos", -1.5, 0, NAN},
    INFINITE(acos, NAN, NAN),
    ODD(atan),
    ODD(sinh),
    INFINITE(sinh, -INFINITY, INFINITY),
    {"cosh", -0.0, 0, 1},
    INFINITE(cosh, INFINITY, INFINITY),
    ODD(tanh),
    INFINITE(tanh, -1, 1),
    ODD(asinh),
    INFINITE(asinh, -INFINITY, INFINITY),
    {"acosh", 1, 0, 0.0},
    {"acosh", 0.5, 0, NAN},
    INFINITE(acosh, NAN, INFINITY),
    ODD(atanh),
    {"atanh", 1, 0, INFINITY},
    {"atanh", -1, 0, -INFINITY},
    {"atanh", 1.5, 0, NAN},
    {"exp", -0.0, 0, 1},
    INFINITE(exp, 0.0, INFINITY),
    {"exp2", -0.0, 0, 1},
    INFINITE(exp2, 0.0, INFINITY),
    ODD(expm1),
    INFINITE(expm1, -1, INFINITY),
    {"log", 0.0, 0, -INFINITY},
    {"log", -0.0, 0, -INFINITY},
    {"log", 1, 0, 0.0},
    INFINITE(log, NAN, INFINITY),
    {"log2", -0.0, 0, -INFINITY},
    {"log2", 1, 0, 0.0},
    INFINITE(log2, NAN, INFINITY),
    {"log10", -0.0, 0, -INFINITY},
    {"log10", 1, 0, 0.0},
    INFINITE(log10, NAN, INFINITY),
    ODD(log1p),
    {"log1p", -1, 0, -INFINITY},
    {"log1p", -2, 0, NAN},
    INFINITE(log1p, NAN, INFINITY),
    ODD(cbrt),
    INFINITE(cbrt, -INFINITY, INFINITY),
    ODD(erf),
    INFINITE(erf, -1, 1),
    INFINITE(erfc, 2, 0.0),
    {"tgamma", 0.0, 0, INFINITY},
    {"tgamma", -0.0, 0, -INFINITY},
    {"tgamma", -2, 0, NAN},
    INFINITE(tgamma, NAN, INFINITY),
    {"lgamma", 1, 0, 0.0},
    {"lgamma", 2, 0, 0.0},
    {"lgamma", -3, 0, INFINITY},
    {"lgamma", -0.0, 0, INFINITY},
    INFINITE(lgamma, INFINITY, INFINITY),
    {"atan2", 0.0, -0.0, 0x1.921FB54442D18p1},
    {"atan2", -0.0, -0.0, -0x1.921FB54442D18p1},
    {"atan2", -0.0, 0.0, -0.0},
    {"atan2", 0.0, -1, 0x1.921FB54442D18p1},
    {"atan2", -0.0, 1, -0.0},
    {"atan2", 1, -0.0, 0x1.921FB54442D18p0},
    {"atan2", 1, INFINITY, 0.0},
    {"atan2", -1, -INFINITY, -0x1.921FB54442D18p1},
    {"atan2", INFINITY, 1, 0x1.921FB54442D18p0},
    {"atan2", INFINITY, -INFINITY, 0x1.2D97C7F3321D2p1},
    {"atan2", -INFINITY, INFINITY, -0x1.921FB54442D18p-1},
    {"atan2", NAN, 1, NAN},
    {"hypot", INFINITY, NAN, INFINITY},
    {"hypot", NAN, -INFINITY, INFINITY},
    {"hypot", -0.0, -3, 3},
    {"hypot", NAN, 1, NAN},
    {"pow", 0.0, -3, INFINITY},
    {"pow", -0.0, -3, -INFINITY},
    {"pow", -0.0, -2, INFINITY},
    {"pow", -0.0, -2.5, INFINITY},
    {"pow", -0.0, -INFINITY, INFINITY},
    {"pow", -0.0, 3, -0.0},
    {"pow", -0.0, 2, 0.0},
    {"pow", -1, INFINITY, 1},
    {"pow", -1, -INFINITY, 1},
    {"pow", 1, NAN, 1},
    {"pow", NAN, 0, 1},
    {"pow", NAN, -0.0, 1},
    {"pow", -2, 0.5, NAN},
    {"pow", 0.5, -INFINITY, INFINITY},
    {"pow", -2, -INFINITY, 0.0},
    {"pow", 0.5, INFINITY, 0.0},
    {"pow", 2, INFINITY, INFINITY},
    {"pow", -INFINITY, -3, -0.0},
    {"pow", -INFINITY, -2, 0.0},
    {"pow", -INFINITY, 3, -INFINITY},
    {"pow", -INFINITY, 2, INFINITY},
    {"pow", INFINITY, -1, 0.0},
    {"pow", INFINITY, 1, INFINITY},
    {"pow", NAN, 1, NAN},
    {"pow", 2, NAN, NAN},
};

static void check_specials(const struct function *f) {
  for (size_t i = 0; i < COUNT(specials); i++) {
    if (strcmp(specials[i].name, f->name))
      continue;
    double want = specials[i].want;
    double got = f->ours_1 ? f->ours_1(specials[i].x) : f->ours_2(specials[i].x, specials[i].y);
    if (want != want ? got == got : bits_of(got) != bits_of(want)) {
      failed = true;
      printf("%s(%a, %a) is %a, but has to be %a  FAILED\n", f->name, specials[i].x, specials[i].y, got, want);
    }
  }
  double of_nan = f->ours_1 ? f->ours_1(NAN) : f->ours_2(NAN, 2);
  if (of_nan == of_nan) {
    failed = true;
    printf("%s of a NaN is %a  FAILED\n", f->name, of_nan);
  }
}

static void check(const struct function *f, struct operand o, double bound, bool exact, double *worst) {
  double error = exact ? exact_error(f, o) : error_of(f, o, bound, false, &failed);
  if (!(error <= *worst))
    *worst = error;
  if (error <= bound)
    return;
  failed = true;
  if (reported++ < MOST_REPORTED)
    printf("%s(%a, %a) has an error of %.4f, greatest known %.4f  FAILED\n", f->name, o.x, o.y, error, bound);
}

static void check_function(const struct function *f, const struct found *found, uint64_t count) {
  double bound = found->error[0] + 0.00005, worst = 0; /* the file has four digits */
  reported = 0;
  for (size_t i = 0; i < found->count; i++) {
    double error = exact_error(f, found->operand[i]);
    if (fabs(error - found->error[i]) > 0.00005001) {
      failed = true;
      printf("%s(%a, %a) has an error of %.4f, not %.4f as listed  FAILED\n", f->name, found->operand[i].x,
             found->operand[i].y, error, found->error[i]);
    }
  }
  for (size_t i = 0; i < 2 * COUNT(special_doubles); i++)
    for (size_t j = 0; j < (f->ours_2 ? 2 * COUNT(special_doubles) : 1); j++) {
      struct operand o = {double_of(special_doubles[i / 2] | (uint64_t)(i & 1) << 63),
                          double_of(special_doubles[j / 2] | (uint64_t)(j & 1) << 63)};
      if (is_defined(f, o))
        check(f, o, bound, true, &worst);
    }
  uint64_t state = 21;
  for (uint64_t i = 0; i < count; i++)
    check(f, new_operand(f, &state), bound, false, &worst);
  printf("%-9s %.4f ulp, greatest known %.4f\n", f->name, worst, found->count ? found->error[0] : 0);
  check_specials(f);
}

int main(int argc, char **argv) {
  long count = argc > 2 ? strtol(argv[2], NULL, 0) : 100000;
  const char *only = argc > 3 ? argv[3] : NULL;
  if (argc < 2 || count <= 0) {
    fprintf(stderr, "usage: test-math64 FOUND.csv [COUNT [FUNCTION]]\n");
    return 1;
  }
  for (size_t i = 0; i < function_count; i++) {
    if (only && strcmp(only, functions[i].name))
      continue;
    struct found found;
    if (!read_found(argv[1], functions[i].name, &found)) {
      fprintf(stderr, "test-math64: %s has no line of %s\n", argv[1], functions[i].name);
      return 1;
    }
    check_function(&functions[i], &found, (uint64_t)count);
  }
  return failed;
}
