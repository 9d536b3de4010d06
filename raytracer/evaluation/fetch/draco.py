"""Meshes of a GLB file that Draco has packed: Debian's draco_decoder unpacks each, and trax-scene reads the results.
Transforms of nodes are not applied: positions are those of the meshes."""

import json
import shutil
import struct

from trax_eval.tools import run_tool

from .problems import Failed

EXTENSION = "KHR_draco_mesh_compression"


def chunks_of(data):
    """The JSON and the binary chunk of a GLB file."""
    if data[:8] != b"glTF" + struct.pack("<I", 2) or len(data) < 20:
        raise Failed("no GLB file of version 2")
    length, kind = struct.unpack_from("<I4s", data, 12)
    binary = 20 + length
    if kind != b"JSON" or data[binary + 4:binary + 8] != b"BIN\0":
        raise Failed("the GLB file has no JSON and binary chunks")
    return json.loads(data[20:binary]), data[binary + 8:]


def packed_meshes(data):
    """The bytes that Draco made of each mesh, in the order of the file."""
    try:
        document, binary = chunks_of(data)
        for mesh in document["meshes"]:
            for primitive in mesh["primitives"]:
                view = document["bufferViews"][primitive["extensions"][EXTENSION]["bufferView"]]
                begin, length = view.get("byteOffset", 0), view["byteLength"]
                if min(begin, length) < 0 or begin + length > len(binary):
                    raise Failed("the GLB file ends too early")
                yield binary[begin:begin + length]
    except (KeyError, IndexError, TypeError, AttributeError, ValueError, RecursionError) as error:
        raise Failed(f"no GLB file with meshes packed by Draco: {error!r}") from error


def meshes_of(path, scratch):
    """The meshes of a GLB file as OBJ files, whose coordinates have six digits behind the point."""
    decoder = shutil.which("draco_decoder")
    if not decoder:
        raise Failed("draco_decoder is not installed: apt-get install draco (Debian)")
    meshes = []
    for data in packed_meshes(path.read_bytes()):
        packed, mesh = (scratch / f"{len(meshes)}.{ending}" for ending in ("drc", "obj"))
        packed.write_bytes(data)
        run = run_tool([decoder, "-i", str(packed), "-o", str(mesh)])
        if run.returncode != 0 or not mesh.is_file():
            raise Failed(f"draco_decoder: {(run.stderr or run.stdout).strip() or f'status {run.returncode}'}")
        packed.unlink()
        meshes.append(mesh)
    if not meshes:
        raise Failed("the GLB file has no meshes")
    return meshes
