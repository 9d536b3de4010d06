"""limits.py TRAX_MC: sources that crash LLVM's assembler or keep it for ever, as files and as inline assembly."""
import os
import pathlib
import re
import subprocess
import sys
import tempfile

MC = pathlib.Path(sys.argv[1])
N = 100000
LEVELS = "".join(f".macro m{i}\n" + f"m{i - 1}\n" * 10 + ".endm\n" for i in range(1, 18)) + "m17\n"
CASES = {
    "parentheses": ".word " + "(" * N + "1" + ")" * N,
    "minus": ".word " + "-" * 2 * N + "1",
    "not": ".word " + "~" * N + "1",
    "operand": "addi r1, r0, " + "(" * N + "1" + ")" * N,
    "condition": ".if " + "!" * N + "1\n.endif",
    "alias": ".weakref a,a\n.word a",
    "aliases": ".weakref a,b\n.weakref b,a\n.word a",
    "sum": "x: .word x" + "+1" * 3 * N,
    "division": ".word -0x8000000000000000/-1",
    "remainder": ".word -0x8000000000000000%-1",
    "file": '.file 4000000000 "x"',
    "codeview": ".cv_func_id 4000000000",
    "skip": ".skip 1000000000000000000",
    "product": ".skip 1<<60",
    "org": ".org 1<<31",
    "align": ".byte 1\n.p2align 31",
    "bss": ".bss\n.skip 1<<40",
    "difference": "a: nop\nb: .skip (b-a)*1000000000",
    "fill": ".fill 1000000000000,4,0",
    "dcb": ".dcb.l 1000000000000,0",
    "rept": ".rept 1000000000\nnop\n.endr",
    "empty": ".rept 1000000000\n.endr",
    "place": ".rept .-.+1000000000000\nnop\n.endr",
    "nested": ".rept 1000\n" * 5 + "nop\n" + ".endr\n" * 5,
    "list": ".irp x," + ",".join(["a"] * 50000) + "\n" + ".word \\x\n" * 20000 + ".endr",
    "recursive": ".macro m\nm\nm\n.endm\nm",
    "levels": ".macro m0\n.endm\n" + LEVELS,
    "argument": ".macro m x\n" + ".word \\x\n" * N + ".endm\nm " + "1+" * N + "1",
    "errors": ".rept 100000\nfoo bar\n.endr",
    "zero": '.include "/dev/zero"',
    "bytes": '.incbin "/dev/urandom"',
    "bundle": ".bundle_align_mode 30\nnop",
    "chain": ".set s0, x\n" + "".join(f".set s{i}, s{i - 1}+1\n" for i in range(1, 600)) + ".word s599",
    "double": ".set s0, x-y\n" + "".join(f".set s{i}, s{i - 1}+s{i - 1}\n" for i in range(1, 60)) + ".word s59",
    "negated": ".set s0, x-y\n" + "".join(f".set s{i}, -s{i - 1}+-s{i - 1}\n" for i in range(1, 60)) + ".word s59",
    "labels": "a:" * 3000,
    "itself": '.include "itself.s"',
    "twice": '.include "twice.s"\n.include "twice.s"',
}
# For the compiler, as files and inline; what takes a second is the compiler's with TRAX_LEVELS=all alone.
INLINE = {"parentheses", "division", "alias", "rept", "skip", "sum", "chain", "double"}
if os.environ.get("TRAX_LEVELS") != "all":
    INLINE.remove("chain")
failures = 0


def check(name, command, folder):
    global failures
    try:
        # Within a second; a busy host with sanitizers takes longer, and one that never ends longer still.
        ended = subprocess.run(command, capture_output=True, text=True, errors="replace", timeout=60, cwd=folder)
    except subprocess.TimeoutExpired:
        ended = subprocess.CompletedProcess(command, "no end", "", "")
    if ended.returncode != 1 or not re.search(rf"({name}\.s|<inline asm>|<instantiation>):\d+:",
                                              ended.stderr) or "PLEASE" in ended.stderr or len(
                                                  ended.stderr) > 1 << 22:
        failures += 1
        print(f"{name}: {command}: {ended.returncode}: {ended.stderr[:500]}")


with tempfile.TemporaryDirectory() as folder:
    clang = [MC.parent / "clang", "--target=trax", "-c", "-o", "x.o"]
    for name, text in CASES.items():
        pathlib.Path(folder, f"{name}.s").write_text(text + "\n")
        check(name, [MC, "-filetype=obj", "-o", "x.o", f"{name}.s"], folder)
        if name in INLINE:  # the compiler reads assembly with the same guards
            check(name, [*clang, f"{name}.s"], folder)
            pathlib.Path(folder, f"{name}.c").write_text('void f(void) { __asm__ volatile("' +
                                                         text.replace("\n", "\\n") + '"); }\n')
            check(name, [*clang, f"{name}.c"], folder)
    # A source within the limits is assembled.
    pathlib.Path(folder, "good.s").write_text(".rept 100000\n.word 1\n.endr\n.set n, 100000\n.set s0, x\n" +
                                              "".join(f".set s{i}, s{i - 1}+1\n" for i in range(1, 500)) +
                                              ".rept n\nnop\n.endr\n.fill n*10, 4, 7\n.skip 1<<20\n.word " + "(" * 100 +
                                              "1" + ")" * 100 + "\n")
    subprocess.run([MC, "-filetype=obj", "-o", "good.o", "good.s"], check=True, cwd=folder)
sys.exit(failures != 0)
