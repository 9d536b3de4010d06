#!/usr/bin/env python3
"""Writes coefficients64.h: the polynomials and tables of the binary64 functions that compute with 64-bit integers.

Made as coefficients.py, which has what both share:  ./coefficients64.py | clang-format-19 > coefficients64.h
"""

from decimal import localcontext

from coefficients import (BERNOULLI, LN2, PI, D, atan_tail, atanh_tail, chebyshev, cos_tail, gamma_inverse,
                          greatest_error, log2_text)
from coefficients import series, sin_tail, sinh_tail


def exp_tail(x):
    """(2^(x/16) - 1) / x"""
    return series(LN2 / 16, lambda k: LN2 / 16 / (k + 1), x)


def erf_tail(z):
    """(1 - erf(x) sqrt(pi) / 2x) / z for z = x^2"""
    total, power, k = D(0), D(1), 1
    while abs(power) > D(10) ** -62:
        power /= k
        total += power / (2 * k + 1)
        power *= -z
        k += 1
        if z == 0:
            break
    return total


def erfc_scaled(t):
    """(x + 3) erfc(x) e^(x^2) for t = 9/16 - 4/(x + 3), by erfc's continued fraction"""
    with localcontext() as context:
        context.prec = 60
        x = 4 / (D(9) / 16 - t) - 3
        value = x
        for k in range(1500, 0, -1):
            value = x + k / (2 * value)
        return (x + 3) / (value * PI.sqrt())


def lgamma_tail(t):
    """lgamma(2 + t) / t"""
    t = t if abs(t) > D(10) ** -20 else D(10) ** -20
    with localcontext() as context:
        context.prec = 100
        return -gamma_inverse(t + D("0.5")).ln() / t


def stirling(y):
    """x (lgamma(x) - (x - 1/2) ln x + x - ln(2 pi) / 2) for y = 1/x^2: the logarithm moved up by 60, where the series
    is exact"""
    def direct(x):
        total = D(0)
        for k in range(1, 21):
            total += D(BERNOULLI[2 * k].numerator) / BERNOULLI[2 * k].denominator / (2 * k *
                                                                                     (2 * k - 1)) / x**(2 * k - 2)
        return total

    with localcontext() as context:
        context.prec = 80
        if y < D(1) / 1600:
            return direct(1 / y.sqrt()) if y else D(1) / 12
        x = 1 / y.sqrt()
        up = x + 60
        log_gamma = (up - D("0.5")) * up.ln() - up + direct(up) / up
        for i in range(60):
            log_gamma -= (x + i).ln()
        return x * (log_gamma - (x - D("0.5")) * x.ln() + x)


def sin_pi(z):
    """sin(pi f) / f for z = f^2"""
    return series(PI, lambda k: -PI * PI / ((2 * k) * (2 * k + 1)), z)


def emit(name, what, function, low, high, degree, bits, weight, weighted, signs="unsigned"):
    """signs: unsigned, alternating (from +) or signed."""
    coefficients = chebyshev(function, low, high, degree)
    error = greatest_error(function, coefficients, low, high, weight)
    values = [int(((c * (-1) ** i) if signs == "alternating" else c) * D(2) ** bits) for i,
              c in enumerate(coefficients)]
    assert signs == "signed" or all(0 <= v < 2**64 for v in values), name
    assert signs != "signed" or all(abs(v) < 2**63 for v in values), name
    print(
        f"/* {what}, times 2^{bits}{', signs alternating from +' if signs == 'alternating' else ''}; {weighted} "
        f"{log2_text(error)}. */"
    )
    print(f"static const {'' if signs == 'signed' else 'u'}int64_t {name}[{degree + 1}] = {{")
    for i in range(0, len(values), 4):
        print("    " + ", ".join(f"{'-' if v < 0 else ''}0x{abs(v):X}{'' if v >= 0 and signs != 'signed' else 'LL'}"
                                 for v in values[i:i + 4]) + ",")
    print("};\n")


def emit_words(name, what, values):
    print(f"/* {what} */")
    print(f"static const uint64_t {name}[{len(values)}] = {{")
    for i in range(0, len(values), 4):
        print("    " + ", ".join(f"0x{int(v):016X}" for v in values[i : i + 4]) + ",")
    print("};\n")


def emit_constant(name, what, value, bits, count):
    words = int(value * D(2) ** bits + D("0.5"))
    print(f"/* {what} * 2^{bits}, words of 32 bits, the greatest first. */")
    print(f"static const uint32_t {name}[{count}] = {{" +
          ", ".join(f"0x{words >> (32 * (count - 1 - i)) & 0xFFFFFFFF:08X}" for i in range(count)) + "};\n")


