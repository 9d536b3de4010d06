"""Fenced blocks of pages, and the commands in them. What stands behind the three backticks says what a block is:

    sh                                    commands, which a test runs in the page's order, in one shell
    text                                  what the commands before it print
    c hello.c (any language and a name)   a file, written before the commands run
    c of PATH (any language)              a part of that file of the sources
    sh long, console long                 commands that take minutes or need files that are not here; only their
                                          options are checked
    sh whole, text whole                  the same, in the tutorial: they need changed sources built anew
    sh recipe                             what the test clang/recipes.test runs
    output                                what a program prints, shown to explain it
    c, python, ... alone                  shown to explain something
    nothing, and first `$ trax-...`       what that command prints; the test commands-help compares it"""

import os
import pathlib
import subprocess

MARK = "@@@ block "


class Failure(Exception):
    pass


def read_blocks(page):
    """(information, text, line) of each fenced block."""
    blocks, inside = [], None
    for number, line in enumerate(page.splitlines(keepends=True), 1):
        if inside is None and line.startswith("```"):
            inside = (line[3:].strip(), [], number)
        elif inside is not None and line.rstrip("\n") == "```":
            blocks.append((inside[0], "".join(inside[1]), inside[2]))
            inside = None
        elif inside is not None:
            inside[1].append(line)
    if inside:
        raise Failure(f"the block of line {inside[2]} has no end")
    return blocks


def kind(words, text):
    """sh, text, file, part, long, whole, shown or help; or None."""
    words = words.split()
    if not words:
        return "help" if text.startswith("$ trax-") else None
    if words[-1] in ("long", "whole") and len(words) == 2 and words[0] in ("sh", "text", "console"):
        return words[-1]
    if words == ["sh", "recipe"]:
        return "shown"
    if words in (["sh"], ["text"]):
        return words[0]
    if len(words) == 1:
        return "shown"
    if len(words) == 2:
        return "file"
    return "part" if len(words) == 3 and words[1] == "of" else None


def run_commands(blocks, root, folder, kinds=("sh", ), path=()):
    """What each block of commands printed, by its line, and what went to standard error. Files go to `folder`."""
    script = ["set -e -o pipefail"]
    folder.mkdir(parents=True, exist_ok=True)
    for words, text, line in blocks:
        what = kind(words, text)
        if what == "file":
            (folder / words.split()[1]).write_text(text)
        elif words.startswith("sh") and what in kinds:
            script += [f"echo '{MARK}{line}'", text]
    environment = {**os.environ, "LC_ALL": "C", "PATH": os.pathsep.join([*map(str, path), os.environ["PATH"]])}
    done = subprocess.run(["bash", "-c", "\n".join(script)], cwd=root, env=environment, stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
    printed = {}
    for part in done.stdout.split(MARK)[1:]:
        line, _, text = part.partition("\n")
        printed[int(line)] = text
    if done.returncode != 0:
        last = max(printed, default=0)
        raise Failure(
            f"the commands of line {last} ended with status "
            f"{done.returncode}:\n{printed.get(last, '')[-2000:]}{done.stderr[-2000:]}"
        )
    return printed, done.stderr


def compare(page, blocks, printed, update):
    """Blocks of text against what the commands before them printed; the page as it should be."""
    lines, wrong, compared, shift = page.splitlines(keepends=True), [], 0, 0
    for (before, _, at), (words, text, line) in zip(blocks, blocks[1:]):
        if words.split()[:1] != ["text"] or at not in printed:
            continue
        if before.split()[:1] != ["sh"]:
            raise Failure(f"line {line}: no commands stand before this text")
        compared += 1
        if printed[at] != text:
            wrong.append(f"line {line}: the page has\n{text}but the commands of line {at} print\n{printed[at]}")
            start, old, new = line + shift, text.splitlines(keepends=True), printed[at].splitlines(keepends=True)
            lines[start:start + len(old)] = new
            shift += len(new) - len(old)
    if wrong and not update:
        raise Failure("\n".join(wrong))
    return "".join(lines), compared


def check_parts(blocks, source):
    """What the page shows of files is in them."""
    for words, text, line in blocks:
        if kind(words, text) == "part" and text not in (source / words.split()[2]).read_text():
            raise Failure(f"line {line}: this is no part of {words.split()[2]}")


def pages(source):
    """Every page that a reader meets."""
    source = pathlib.Path(source)
    named = [
        source / name for name in ("README.md", "CONTRIBUTING.md", "CHANGELOG.md", "tests/isa/README.md",
                                   "raytracer/evaluation/README.md")
    ]
    return [page for page in named if page.exists()] + sorted((source / "docs").rglob("*.md"))
