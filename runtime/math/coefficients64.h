/* Written by coefficients64.py, which says how; do not edit. */
#ifndef TRAX_RUNTIME_COEFFICIENTS64_H
#define TRAX_RUNTIME_COEFFICIENTS64_H

#include <stdint.h>

/* (2^(x/16) - 1) / x on [0, 1], times 2^64; error in 2^x 2^-64.5. */
static const uint64_t exp_coefficients[7] = {
    0xB17217F7D1CF79B, 0x3D7F7BFF058AD8, 0xE35846B82956, 0x276556DDD69, 0x5762043BF, 0xA17DC6E, 0x104CC6,
};

/* 2^(i/16) * 2^63 */
static const uint64_t exp_table[16] = {
    0x8000000000000000, 0x85AAC367CC487B14, 0x8B95C1E3EA8BD6E6, 0x91C3D373AB11C336,
    0x9837F0518DB8A96F, 0x9EF5326091A111AD, 0xA5FED6A9B15138EA, 0xAD583EEA42A14AC6,
    0xB504F333F9DE6484, 0xBD08A39F580C36BE, 0xC5672A115506DADD, 0xCE248C151F8480E3,
    0xD744FCCAD69D6AF4, 0xE0CCDEEC2A94E111, 0xEAC0C6E7DD24392E, 0xF5257D152486CC2C,
};

/* (atanh(s)/s - 1) / s^2 in s^2, |s| <= 3 - 2 sqrt 2, times 2^64; relative error in atanh 2^-64.8. */
static const uint64_t atanh_coefficients64[8] = {
    0x5555555555555542, 0x3333333333346F2A, 0x249249248ED99723, 0x1C71C72015917747,
    0x1745CF9048DD953D, 0x13B1C355A8F7A20F, 0x10FBE95D71601F94, 0x10C039C49989C5E0,
};

/* (sinh(r)/r - 1) / r^2 in r^2, |r| < 1, times 2^64; relative error in sinh 2^-71.7. */
static const uint64_t sinh_coefficients64[8] = {
    0x2AAAAAAAAAAAAAAA, 0x222222222222222, 0xD00D00D00D000, 0x2E3BC74AADF2, 0x6B99159E4A, 0xB09233E6, 0xD73BBE, 0xCCF8,
};

/* (1 - sin(r)/r) / r^2 in r^2, |r| <= pi/4, times 2^64, signs alternating from +; relative error in sin 2^-66.9. */
static const uint64_t sin_coefficients64[7] = {
    0x2AAAAAAAAAAAAAAA, 0x222222222222200, 0xD00D00D00CC9B, 0x2E3BC74A8C12, 0x6B991504B1, 0xB090BF85, 0xD58BEA,
};

/* (1 - cos r) / r^2 in r^2, |r| <= pi/4, times 2^64, signs alternating from +; error in cos 2^-73.8. */
static const uint64_t cos_coefficients64[8] = {
    0x7FFFFFFFFFFFFFFF, 0xAAAAAAAAAAAAAAA, 0x5B05B05B05B04E, 0x1A01A01A01959,
    0x49F93EDD9FA,      0x8F76C698A,       0xC9C9EA2,        0xD5850,
};

/* (1 - atan(s)/s) / s^2 in s^2, |s| <= 1/8, times 2^64, signs alternating from +; relative error in atan 2^-65.2. */
static const uint64_t atan_coefficients64[7] = {
    0x5555555555555538, 0x3333333333307443, 0x24924924874B5794, 0x1C71C70BEEEE437D,
    0x1745C5A1714AA02D, 0x13ACE00BB6092B56, 0x10445C632520D806,
};

/* atan(i/4) * 2^64 */
static const uint64_t atan_table[5] = {
    0x0000000000000000, 0x3EB6EBF25901BAC5, 0x76B19C1586ED3DA2, 0xA4BC7D1934F70924, 0xC90FDAA22168C234,
};

/* (1 - erf(x) sqrt(pi) / 2x) / x^2 in x^2, |x| < 1, times 2^64, signs alternating from +; relative error in erf
 * 2^-66.9. */
static const uint64_t erf_coefficients[13] = {
    0x5555555555555555, 0x1999999999999968, 0x618618618617B51, 0x12F684BDA120908, 0x31A6031A55903D,
    0x7007006B7DFD4,    0xDDEBBB5B5840,     0x1879FC6F434F,    0x26EE8251728,     0x385212FD6C,
    0x4A3D94B2C,        0x55C15BBE,         0x443409D,
};

