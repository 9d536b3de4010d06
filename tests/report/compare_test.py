#!/usr/bin/env python3
"""trax-sim compare: compare_test.py BIN SOURCE [--keep DIR]. Properties of every comparison, on runs of two chips and
on random statistics: a run does not differ from itself, the parts add up to the difference of cycles, B against A is A
against B with the other sign, and a figure that is changed is found. Then the files beside the statistics, folders,
sampled runs, bad input, and the page in a browser. --keep leaves pages and pictures in a folder, to be looked at."""

import base64
import contextlib
import copy
import fractions
import io
import json
import os
import pathlib
import random
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import time
import types
import unittest
import zlib

from browser import Browser, PageTests, find_chromium, take_keep

BIN, SOURCE = (pathlib.Path(one).resolve() for one in sys.argv[1:3])
del sys.argv[1:3]
KEEP = take_keep()
WHOLE = os.environ.get("TRAX_WHOLE")
DATA = BIN.parent / "lib/trax/evaluation"
sys.path.insert(0, str(DATA))

from command.main import main  # noqa: E402
from compare.difference import compare, flat  # noqa: E402
from compare.figures import SECTIONS, Figures  # noqa: E402
from compare.page import without  # noqa: E402
from compare.runs import HOST, Run  # noqa: E402
from compare.text import is_empty, part, print_comparison  # noqa: E402
from trax_eval.pictures import png, read_png  # noqa: E402
from trax_eval.tools import Tools  # noqa: E402
from trax_eval.util import Problem  # noqa: E402

FIGURES = Figures(Tools(BIN))
TABLES = ("causes", "functions", "lines", "kinds")
CHIPS = {"a": ("--config", "1x32"), "b": ("--config", "2x32", "--set", "dcache.bytes=32768")}


def setUpModule():
    scratch = tempfile.TemporaryDirectory()
    unittest.addModuleCleanup(scratch.cleanup)
    Scratch.folder = pathlib.Path(scratch.name)
    for name, chip in CHIPS.items():
        subprocess.run([
            BIN / "trax-render", SOURCE / "tests/render/box.obj", "--view", SOURCE / "tests/render/box.view", "--size",
            "48x27", "--mark-rays", *chip, "--explore", f"{name}.html", "--stats", f"{name}.json",
            "-o", f"{name}.png", "-q"
        ], cwd=Scratch.folder, check=True)
    Scratch.runs = {name: Run(Scratch.folder / f"{name}.json") for name in CHIPS}


class Scratch(unittest.TestCase):
    def command(self, *words, status=0, folder=None):
        """Runs the command in this process."""
        out, errors = io.StringIO(), io.StringIO()
        place = contextlib.chdir(folder or self.folder)
        with place, contextlib.redirect_stdout(out), contextlib.redirect_stderr(errors):
            found = main(["compare", *map(str, words)], BIN, DATA)
        self.assertEqual(found, status, errors.getvalue() + out.getvalue())
        return types.SimpleNamespace(stdout=out.getvalue(), stderr=errors.getvalue())

    def run_of(self, stats, name="made.json"):
        path = pathlib.Path(self.made.name) / name
        path.write_text(json.dumps(stats))
        return Run(path)

    def setUp(self):
        self.made = tempfile.TemporaryDirectory()
        self.addCleanup(self.made.cleanup)


def negative(comparison):
    """The comparison of the same runs in the other order."""
    def turned(value):
        if isinstance(value, list):
            return [turned(one) for one in value]
        if not isinstance(value, dict):
            return value
        out = {}
        for key, one in value.items():
            swapped = f"{key[:-1]}{'ab'[key[-1] == 'a']}" if key in ("a", "b") or key.endswith(("_a", "_b")) else key
            out[swapped] = -one if key in ("difference", "cause_difference") and one is not None else \
                "ab"[one == "a"] if key == "only_in" else one if key == "largest" and not isinstance(one, dict) else \
                turned(one)
        return out

    made = turned(comparison)
    made["cycles"]["relative"] = made["warnings"] = made["missing"] = None
    if made["cycles"]["interval"]:
        made["cycles"]["interval"] = [-end for end in reversed(made["cycles"]["interval"])]
    if "cost" in made.get("pictures", {}):
        cost = made["pictures"]["cost"]
        cost["pixels_less"], cost["pixels_more"] = cost["pixels_more"], cost["pixels_less"]
    return made


