"""Operands for the instructions' values: corners, and constructed hard cases of binary32. Integers only: no host
arithmetic decides what a float is. Everything follows from fixed seeds."""

import random
from functools import lru_cache
from math import isqrt

INTEGERS = [0, 1, 2, 3, 4, 5, 7, 8, 15, 16, 30, 31, 32, 33, 63, 64, 0x7F, 0x80, 0xFF, 0x7FFF, 0x8000, 0xFFFF, 0x10000,
            0x55555555,
            0xAAAAAAAA, 0x7FFFFFFE, 0x7FFFFFFF, 0x80000000, 0x80000001, 0xFFFF7FFF, 0xFFFF8000, 0xFFFFFFFE, 0xFFFFFFFF,
            0xDEADBEEF]

# Both signs of each.
_MAGNITUDES = [0x00000000, 0x00000001, 0x00000002, 0x00400000, 0x007FFFFF, 0x00800000, 0x00800001, 0x00FFFFFF,
               0x0C000000, 0x33800000,
               0x34000000, 0x3EAAAAAB, 0x3F000000, 0x3F7FFFFF, 0x3F800000, 0x3F800001, 0x3FC00000, 0x40000000,
               0x40400000, 0x40490FDB,
               0x4B000000, 0x4B7FFFFF, 0x4B800000, 0x4F000000, 0x4F800000, 0x7E800000, 0x7F000000, 0x7F7FFFFF,
               0x7F800000,  # infinity
               0x7F800001, 0x7FA5A5A5,  # NaNs that signal
               0x7FC00000, 0x7FFFFFFF]  # and quiet ones
FLOATS = [magnitude | sign for magnitude in _MAGNITUDES for sign in (0, 0x80000000)]


def pack(sign, exponent, significand):
    """(-1)^sign * significand * 2^exponent, which must be a binary32 number."""
    while significand >= 1 << 24 and significand % 2 == 0:
        significand, exponent = significand >> 1, exponent + 1
    while significand and significand < 1 << 23 and exponent > -149:
        significand, exponent = significand << 1, exponent - 1
    while exponent < -149 and significand % 2 == 0:
        significand, exponent = significand >> 1, exponent + 1
    if significand >= 1 << 24 or exponent < -149 or (significand >= 1 << 23 and exponent > 104):
        raise ValueError("not a binary32 number")
    biased = exponent + 150 if significand >> 23 else 0
    return sign << 31 | biased << 23 | (significand & 0x7FFFFF)


def _packed(pairs):
    """Those pairs of (sign, exponent, significand) that are numbers."""
    packed = []
    for pair in pairs:
        try:
            packed.append(tuple(pack(*operand) for operand in pair))
        except ValueError:
            pass
    return packed


def _random_significand(source):
    return 1 << 23 | source.getrandbits(23)


@lru_cache(None)
def integer_pairs():
    source = random.Random("integers")
    pairs = [(source.getrandbits(32), source.getrandbits(32)) for _ in range(128)]
    for bit in range(32):
        pairs += [(source.getrandbits(32), bit), (source.getrandbits(32), bit + 32), (0xFFFFFFFF, bit),
                  (0x80000000, bit),
                  (1 << bit, source.getrandbits(32)), (source.getrandbits(32), 1 << bit), (1 << bit, 1 << bit),
                  (1 << bit, 1 << 31 - bit),
                  (0x7FFFFFFF ^ 1 << bit, 0x7FFFFFFF), (0xFFFFFFFF ^ 1 << bit, 0xFFFFFFFF)]
    return pairs


@lru_cache(None)
def sums():
    """Halfway cases and their neighbours at every distance of exponents, cancellation, subnormal results, overflow."""
    source = random.Random("sums")
    pairs = []
    for distance in range(1, 27):
        for tail in (-1, 0, 1):
            for significand in (1 << 23, _random_significand(source) | 1, _random_significand(source) & ~1 | 2,
                                0xFFFFFF):
                for sign in (0, 1):
                    # b's low bits, as many as lie below a's last one, are a half of that or one more or less.
                    low = (1 << distance - 1) + tail
                    b = _random_significand(source) >> distance << distance | low if distance < 24 else low
                    if b >= 1 << 24:
                        b = (1 << 23) + max(tail, 0)
                    exponent = source.choice((-130, -23, 0, 60))
                    first, second = (sign, exponent, significand), (sign ^ source.getrandbits(1), exponent - distance,
                                                                    b)
                    pairs.append((first, second) if source.getrandbits(1) else (second, first))
    for _ in range(96):  # nearly equal
        a = _random_significand(source)
        exponent = source.choice((-149, -148, -140, -23, 0, 100))
        pairs.append(((0, exponent, a),
                      (1, exponent + source.choice((-1, 0, 0)), a ^ source.getrandbits(source.randrange(23)))))
        pairs.append(((1, exponent, a), (source.getrandbits(1), exponent, a)))
    for _ in range(96):  # subnormal results and operands
        pairs.append(tuple((source.getrandbits(1), -149 + source.randrange(3),
                            source.getrandbits(source.randrange(1, 25)))
                           for _ in range(2)))
    for binade in range(1, 255):
        for _ in range(3):
            distance = source.choice((0, 1, 2, 5, 11, 17, 22, 23, 24))
            sign = source.getrandbits(1)
            pairs.append(((sign, binade - 150, _random_significand(source)),
                          (sign ^ source.getrandbits(1), binade - 150 - distance, _random_significand(source))))
    largest = (0, 104, 0xFFFFFF)
    for second in ((0, 103, 1), (0, 80, 0x7FFFFF), (0, 79, 0xFFFFFF), (0, 80, 0x800001), (0, 104, 1),
                   (0, 104, 0x800000), (1, 104, 0xFFFFFF)):
        for sign in (0, 1):
            pairs.append(((sign, *largest[1:]), (second[0] ^ sign, *second[1:])))
    return _packed(pairs)


