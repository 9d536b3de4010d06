#!/usr/bin/env python3
"""Prints coefficients.h: the polynomials and tables of the mathematical functions, as fixed-point integers. The build
runs it.

Each polynomial interpolates its function at Chebyshev points of the interval where it is used. That is within a small
factor of the best approximation of its degree. The comment beside it gives the greatest error on a dense grid, against
series summed to 60 digits.
"""

from decimal import Decimal, getcontext, localcontext
from fractions import Fraction
from math import comb

getcontext().prec = 450
D = Decimal


def pi():
    """Machin: 16 atan(1/5) - 4 atan(1/239)."""

    def atan_inverse(n):
        total, power, k = D(0), D(1) / n, 0
        while abs(power) > D(10) ** -440:
            total += power / (2 * k + 1) * (-1) ** k
            power /= n * n
            k += 1
        return total

    return 16 * atan_inverse(5) - 4 * atan_inverse(239)


PI = pi()
LN2 = D(2).ln()


def series(first, ratio, x):
    """Sum of terms, the first given, each the one before times x times ratio(k)."""
    total, term, k = D(0), D(first), 0
    while abs(term) > D(10) ** -62:
        total += term
        k += 1
        term *= x * ratio(k)
    return total


def exp2_tail(x):
    """(2^x - 1) / x"""
    return series(LN2, lambda k: LN2 / (k + 1), x)


def sin_tail(z):
    """(1 - sin(r)/r) / z for z = r^2"""
    return series(D(1) / 6, lambda k: D(-1) / ((2 * k + 2) * (2 * k + 3)), z)


def cos_tail(z):
    """(1 - cos r) / z for z = r^2"""
    return series(D(1) / 2, lambda k: D(-1) / ((2 * k + 1) * (2 * k + 2)), z)


def sinh_tail(z):
    """(sinh(r)/r - 1) / z for z = r^2"""
    return series(D(1) / 6, lambda k: D(1) / ((2 * k + 2) * (2 * k + 3)), z)


def cosh_tail(z):
    """(cosh r - 1) / z for z = r^2"""
    return series(D(1) / 2, lambda k: D(1) / ((2 * k + 1) * (2 * k + 2)), z)


def tanh_tail(z):
    """(1 - tanh(r)/r) / z for z = r^2: tanh(r)/r = (1 + z sinh_tail) / (1 + z cosh_tail)"""
    return (cosh_tail(z) - sinh_tail(z)) / (1 + z * cosh_tail(z))


def asinh_tail(z):
    """(1 - asinh(s)/s) / z for z = s^2, by the binomial series of its derivative"""
    total, term, k = D(0), D(1) / 2, 1
    while abs(term) > D(10) ** -62:
        total += term / (2 * k + 1)
        term *= -z * (2 * k + 1) / (2 * k + 2)
        k += 1
    return total


def atanh_tail(z):
    """(atanh(x)/x - 1) / z for z = x^2"""
    total, power, k = D(0), D(1), 0
    while power > D(10) ** -62:
        total += power / (2 * k + 3)
        power *= z
        k += 1
    return total


def atan_tail(z):
    """(1 - atan(t)/t) / z for z = t^2"""
    total, power, k = D(0), D(1), 0
    while power > D(10) ** -62:
        total += power / (2 * k + 3) * (-1) ** k
        power *= z
        k += 1
        if z == 0:
            break
    return total


def log2_tail(r):
    """-(log2(1 + r) - r/ln 2) / r^2"""
    if abs(r) < D("0.01"):
        total, power, k = D(0), D(1), 2
        while abs(power) > D(10) ** -62 and k < 60:
            total += power / k
            power *= -r
            k += 1
        return total / LN2
    return -((1 + r).ln() - r) / LN2 / (r * r)


BERNOULLI = [Fraction(1)]  # by the recurrence; those of odd index above 1 are 0
for m in range(1, 41):
    BERNOULLI.append(-sum(comb(m + 1, k) * BERNOULLI[k] for k in range(m)) / (m + 1))


def gamma_inverse(t):
    """1 / gamma(3/2 + t): Stirling's series for the argument 40 greater, over the factors in between."""
    with localcontext() as context:
        context.prec = 80
        z = D("41.5") + t
        total = (z - D("0.5")) * z.ln() - z + (2 * PI).ln() / 2
        for k in range(1, 21):
            b = BERNOULLI[2 * k]
            total += D(b.numerator) / b.denominator / (2 * k * (2 * k - 1)) / z ** (2 * k - 1)
        product = D(1)
        for i in range(1, 41):
            product *= z - i
        return product / total.exp()


