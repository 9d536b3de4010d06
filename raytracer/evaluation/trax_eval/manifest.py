"""What trax-render --prepare writes (docs/manifest.md)."""

import ctypes
import json
import pathlib

from .util import Problem, write_json

NAME = "manifest.json"


def read_manifest(folder):
    return json.loads(pathlib.Path(folder, NAME).read_text())


class Hash(ctypes.Structure):
    _fields_ = [("low", ctypes.c_uint64), ("high", ctypes.c_uint64)]


def xxh128(data):
    """As xxhsum -H2 prints it, by the library that the programs in C are linked with."""
    try:
        function = ctypes.CDLL("libxxhash.so.0").XXH3_128bits
    except OSError:
        raise Problem("libxxhash.so.0 is not installed (Debian's package is called libxxhash0)") from None
    function.argtypes, function.restype = (ctypes.c_char_p, ctypes.c_size_t), Hash
    found = function(data, len(data))
    return f"{found.high:016x}{found.low:016x}"


def seal(folder, more=()):
    """Writes sizes and hashes of the files as they are now. more: buffers behind those that are there."""
    manifest = read_manifest(folder)
    manifest["buffers"] += more
    for part in (manifest["program"], *manifest["buffers"]):
        if "file" in part:
            data = pathlib.Path(folder, part["file"]).read_bytes()
            part["bytes"], part["xxh128"] = len(data), xxh128(data)
    write_json(pathlib.Path(folder, NAME), manifest)
