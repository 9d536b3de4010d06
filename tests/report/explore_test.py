#!/usr/bin/env python3
"""The page of --explore: explore_test.py BIN SOURCE [--keep DIR]. Whether its data are those of the other outputs,
whether its bytes depend on the run alone, and whether a browser shows it without a word on its console. --keep leaves
pages, pictures and the PDF in a folder, to be looked at."""

import collections
import csv
import io
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

from browser import TEXT_COLOURS, Browser, PageTests, contrast, find_chromium, take_keep
from explore_page import unpack

BIN, SOURCE = (pathlib.Path(one).resolve() for one in sys.argv[1:3])
del sys.argv[1:3]
KEEP = take_keep()

WIDTH, HEIGHT = 48, 27
OF_HOST = ("host_seconds", "instructions_per_host_second")
HOSTILE = "<img src=x onerror=alert(1)> & </script>.obj".replace("/", "\u2044")


def render(folder, *words, check=True, mesh=None):
    command = [
        BIN / "trax-render", mesh or SOURCE / "tests/render/box.obj", "--view", SOURCE / "tests/render/box.view",
        "--size", f"{WIDTH}x{HEIGHT}", "-q", *words
    ]
    return subprocess.run(command, cwd=folder, check=check, capture_output=not check, text=True)


def simulate(folder, *words, check=True):
    return subprocess.run([BIN / "trax-sim", "--quiet", *words], cwd=folder, check=check, capture_output=not check,
                          text=True)


