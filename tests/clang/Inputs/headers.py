#!/usr/bin/env python3
"""headers.py CLANG FOLDER: every header of C17 that a program finds here, and our own, compiles alone, in C or in C++
by turns (with TRAX_LEVELS=all in both, and as gnu2x, too), without warnings, twice in a row; what C17 promises of each
is declared, and its functions are in the library. Exit status 1 and the compiler's words if not."""

import os
import pathlib
import re
import subprocess
import sys


def read_headers():
    """Returns the names of each header, as headers.txt has them."""
    text = (pathlib.Path(__file__).parent / "headers.txt").read_text(encoding="ascii").replace("\n  ", " ")
    text = re.sub(r"(\w+)\*", r"\1 \1f \1l", text)
    return dict(re.findall(r"^([a-z].*):(.*)", text, re.M))


HEADERS = read_headers()
# Functions that C's headers have as well, but not for a program in plain C.
MORE = {
    "stdio.h": "asprintf dprintf fdopen fileno fseeko getc_unlocked getdelim getline iprintf popen renameat setlinebuf",
    "stdlib.h": "drand48 getprogname malloc_usable_size memalign mkstemp posix_memalign putenv qsort_r rand_r "
                "random realpath setenv",
    "string.h": "bcopy ffs index memmem memrchr stpcpy strcasecmp strcasestr strlcpy strnlen strsep strsignal strtok_r",
    "time.h": "clock_gettime nanosleep strptime", "signal.h": "kill sigaction sigemptyset sigprocmask",
    "setjmp.h": "siglongjmp", "math.h": "lgamma_r sincos", "wchar.h": "wcwidth"}
# Names that programs use for themselves after these headers.
FREE = {header: "time clock difftime gmtime strftime" for header in
        "sys/time.h sys/times.h utime.h unistd.h sys/types.h sys/select.h sys/resource.h sys/wait.h".split()}
FREE["pthread.h"] = "thrd_create mtx_lock wait kill ioctl"
# Missing functions: their use is an error that names a replacement.
WITHOUT = {"stdio.h": "fmemopen open_memstream"}
NOT_IN_CXX = {"uchar.h", "wchar.h", "wctype.h", "threads.h", "stdatomic.h", "stdnoreturn.h", "tgmath.h", "complex.h",
              "stdalign.h", "stdbool.h", "iso646.h"}
# Macros that are not values.
MACROS = set(
    "ONCE_FLAG_INIT alloca assert complex CMPLX CMPLXF CMPLXL offsetof va_start va_arg va_end va_copy UINT8_C "
    "fpclassify isfinite isinf isnan isnormal signbit isgreater isgreaterequal isless islessequal islessgreater "
    "bswap_16 bswap_32 bswap_64 htobe32 le16toh "
    "isunordered atomic_fetch_add atomic_init atomic_flag_test_and_set".split())


def program(header, names, cxx):
    lines = [f"#include <{header}>", f"#include <{header}>"]
    for number, name in enumerate(names):
        if name == "errno":
            lines.append("int get_errno(void);\nint get_errno(void) { return errno; }")
        elif cxx:  # libc++ makes overloaded functions of some macros
            if name not in MACROS and not name[:3].isupper() and name not in ("math_errhandling", "stdin", "stdout",
                                                                              "stderr", "L_tmpnam", "true", "false"):
                lines.append(f"namespace use{number} {{ using ::{name}; }}")
        elif name in MACROS:
            lines += [f"#ifndef {name}", f"#error {name}", "#endif"]
        else:
            lines.append(f"__typeof__(({name})) *use{number};")
    if header == "tgmath.h":
        lines.append(
            "float f(float x, double y);\nfloat f(float x, double y) { return sin(x) + (float)pow(x, y) + "
            "(float)fabs(y); }"
        )
    if header == "assert.h":
        lines.append('static_assert(1, "");')
    if header == "stdalign.h":
        lines.append("alignas(8) int aligned[alignof(int)];")
    if header == "stdnoreturn.h":
        lines.append("noreturn void f(void);")
    return "\n".join(lines) + "\n"


