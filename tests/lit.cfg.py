"""The lit tests: assembler, code generator, clang, linker and C programs.

A test is a file whose RUN lines all succeed; directories named Inputs hold what they read. Run them with `ninja
check-lit`, or some of them with lit.py -v BUILD/tests/codegen/frames.ll. Substitutions beyond lit's own:

  %clang         clang --target=trax          %trax_sim      the emulator
  %clangxx       clang++ --target=trax        %trax_ld       the linker
  %host_clang    clang, for the host          %trax_mc       assembler and disassembler
  %runtime       directory of crt0.o, libc.a  %trax_llc      LLVM IR to assembly, with the verifier on
  %python        the Python interpreter       %trax_objdump  disassembler of ELF files
  %unwind_test   compares frame information with the call chain (tests/unwind)
  %run_c         run_c.py: compiles a C program at several -O levels, runs each and compares (tests/c; lit_programs.py)

LLVM's tools (FileCheck, not, split-file, yaml2obj, llvm-readelf, ...) are on the PATH. When a program is
missing, the test fails; only ccache.test is unsupported then.
"""

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import lit_programs  # noqa: E402

SUITES = ["mc", "tools", "codegen", "clang", "ld", "c"]

config.name = "trax"
config.suffixes = [".s", ".S", ".ll", ".c", ".cpp", ".test", ".yaml"]
config.test_source_root = os.path.dirname(__file__)
config.test_exec_root = os.path.join(config.trax_build_root, "tests")
config.excludes = ["Inputs"] + [name for name in os.listdir(config.test_source_root) if name not in SUITES]

config.environment["PATH"] = os.pathsep.join([config.trax_bin, config.llvm_bin, config.environment["PATH"]])
config.environment["LC_ALL"] = "C"
# lit's own "not" takes a crash for a failure: what FileCheck reads shows none.
config.environment["FILECHECK_OPTS"] = "--implicit-check-not=Stack{{.}}dump:"
# Reports of sanitizer builds set the exit status; leaks of a compiler that is about to exit are intended.
for variable in ("ASAN_OPTIONS", "UBSAN_OPTIONS", "LSAN_OPTIONS", "TRAX_LEVELS"):
    if variable in os.environ:
        config.environment[variable] = os.environ[variable]


def program(name, *arguments, folder=config.trax_bin):
    return " ".join([os.path.join(folder, name), *arguments])


run_c = ["--clang", program("clang"), "--sim", program("trax-sim"),
         "--expected", os.path.join(config.trax_build_root, "tests", "c")]
config.test_format = lit_programs.Format(run_c)
config.substitutions += [
    ("%clangxx", program("clang++", "--target=trax")),
    ("%clang", program("clang", "--target=trax")),
    ("%host_clang", program("clang")),
    ("%trax_sim", program("trax-sim")),
    ("%trax_ld", program("trax-ld")),
    ("%trax_mc", program("trax-mc")),
    ("%trax_llc", program("trax-llc", "-verify-machineinstrs", folder=config.trax_test_bin)),
    ("%trax_objdump", program("trax-objdump")),
    ("%unwind_test", program("unwind-test", folder=config.trax_test_bin)),
    ("%runtime", os.path.join(config.trax_build_root, "lib", "trax")),
    ("%trax_bin", config.trax_bin),
    ("%trax_source", config.trax_source_root),
    ("%trax_build", config.trax_build_root),
    ("%llvm_include", config.llvm_include),
    ("%{path}", config.environment["PATH"]),
    ("%python", sys.executable),
    ("%cmake", config.cmake),
    ("%run_c", " ".join([
        sys.executable, "-S", "-E",  # without site packages it starts in half the time
        os.path.join(config.test_source_root, "run_c.py"), *run_c])),
]

try:
    import psutil  # noqa: F401 - lit needs it to stop a test that hangs

    lit_config.maxIndividualTestTime = 300
except ImportError:
    pass
