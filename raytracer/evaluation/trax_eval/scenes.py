"""Scenes: a file each in ../scenes, or beside a sweep, and how their scene files are made."""

import os
import pathlib

from .fields import Fields, find_file, read_fields, unknown
from .tools import run_tools
from .util import Problem, hash_file, hash_value

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
    return {"name": name, "title": fields.text("title", name), "meshes": meshes, "view": view, "folder": str(folder), "licence": fields.text("licence", ""),
            "paper": fields.text("paper", "")}


def inline_scene(path, value):
    """A scene that a sweep has within itself."""
    return scene_of(Fields(f"{path}: scenes", value, INLINE_KEYS), pathlib.Path(path).parent)


def find_scenes(name, beside, sets=True):
    """Those of a name: one, or those of a set of scenes. beside: the folder that relative names of files begin in."""
    path = find_file("scenes", name, beside)
    if not path:
        raise unknown("scenes", name, "scene")
    if not sets or "scenes" not in read_fields(path, (*KEYS, "scenes")).value:
        return [scene_of(read_fields(path, KEYS), path.parent)]
    members = read_fields(path, SET_KEYS).strings("scenes", None)
    return [scene for member in members for scene in find_scenes(member, path.parent, False)]


def find_mesh(directory, name, beside=None):
    """In the folder `beside`, or in that of scenes, where it may be packed."""
    if name.startswith("generate:"):
        return name
    for candidate in (*([pathlib.Path(beside, name)] if beside else []), directory / name, directory / (name + ".xz")):
        if candidate.is_file():
            return str(candidate.resolve())
    raise Problem(f"{directory}: neither {name} nor {name}.xz is there; README.md says where the scenes are to be had")


def neighbours(mesh):
    """Material files and pictures are found beside a mesh: what is there decides whether it is imported anew."""
    folder = pathlib.Path(mesh).parent
    return [(entry.name, entry.stat().st_size, entry.stat().st_mtime_ns) for entry in sorted(os.scandir(folder), key=lambda one: one.name) if entry.is_file()]


PAPERS_LINES = 256  # of the data cache, what trax-scene takes by itself


def order_options(dcache_bytes):
    """trax-scene orders nodes for the data cache that they are for."""
    lines = min(max(dcache_bytes // 64, 1), 4096)
    return [] if lines == PAPERS_LINES else ["--cache-lines", str(lines)]


def plan_scene(out, tools, directory, scene, options, own, only_look=False):
    """The scene file of a scene, and the command that makes it: imported once for the same meshes, options and importer. NAME.trax in the directory comes
    first, unless there are options of its own, those of a workload or a sweep. only_look: no file if none has been imported, and the importer is not needed."""
    name = scene["name"]
    built = directory / f"{name}.trax"
    if built.is_file() and not own:
        return built.resolve(), None
    meshes = [find_mesh(directory, mesh, scene["folder"]) for mesh in scene["meshes"]]
    files = [mesh for mesh in meshes if not mesh.startswith("generate:")]
    if only_look and not any((out / "scenes").glob("*.trax")):
        return None, None
    key = hash_value([tools.hash("trax-scene"), options, meshes, [hash_file(mesh) for mesh in files], [neighbours(mesh) for mesh in files]])
    path = out / "scenes" / f"{name}-{key}.trax"
    return path, [tools.path("trax-scene"), "--quiet", *options, *meshes, "-o", str(path)]


def import_scenes(commands, jobs):
    """Those that are not there yet of {path: command}. Returns what went wrong, by path."""
    missing = {path: command for path, command in commands.items() if not path.exists()}
    for path in missing:
        path.parent.mkdir(parents=True, exist_ok=True)
    paths = list(missing)
    runs = run_tools(list(missing.values()), jobs)
    return {paths[place]: run.stderr.strip() or f"trax-scene ended with status {run.returncode}" for place, run in runs if run.returncode != 0}


def mesh_files(directory, name):
    """Of a scene that comes with trax, in the folder of scenes: for scripts that measure without trax-eval."""
    return [find_mesh(directory, mesh) for mesh in find_scenes(name, ".", False)[0]["meshes"]]
