#!/usr/bin/env python3
"""Writes the initial cases of the fuzzers. Usage: seeds.py BUILD DIRECTORY

BUILD is a finished build, whose clang compiles. DIRECTORY gets trax-ld/ and trax-objdump/, one file a case, in the form
that fuzz_case.h describes.
"""

import hashlib
import os
import pathlib
import subprocess
import sys
import tempfile

if len(sys.argv) != 3:
    sys.exit(__doc__)
build, directory = sys.argv[1:]
HERE = os.path.dirname(os.path.abspath(__file__))
bindir = os.path.join(build, "bin")
LARGEST = 6000  # bytes; larger files are mutated more slowly and find no more

PROGRAMS = {
    "a.c": """extern int g(int, const char *); extern long long table[4]; __attribute__((weak)) extern void hook(void);
              _Thread_local int counter; int common; static const char *const names[] = {"ab", "b", "cdab"};
              int f(int x) { counter++; if (hook) hook(); return g(x, names[x & 1]) + (int)table[x & 3] + common; }
              __attribute__((constructor)) static void before(void) { common = 5; }
              __attribute__((section("extra"))) int kept; extern int __start_extra[];
              void _start(void) { f(__start_extra[0]); }""",
    "b.c": """struct pair { int first; double second; }; long long table[4] = {1, 2}; static struct pair pairs[3];
              static inline int twice(int x) { return 2 * x; }
              int g(int x, const char *s) { switch (x) { case 0: return 5; case 1: return twice(s[0]);
              case 2: return pairs[1].first; case 3: return twice(x); case 4: return s[1]; case 5: return 77; }
              return x ? g(x - 1, s) : twice(twice(x)); }
              int unused(void) { return g(3, "ab"); }""",
    "c.cpp": """template <class T> struct box { T value; T get() const { return value; } virtual ~box() {} };
                inline int shared(int x) { static int n; return n += x; }
                void operator delete(void *, unsigned) noexcept;
                extern "C" int f(int x) { box<int> b; b.value = x; return shared(b.get()); }
                extern "C" void _start() { f(1); }""", }


def run(*command):
    subprocess.run(command, check=True, stderr=subprocess.PIPE)


def add(program, options, *files):
    """files: pairs of name and bytes."""
    case = options.encode() + b"\n" + b"".join(f"{name} {len(data)}\n".encode() + data for name, data in files)
    if len(case) < 3 * LARGEST:
        with open(os.path.join(directory, program, hashlib.sha1(case).hexdigest()[:12]), "wb") as file:
            file.write(case)


def read(path):
    with open(path, "rb") as file:
        return file.read()


for program in ("trax-ld", "trax-objdump"):
    os.makedirs(os.path.join(directory, program), exist_ok=True)
LISTINGS = ["-d", "-d -l -r", "-S", "-h -t -f", "-D -s", "-x -d"]

with tempfile.TemporaryDirectory() as work:
    objects = {}
    for name, text in PROGRAMS.items():
        source = os.path.join(work, name)
        with open(source, "w", encoding="ascii") as file:
            file.write(text)
        for flags in (["-O0", "-g"], ["-O2", "-g", "-ffunction-sections", "-fdata-sections", "-fcommon"], ["-Os"],
                      ["-O1", "-gz", "-g"], ["-O1", "-gdwarf-5"]):
            output = os.path.join(work, name[0] + ".o")
            run(os.path.join(bindir, "clang"), "--target=trax", "-c", *flags, "-fdebug-compilation-dir=/source",
                "-ffile-prefix-map=" + work + "=/source", source, "-o", output)
            objects[name[0] + "".join(flags)] = data = read(output)
            for listing in LISTINGS:
                add("trax-objdump", listing, ("a.o", data))
    for flags in sorted({key[1:] for key in objects}):
        a, b, c = (objects[letter + flags] for letter in "abc")
        archive = os.path.join(work, "liba.a")
        for kind in ("gnu", "bsd"):
            if os.path.exists(archive):
                os.unlink(archive)
            with open(os.path.join(work, "b.o"), "wb") as file:
                file.write(b)
            run("llvm-ar-19", "rc", "--format=" + kind, archive, os.path.join(work, "b.o"))
            add("trax-ld", "a.o -L. -la --gc-sections --print-gc-sections -Map=-", ("a.o", a),
                ("liba.a", read(archive)))
            add("trax-ld", "a.o --whole-archive liba.a -S", ("a.o", a), ("liba.a", read(archive)))
        add("trax-ld", "a.o b.o", ("a.o", a), ("b.o", b))
        add("trax-ld", "@response", ("a.o", a), ("b.o", b),
            ("response", b"a.o b.o '-u' \"unused\" --wrap=g\n--defsym=__wrap_g=g+4"))
        add("trax-ld", "c.o --print-memory-usage --defsym=_ZdlPvj=f", ("c.o", c))
        add("trax-ld", "a.o b.o c.o", ("a.o", a), ("b.o", b), ("c.o", c))
        image = os.path.join(work, "image")
        for name, data in (("a.o", a), ("b.o", b)):
            with open(os.path.join(work, name), "wb") as file:
                file.write(data)
        run(os.path.join(bindir, "trax-ld"), os.path.join(work, "a.o"), os.path.join(work, "b.o"), "-o", image)
        for listing in LISTINGS:
            add("trax-objdump", listing, ("image", read(image)))

# The objects that the tests of the linker describe.
for path in sorted(pathlib.Path(HERE, "../../tests/ld").rglob("*.yaml")):
    for number in range(1, path.read_text(encoding="utf-8").count("--- !") + 1):
        made = subprocess.run(["yaml2obj-19", f"--docnum={number}", path], capture_output=True, check=False)
        if made.returncode == 0 and len(made.stdout) < LARGEST:  # others need values
            add("trax-ld", "a.o", ("a.o", made.stdout))
            add("trax-ld", "a.o --gc-sections -Map=- -w", ("a.o", made.stdout))
            add("trax-objdump", "-x -d", ("a.o", made.stdout))
