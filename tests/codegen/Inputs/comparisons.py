#!/usr/bin/env python3
"""comparisons.py: every comparison of floats as a value, in a selection and in a branch, and every one of integers in a
branch, also with constants, as functions of LLVM's IR with the required code, to standard output."""

CALL = ["addi r2, r2, -4", "sw r1, 0(r2)", "call g", "lw r1, 0(r2)", "addi r2, r2, 4"]
LABEL = ".LBB{{[0-9_]+}}"

# Instructions that put the result, or its opposite (second column), into {0}.
ONE, TWO = "flt r12, r5, r4", "flt r13, r4, r5"
FLOATS = {
    "oeq": ("feq {0}, r4, r5", False), "une": ("feq {0}, r4, r5", True),
    "olt": ("flt {0}, r4, r5", False), "uge": ("flt {0}, r4, r5", True),
    "ole": ("fle {0}, r4, r5", False), "ugt": ("fle {0}, r4, r5", True),
    "ogt": ("flt {0}, r5, r4", False), "ule": ("flt {0}, r5, r4", True),
    "oge": ("fle {0}, r5, r4", False), "ult": ("fle {0}, r5, r4", True),
    "one": (f"{ONE}; {TWO}; or {{0}}, r13, r12", False), "ueq": (f"{ONE}; {TWO}; or {{0}}, r13, r12", True),
    "ord": ("feq r12, r5, r5; feq r13, r4, r4; and {0}, r13, r12", False),
    "uno": ("feq r12, r5, r5; feq r13, r4, r4; and {0}, r13, r12", True),
}
# The branch past the call: of the opposite.
INTEGERS = {
    "eq": "bne r4, r5", "ne": "beq r4, r5", "slt": "bge r4, r5", "sge": "blt r4, r5", "sgt": "bge r5, r4",
    "sle": "blt r5, r4", "ult": "bgeu r4, r5", "uge": "bltu r4, r5", "ugt": "bgeu r5, r4", "ule": "bltu r5, r4",
}
# With a constant: the branch, and whether it leads to the call or past it.
CONSTANTS = {
    "negative": ("slt", "0", ["bltz r4"], True), "not_negative": ("sgt", "-1", ["bltz r4"], False),
    "positive": ("sgt", "0", ["blez r4"], False), "not_positive": ("slt", "1", ["blez r4"], True),
    "less": ("ult", "100", ["li r12, 99", "bltu r12, r4"], False),
}


def function(name, result, parameters, checks, body):
    print(f"; CHECK-LABEL: {name}:")
    print("".join(f"; CHECK: {line}\n" for line in checks), end="")
    print(f"define {result} @{name}({parameters}) {{\n{body}}}")


def branch(name, kind, comparison, checks, other="%b"):
    function(name, "void", f"{kind} %a, {kind} %b", checks,
             f"  %c = {comparison} {kind} %a, {other}\n  br i1 %c, label %yes, label %no\n"
             "yes:\n  call void @g()\n  br label %no\nno:\n  ret void\n")


PAST = [*CALL, f"{LABEL}:", "ret"]
TO_CALL = ["ret", f"{LABEL}:", *CALL, "ret"]

for predicate, (code, negated) in FLOATS.items():
    computed = code.format("r12").split("; ")
    function(f"set_{predicate}", "i32", "float %a, float %b",
             [*(computed + ["xori r4, r12, 1"] if negated else code.format("r4").split("; ")), "ret"],
             f"  %c = fcmp {predicate} float %a, %b\n  %r = zext i1 %c to i32\n  ret i32 %r\n")
    function(f"select_{predicate}", "i32", "float %a, float %b, i32 %t, i32 %f",
             [*computed, f"cmov{'nz' if negated else 'z'} r6, r7, r12", "mv r4, r6", "ret"],
             f"  %c = fcmp {predicate} float %a, %b\n  %r = select i1 %c, i32 %t, i32 %f\n  ret i32 %r\n")
    to_call = negated and len(computed) > 1
    code = "bnez" if negated and not to_call else "beqz"
    branch(f"branch_{predicate}", "float", f"fcmp {predicate}",
           [*computed, f"{code} r12, {LABEL}", *(TO_CALL if to_call else PAST)])
for predicate, code in INTEGERS.items():
    branch(f"integer_{predicate}", "i32", f"icmp {predicate}", [f"{code}, {LABEL}", *PAST])
for name, (predicate, constant, code, to_call) in CONSTANTS.items():
    branch(f"constant_{name}", "i32", f"icmp {predicate}",
           [*code[:-1], f"{code[-1]}, {LABEL}", *(TO_CALL if to_call else PAST)], constant)
print("declare void @g()")
