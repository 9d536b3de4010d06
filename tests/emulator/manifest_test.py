"""Manifests (docs/manifest.md): what trax-render --prepare writes runs as it should, and a damaged one is refused.

  manifest_test.py BIN SOURCE; BIN has the programs, SOURCE is the tree."""

import copy
import json
import pathlib
import os
import random
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import checking  # noqa: E402
from checking import check  # noqa: E402

BIN, SOURCE = map(pathlib.Path, sys.argv[1:])
BOX = SOURCE / "tests/render/box.obj"


def run(*command):
    return subprocess.run([BIN / command[0], *command[1:]], capture_output=True, text=True, timeout=120)


def prepare(folder, *options):
    result = run("trax-render", BOX, "--size", "16x9", "--config", "2x32", "--set", "memory.latency_cycles=90",
                 "--prepare", folder, "-q", *options)
    check(result.returncode == 0, "--prepare", *options, result.stderr)
    return json.loads((folder / "manifest.json").read_text())


def runs(scratch):
    """The same run as trax-render's own, and with options added."""
    for number, options in enumerate(([], ["--no-specialise"], ["--paths", "3", "--samples", "2"], ["--float"])):
        folder = scratch / f"good-{number}"
        manifest = prepare(folder, *options)
        picture, stats = folder / "own.png", folder / "own.json"
        run("trax-render", BOX, "--size", "16x9", "--config", "2x32", "--set", "memory.latency_cycles=90", "-q",
            "--stats", stats, "-o", picture, *options)
        result = run("trax-sim", folder / "manifest.json", "--quiet", "--stats", folder / "run.json")
        check(result.returncode == 0, "a run of it", *options, result.stderr)
        own, again = (json.loads((folder / name).read_text()) for name in ("own.json", "run.json"))
        for one in (own, again):
            for name in ("program", "host_seconds", "instructions_per_host_second"):
                del one[name]
        check(own == again, "other statistics than trax-render's own", *options)
        check(again["configuration"]["memory"]["latency_cycles"] == 90, "the configuration")
        layout, image = manifest["picture"], (folder / "image.raw").read_bytes()
        size = {"rgba uint8": 4, "rgb float32": 12}[layout["layout"]]
        check((layout["width"], layout["height"], len(image)) == (16, 9, 144 * size), "the picture", layout, len(image))
        # On another machine, to another place: not a byte of the folder changes.
        (folder / "image.raw").unlink()
        result = run("trax-sim", folder / "manifest.json", "--quiet", "--config", "1x48", "--dump",
                     f"image={scratch / 'other.raw'}")
        check(result.returncode == 0 and not (folder / "image.raw").exists(), "--dump and --config", *options,
              result.stderr)
        check((scratch / "other.raw").read_bytes() == image, "another picture on another machine", *options)
    check(manifest["features"] and manifest["view"]["fov"] > 0, "what is for others")
    result = run("trax-sim", folder / "manifest.json", "--set", "chip.tms=1", "--print-config")
    check("tms = 1;" in result.stdout and "latency_cycles = 90;" in result.stdout, "--print-config", result.stdout)
    result = run("trax-sim", folder / "manifest.json", "--stats", folder / "scene.trax")
    check(result.returncode == 1 and "scene.trax" in result.stderr, "an output that is an input", result.stderr)
    result = run("trax-sim", folder / "manifest.json", "--bind", "scene=/dev/null")
    check(result.returncode == 1 and "buffer scene is bound twice" in result.stderr, "--bind", result.stderr)


def change(manifest, path, value):
    """A copy with the member at this path set, or without it if there is no value."""
    manifest = copy.deepcopy(manifest)
    place = manifest
    for step in path[:-1]:
        place = place[step]
    if value is None:
        del place[path[-1]]
    else:
        place[path[-1]] = value
    return manifest


