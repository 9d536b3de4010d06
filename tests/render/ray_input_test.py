#!/usr/bin/env python3
"""ray_input_test.py BIN: trax-render --rays finds, for the rays of a picture, what the picture's rays hit, in every bit
and in any order; other files are refused with their place."""
import functools
import pathlib
import shutil
import struct
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import checking  # noqa: E402
from checking import check  # noqa: E402

BIN = pathlib.Path(sys.argv[1]).resolve()
HEADER, RECORD = 32, 64
call = functools.partial(checking.call, BIN)

# A floor that reaches 5,000 times as far as it is near: binary32 cannot tell its hits from this eye.
FLOOR = ("v -9000 0 -9000\nv 9000 0 -9000\nv 9000 0 9000\nv -9000 0 9000\nf 1 4 3 2\n"
         "v 0 2 -1\nv 1 0 -2\nv -1 0 -2\nf 5 6 7\n")
LOOK = ["--eye", "0,1,2", "--look-at", "0,0.5,-2", "--light", "3,9,4"]

PICTURES = {
    "paper": ["forest.trax", "--view", "forest"],
    "paths": ["forest.trax", "--view", "forest", "--paths", "3", "--one-sided"],
    "occlusion": ["forest.trax", "--view", "forest", "--occlusion", "2", "--samples", "2"],
    "binary": ["floor.obj", *LOOK, "--nodes", "binary"],
    "huge": ["huge.obj", "--eye", "0,1e12,2e12", "--look-at", "0,5e11,-2e12", "--light", "3e12,9e12,4e12"],
}


def trace(picture):
    """The words that trace the picture's rays again, and the file of its rays."""
    scene, *options = PICTURES[picture]
    call("trax-render", scene, *options, "--size", "16x12", "--engine", "native", "--ray-trace", f"{picture}.bin",
         "--quiet")
    of_mesh = options[options.index("--nodes"):] if "--nodes" in options else []
    return [scene, *of_mesh, "--rays", f"{picture}.bin"], pathlib.Path(f"{picture}.bin").read_bytes()


def results(file):
    """Returns what each ray hit; for shadow and occlusion rays, only whether they did."""
    records = struct.iter_unpack("<8f3H2BI3f2I", pathlib.Path(file).read_bytes()[HEADER:])
    return [record[12] if record[11] in (1, 2) else record[12:17] for record in records]


def check_picture(picture):
    rays, file = trace(picture)
    for order in ("found", "random") if picture != "paper" else ("found", "morton", "treelet", "random"):
        done = call("trax-render", *rays, "--ray-order", order, "--compare", "--ray-results", "results.bin")
        count = (len(file) - HEADER) // RECORD
        check(f"{count} of {count} rays" in done.stdout, picture, order, done.stdout)
        written = pathlib.Path("results.bin").read_bytes()
        check(written[:HEADER] == file[:HEADER] and len(written) == len(file), picture, "header")
        check(results("results.bin") == results(f"{picture}.bin"), picture, order, "results")
    return rays, file


def check_orders(rays):
    """Orders change the time, and the engines agree about it."""
    cycles = {}
    for order in ("found", "morton", "treelet", "random"):
        lines = call("trax-render", *rays, "--ray-order", order).stdout.splitlines()
        cycles[order] = lines[0]
    check(len(set(cycles.values())) == 4, cycles)
    reference = call("trax-render", *rays, "--ray-order", "random", "--engine", "reference").stdout.splitlines()[0]
    check(reference == cycles["random"], reference, cycles)
    call("trax-render", *rays, "--prepare", "kept", "--quiet")
    call("trax-sim", "kept/manifest.json", "--quiet")
    hits = list(struct.iter_unpack("<I3f", pathlib.Path("kept/hits.bin").read_bytes()))
    check([bool(hit[0]) for hit in hits
           ] == [bool(record if isinstance(record, int) else record[0]) for record in results("paper.bin")],
          "hits of trax-sim")


def check_refusals(rays, file):

    def refused(words, *more, bytes_=None, other=None):
        if bytes_ is not None:
            pathlib.Path("bad.bin").write_bytes(bytes_)
        done = call("trax-render", rays[0], "--rays", other or "bad.bin", *more, status=1)
        check(words in done.stderr and not done.stdout, words, done.stderr)

    def changed(place, form, *values):
        record = bytearray(file)
        struct.pack_into(form, record, HEADER + 2 * RECORD + place, *values)
        return bytes(record)

    pathlib.Path("bad.bin").write_bytes(changed(40, "<I", 999999))
    done = call("trax-render", rays[0], "--rays", "bad.bin", "--compare", status=1)
    check("ray 3 is the first" in done.stdout, done.stdout)

    refused("not a binary file of rays", bytes_=b"")
    refused("not a binary file of rays", bytes_=b"traxray2" + file[8:])
    refused("it has no rays", bytes_=file[:HEADER])
    refused("ray 4 is cut off", bytes_=file[:HEADER + 3 * RECORD + 5])
    refused("ray 3: a coordinate is not finite", bytes_=changed(4, "<f", float("nan")))
    refused("ray 3: the largest component", bytes_=changed(12, "<3f", 0, 0, 0))
    refused("ray 3: its interval does not begin", bytes_=changed(24, "<f", 1))
    refused("ray 3: its interval has no end", bytes_=changed(28, "<f", float("inf")))
    refused("ray 3: there is no such kind", bytes_=changed(38, "<B", 8))
    refused("of another scene", bytes_=changed(0, "<f", 1e30))
    for exponent, words in ((4096, "scaled by 2^4096"), (-1 << 31, "scaled by 2^-2147483648"), (300, "times 2^300")):
        refused(words, bytes_=file[:24] + struct.pack("<i", exponent) + file[28:])
    refused("`exact` is 2", bytes_=file[:28] + struct.pack("<I", 2) + file[32:])
    refused("no-such.bin", other="no-such.bin")
    pathlib.Path("bad.bin").write_bytes(file)
    for words in (["-o", "p.png"], ["--view", "forest"], ["--paths", "2"], ["--engine", "native"],
                  ["--explore", "e.html"], ["--no-specialise"], ["--sampled"], ["--environment", "e.pfm"],
                  ["--ambient", "0.5"], ["--background", "000000"]):
        refused("not with", *words)
    refused("is an input and the output", "--ray-results", "bad.bin")
    done = call("trax-render", rays[0], "-o", "p.png", "--ray-order", "random", status=1)
    check("--ray-order without --rays" in done.stderr, done.stderr)


def pictures():
    shutil.copy(BIN.parent / "tests/forest.trax", "forest.trax")
    pathlib.Path("floor.obj").write_text(FLOOR)
    lines = [line.split() for line in FLOOR.splitlines()]
    pathlib.Path("huge.obj").write_text("\n".join(
        " ".join([word, *(f"{float(place) * 1e12:g}" if word == "v" else place for place in places)])
        for word, *places in lines))
    first = {picture: check_picture(picture) for picture in PICTURES}
    exponents = {picture: struct.unpack_from("<i", file, 24)[0] for picture, (_, file) in first.items()}
    check({picture for picture, exponent in exponents.items() if exponent} == {"huge"}, exponents)
    call("trax-render", *first["binary"][0], "--prepare", "exact", "--quiet")
    check('"exact"' in pathlib.Path("exact/manifest.json").read_text(), "hits of the floor are not exact")
    check_orders(first["paper"][0])
    check_refusals(*first["paper"])


sys.exit(checking.run(pictures))
