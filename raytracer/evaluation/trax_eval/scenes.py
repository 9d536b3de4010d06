"""Scenes: a file each in ../scenes, or beside a sweep, and how their scene files are made."""

import os
import pathlib
import re
import typing

from .fields import Fields, find_file, read_fields, unknown
from .manifest import xxh128_of_file
from .tools import run_tools
from .util import Problem, hash_file, hash_value, read_json, read_sealed, remark, write_sealed

KEYS = ("name", "title", "meshes", "view", "licence", "paper")
INLINE_KEYS = ("name", "title", "meshes", "view")
SET_KEYS = ("name", "title", "scenes")


def scene_of(fields, folder):
    """folder: where its files are looked for first."""
    name, meshes, view = fields.name(), fields.value.get("meshes"), fields.value.get("view")
    if not isinstance(meshes, list) or not meshes or not all(isinstance(mesh, str) for mesh in meshes):
        fields.fail("meshes", "expected a list of files")
    if view is not None and not isinstance(view, str):
        fields.fail("view", "expected a file or the name of one that comes with trax")
    if view is not None and pathlib.Path(folder, view).is_file():
        view = str(pathlib.Path(folder, view).resolve())
    return {
        "name": name, "title": fields.text("title", name), "meshes": meshes, "view": view, "folder": str(folder),
        "licence": fields.text("licence", ""), "paper": fields.text("paper", "")
    }


def inline_scene(path, value):
    """A scene that a sweep has within itself."""
    return scene_of(Fields(f"{path}: scenes", value, INLINE_KEYS), pathlib.Path(path).parent)


def find_scenes(name, beside, sets=True):
    """The scenes of a name: one, or those of a set. beside: the folder that relative names of files begin in."""
    path = find_file("scenes", name, beside)
    if not path:
        raise unknown("scenes", name, "scene")
    if not sets or "scenes" not in read_fields(path, (*KEYS, "scenes")).value:
        return [scene_of(read_fields(path, KEYS), path.parent)]
    members = read_fields(path, SET_KEYS).strings("scenes", None)
    return [scene for member in members for scene in find_scenes(member, path.parent, False)]


def is_there(path):
    """Whether there is the mesh, or a frame of it: its number stands for %d or %04d in the name."""
    pattern = re.sub(r"%(0[1-9])?d", "*", re.sub(r"[*?\[]", "[\\g<0>]", path.name), count=1)
    return path.is_file() or "%" in path.name and any(path.parent.glob(pattern))


def find_mesh(directory, name, beside=None):
    """Finds a mesh in the folder `beside`, or in that of scenes, where it may be packed."""
    if name.startswith("generate:"):
        return name
    for candidate in (*([pathlib.Path(beside, name)] if beside else []), directory / name, directory / (name + ".xz")):
        if is_there(candidate):
            return str(candidate.resolve())
    raise Problem(f"{directory}: neither {name} nor {name}.xz is there; trax-eval fetch-scenes fetches the scenes")


PAPERS_LINES = 256  # of the data cache, what trax-scene takes by itself


def order_options(dcache_bytes):
    """trax-scene orders nodes for the data cache that they are for."""
    lines = min(max(dcache_bytes // 64, 1), 4096)
    return [] if lines == PAPERS_LINES else ["--cache-lines", str(lines)]


class Imported(typing.NamedTuple):
    """A scene file in the folder of results, its record, and what makes both."""

    path: pathlib.Path
    record: pathlib.Path  # every file that the importer read, with its hash or None, the scene file's hash, statistics
    command: list  # trax-scene's, without its outputs; None: the scene file is as it was imported


def plan_scene(out, tools, directory, scene, options, hashes, only_look=False):
    """Imported once for the same meshes, options and importer, and the same bytes of every file that the importer read:
    material files and pictures, too. hashes: of files, by path. only_look: None if nothing has been imported, and the
    importer is not needed."""
    name = scene["name"]
    meshes = [find_mesh(directory, mesh, scene["folder"]) for mesh in scene["meshes"]]
    if only_look and not any((out / "scenes").glob("*.trax")):
        return None
    key = hash_value([tools.hash("trax-scene"), options, meshes])
    path, record = (out / "scenes" / f"{name}-{key}.{ending}" for ending in ("trax", "json"))
    command = [tools.path("trax-scene"), "--quiet", *options, *meshes]
    return Imported(path, record, None if is_current(path, record, hashes, not only_look) else command)


def is_current(path, record, hashes, tell):
    """Returns whether the scene file is what an import of the present files would give. tell: damage is noted."""
    try:
        known = read_sealed(record) if record.exists() else None
        damaged = known and path.exists() and hash_file(path) != known["scene"] and f"{path}: is damaged"
    except Problem as problem:
        known, damaged = None, str(problem)
    if damaged and tell:
        remark(f"{damaged}; the scene is imported anew")
    if damaged or not known or not path.exists():
        return False
    for file, digest in known["files"].items():
        if file not in hashes:
            hashes[file] = hash_or_none(os.fsdecode(file.encode("latin-1")))
        if hashes[file] != digest:
            return False
    return True


def hash_or_none(path):
    """None of what trax-scene does not read, either."""
    try:
        return xxh128_of_file(path) if os.path.isfile(path) else None
    except OSError:
        return None


def read_list(path):
    """Reads the output of trax-scene --list-files: names as bytes of any encoding, each byte a letter."""
    files = {}
    for line in path.read_bytes().decode("latin-1").split("\n")[:-1]:
        digest, name = line.removeprefix("\\").split("  ", 1)
        if line[0] == "\\":
            name = re.sub(r"\\(.)", lambda escaped: "\n" if escaped[1] == "n" else escaped[1], name)
        files[name] = None if digest == "-" else digest
    return files


def same_statistics(statistics):
    """Returns the statistics that every import of the meshes gives: without times and memory."""
    return {name: value for name, value in statistics.items() if not re.search(r"\.seconds$|^memory\.", name)}


def import_scenes(wanted, jobs, scratch):
    """wanted: Imported, by path. Returns what went wrong, by path."""
    wanted, problems = list(wanted.values()), {}
    made = [[pathlib.Path(scratch, f"{one.path.stem}.{ending}") for ending in ("trax", "files", "json")]
            for one in wanted]
    commands = [[*one.command, "-o", str(path), "--list-files", str(files), "--stats-json", str(statistics)]
                for one, (path, files, statistics) in zip(wanted, made)]
    for one in wanted:
        one.path.parent.mkdir(parents=True, exist_ok=True)
        one.record.unlink(missing_ok=True)
    for place, run in run_tools(commands, jobs):
        one, (path, files, statistics) = wanted[place], made[place]
        if run.returncode == 0:
            known = {"files": read_list(files), "scene": hash_file(path),
                     "statistics": same_statistics(read_json(statistics))}
            os.replace(path, one.path)
            write_sealed(one.record, known)
        else:
            problems[one.path] = run.stderr.strip() or f"trax-scene ended with status {run.returncode}"
    return problems


def mesh_files(directory, name):
    """The meshes of a scene that comes with trax, in the folder of scenes: for scripts that measure without
    trax-eval."""
    scene = find_scenes(name, ".", False)[0]
    return [find_mesh(directory, mesh, scene["folder"]) for mesh in scene["meshes"]]