REFUSED = [
    (["trax_manifest"], 2, "trax_manifest: must be a whole number from 1 to 1"),
    (["trax_manifest"], None, "trax_manifest: must be"),
    (["program"], None, "program: must be an object"),
    (["program"], "program.elf", "program: must be an object"),
    (["program", "file"], None, "program.file: must be a text"),
    (["program", "file"], "", "program.file: must be a text that is not empty"),
    (["program", "file"], 7, "program.file: must be a text"),
    (["program", "file"], "/etc/passwd", "program.file: must be a path within the manifest's folder"),
    (["program", "file"], "../program.elf", "program.file: must be a path within"),
    (["program", "file"], "a/..", "program.file: must be a path within"),
    (["program", "file"], "absent.elf", "absent.elf: "),
    (["program", "file"], ".", "not a regular file|Is a directory|cannot be read|bytes, but"),
    (["program", "file"], "scene.trax", "bytes, but|its bytes are not those"),
    (["program", "bytes"], 1, "program.elf: "),
    (["program", "xxh128"], "0" * 32, "program.elf: its bytes are not those of"),
    (["program", "xxh128"], "0" * 31, "program.xxh128: must be 32 hexadecimal digits"),
    (["program", "entry"], 0, 'program: unknown key "entry"'),
    (["bufers"], [], 'unknown key "bufers"; did you mean buffers?'),
    (["buffers"], None, "buffers: must be a list"),
    (["buffers"], {}, "buffers: must be a list"),
    (["buffers", 0], 3, "buffers[0]: must be an object"),
    (["buffers", 0, "symbol"], None, "buffers[0].symbol: must be a text"),
    (["buffers", 0, "symbol"], "none", "buffers[0]: "),
    (["buffers", 1, "symbol"], "scene", "buffers[1]: buffer scene is bound twice"),
    (["buffers", 0, "file"], "./../x", "buffers[0].file: must be a path within"),
    (["buffers", 0, "bytes"], -1, "buffers[0].bytes: must be a whole number from 0 to 4294967295"),
    (["buffers", 0, "bytes"], 1 << 32, "buffers[0].bytes: must be a whole number"),
    (["buffers", 0, "bytes"], 1.5, "buffers[0].bytes: must be a whole number"),
    (["buffers", 0, "bytes"], "64", "buffers[0].bytes: must be a whole number"),
    (["buffers", 0, "bytes"], 64, "scene.trax: "),
    (["buffers", 0, "xxh128"], None, "buffers[0].xxh128: must be 32 hexadecimal digits"),
    (["buffers", 0, "xxh128"], "f" * 32, "scene.trax: its bytes are not those of"),
    (["buffers", 0, "bytes_per_thread"], 4, "buffers[0].bytes_per_thread: is for a buffer without a file"),
    (["buffers", -1, "bytes"], None, "bytes: must be a whole number"),
    (["buffers", -1, "bytes"], 4294967295, "does not fit into memory"),
    (["buffers", -1, "bytes_per_thread"], 4, "bytes: is given by bytes_per_thread"),
    (["buffers", -1, "output"], "../../image.raw", "output: must be a path within"),
    (["items"], "many", "items: must be a whole number"),
    (["configuration"], [], "configuration: must be an object"),
    (["configuration", "chip"], 3, "configuration.chip: must be an object"),
    (["configuration", "chip", "tms"], 65, "configuration.chip.tms: "),
    (["configuration", "chip", "tms"], [1], "configuration.chip.tms: must be a number, true, false or a word"),
    (["configuration", "chip", "tns"], 4, "did you mean chip.tms"),
    (["configuration", "memory", "bandwidth_gbps"], True, "configuration.memory.bandwidth_gbps: "),
    (["configuration", "icache", "bytes"], 96, "configuration.icache.bytes: "),
    (["configuration", "memory", "model"], "limit" + 90 * " ", "configuration.memory.model: is longer than any value"),
    (["configuration", "dram", "mapping"], "row:rank:bank:column:channel0".ljust(79, "0") + "x", "mapping: is longer"),
    (["configuration", "chip", "tms"], "2".rjust(79, "0") + "x", "configuration.chip.tms: is longer than any value"),
]
TEXTS = [("", "manifest.json:1: "), ("[]", "must be an object"), ("{", "manifest.json:1: "),
         ('{\n"trax_manifest": 1,\n]', "manifest.json:3: "),
         ('{"trax_manifest": 1, "trax_manifest": 1}', "manifest.json:1: duplicate"), ("\0", "manifest.json:1: "),
         ("[" * 100000, "manifest.json:1: "),
         (" " * (1 << 20) + "{}", "more than 1048576 bytes")]


