"""The scenes that sweeps may name, and how their scene files are made."""

import os
import pathlib

from .tools import run_tool
from .util import Problem, hash_file, hash_value

# The paper's four, in the order of Table 2, and one more. Meshes are in the directory of scenes, also as .xz.
CATALOGUE = {
    "conference": {"meshes": ["conference.ply"], "view": "conference"},
    "crytek-sponza": {"meshes": ["crytek-sponza.ply"], "view": "crytek-sponza"},
    "dragon": {"meshes": ["dragon.ply", "dragon_box.obj"], "view": "dragon"},
    "forest": {"meshes": ["generate:forest"], "view": "forest"},  # stands in for the fairy forest, which is not to be had
    "sibenik": {"meshes": ["sibenik.ply"], "view": "sibenik"},
}
SETS = {"paper": ["conference", "crytek-sponza", "dragon", "forest"]}


def find_mesh(directory, name):
    if name.startswith("generate:"):
        return name
    for candidate in (directory / name, directory / (name + ".xz")):
        if candidate.is_file():
            return str(candidate.resolve())
    raise Problem(f"{directory}: neither {name} nor {name}.xz is there; README.md says where the scenes are to be had")


def neighbours(mesh):
    """Material files and pictures are found beside a mesh: what is there decides whether it is imported anew."""
    folder = pathlib.Path(mesh).parent
    return [(entry.name, entry.stat().st_size, entry.stat().st_mtime_ns) for entry in sorted(os.scandir(folder), key=lambda one: one.name) if entry.is_file()]


# What trax-scene is told for a program; the era program's boxes are those of the triangles, not of a grid, and no triangle is split.
IMPORT_OPTIONS = {"ours": [], "era": ["--nodes", "binary", "--splits=1", "--passes", "0"]}


PAPERS_LINES = 256  # of the data cache, what trax-scene takes by itself


def order_options(dcache_bytes):
    """trax-scene orders nodes for the data cache that they are for."""
    lines = min(max(dcache_bytes // 64, 1), 4096)
    return [] if lines == PAPERS_LINES else ["--cache-lines", str(lines)]


def scene_file(out, tools, directory, name, scene, options, more=(), only_look=False):
    """The scene file of a scene; imported once for the same meshes, options and importer. NAME.trax in the directory comes first, unless there
    are more options, those of a workload. only_look: None if it has not been imported."""
    built = directory / f"{name}.trax"
    if built.is_file() and not more:
        return built.resolve()
    meshes = [find_mesh(directory, mesh) for mesh in scene["meshes"]]
    files = [mesh for mesh in meshes if not mesh.startswith("generate:")]
    if only_look and not any((out / "scenes").glob("*.trax")):
        return None
    options = [*options, *more]
    key = hash_value([tools.hash("trax-scene"), options, meshes, [hash_file(mesh) for mesh in files], [neighbours(mesh) for mesh in files]])
    path = out / "scenes" / f"{name}-{key}.trax"
    if only_look and not path.exists():
        return None
    if not path.exists():
        path.parent.mkdir(parents=True, exist_ok=True)
        run = run_tool([tools.path("trax-scene"), "--quiet", *options, *meshes, "-o", path])
        if run.returncode != 0:
            raise Problem(f"{name}: {run.stderr.strip() or f'trax-scene ended with status {run.returncode}'}")
    return path