def plain(comparison):
    comparison = copy.deepcopy(comparison)
    comparison["cycles"]["relative"] = comparison["warnings"] = comparison["missing"] = None
    return comparison


class Against(Scratch):
    """--explore-against."""
    def setUp(self):
        super().setUp()
        self.page, self.plain = pathlib.Path(self.made.name) / "b.html", (self.folder / "b.html").read_bytes()

    def render(self, *words, status=0):
        done = subprocess.run([
            BIN / "trax-render", SOURCE / "tests/render/box.obj", "--view", SOURCE / "tests/render/box.view", "--size",
            "48x27", "--mark-rays", *CHIPS["b"], "-o", self.page.with_suffix(".png"), "-q", *words
        ], cwd=self.folder, capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, status, done.stderr)
        return done.stderr

    def test_run(self):
        self.render("--explore", self.page, "--explore-against", "a.json")
        found = self.page.read_bytes()
        self.assertEqual(without(found.decode()), self.plain.decode())
        self.page.write_bytes(self.plain)
        for _ in range(2):  # the second replaces the first
            self.command("--add", "a.json", self.page)
            self.assertEqual(self.page.read_bytes(), found)

    def test_errors(self):
        said = self.render("--explore", self.page, "--explore-against", "missing.json", status=1)
        self.assertIn("missing.json: No such file", said)
        self.assertIn("needs --explore", self.render("--explore-against", "a.json", status=1))
        self.assertEqual(os.listdir(self.made.name), [])
        bad = self.page.with_name("bad.json")
        bad.write_text("[]")
        said = self.render("--explore", self.page, "--explore-against", bad, status=1)
        self.assertIn(f"b.html: the differences to {bad} are missing: trax-sim: error: {bad}: is", said)
        self.assertEqual(self.page.read_bytes(), self.plain)
        self.assertIn("needs a page", self.command("--add", "a.json", "b.json", status=1).stderr)


