"""trax-eval fetch-scenes: the meshes of the scenes, from packages and from their authors' pages (docs/scenes.md).

    trax-eval fetch-scenes [-o DIR] [--from PLACE] [--alike] [SCENE...]
    trax-eval fetch-scenes --list
    trax-eval fetch-scenes --hash MESH...

Meshes appear in the folder of scenes whole, after their geometry was compared with the hash that this program knows.
No file that is there is replaced. The same command goes on with what is missing."""

import argparse
import os
import pathlib
import shutil
import sys
import tempfile

from trax_eval.fields import installed
from trax_eval.scenes import find_scenes
from trax_eval.util import Once, Parser, Problem, complain, remark

from .folder import work_folder
from .geometry import geometry_hash, import_triangles
from .meshes import Fetcher
from .problems import Failed
from .sources import MESHES, read_meshes


def new_parser():
    parser = Parser(prog="trax-eval fetch-scenes", description=__doc__, allow_abbrev=False,
                    formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="SCENE",
                        help="scenes, or files of meshes (default: all that this program knows)")
    parser.add_argument("-o", "--output", action=Once, metavar="DIR", default=os.environ.get("TRAX_SCENES") or "scenes",
                        help="the folder of scenes (default: the variable TRAX_SCENES, or else ./scenes)")
    parser.add_argument("--from", dest="mirror", metavar="PLACE", default=os.environ.get("TRAX_SCENES_FROM"),
                        help="an address or a folder that has the meshes (NAME.ply, also as .xz or .gz) or the files "
                        "of the sources, instead of the sources (default: the variable TRAX_SCENES_FROM)")
    parser.add_argument("--alike", action="store_true",
                        help="also take a mesh with another hash, but that number, bounds and area of triangles")
    parser.add_argument("--sources", metavar="FILE.json", type=pathlib.Path, default=MESHES,
                        help="a list of meshes and sources of your own")
    parser.add_argument("--list", action="store_true", help="print meshes, hashes, licences and sources, and end")
    parser.add_argument("--hash", action="store_true", help="print the hash of the geometry of each MESH, and end")
    parser.add_argument("-q", "--quiet", action="store_true", help="no progress")
    return parser


def meshes_named(names, known):
    """The meshes of scenes and of files, each once, in the order of the list."""
    wanted = set()
    for name in names:
        if name in known:
            wanted.add(name)
        elif name in installed("scenes"):
            files = [file for scene in find_scenes(name, ".") for file in scene["meshes"]]
            wanted.update(file for file in files if file in known)
            for file in files:
                if file.startswith("generate:"):
                    remark(f"{name}: {file} needs no file: trax-scene makes it")
        else:
            raise Problem(f'"{name}" is neither a scene ({", ".join(installed("scenes"))}) nor one of the meshes '
                          f'({", ".join(known)})')
    return [mesh for mesh in known.values() if mesh.file in wanted or not names]


def print_list(meshes):
    for mesh in meshes:
        print(f"{mesh.file}: {mesh.measures['triangles']:,} triangles with an area")
        for label, text in (("geometry", mesh.geometry), ("licence", mesh.licence()), ("note", mesh.note)):
            if text:
                print(f"  {label}: {text}")
        for source in mesh.sources:
            print(f"  from: {source}{f', {source.member}' if source.member else ''}"
                  f"{f' ({source.note})' if source.note else ''}")


def print_hashes(tools, paths):
    with tempfile.TemporaryDirectory(prefix="trax-eval.") as scratch:
        for path in paths:
            try:
                print(f"{geometry_hash(import_triangles(tools, [path], pathlib.Path(scratch)))}  {path}", flush=True)
            except Failed as failed:
                raise Problem(failed) from failed


class Screen:
    """Prints progress: lines, and on a terminal one line that is rewritten."""
    def __init__(self, quiet):
        self.quiet, self.terminal = quiet, sys.stderr.isatty() and not quiet

    def line(self, text):
        if not self.quiet:
            print(f"{self.clear()}trax-eval: {text}", file=sys.stderr, flush=True)

    def clear(self):
        return "\r\033[K" if self.terminal else ""

    def bytes(self, name, there, whole):
        if self.terminal:
            of = f" of {whole / 1e6:.1f}" if whole else ""
            width = shutil.get_terminal_size().columns - 1
            text = f"trax-eval: {name}: {there / 1e6:.1f}{of} MB"[:width]
            print(f"{self.clear()}{text}", end="", file=sys.stderr, flush=True)


def mirror_of(text):
    """A folder, or an address without its last slash; None if there is no mirror."""
    if not text:
        return None
    if text.startswith(("http://", "https://")):
        return text.rstrip("/")
    if not pathlib.Path(text).is_dir():
        raise Problem(f"--from {text}: is neither a folder nor an address that begins with http:// or https://")
    return pathlib.Path(text)


def fetch(options, meshes, tools):
    folder = pathlib.Path(options.output)
    if folder.exists() and not folder.is_dir():
        raise Problem(f"{folder}: is no folder")
    mirror, screen, missing = mirror_of(options.mirror), Screen(options.quiet), 0
    with work_folder(folder) as scratch:
        fetcher = Fetcher(tools, folder, scratch, mirror, options.alike, screen.line, screen.bytes)
        for mesh in meshes:
            try:
                print(f"{mesh.file}: {fetcher.fetch(mesh)}", flush=True)
            except Problem as problem:
                print(screen.clear(), end="", file=sys.stderr)
                complain("trax-eval", problem)
                missing += 1
    print(f"{len(meshes) - missing} of {len(meshes)} meshes are in {folder}")
    return 1 if missing else 0


def main(arguments, tools):
    options = new_parser().parse_intermixed_args(arguments)
    if options.hash:
        if not options.names:
            raise Problem("fetch-scenes: --hash: no mesh was named")
        print_hashes(tools, options.names)
        return 0
    meshes = meshes_named(options.names, read_meshes(options.sources))
    if options.list:
        print_list(meshes)
        return 0
    return fetch(options, meshes, tools)