def chebyshev(function, low, high, degree):
    """Coefficients, lowest first, of the interpolating polynomial."""
    low, high = D(low), D(high)
    count = degree + 1

    def cosine(k):  # of (2k + 1) pi / (2 count)
        angle = PI * (2 * k + 1) / (2 * count)
        return 1 - angle * angle * cos_tail(angle * angle)

    points = [(low + high) / 2 + (high - low) / 2 * cosine(k) for k in range(count)]
    table = [function(x) for x in points]  # divided differences
    for level in range(1, count):
        for i in range(count - 1, level - 1, -1):
            table[i] = (table[i] - table[i - 1]) / (points[i] - points[i - level])
    coefficients = [D(0)] * count
    for i in range(count - 1, -1, -1):
        shifted = [D(0)] + coefficients[:-1]
        coefficients = [s - points[i] * c for s, c in zip(shifted, coefficients)]
        coefficients[0] += table[i]
    return coefficients


def greatest_error(function, coefficients, low, high, weight):
    worst = D(0)
    for i in range(401):
        x = D(low) + (D(high) - D(low)) * i / 400
        value = D(0)
        for c in reversed(coefficients):
            value = value * x + c
        worst = max(worst, abs((value - function(x)) * weight(x)))
    return worst


def log2_text(x):
    return f"2^{float(x.ln() / LN2):.1f}"


def emit_polynomial(name, what, function, low, high, degree, bits, weight, weighted, alternating=False):
    coefficients = chebyshev(function, low, high, degree)
    error = greatest_error(function, coefficients, low, high, weight)
    values = [int((c * (-1) ** i if alternating else c) * D(2) ** bits + D("0.5")) for i, c in enumerate(coefficients)]
    assert all(0 <= v < 2**32 for v in values), name
    print(
        f"/* {what}, times 2^{bits}{', signs alternating from +' if alternating else ''}; {weighted} "
        f"{log2_text(error)}. */"
    )
    print(f"static const uint32_t {name}[{degree + 1}] = {{")
    for i in range(0, len(values), 6):
        print("    " + ", ".join(f"0x{v:08X}" for v in values[i : i + 6]) + ",")
    print("};\n")


def emit_signed_polynomial(name, what, function, low, high, degree, bits, weighted):
    coefficients = chebyshev(function, low, high, degree)
    error = greatest_error(function, coefficients, low, high, lambda x: D(1))
    values = [int((c * D(2) ** bits).to_integral_value()) for c in coefficients]
    print(f"/* {what}, times 2^{bits}; {weighted} {log2_text(error)}. */")
    print(f"static const int64_t {name}[{degree + 1}] = {{")
    for i in range(0, len(values), 4):
        print("    " + ", ".join(f"{'-' if v < 0 else ''}0x{abs(v):X}LL" for v in values[i : i + 4]) + ",")
    print("};\n")


def emit_log2_table():
    """For each i of 0 to 32, a number c near 32/(32 + i) with 9 bits, and -log2 c; m = 1 + i/32 + at most 1/64 gives
    |m*c - 1| < 2^-5.9."""
    reciprocals = [round(512 * 32 / (32 + i)) for i in range(33)]
    worst = D(0)
    for i, c in enumerate(reciprocals):
        for m in (D(64 + 2 * i - 1) / 64, D(64 + 2 * i + 1) / 64):
            if 1 <= m <= 2:
                worst = max(worst, abs(m * c / 512 - 1))
    print(
        "/* c[i] near 512 * 32 / (32 + i), and -log2(c[i] / 512) * 2^55: log2 m = -log2 c + log2(m c), and the product "
        "with the nearest"
    )
    print(f"   c is 1 + r with |r| < {log2_text(worst)}. */")
    print("static const uint16_t log2_reciprocal[33] = {")
    for i in range(0, 33, 11):
        print("    " + ", ".join(f"{c}" for c in reciprocals[i : i + 11]) + ",")
    print("};")
    print("static const uint64_t log2_of_reciprocal[33] = {")
    values = [int(-(D(c) / 512).ln() / LN2 * D(2) ** 55 + D("0.5")) for c in reciprocals]
    for i in range(0, 33, 4):
        print("    " + ", ".join(f"0x{v:016X}" for v in values[i : i + 4]) + ",")
    print("};\n")


def emit_constant(name, what, value, bits):
    word = int(value * D(2) ** bits + D("0.5"))
    print(f"/* {what} * 2^{bits} */")
    print(f"#define {name} 0x{word:X}u\n")


