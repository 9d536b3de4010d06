/* Written by coefficients.py, which says how; do not edit. */
#ifndef TRAX_RUNTIME_COEFFICIENTS_H
#define TRAX_RUNTIME_COEFFICIENTS_H

#include <stdint.h>

/* (2^x - 1) / x on [0, 1], times 2^32; error in 2^x 2^-37.7. */
static const uint32_t exp2_coefficients[8] = {
    0xB17217F8, 0x3D7F7C01, 0x0E35843C, 0x027656E6, 0x00575C45, 0x000A2454, 0x0000F206, 0x00001E45,
};

/* (1 - sin(r)/r) / r^2 in r^2, |r| <= pi/4, times 2^34, signs alternating from +; relative error in sin 2^-35.8. */
static const uint32_t sin_coefficients[4] = {
    0xAAAAAAAA,
    0x0888886F,
    0x00340275,
    0x0000B6DF,
};

/* (1 - cos r) / r^2 in r^2, |r| <= pi/4, times 2^32, signs alternating from +; error in cos 2^-42.0. */
static const uint32_t cos_coefficients[5] = {
    0x80000000, 0x0AAAAAAB, 0x005B05AF, 0x0001A013, 0x00000492,
};

/* (1 - atan(t)/t) / t^2 in t^2, |t| <= tan(pi/8), times 2^33, signs alternating from +; relative error in atan 2^-38.4.
 */
static const uint32_t atan_coefficients[7] = {
    0xAAAAAAAB, 0x66666609, 0x49247023, 0x38DED0E7, 0x2E3A7821, 0x248869D1, 0x14B38920,
};

/* (sinh(r)/r - 1) / r^2 in r^2, |r| < 1, times 2^34; relative error in sinh 2^-41.5. */
static const uint32_t sinh_coefficients[5] = {
    0xAAAAAAAB, 0x08888888, 0x00340342, 0x0000B8E9, 0x000001B5,
};

/* (cosh r - 1) / r^2 in r^2, |r| < 1, times 2^32; error in cosh 2^-37.8. */
static const uint32_t cosh_coefficients[5] = {
    0x80000000, 0x0AAAAAAA, 0x005B05B7, 0x0001A006, 0x000004B6,
};

/* (1 - tanh(r)/r) / r^2 in r^2, |r| < 1/2, times 2^33, signs alternating from +; relative error in tanh 2^-35.0. */
static const uint32_t tanh_coefficients[6] = {
    0xAAAAAAAA, 0x44444304, 0x1BA17F37, 0x0B2E7DEF, 0x046A144F, 0x015F3D3D,
};

/* (1 - asinh(s)/s) / s^2 in s^2, |s| < 1/2, times 2^34, signs alternating from +; relative error in asinh 2^-36.7. */
static const uint32_t asinh_coefficients[7] = {
    0xAAAAAAAA, 0x4CCCCBA7, 0x2DB6913D, 0x1F155634, 0x169452A8, 0x0FB201C0, 0x07550C23,
};

/* (atanh(x)/x - 1) / x^2 in x^2, |x| < 1/2, times 2^33; relative error in atanh 2^-35.4. */
static const uint32_t atanh_coefficients[8] = {
    0xAAAAAAAA, 0x6666678B, 0x49243349, 0x38EF38E6, 0x2DD9A0DD, 0x2D09E273, 0x09904774, 0x50E4BCF8,
};

/* -(log2(1 + r) - r/ln 2) / r^2, |r| < 2^-5.9, times 2^31, signs alternating from +; error in log2 2^-54.6. */
static const uint32_t log2_coefficients[6] = {
    0x5C551D95, 0x3D8E13B8, 0x2E2A8EB9, 0x24EED893, 0x1EC98665, 0x1A63ABFA,
};

/* c[i] near 512 * 32 / (32 + i), and -log2(c[i] / 512) * 2^55: log2 m = -log2 c + log2(m c), and the product with the
   nearest c is 1 + r with |r| < 2^-6.0. */