def declared(clang, header, names):
    """Those of the names that the header declares: no error is in their lines."""
    lines = [f"void *f{number} = (void *){name};" for number, name in enumerate(names)]
    text = "\n".join([f"#include <{header}>", '#line 0 "names"', *lines, ""])
    done = subprocess.run([*clang, "-fsyntax-only", "-ferror-limit=0", "-x", "c", "-"], input=text, text=True,
                          stderr=subprocess.PIPE, check=False)
    wrong = {int(number) for number in re.findall(r"^names:(\d+):\d+: error: ", done.stderr, re.MULTILINE)}
    return [name for number, name in enumerate(names) if number not in wrong]


def missing_functions(clang, folder):
    """Returns the linker's output for a program with the address of each function of C."""
    path = os.path.join(folder, "functions.c")
    with open(path, "w", encoding="utf-8") as file:
        for number, (header, names) in enumerate(HEADERS.items()):
            functions = [name for name in names.split() if name.islower() and name not in MACROS and header != "trax.h"]
            functions = [name for name in functions if name not in ("errno", "stdin", "stdout", "stderr", "true",
                                                                    "false", "math_errhandling")]
            file.write(f"#include <{header}>\nvoid *functions{number}[] = {{0")
            file.writelines(f",\n#ifndef {name}\n(void *){name}\n#else\n0\n#endif\n" for name in functions)
            file.write("};\n")
        file.write("int main(void) { return 0; }\n")
    done = subprocess.run([*clang, "-w", path, "-mstack=global", "-Wl,--no-gc-sections", "-Wl,--no-check-stack",
                           "-Wl,--error-limit=0", "-o",
                           os.path.join(folder, "functions")], stderr=subprocess.PIPE, check=False)
    return done.stderr.decode() if done.returncode else ""


def main():
    clang, folder = sys.argv[1:-1], sys.argv[-1]
    os.makedirs(folder, exist_ok=True)
    words = missing_functions(clang, folder)
    print(words, file=sys.stderr)
    failed = bool(words)
    for header, names in WITHOUT.items():
        if wrong := declared(clang, header, names.split()):
            failed = True
            print(f"<{header}> declares {wrong}, which are not here", file=sys.stderr)
    for header, names in MORE.items():
        if wrong := declared([*clang, "-std=c17"], header, names.split()):
            failed = True
            print(f"<{header}> declares {wrong} in C17, which are names of programs", file=sys.stderr)
        for flags in (["-std=gnu17"], ["-std=c17", "-D_POSIX_C_SOURCE=200809L"]):
            if wrong := set(names.split()) - set(declared([*clang, *flags], header, names.split())):
                failed = True
                print(f"<{header}> lacks {wrong} with {flags}", file=sys.stderr)
    for header, names in FREE.items():
        if wrong := declared(clang, header, names.split()):
            failed = True
            print(f"<{header}> declares {wrong}, which are names of programs", file=sys.stderr)
    every = os.environ.get("TRAX_LEVELS") == "all"
    for number, (header, names) in enumerate(HEADERS.items()):
        variants = [("c", "-std=c17")] + ([] if header in NOT_IN_CXX else [("cpp", "-std=c++17")])
        variants = [*variants, ("c", "-std=gnu2x")] if every else [variants[number % len(variants)]]
        for ending, standard in variants:
            path = os.path.join(folder, f"{header[:-2].replace('/', '-')}.{ending}")
            with open(path, "w", encoding="utf-8") as file:
                file.write(program(header, names.split(), ending == "cpp"))
            command = [*clang, "--driver-mode=g++"] if ending == "cpp" else clang
            command = [*command, standard, "-fsyntax-only", "-Wall", "-Wextra", "-Werror", path]
            if header != "tgmath.h":  # the compiler's own, which is not that clean
                command += ["-Wsystem-headers", "-Wno-unused-parameter", "-Wno-user-defined-warnings"]
            done = subprocess.run(command, stderr=subprocess.PIPE, check=False)
            if done.returncode:
                failed = True
                print(f"<{header}> as {standard}:\n{done.stderr.decode()}", file=sys.stderr)
    return failed


if __name__ == "__main__":
    sys.exit(main())
