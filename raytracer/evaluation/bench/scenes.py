"""What the benchmarks share: their scenes, whose meshes are those of trax-eval, and the arguments that each of them takes."""

import argparse
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "raytracer/evaluation"))
from trax_eval.scenes import find_mesh, find_scenes  # noqa: E402
from trax_eval.util import Problem  # noqa: E402

CATALOGUE = {name: find_scenes(name, ".")[0] for name in ("conference", "crytek-sponza", "dragon", "forest", "sibenik")}
# Name, which is the view's, too, and meshes.
SCENES = [(name, CATALOGUE[name]["meshes"]) for name in ("conference", "crytek-sponza", "dragon", "sibenik", "forest")]


def find(directory, mesh):
    """A mesh's place in the directory, perhaps as .xz; a generated one's name."""
    try:
        return find_mesh(directory, mesh)
    except Problem as problem:
        sys.exit(f"{pathlib.Path(sys.argv[0]).name}: error: {problem}")


def files_of(directory, scene):
    """The meshes of the scene of this name."""
    if scene not in CATALOGUE:
        sys.exit(f"{pathlib.Path(sys.argv[0]).name}: error: no scene is called {scene}; there are {', '.join(CATALOGUE)}")
    return [find(directory, mesh) for mesh in CATALOGUE[scene]["meshes"]]


def arguments(description, size):
    """A parser that knows what all of them take; size is the default."""
    parser = argparse.ArgumentParser(description=description.split("\n")[0])
    parser.add_argument("scenes", metavar="SCENES_DIRECTORY", type=pathlib.Path)
    parser.add_argument("--size", default=size)
    parser.add_argument("--bin", type=pathlib.Path, default=ROOT / "build/bin")
    return parser
