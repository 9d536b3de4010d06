"""What programs read: prepared by trax-render, changed by the program's converter, and kept under the hash of what the manifest says."""

import os
import pathlib
import shutil
import tempfile

from .manifest import read_manifest, seal
from .programs import convert
from .scratch import new_scratch
from .tools import run_tool
from .util import Problem, hash_file, hash_value

WHOLE_FILES = ("whole.trax", "picture.view")  # what trax-render makes a program's inputs of
COUNTERS = "counters"  # the buffer of a program that counts
SOURCE = "source"  # of a program that trax-render is to compile again


def prepare_inputs(out, tools, scene, view, size, program, built, chip, more=(), sampling=(), whole=False, only_look=False):
    """The files that a program reads for a picture; returns their description, which is part of the job. built: options of trax-render that name the
    program. chip: what of it decides about the program, its TMs and the bytes of an instruction cache; None: nothing does. more: options of trax-render;
    sampling: those for a run of some parts. whole: trax-render is to run again, to estimate or to measure. only_look: nothing is kept."""
    scratch = tempfile.mkdtemp(prefix="trax-eval.") if only_look else new_scratch(out)
    try:
        command = [tools.path("trax-render"), str(scene), "--size", size, "--prepare", scratch, "--quiet"]
        command += ["--write-view", f"{scratch}/picture.view"] if whole else []
        command += ["--view", view] if view else []
        command += built
        command += ["--queues", str(chip[0]), "--set", f"icache.bytes={chip[1]}"] if chip else []
        command += more
        run = run_tool(command)
        if run.returncode != 0:
            raise Problem(f"{scene}: {run.stderr.strip() or f'trax-render ended with status {run.returncode}'}")
        if program.convert:
            convert(program, scratch)
        if program.convert or program.counters:
            seal_inputs(program, scratch)
        description = description_of(read_manifest(scratch))
        if whole:
            shutil.copyfile(scene, pathlib.Path(scratch, "whole.trax"))
            description["whole"] = describe_whole(program, built, [*more, *sampling], scratch)
        place = out / "inputs" / hash_value(description)
        if not only_look and not place.exists():
            (place.parent / "bytes").mkdir(parents=True, exist_ok=True)
            os.chmod(scratch, 0o755)
            for buffer in description["buffers"]:
                if "file" in buffer:
                    share(pathlib.Path(scratch, buffer["file"]), place.parent / "bytes" / buffer["xxh128"])
            try:
                os.rename(scratch, place)
            except OSError:
                if not place.exists():  # somebody else was faster otherwise
                    raise
        return description
    finally:
        shutil.rmtree(scratch, ignore_errors=True)


def describe_whole(program, built, more, folder):
    """The files that trax-render reads when it runs again, and its options."""
    source = built[1] if built[:1] == ["--source"] else None
    if source:
        shutil.copytree(source, pathlib.Path(folder, SOURCE), copy_function=shutil.copyfile)
    files = [*WHOLE_FILES, *sorted(str(path.relative_to(folder)) for path in pathlib.Path(folder, SOURCE).rglob("*") if path.is_file())]
    return {"options": list(more), "program": not program.specialised, "source": bool(source), "files": {file: hash_file(pathlib.Path(folder, file)) for file in files}}


def seal_inputs(program, folder):
    """The manifest of files that the program's converter may have changed, with the buffer of its counters."""
    more = [{"symbol": COUNTERS, "bytes": 4 * len(program.counters), "output": f"{COUNTERS}.raw"}] if program.counters else []
    try:
        seal(folder, more)
    except (OSError, ValueError, TypeError, KeyError) as error:
        raise Problem(f"{program.file}: convert: the manifest or a file of it cannot be read any more: {error}") from None


def description_of(manifest):
    """What of the manifest decides a result: a job has a machine of its own."""
    return {name: manifest[name] for name in ("program", "buffers", "items", "picture")}


def share(path, content):
    """Pictures of several sizes have the same scene: it takes its place once, if the file system has hard links."""
    try:
        if content.exists():
            beside = path.with_name(path.name + ".link")
            os.link(content, beside)
            os.replace(beside, path)
        else:
            os.link(path, content)
    except OSError:
        pass
