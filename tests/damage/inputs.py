"""Good inputs of every kind, made in a folder. What is damaged begins with them."""
import json
import struct
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import calls  # noqa: E402
from png_files import png_of  # noqa: E402

PROGRAM = r"""
#include <stdio.h>
#include <stdlib.h>
#include <trax.h>
struct trax_buffer image;

static const char *const names[] = {"one", "two", "three"};
static unsigned fib(unsigned n) { return n < 2 ? n : fib(n - 1) + fib(n - 2); }
int main(void) {
  float sum = 0;
  for (int i = 1; i < 40; i++)
    sum += 1.0f / (float)i;
  switch (trax_thread() % 5) {
  case 0: printf("%s %u\n", names[0], fib(8)); break;
  case 1: sum *= 2; break;
  case 2: free(malloc(40)); break;
  case 3: puts(names[2]); break;
  default: sum -= 1; break;
  }
  if (image.size)
    ((float *)image.data)[trax_thread() % 16] = sum;
  return sum > 100;
}
"""
OBJECT = r"""
template <class T> T twice(T x) { return x + x; }
inline int shared(int x) { static int calls; return x + ++calls; }
struct Base { virtual int value() const { return 3; } };
struct Derived : Base { int value() const override { return twice(4); } };
Derived derived;
__attribute__((weak)) int weak_one(const Base &base) { return base.value(); }
extern "C" int entry(int x) {
  switch (x) { case 1: return 7; case 2: return 9; case 3: return shared(x); case 4: return 5; case 5: return 1; }
  return weak_one(derived) + shared(x);
}
int main() { return entry(2) != 9; }
"""
ASSEMBLER = """\
  .text
  .globl _start
  .type _start,@function
_start:
  .cfi_startproc
  addi r4, r0, 1
loop:
  lw r5, 4(r4)
  add r6, r5, r4
  bne r6, r5, loop
  .macro twice reg, count=2
  .rept \\count
  add \\reg, \\reg, \\reg
  .endr
  .endm
  twice r7, 3
  .if 3 > 2
  li r8, 0x12345678
  .else
  .error "no"
  .endif
  .cfi_endproc
  .size _start, .-_start
  .section .rodata.str,"aMS",@progbits,1
text: .asciz "text"
  .data
  .p2align 4
value: .word text, value+4, (1 << 5) | 3, loop - _start
  .irp x, 1, 2, 3
  .byte \\x
  .endr
  .skip 8, 0x55
  .set alias, value + 8
  .file 1 "a.c"
  .text
  .loc 1 2 3
  nop
"""
OBJ = """\
mtllib mesh.mtl
o box
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
v 0 0 1
v 1 0 1
vt 0 0
vt 1 0
vt 1 1
vn 0 0 1
usemtl red
s 1
f 1/1/1 2/2/1 3/3/1 4/1/1
f 1 2 5
g glass
usemtl glass
f -1 -2 -3
f 2//1 3//1 6//1
"""
MTL = """\
newmtl red
Kd 0.8 0.1 0.1
Ke 0 0 0
map_Kd texture.png
map_d texture.png
newmtl glass
Ni 1.5
illum 7
Kd 1 1 1
d 0.5
Pr 0.3
"""
PLY = """\
ply
format ascii 1.0
comment made here
element vertex 4
property float x
property float y
property float z
property uchar red
element face 2
property list uchar int vertex_indices
end_header
0 0 0 255
1 0 0 0
1 1 0 7
0 1 1 9
4 0 1 2 3
3 0 2 3
"""
VIEW = """\
eye = [0.5, 0.5, 4.0];
direction = [0.0, 0.0, -1.0];
up = [0.0, 1.0, 0.0];
fov = 40.0;
light = [2.0, 3.0, 4.0];
"""


def gltf(uri):
    """A triangle with a node above a node; the bytes of its buffer are beside it, or in the file itself."""
    return {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"children": [1], "translation": [0, 0, 1]}, {"mesh": 0, "scale": [1, 2, 1]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
        "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0.5, 1], "metallicFactor": 0}}],
        "buffers": [{"byteLength": 44, **({"uri": uri} if uri else {})}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 6}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
            {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"},
        ],
    }


def glb(document, body):
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    return (
        struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(body))
        + struct.pack("<I4s", len(text), b"JSON")
        + text
        + struct.pack("<I4s", len(body), b"BIN\0")
        + body
    )


