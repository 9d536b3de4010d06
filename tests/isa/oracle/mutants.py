#!/usr/bin/env python3
"""Show that isa-exhaustive, and the oracle's own test, notice every mistake: each rule of the oracle is broken in turn.

    mutants.py [SCRATCH] [--build build] [--only EXPRESSION]
    mutants.py --stale             only lists texts that are not there

A mutant is oracle.c with one text replaced. isa-exhaustive compares the emulator's arithmetic with it over a million
cases of each operation, so a mutant that passes would also be a mistake of the emulator that passes. The oracle's test
is tried as well, once as a whole and once without the comparison with MPFR, by the hand-worked cases alone. Exit
status: 0 if isa-exhaustive and the whole test notice all.
"""

import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1]))
from mutation import Mutant, failure, main, relinked  # noqa: E402

COUNT = 1000000
SECONDS = 600

MUTANTS = [  # (description, text, replacement)
    ("ties to odd", "kept % 2 == 1)", "kept % 2 == 0)"), ("ties away", "(sticky || kept % 2 == 1)", "true"),
    ("ties towards zero", "(sticky || kept % 2 == 1)", "sticky"),
    ("sticky forgotten at a tie", "(sticky || kept % 2 == 1)", "kept % 2 == 1"),
    ("never up", "      kept++;\n  }\n  if (kept == (uint128)1", "      kept += 0;\n  }\n  if (kept == (uint128)1"),
    ("subnormal numbers rounded as normal ones", "  if (last < LEAST_EXPONENT)\n    last = LEAST_EXPONENT;\n", ""),
    ("results below the normal are zero", "signed_bits(negative, (uint32_t)kept)", "signed_bits(negative, 0)"),
    ("operands below the normal are zero", "} else if (fraction == 0) {", "} else {"),
    ("subnormal numbers a binade off", "(int)biased - 1 + LEAST_EXPONENT", "(int)biased + LEAST_EXPONENT"),
    ("the greatest binade is infinity", "last > 127 - (SIGNIFICANT_BITS - 1)", "last > 126 - (SIGNIFICANT_BITS - 1)"),
    ("overflow gives the greatest", "return signed_bits(negative, INFINITY_BITS);\n  if (kept",
     "return signed_bits(negative, INFINITY_BITS - 1);\n  if (kept"),
    ("operands are far too soon", "const int far = 100;", "const int far = 20;"),
    ("an exact zero sum is -0", "return 0; /* +0 [6.3] */", "return SIGN_BIT;"),
    ("-0 + -0 is +0", "x.negative && y.negative ? SIGN_BIT : 0", "0"),
    ("+0 + -0 is -0", "x.negative && y.negative ? SIGN_BIT : 0", "x.negative || y.negative ? SIGN_BIT : 0"),
    ("infinity - infinity is infinity", "x.negative == y.negative ? a : CANONICAL_NAN", "a"),
    ("a sum with infinity is the other operand", "return x.kind == INFINITE ? a : b;",
     "return x.kind == INFINITE ? b : a;"), ("subtract adds", "oracle_fadd(a, b ^ SIGN_BIT)", "oracle_fadd(a, b)"),
    ("0 * infinity is infinity", "x.kind == ZERO || y.kind == ZERO ? CANONICAL_NAN : ", ""),
    ("a zero product has no sign", "if (x.kind == ZERO || y.kind == ZERO)\n    return signed_bits(negative, 0);",
     "if (x.kind == ZERO || y.kind == ZERO)\n    return 0;"),
    ("a NaN is not canonical", "#define CANONICAL_NAN 0x7FC00000u", "#define CANONICAL_NAN 0xFFC00000u"),
    ("the quotient is cut off", "dividend % y.significand != 0", "false"),
    ("0/0 is infinity", "return x.kind == ZERO ? CANONICAL_NAN : signed_bits(negative, INFINITY_BITS);",
     "return signed_bits(negative, INFINITY_BITS);"),
    ("x/0 has no sign", "x.kind == ZERO ? CANONICAL_NAN : signed_bits(negative, INFINITY_BITS)",
     "x.kind == ZERO ? CANONICAL_NAN : INFINITY_BITS"),
    ("infinity/infinity is infinity", "y.kind == INFINITE ? CANONICAL_NAN : signed_bits", "signed_bits"),
    ("x/infinity has no sign", "if (x.kind == ZERO || y.kind == INFINITE)\n    return signed_bits(negative, 0);",
     "if (x.kind == ZERO || y.kind == INFINITE)\n    return 0;"),
    ("the reciprocal root is cut off", "(uint128)(n * n) * x.significand != one", "false"),
    ("the reciprocal root of -0 is +infinity", "return signed_bits(x.negative, INFINITY_BITS);",
     "return INFINITY_BITS;"),
    ("the reciprocal root of infinity is infinity", "if (x.kind == INFINITE)\n    return 0;",
     "if (x.kind == INFINITE)\n    return a;"),
    ("odd exponents are taken as even", "if (d->exponent % 2 != 0) {", "if (d->exponent % 2 > 0) {"),
    ("the root is cut off", "n * n != square)", "false)"),
    ("the root of -0 is +0", "if (x.kind == ZERO)\n    return a;", "if (x.kind == ZERO)\n    return 0;"),
    ("-0 is not less than +0", "return !d.negative ? magnitude : zeros_equal ? -magnitude : -magnitude - 1;",
     "return !d.negative ? magnitude : -magnitude;"),
    ("zeros differ", "int64_t p = place(x, a, true), q = place(y, b, true);",
     "int64_t p = place(x, a, false), q = place(y, b, false);"),
    ("a NaN wins", "return x.kind != NOT_A_NUMBER ? a : y.kind != NOT_A_NUMBER ? b : CANONICAL_NAN;",
     "return CANONICAL_NAN;"),
    ("two NaNs give the first", "y.kind != NOT_A_NUMBER ? b : CANONICAL_NAN;", "y.kind != NOT_A_NUMBER ? b : a;"),
    ("a NaN equals", "return UNORDERED;", "return EQUAL;"), ("a NaN is less", "return UNORDERED;", "return LESS;"),
    ("<= is <", "return r == LESS || r == EQUAL;", "return r == LESS;"),
    ("the least integer is cut off", "x.negative ? 0x80000000u : 0x7FFFFFFFu", "0x7FFFFFFFu"),
    ("integers are rounded", "d.significand >> -d.exponent", "((d.significand >> (-d.exponent - 1)) + 1) / 2"),
    ("a NaN gives the greatest integer", "if (x.kind == NOT_A_NUMBER)\n    return 0;\n  uint64_t most",
     "if (x.kind == NOT_A_NUMBER)\n    return 0x7FFFFFFF;\n  uint64_t most"),
    ("negative numbers wrap",
     "if (x.kind == NOT_A_NUMBER || x.negative)\n    return 0;\n  uint64_t n = integer_part(x);",
     "if (x.kind == NOT_A_NUMBER)\n    return 0;\n  uint64_t n = integer_part(x);\n  if (x.negative)\n    return "
     "(uint32_t)(0 - n);"
     ),
    ("unsigned saturates as signed", "n < UINT32_MAX ? (uint32_t)n : UINT32_MAX",
     "n < INT32_MAX ? (uint32_t)n : INT32_MAX"),
    ("a negative integer is taken as unsigned", "bool negative = a >> 31;\n", "bool negative = false;\n"),
    ("an unsigned integer is taken as signed", "round_pack(false, 0, a, false);\n}\n\nuint32_t oracle_reduce",
     "oracle_fcvt_s_w(a);\n}\n\nuint32_t oracle_reduce"), ("reduced ties up", "multiple % 2 == 1))", "true))"),
    ("reduced towards zero", "    multiple++;\n", "    multiple += 0;\n"),
    ("subnormal numbers are reduced", " || (value & INFINITY_BITS) == 0)", ")"),
    ("a bit too many is kept", "(uint32_t)1 << (SIGNIFICANT_BITS - bits)",
     "(uint32_t)1 << (SIGNIFICANT_BITS - bits) / 2 * 2"), ]


TESTS = {"isa-exhaustive": ("isa-exhaustive", "--count", COUNT), "the oracle's test": ("isa-oracle-test",),
         "hand-worked cases": ("isa-oracle-test", "--by-hand")}
REQUIRED = list(TESTS)[:2]


def noticed(folder, build, mutant):
    """Returns the tests that notice the mutant; an empty list unless all of REQUIRED do."""
    list(relinked(folder, build, "tests/isa/oracle/CMakeFiles/isa_oracle.dir", HERE / mutant.file,
                  mutant.changed(HERE), ("isa-exhaustive", "isa-oracle-test")))
    found = [by for by, (program, *words) in TESTS.items() if failure(SECONDS, folder / program, *words)]
    return found if mutant.text == mutant.other or set(REQUIRED) <= set(found) else []


def print_totals(results):
    print(", ".join(f"{by} notices {sum(by in found for _, found in results)}" for by in TESTS))


if __name__ == "__main__":
    LIST = [Mutant("oracle.c", text, other, what) for what, text, other in MUTANTS]
    sys.exit(main(__doc__, HERE, LIST, noticed, totals=print_totals))
