#!/usr/bin/env python3
"""Every option is in --help, in the man page and in the completion: pages_test.py BIN SOURCE

The options are those of the tables in the sources; what is installed is what the commands print."""

import os
import pathlib
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import checking  # noqa: E402
from checking import check  # noqa: E402

BIN, SOURCE = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
TABLES = {
    "trax-sim": "emulator/host/options.c",
    "trax-scene": "raytracer/scene/trax_scene_options.c",
    "trax-render": "raytracer/render/options.c",
    "trax-compare": "raytracer/render/compare_main.c",
}
EXPLAIN = SOURCE / "emulator/include/trax/explain.h"  # the options that explain a run
LEAST = {"trax-sim": 40, "trax-scene": 25, "trax-render": 50, "trax-compare": 4}


def printed(command, option):
    return subprocess.run([BIN / command, option], capture_output=True, text=True, check=True, timeout=60).stdout


def table(command):
    """Names of the options, and of those that are gone."""
    text = (SOURCE / TABLES[command]).read_text()
    rows = re.findall(r'^ *(?:static const trax_option rows\[\] = \{)?\{"([a-z-]+)",(.*?)(?=^ *(?:\{|TRAX_OPTION))',
                      text, re.MULTILINE | re.DOTALL)
    rows = [(name, rest) for name, rest in rows if ".meaning" in rest or ".instead" in rest]
    names = {name for name, rest in rows if ".instead" not in rest} | {"help", "version"}
    if "TRAX_EXPLAIN_FILES" in text:
        names |= set(re.findall(r'^ *X\(\w+, "([a-z-]+)"', EXPLAIN.read_text(), re.MULTILINE))
    return names, {name for name, rest in rows if ".instead" in rest}


def completed(command, *words, folder=SOURCE / "docs"):
    """What bash offers for the last word, as in a shell that finds the programs."""
    script = BIN.parent / "share/bash-completion/completions" / command
    run = subprocess.run([
        "bash", "--norc", "-c",
        'source "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); "_${1//-/_}"; printf "%s\\n" "${COMPREPLY[@]}"',
        "bash", script, command, *words], capture_output=True, text=True, timeout=60, cwd=folder,
                         env=os.environ | {"PATH": f"{BIN}:{os.environ['PATH']}"})
    check(run.returncode == 0 and not run.stderr, command, *words, run.stderr)
    return set(run.stdout.splitlines()) - {""}


# Words, and what the completion offers for the last of them, besides files.
OFFERED = """\
trax-sim --config 4x -> 4x32 4x48 4x64
trax-sim --engine '' -> fast reference functional simt
trax-sim --main-on '' -> 0 all
trax-sim --set dcache. -> dcache.bytes= dcache.line_bytes=
trax-sim comp -> compare
trax-sim compare -- -> --all --json --html --picture --cost-picture --help
trax-sim compare inde -> index.md
trax-render --config 8x64 -> 8x64
trax-render --set l2.b -> l2.bytes= l2.banks=
trax-render --view for -> forest
trax-render --view inde -> index.md
trax-render --cost cyc -> cycles
trax-render --cost wait_m -> wait_memory
trax-render --material m -> mirror
trax-render --nodes '' -> auto binary quantised
trax-scene --material '' -> lambert mirror glass ggx: emit:
trax-scene --normals '' -> file smooth flat"""


def main():
    for command in TABLES:
        check(re.search(r"^\S[^:]*:$", printed(command, "--help"), re.MULTILINE), command, "--help has no groups")
        names, gone = table(command)
        check(len(names) >= LEAST[command], f"{len(names)} options of {command} are too few to prove anything")
        place = f"bash-completion/completions/{command}"
        check((BIN.parent / "share" / place).read_text() == printed(command, "--help-completion"),
              f"share/{place} is not what {command} prints")
        in_help = set(re.findall(r"^ +(?:-\w, )?--([a-z-]+)", printed(command, "--help"), re.MULTILINE))
        in_script = {word[2:] for word in completed(command, "--")}
        for found, where in ((in_help, "--help"), (in_script, "the completion")):
            check(found == names, command, where, "has", sorted(found - names), "and lacks", sorted(names - found))
        for name in gone:
            check(completed(command, f"--{name}") <= names, command, name, "is gone")
    check(completed("trax-render", "--engine", "") == {"fast", "reference", "native", "embree", "exact"}, "choices")
    check(completed("trax-render", "--engine", "re") == {"reference"}, "a choice that is begun")
    check(completed("trax-render", "--engine", "=", "na") == {"native"}, "a choice behind '='")
    for row in OFFERED.splitlines():
        words, expected = row.split(" -> ")
        there, expected = completed(*words.replace("''", "").split(" ")), set(expected.split())
        check(expected <= there, words, "offers", sorted(there), "and not", sorted(expected - there))
    for command in TABLES:
        heads = [f".SH {head}\n" in page(command) for head in ("EXAMPLES", "SEE ALSO")]
        check(all(heads) and "\nExamples:\n" in printed(command, "--help"), command, "has no examples")
    check(completed("trax-render", "--size", "1") == set(), "what only the user knows")
    check(completed("trax-sim", "--stats", "manif") == completed("trax-sim", "manif") == {"manifest.md"}, "files")
    with tempfile.TemporaryDirectory() as folder:
        pathlib.Path(folder, "two words.elf").touch()
        for command, *words in (("trax-sim",), ("trax-sim", "--stats"), ("trax-render", "--view"), ("trax-eval",),
                                ("trax-eval", "report"), ("trax-ld",)):
            for begun in ("two", "two\\ w"):
                found = completed(command, *words, begun, folder=folder)
                check(found == {"two words.elf"}, "a name with a blank:", command, *words, begun, found)
    evaluation_completion()
    help_pages()
    return checking.failures != 0


