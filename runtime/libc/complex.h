/* Complex numbers: functions of float, double and long double, which is double. They are newlib's. */
#ifndef TRAX_COMPLEX_H
#define TRAX_COMPLEX_H

#define complex _Complex
#define _Complex_I (__extension__ 1.0iF)
#define I _Complex_I

#define CMPLX(x, y) __builtin_complex((double)(x), (double)(y))
#define CMPLXF(x, y) __builtin_complex((float)(x), (float)(y))
#define CMPLXL(x, y) __builtin_complex((long double)(x), (long double)(y))

#ifdef __cplusplus
extern "C" {
#endif

/* Each function has three forms: name, namef and namel. */
#define __TRAX_COMPLEX(name)                                                                                           \
  double _Complex name(double _Complex);                                                                               \
  float _Complex name##f(float _Complex);                                                                              \
  long double _Complex name##l(long double _Complex);
#define __TRAX_COMPLEX_REAL(name)                                                                                      \
  double name(double _Complex);                                                                                        \
  float name##f(float _Complex);                                                                                       \
  long double name##l(long double _Complex);

__TRAX_COMPLEX(cacos)
__TRAX_COMPLEX(casin)
__TRAX_COMPLEX(catan)
__TRAX_COMPLEX(ccos)
__TRAX_COMPLEX(csin)
__TRAX_COMPLEX(ctan)
__TRAX_COMPLEX(cacosh)
__TRAX_COMPLEX(casinh)
__TRAX_COMPLEX(catanh)
__TRAX_COMPLEX(ccosh)
__TRAX_COMPLEX(csinh)
__TRAX_COMPLEX(ctanh)
__TRAX_COMPLEX(cexp)
__TRAX_COMPLEX(clog)
__TRAX_COMPLEX(csqrt)
__TRAX_COMPLEX(conj)
__TRAX_COMPLEX(cproj)
__TRAX_COMPLEX_REAL(cabs)
__TRAX_COMPLEX_REAL(carg)
__TRAX_COMPLEX_REAL(cimag)
__TRAX_COMPLEX_REAL(creal)
double _Complex cpow(double _Complex, double _Complex);
float _Complex cpowf(float _Complex, float _Complex);
long double _Complex cpowl(long double _Complex, long double _Complex);

#undef __TRAX_COMPLEX
#undef __TRAX_COMPLEX_REAL

#ifdef __cplusplus
}
#endif

#endif
