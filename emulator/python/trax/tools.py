"""The programs beside the library: compiler and ray tracer."""

import os
import pathlib
import shutil
import subprocess

from ._library import HERE, TraxError


def folders():
    """Where the programs may be, the best one first."""
    yield os.environ.get("TRAX_BIN")
    if (HERE.parents[1] / "libtraxemu.so").exists():  # an installation or a build folder, which has this package
        yield HERE.parents[3] / "bin"
    if (HERE / "bin.txt").exists():  # a wheel, which names the build folder that it was made of
        yield (HERE / "bin.txt").read_text().strip()
    on_path = shutil.which("trax-sim")
    yield on_path and os.path.dirname(on_path)


def tool(name):
    """The path of one of trax's programs, such as "trax-sim" or "trax-clang": in the folder that the variable TRAX_BIN
    names, of the installation or build folder of this package, or on the PATH."""
    for folder in folders():
        if folder and pathlib.Path(folder, "trax-sim").exists() and pathlib.Path(folder, name).exists():
            return os.path.join(folder, name)
    raise TraxError(f"{name} is neither beside the package nor on the PATH; the variable TRAX_BIN names its folder")


def sources():
    """lib/trax of the build folder that a wheel was made of, or None: other libraries are in it themselves."""
    if (HERE / "libtraxemu.so").exists() and (HERE / "bin.txt").exists():
        folder = pathlib.Path((HERE / "bin.txt").read_text().strip()).parent / "lib/trax"
        return folder if folder.is_dir() else None
    return None


def call(name, *arguments):
    """Runs a program; TraxError with what it says if it fails."""
    done = subprocess.run([tool(name), *map(os.fspath, arguments)], capture_output=True, text=True, errors="replace",
                          check=False)
    if done.returncode:
        raise TraxError(done.stderr.strip() or f"{name} ended with status {done.returncode}")
    return done.stdout


def compile(*sources, output="program.elf", options=("-O2", "-g")):
    """Compiles and links C or C++ files for the TPs. Returns output, the executable's path. Error: TraxError with the
    compiler's messages."""
    call("trax-clang", "--target=trax", *options, *sources, "-o", output)
    return output


def prepare(*meshes, folder, size=(320, 180), options=()):
    """Imports meshes (or "generate:forest"), compiles the ray tracer for the picture, and writes both into a folder.
    Returns the path of its manifest, which Machine takes. size: (width, height) in pixels. options: further ones of
    trax-render, as in ("--paths", "4", "--view", "conference")."""
    call("trax-render", *meshes, "--size", "{}x{}".format(*size), *options, "--quiet", "--prepare", folder)
    return os.path.join(folder, "manifest.json")