@lru_cache(None)
def products():
    """Halfway cases, every binade of the result, subnormal results and their halfway cases, the threshold of
    overflow."""
    source = random.Random("products")
    pairs = []

    def pair(exponent, a, b, sign=None):
        """a * b * 2^exponent"""
        signs = source.getrandbits(1), source.getrandbits(1)
        part = source.randrange(-20, 21)
        pairs.append(((signs[0], part, a), (signs[1], exponent - part, b)))

    for bits in range(2, 24):  # the product has 25 bits, the last one set
        found = 0
        while found < 6:
            a, b = source.getrandbits(bits) | 1 << bits - 1 | 1, source.getrandbits(25 - bits) | 1 << 24 - bits | 1
            if (a * b).bit_length() == 25:
                pair(source.choice((-60, -24, 0, 50)), a, b)
                found += 1
    for bits in range(1, 25):  # the same where the result is subnormal: one bit below the last place, and one more
        for last in (1, 2):
            for _ in range(2):
                a = source.getrandbits(bits) | 1
                pair(-149 - last, a, 1 << source.randrange(24))
                pairs.append(((source.getrandbits(1), -149 + 30, a), (source.getrandbits(1), -30 - last, 1)))
    for binade in range(-151, 105):
        for _ in range(3):
            a, b = _random_significand(source), _random_significand(source)
            pair(binade - 23, a, b)
    for _ in range(64):
        a = _random_significand(source)
        b = ((1 << 24) - 1 << 24) // a + source.choice((-1, 0, 1))
        pair(104 - 24, a, b)
    return _packed(pairs)


@lru_cache(None)
def quotients():
    """Quotients as near to a halfway case as can be, every binade, subnormal results and their halfway cases, exact
    ones."""
    source = random.Random("quotients")
    pairs = []

    def pair(exponent, a, b):
        part = source.randrange(-20, 21)
        pairs.append(((source.getrandbits(1), part + exponent, a), (source.getrandbits(1), part, b)))

    found = 0
    while found < 192:
        # a * 2^25 = q * b - r with a small r, and q, of 25 bits and odd, halfway between two floats.
        b, remainder = _random_significand(source) | 1, source.choice((-5, -3, -1, 1, 3, 5))
        q = remainder * pow(b, -1, 1 << 25) % (1 << 25)
        a = (q * b - remainder) >> 25
        if q >> 24 and a.bit_length() == 24:
            pair(source.choice((0, -24, 30)), a, b)
            found += 1
    for bits in range(1, 25):
        for last in (1, 2):
            a = source.getrandbits(bits) | 1
            pairs.append(((source.getrandbits(1), -149 + 40, a), (source.getrandbits(1), 40 + last, 1)))
    for binade in range(-152, 106):
        for _ in range(3):
            pair(binade, _random_significand(source), _random_significand(source))
    for _ in range(48):
        q, b = source.getrandbits(12) | 1, source.getrandbits(12) | 1
        pair(source.choice((0, -100, 80)), q * b, b)
    return _packed(pairs)


@lru_cache(None)
def neighbours():
    """Pairs that differ in their last place, sign or exponent, for comparisons."""
    source = random.Random("neighbours")
    pairs = []
    for _ in range(128):
        a = source.getrandbits(32)
        pairs += [(a, a), (a, a ^ 0x80000000), (a, (a + 1) & 0xFFFFFFFF), ((a + 1) & 0xFFFFFFFF, a),
                  (a, a ^ 1 << source.randrange(32)),
                  (a, source.getrandbits(32))]
    return pairs


