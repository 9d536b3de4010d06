#!/usr/bin/env python3
"""float_operations.py: a function of LLVM's IR for each operation on floating-point numbers, of each type, to standard
output."""

TYPES = {"half": "f16", "bfloat": "bf16", "float": "f32", "double": "f64", "fp128": "f128", "<2 x float>": "v2f32",
         "<3 x half>": "v3f16"}
UNARY = (
    "sqrt sin cos tan acos asin atan sinh cosh tanh exp exp2 exp10 log log2 log10 fabs floor ceil trunc rint nearbyint "
    "round roundeven "
    "canonicalize arithmetic.fence").split()
BINARY = "pow minnum maxnum minimum maximum copysign".split()
EXACT = "floor ceil round roundeven minnum maxnum minimum maximum".split()  # constrained without a rounding mode
CONSTRAINED = {"fadd": 2, "fsub": 2, "fmul": 2, "fdiv": 2, "frem": 2, "sqrt": 1, "sin": 1, "cosh": 1, "pow": 2,
               "floor": 1, "rint": 1, "fma": 3, "minnum": 2,
               "roundeven": 1}
declared = set()


def define(result, name, parameters, body):
    listed = ", ".join(f"{kind} %{place}" for place, kind in zip("abc", parameters))
    print(f'define {result} @"{name}"({listed}) {{\n  %r = {body}\n  ret {result} %r\n}}')


def call(result, name, parameters, more="", tail=""):
    """A call of an intrinsic with the parameters of the function around it."""
    declaration = f"declare {result} @llvm.{name}({', '.join(parameters)}{', metadata' * more.count('metadata')})"
    if declaration not in declared:
        declared.add(declaration)
        print(declaration)
    listed = ", ".join(f"{kind} %{place}" for place, kind in zip("abc", parameters))
    define(result, name, parameters, f"call {result} @llvm.{name}({listed}{more}){tail}")


for kind, suffix in TYPES.items():
    for name in ("fadd", "fsub", "fmul", "fdiv", "frem"):
        define(kind, f"{name}.{suffix}", [kind, kind], f"{name} {kind} %a, %b")
    define("<2 x i1>" if kind[:2] == "<2" else "<3 x i1>" if kind[0] == "<" else "i1", f"fcmp.{suffix}", [kind, kind],
           f"fcmp ueq {kind} %a, %b")
    for count, names in ((1, UNARY), (2, BINARY), (3, ["fma", "fmuladd"])):
        for name in names:
            call(kind, f"{name}.{suffix}", [kind] * count)
    for name, count in CONSTRAINED.items():
        mode = "" if name in EXACT else ', metadata !"round.dynamic"'
        call(kind, f"experimental.constrained.{name}.{suffix}", [kind] * count, mode + ', metadata !"fpexcept.strict"',
             " strictfp")
    if kind[0] == "<":
        continue
    for bits in ("i1", "i8", "i17", "i32", "i64", "i128"):
        for sign in "su":
            call(bits, f"fpto{sign}i.sat.{bits}.{suffix}", [kind])
            define(bits, f"fpto{sign}i.{bits}.{suffix}", [kind], f"fpto{sign}i {kind} %a to {bits}")
            define(kind, f"{sign}itofp.{bits}.{suffix}", [bits], f"{sign}itofp {bits} %a to {kind}")
    for name, bits in (("lrint", "i32"), ("lround", "i32"), ("llrint", "i64"), ("llround", "i64")):
        call(bits, f"{name}.{bits}.{suffix}", [kind])
    call(kind, f"powi.{suffix}.i32", [kind, "i32"])
    call(kind, f"ldexp.{suffix}.i32", [kind, "i32"])
    call(f"{{ {kind}, i32 }}", f"frexp.{suffix}.i32", [kind])