def expect_refusal(folder, text, expected):
    path = folder / "manifest.json"
    path.write_text(text)
    result = run("trax-sim", path, "--quiet")
    check(
        result.returncode == 1 and result.stderr.startswith("trax-sim: error: ") and
        any(one in result.stderr for one in expected.split("|")) and result.stderr.count("\n") == 1 and
        not result.stdout, expected, result.returncode, result.stderr)
    check(not (folder / "image.raw").exists(), "a picture in spite of", expected)


def refusals(scratch):
    folder = scratch / "bad"
    good = prepare(folder)
    for path, value, expected in REFUSED:
        if path == ["buffers", 0, "bytes"] and value == 64:
            value += good["buffers"][0]["bytes"]
        expect_refusal(folder, json.dumps(change(good, path, value)), expected)
    for text, expected in TEXTS:
        expect_refusal(folder, text, expected)
    # Files that are no longer what the manifest says.
    for name in ("scene.trax", "params.bin", "program.elf"):
        kept = (folder / name).read_bytes() if (folder / name).exists() else None
        if kept is None:
            continue
        for damaged in (kept[:-1], kept + b"\0", kept[:40] + bytes([kept[40] ^ 1]) + kept[41:], b"", None):
            (folder / name).unlink()
            if damaged is not None:
                (folder / name).write_bytes(damaged)
            expect_refusal(folder, json.dumps(good), f"{name}: ")
            (folder / name).write_bytes(kept)
    (folder / "manifest.json").write_text(json.dumps(good))
    check(run("trax-sim", folder / "manifest.json", "--quiet").returncode == 0, "whole again")


def links(scratch):
    """Links in the folder: what they lead to is read if it is beneath the folder, and never written."""
    folder, outside = scratch / "folder", scratch / "outside"
    good = prepare(folder)
    outside.mkdir()
    (outside / "kept").write_text("kept")
    (folder / "sub").mkdir()
    for name in ("program.elf", "scene.trax"):
        shutil.copy(folder / name, outside / name)
        shutil.copy(folder / name, folder / "sub" / name)
    (folder / "away").symlink_to(outside)
    (folder / "near").symlink_to("sub")
    (folder / "up").symlink_to("..")
    (folder / "kept").symlink_to("../outside/kept")
    (folder / "absolute").symlink_to(outside / "kept")
    (folder / "new").symlink_to("../outside/new")
    (folder / "inner").symlink_to("image.raw")
    (folder / "null").symlink_to("/dev/null")
    os.mkfifo(folder / "pipe")
    place = ["buffers", len(good["buffers"]) - 1, "output"]
    index = next(i for i, one in enumerate(good["buffers"]) if one.get("file") == "scene.trax")
    for output in ("kept", "absolute", "new", "inner", "null", "pipe", "sub", "away/kept", "away/new",
                   "up/outside/kept", "near/../../outside/kept",
                   "program.elf/x"):
        (folder / "image.raw").unlink(missing_ok=True)
        expect_refusal(folder, json.dumps(change(good, place, output)),
                       f"{output}: cannot be written: |output: must be a path within")
    for path, name in ((["program", "file"], "program.elf"), (["buffers", index, "file"], "scene.trax")):
        for way in ("away", "up/outside"):
            expect_refusal(folder, json.dumps(change(good, path, f"{way}/{name}")), f"{way}/{name}: cannot be read: ")
    check(sorted(os.listdir(outside)) == ["kept", "program.elf",
                                          "scene.trax"] and (outside / "kept").read_text() == "kept", "outside")
    near = change(change(good, ["program", "file"], "near/program.elf"), ["buffers", index, "file"], "near/scene.trax")
    (folder / "manifest.json").write_text(json.dumps(change(near, place, "near/picture.raw")))
    result = run("trax-sim", folder / "manifest.json", "--quiet")
    check(result.returncode == 0 and (folder / "sub/picture.raw").stat().st_size == 576, "links within the folder",
          result.stderr)
    # A link that appears during the run, where the output or its folder was.
    for target in (folder / "image.raw", folder / "sub"):
        output = "image.raw" if target.suffix else "sub/picture.raw"
        (folder / "manifest.json").write_text(json.dumps(change(good, place, output)))
        wait = folder / f"wait-{output[:3]}"
        os.mkfifo(wait)
        command = [BIN / "trax-sim", folder / "manifest.json", "--quiet", "--memory-trace", wait]
        with subprocess.Popen(command, stderr=subprocess.PIPE) as process:
            with open(wait, "rb") as reader:  # opened by trax-sim when the run begins, after its checks
                if target.is_dir():
                    shutil.rmtree(target)
                else:
                    target.unlink(missing_ok=True)
                target.symlink_to(outside / "kept" if target.suffix else outside)
                reader.read()
            process.communicate()
        check((outside / "kept").read_text() == "kept" and not (outside / "picture.raw").exists(),
              "a link that appears", output)


