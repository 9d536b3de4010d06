"""The manifest that trax-render --prepare writes (docs/manifest.md)."""

import ctypes
import json
import pathlib

from .util import Problem, write_json

NAME = "manifest.json"


def read_manifest(folder):
    return json.loads(pathlib.Path(folder, NAME).read_text())


class Hash(ctypes.Structure):
    _fields_ = [("low", ctypes.c_uint64), ("high", ctypes.c_uint64)]


def library():
    """The one that the programs in C are linked with."""
    try:
        functions = ctypes.CDLL("libxxhash.so.0")
    except OSError:
        raise Problem("libxxhash.so.0 is not installed (Debian's package is called libxxhash0)") from None
    functions.XXH3_createState.restype = ctypes.c_void_p
    functions.XXH3_128bits_digest.restype = Hash
    return functions


def xxh128_of_file(path):
    """The hash as xxhsum -H2 prints it."""
    functions = library()
    state = ctypes.c_void_p(functions.XXH3_createState())
    try:
        functions.XXH3_128bits_reset(state)
        with open(path, "rb") as file:
            while data := file.read(1 << 20):
                functions.XXH3_128bits_update(state, data, ctypes.c_size_t(len(data)))
        found = functions.XXH3_128bits_digest(state)
    finally:
        functions.XXH3_freeState(state)
    return f"{found.high:016x}{found.low:016x}"


def forget_machine(folder):
    """Machines share inputs, and a job names its own: whichever came first must not stand here."""
    manifest = read_manifest(folder)
    manifest.pop("configuration", None)
    write_json(pathlib.Path(folder, NAME), manifest)


def seal(folder, more=()):
    """Writes the present sizes and hashes of the files. more: further buffers."""
    manifest = read_manifest(folder)
    manifest["buffers"] += more
    for part in (manifest["program"], *manifest["buffers"]):
        if "file" in part:
            path = pathlib.Path(folder, part["file"])
            part["bytes"], part["xxh128"] = path.stat().st_size, xxh128_of_file(path)
    write_json(pathlib.Path(folder, NAME), manifest)