def stems(folder):
    return {path.stem for path in (SOURCE / "raytracer/evaluation" / folder).glob("*.json")}


def evaluation_completion():
    """trax-eval: the options of its help, their values, and experiments."""
    script = printed("trax-eval", "--help-completion")
    check((BIN.parent / "share/bash-completion/completions/trax-eval").read_text() == script,
          "the installed completion is not what trax-eval prints")
    told = printed("trax-eval", "--help")
    options = set(re.findall(r"^ +(?:-\w, )?--([a-z-]+)", told, re.MULTILINE))
    commands = set(re.findall(r"^ +trax-eval ([a-z][a-z-]*) ", told, re.MULTILINE))
    check({word[2:] for word in completed("trax-eval", "--")} == options and len(options) >= 16,
          "options of trax-eval:", completed("trax-eval", "--"))
    experiments = stems("sweeps")
    for words in ([""], ["--quick", ""]):
        found = completed("trax-eval", *words)
        wanted = experiments | commands | {"compare", "job", "index.md"}
        check(wanted <= found and len(experiments) >= 30 and len(commands) >= 4, "experiments and commands:",
              sorted(wanted - found))
    check(completed("trax-eval", "table2", "table") == {"table1", "table2", "table3"}, "an experiment that is begun")
    for words, expected in ((["--mode", ""], {"exact", "quick"}), (["--mode", "=", "q"], {"quick"}),
                            (["--size", "1"], set()),
                            (["--jobs", ""], set()), (["--chip", "4x32,8x4"], {"4x32,8x48"}),
                            (["--program", "pap"], {"paper"}),
                            (["--scene", "sibenik,cryt"], {"sibenik,crytek-sponza"}), (["--scene", "ind"], set()),
                            (["--chip", "ind"], {"index.md"}), (["-o", "resu"], {"results"}), (["-o", "inde"], set()),
                            (["docs", "--"], {"--anew", "--check", "--help"}),
                            (["report", "--"], {"--help", "--output", "--paper"}),
                            (["report", "inde"], {"index.md"})):
        check(completed("trax-eval", *words) == expected, *words, completed("trax-eval", *words))
    check(stems("programs") <= completed("trax-eval", "--program", ""), "programs of trax-eval")
    check(stems("scenes") <= completed("trax-eval", "--scene", ""), "scenes of trax-eval")


# Programs, with the least number of options that prove something.
HELPED = {"trax-ld": 30, "trax-mc": 6, "trax-objdump": 20, "trax-eval": 15, **LEAST}


def names_in(text):
    return set(re.findall(r"(?<![\w-])--?[A-Za-z][\w-]*", text))


def help_pages():
    """The page has every option of the help, and headings where the help has them."""
    for command, least in HELPED.items():
        shown = printed(command, "--help")
        options = {
            name
            for line in shown.splitlines()
            for name in names_in((re.match(r"  +(-.*?)(?:  | - |$)", line) or ["", ""])[1])}
        check(len(options) >= least, f"{len(options)} options of {command} are too few to prove anything")
        check(len(re.findall(r"^\S[^:]*:$", shown, re.MULTILINE)) >= 2, command, "--help has no groups")
        manual = page(command)
        there = names_in(manual.replace("\\-", "-").replace("\\fB", " ").replace("\\fR", " "))
        check(options <= there, f"the page of {command} lacks", sorted(options - there))
        check(manual.count("\n.SS ") >= 2, f"the page of {command} has no groups")
        if command in TABLES:
            continue
        there = completed(command, "-")
        check({name for name in options if name.startswith("-")} == there or command == "trax-eval",
              f"the completion of {command}:", sorted(options ^ there))
        check(completed(command, "inde") == {"index.md"}, f"files behind {command}")
    check("aarch64" not in printed("trax-mc", "--help"), "trax-mc --help lists the options of other targets")
    clang = page("trax-clang").replace("\\-", "-").replace("\\fI", "").replace("\\fR", "")
    own = re.findall(r"^  (-[\w-]+=?)\S* .*$\n?(?=.*)",
                     "\n".join(line for line in printed("trax-clang", "--help").splitlines() if "trax: " in line),
                     re.MULTILINE)
    check(len(own) == 3, "clang's own options:", own)
    for name in own:
        check(f"\\fB{name}" in clang, "the page of trax-clang lacks", name)
    check("trax-clang.1" in page("trax-clang++"), "trax-clang++ has the page of trax-clang")
    for words, expected in ((["-mstack-s"], {"-mstack-size="}), (["-mstack", "="], {"either", "global", "local"}),
                            (["-O2", "-mstack", "=", "gl"], {"global"}), (["-c", "inde"], {"index.md"})):
        check(completed("trax-clang", *words) == expected, "trax-clang", *words, completed("trax-clang", *words))


def page(command):
    text = (BIN.parent / f"share/man/man1/{command}.1").read_text()
    if have("groff") and not text.startswith(".so"):
        warnings = subprocess.run(["groff", "-man", "-Tascii", "-ww", "-z"], input=text, capture_output=True,
                                  text=True).stderr
        check(warnings == "", command, "groff warns of the page:", warnings)
    return text


def have(program):
    return subprocess.run(["which", program], capture_output=True).returncode == 0


if __name__ == "__main__":
    sys.exit(main())