def one_reading(scratch):
    """The bytes that were checked are those that run: the program is read once."""
    folder = scratch / "once"
    good = prepare(folder)
    program = (folder / "program.elf").read_bytes()
    (folder / "program.elf").unlink()
    os.mkfifo(folder / "program.elf")
    (folder / "manifest.json").write_text(json.dumps(good))
    with subprocess.Popen([BIN / "trax-sim", folder / "manifest.json", "--quiet"], stderr=subprocess.PIPE) as process:
        (folder / "program.elf").write_bytes(program)
        try:
            _, said = process.communicate(timeout=20)
        except subprocess.TimeoutExpired:
            process.kill()
            _, said = b"", b"it waits for the program again"
        check(process.returncode == 0 and (folder / "image.raw").exists(), "a program from a pipe", said)


def values_of(node):
    """Paths of all members."""
    below = node.items() if isinstance(node, dict) else enumerate(node) if isinstance(node, list) else ()
    for key, value in below:
        yield [key]
        yield from ([key, *path] for path in values_of(value))


def mutations(scratch):
    """Damage by chance: a run, or a refusal, and nothing else."""
    folder = scratch / "mutants"
    good = prepare(folder)
    chance = random.Random(19)
    paths = list(values_of(good))
    strange = [None, 0, -1, 1, 2**31, 2**32, 2**63 - 1, 1e300, 0.5, "", "x", "../x", "%s%n", "\u0001", [], {}, True,
               False, [[]], {"file": "x"}, "program.elf"]
    endings = {}
    for number in range(500):
        if number % 2:
            text = json.dumps(change(good, chance.choice(paths), chance.choice(strange)))
        else:
            text = bytearray(json.dumps(good).encode())
            for _ in range(chance.randint(1, 4)):
                place = chance.randrange(len(text))
                text[place:place + chance.choice((0, 1, 1, 1, 9))] = bytes(
                    chance.choices(b'0129{}[]",:.-e\\\0\xff tf', k=chance.choice((0, 1, 1, 5))))
        (folder / "manifest.json").write_bytes(text.encode() if isinstance(text, str) else bytes(text))
        result = subprocess.run([BIN / "trax-sim", folder / "manifest.json", "--quiet", "--max-cycles", "2000"],
                                capture_output=True, timeout=60)
        said = result.stderr.decode(errors="replace")
        whole = result.returncode in (
            0, 124) or result.returncode == 1 and said.startswith("trax-sim: ") and len(said) > 20
        check(whole, "mutant", number, result.returncode, said)
        endings[result.returncode] = endings.get(result.returncode, 0) + 1
    check(endings.get(1, 0) > 300 and endings.get(124, 0) > 10, "the mutants do not reach far enough", endings)


def main():
    with tempfile.TemporaryDirectory() as name:
        for test in (runs, refusals, links, one_reading, mutations):
            scratch = pathlib.Path(name, test.__name__)
            scratch.mkdir()
            test(scratch)
            shutil.rmtree(scratch)
    return checking.failures != 0


if __name__ == "__main__":
    sys.exit(main())