def main():
    print("/* Generated by coefficients.py. Do not edit. */")
    print("#ifndef TRAX_RUNTIME_COEFFICIENTS_H\n#define TRAX_RUNTIME_COEFFICIENTS_H\n\n#include <stdint.h>\n")
    square_limit = (PI / 4) ** 2
    atan_limit = (D(2).sqrt() - 1) ** 2
    emit_polynomial("exp2_coefficients", "(2^x - 1) / x on [0, 1]", exp2_tail, 0, 1, 7, 32, lambda x: x, "error in 2^x")
    emit_polynomial("sin_coefficients", "(1 - sin(r)/r) / r^2 in r^2, |r| <= pi/4", sin_tail, 0, square_limit, 3, 34,
                    lambda z: z, "relative error in sin", True)
    emit_polynomial("cos_coefficients", "(1 - cos r) / r^2 in r^2, |r| <= pi/4", cos_tail, 0, square_limit, 4, 32,
                    lambda z: z, "error in cos", True)
    emit_polynomial("atan_coefficients", "(1 - atan(t)/t) / t^2 in t^2, |t| <= tan(pi/8)", atan_tail, 0, atan_limit, 6,
                    33,
                    lambda z: z, "relative error in atan", True)
    emit_polynomial("sinh_coefficients", "(sinh(r)/r - 1) / r^2 in r^2, |r| < 1", sinh_tail, 0, 1, 4, 34, lambda z: z,
                    "relative error in sinh")
    emit_polynomial("cosh_coefficients", "(cosh r - 1) / r^2 in r^2, |r| < 1", cosh_tail, 0, 1, 4, 32, lambda z: z,
                    "error in cosh")
    emit_polynomial("tanh_coefficients", "(1 - tanh(r)/r) / r^2 in r^2, |r| < 1/2", tanh_tail, 0, D("0.25"), 5, 33,
                    lambda z: z,
                    "relative error in tanh", True)
    emit_polynomial("asinh_coefficients", "(1 - asinh(s)/s) / s^2 in s^2, |s| < 1/2", asinh_tail, 0, D("0.25"), 6, 34,
                    lambda z: z,
                    "relative error in asinh", True)
    emit_polynomial("atanh_coefficients", "(atanh(x)/x - 1) / x^2 in x^2, |x| < 1/2", atanh_tail, 0, D("0.25"), 7, 33,
                    lambda z: z,
                    "relative error in atanh")
    limit = D(2) ** D("-5.9")
    emit_polynomial("log2_coefficients", "-(log2(1 + r) - r/ln 2) / r^2, |r| < 2^-5.9", log2_tail, -limit, limit, 5, 31,
                    lambda r: r * r, "error in log2", True)
    emit_log2_table()
    emit_signed_polynomial("gamma_inverse_coefficients", "1 / gamma(3/2 + t) in t, |t| <= 1/2", gamma_inverse,
                           D("-0.5"), D("0.5"), 17, 62,
                           "error")
    bits = int(2 / PI * D(2) ** 224)
    print("/* 2/pi in words of 32 bits, the first of them zero. */")
    print("static const uint32_t two_over_pi[8] = {")
    words = [0] + [bits >> (32 * (6 - i)) & 0xFFFFFFFF for i in range(7)]
    for i in range(0, 8, 4):
        print("    " + ", ".join(f"0x{w:08X}" for w in words[i : i + 4]) + ",")
    print("};\n")
    print("/* 2/pi for binary64: two words of zeros and 38 of digits. */")
    print("static const uint32_t two_over_pi_long[40] = {")
    bits = int(2 / PI * D(2) ** (32 * 38))
    words = [0, 0] + [bits >> (32 * (37 - i)) & 0xFFFFFFFF for i in range(38)]
    for i in range(0, 40, 8):
        print("    " + ", ".join(f"0x{w:08X}" for w in words[i : i + 8]) + ",")
    print("};\n")
    bits = int(PI / 4 * D(2) ** 96)
    print("/* pi/4 in words of 32 bits. */")
    print("static const uint32_t pi_over_4[3] = {" + ", ".join(f"0x{bits >> shift & 0xFFFFFFFF:08X}"
                                                               for shift in (64, 32, 0)) + "};\n")
    emit_constant("PI_OVER_4", "pi/4", PI / 4, 32)
    emit_constant("PI_64", "pi", PI, 62)
    emit_constant("LOG2_E", "1/ln 2", 1 / LN2, 63)
    emit_constant("LOG2_E_LESS_1", "1/ln 2 - 1", 1 / LN2 - 1, 32)
    emit_constant("LN_2", "ln 2", LN2, 64)
    emit_constant("LOG10_2", "log10 2", LN2 / D(10).ln(), 65)
    print("#endif")


if __name__ == "__main__":
    main()
