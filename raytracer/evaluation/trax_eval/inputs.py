"""The inputs of programs: prepared by trax-render, changed by the program's converter, and kept under the hash of the
manifest's description."""

import contextlib
import filecmp
import os
import pathlib
import shutil
import typing

from .manifest import forget_machine, read_manifest, seal
from .programs import Program, convert
from .scratch import new_scratch
from .tools import run_tools
from .util import Problem, hash_file, hash_value, remark
from .workloads import KINDS

WHOLE_FILES = ("whole.trax", "picture.view")  # what trax-render makes a program's inputs of
COUNTERS = "counters"  # the buffer of a program that counts
RAYS = "rays.bin"
SOURCE = "source"  # of a program that trax-render is to compile again


class Request(typing.NamedTuple):
    """The things that inputs are made of."""

    scene: pathlib.Path
    view: str | None
    size: str
    program: Program
    # the figures on which the program depends: TMs and the bytes of an instruction cache; None: it depends on none
    chip: tuple | None
    options: tuple  # of trax-render
    sampling: tuple  # those for a run of some parts
    whole: bool  # trax-render is to run again, to estimate or to measure
    rays: str  # the kind of the picture's rays that are traced again, alone; "": the picture is rendered
    again: tuple  # options of trax-render for that

    def traced(self):
        """The things that a picture's rays are made of."""
        return self.scene, self.view, self.size, self.options


def prepare_inputs(out, tools, requests, jobs, only_look=False):
    """The files that programs read for pictures, several at the same time. requests: by Request, the options of
    trax-render that name its program. Yields (request, description or Problem) as they get ready; the description is
    part of the job. only_look: nothing is kept."""
    with contextlib.ExitStack() as stack:

        def new_folder():
            folder = new_scratch(None if only_look else out)
            stack.callback(shutil.rmtree, folder, ignore_errors=True)
            return folder

        traced = trace_rays(tools, requests, jobs, new_folder())
        waiting = []
        for request, built in requests.items():
            rays = traced[request.traced()] if request.rays else None
            if isinstance(rays, Problem):
                yield request, rays
            elif rays and not (rays / request.rays).exists():
                yield request, Problem(f"{request.scene}: the picture has no rays of kind {request.rays}")
            else:
                waiting.append((request, built, new_folder()))
        runs = stack.enter_context(
            contextlib.closing(run_tools([prepare_command(tools, traced, *one) for one in waiting], jobs)))
        for place, run in runs:
            request, built, folder = waiting[place]
            try:
                if run.returncode != 0:
                    raise Problem(
                        f"{request.scene}: {run.stderr.strip() or f'trax-render ended with status {run.returncode}'}")
                result = keep_inputs(out, request, built, folder, only_look)
            except Problem as problem:
                result = problem
            shutil.rmtree(folder, ignore_errors=True)
            yield request, result


def trace_rays(tools, requests, jobs, folder):
    """The pictures whose rays are traced again: by Request.traced(), a folder with a file of each kind, or Problem."""
    places = {}
    for request in requests:
        if request.rays:
            places.setdefault(request.traced(), os.path.join(folder, str(len(places))))
    commands, pictures, result = [], list(places), {}
    for scene, view, size, options in pictures:
        place = places[scene, view, size, options]
        os.mkdir(place)
        commands.append([
            tools.path("trax-render"), str(scene), "--size", size, *(["--view", view] if view else []), *options,
            "--engine", "native", "--ray-trace", os.path.join(place, RAYS), "--quiet"
        ])
    with contextlib.closing(run_tools(commands, jobs)) as runs:
        for number, run in runs:
            picture = pictures[number]
            result[picture] = pathlib.Path(places[picture])
            if run.returncode != 0:
                result[picture] = Problem(
                    f"{picture[0]}: {run.stderr.strip() or f'trax-render ended with status {run.returncode}'}")
            else:
                split_rays(result[picture])
    return result


def split_rays(folder):
    """A file of each kind of rays (docs/traces.md, "Rays"): a header of 32 bytes, and 64 bytes a ray."""
    data = (folder / RAYS).read_bytes()
    for number, kind in enumerate(KINDS):
        rays = [data[at:at + 64] for at in range(32, len(data), 64) if data[at + 38] == number]
        if rays:
            (folder / kind).write_bytes(data[:32] + b"".join(rays))
    (folder / RAYS).unlink()


