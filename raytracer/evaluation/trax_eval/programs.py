"""Programs for the TPs: a file each in ../programs, or beside a sweep. The format is in ../README.md."""

import dataclasses
import functools
import os
import pathlib
import re
import shutil
import subprocess
import sys

from .fields import INSTALLED, find_file, read_fields, unknown
from .tools import run_tool
from .util import Problem, canonical

KEYS = ("name", "title", "like", "program", "source", "flags", "patch", "scene", "render", "set", "convert", "counters",
        "rays")
SET_KEYS = ("name", "title", "programs")
SPECIALISED = "specialised"  # trax-render makes it for scene, view and chip
DEVICE = "raytracer"  # its source, in the installation
FLAGS = ("--target=trax", "-std=c17", "-O3", "-g", "-fdebug-compilation-dir=.")
MOST_COUNTERS = 1024


@dataclasses.dataclass(eq=False)
class Program:
    """The contents of a program's file. Each file has one object."""

    name: str
    title: str
    file: str
    program: str
    # the ELF or C file, or the folder of a specialised program's source; None: the installation's
    source: pathlib.Path | None
    flags: list
    patches: list
    scene: list  # options of trax-scene
    render: list  # and of trax-render
    settings: tuple  # of the machine: (key, value), unless the sweep says otherwise
    convert: list  # a command
    counters: list
    rays: bool  # it takes workloads, and tells where rays begin

    @property
    def specialised(self):
        return self.program == SPECIALISED

    @property
    def plain(self):
        """Returns whether trax-render runs the program as it is: nothing is compiled or changed here."""
        return not (self.patches or self.convert or self.counters or self.program.endswith(".c") or
                    self.source and self.specialised)

    @property
    def can_be_sampled(self):
        """Returns whether trax-render runs the program: as it is, or compiled from another source."""
        return self.plain or self.specialised and not (self.convert or self.counters)


def check_settings(fields):
    value = fields.value.get("set", {})
    if not isinstance(value, dict) or not all(
            isinstance(item, (bool, int, float)) or isinstance(item, str) and item.isalpha()
            for item in value.values()):
        fields.fail("set",
                    f"expected an object of keys of the machine, each with a number or a word, is {canonical(value)}")
    return tuple(value.items())


def read_members(path, seen=()):
    """The file's members and, under `like`, those of another program that it does not have: (Fields, the folder of the
    file that says each)."""
    path = pathlib.Path(path).resolve()
    fields = read_fields(path, KEYS)
    folders = dict.fromkeys(fields.value, path.parent)
    if "like" in fields.value:
        base = find_file("programs", fields.text("like", ""), path.parent)
        if not base or base.resolve() in (path, *seen):
            fields.fail("like", f'"{fields.value["like"]}" is no other program')
        others, other_folders = read_members(base, (path, *seen))
        fields.value = {key: value
                        for key, value in others.value.items() if key not in ("name", "title")} | fields.value
        folders = other_folders | folders
    return fields, folders


@functools.lru_cache(maxsize=None)
def read_program(path):
    fields, folders = read_members(path)
    name = fields.name()

    def place(key, text):
        """Returns the path beside the file that names it, or in the installation."""
        for candidate in (folders[key] / text, INSTALLED / text):
            if candidate.exists():
                return candidate
        fields.fail(key, f"{text} is neither in {folders[key]} nor in {INSTALLED}")

    program = fields.text("program", "")
    if program != SPECIALISED and not re.fullmatch(r".+\.(elf|c)", program):
        fields.fail("program",
                    f'expected "{SPECIALISED}", "FILE.elf" or "FILE.c", is {canonical(fields.value.get("program"))}')
    source = None
    if program == SPECIALISED:
        source = place("source", fields.text("source", "")) if "source" in fields.value else None
    elif "source" in fields.value:
        fields.fail("source", f'is for "program": "{SPECIALISED}"')
    else:
        source = place("program", program)
    patches = [place("patch", text) for text in (fields.strings("patch", []) if "patch" in fields.value else [])]
    flags = fields.words("flags", "options of the compiler")
    if program.endswith(".elf") and (patches or flags):
        fields.fail("patch" if patches else "flags", "is for a program that is compiled")
    if program == SPECIALISED and flags:
        fields.fail("flags", f'is for "FILE.c"; {program} programs are compiled by trax-render')
    counters = fields.words("counters", "names")
    if len(counters) > MOST_COUNTERS or len(set(counters)) != len(counters) or not all(
            re.fullmatch(r"[\w.]+", counter) for counter in counters):
        fields.fail("counters",
                    f"expected at most {MOST_COUNTERS} names of letters, digits, . and _, none of them twice")
    options = {key: fields.words(key, "the options and their values") for key in ("scene", "render")}
    convert = [
        str(folders["convert"] / word) if (folders["convert"] / word).is_file() else word
        for word in fields.words("convert", "a command and its arguments")
    ]
    return Program(name, fields.text("title", name), str(path), program, source, flags, patches, options["scene"],
                   options["render"], check_settings(fields), convert, counters, fields.flag("rays"))