def npy(descr, shape, values, letter):
    header = f"{{'descr': '{descr}', 'fortran_order': False, 'shape': {shape}, }}".encode()
    header += b" " * (-(11 + len(header)) % 64) + b"\n"
    return b"\x93NUMPY\1\0" + struct.pack("<H", len(header)) + header + struct.pack(f"<{len(values)}{letter}", *values)


def make(binaries, folder):
    """Writes them all into the folder."""

    def run(program, *words):
        subprocess.run([binaries / program, *words], cwd=folder, check=True, capture_output=True)

    for name, text in (
        ("program.c", PROGRAM),
        ("calls.c", calls.PROGRAM),
        ("object.cpp", OBJECT),
        ("text.s", ASSEMBLER),
        ("mesh.obj", OBJ),
        ("mesh.mtl", MTL),
        ("mesh.ply", PLY),
        ("mesh.view", VIEW),
    ):
        (folder / name).write_text(text)
    run("clang", "--target=trax", "-O1", "-g", "program.c", "-o", "program.elf")
    run("clang", "--target=trax", "-mstack=global", "-O2", "calls.c", "-o", "calls.elf")
    run("clang", "--target=trax", "-O1", "-g", "-c", "object.cpp", "-o", "object.o")
    run("clang", "--target=trax", "-O1", "-emit-llvm", "-c", "program.c", "-o", "program.bc")
    objects = [(b"object.o/", (folder / "object.o").read_bytes())]
    archive = b"!<arch>\n"
    for name, body in objects:
        archive += (
            b"%-16s%-12d%-6d%-6d%-8o%-10d`\n" % (name, 0, 0, 0, 0o644, len(body)) + body + b"\n" * (len(body) % 2)
        )
    (folder / "archive.a").write_bytes(archive)
    run(
        "trax-sim",
        "program.elf",
        "--quiet",
        "--config",
        "1x32",
        "--alloc",
        "image=64",
        "--checkpoint",
        "run.checkpoint",
        "--checkpoint-at",
        "3000",
    )
    run("trax-sim", "program.elf", "--quiet", "--main-on", "0", "--profile-sample", "program.prof")
    (folder / "machine.cfg").write_bytes(
        subprocess.run(
            [binaries / "trax-sim", "--config", "2x32", "--print-config"], capture_output=True, check=True
        ).stdout
    )
    triangle = struct.pack("<9f3H2x", 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 2)
    (folder / "mesh.bin").write_bytes(triangle)
    (folder / "mesh.gltf").write_text(json.dumps(gltf("mesh.bin")))
    (folder / "mesh.glb").write_bytes(glb(gltf(None), triangle))
    (folder / "binary.ply").write_bytes(
        PLY.split("0 0 0 255")[0].replace("ascii", "binary_little_endian").encode()
        + b"".join(struct.pack("<3fB", x, x * x, -x, 9) for x in range(4))
        + struct.pack("<B4iB3i", 4, 0, 1, 2, 3, 3, 0, 2, 3)
    )
    rows = [bytes(v for x in range(4) for v in (60 * x, 60 * y, 9, 255 - 80 * x)) for y in range(4)]
    (folder / "texture.png").write_bytes(png_of(rows, channels=4))
    run("trax-scene", "mesh.obj", "-q", "-o", "scene.trax")
    run("trax-scene", "mesh.obj", "-q", "--smooth", "--nodes", "quantised", "--splits=2", "-o", "quantised.trax")
    run("trax-render", "scene.trax", "-q", "--engine", "native", "--size", "9x7", "-o", "picture.png")
    run("trax-render", "scene.trax", "-q", "--engine", "native", "--size", "9x7", "-o", "picture.exr")
    run("trax-render", "scene.trax", "-q", "--engine", "native", "--size", "9x7", "-o", "picture.pfm")
    # Two leaves below the root, for the three triangles of mesh.ply.
    (folder / "tree.npy").write_bytes(npy("<i4", (3, 3), (1, 2, 0, 0, 0, 2, 2, 0, 1), "i"))
    (folder / "order.npy").write_bytes(npy("<i4", (3,), (0, 1, 2), "i"))
    (folder / "sweep.json").write_text(
        json.dumps(
            {
                "name": "own",
                "title": "Own",
                "programs": ["ours"],
                "chips": ["1x32", "machine.cfg"],
                "size": "32x18",
                "scenes": [{"name": "mesh", "meshes": ["mesh.obj"], "view": "mesh.view"}],
                "set": [{"name": "small", "dcache.bytes": [4096, 16384], "trax-scene --leaf": 3}],
                "x": "dcache.bytes",
                "y": "mrps",
                "table": {"rows": ["chip"], "columns": "scene"},
            }
        )
    )
