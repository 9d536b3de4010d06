#!/usr/bin/env python3
"""comparisons.py: every comparison of floats as a value, in a selection and in a branch, and every one of integers in a
branch, as functions of LLVM's IR with the required code, to standard output."""

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


def function(name, result, parameters, checks, body):
    print(f"; CHECK-LABEL: {name}:")
    print("".join(f"; CHECK: {line}\n" for line in checks), end="")
    print(f"define {result} @{name}({parameters}) {{\n{body}}}")


def branch(name, kind, comparison, checks):
    function(name, "void", f"{kind} %a, {kind} %b", checks,
             f"  %c = {comparison} {kind} %a, %b\n  br i1 %c, label %yes, label %no\n"
             "yes:\n  call void @g()\n  br label %no\nno:\n  ret void\n")


for predicate, (code, negated) in FLOATS.items():
    computed = code.format("r12").split("; ")
    function(f"set_{predicate}", "i32", "float %a, float %b",
             [*(computed + ["xori r4, r12, 1"] if negated else code.format("r4").split("; ")), "ret"],
             f"  %c = fcmp {predicate} float %a, %b\n  %r = zext i1 %c to i32\n  ret i32 %r\n")
    function(f"select_{predicate}", "i32", "float %a, float %b, i32 %t, i32 %f",
             [*computed, f"cmov{'nz' if negated else 'z'} r6, r7, r12", "mv r4, r6", "ret"],
             f"  %c = fcmp {predicate} float %a, %b\n  %r = select i1 %c, i32 %t, i32 %f\n  ret i32 %r\n")
    past = [*CALL, f"{LABEL}:", "ret"]
    if negated and len(computed) > 1:  # the call is where the branch leads to
        past, negated = ["ret", f"{LABEL}:", *CALL, "ret"], False
    branch(f"branch_{predicate}", "float", f"fcmp {predicate}",
           [*computed, f"{'bnez' if negated else 'beqz'} r12, {LABEL}", *past])
for predicate, code in INTEGERS.items():
    branch(f"integer_{predicate}", "i32", f"icmp {predicate}", [f"{code}, {LABEL}", *CALL, f"{LABEL}:", "ret"])
print("declare void @g()")