static const uint16_t log2_reciprocal[33] = {
    512, 496, 482, 468, 455, 443, 431, 420, 410, 400, 390, 381, 372, 364, 356, 349, 341,
    334, 328, 321, 315, 309, 303, 298, 293, 287, 282, 278, 273, 269, 264, 260, 256,
};
static const uint64_t log2_of_reciprocal[33] = {
    0x0000000000000000, 0x0005DCE532765635, 0x000B2671360338AB, 0x001097E38CE60649, 0x0015CBA53A0762ED,
    0x001ABB2CA9EC7472, 0x001FCD677E5AC81D, 0x0024939A56279AD9, 0x002906CBCD2BAF2D, 0x002D961ED0CB91D4,
    0x003243001249BA77, 0x003692BA9D230BEF, 0x003AFCD815786AF2, 0x003F0095D1A19A03, 0x00431B2ABC31565C,
    0x0046C5FA126B7098, 0x004B0E3D72108217, 0x004EE2C71A3E9BB5, 0x00523BBC64C5E643, 0x0056378EFE2E092C,
    0x0059B38D3929AF95, 0x005D40B31289EE01, 0x0060DFACC6DF70D9, 0x0063F2493226B212, 0x0067123517CAD494,
    0x006AE4546F85A376, 0x006E232E68AAD485, 0x0070C689F7402D27, 0x00742088B4A3AEBF, 0x0076DA5240F652E2,
    0x007A514B229C409E, 0x007D230D2F47A5BB, 0x0080000000000000,
};

/* 1 / gamma(3/2 + t) in t, |t| <= 1/2, times 2^62; error 2^-68.6. */
static const int64_t gamma_inverse_coefficients[18] = {
    0x48375D410A6DB447LL, -0x2A29A7B20B09670LL, -0x21B4B4CE38091423LL, 0xB34DF20D49C4A50LL, 0x3430A817C6597A1LL,
    -0x2B2AB9872E4949ALL, 0x6C5880F978625FLL,   0x22BEFE0C1FFD2ALL,    -0x1232BD87871293LL, 0x27F08BFE65E2CLL,
    0x6A58F141ED01LL,     -0x3A4994D39F5ALL,    0x90B37607CB9LL,       0x3E36DD406ALL,      -0x5FC02EA9A7LL,
    0x125E817D18LL,       -0xE8F7787ALL,        -0x4C1FA3DELL,
};

/* 2/pi in words of 32 bits, the first of them zero. */
static const uint32_t two_over_pi[8] = {
    0x00000000, 0xA2F9836E, 0x4E441529, 0xFC2757D1, 0xF534DDC0, 0xDB629599, 0x3C439041, 0xFE5163AB,
};

/* 2/pi for binary64: two words of zeros and 38 of digits. */
static const uint32_t two_over_pi_long[40] = {
    0x00000000, 0x00000000, 0xA2F9836E, 0x4E441529, 0xFC2757D1, 0xF534DDC0, 0xDB629599, 0x3C439041,
    0xFE5163AB, 0xDEBBC561, 0xB7246E3A, 0x424DD2E0, 0x06492EEA, 0x09D1921C, 0xFE1DEB1C, 0xB129A73E,
    0xE88235F5, 0x2EBB4484, 0xE99C7026, 0xB45F7E41, 0x3991D639, 0x835339F4, 0x9C845F8B, 0xBDF9283B,
    0x1FF897FF, 0xDE05980F, 0xEF2F118B, 0x5A0A6D1F, 0x6D367ECF, 0x27CB09B7, 0x4F463F66, 0x9E5FEA2D,
    0x7527BAC7, 0xEBE5F17B, 0x3D0739F7, 0x8A5292EA, 0x6BFB5FB1, 0x1F8D5D08, 0x56033046, 0xFC7B6BAB,
};

/* pi/4 in words of 32 bits. */
static const uint32_t pi_over_4[3] = {0xC90FDAA2, 0x2168C234, 0xC4C6628B};

/* pi/4 * 2^32 */
#define PI_OVER_4 0xC90FDAA2u

/* pi * 2^62 */
#define PI_64 0xC90FDAA22168C235u

/* 1/ln 2 * 2^63 */
#define LOG2_E 0xB8AA3B295C17F0BCu

/* 1/ln 2 - 1 * 2^32 */
#define LOG2_E_LESS_1 0x71547653u

/* ln 2 * 2^64 */
#define LN_2 0xB17217F7D1CF79ACu

/* log10 2 * 2^65 */
#define LOG10_2 0x9A209A84FBCFF799u

#endif