@lru_cache(None)
def reciprocal_root_operands():
    """Every binade, every length of a subnormal, exact roots, and significands whose root lies near a halfway case."""
    source = random.Random("roots")
    operands = list(FLOATS)
    for exponent in range(1, 255):
        operands += [exponent << 23 | source.getrandbits(23)
                     for _ in range(4)] + [exponent << 23, exponent << 23 | 0x7FFFFF]
    for bits in range(1, 24):
        operands += [1 << bits - 1 | source.getrandbits(bits - 1) for _ in range(3)] + [1 << bits - 1]

    def distance(operand):
        """Of 1 / root from the nearest halfway case, in units of 2^-24 of its last place; the operand is in [1, 4)."""
        significand = (operand & 0x7FFFFF | 1 << 23) << (operand >> 23) - 127
        root = isqrt((1 << 119 + 2 * 24) // significand)  # 1 / root scaled by 2^(48 + 24), of 72 or 73 bits
        below = root.bit_length() - 24
        return abs((root & (1 << below) - 1) - (1 << below - 1)) >> below - 24

    candidates = [source.choice((127, 128)) << 23 | source.getrandbits(23) for _ in range(12000)]
    return operands + sorted(candidates, key=distance)[:192]


@lru_cache(None)
def floats_to_convert():
    source = random.Random("conversions")
    operands = list(FLOATS)
    for exponent in range(100, 170):
        operands += [source.getrandbits(1) << 31 | exponent << 23 | source.getrandbits(23) for _ in range(6)]
    for edge in (0x3F000000, 0x3F800000, 0x40000000, 0x4B000000, 0x4B800000, 0x4EFFFFFF, 0x4F000000, 0x4F7FFFFF,
                 0x4F800000):
        operands += [(edge + step) | sign for step in (-1, 0, 1) for sign in (0, 0x80000000)]
    return operands


@lru_cache(None)
def integers_to_convert():
    """Every length, with the bits below the last place of the float a half, less and more, above an odd and an even
    place."""
    source = random.Random("integers to convert")
    operands = list(INTEGERS)
    for bits in range(1, 33):
        operands += [1 << bits - 1, (1 << bits) - 1] + [1 << bits - 1 | source.getrandbits(bits - 1) for _ in range(4)]
        if bits > 25:
            below = bits - 24
            for odd in (0, 1):
                for tail in (-1, 0, 1):
                    top = 1 << 23 | source.getrandbits(22) << 1 | odd
                    operands.append((top << below) + (1 << below - 1) + tail)
        elif bits == 25:
            operands += [(1 << 24) + 1, (1 << 24) + 3, (1 << 25) - 1, (1 << 25) - 3]
    return operands + [-operand & 0xFFFFFFFF for operand in operands]


def _small(source, most):
    """An integer, as a float."""
    return pack(source.getrandbits(1), 0, source.randrange(most + 1))


def _with_corners(source, words):
    """One of the words is any float."""
    words[source.randrange(len(words))] = source.choice(FLOATS)
    return words


def _any_float(source):
    return source.getrandbits(1) << 31 | source.randrange(120, 134) << 23 | source.getrandbits(23)


@lru_cache(None)
def boxes():
    """[limit, three factors, three offsets, six planes]: hits and misses along each axis, touched edges, flat boxes,
    any floats."""
    source = random.Random("boxes")
    cases = []
    for number in range(900):
        if number % 3 == 2:
            planes = [_any_float(source) for _ in range(6)]
            ray = [_any_float(source) for _ in range(6)]
        else:  # a box of small integers around where the ray is, so that much is equal
            planes = [_small(source, 4) for _ in range(6)]
            if number % 5 == 0:
                axis = source.randrange(3)
                planes[axis + 3] = planes[axis]
            ray = [pack(source.getrandbits(1), source.choice((-1, 0, 0, 1)),
                        source.choice((1, 1, 3))) for _ in range(3)]
            ray += [_small(source, 3) for _ in range(3)]
        limit = source.choice((0x7F800000, pack(0, 0, 100), pack(0, 0, source.randrange(6)),
                               _any_float(source) & 0x7FFFFFFF))
        words = [limit, *ray, *planes]
        cases.append(_with_corners(source, words) if number % 9 == 0 else words)
    return cases


@lru_cache(None)
def triangles():
    """[limit, origin, direction, three vertices]: both sides, edges and vertices that are met exactly, behind, beyond
    the limit, any floats."""
    source = random.Random("triangles")
    cases = []
    for number in range(1500):
        if number % 3 == 2:
            origin = [_any_float(source) for _ in range(3)]
            direction = [_any_float(source) for _ in range(3)]
            vertices = [_any_float(source) for _ in range(9)]
        else:  # small integers: determinants are exact, and often 0 or equal
            most = 2 if number % 2 else 5
            origin = [_small(source, most) for _ in range(3)]
            direction = [_small(source, 2) for _ in range(3)]
            vertices = [_small(source, most) for _ in range(9)]
        limit = source.choice((0x7F800000, pack(0, 0, 100), pack(0, 0, source.randrange(4)),
                               _any_float(source) & 0x7FFFFFFF))
        words = [limit, *origin, *direction, *vertices]
        cases.append(_with_corners(source, words) if number % 9 == 0 else words)
    return cases