/* (x + 3) erfc(x) e^(x^2) in t = 9/16 - 4/(x + 3), 1 <= x <= 28, times 2^62; error 2^-65.4. */
static const int64_t erfc_coefficients[23] = {
    0x3CC0DA477CCF478CLL, -0x451D5735CD7F8AE4LL, 0x4268D68F82336F6FLL, -0x3458AD0CAA2300AFLL, 0x1FEA572B1DF2F421LL,
    -0xCE6712F7572BF69LL, 0x135412A1ECE7532LL,   0x25C7366C314203FLL,  -0x1525D6F7666C479LL,  -0x34E93EBA1930F5LL,
    0x7942F617CDC34CLL,   -0x9DAFC509C05AELL,    -0x2A166BB7ACE853LL,  0x8A8B12189F6E0LL,     0x10760B6FE38BDELL,
    -0x3F06C8C034987LL,   -0x76C6D9752C543LL,    0x14C3155B20525LL,    0x3ACA72537C3C4LL,     -0x2E6659F22591LL,
    -0x1C1E0E88C88BBLL,   -0x13539D279307LL,     0x946993DA78A6LL,
};

/* lgamma(2 + t) / t in t, |t| <= 1/2, times 2^63; error 2^-66.6. */
static const int64_t lgamma_coefficients[21] = {
    0x361DCC0E41279C2DLL, 0x294699894C1F4C89LL, -0x89F000D2ABB0348LL, 0x2A264558FB09366LL, -0xF2027E10C7AE06LL,
    0x5EB75BAB6CB044LL,   -0x27158B857F15ECLL,  0x10B36AF88B2883LL,   -0x74FF531E4511DLL,  0x3424F5E8955EELL,
    -0x178DE5ABF176ALL,   0xAC07130090D2LL,     -0x4F2F363EFA10LL,    0x24B192CA3B7DLL,    -0x111A9AFB059ELL,
    0x80A315ACA27LL,      -0x3C7DAA4921CLL,     0x1B1A8C8BF04LL,      -0xCDBC76E3FDLL,     0x8AFF543996LL,
    -0x41E890DADELL,
};

/* x (lgamma(x) - (x - 1/2) ln x + x - ln(2 pi)/2) in 1/x^2, x >= 8, times 2^64, signs alternating from +; error
 * 2^-66.1. */
static const uint64_t stirling_coefficients[8] = {
    0x1555555555555555, 0xB60B60B60B5949, 0x34034033DC1B7B,  0x27026FD80E028D,
    0x3729EDACB24323,   0x7D7FCBF737C11E, 0x196DB40614B192C, 0x556CE9C6D9A8B60,
};

/* sin(pi f)/f in f^2, |f| <= 1/2, times 2^61, signs alternating from +; error 2^-69.8. */
static const uint64_t sin_pi_coefficients[10] = {
    0x6487ED5110B4611A, 0xA55DE7312DF295F3, 0x519AF19DD6AB865F, 0x132D2CCE62BD571B, 0x2A0F0690FD83334,
    0x3C60E9FB8A41D3,   0x3D1E8671C074C,    0x2DF5A9110A4C,     0x1AABBE3815E,      0xBF6A66B91,
};

/* 1/ln 2 - 1 * 2^96, words of 32 bits, the greatest first. */
static const uint32_t log2_e_less_1[3] = {0x71547652, 0xB82FE177, 0x7D0FFDA1};

/* ln 2 * 2^96, words of 32 bits, the greatest first. */
static const uint32_t ln2_long[3] = {0xB17217F7, 0xD1CF79AB, 0xC9E3B398};

/* sqrt 2 * 2^63 */
#define SQRT2_64 0xB504F333F9DE6484u

/* log10 e * 2^65 */
#define LOG10_E_64 0xDE5BD8A937287195u

/* 2/sqrt(pi) * 2^63 */
#define TWO_OVER_SQRT_PI_64 0x906EBA8214DB688Du

/* pi * 2^62 */
#define PI_Q62 0xC90FDAA22168C235u

/* ln pi * 2^63 */
#define LN_PI_64 0x928682473D0DE85Fu

/* ln(2 pi) / 2 * 2^64 */
#define LN_2PI_HALF_64 0xEB3F8E4325F5A535u

#endif
