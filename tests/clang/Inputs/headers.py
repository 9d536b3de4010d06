#!/usr/bin/env python3
"""headers.py CLANG FOLDER: every header of C17 that a program finds here, and our own, compiles alone, in C and in C++, without
warnings, twice in a row; what C17 promises of each is declared. Exit status 1 and the compiler's words if not."""

import os
import subprocess
import sys

# Header: functions and macros that must be usable after it alone (C17 7.x; without what a machine without files and locales lacks).
HEADERS = {
    "alloca.h": "alloca",
    "assert.h": "assert",
    "complex.h": "complex I CMPLX CMPLXF CMPLXL " + " ".join(
        name + suffix for suffix in ("", "f", "l") for name in
        "cacos casin catan ccos csin ctan cacosh casinh catanh ccosh csinh ctanh cexp clog cabs cpow csqrt carg cimag conj cproj creal".split()),
    "ctype.h": "isalnum isalpha isblank iscntrl isdigit isgraph islower isprint ispunct isspace isupper isxdigit tolower toupper",
    "errno.h": "errno EDOM EILSEQ ERANGE",
    "fenv.h": "feclearexcept fegetexceptflag feraiseexcept fesetexceptflag fetestexcept fegetround fesetround fegetenv feholdexcept "
              "fesetenv feupdateenv FE_TONEAREST FE_ALL_EXCEPT FE_DFL_ENV",
    "float.h": "DBL_MAX FLT_EPSILON LDBL_DIG DBL_TRUE_MIN FLT_EVAL_METHOD DECIMAL_DIG",
    "inttypes.h": "imaxabs imaxdiv strtoimax strtoumax PRId64 PRIxPTR SCNuMAX",
    "iso646.h": "",
    "limits.h": "CHAR_BIT INT_MAX LLONG_MIN ULONG_MAX",
    "math.h": "HUGE_VAL HUGE_VALF HUGE_VALL INFINITY NAN FP_ILOGB0 math_errhandling fpclassify isfinite isinf isnan isnormal signbit "
              "isgreater isgreaterequal isless islessequal islessgreater isunordered " + " ".join(
        name + suffix for suffix in ("", "f", "l") for name in
        "acos asin atan atan2 cos sin tan acosh asinh atanh cosh sinh tanh exp exp2 expm1 frexp ilogb ldexp log log10 log1p log2 logb "
        "modf scalbn scalbln cbrt fabs hypot pow sqrt erf erfc lgamma tgamma ceil floor nearbyint rint lrint llrint round lround "
        "llround trunc fmod remainder remquo copysign nan nextafter nexttoward fdim fmax fmin fma".split()),
    "setjmp.h": "setjmp longjmp",
    "stdalign.h": "",
    "stdarg.h": "va_start va_arg va_end va_copy",
    "stdatomic.h": "atomic_fetch_add atomic_init ATOMIC_INT_LOCK_FREE atomic_flag_test_and_set",
    "stdbool.h": "true false",
    "stddef.h": "NULL offsetof",
    "stdint.h": "INT64_MAX UINT8_C SIZE_MAX",
    "stdio.h": "printf vprintf fprintf vfprintf sprintf vsprintf snprintf vsnprintf putchar putc fputc puts fputs fwrite fflush perror "
               "stdout stderr EOF",
    "stdlib.h": "atof atoi atol atoll strtod strtof strtold strtol strtoll strtoul strtoull rand srand RAND_MAX aligned_alloc calloc "
                "free malloc realloc abort atexit exit _Exit bsearch qsort abs labs llabs div ldiv lldiv EXIT_SUCCESS EXIT_FAILURE "
                "MB_CUR_MAX",
    "stdnoreturn.h": "",
    "string.h": "memcpy memmove strcpy strncpy strcat strncat memcmp strcmp strcoll strncmp strxfrm memchr strchr strcspn strpbrk "
                "strrchr strspn strstr strtok memset strerror strlen strtok_r strnlen stpcpy memmem memccpy strdup",
    "strings.h": "strcasecmp strncasecmp",
    "tgmath.h": "",
    "time.h": "clock difftime CLOCKS_PER_SEC",
    "trax.h": "trax_thread",
}
NOT_IN_CXX = {"stdatomic.h", "stdnoreturn.h", "tgmath.h", "complex.h", "stdalign.h", "stdbool.h", "iso646.h"}
# Macros that are not values.
MACROS = set("alloca assert complex CMPLX CMPLXF CMPLXL offsetof va_start va_arg va_end va_copy UINT8_C "
                 "fpclassify isfinite isinf isnan isnormal signbit isgreater isgreaterequal isless islessequal islessgreater "
                 "isunordered atomic_fetch_add atomic_init atomic_flag_test_and_set".split())


def program(header, names, cxx):
    lines = [f"#include <{header}>", f"#include <{header}>"]
    for number, name in enumerate(names):
        if name == "errno":
            lines.append("int get_errno(void);\nint get_errno(void) { return errno; }")
        elif cxx:  # libc++ makes overloaded functions of some macros
            if name not in MACROS and not name[:3].isupper() and name not in ("math_errhandling", "stdout", "stderr", "true", "false"):
                lines.append(f"namespace use{number} {{ using ::{name}; }}")
        elif name in MACROS:
            lines += [f"#ifndef {name}", f"#error {name}", "#endif"]
        else:
            lines.append(f"__typeof__(({name})) *use{number};")
    if header == "tgmath.h":
        lines.append("float f(float x, double y);\nfloat f(float x, double y) { return sin(x) + (float)pow(x, y) + (float)fabs(y); }")
    if header == "assert.h":
        lines.append('static_assert(1, "");')
    if header == "stdalign.h":
        lines.append("alignas(8) int aligned[alignof(int)];")
    if header == "stdnoreturn.h":
        lines.append("noreturn void f(void);")
    return "\n".join(lines) + "\n"


def main():
    clang, folder = sys.argv[1:-1], sys.argv[-1]
    os.makedirs(folder, exist_ok=True)
    failed = False
    for header, names in HEADERS.items():
        variants = [("c", "-std=c17"), ("c", "-std=gnu2x")] + ([] if header in NOT_IN_CXX else [("cpp", "-std=c++17")])
        for ending, standard in variants:
            path = os.path.join(folder, f"{header[:-2]}.{ending}")
            with open(path, "w", encoding="utf-8") as file:
                file.write(program(header, names.split(), ending == "cpp"))
            command = [*clang, "--driver-mode=g++"] if ending == "cpp" else clang
            command = [*command, standard, "-fsyntax-only", "-Wall", "-Wextra", "-Werror", path]
            if header != "tgmath.h":  # the compiler's own, which is not that clean
                command += ["-Wsystem-headers", "-Wno-unused-parameter"]
            done = subprocess.run(command, stderr=subprocess.PIPE, check=False)
            if done.returncode:
                failed = True
                print(f"<{header}> as {standard}:\n{done.stderr.decode()}", file=sys.stderr)
    return failed


if __name__ == "__main__":
    sys.exit(main())