def emit_number(name, what, value, bits):
    print(f"/* {what} * 2^{bits} */")
    print(f"#define {name} 0x{int(value * D(2) ** bits + D('0.5')):X}u\n")


def main():
    print("/* Written by coefficients64.py, which says how; do not edit. */")
    print("#ifndef TRAX_RUNTIME_COEFFICIENTS64_H\n#define TRAX_RUNTIME_COEFFICIENTS64_H\n\n#include <stdint.h>\n")

    def one(x):
        return D(1)

    def identity(x):
        return x

    emit("exp_coefficients", "(2^(x/16) - 1) / x on [0, 1]", exp_tail, 0, 1, 6, 64, identity, "error in 2^x")
    emit_words("exp_table", "2^(i/16) * 2^63", [(LN2 * i / 16).exp() * D(2) ** 63 for i in range(16)])
    atanh_limit = (3 - 2 * D(2).sqrt()) ** 2
    emit("atanh_coefficients64", "(atanh(s)/s - 1) / s^2 in s^2, |s| <= 3 - 2 sqrt 2", atanh_tail, 0, atanh_limit, 7,
         64, identity,
         "relative error in atanh")
    emit("sinh_coefficients64", "(sinh(r)/r - 1) / r^2 in r^2, |r| < 1", sinh_tail, 0, 1, 7, 64, identity,
         "relative error in sinh")
    square_limit = (PI / 4) ** 2
    emit("sin_coefficients64", "(1 - sin(r)/r) / r^2 in r^2, |r| <= pi/4", sin_tail, 0, square_limit, 6, 64, identity,
         "relative error in sin",
         "alternating")
    emit("cos_coefficients64", "(1 - cos r) / r^2 in r^2, |r| <= pi/4", cos_tail, 0, square_limit, 7, 64, identity,
         "error in cos", "alternating")
    emit("atan_coefficients64", "(1 - atan(s)/s) / s^2 in s^2, |s| <= 1/8", atan_tail, 0, D(1) / 64, 6, 64, identity,
         "relative error in atan",
         "alternating")
    emit_words("atan_table", "atan(i/4) * 2^64", [int(atan_of(D(i) / 4) * D(2) ** 64) for i in range(5)])
    emit("erf_coefficients", "(1 - erf(x) sqrt(pi) / 2x) / x^2 in x^2, |x| < 1", erf_tail, 0, 1, 12, 64, identity,
         "relative error in erf",
         "alternating")
    emit("erfc_coefficients", "(x + 3) erfc(x) e^(x^2) in t = 9/16 - 4/(x + 3), 1 <= x <= 28", erfc_scaled,
         D("-0.4375"), D("0.4335"), 22, 62, one,
         "error", "signed")
    emit("lgamma_coefficients", "lgamma(2 + t) / t in t, |t| <= 1/2", lgamma_tail, D("-0.5"), D("0.5"), 20, 63, one,
         "error", "signed")
    emit("stirling_coefficients", "x (lgamma(x) - (x - 1/2) ln x + x - ln(2 pi)/2) in 1/x^2, x >= 8", stirling, 0,
         D(1) / 64, 7, 64, one, "error",
         "alternating")
    emit("sin_pi_coefficients", "sin(pi f)/f in f^2, |f| <= 1/2", sin_pi, 0, D("0.25"), 9, 61, one, "error",
         "alternating")
    emit_constant("log2_e_less_1", "1/ln 2 - 1", 1 / LN2 - 1, 96, 3)
    emit_constant("ln2_long", "ln 2", LN2, 96, 3)
    emit_number("SQRT2_64", "sqrt 2", D(2).sqrt(), 63)
    emit_number("LOG10_E_64", "log10 e", 1 / D(10).ln(), 65)
    emit_number("TWO_OVER_SQRT_PI_64", "2/sqrt(pi)", 2 / PI.sqrt(), 63)
    emit_number("PI_Q62", "pi", PI, 62)
    emit_number("LN_PI_64", "ln pi", PI.ln(), 63)
    emit_number("LN_2PI_HALF_64", "ln(2 pi) / 2", (2 * PI).ln() / 2, 64)
    print("#endif")


def atan_of(x):
    """By halving the argument until the series is short: atan x = 2 atan(x / (1 + sqrt(1 + x^2)))"""
    if x == 0:
        return D(0)
    with localcontext() as context:
        context.prec = 100
        doubled = 1
        while x > D("0.01"):
            x = x / (1 + (1 + x * x).sqrt())
            doubled *= 2
        return doubled * x * (1 - x * x * atan_tail(x * x))


main()