class Scratch(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = Scratch.folder

    def text(self, name):
        return (self.folder / name).read_text()


def setUpModule():
    scratch = tempfile.TemporaryDirectory()
    unittest.addModuleCleanup(scratch.cleanup)
    folder = Scratch.folder = pathlib.Path(scratch.name)
    render(folder, "--mark-rays", "-o", "p.png", "--keep", "run", "--explore", "p.html", "--stats", "p.json",
           "--cost-values", "p.csv")
    simulate(folder, "run/manifest.json", "--explore", "q.html", "--stats", "q.json", "--heat", "heat.csv",
             "--waits", "waits.csv", "--ray-kinds", "rays.csv", "--profile-folded", "folded", "--items", "items.csv",
             "--item-buffer", "image")


class Data(Scratch):
    def test_is_what_the_other_outputs_are(self):
        for page, stats in (("p.html", "p.json"), ("q.html", "q.json")):
            data, columns = unpack(self.folder / page)
            written = json.loads(self.text(stats))
            for name in OF_HOST:
                del written[name]
            self.assertEqual(data["stats"], written)
            for cause, cycles in written["causes"].items():
                self.assertEqual(
                    sum(columns.get(f"causes.{cause}", [])) + data["picture"]["elsewhere"][cause], cycles, cause)
            for kind, rays in written["rays_by_kind"].items():
                self.assertEqual(sum(columns.get(f"rays.{kind}", [])), rays, kind)
            self.assertEqual(columns["rays.primary"], [1] * WIDTH * HEIGHT)
            series = list(csv.DictReader(io.StringIO(data["series"])))
            lengths = [int(row["end"]) - int(row["begin"]) for row in series if row["tm"] == "all"]
            self.assertTrue(16 < len(lengths) < 256 and len(set(lengths[:-1])) == 1 and lengths[-1] <= lengths[0],
                            lengths)
            for cause, cycles in written["causes"].items():
                self.assertEqual(sum(int(row[cause]) for row in series if row["tm"] == "all"), cycles, cause)
                for tm in written["tms"]:
                    self.assertEqual(sum(int(row[cause]) for row in series if row["tm"] == str(tm["tm"])),
                                     tm["causes"][cause], cause)
            self.assertEqual(sum(int(row["memory.bytes"]) for row in series if row["tm"] == "all"),
                             written["memory"]["bytes"])
            instructions = list(filter(None, data["instructions"]))
            self.assertEqual([sum(one[5][i] for one in instructions) for i in range(len(written["causes"]))],
                             list(written["causes"].values()))
            self.assertTrue(
                any(path.endswith("traverse.h") and "descend" in text for path, text in data["sources"].items()))
        self.assertEqual(data["heat"], self.text("heat.csv"))
        self.assertEqual(data["waits"], self.text("waits.csv"))
        # trax-render also knows the parts of the scene.
        waits = [row for row in csv.DictReader(io.StringIO(unpack(self.folder / "p.html")[0]["waits"]))]
        self.assertEqual(sum(int(row["wait_memory"]) for row in waits), written["causes"]["wait_memory"])
        self.assertIn("scene: nodes", {row["object"] for row in waits if row["wait_memory"] != "0"})
        self.assertEqual(data["ray_kinds"], self.text("rays.csv"))
        self.assertEqual(data["folded"], self.text("folded"))

    def test_pixels(self):
        data, columns = unpack(self.folder / "p.html")
        cycles = [
            sum(values) for values in zip(*(values for name, values in columns.items() if name.startswith("causes.")))
        ]
        self.assertEqual(cycles, [int(row["cycles"]) for row in csv.DictReader(io.StringIO(self.text("p.csv")))])
        image = (self.folder / "run/image.raw").read_bytes()
        for channel, name in enumerate(("red", "green", "blue")):
            value, values = 0, []
            for difference in columns[f"picture.{name}"]:
                values.append(value := value + difference & 255)
            self.assertEqual(bytes(values), image[channel::4], name)
        # trax-sim's page of the same run knows neither nodes nor triangles: a file of their own has these.
        _, others = unpack(self.folder / "q.html")
        self.assertEqual({name: values for name, values in columns.items() if not name.startswith("counts.")}, others)
        for row in csv.DictReader(io.StringIO(self.text("items.csv"))):
            if row["kind"] == "item":
                place = int(row["place"])
                self.assertEqual(
                    [others["causes.issued"][place], others[".thread"][place] - 1, others[".begin"][place]],
                    [int(row[name]) for name in ("instructions", "thread", "begin")])
        # A visit of a node loads a plane at least, at most two boxes and two references; a triangle has 10 words.
        parts = {row["object"]: int(row["loads"]) for row in csv.DictReader(io.StringIO(data["parts"]))}
        nodes, triangles = sum(columns["counts.nodes"]), sum(columns["counts.triangles"])
        self.assertTrue(nodes > WIDTH * HEIGHT and 2 * nodes <= parts["scene: nodes"] <= 14 * nodes, (nodes, parts))
        self.assertTrue(
            triangles > WIDTH * HEIGHT / 2 and
            triangles <= parts["scene: triangles"] <= 10 * triangles + 10 * sum(columns["rays.primary"]),
            (triangles, parts))

    def test_bytes(self):
        page = (self.folder / "p.html").read_bytes()
        self.assertNotIn(b"http:", page.replace(b"http://www.w3.org/2000/svg", b""))  # the name of SVG
        self.assertNotIn(b"https:", page)
        packed = re.search(rb'id="pixels">([^<]*)<', page)[1]
        self.assertLess(len(packed),
                        8e6 * WIDTH * HEIGHT / (640 * 360))  # of 10 MB; the rest hardly grows with the picture
        self.assertLess(len(page) - len(packed), 600000)
        for words in (["--threads", "1"], ["--threads", "3"], ["--engine", "reference"]):
            render(self.folder, "--mark-rays", "-o", "other.png", "--explore", "other.html", *words)
            self.assertEqual((self.folder / "other.html").read_bytes(), page, words)

    def test_bytes_beside_other_files(self):
        pages = []
        for words in ([], ["--waits", "beside.waits"], ["--profile-folded", "beside.folded", "--waits", "beside.waits"],
                      ["--engine", "reference", "--profile-folded", "beside.folded", "--items", "beside.items"],
                      ["--check-memory"], ["--perfetto", "beside.perfetto", "--window", "0:500"]):
            simulate(self.folder, "run/manifest.json", "--explore", "beside.html", *words)
            pages.append((self.folder / "beside.html").read_bytes())
        self.assertEqual([page == pages[0] for page in pages], [True] * len(pages))

    def test_run_is_the_same(self):
        render(self.folder, "--mark-rays", "-o", "plain.png", "--stats", "plain.json")
        self.assertEqual((self.folder / "plain.png").read_bytes(), (self.folder / "p.png").read_bytes())
        stats = [json.loads(self.text(name)) for name in ("plain.json", "p.json")]
        for one in stats:
            for name in OF_HOST:
                del one[name]
        self.assertEqual(*stats)

    def test_another_program(self):
        """Its visits are not known, its work is that of no kind of ray."""
        render(self.folder, "-o", "general.png", "--explore", "general.html", "--program",
               BIN / "../lib/trax/trax-raytracer.elf")
        _, columns = unpack(self.folder / "general.html")
        self.assertEqual([name for name in columns if name.startswith("counts.")], [])
        self.assertEqual(columns["rays.primary"], [1] * WIDTH * HEIGHT)

    def test_refused(self):
        (self.folder / "closed").mkdir(exist_ok=True)
        (self.folder / "kept.html").write_text("kept")
        for words, message in ((["none/x.html"], "none/x.html"), (["closed"], "closed"),
                               (["p.png", "-o", "p.png"], "written twice"),
                               ([SOURCE / "tests/render/box.obj"], "is an input and the output of --explore"),
                               (["kept.html", "--engine", "native"], "need the emulator"),
                               (["kept.html", "--sampled"], "nothing to compare, explain")):
            output = [] if "-o" in words else ["-o", "new.png"]
            ended = render(self.folder, *output, "--explore", *words, check=False)
            self.assertEqual(ended.returncode, 1, words)
            self.assertRegex(ended.stderr, r"^trax-render: error: .*(" + message + ")")
        for words, message in ((["none/x.html"], "none/x.html"), (["run/manifest.json"], "manifest.json"),
                               (["kept.html", "--engine", "functional"], "a run is explained by"),
                               (["kept.html", "--resume", "q.json"], "cannot be explained without")):
            ended = simulate(self.folder, "--explore", *words, "run/manifest.json", check=False)
            self.assertEqual(ended.returncode, 1, words)
            self.assertRegex(ended.stderr, r"^trax-sim: error: .*" + message)
        # A page that cannot be written to its end is an error, and the file that was there stays.
        ended = simulate(self.folder, "--explore", "/dev/full", "run/manifest.json", check=False)
        self.assertEqual((ended.returncode, ended.stderr.startswith("trax-sim: error: /dev/full: ")), (1, True),
                         ended.stderr)
        limited = subprocess.run([
            "bash", "-c",
            f"ulimit -f 60; exec {BIN}/trax-sim --quiet --explore kept.html run/manifest.json --dump image=/dev/null"
        ], cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(limited.returncode, 1, limited.stderr)
        self.assertRegex(limited.stderr, "^trax-sim: error: kept.html: ")
        self.assertEqual((self.text("kept.html"), sorted(one.name for one in self.folder.glob("kept*"))),
                         ("kept", ["kept.html"]))
        manifest = json.loads(self.text("run/manifest.json"))
        manifest["picture"]["width"] += 1
        (self.folder / "run/wrong.json").write_text(json.dumps(manifest))
        ended = simulate(self.folder, "--explore", "kept.html", "run/wrong.json", check=False)
        self.assertEqual(ended.returncode, 1)
        self.assertRegex(
            ended.stderr,
            "^trax-sim: error: the manifest's picture of 49x27 pixels of 4 bytes is not the buffer image of 5184 bytes")
        self.assertEqual(self.text("kept.html"), "kept")

    def test_unfinished(self):
        ended = simulate(self.folder, "--explore", "part.html", "--stats", "part.json", "--max-cycles", "20000",
                         "run/manifest.json", check=False)
        self.assertEqual(ended.returncode, 124)
        data, columns = unpack(self.folder / "part.html")
        self.assertEqual((data["stats"]["status"], data["stats"]["cycles"]), ("limit", 20000))
        done = data["stats"]["items"]
        self.assertTrue(0 < done < WIDTH * HEIGHT)
        self.assertEqual(sum(1 for thread in columns[".thread"] if thread), done)


class Stories(Scratch):
    """The story of a pixel against the other outputs: rays, instructions, time line, text."""

    def check_stories(self, data, columns, everything):
        """Each story has the charges of its pixel, in all of its parts."""
        names = list(data["stats"]["causes"])
        stories = [one for one in data["stories"] if one]
        for story in stories:
            expected = [columns.get(f"causes.{name}", [0] * (story["place"] + 1))[story["place"]] for name in names]
            for part, skipped in ("code", 1), ("rays", 2), ("time", 1):
                self.assertEqual([sum(row[skipped + i] for row in story[part]) for i in range(len(names))], expected,
                                 (part, story["place"]))
            self.assertEqual([story["cycles"], story["begin"]], [sum(expected), columns[".begin"][story["place"]]])
            self.assertLess(len(story["time"]), 97)
            begin = story["begin"]
            for ray in story["rays"]:  # one begins where the one before ended
                self.assertEqual(ray[1], begin, ("begin", story["place"]))
                begin += sum(ray[2:])
            rays = data["rays"][story["place"]]
            self.assertEqual([(ray[0], sum(ray[2:]), ray[2]) for ray in story["rays"][1:]],
                             [(ray["kind"], ray["cycles"], ray["instructions"]) for ray in rays])
        if everything:
            by_pc = collections.Counter()
            for story in stories:
                for pc, *cycles in story["code"]:
                    by_pc.update({(pc, name): count for name, count in zip(names, cycles)})
            run = {(one[0], name): count for one in filter(None, data["instructions"])
                   for name, count in zip(names, one[5])}
            self.assertFalse([key for key, count in by_pc.items() if count > run[key]])
            for name in names:
                self.assertEqual(sum(count for key, count in by_pc.items() if key[1] == name) +
                                 data["picture"]["elsewhere"][name], data["stats"]["causes"][name], name)
        return stories

    def test_costliest(self):
        data, columns = unpack(self.folder / "p.html")
        stories = self.check_stories(data, columns, False)
        costs = [sum(values) for values in zip(*(columns[name] for name in columns if name.startswith("causes.")))]
        self.assertEqual([story["cycles"] for story in stories], sorted(costs, reverse=True)[:24])

    def test_rays(self):
        """All rays of the picture are those of the trace, and add up to the pixels' counts and to the kinds' costs."""
        data, columns = unpack(self.folder / "p.html")
        render(self.folder, "--ray-trace", "rays.trace.csv")
        traced = [[] for _ in range(WIDTH * HEIGHT)]
        for row in csv.DictReader(io.StringIO(self.text("rays.trace.csv"))):
            traced[int(row["y"]) * WIDTH + int(row["x"])].append(
                [row["kind"], *(int(row[name]) for name in ("hit", "nodes", "triangles"))])
        kinds = data["picture"]["rays"]["kinds"]
        self.assertEqual([[[kinds[ray["kind"]], ray["hit"], ray["nodes"], ray["triangles"]] for ray in rays]
                          for rays in data["rays"]], traced)
        for name in "nodes", "triangles":
            self.assertEqual([sum(ray[name] for ray in rays) for rays in data["rays"]], columns[f"counts.{name}"])
        self.assertTrue(all(ray["material"] for rays in data["rays"] for ray in rays if ray["hit"] and not ray["kind"]))
        table = {row["kind"]: row for row in csv.DictReader(io.StringIO(self.text("rays.csv")))}
        for number, kind in enumerate(kinds):
            mine = [ray for rays in data["rays"] for ray in rays if ray["kind"] == number]
            self.assertEqual([len(mine), sum(ray["cycles"] for ray in mine), sum(ray["instructions"] for ray in mine)],
                             [int(table[kind][name]) for name in ("rays", "thread_cycles", "issued")], kind)

    def test_all_pixels(self):
        """A picture of 24 pixels, whose stories are all kept: also of pixels that a thread's log is too short for."""
        machine = ["--set", "chip.tms=1", "--set", "chip.tps_per_tm=2"]
        paths = ["--size", "6x4", "--paths", "3", "--samples", "16", *machine]
        render(self.folder, *paths, "--explore", "paths.html")
        stories = self.check_stories(*unpack(self.folder / "paths.html"), True)
        self.assertEqual(len(stories), 24)
        self.assertGreater(max(story["cycles"] for story in stories), 2 << 15)
        for engine in "reference", "fast":
            render(self.folder, "--size", "6x4", "--mark-rays", *machine, "--engine", engine, "--explore", engine)
        self.assertEqual(self.text("fast"), self.text("reference"))
        self.check_stories(*unpack(self.folder / "fast"), True)

    def test_text(self):
        words = ["--mark-rays", "--pixel", "3,20", "--pixel", "17,5", "--explore", "chosen.html"]
        process = subprocess.run([
            BIN / "trax-render", SOURCE / "tests/render/box.obj", "--view", SOURCE / "tests/render/box.view", "--size",
            f"{WIDTH}x{HEIGHT}", "-q", *words], cwd=self.folder, check=True, capture_output=True, text=True)
        data, columns = unpack(self.folder / "chosen.html")
        names = list(data["stats"]["causes"])
        self.check_stories(data, columns, False)
        chosen = [20 * WIDTH + 3, 5 * WIDTH + 17]
        self.assertEqual({story["place"] for story in data["stories"][:2]}, set(chosen))
        stories = sorted(data["stories"][:2], key=lambda story: chosen.index(story["place"]))
        for story, text in zip(stories, process.stdout.split("\n\nPixel")):
            cycles, x, y = story["cycles"], story["place"] % WIDTH, story["place"] // WIDTH
            parts = text.split("\n\n")
            self.assertIn(f"({x}, {y}): {cycles} cycles, {sum(row[1] for row in story['code'])} instructions", parts[0])
            self.assertIn(f"Thread {story['thread']} ", parts[0])
            self.assertIn(f"cycles {story['begin']} to {story['begin'] + cycles} ", parts[0])
            for ray, line in zip(data["rays"][story["place"]], parts[1].splitlines()[2:]):
                found = re.match(r"  (\w+) +(.*?) +(\d+) +(\d+) +(\d+) +[\d.]+ % +(\d+)  ", line)
                self.assertEqual([int(number) for number in found.groups()[2:]],
                                 [ray[name] for name in ("nodes", "triangles", "cycles", "instructions")])
                material = data["picture"]["rays"]["materials"][ray["material"] - 1] if ray["material"] else "no"
                self.assertEqual(found[2], "yes" if ray["hit"] and not ray["material"] else material)
            causes = {line.split()[0]: int(line.split()[1]) for line in parts[2].splitlines()[1:]}
            self.assertEqual(causes, {name: total for i, name in enumerate(names)
                                      if (total := sum(row[1 + i] for row in story["code"]))})
            functions = collections.Counter()
            places = {one[0]: data["names"][one[4][0][0]] for one in filter(None, data["instructions"])}
            for pc, *counts in story["code"]:
                functions[places[pc]] += sum(counts)
            shown = {line.split()[0]: int(line.split()[1]) for line in parts[3].splitlines()[1:13]}
            self.assertEqual(shown, dict(sorted(functions.items(), key=lambda one: (-one[1], one[0]))[:12]) |
                             {name: functions[name] for name in shown})
            self.assertEqual(sum(int(re.split(r" +", line)[2]) for line in parts[5].splitlines()[1:]), cycles)

    def test_wrong(self):
        for words, message in ((("--pixel", "48,0"), "the picture has 48 x 27 pixels"), (("--pixel", "1;2"), "X,Y"),
                               (("--pixel", "1,-2"), "X,Y"), (("--pixel", "1,2", "--engine", "native"), "emulator"),
                               (["--pixel", "1,2"] * 17, "16 pixels")):
            result = render(self.folder, *words, check=False)
            self.assertEqual(result.returncode, 1, words)
            self.assertIn(message, result.stderr)
        # Rays that are counted together have no cycles of their own.
        render(self.folder, "--explore", "together.html")
        data, _ = unpack(self.folder / "together.html")
        self.assertNotIn("cycles", data["picture"]["rays"]["fields"])


SEEN = """(() => {
    const all = (selector, what) => Array.from(document.querySelectorAll(selector), what);
    return {
        figures: all("[data-figure]", e => [e.dataset.figure, Number(e.dataset.value), e.textContent]),
        sections: all("main > section", e => [e.id, e.getBoundingClientRect().height]),
        polygons: all("#time svg polygon", e => e).length,
        brief: document.getElementById("brief").textContent,
        memory: document.getElementById("memory-table").textContent,
        cut: all(".scroll", e => e).filter(e => e.scrollWidth > e.clientWidth + 1).map(e => e.firstChild.id),
        causes: all("#causes-table tbody th",
            e => [e.textContent, getComputedStyle(e.querySelector(".swatch")).backgroundColor]),
        rays: all("#rays-table tr", row => Array.from(row.cells, cell => cell.textContent)),
    }; })()"""


class Page(PageTests, Scratch):
    KEEP, CLOSELY = KEEP, "whole"
    MARGIN, PAPER, WIDE = 22, (3, 15), "table, canvas, svg"
    read = {}  # by page

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        program = find_chromium()
        shutil.copy(SOURCE / "tests/render/box.obj", cls.folder / HOSTILE)
        shutil.copy(SOURCE / "tests/render/box.mtl", cls.folder)
        render(cls.folder, "-o", "h.png", "--explore", "hostile.html", "--stats", "hostile.json", mesh=HOSTILE)
        simulate(cls.folder, "--explore", "part.html", "--stats", "part.json", "--max-cycles", "20000",
                 "run/manifest.json", check=False)
        render(cls.folder, "-o", "g.png", "--explore", "general.html", "--stats", "general.json", "--program",
               BIN / "../lib/trax/trax-raytracer.elf", "--config", "1x32", "--set", "memory.model=dram", "--set",
               "dram.preset=lpddr3-1600")
        (cls.folder / "idle.c").write_text("int main(void) {}\n")
        subprocess.run([BIN / "clang", "--target=trax", "-O2", "idle.c", "-o", "idle"], cwd=cls.folder, check=True)
        simulate(cls.folder, "idle", "--explore", "idle.html", "--stats", "idle.json", "--config", "1x32")
        files = {"whole": "p", "manifest": "q", "hostile": "hostile", "partial": "part", "dram": "general"}
        cls.pages = {name: cls.folder / f"{file}.html" for name, file in files.items()}
        cls.browser = Browser(program)
        cls.addClassCleanup(cls.browser.close)

    def seen(self, name):
        """What stands in a page as it was loaded. Loading one takes as long as all looks at it."""
        if name not in self.read:
            self.load(name)
            self.read[name] = self.browser.run(SEEN)
            self.is_quiet()
        return self.read[name]

    def load(self, name):
        self.browser.open(self.pages.get(name, self.folder / f"{name}.html"))
        until = time.monotonic() + 60
        while self.browser.run("document.documentElement.dataset.ready") != "yes":
            self.assertLess(time.monotonic(), until, self.browser.messages)
            time.sleep(0.05)

    def unfold(self):
        self.browser.run("document.querySelector('#lines-table tbody button').click()")

    def key(self, name):
        for kind in ("keyDown", "keyUp"):
            self.browser.call("Input.dispatchKeyEvent", type=kind, key=name, code=name,
                              windowsVirtualKeyCode={"Enter": 13, "ArrowRight": 39, "ArrowDown": 40}.get(name, 0))

    def middle(self, expression):
        return self.browser.run(
            f"(e => {{ e.scrollIntoView({{block: 'center'}}); const b = e.getBoundingClientRect(); return [b.x + "
            f"b.width / 2, b.y + b.height / 2]; }})({expression})"
        )

    def test_figures(self):
        """Every figure of --stats stands on the page, with its value."""
        for name, page in self.pages.items():
            stats, seen = json.loads(self.text(f"{page.stem}.json")), self.seen(name)
            shown = seen["figures"]

            def flat(level, prefix=""):
                for key, value in level.items():
                    if isinstance(value, dict):
                        yield from flat(value, f"{prefix}{key}.")
                    elif isinstance(value, (int, float)) and not isinstance(value, bool):
                        yield prefix + key, value

            expected = {
                key: value for key, value in flat({
                    key: value for key, value in stats.items()
                    if key not in ("configuration", "identity", "exit_status", *OF_HOST)
                })
            }
            self.assertGreater(len(expected), 150)
            self.assertEqual({key: value for key, value, _ in shown}, expected, name)
            for key, value, text in shown:
                if isinstance(value, int) and key.startswith("causes."):
                    self.assertEqual(text, f"{value:,}")
            self.assertEqual(
                [one for one, height in seen["sections"] if height > 60],
                ["causes", "time", "picture", "source", "calls", "hardware", "objects", "waits", "rays", "statistics"],
                name)
            self.assertEqual(seen["polygons"], sum(1 for cycles in stats["causes"].values() if cycles))
            self.assertEqual(stats["partial"], "did not finish" in seen["brief"])
        self.assertIn("DRAM", self.seen("dram")["memory"])

    def test_tables_fit(self):
        """In a window of 1400 pixels no table is cut."""
        for name in self.pages:
            self.assertEqual(self.seen(name)["cut"], [], name)

    def test_colours_of_causes(self):
        """A cause has one colour, whatever other causes a run has, and no other has it. A bar's labels can be read on
        all."""
        known, every = {}, list(json.loads(self.text("p.json"))["causes"])
        for name in self.pages:
            for cause, colour in self.seen(name)["causes"]:
                known.setdefault(cause, set()).add(colour)
        self.assertGreater(len(known), 10)
        self.load("whole")
        self.assertEqual({cause: colours for cause, colours in known.items() if len(colours) > 1}, {})
        both = [
            self.browser.run(f"causesOf({{causes: {json.dumps(causes)}}}, []).map(one => [one.name, one.colour])")
            for causes in ({cause: 1
                            for cause in (*every, "compare_conflict")}, {"fp_mul_conflict": 1, "compare_conflict": 1})
        ]
        self.assertEqual([pair for pair in both[1] if pair not in both[0]], [])
        self.assertEqual(len({colour for _, colour in both[0]}), len(every) + 1)
        for scheme in ("light", "dark"):
            self.browser.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme",
                                                                       "value": scheme}])
            for cause in (*every, "compare_conflict"):
                self.browser.run(f"""document.getElementById("causes-bar").replaceChildren(
                    stack(causesOf({{causes: {{{cause}: 1}}}}, []), {{{cause}: 1}}, 1, "large", true))""")
                text, back = self.browser.run(TEXT_COLOURS.replace("main *, header *", "#causes-bar *"))[0]
                self.assertGreaterEqual(contrast(text, back), 4.5, (scheme, cause, text, back))
        self.browser.call("Emulation.setEmulatedMedia", features=[])

    def test_no_false_zeros(self):
        """An interval without loads has no share of loads that hit: the curve has a gap, not 0 %."""
        rows = list(csv.DictReader(io.StringIO(unpack(self.folder / "p.html")[0]["series"])))
        self.load("whole")
        for tm in ("all", "0", "3"):
            self.browser.run(f"""(s => {{ s.value = "{tm}"; s.dispatchEvent(new Event("change")); }})
                (document.getElementById("time-tm"))""")
            mine = [row for row in rows if row["tm"] == tm]
            known = [any(int(row[f"dcache.{what}"]) for what in ("hits", "misses", "merged")) for row in mine]
            stretches = sum(a and not b for a, b in zip(known, [False, *known]))
            curves = self.browser.run("""Array.from(Array.from(document.querySelectorAll("#time-lines figure"))
                .find(f => f.textContent.includes("Loads that hit")).querySelectorAll(".curve"),
                c => c.points.length)""")
            self.assertEqual((len(curves), sum(curves)), (stretches, 2 * sum(known)), tm)
        self.assertFalse(all(known))  # TM 3 has intervals without loads
        self.load("idle")
        shown = self.browser.run("""document.querySelector("[data-figure='dcache.hit_rate']").textContent +
            document.getElementById("caches-table").tBodies[0].rows[1].cells[2].textContent""")
        self.assertNotRegex(shown, "[0-9]")

    def test_rays_that_are_not_marked(self):
        """A run without --mark-rays knows only the number of rays of a kind."""
        for name, heads in (("whole", 9), ("dram", 2)):
            table = self.seen(name)["rays"]
            self.assertEqual({len(row) for row in table}, {heads}, name)
        stats = json.loads(self.text("general.json"))
        self.assertEqual(table[1:], [
            *([kind, f"{rays:,}"]
              for kind, rays in stats["rays_by_kind"].items() if rays), ["all", f"{stats['rays']:,}"]
        ])

    def test_story(self):
        self.load("whole")
        data, columns = unpack(self.folder / "p.html")
        causes = {name[len("causes."):]: values for name, values in columns.items() if name.startswith("causes.")}
        box = self.browser.run(
            "(e => { e.scrollIntoView({block: 'center'}); const b = e.getBoundingClientRect(); return [b.x, b.y, "
            "b.width, b.height]; })(document.getElementById('picture-cost'))"
        )
        x, y = 17, 20
        at = [box[0] + (x + 0.5) * box[2] / WIDTH, box[1] + (y + 0.5) * box[3] / HEIGHT]

        def check(x, y):
            place = y * WIDTH + x
            cycles, story = sum(
                values[place]
                for values in causes.values()), self.browser.run("document.getElementById('story').innerText")
            thread, begin = columns[".thread"][place] - 1, columns[".begin"][place]
            self.assertIn(f"Pixel ({x}, {y}): {cycles:,} cycles", story)
            self.assertIn(
                f"Thread {thread} (TM {thread // 32}, TP {thread % 32}), cycles {begin:,} to {begin + cycles:,}.",
                story)
            shadows = columns["rays.shadow"][place]
            self.assertIn(
                f"{1 + shadows} rays (1 primary{', 1 shadow' if shadows else ''}), {columns['counts.nodes'][place]:,} "
                f"nodes, {columns['counts.triangles'][place]:,} triangles, "
                f"{causes['issued'][place]:,} instructions", story)
            rows = dict(
                self.browser.run(
                    "Array.from(document.querySelectorAll('#story-table tbody tr'), row => [row.cells[0].textContent, "
                    "row.cells[1].textContent])"
                ))
            self.assertEqual(rows, {cause: f"{values[place]:,}" for cause, values in causes.items() if values[place]})
            return cycles

        self.browser.call("Input.dispatchMouseEvent", type="mouseMoved", x=at[0], y=at[1])
        self.assertRegex(self.browser.run("document.getElementById('tip').textContent"),
                         rf"^\({x}, {y}\)\ncycles {sum(values[y * WIDTH + x] for values in causes.values()):,}$")
        self.browser.press(*at)
        check(x, y)
        # The same with the keyboard, on the other picture.
        self.browser.run("document.getElementById('picture-seen').focus()")
        for key in ("ArrowRight", "ArrowDown", "Enter"):
            self.key(key)
        check(x + 1, y + 1)
        self.assertIn(f"trax-render --pixel {x + 1},{y + 1}.", self.browser.run(
            "document.getElementById('story-more').innerText"))
        # The costliest pixel: its rays, and its costliest function and line.
        self.browser.run("document.querySelector('#costliest tbody button').click()")
        rows = lambda name: self.browser.run(  # noqa: E731
            f"Array.from(document.querySelectorAll('#{name} tbody tr'), row => Array.from(row.cells, one => "
            "one.textContent))")
        place = tuple(map(int, re.findall(r"\d+", self.browser.run(
            "document.querySelector('#costliest tbody button').textContent"))))
        story = next(one for one in data["stories"] if one["place"] == place[1] * WIDTH + place[0])
        self.assertEqual([[row[4], row[6]] for row in rows("story-rays")],
                         [[f"{ray['cycles']:,}", f"{ray['instructions']:,}"] for ray in data["rays"][story["place"]]])
        frames = {one[0]: one[4][0] for one in filter(None, data["instructions"])}
        for table, part in ("story-functions", 0), ("story-lines", 1):
            sums = collections.Counter()
            for pc, *cycles in story["code"]:
                sums[data["names"][frames[pc][part]]] += sum(cycles)
            self.assertEqual([row[1] for row in rows(table)], [f"{count:,}" for _, count in sums.most_common(10)])
        self.assertEqual(self.browser.run("document.querySelectorAll('#story-more svg .axis').length"),
                         len(story["rays"]))  # the rays' begins, and the axis
        # Colours show the chosen cost.
        self.browser.run(
            "(s => { s.value = Array.from(s.options).find(o => o.text === 'nodes').value; s.dispatchEvent(new "
            "Event('change')); })(document.getElementById('picture-what'))"
        )
        self.assertRegex(self.browser.run("document.getElementById('picture-scale').textContent"),
                         rf"most {max(columns['counts.nodes']):,};")
        self.is_quiet()

    def test_end(self):
        """The last pixel, how long it is alone, and what threads had to do after their last, by the items' file."""
        stats = json.loads(self.text("q.json"))
        items = [{name: int(row[name]) for name in ("thread", "place", "begin", "end")}
                 for row in csv.DictReader(io.StringIO(self.text("items.csv"))) if row["kind"] == "item"]
        ends = {}
        for item in items:
            ends[item["thread"]] = max(ends.get(item["thread"], 0), item["end"])
        last = max(items, key=lambda item: item["end"])
        alone, before = (sorted(ends.values())[-1] - sorted(ends.values())[-2],
                         max(item["begin"] for item in items))
        idle = 1 - sum(ends.values()) / stats["thread_cycles"]
        self.load("whole")
        lines = self.browser.run("Array.from(document.querySelectorAll('#brief li'), li => li.textContent)")
        begins = (f"The last {alone:,} cycles wait for" if alone >= stats["cycles"] / 100 else
                  f"The last to end, {alone:,} {'cycle' if alone == 1 else 'cycles'} after all others, was")
        self.assertIn(f"{begins} pixel ({last['place'] % WIDTH}, {last['place'] // WIDTH}), which was begun in cycle "
                      f"{last['begin']:,} and took {last['end'] - last['begin']:,}.", lines)
        self.assertIn(f"After cycle {before:,} no further pixel was begun: threads that had ended theirs had nothing "
                      f"to do in {100 * idle:.1f} % of all thread-cycles.", lines)
        self.browser.run("Array.from(document.querySelectorAll('#brief button')).find("
                         "b => b.textContent.startsWith('pixel')).click()")
        story = self.browser.run("document.getElementById('story').innerText")
        self.assertIn(f"Pixel ({last['place'] % WIDTH}, {last['place'] // WIDTH}):", story)
        own = sum(item["thread"] == last["thread"] for item in items)
        self.assertIn(f"The {own} pixels of its thread over the run", story)
        # The chosen one is drawn where it is in time.
        pink = self.browser.run(
            "(c => { const d = c.getContext('2d').getImageData(0, 1, 1200, 1).data, found = []; "
            "for (let i = 0; i < 1200; i++) if (d[4 * i] === 255 && d[4 * i + 1] === 45 && d[4 * i + 3] === 255)"
            " found.push(i); return [found[0], "
            "found[found.length - 1]]; })(document.querySelector('canvas.line'))"
        )
        for found, cycle in zip(pink, (last["begin"], last["end"])):
            self.assertAlmostEqual(found, 1200 * cycle / stats["cycles"], delta=3)
        self.is_quiet()

    def test_source(self):
        self.load("whole")
        data, _ = unpack(self.folder / "p.html")
        total, lines = data["stats"]["thread_cycles"], collections.Counter()
        for one in filter(None, data["instructions"]):
            lines[data["names"][one[4][0][1]]] += sum(one[5])
        del lines[""]
        hottest, cycles = max(lines.items(), key=lambda line: (line[1], line[0]))
        self.assertIn(pathlib.Path(hottest).name, self.browser.run("document.getElementById('brief').textContent"))
        self.browser.run("document.querySelector('#lines-table tbody button').click()")
        row = self.browser.run(
            "(row => [row.dataset.line, row.cells[1].textContent, "
            "row.cells[6].textContent])(document.querySelector('#listing tr[aria-expanded=true]'))"
        )
        path, number = hottest.rsplit(":", 1)
        self.assertEqual(
            row,
            [number, f"{100 * cycles / total:.1f} %",
             pathlib.Path(path).read_text().splitlines()[int(number) - 1]])
        mine = [one for one in filter(None, data["instructions"]) if data["names"][one[4][0][1]] == hottest]
        below = self.browser.run(
            "Array.from(document.querySelectorAll('#listing tr.instruction'), row => [row.cells[0].textContent, "
            "row.cells[3].textContent, row.cells[6].textContent])"
        )
        self.assertEqual([(pc, issued) for pc, issued, _ in below],
                         [(f"{one[0]:08x}", f"{one[5][0]:,}") for one in mine])
        for (_, _, text), one in zip(below, mine):
            self.assertTrue(text.startswith(one[1]), text)
        # Awaited lines: in the table of lines, in the listing, and the first row of their own table.
        awaited = collections.Counter()
        for wait in csv.DictReader(io.StringIO(data["waits"])):
            awaited[wait["line"]] += sum(int(value) for name, value in wait.items() if name in data["stats"]["causes"])
        share = f"{100 * awaited[hottest] / total:.1f} %"
        for row in "#listing tr[aria-expanded=true]", "#lines-table tbody tr":
            self.assertEqual(self.browser.run(f"document.querySelector('{row}').cells[5].textContent"), share)
        most, cycles = max(awaited.items(), key=lambda line: line[1])
        self.assertEqual(
            self.browser.run("(row => [row.cells[0].textContent, row.cells[3].textContent])("
                             "document.querySelector('#waits-table tbody tr'))"),
            [pathlib.Path(most).name, f"{100 * cycles / total:.1f} %"])
        tree = self.browser.run("document.getElementById('calls-tree').innerText")
        for name in ("_start", "main", "trace_ray"):
            self.assertIn(name, tree)
        self.browser.run(
            "(i => { i.value = 'queue peak'; i.value = 'cache dropped'; i.dispatchEvent(new Event('input')); "
            "})(document.getElementById('statistics-filter'))"
        )
        self.assertEqual(
            self.browser.run(
                "Array.from(document.querySelectorAll('#statistics-table tbody tr:not([hidden])'), row => "
                "row.cells[0].textContent)"
            ), ["dcache.dropped"])
        self.is_quiet()

    def test_without_lines(self):
        """Instructions without a line are listed, by address; a name with quotation marks and commas is one cell."""
        (self.folder / "plain.c").write_text(
            'volatile unsigned named[9] __asm__("a\\"b,c");\nint main(void) { for (unsigned i = 0; i < 9; i++) '
            'named[i] = i; }\n'
        )
        subprocess.run([BIN / "clang", "--target=trax", "-O1", "plain.c", "-o", "plain"], cwd=self.folder, check=True)
        simulate(self.folder, "--explore", "plain.html", "--heat", "plain.csv", "plain")
        data, _ = unpack(self.folder / "plain.html")
        self.assertEqual(
            [row["object"] for row in csv.DictReader(io.StringIO(self.text("plain.csv"))) if row["stores"] == "9"],
            ['a"b,c'])
        unknown = [one for one in filter(None, data["instructions"]) if not data["names"][one[4][0][1]]]
        self.assertTrue(unknown)
        self.pages = {**self.pages, "plain": self.folder / "plain.html"}
        self.load("plain")
        self.assertIn(
            'a"b,c',
            self.browser.run("Array.from(document.querySelectorAll('#objects tbody th'), cell => cell.textContent)"))
        self.browser.run(
            "(s => { s.value = Array.from(s.options).find(o => o.text.startsWith('(no line is known)')).value; "
            "s.dispatchEvent(new Event('change')); })(document.getElementById('source-file'))"
        )
        self.browser.run("document.querySelector('#listing tbody tr').click()")
        below = self.browser.run(
            "Array.from(document.querySelectorAll('#listing tr.instruction'), row => row.cells[0].textContent)")
        self.assertEqual(below, [f"{one[0]:08x}" if one[0] is not None else "" for one in unknown])
        self.is_quiet()

    def test_names_are_text(self):
        self.load("hostile")
        self.assertIn(HOSTILE, self.browser.run("document.querySelector('h1').textContent"))
        self.assertEqual(self.browser.run("document.querySelectorAll('img').length"), 0)
        self.assertIn("--mark-rays", self.browser.run("document.getElementById('rays-note').textContent"))
        self.is_quiet()


if __name__ == "__main__":
    unittest.main()
