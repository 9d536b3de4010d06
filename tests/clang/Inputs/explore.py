"""Does with its properties what Compiler Explorer does: explore.py PROPERTIES SOURCE. It cannot be installed by itself;
these are its commands."""

import subprocess
import sys

properties, source = sys.argv[1:]
with open(properties, encoding="utf-8") as file:
    values = dict(line.rstrip("\n").split("=", 1) for line in file if "=" in line and not line.startswith("#"))
names = values["compilers"].split(":")
if names != ["trax"] or any(not key.startswith("compiler.trax.") for key in values if key != "compilers"):
    sys.exit(f"{properties}: a property of no compiler")


def run(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def value(key):
    return values["compiler.trax." + key]


if "clang version" not in run(value("exe"), "--version"):
    sys.exit("not taken for clang")
run(value("exe"), *value("options").split(), "-g", "-o", "output.s", "-S", "-fcolor-diagnostics",
    "-fno-crash-diagnostics", source)
with open("output.s", encoding="utf-8") as file:
    if "main:" not in (text := file.read()) or ".loc" not in text:
        sys.exit("assembly without a function or without places")
run(value("exe"), *value("options").split(), "-g", "-o", "output.o", "-c", source)
if "<main>:" not in run(value("objdumper"), "-d", "output.o", "-l"):
    sys.exit("no listing of the object")
with open("alone.c", "w", encoding="utf-8") as file:
    file.write('#include <stdio.h>\nint main(void) { puts("run"); return 0; }\n')
run(value("exe"), *value("options").split(), "-g", "-o", "output.elf", "alone.c")
if "run\n" not in run(value("executionWrapper"), "output.elf"):
    sys.exit("the program was not run")