class Properties(Scratch):
    def check_pair(self, a, b):
        there, back = compare(a, b, FIGURES)[0], compare(b, a, FIGURES)[0]
        self.assertEqual(plain(back), negative(there))
        cycles = [run.stats["cycles"] for run in (a, b)]
        for name in TABLES:
            rows = there.get(name)
            if rows is None:
                continue
            self.assertAlmostEqual(sum(row["difference"] for row in rows), cycles[1] - cycles[0],
                                   delta=1e-7 * max(cycles))
            self.assertNotIn("(charged to nothing)", [row["name"] for row in rows])
            self.assertEqual([abs(row["difference"]) for row in rows],
                             sorted((abs(row["difference"]) for row in rows), reverse=True))
        # A second computation, with exact fractions.
        exact = {}
        for sign, run in ((-1, a), (1, b)):
            for cause, value in run.stats["causes"].items():
                exact[cause] = exact.get(cause, 0) + sign * fractions.Fraction(value, run.stats["threads"])
        self.assertEqual(sum(exact.values()), cycles[1] - cycles[0])
        found = {row["name"]: row["difference"] for row in there["causes"]}
        self.assertEqual(found.keys(), {cause for cause, value in exact.items() if value})
        for cause, value in found.items():
            self.assertAlmostEqual(value, float(exact[cause]), delta=1e-9 * max(cycles))
        return there

    def test_runs_of_two_chips(self):
        found = self.check_pair(self.runs["a"], self.runs["b"])
        self.assertEqual({row["name"]: (row["a"], row["b"]) for row in found["configuration"]},
                         {"chip.tms": (1, 2), "dcache.bytes": (16384, 32768)})
        self.assertEqual(found["pictures"]["different"], 0)
        self.assertGreater(found["pictures"]["cost"]["pixels_less"], 0)
        self.assertEqual(len(found["warnings"]), 1)  # they are compiled for their numbers of TMs
        self.assertIn("different programs: trax-render compiles one for each", found["warnings"][0])
        energies = {row["name"]: row["difference"] for row in found["sections"]["energy"]}
        whole = energies.pop("energy.total")
        parts = sum(value for name, value in energies.items()
                    if name not in ("energy.per_ray", "energy.average_power", "energy.off_chip"))
        self.assertAlmostEqual(parts, whole, delta=1e-9 * abs(self.runs["a"].stats["energy"]["total"]))

    def test_itself(self):
        for run in self.runs.values():
            found, pictures = compare(run, run, FIGURES)
            self.assertTrue(is_empty(found))
            self.assertEqual(([*flat([found["sections"]])][0][1], pictures), ([], {}))
            text = io.StringIO()
            print_comparison(found, True, lambda line: print(line, file=text))
            self.assertIn("Nothing differs.", text.getvalue())

    def test_random_statistics(self):
        chance = random.Random(35)
        for _ in range(60 if WHOLE else 10):
            pair = []
            for name in ("x.json", "y.json"):
                stats = copy.deepcopy(self.runs["a"].stats)
                stats["threads"] = chance.choice([1, 3, 32, 512])
                left = stats["thread_cycles"] = stats["threads"] * chance.randrange(10**chance.randrange(1, 13))
                stats["cycles"] = left // stats["threads"]
                causes = chance.sample(list(stats["causes"]), 5)
                stats["causes"] = dict.fromkeys(stats["causes"], 0)
                for cause in causes:
                    stats["causes"][cause] = chance.randrange(left + 1)
                    left -= stats["causes"][cause]
                stats["causes"]["issued"] += left
                pair.append(self.run_of(stats, name))
            self.check_pair(*pair)

    def test_every_change_is_found(self):
        chance, original = random.Random(36), json.loads((self.folder / "a.json").read_text())
        names = [name for name, _ in flat(original) if name not in HOST]
        few = [name for name in names if not name.startswith("tms.")]
        for name in (few if WHOLE else chance.sample(few, 30)) + chance.sample(names, 10):
            stats = copy.deepcopy(original)
            *way, last = (int(part) if part.isdecimal() else part for part in name.split("."))
            owner = stats
            for step in way:
                owner = owner[step]
            value = owner[last]
            owner[last] = chance.choice([value + 1, value * 2 + 3]) if type(value) in (int, float) else \
                not value if isinstance(value, bool) else f"{value}!"
            if name == "threads":
                stats["threads"] = 64
            found = compare(self.run_of(original, "x.json"), self.run_of(stats, "y.json"), FIGURES)[0]
            rows = [*found["configuration"], *(row for one in found["sections"].values() for row in one)]
            listed = {row["name"]: (row["a"], row["b"]) for row in rows}
            key = name.removeprefix("configuration.")
            if name.startswith("causes."):
                self.assertIn(last, [row["name"] for row in found["causes"]])
            else:
                self.assertEqual(listed.get(key), (value, owner[last]), name)
            self.assertLessEqual(len(listed), 1, name)

    def test_what_one_has_alone(self):
        stats = copy.deepcopy(self.runs["a"].stats)
        del stats["energy"]
        found = compare(self.runs["a"], self.run_of(stats), FIGURES)[0]["sections"]["energy"]
        self.assertEqual({row["only_in"] for row in found}, {"a"})
        self.assertEqual({row["name"] for row in found},
                         {f"energy.{name}" for name in self.runs["a"].stats["energy"]})

    def test_units_and_meanings(self):
        self.assertEqual({"fp_add", "fp_mul", "int_mul", "special", "ray"}, FIGURES.units)
        for name, value in flat(self.runs["a"].stats):
            if not name.startswith(("tms.", "channels.", "configuration.", "identity.")) and not isinstance(value, str):
                self.assertTrue(FIGURES.meaning(name) or name in ("partial", "exit_status"), name)
        self.assertEqual(FIGURES.unit("cause_percent.issued"), "per cent")


