"""README's figures are those of this build: readme_test.py SOURCE BIN [--update]

The forest is made by the program itself: its row is measured again, from the scene file that the build has made, and
must be the same to the digit. With TRAX_SCENES=DIR the rows of the other scenes are rendered, too. The picture of
docs/explaining.md is of a run that takes as many cycles as its caption says. --update writes rows and that picture."""

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

SCENES = {
    "conference": ("conference.ply", "conference"), "crytek-sponza": ("crytek-sponza.ply", "crytek-sponza"),
    "dragon": ("dragon.ply dragon_box.obj", "dragon"), "sibenik": ("sibenik.ply", "sibenik"),
    "forest": ("generate:forest", "forest")
}
FOREST, SIZE = "generate:forest", "320x180"

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

        for scene, (files, view) in SCENES.items():
            if scene != "forest" and not folder_of_scenes:
                continue
            meshes = [file if ":" in file else mesh_file(folder_of_scenes, file) for file in files.split()]
            subprocess.run([
                binaries / "trax-render", *with_forest(binaries, meshes), "--view", view, "--config", "4x32", "--size",
                SIZE, "--quiet", "--stats", folder / "stats.json"
            ], check=True, stdout=subprocess.DEVNULL)
            old = re.search(rf"^\| {scene}\b.*\n", text, re.M)[0]
            new = row(scene, json.loads((folder / "stats.json").read_text()), old)
            if new != old:
                wrong.append(f"README.md has\n{old}and this build's figures are\n{new}")
                text = text.replace(old, new)
        faults = check_screen(source, binaries, folder, update)
        if update:
            page.write_text(text)
            return 0
        wrong += faults
    for fault in wrong:
        print(fault)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