def find_programs(name, beside, sets=True):
    """The programs of a name: one, or those of a set. beside: the folder that relative names of files begin in."""
    path = find_file("programs", name, beside)
    if not path:
        raise unknown("programs", name, "program")
    path = path.resolve()
    if not sets or "programs" not in read_fields(path, (*KEYS, "programs")).value:
        return [read_program(path)]
    members = read_fields(path, SET_KEYS).strings("programs", None)
    return [program for member in members for program in find_programs(member, path.parent, False)]


# --- what trax-render is given


def compiler_failed(program, run):
    said = next((line for line in run.stderr.splitlines() if "error" in line), run.stderr.strip())
    raise Problem(f"{program.file}: program: {said or f'clang ended with status {run.returncode}'}")


def patched(program, folder, scratch):
    """A copy of the folder with the program's patches."""
    copy = pathlib.Path(scratch, "source")
    shutil.copytree(folder, copy, copy_function=shutil.copyfile)
    for patch in program.patches:
        try:  # git would look for a repository above, and leave out what is not in it
            run = subprocess.run(
                ["git", "apply", "--whitespace=nowarn", str(patch)], cwd=copy, capture_output=True, text=True,
                errors="replace", env=os.environ | {"GIT_CEILING_DIRECTORIES": str(copy.parent)})
        except FileNotFoundError:
            raise Problem(f"{program.file}: patch: git is not installed") from None
        if run.returncode != 0:
            raise Problem(
                f"{program.file}: patch: {patch.name} does not fit {folder}: "
                f"{run.stderr.strip().splitlines()[-1] if run.stderr.strip() else 'git apply failed'}"
            )
    return copy


def build(tools, program, scratch):
    """Options of trax-render that name the program, which is in `scratch` if it must be compiled."""
    if program.specialised:
        source = program.source or INSTALLED / DEVICE
        if program.patches:
            source = patched(program, source, scratch)
        return ["--source", str(source)] if program.patches or program.source else []
    if program.program.endswith(".elf"):
        return ["--program", str(program.source)]
    folder = patched(program, program.source.parent, scratch) if program.patches else program.source.parent
    elf = pathlib.Path(scratch, "program.elf")
    process = run_tool([
        tools.path("trax-clang"), *FLAGS, *program.flags, "-I",
        str(INSTALLED / DEVICE), program.source.name, "-o",
        str(elf)
    ], cwd=folder)
    if process.returncode != 0:
        compiler_failed(program, process)
    return ["--program", str(elf)]


def convert(program, folder):
    """The program's command on what trax-render has prepared."""
    for path in pathlib.Path(folder).iterdir():
        path.chmod(0o644)
    command = [sys.executable if program.convert[0] == "python3" else program.convert[0], *program.convert[1:]]
    if not shutil.which(os.path.join(folder, command[0]) if "/" in command[0] else command[0]):
        raise Problem(f"{program.file}: convert: {command[0]}: No such file or directory, or no program")
    run = run_tool(command, cwd=folder, env=os.environ | {"PYTHONDONTWRITEBYTECODE": "1"})
    if run.returncode != 0:
        raise Problem(
            f"{program.file}: convert: "
            f"{run.stderr.strip().splitlines()[-1] if run.stderr.strip() else f'it ended with status {run.returncode}'}"
        )
