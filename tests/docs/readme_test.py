"""README's figures and picture are those of this build: readme_test.py SOURCE BIN [--update]

The forest is made by the program itself: its row and its picture are rendered again, from the scene file that the
build has made, and must be the same to the digit and the pixel. The command of the picture's caption is run for a small
picture. With TRAX_SCENES=DIR the rows of the other scenes are rendered, too. The picture of docs/explaining.md is of a
run that takes as many cycles as its caption says. --update writes rows and pictures; the right half of README's, what
each pixel cost, takes a minute of a core."""

import base64
import importlib
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time
import zlib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from png_files import png_of, read_png  # noqa: E402

SCENES = {
    "conference": ("conference.ply", "conference"), "crytek-sponza": ("crytek-sponza.ply", "crytek-sponza"),
    "dragon": ("dragon.ply dragon_box.obj", "dragon"), "sibenik": ("sibenik.ply", "sibenik"),
    "forest": ("generate:forest", "forest")
}
FOREST = "generate:forest"
PICTURE, SIZE, GAP = "docs/forest.png", "320x180", 8


SCREEN = "docs/explore.png"
CYCLES = b"tEXtcycles\0"  # the name of the text chunk in which the picture has the cycles of the run that it shows
CLIP = {"x": 0, "y": 0, "width": 1400, "height": 1640, "scale": 0.68}


def mesh_file(folder, name):
    """The mesh in the folder of scenes, which may be packed."""
    path = pathlib.Path(folder, name)
    return path if path.is_file() else path.with_name(f"{name}.xz")


def with_forest(binaries, words):
    """The words of a command with the forest that the build has made."""
    return [binaries.parent / "tests/forest.trax" if word == FOREST else word for word in words]


def take_screen(page, path, cycles):
    """The beginning of a page in a browser."""
    sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "report"))
    browser = importlib.import_module("browser")
    with browser.Browser(browser.find_chromium()) as shown:
        shown.open(page)
        while shown.run("document.documentElement.dataset.ready") != "yes":
            time.sleep(0.1)
        png = base64.b64decode(shown.call("Page.captureScreenshot", captureBeyondViewport=True, clip=CLIP)["data"])
    content = CYCLES + str(cycles).encode()
    path.write_bytes(png[:33] + (len(content) - 4).to_bytes(4, "big") + content +
                     zlib.crc32(content).to_bytes(4, "big") + png[33:])


def check_screen(source, binaries, folder, update):
    """What is wrong with the picture of the page that explains a run."""
    page = source / "docs/explaining.md"
    text = page.read_text()
    caption = re.search(r"^\*The beginning of a page: ([\d,]+) cycles\* \(`(trax-render [^`]+)`\)", text, re.M)
    if not caption:
        return ["docs/explaining.md: the picture has no caption with its command"]
    words = caption[2].split()
    words = words if update else words[:words.index("--explore")]  # the page takes ten times as long as the run
    subprocess.run([binaries / words[0], *with_forest(binaries, words[1:]), "--stats", "screen.json", "--quiet"],
                   cwd=folder, check=True)
    cycles = json.loads((folder / "screen.json").read_text())["cycles"]
    if update:
        page.write_text(text.replace(caption[1], f"{cycles:,}"))
        take_screen(folder / words[-1], source / SCREEN, cycles)
    shown = re.search(re.escape(CYCLES) + rb"(\d+)", (source / SCREEN).read_bytes())
    wrong = [] if caption[1] == f"{cycles:,}" else [f"docs/explaining.md: the page's run takes {cycles:,} cycles"]
    if not shown or int(shown[1]) != cycles:
        wrong.append(f"{SCREEN}: does not show the run of {cycles:,} cycles")
    return wrong


def digits(value):
    return f"{value:,.0f}" if value >= 999.5 else f"{value:#.3g}".rstrip(".")


def row(scene, statistics, old):
    """The row of README for a scene's statistics; name and the paper's figure are from the old one."""
    cells = old.strip("|\n ").split(" | ")
    rays, paper = statistics["rays"], cells[4]
    deviation = "-" if paper == "-" else f"{statistics['mrps'] / float(paper) * 100 - 100:+.1f} %"
    return "| " + " | ".join([
        cells[0], f"{statistics['cycles']:,}", f"{rays:,}", digits(statistics["mrps"]), paper, deviation,
        digits(statistics["flops"] / rays), digits(statistics["memory"]["bytes"] / rays),
        digits(statistics["memory"]["bandwidth_gbps"])
    ]) + " |\n"


def main():
    source, binaries, update = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), "--update" in sys.argv
    page = source / "README.md"
    text, wrong, folder_of_scenes = page.read_text(), [], os.environ.get("TRAX_SCENES")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)

        def render(scene, meshes, view, *words):
            subprocess.run([
                binaries / "trax-render", *with_forest(binaries, meshes), "--view", view, "--config", "4x32", "--size",
                SIZE, "--quiet", "-o", folder / f"{scene}.png", "--stats", folder / "stats.json", *words
            ], check=True, stdout=subprocess.DEVNULL)
            return json.loads((folder / "stats.json").read_text())

        cost = ["--cost-picture", folder / "cost.png"] if update else []
        for scene, (files, view) in SCENES.items():
            if scene != "forest" and not folder_of_scenes:
                continue
            meshes = [file if ":" in file else mesh_file(folder_of_scenes, file) for file in files.split()]
            old = re.search(rf"^\| {scene}\b.*\n", text, re.M)[0]
            statistics = render(scene, meshes, view, *(cost if scene == "forest" else []))
            new = row(scene, statistics, old)
            if new != old:
                wrong.append(f"README.md has\n{old}and this build's figures are\n{new}")
                text = text.replace(old, new)
        said = f"128 threads: {statistics['cycles'] / 1e6:.1f} million cycles"  # the forest's, which is the last
        if said not in text:
            wrong.append(f"README.md does not say: {said}")
            text = re.sub(r"128 threads: [\d.]+ million cycles", said, text)
        # As a reader types it, but for size and forest: the cost of the whole picture takes a minute.
        caption = re.search(rf"^\(`(trax-render [^`]* --size {SIZE} [^`]*)`\)", text, re.M)
        words = caption[1].replace(SIZE, "40x22").split() if caption else []
        done = subprocess.run([binaries / words[0], *with_forest(binaries, words[1:])], cwd=folder, capture_output=True,
                              text=True, check=False) if words else None
        if not done or done.returncode or read_png((folder / words[-1]).read_bytes())[0] != 40:
            reason = "fails: " + done.stderr if done else "is not there"
            wrong.append(f"README.md: the command of the picture's caption {reason}")
        wrong += [] if update else check_screen(source, binaries, folder, False)
        left = read_png((folder / "forest.png").read_bytes())[2]
        if update:
            right = read_png((folder / "cost.png").read_bytes())[2]
            rows = [a + b"\xff" * (3 * GAP) + b for a, b in zip(left, right)]
            (source / PICTURE).write_bytes(png_of(rows, best=True))
            page.write_text(text)
            check_screen(source, binaries, folder, True)
            return 0
        both = read_png((source / PICTURE).read_bytes())[2]
        if len(both) != len(left) or any(b[:len(a)] != a or len(b) != 2 * len(a) + 3 * GAP for a, b in zip(left, both)):
            wrong.append(f"{PICTURE}: its left half is not what the program renders")
    for fault in wrong:
        print(fault)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
