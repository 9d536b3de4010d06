#!/usr/bin/env python3
"""Every option is in --help, in the man page and in the completion: pages_test.py BIN SOURCE

The options are those of the tables in the sources; what is installed is what the commands print."""

import pathlib
import re
import subprocess
import sys

BIN, SOURCE = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
TABLES = {
    "trax-sim": "emulator/host/options.c",
    "trax-scene": "raytracer/scene/trax_scene_options.c",
    "trax-render": "raytracer/render/options.c",
    "trax-compare": "raytracer/render/compare_main.c",
}
LEAST = {"trax-sim": 40, "trax-scene": 25, "trax-render": 50, "trax-compare": 4}
failures = 0


def check(passed, *what):
    global failures
    if not passed:
        failures += 1
        print("FAILED:", *what)


def printed(command, option):
    return subprocess.run([BIN / command, option], capture_output=True, text=True, check=True, timeout=60).stdout


def table(command):
    """Names of the options, and of those that are gone."""
    text = (SOURCE / TABLES[command]).read_text()
    rows = re.findall(r'^ *(?:static const trax_option rows\[\] = \{)?\{"([a-z-]+)",(.*?)(?=^ *(?:\{|TRAX_OPTION))', text, re.MULTILINE | re.DOTALL)
    names = {name for name, rest in rows if ".instead" not in rest} | {"help", "version"}
    return names, {name for name, rest in rows if ".instead" in rest}


def completed(command, *words):
    """What bash offers for the last word."""
    script = BIN.parent / "share/bash-completion/completions" / command
    run = subprocess.run(["bash", "--norc", "-c", 'source "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); "_${1//-/_}"; printf "%s\\n" "${COMPREPLY[@]}"',
                          "bash", script, command, *words], capture_output=True, text=True, timeout=60, cwd=SOURCE / "docs")
    check(run.returncode == 0 and not run.stderr, command, *words, run.stderr)
    return set(run.stdout.split())


def main():
    for command in TABLES:
        names, gone = table(command)
        check(len(names) >= LEAST[command], f"{len(names)} options of {command} are too few to prove anything")
        manual, script = printed(command, "--help-man"), printed(command, "--help-completion")
        for text, place in ((manual, f"man/man1/{command}.1"), (script, f"bash-completion/completions/{command}")):
            check((BIN.parent / "share" / place).read_text() == text, f"share/{place} is not what {command} prints")
        in_help = set(re.findall(r"^ +(?:-\w, )?--([a-z-]+)", printed(command, "--help"), re.MULTILINE))
        in_page = {name.replace("\\-", "-") for name in re.findall(r"^(?:\\fB\\-\w\\fR, )?\\fB\\-\\-([a-z\\-]+?)\\fR", manual, re.MULTILINE)}
        in_script = {word[2:] for word in completed(command, "--")}
        for found, where in ((in_help, "--help"), (in_page, "the man page"), (in_script, "the completion")):
            check(found == names, command, where, "has", sorted(found - names), "and lacks", sorted(names - found))
        for name in gone:
            check(completed(command, f"--{name}") <= names and f"\\-\\-{name}" not in manual, command, name, "is gone")
        check(subprocess.run(["groff", "-man", "-Tascii", "-ww", "-z"], input=manual, capture_output=True, text=True).stderr == "" if have("groff") else True,
              command, "groff warns of the page")
    check(completed("trax-render", "--engine", "") == {"fast", "reference", "native", "embree"}, "choices")
    check(completed("trax-render", "--engine", "re") == {"reference"}, "a choice that is begun")
    check(completed("trax-render", "--engine", "=", "na") == {"native"}, "a choice behind '='")
    check(completed("trax-render", "--size", "1") == set(), "what only the user knows")
    check(completed("trax-sim", "--stats", "manif") == completed("trax-sim", "manif") == {"manifest.md"}, "files")
    check("SS View" in printed("trax-render", "--help-man") and "\nView:\n" in printed("trax-render", "--help"), "headings")
    return failures != 0


def have(program):
    return subprocess.run(["which", program], capture_output=True).returncode == 0


if __name__ == "__main__":
    sys.exit(main())