class Files(Scratch):
    def setUp(self):
        super().setUp()
        self.place = pathlib.Path(self.made.name)

    def test_beside(self):
        shutil.copy(self.folder / "a.json", self.place / "r.json")
        bare = Run(self.place / "r.json")
        self.assertEqual((bare.profile, bare.kinds, bare.picture, bare.costs), (None,) * 4)
        shutil.copy(self.folder / "a.png", self.place / "r.png")
        drawn = Run(self.place / "r.json")
        self.assertEqual((drawn.picture, drawn.notes), (self.runs["a"].picture, []))
        # The page of another run is not used.
        shutil.copy(self.folder / "b.html", self.place / "r.html")
        other = Run(self.place / "r.json")
        self.assertEqual((other.profile, other.kinds, other.costs, len(other.notes)), (None, None, None, 1))
        self.assertIn("page of another run", other.notes[0])
        self.assertEqual(other.picture, self.runs["a"].picture)

    def test_page_alone(self):
        page = Run(self.folder / "a.html")
        self.assertTrue({"rest", "all"}.isdisjoint(page.kinds))
        self.assertEqual((page.profile, page.kinds, page.picture, page.costs),
                         tuple(getattr(self.runs["a"], name) for name in ("profile", "kinds", "picture", "costs")))
        found = compare(page, self.runs["a"], FIGURES)[0]
        self.assertTrue(is_empty(found))

    def test_every_filter_of_png(self):
        chance, width, height = random.Random(7), 13, 10
        for step, kind in ((3, 2), (4, 6), (1, 0)):
            rows = [bytes(chance.randrange(4) for _ in range(width * step)) for _ in range(height)]
            packed, above = b"", bytes(width * step)
            for number, row in enumerate(rows):
                filter_ = number % 5
                packed += bytes([filter_])
                for place, value in enumerate(row):
                    left, corner = (row[place - step], above[place - step]) if place >= step else (0, 0)
                    up = above[place]
                    paeth = min((left, up, corner), key=lambda one: abs(left + up - corner - one))
                    packed += bytes([(value - (0, left, up, (left + up) // 2, paeth)[filter_]) & 255])
                above = row
            chunks = ((b"IHDR", struct.pack(">IIBBBBB", width, height, 8, kind, 0, 0, 0)),
                      (b"IDAT", zlib.compress(packed)))
            path = self.place / "p.png"
            path.write_bytes(b"\x89PNG\r\n\x1a\n" + b"".join(
                struct.pack(">I", len(data)) + name + data + b"\0\0\0\0" for name, data in chunks))
            colours = [[row[at * step + (channel if step > 1 else 0)] for channel in range(3)]
                       for row in rows for at in range(width)]
            shutil.copy(self.folder / "a.json", self.place / "p.json")
            self.assertEqual(Run(self.place / "p.json").picture, (width, height, bytes(sum(colours, []))))

    def test_pictures_of_differences(self):
        a, b = copy.copy(self.runs["a"]), copy.copy(self.runs["a"])
        width, height, pixels = a.picture
        changed = bytearray(pixels)
        for place, by in ((5, 3), (700, 9)):
            changed[3 * place + 1] = (changed[3 * place + 1] + by) & 255 if changed[3 * place + 1] < 240 else \
                changed[3 * place + 1] - by
        b.picture = width, height, bytes(changed)
        counts, made = compare(a, b, FIGURES)
        self.assertEqual({**counts["pictures"]}, {"pixels": width * height, "different": 2, "largest": 9})
        (self.place / "d.png").write_bytes(made["pixels"])
        self.assertEqual(list(made), ["pixels"])
        b.picture = width, height - 1, pixels
        self.assertEqual(compare(a, b, FIGURES)[0]["pictures"], {"sizes": [[width, height], [width, height - 1]]})

    def test_pictures_as_files(self):
        """A picture of no difference is transparent, and the page is written beside it. Pictures that cannot be
        compared leave no file."""
        page, pixels, costs = (self.place / name for name in ("x.html", "d.png", "c.png"))
        self.command("a.json", "b.json", "--html", page, "--picture", pixels, "--cost-picture", costs)
        self.assertTrue(page.is_file())
        for path, is_equal in ((pixels, True), (costs, False)):
            alphas = set(read_png(path.read_bytes())[3][3::4])
            self.assertEqual(alphas == {0}, is_equal, path)
            path.unlink()
        page.unlink()
        for name, size in (("p", (2, 1)), ("q", (1, 1)), ("r", None)):
            shutil.copy(self.folder / "a.json", self.place / f"{name}.json")
            if size:
                (self.place / f"{name}.png").write_bytes(
                    png({"width": size[0], "height": size[1], "layout": "rgba uint8"}, bytes(4 * size[0] * size[1])))
        kept = sorted(self.place.iterdir())
        for words, said in ((("p.json", "q.json", "--picture", "d.png"), "the runs' are of 2x1 and 1x1 pixels"),
                            (("p.json", "r.json", "--picture", "d.png"), "B has none (--explore FILE.html, or a PNG)"),
                            (("p.json", "p.json", "--cost-picture", "d.png"),
                             "A and B have none (--explore FILE.html)")):
            run = self.command(*words, "--html", "x.html", status=1, folder=self.place)
            self.assertEqual(run.stderr, f"trax-sim: error: d.png: no picture of differences: {said}\n")
            self.assertEqual(sorted(self.place.iterdir()), kept)

    def test_sampled(self):
        def sampled(cycles, low, high):
            stats = copy.deepcopy(self.runs["a"].stats)
            stats["causes"]["issued"] += 32 * (cycles - stats["cycles"])
            stats |= {"cycles": cycles, "thread_cycles": 32 * cycles,
                      "sampled": {"cycles_low": low, "cycles_high": high}}
            return self.run_of(stats)

        base = self.runs["a"].stats["cycles"]
        a, near, far = (sampled(base + at, base + at - 300, base + at + 400) for at in (0, 100, 5000))
        found = compare(a, near, FIGURES)[0]["cycles"]
        self.assertEqual((found["difference"], found["interval"], found["within_noise"]), (100, [-400, 600], True))
        self.assertEqual(compare(a, far, FIGURES)[0]["cycles"]["within_noise"], False)
        self.assertEqual(compare(far, a, FIGURES)[0]["cycles"]["interval"], [-5500, -4500])
        self.assertIsNone(compare(self.runs["a"], self.runs["a"], FIGURES)[0]["cycles"]["within_noise"])
        for runs, said in (((a, near), "A and B are sampled: the difference is -400 to +600 with 95 %"),
                           ((a, self.runs["a"]), "A is sampled: "), ((self.runs["a"], a), "B is sampled: ")):
            lines = []
            print_comparison(compare(*runs, FIGURES)[0], False, lines.append)
            self.assertTrue(any(line.startswith(said) for line in lines), lines)

    def test_many_times_as_long(self):
        """The shares of contributions add up to that of the difference; only a whole run has a factor."""
        short = copy.deepcopy(self.runs["a"].stats)
        short |= {"cycles": 100, "thread_cycles": 3200, "causes": {"issued": 1000, "halted": 2200}}
        long = short | {"cycles": 500000, "thread_cycles": 16000000, "causes": {"wait_memory": 16000000}}
        lines = []
        print_comparison(compare(self.run_of(short), self.run_of(long, "long.json"), FIGURES)[0], False, lines.append)
        text = "\n".join(lines)
        self.assertIn("B takes 499,900 cycles more than A (x 5,000).", text)
        shares = re.findall(r"([+-][\d.,]+) %  ", text[:text.index("Functions and")])
        self.assertEqual((len(shares), sum(float(share.replace(",", "")) for share in shares)), (3, 499900))

    def test_names_without_control_characters(self):
        stats = copy.deepcopy(self.runs["a"].stats)
        other = self.run_of(stats | {"\x1b[31m\n": 1, "program": "\x1b]0;x"}, "odd\udcff.json")
        lines = []
        print_comparison(compare(self.runs["a"], other, FIGURES)[0], True, lines.append)
        self.assertEqual([line for line in lines if not line.isprintable()], [])
        self.assertIn("\\x1b[31m\\x0a", "\n".join(lines))

    def test_folders(self):
        for name, runs in (("before", ("a", "b")), ("after", ("b", "a"))):
            (self.place / name).mkdir()
            for number, run in enumerate(runs):
                shutil.copy(self.folder / f"{run}.json", self.place / name / f"r{number}.json")
        shutil.copy(self.folder / "a.html", self.place / "after/page.html")
        (self.place / "after/list.json").write_text("[1]")
        for folder in ("folder.json", "folder.html"):
            (self.place / "after" / folder).mkdir()
        found = json.loads(self.command("--json", "before", "after", folder=self.place).stdout)
        self.assertEqual((sorted(found["runs"]), found["only_a"], found["only_b"]), (["r0", "r1"], [], ["page"]))
        self.assertEqual(found["runs"]["r0"]["cycles"]["difference"], -found["runs"]["r1"]["cycles"]["difference"])
        self.assertAlmostEqual(found["ratio"], 1)
        text = self.command("before", "after", folder=self.place).stdout
        self.assertIn("only in B: page", text)
        for name in ("one", "two"):
            (self.place / name).mkdir()
            shutil.copy(self.folder / "a.json", self.place / name / f"{name}.json")
        self.assertIn("one", self.command("one", "two", folder=self.place).stdout)

    def test_warnings(self):
        stats = copy.deepcopy(self.runs["a"].stats) | {"trax_sim": "0.1", "program": "x/other", "items": 3,
                                                       "status": "limit"}
        found = compare(self.runs["a"], self.run_of(stats), FIGURES)[0]["warnings"]
        for word in ("versions of trax-sim: ", ".elf and other", "numbers of items: ", "did not finish (limit)"):
            self.assertEqual(sum(word in one for one in found), 1, (word, found))
        stats["causes"]["issued"] += 1000
        made = compare(self.runs["a"], self.run_of(stats), FIGURES)[0]
        self.assertTrue(any("do not add up" in one for one in made["warnings"]))
        self.assertEqual(made["causes"][0]["difference"], -made["causes"][1]["difference"])

    def test_bad_input(self):
        good = json.loads((self.folder / "a.json").read_text())
        text = (self.folder / "a.html").read_text()
        for name, content, said in (
                ("empty.json", "", "neither a file of --stats"), ("cut.json", json.dumps(good)[:500], ":1:"),
                ("list.json", "[]", "neither a file of --stats"), ("none.json", "{}", '"cycles" is no number'),
                ("text.json", json.dumps(good | {"cycles": "7"}), '"cycles" is no number'),
                ("true.json", json.dumps(good | {"threads": True}), '"threads" is no number'),
                ("zero.json", json.dumps(good | {"threads": 0}), '"threads" is 0'),
                ("cause.json", json.dumps(good | {"causes": {"issued": []}}), '"causes.issued" is no number'),
                ("noise.json", json.dumps(good | {"sampled": {}}), "no interval"),
                ("large.json", json.dumps(good | {"cycles": 10**400}), '"cycles" is no figure that a run can have'),
                ("sum.json", json.dumps(good | {"causes": {"a": 1.7e308, "b": 1.7e308}}), '"causes.a" is no figure'),
                ("chip.json", json.dumps(good | {"configuration": {"chip": [1]}}), '"configuration.chip" is no object'),
                ("nan.json", json.dumps(good | {"mrps": float("nan")}), "NaN"),
                ("page.html", "<html></html>", "no page of --explore"),
                ("cut.html", text[:20000], "no page of --explore"),
                ("odd.html", text.replace('id="data">e', 'id="data">f'), "no page of --explore")):
            (self.place / name).write_text(content)
            run = self.command(name, self.folder / "a.json", status=1, folder=self.place)
            self.assertRegex(run.stderr, f"^trax-sim: error: {name}:.*")
            self.assertIn(said, run.stderr)
            self.assertEqual((run.stdout, run.stderr.count("\n")), ("", 1))
        (self.place / "c.json").write_text(json.dumps(good))
        (self.place / "c.png").write_text("GIF89a")
        self.assertIn("c.png", self.command("c.json", "c.json", status=1, folder=self.place).stderr)

    def test_forged_pages(self):
        """A value of another type or size anywhere in the data of a page is an error that names the page."""
        text = (self.folder / "a.html").read_text()
        begin, data, end = re.split(r'(?<=id="data">)([A-Za-z0-9+/=]*)', text, maxsplit=1)
        page = json.loads(zlib.decompress(base64.b64decode(data)))
        last = page["instructions"][-2]  # the one behind it is no instruction
        function = last[4][0][0]
        kinds = [f"kind,rays,thread_cycles,issued\nprimary,1,{end}"
                 for end in ("1e999,1\n", "x" * 99999, f"{'9' * 5000},1\n")]
        for place, key, value in ((page["names"], function, 7), (last[5], 0, 10**400), (last[5], 0, "1"),
                                  (page["picture"], "width", -1), (page["picture"], "height", 0),
                                  (page, "ray_kinds", 3), (page, "names", {}),
                                  *((page, "ray_kinds", text)
                                    for text in (*kinds, "a,b\n1,2\n", "kind,rays\nprimary,1\n")),
                                  (page, "picture", {"width": 10**9, "height": 10**9, "columns": [None]})):
            kept, place[key] = place[key], value
            packed = base64.b64encode(zlib.compress(json.dumps(page).encode())).decode()
            (self.place / "forged.html").write_text(begin + packed + end)
            place[key] = kept
            run = self.command("forged.html", self.folder / "a.json", status=1, folder=self.place)
            self.assertRegex(run.stderr, "^trax-sim: error: forged.html: is no page of --explore .*\n$")

    def test_bad_use(self):
        a, b = self.folder / "a.json", self.folder / "b.json"
        for words, said in (((a,), "are required: b"), ((a, b, a), "unrecognized arguments"),
                            ((a, "none.json"), "none.json: No such file"), ((a, self.folder), "one is a folder"),
                            ((a, b, "--html", a), "is an input and the output"), ((a, b, "--jsn"), "unrecognized"),
                            ((a, b, "--html", self.folder / "a.html"), "is an input and the output"),
                            ((a, b, "--html", "none/x.html"), "none/x.html: No such file"),
                            ((self.place, self.place), "has no run")):
            run = self.command(*words, status=1, folder=self.place)
            self.assertIn(said, run.stderr)
            self.assertEqual((run.stdout, list(self.place.iterdir())), ("", []))
        self.assertEqual(self.command("--help").stdout.splitlines()[0], "usage: trax-sim compare [OPTION...] A B")

    def test_program(self):
        """The command in a process of its own."""
        with subprocess.Popen(["cat", self.folder / "a.json"], stdout=subprocess.PIPE) as source:
            pipe = subprocess.run([BIN / "trax-sim", "compare", "/dev/stdin", self.folder / "b.json"],
                                  stdin=source.stdout, capture_output=True, text=True)
        self.assertIn("A  /dev/stdin: 1x32, ", pipe.stdout, pipe.stderr)
        for words, status in (((self.folder / "a.json", self.folder / "b.json"), 0), (("none.json", "x"), 1)):
            run = subprocess.run([BIN / "trax-sim", "compare", *words], cwd=self.place, capture_output=True, text=True)
            here = self.command(*words, status=status, folder=self.place)
            self.assertEqual((run.returncode, run.stdout, run.stderr), (status, here.stdout, here.stderr))
        alone = self.place / "bin"
        alone.mkdir()
        shutil.copy(BIN / "trax-sim", alone)
        run = subprocess.run([alone / "trax-sim", "compare", "a", "b"], capture_output=True, text=True)
        self.assertEqual(run.returncode, 1)
        self.assertRegex(run.stderr, "^trax-sim: error: compare: .*/trax-eval cannot be started: No such file")

    def test_text(self):
        text = self.command("a.json", "b.json", "--cost-picture", self.place / "cost.png").stdout
        self.assertTrue((self.place / "cost.png").read_bytes().startswith(b"\x89PNG"))
        for line in ("A  a.json: 1x32, ", "  chip.tms  ", "Pictures: the same", "Kinds of rays, in cycles",
                     "and shares (--all)"):
            self.assertIn(line, text)
        every = self.command("a.json", "b.json", "--all").stdout
        for _, title, *_ in SECTIONS:
            self.assertIn(title, every) if title != "Other members" and title != "Work" else None
        self.assertNotIn("more (--all)", every)
        found = json.loads(self.command("a.json", "b.json", "--json").stdout)
        self.assertEqual(found["cycles"]["a"], self.runs["a"].stats["cycles"])
        for name in ("a", "b"):
            shutil.copy(self.folder / f"{name}.json", self.place)
        bare = self.command("a.json", "b.json", folder=self.place).stdout
        self.assertIn("Functions and lines are not compared: A and B have none (--explore FILE.html", bare)

    def test_readers_of_pages(self):
        with self.assertRaisesRegex(Problem, "no page"):
            (self.place / "x.html").write_text("x")
            Run(self.place / "x.html")


class Page(PageTests, Scratch):
    KEEP, CLOSELY = KEEP, "two"
    REQUESTS, TEXTS, PAPER = r"^(file://.*\.html$|data:image/png)", 4, (2, 40)

    @classmethod
    def setUpClass(cls):
        folder = cls.folder / "pages"
        for name in CHIPS:
            (folder / name).mkdir(parents=True)
            for ending in ("json", "html"):
                shutil.copy(cls.folder / f"{name}.{ending}", folder / name / f"run.{ending}")
                shutil.copy(cls.folder / f"a.{ending}", folder / name / f"same.{ending}")
        for name, words in (("two", ("../a.json", "../b.json")), ("folders", ("a", "b"))):
            subprocess.run([BIN / "trax-sim", "compare", *words, "--html", f"{name}.html"], cwd=folder, check=True,
                           stdout=subprocess.DEVNULL)
        shutil.copy(cls.folder / "b.html", folder / "against.html")
        subprocess.run([BIN / "trax-sim", "compare", "--add", "../a.json", "against.html"], cwd=folder, check=True)
        timeless = json.loads((cls.folder / "a.json").read_text()) | {"cycles": 0, "thread_cycles": 0, "causes": {}}
        (folder / "timeless.json").write_text(json.dumps(timeless))
        subprocess.run([BIN / "trax-sim", "compare", "timeless.json", "../a.json", "--html", "timeless.html"],
                       cwd=folder, check=True, stdout=subprocess.DEVNULL)
        cls.pages = {name: folder / f"{name}.html" for name in ("two", "folders", "against", "timeless")}
        cls.browser = Browser(find_chromium())
        cls.addClassCleanup(cls.browser.close)

    def test_added(self):
        """The section of --explore-against, in the page of the run: its rows, light, dark, on a telephone and on
        paper. Loading the page takes longer than these."""
        found = compare(self.runs["a"], self.runs["b"], FIGURES)[0]
        self.load("against")
        for name in ("causes", "functions", "lines"):
            rows = self.cells(f"against-{name}-table")
            self.assertEqual([row[0] for row in rows], [row["name"] for row in found[name]])
        self.assertEqual(self.browser.run("document.querySelectorAll('#against-pictures img').length"), 1)
        self.assertEqual(self.browser.run("document.querySelector('nav a').textContent"), "Differences")
        self.assertGreater(self.browser.run("document.querySelectorAll('#causes-table tbody tr').length"), 5)
        ids = self.browser.run("Array.from(document.querySelectorAll('[id]'), one => one.id)")
        self.assertEqual(len(ids), len(set(ids)))
        self.unfold()
        self.can_be_read("light")
        light = self.ground()
        self.browser.run("document.getElementById('theme').click()")
        self.assertNotEqual(self.ground(), light)
        self.can_be_read("dark")
        self.fits_paper()
        self.browser.call("Emulation.setDeviceMetricsOverride", width=390, height=800, deviceScaleFactor=1, mobile=True)
        heights = self.browser.run("Array.from(document.querySelectorAll('#against tr'), e => e.offsetHeight)")
        self.browser.call("Emulation.clearDeviceMetricsOverride")
        self.assertGreater(len(heights), 20)
        self.assertLess(max(heights), 150)
        self.is_quiet()
        self.browser.run("try { localStorage.clear() } catch {}")

    def load(self, name):
        super().load(name)
        until = time.monotonic() + 60
        while self.browser.run("document.documentElement.dataset.ready") != "yes":  # --explore unpacks its data
            self.assertLess(time.monotonic(), until, self.browser.messages)
            time.sleep(0.05)

    def unfold(self):
        self.browser.run("for (const one of document.querySelectorAll('details')) one.open = true")

    def cells(self, table):
        return self.browser.run(f"Array.from(document.querySelectorAll('#{table} tbody tr'), row => "
                                "Array.from(row.children, cell => cell.textContent))")

    def test_figures(self):
        found = compare(self.runs["a"], self.runs["b"], FIGURES)[0]
        self.load("two")
        for name in ("causes", "functions", "lines"):
            rows = self.cells(f"{name}-table")
            self.assertEqual([(row[0], row[5].replace("\u2212", "-")) for row in rows],
                             [(row["name"], part(row["difference"] / found["cycles"]["a"])) for row in found[name]])
        self.assertEqual(self.cells("configuration-table"),
                         [["chip.tms", "1", "2"], ["dcache.bytes", "16,384", "32,768"]])
        self.assertEqual(self.browser.run("document.querySelectorAll('#pictures img').length"), 1)
        self.assertIsNone(self.browser.run("document.getElementById('runs')"))
        self.is_quiet()
        self.load("folders")
        self.assertEqual([row[0] for row in self.cells("runs-table")], ["run", "same"])
        self.browser.run("document.querySelectorAll('#runs-table tbody button')[1].click()")
        self.assertEqual(self.cells("causes-table"), [])
        self.is_quiet()
        self.load("timeless")
        self.assertEqual({row[5] for row in self.cells("causes-table")}, {""})  # no share of 0 cycles


unittest.main()
