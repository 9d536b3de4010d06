/* C23's functions of bits, for the unsigned types. */
#ifndef TRAX_STDBIT_H
#define TRAX_STDBIT_H

#define __STDC_VERSION_STDBIT_H__ 202311L
#define __STDC_ENDIAN_LITTLE__ __ORDER_LITTLE_ENDIAN__
#define __STDC_ENDIAN_BIG__ __ORDER_BIG_ENDIAN__
#define __STDC_ENDIAN_NATIVE__ __BYTE_ORDER__

#define __TRAX_BITS(x) (8u * (unsigned)sizeof(x))
#define __TRAX_FUNCTIONS(suffix, type)                                                                                 \
  static inline unsigned stdc_count_ones_##suffix(type x) {                                                            \
    return (unsigned)__builtin_popcountll(x);                                                                          \
  }                                                                                                                    \
  static inline unsigned stdc_count_zeros_##suffix(type x) {                                                           \
    return __TRAX_BITS(x) - stdc_count_ones_##suffix(x);                                                               \
  }                                                                                                                    \
  static inline unsigned stdc_leading_zeros_##suffix(type x) {                                                         \
    return x ? (unsigned)__builtin_clzll(x) - (64 - __TRAX_BITS(x)) : __TRAX_BITS(x);                                  \
  }                                                                                                                    \
  static inline unsigned stdc_leading_ones_##suffix(type x) {                                                          \
    return stdc_leading_zeros_##suffix((type)~x);                                                                      \
  }                                                                                                                    \
  static inline unsigned stdc_trailing_zeros_##suffix(type x) {                                                        \
    return x ? (unsigned)__builtin_ctzll(x) : __TRAX_BITS(x);                                                          \
  }                                                                                                                    \
  static inline unsigned stdc_trailing_ones_##suffix(type x) {                                                         \
    return stdc_trailing_zeros_##suffix((type)~x);                                                                     \
  }                                                                                                                    \
  static inline unsigned stdc_first_leading_one_##suffix(type x) {                                                     \
    return x ? stdc_leading_zeros_##suffix(x) + 1 : 0;                                                                 \
  }                                                                                                                    \
  static inline unsigned stdc_first_leading_zero_##suffix(type x) {                                                    \
    return stdc_first_leading_one_##suffix((type)~x);                                                                  \
  }                                                                                                                    \
  static inline unsigned stdc_first_trailing_one_##suffix(type x) {                                                    \
    return x ? stdc_trailing_zeros_##suffix(x) + 1 : 0;                                                                \
  }                                                                                                                    \
  static inline unsigned stdc_first_trailing_zero_##suffix(type x) {                                                   \
    return stdc_first_trailing_one_##suffix((type)~x);                                                                 \
  }                                                                                                                    \
  static inline int stdc_has_single_bit_##suffix(type x) {                                                             \
    return x && !(x & (type)(x - 1));                                                                                  \
  }                                                                                                                    \
  static inline unsigned stdc_bit_width_##suffix(type x) {                                                             \
    return __TRAX_BITS(x) - stdc_leading_zeros_##suffix(x);                                                            \
  }                                                                                                                    \
  static inline type stdc_bit_floor_##suffix(type x) {                                                                 \
    return x ? (type)((type)1 << (stdc_bit_width_##suffix(x) - 1)) : 0;                                                \
  }                                                                                                                    \
  static inline type stdc_bit_ceil_##suffix(type x) {                                                                  \
    return x <= 1 ? 1 : (type)((type)2 << (stdc_bit_width_##suffix((type)(x - 1)) - 1));                               \
  }
__TRAX_FUNCTIONS(uc, unsigned char)
__TRAX_FUNCTIONS(us, unsigned short)
__TRAX_FUNCTIONS(ui, unsigned)
__TRAX_FUNCTIONS(ul, unsigned long)
__TRAX_FUNCTIONS(ull, unsigned long long)
#undef __TRAX_FUNCTIONS

#ifndef __cplusplus
#define __TRAX_GENERIC(name, x)                                                                                        \
  _Generic((x),                                                                                                        \
      unsigned char: name##_uc,                                                                                        \
      unsigned short: name##_us,                                                                                       \
      unsigned: name##_ui,                                                                                             \
      unsigned long: name##_ul,                                                                                        \
      unsigned long long: name##_ull)(x)
#define stdc_count_ones(x) __TRAX_GENERIC(stdc_count_ones, x)
#define stdc_count_zeros(x) __TRAX_GENERIC(stdc_count_zeros, x)
#define stdc_leading_zeros(x) __TRAX_GENERIC(stdc_leading_zeros, x)
#define stdc_leading_ones(x) __TRAX_GENERIC(stdc_leading_ones, x)
#define stdc_trailing_zeros(x) __TRAX_GENERIC(stdc_trailing_zeros, x)
#define stdc_trailing_ones(x) __TRAX_GENERIC(stdc_trailing_ones, x)
#define stdc_first_leading_one(x) __TRAX_GENERIC(stdc_first_leading_one, x)
#define stdc_first_leading_zero(x) __TRAX_GENERIC(stdc_first_leading_zero, x)
#define stdc_first_trailing_one(x) __TRAX_GENERIC(stdc_first_trailing_one, x)
#define stdc_first_trailing_zero(x) __TRAX_GENERIC(stdc_first_trailing_zero, x)
#define stdc_has_single_bit(x) __TRAX_GENERIC(stdc_has_single_bit, x)
#define stdc_bit_width(x) __TRAX_GENERIC(stdc_bit_width, x)
#define stdc_bit_floor(x) __TRAX_GENERIC(stdc_bit_floor, x)
#define stdc_bit_ceil(x) __TRAX_GENERIC(stdc_bit_ceil, x)
#endif

#endif
