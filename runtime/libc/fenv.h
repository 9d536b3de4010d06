/* The floating-point environment: numbers are rounded to nearest, and there are no exception flags. */
#ifndef TRAX_FENV_H
#define TRAX_FENV_H

#define FE_TONEAREST 0
#define FE_ALL_EXCEPT 0

#ifdef __cplusplus
extern "C" {
#endif

typedef int fenv_t;
typedef int fexcept_t;

extern const fenv_t __trax_default_environment;
#define FE_DFL_ENV (&__trax_default_environment)

/* 0 is success. Of exceptions only none can be asked for, of rounding modes only one. */
int feclearexcept(int exceptions);
int fegetexceptflag(fexcept_t *flags, int exceptions);
int feraiseexcept(int exceptions);
int fesetexceptflag(const fexcept_t *flags, int exceptions);
int fetestexcept(int exceptions);
int fegetround(void);
int fesetround(int mode);
int fegetenv(fenv_t *environment);
int feholdexcept(fenv_t *environment);
int fesetenv(const fenv_t *environment);
int feupdateenv(const fenv_t *environment);

#ifdef __cplusplus
}
#endif

#endif
