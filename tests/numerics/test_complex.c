/* The complex functions, compiled for the host, against the host's in long double.

   The error is the distance in the plane, in units in the last place of the true value's magnitude; newlib's functions
   lose digits where parts cancel (docs/runtime.md). Exits with status 1 if a function exceeds its bound. */
#include <complex.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>

#include "host.h"
#include "operands.h"

/* Name, and bounds of double and float. */
#define FUNCTIONS(X)                                                                                                   \
  X(cacos, 55, 51)                                                                                                     \
  X(casin, 68, 64)                                                                                                     \
  X(catan, 23, 29)                                                                                                     \
  X(ccos, 2.3, 2.2)                                                                                                    \
  X(csin, 2.6, 2.5)                                                                                                    \
  X(ctan, 4.3, 4.1)                                                                                                    \
  X(cacosh, 3.8, 3.7)                                                                                                  \
  X(casinh, 75, 77)                                                                                                    \
  X(catanh, 20, 36)                                                                                                    \
  X(ccosh, 2, 2)                                                                                                       \
  X(csinh, 2.2, 2.2)                                                                                                   \
  X(ctanh, 930, 1290)                                                                                                  \
  X(cexp, 1.6, 1.5)                                                                                                    \
  X(clog, 17, 24)                                                                                                      \
  X(csqrt, 1.6, 1.5)                                                                                                   \
  X(conj, 0, 0)                                                                                                        \
  X(cproj, 0, 0)                                                                                                       \
  X(cabs, 0.9, 0.51)                                                                                                   \
  X(carg, 1.3, 0.51)                                                                                                   \
  X(creal, 0, 0)                                                                                                       \
  X(cimag, 0, 0)

#define DECLARE(name, of_float, of_double) RUNTIME_FUNCTION(name) RUNTIME_FUNCTION(name##f)
FUNCTIONS(DECLARE)
DECLARE(cpow, , )

static bool failed;

static double uniform(uint64_t *state) {
  return (double)(int64_t)random64(state) * 0x1p-63;
}

/* A number of either sign, from 2^-6 to 2^3 in magnitude. */
static float part(uint64_t *state) {
  double x = uniform(state);
  return (float)ldexp(x < 0 ? x - 1 : x + 1, (int)(random64(state) % 9) - 6);
}

static double distance(double complex got, long double complex want, int digits) {
  long double difference = cabsl((long double complex)got - want);
  return difference == 0 ? 0 : (double)(difference / ldexpl(1, ilogbl(cabsl(want)) - digits));
}

static void report(const char *name, double worst, double complex at, double bound) {
  bool bad = !(worst <= bound);
  failed |= bad;
  printf("%-8s %9.3f ulp, bound %6.2f, worst at %a, %a%s\n", name, worst, bound, creal(at), cimag(at),
         bad ? "  FAILED" : "");
}

struct greatest {
  double error;
  double complex at;
};

static void note(struct greatest *greatest, double error, double complex at) {
  if (!(error <= greatest->error))
    *greatest = (struct greatest){error, at};
}

/* Arguments: (x), or (x, y). */
#define CHECK(name, bound, bound_f, arguments)                                                                         \
  {                                                                                                                    \
    uint64_t state = 31, other = 32;                                                                                   \
    struct greatest worst = {0}, worst_f = {0};                                                                        \
    for (int i = 0; i < 20000; i++) {                                                                                  \
      const float complex x = __builtin_complex(part(&state), part(&state));                                           \
      const float complex y = __builtin_complex((float)uniform(&other), (float)uniform(&other));                       \
      (void)y;                                                                                                         \
      const long double complex want = name##l arguments;                                                              \
      note(&worst, distance(rt_##name arguments, want, 52), x);                                                        \
      note(&worst_f, distance((double complex)rt_##name##f arguments, want, 23), x);                                   \
    }                                                                                                                  \
    report(#name, worst.error, worst.at, bound);                                                                       \
    report(#name "f", worst_f.error, worst_f.at, bound_f);                                                             \
  }
#define CHECK_ONE(name, bound, bound_f) CHECK(name, bound, bound_f, (x))

int main(void) {
  FUNCTIONS(CHECK_ONE)
  CHECK(cpow, 8.2, 7.3, (x, y))
  /* On the unit circle, where newlib 3.3.0 saw a pole. */
  for (int sign = -1; sign <= 1; sign += 2) {
    report("catan", distance(rt_catan(sign), catanl(sign), 52), sign, 1);
    report("catanf", distance((double complex)rt_catanf((float)sign), catanl(sign), 23), sign, 1);
  }
  return failed;
}