def prepare_command(tools, traced, request, built, folder):
    if request.rays:
        queues = ["--queues", str(request.chip[0]), "--set", f"icache.bytes={request.chip[1]}"]
        return [
            tools.path("trax-render"), str(request.scene), "--rays", str(traced[request.traced()] / request.rays),
            "--prepare", folder, "--quiet", *built, *queues, *request.again
        ]
    command = [tools.path("trax-render"), str(request.scene), "--size", request.size, "--prepare", folder, "--quiet"]
    command += ["--write-view", f"{folder}/picture.view"] if request.whole else []
    command += ["--view", request.view] if request.view else []
    command += built
    command += ["--queues", str(request.chip[0]), "--set", f"icache.bytes={request.chip[1]}"] if request.chip else []
    return [*command, *request.options]


def keep_inputs(out, request, built, folder, only_look):
    """The description of prepared inputs, which take their place in the results."""
    program = request.program
    if program.convert:
        convert(program, folder)
    if program.convert or program.counters:
        seal_inputs(program, folder)
    forget_machine(folder)
    description = description_of(read_manifest(folder))
    if request.whole:
        shutil.copyfile(request.scene, pathlib.Path(folder, "whole.trax"))
        description["whole"] = describe_whole(program, built, [*request.options, *request.sampling], folder)
    place = out / "inputs" / hash_value(description)
    if not only_look:
        (place.parent / "bytes").mkdir(parents=True, exist_ok=True)
        os.chmod(folder, 0o755)
        for buffer in description["buffers"]:
            if "file" in buffer:
                share(pathlib.Path(folder, buffer["file"]), place.parent / "bytes" / buffer["xxh128"])
        take_place(folder, place)
    return description


def take_place(folder, place):
    """Moves the folder to the place. If the place is taken, damaged files there are replaced."""
    with contextlib.suppress(OSError):
        os.rename(folder, place)
        return
    for path in sorted(path for path in pathlib.Path(folder).rglob("*") if path.is_file()):
        known = place / path.relative_to(folder)
        if not same_bytes(path, known):
            remark(f"{known}: is damaged; it is made anew")
            known.parent.mkdir(parents=True, exist_ok=True)
            os.replace(path, known)


def same_bytes(path, other):
    return other.is_file() and (path.samefile(other) or filecmp.cmp(path, other, shallow=False))


def describe_whole(program, built, more, folder):
    """The files that trax-render reads when it runs again, and its options."""
    source = built[1] if built[:1] == ["--source"] else None
    if source:
        shutil.copytree(source, pathlib.Path(folder, SOURCE), copy_function=shutil.copyfile)
    files = [
        *WHOLE_FILES,
        *sorted(str(path.relative_to(folder)) for path in pathlib.Path(folder, SOURCE).rglob("*") if path.is_file())
    ]
    return {
        "options": list(more), "program": not program.specialised, "source": bool(source),
        "files": {file: hash_file(pathlib.Path(folder, file)) for file in files}
    }


def seal_inputs(program, folder):
    """The manifest of files that the program's converter may have changed, with the buffer of its counters."""
    more = [{"symbol": COUNTERS, "bytes": 4 *
             len(program.counters), "output": f"{COUNTERS}.raw"}] if program.counters else []
    try:
        seal(folder, more)
    except (OSError, ValueError, TypeError, KeyError) as error:
        raise Problem(
            f"{program.file}: convert: the manifest or a file of it cannot be read any more: {error}") from None


def description_of(manifest):
    """The part of the manifest that decides a result. The machine is the job's."""
    return {name: manifest[name] for name in ("program", "buffers", "items", "picture") if name in manifest}


def share(path, content):
    """Pictures of several sizes have the same scene: it takes its place once, if the file system has hard links."""
    try:
        if same_bytes(path, content):
            beside = path.with_name(path.name + ".link")
            os.link(content, beside)
            os.replace(beside, path)
        else:
            content.unlink(missing_ok=True)
            os.link(path, content)
    except OSError:
        pass
