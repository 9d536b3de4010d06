#!/usr/bin/env python3
"""The report's page as text: page_test.py REPORT_FOLDER TRAX_EVAL, the folder that holds the package `report` and
`paper`, and the command.

What it shows against the results it was made of; missing, wrong and hostile results; that it asks for nothing from
elsewhere."""

import contextlib
import copy
import csv
import html.parser
import importlib
import io
import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import example

FOLDER, COMMAND = (pathlib.Path(sys.argv.pop(1)).resolve() for _ in range(2))
sys.path.insert(0, str(FOLDER))
make = importlib.import_module("report.make")
VOID = {"meta", "img", "br", "hr", "col", "input", "link"}


class Page(html.parser.HTMLParser):
    """Tables as lists of rows of (text, sort value), figures' marks; every element must be closed in its place."""
    def __init__(self, text):
        super().__init__(convert_charrefs=True)
        self.open, self.tables, self.figures, self.attributes, self.identities, self.scripts = [], {}, {}, [], [], 0
        self.table = self.row = self.figure = self.text = None
        self.feed(text)
        self.close()
        assert not self.open, f"never closed: {self.open}"

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.attributes += [(tag, key, value) for key, value in attributes.items()]
        if "id" in attributes:
            self.identities.append(attributes["id"])
        self.scripts += tag == "script"
        if tag not in VOID:
            self.open.append(tag)
        if tag == "table":
            self.table = self.tables[attributes["id"]] = {"head": [], "rows": []}
        elif tag == "tr" and self.table is not None:
            self.row = []
        elif tag in ("td", "th") and self.row is not None:
            self.text = []
            self.value = attributes.get("data-value")
        elif tag == "figure":
            self.figure = self.figures.setdefault(attributes.get("id", f"picture {len(self.figures)}"), [])
        elif tag in ("circle", "polygon") and self.figure is not None:
            self.mark = attributes
        elif tag == "title":
            self.text = []

    def handle_endtag(self, tag):
        assert self.open and self.open[-1] == tag, f"</{tag}> closes {self.open[-3:]}"
        self.open.pop()
        if tag in ("td", "th") and self.row is not None:
            self.row.append(("".join(self.text).strip(), self.value))
            self.text = None
        elif tag == "tr" and self.row is not None:
            self.table["rows" if "thead" not in self.open else "head"].append(self.row)
            self.row = None
        elif tag == "table":
            self.table = None
        elif tag == "title" and self.figure is not None:
            self.figure.append((self.mark, "".join(self.text)))
            self.text = None
        elif tag == "figure":
            self.figure = None

    def handle_data(self, data):
        if self.text is not None:
            self.text.append(data)


class ReportTest(unittest.TestCase):
    whole = None

    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.addCleanup(self.scratch.cleanup)
        self.folder = pathlib.Path(self.scratch.name)
        (self.folder / "pictures").mkdir()
        for scene in example.SCENES[:3]:
            (self.folder / "pictures" / f"{scene}.png").write_bytes(example.picture())

    def command(self, *arguments):
        """Makes the page in this process: a start of the interpreter takes longer than a page."""
        out, errors = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(errors):
            status = make.main([str(argument) for argument in arguments])
        return subprocess.CompletedProcess(arguments, status, out.getvalue(), errors.getvalue())

    def make(self, document, name="results", *options):
        source, output = self.folder / f"{name}.json", self.folder / f"{name}.html"
        source.write_text(document if isinstance(document, str) else json.dumps(document))
        done = self.command(source, "-o", output, *options)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.text = output.read_text()
        return Page(self.text)

    def complete(self):
        """The page of example.complete(), which is made and read once."""
        if self.whole is None:
            ReportTest.whole = self.make(example.complete()), self.text
        page, self.text = self.whole
        return page

    def refused(self, text, message, *options):
        source, output = self.folder / "bad.json", self.folder / "bad.html"
        source.write_text(text)
        done = self.command(source, "-o", output, *options)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertRegex(done.stderr, "^trax-eval report: error: .*" + message)
        self.assertEqual(done.stderr.count("\n"), 1)
        self.assertFalse(output.exists())
        self.assertEqual([path.name for path in self.folder.iterdir() if path.name.endswith(".part")], [])

    def test_table2(self):
        page = self.complete()
        with open(FOLDER / "paper" / "table2.csv", newline="") as file:
            published = {row["name"]: row for row in csv.DictReader(file)}
        for program in ("era", "ours"):
            rows = page.tables[f"table2-{program}"]["rows"]
            self.assertEqual([row[0][0] for row in rows], example.CHIPS)
            for row in rows:
                chip, ours = row[0][0], []
                for place, (column, scene) in enumerate(zip(("conference", "crytek", "dragon", "fairy"),
                                                            example.SCENES)):
                    wanted, value = float(published[chip][column + "_mrps"]), example.mrps(program, scene, chip)
                    ours.append(value)
                    self.assertEqual(row[2 + 2 * place], (published[chip][column + "_mrps"], repr(wanted)))
                    self.assertEqual(float(row[3 + 2 * place][1]), value)
                    shown = re.fullmatch(r"([\d.]+)([+−]?[\d,]+)\xa0%", row[3 + 2 * place][0])
                    self.assertAlmostEqual(float(shown[1]), value, delta=0.006 * value)
                    self.assertEqual(int(shown[2].replace("−", "-")), round(100 * (value / wanted - 1)))
                self.assertAlmostEqual(float(row[11][1]), sum(ours) / 4)
        self.assertEqual(self.text.count("chips are the paper&#x27;s, with fpu.compare_units = true."),
                         2)  # era's, in the summary and with its table

    def test_tables_1_and_3(self):
        page = self.complete()
        rows = {row[0][0]: row for row in page.tables["table1"]["rows"]}
        place = {cell[0]: index for index, cell in enumerate(page.tables["table1"]["head"][0])}
        self.assertEqual(len(rows), 20)
        self.assertEqual(float(rows["8x64"][3][1]), 0.06 * 512)
        self.assertEqual(rows["NVIDIA Tegra 2"][2][0], "6")
        self.assertAlmostEqual(float(rows["4x32"][place["RT GFLOPS, ours"]][1]),
                               1.3 * sum(example.mrps("ours", scene, "4x32") for scene in example.SCENES) / 4)
        rows = page.tables["table3"]["rows"]
        place = {cell[0]: index for index, cell in enumerate(page.tables["table3"]["head"][0])}
        self.assertEqual([(row[0][0], row[1][0]) for row in rows],
                         [(chip, scene) for chip in ("8x32", "8x48", "8x64") for scene in ("dragon", "average")])
        self.assertEqual([rows[0][place[f"{name}, paper"]][0] for name in ("8 GB/s", "16 GB/s", "gain")],
                         ["5.75", "10.17", "1.77"])
        self.assertEqual([float(rows[0][place[f"{gbs} GB/s, ours"]][1]) for gbs in (8, 16)], [0.72 * 8, 0.72 * 16])
        self.assertEqual(float(rows[0][place["gain, ours"]][1]), 2)

    def test_figures(self):
        """Marks stand where their values are: the centre is linear in what the title says."""
        page = self.complete()
        marks = page.figures["scaling-conference"]
        self.assertEqual(len(marks), 3 * 15 + 2)  # paper, era, ours, and the line in proportion
        seen = []
        for attributes, title in marks:
            found = re.fullmatch(r"(\w+), (\d)x(\d+): ([\d.]+) times, .*", title)
            if found:
                chip = f"{found[2]}x{found[3]}"
                if found[1] != "paper":
                    rates = [example.mrps(found[1], "conference", one) for one in (chip, "1x32")]
                    self.assertAlmostEqual(float(found[4]), rates[0] / rates[1], delta=0.006)
                seen.append((example.threads(chip), float(found[4]), float(attributes["cx"]), float(attributes["cy"])))
        self.assertEqual(len(seen), 45)
        low, high = min(seen), max(seen)
        for count, speedup, x, y in seen:
            self.assertAlmostEqual(x, low[2] + (count - low[0]) * (high[2] - low[2]) / (high[0] - low[0]), delta=0.6)
            self.assertAlmostEqual(y, low[3] + (speedup - low[1]) * (high[3] - low[3]) / (high[1] - low[1]), delta=0.6)
        bars = page.figures["stalls-ours-dragon"]
        self.assertEqual(len(bars), 15 * 9)  # chips and groups of causes
        spans = {}
        for attributes, title in bars:
            corners = [float(pair.split(",")[0]) for pair in attributes["points"].split()]
            spans.setdefault(title.split(":")[0], []).append(
                (min(corners), max(corners), float(re.search(r"([\d.]+) %", title)[1])))
        self.assertEqual(sorted(spans), sorted(example.CHIPS))
        for parts in spans.values():
            whole = parts[-1][1] - parts[0][0]
            self.assertAlmostEqual(sum(share for *_, share in parts), 100, delta=0.5)
            for left, right, share in parts:
                self.assertAlmostEqual(100 * (right - left) / whole, share, delta=0.6)
            for (_, right, _), (left, _, _) in zip(parts, parts[1:]):
                self.assertAlmostEqual(left, right, delta=0.2)
        sweep = page.figures["sweep-2"]
        self.assertEqual(len(sweep), 10)
        over_time = [title
                     for _, title in page.figures["series-0"]]  # of 100 intervals those of a 40th of a decade are one
        self.assertEqual(len(over_time), 2 * len({math.floor(40 * math.log10(10_000 * n)) for n in range(1, 101)}))
        self.assertEqual([title for title in over_time if "issued" in title][-2:],
                         ["to cycle 990,000: issued 49.2 %", "to cycle 1,000,000: issued 49.8 %"])
        for identity in ("memory-era", "memory-ours", "error-time", "sweep-3"):
            self.assertTrue(page.figures[identity], identity)
        self.assertEqual(len(page.figures["memory-ours"]), 60)
        self.assertEqual(len(page.figures["error-time"]), 125)

    def test_claims(self):
        verdicts = {
            row[0][0]: [cell[1] for cell in row[2:4]] for row in self.complete().tables["claims"]["rows"]
        }
        self.assertEqual(verdicts["The dragon stops scaling at 128 threads at 8 GB/s"], ["'differs'", "'agrees'"])
        self.assertEqual(verdicts["The dragon gains from 16 GB/s"], ["'differs'", "'agrees'"])
        self.assertEqual(verdicts["Table 2: rays per second"], ["'differs'", "'differs'"])
        self.assertEqual(verdicts["Power of 4x32"], ["'differs'", "'differs'"])
        self.assertEqual(verdicts["Adds and multiplications a ray"], ["'agrees'", "'agrees'"])
        self.assertEqual([verdicts[name] for name in verdicts if name.startswith("Threads stagger")],
                         [["'agrees'", "'unknown'"]])
        for name in ("A TM's operations per cycle", "Eight TPs share an FPU",
                     "One FPDIV/iSQRT unit serves up to 64 TPs", "Lanes in use on a SIMD machine",
                     "FPDIV/iSQRT are rarely used"):
            self.assertEqual(verdicts[name], ["'unknown'", "'unknown'"], name)

    def test_assertions(self):
        """The page has what the paper asserts about its choices, from the sweeps, and reasons beside what differs."""
        made = example.complete()
        made["runs"] = [
            record for record in made["runs"]
            if record["set"].keys() <= {"memory.bandwidth_gbps"} and record["key"] != "small"
        ] + example.assertions()
        rare = {"era": 5, "ours": 1}
        for record in made["runs"]:
            record["stats"].update(instructions=1000, instructions_by_unit={"special": 10 * rare[record["program"]]})
            fpu = record["stats"]["configuration"]["fpu"]
            fpu.update(adders_per_cluster=1 if record["program"] == "ours" else 2, multipliers_per_cluster=1)
            record["stats"]["configuration"].setdefault("special", {"units_per_tm": 1, "pipelined": True})
        page = self.make(made)
        rows = {row[0][0]: row for row in page.tables["claims"]["rows"]}
        for name in ("A TM's operations per cycle", "Eight TPs share an FPU", "FPDIV/iSQRT are rarely used",
                     "One FPDIV/iSQRT unit serves up to 64 TPs", "16 banks for the instructions of 16 TPs",
                     "A bank of the data cache for each 8 TPs"):
            self.assertEqual([cell[1] for cell in rows[name][2:4]], ["'differs'", "'agrees'"], rows[name])
        self.assertEqual([cell[1] for cell in rows["A larger data cache takes pressure off the memory"][2:4]],
                         ["'agrees'", "'differs'"])
        self.assertIn("13, 19, 25", rows["A TM's operations per cycle"][2][0])
        self.assertIn("99.0 % of the rays of an FPU for each TP", rows["Eight TPs share an FPU"][3][0])
        self.assertIn("80.0 % of the rays of two units", rows["One FPDIV/iSQRT unit serves up to 64 TPs"][2][0])
        # A cell is short; the reasons stand below the table.
        self.assertRegex(rows["Speed-up from 1x32"][2][0], r"\d+ of 42 speed-ups within 10 %$")
        notes = dict(re.findall(r"<li><b>([^<]*)</b>: ([^<]*)</li>", self.text))
        self.assertRegex(
            notes["Speed-up from 1x32"],
            r"^era: conference \d+ of 14, crytek-sponza \d+ of 14, forest \d+ of 14; furthest off: [^.]*, "
            r"of rays [+-]\d+ % on 1x32 and [+-]\d+ % there: a ray moves 700 bytes")
        self.assertIn("dragon-close: 1.00 times on", notes["The dragon stops scaling at 128 threads at 8 GB/s"])
        self.assertIn("dragon-close: 1.75 times", notes["The dragon gains from 16 GB/s"])
        self.assertEqual([cell[0] for row in rows.values() for cell in row if len(cell[0].split()) > 25], [])
        self.assertEqual([cell[0] for row in rows.values() for cell in row[2:4] if len(cell[0].split()) > 15], [])
        self.assertIn("5 of 15 chips within 10 %", rows["Table 1: area of the chips"][3][0])
        machine = {row[2][0]: (row[3][0], row[4][1]) for row in page.tables["described"]["rows"]}
        self.assertEqual(machine["chip.clock_mhz"], ("500", "'agrees'"))
        self.assertEqual(machine["fpu.adders_per_cluster"], ("1, 2", "'differs'"))
        self.assertEqual(machine["icache.tps_per_cache"], ("–", "'unknown'"))
        other = example.complete()
        for record in other["runs"]:
            if record["scene"] == "dragon" and record["config"] == "8x64":
                record["stats"]["mrps"] *= 1.2
            if record["set"].get("memory.bandwidth_gbps") == 16.0 and record["config"] == "8x32":
                record["stats"]["mrps"] *= 0.7
        for row in other["series"][0]["rows"]:
            row[1] = 0.1 + row[0] / 1e7
        verdicts = {row[0][0]: [cell[1] for cell in row[2:4]] for row in self.make(other).tables["claims"]["rows"]}
        self.assertEqual(verdicts["The dragon stops scaling at 128 threads at 8 GB/s"], ["'differs'", "'differs'"])
        self.assertEqual(verdicts["The dragon gains from 16 GB/s"], ["'differs'", "'differs'"])
        self.assertEqual([verdicts[name] for name in verdicts if name.startswith("Threads stagger")],
                         [["'differs'", "'unknown'"]])

    def test_sampled(self):
        page = self.complete()
        rows = page.tables["sampled"]["rows"]
        self.assertEqual({row[2][0]: row[9][0] for row in rows},
                         {"conference": "yes", "crytek-sponza": "yes", "dragon": "no", "forest": "no"})
        self.assertIn("in 2 of 4 cases", self.text)
        # An exact run goes before a sampled one.
        cell = next(row for row in page.tables["table2-ours"]["rows"] if row[0][0] == "4x32")[3]
        self.assertEqual(float(cell[1]), example.mrps("ours", "conference", "4x32"))

    def test_some_scenes(self):
        """A claim that is a mean of the scenes stays open where some are missing, and says of how many it has a
        figure."""
        made = example.complete()
        made["runs"] = [
            record for record in made["runs"] + example.assertions() if record["scene"] in (
                "forest", "dragon") and not (record["scene"] == "dragon" and "fpu-sharing" in record["experiments"])
        ]
        rows = {row[0][0]: row for row in self.make(made).tables["claims"]["rows"]}
        self.assertRegex(rows["Eight TPs share an FPU"][3][0],
                         r"^\? not knownmeasured on 1 of 4 scenes: 99\.0 % of the rays")
        self.assertRegex(rows["One FPDIV/iSQRT unit serves up to 64 TPs"][3][0],
                         r"^\? not knownmeasured on 2 of 4 scenes: 99\.0 % of the rays")
        self.assertRegex(rows["Adds and multiplications a ray"][2][0],
                         r"^\? not knownmeasured on 2 of 4 scenes: 1,300$")
        self.assertRegex(rows["Table 1: area of the chips"][2][0],
                         r"^✗ differs5 of 15 chips")  # a chip has one, whatever the scene

    def test_one_cell(self):
        """Sentences hold for one cell, and say nothing of what is not there."""
        made = example.complete()
        made["runs"] = [{**record, "size": [64, 36]} for record in made["runs"]
                        if (record["program"], record["scene"], record["config"], record["mode"]) == ("ours", "forest",
                                                                                                      "4x32", "quick")]
        self.make(made)
        self.assertIn("Against the one measured cell of Table 2 it has", self.text)
        self.assertIn("Verdicts on small pictures are therefore weak.", self.text)
        self.assertNotIn(" 0 of 0 ", self.text)
        self.assertEqual(re.search(r"\b1 (cells|chips|figures|runs are)\b", self.text), None)

    def test_intervals(self):
        """An interval is divided as its figure is; a run with nothing left to estimate is exact."""
        made = example.complete()
        made["runs"] = [record for record in made["runs"] if "fpu-density" in record["experiments"]]
        for record in made["runs"]:
            record["mode"] = "quick"
            record["values"] = {
                f"mrps_{end}": factor * record["stats"]["mrps"] for end, factor in (("low", 0.98), ("high", 1.03))
            }
        for exact in (False, True):
            for record in made["runs"] if exact else ():
                record["values"] = {"mrps_low": record["stats"]["mrps"], "mrps_high": record["stats"]["mrps"]}
            page = self.make(made)
            for name, per in (("sweep-2-fpu-sharing", 1), ("sweep-3-fpu-density", 0.06 * 128)):
                for row in page.tables[name]["rows"]:
                    shown, value = row[1]
                    if exact:
                        self.assertTrue(shown.endswith("exact"), shown)
                        continue
                    low, high = map(float, re.search(r"\[([\d.]+), ([\d.]+)\]$", shown).groups())
                    self.assertAlmostEqual(low, 0.98 * float(value), delta=0.006 * low, msg=name)
                    self.assertAlmostEqual(high, 1.03 * float(value), delta=0.006 * high, msg=name)
                    self.assertGreater(float(value) * per, 1)
            self.assertEqual({row[6][0] for row in page.tables["sampled"]["rows"]} == {"exact"}, exact)
        for record in made["runs"]:  # ends that differ little are told apart
            record["values"]["mrps_high"] *= 1.001
        ends = [
            re.search(r"\[([\d.]+), ([\d.]+)\]$", row[1][0]).groups()
            for row in self.make(made).tables["sweep-2-fpu-sharing"]["rows"]
        ]
        self.assertEqual([pair for pair in ends if pair[0] == pair[1]], [])

    def test_one_look_of_a_program(self):
        """A program has one colour and one mark on the page, a scene one colour, and no scene that of a program."""
        made = example.complete()
        made["runs"] = [record for record in made["runs"] if record["scene"] != "crytek-sponza"]
        both = [
            record for record in copy.deepcopy(made["runs"])
            if "fpu-sharing" in record["experiments"] and record["scene"] == "dragon"
        ]
        for record in both:
            record.update(program="era", key="era-" + record["key"])
        made["runs"] = [
            record for record in made["runs"]
            if "fpu-sharing" not in record["experiments"] or record["scene"] == "dragon"
        ]
        made["runs"] = both + made["runs"]  # this sweep's first series is the first program's
        self.make(made)
        looks = {}
        for figure in re.findall(r"<figure id=.*?</figure>", self.text, re.DOTALL):
            key = r'<li><svg[^>]*><use href="#mark-(\w+)"[^>]*class="s(\d+)"[^>]*></use></svg>([^<]*)</li>'
            for mark, style, label in re.findall(key, figure):
                looks.setdefault(label, set()).add((style, mark))
        self.assertEqual({name: len(looks[name]) for name in ("era", "ours")}, {"era": 1, "ours": 1}, looks)
        self.assertEqual(
            len({style for name in ("era", "ours", "conference", "dragon", "forest") for style, _ in looks[name]}), 5,
            looks)

    def test_self_contained(self):
        page = self.complete()
        for tag, key, value in page.attributes:
            if key in ("src", "href", "xlink:href", "action", "data", "srcset", "poster"):
                if tag == "a" and not value.startswith("#"):
                    self.assertRegex(value, r"^(runs|pictures)/")
                else:
                    self.assertRegex(value, r"^(#|data:image/png;base64,)", (tag, key))
        self.assertNotRegex(self.text, r"url\(|@import|https?://(?!www\.w3\.org)")
        self.assertEqual(page.scripts, 1)
        self.assertEqual(len(page.identities), len(set(page.identities)))
        for tag, key, value in page.attributes:
            if key == "href" and value.startswith("#"):
                self.assertIn(value[1:], page.identities)
        self.assertEqual(sum(tag == "img" for tag, key, _ in page.attributes if key == "src"), 6)
        self.assertIn("forest.png: No such file", self.text)

    def test_rays(self):
        """Kinds of rays of a program, scene and chip that the report does not know."""
        page = self.make(example.stranger())
        self.assertEqual(len(page.figures["rays-stalls"]), 2 * 5)
        self.assertEqual([row[:2] for row in page.tables["sweep-0-by-kind-tiny"]["rows"]],
                         [[("primary", "'primary'"), ("12.5", "12.5")], [("shadow", "'shadow'"), ("25.0", "25.0")]])
        self.assertIn("<b>beam: Beams of a stranger</b>", self.text)
        self.assertEqual(len(page.identities), len(set(page.identities)))

    def judged_warps(self, rates, **more):
        """The verdicts of `ours` and their findings, by claim, and the page's tables."""
        made = example.complete()
        made["runs"] += example.warps(rates, **more)
        made["programs"].append({"name": "straight"})
        made["sweeps"].append({"name": "simd"})
        made["workloads"] = [{"name": name} for name in rates]
        page = self.make(made)
        programs = [cell[0] for cell in page.tables["claims"]["head"][0]]
        return {row[0][0]: row[programs.index("ours")] for row in page.tables["claims"]["rows"]}, page.tables

    def test_simd(self):
        """MIMD against SIMD: the best program of each machine counts, and each workload of secondary rays decides."""
        rates = {"primary-shadow": {8: 1.5, 32: 1.2}, "paths": {4: 1.3, 8: 0.8, 32: 0.25}}
        pure, lanes = "Pure SIMD is not the most efficient architecture", "Lanes in use on a SIMD machine"
        claims, tables = self.judged_warps(rates)
        self.assertEqual((claims[pure][1], claims[lanes][1]), ("'agrees'", "'agrees'"))
        self.assertIn("0.25 to 0.80 times", claims[pure][0])
        self.assertIn("70 % of the lanes of warps of 32", claims[lanes][0])
        rows = {(row[0][0], row[1][0]): [cell[0] for cell in row] for row in tables["simd-best"]["rows"]}
        self.assertEqual(rows["paths", "SIMD 8, own units"][2:6], ["ours", "4.80", "3.00", "1.60"])
        self.assertIn("0.80", rows["paths", "SIMD 8, own units"][9])
        self.assertEqual(rows["paths", "MIMD"][5], "2.00")
        claims, _ = self.judged_warps({**rates, "glass": {16: 1.1}}, efficiency=0.5)
        self.assertEqual((claims[pure][1], claims[lanes][1]), ("'differs'", "'differs'"))

    def test_rays_of_two_programs(self):
        made = example.stranger()
        others = copy.deepcopy(made["runs"])
        for place, record in enumerate(others):
            record.update(program="lamp", key=f"lamp-{place}")
        made["runs"] += others
        page = self.make(made)
        self.assertEqual(sorted({(row[1][0], row[2][0]) for row in page.tables["rays-table"]["rows"]}),
                         [("primary", "beam"), ("primary", "lamp"), ("shadow", "beam"), ("shadow", "lamp")])
        self.assertEqual(len(page.figures["rays-stalls"]), 4 * 5)
        self.assertIn(">shadow (fog, lamp)<", self.text)

    def test_same_bytes(self):
        self.make(example.complete())
        first = self.text
        self.make(example.complete())
        self.assertEqual(self.text, first)

    def test_command(self):
        """trax-eval makes the same page, by default beside the results."""
        self.make(example.complete())
        (self.folder / "report.html").unlink(missing_ok=True)
        done = subprocess.run([COMMAND, "report", self.folder / "results.json"], capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual((self.folder / "report.html").read_text(), self.text)
        done = subprocess.run([COMMAND, "report", self.folder / "none.json"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 1)

    def test_links_follow_the_page(self):
        source = self.folder / "results.json"
        source.write_text(json.dumps(example.complete()))
        (self.folder / "elsewhere").mkdir()
        self.assertEqual(self.command(source, "-o", self.folder / "elsewhere" / "page.html").returncode, 0)
        self.assertIn('href="../runs/era-conference-1x32-exact-0.json"',
                      (self.folder / "elsewhere" / "page.html").read_text())

    def test_partial(self):
        page = self.make(example.partial())
        rows = {row[0][0]: row for row in page.tables["table2-ours"]["rows"]}
        self.assertEqual(float(rows["1x32"][3][1]), example.mrps("ours", "conference", "1x32"))
        for chip, text in (("1x48", "failed"), ("2x32", "–"), ("2x48", "–"), ("4x32", "–"), ("8x64", "–")):
            self.assertEqual(rows[chip][3], (text, None), chip)
        for row in rows.values():  # one scene is no average of four
            self.assertEqual(row[11], ("–", None))
            self.assertEqual(row[5], ("–", None))
        for table in page.tables.values():  # what is missing is nowhere a zero
            for row in table["rows"]:
                for text, value in row:
                    self.assertNotIn(text, ("0", "0%", "0 %", "nan", "None", "inf"))
                    self.assertNotIn(value, ("0", "0.0", "nan", "None", "inf"))
        self.assertIn("Nothing was measured.", self.text)
        self.assertIn("5 of 7 runs are there, 1 failed.", self.text)
        verdicts = {row[0][0]: row[2][1] for row in page.tables["claims"]["rows"]}
        self.assertEqual(verdicts["Power of 4x32"], "'unknown'")

    def test_empty(self):
        page = self.make(example.document([]))
        self.assertEqual(page.tables["runs"]["rows"], [])
        page = self.make('{"format": "trax-eval-results", "version": 2}')
        for table in ("claims", "table1", "table3", "hardware", "speedups"):  # these runs have nothing for them
            self.assertNotIn(table, page.tables)
        self.assertNotIn("Nothing was measured.", self.text)

    def test_hostile(self):
        nameless = example.own()
        nameless["runs"][0] |= {"scene": "", "program": ""}
        for made in (example.hostile(), example.hostile_own(), nameless):
            self.check_hostile(self.make(made))

    def check_hostile(self, page):
        self.assertEqual(page.scripts, 1)
        self.assertNotIn("<script>hostile", self.text)
        self.assertNotIn("<img src=x", self.text)
        for tag, key, value in page.attributes:
            self.assertFalse(key.startswith("on"), (tag, key, value))
            if key == "href":
                self.assertNotRegex(value, r"(?i)^\s*javascript:")
        self.assertNotRegex(re.sub(r'(?s)<script>.*?</script>|title="[^"]*"', "", self.text),
                            r"\b(nan|NaN|inf|Infinity|None)\b")

    def test_wrong_files(self):
        good = example.complete()
        self.refused("{", r"bad\.json:1:2: Expecting property name")
        self.refused("[]", r"is not a file of results: \"format\"")
        self.refused('{"format": "trax-eval-results", "version": 3}',
                     r"\"version\" is 3, not 2: another trax-eval wrote it")
        self.refused('{"format": "trax-eval-results", "version": 2, "runs": {}}', "\"runs\" is not a list")
        self.refused('{"format": "trax-eval-results", "version": 2, "runs": [3]}', r"runs\[0\] is not an object")
        self.refused('{"format": "trax-eval-results", "version": 2, "sweeps": ["a"]}', r"sweeps\[0\] is not an object")
        for key, value, message in (("scene", 3, "is int, not a string"), ("stats", [], "is list, not an object"),
                                    ("set", "x", "is str, not an object"), ("experiments", "x", "is not a list")):
            bad = copy.deepcopy(good)
            bad["runs"][1][key] = value
            self.refused(json.dumps(bad), rf"runs\[1\]\.{key} {message}")
        for key, value, message in (("x", [], "is list, not a string"), ("y", 2.5, "is float, not a string"),
                                    ("y_per", {"a": 1}, "is dict, not a string"),
                                    ("variants", [[]], "is not a list of strings"),
                                    ("variants", 3, "is not a list of strings")):
            bad = copy.deepcopy(good)
            bad["sweeps"][0][key] = value
            self.refused(json.dumps(bad), rf"sweeps\[0\]\.{key} {message}")
        self.refused('{"format": "trax-eval-results", "version": 2, "scenes": [{"name": []}]}',
                     r"scenes\[0\]\.name is list, not a string")
        self.refused("[" * 100000, "is nested too deeply")
        self.refused(json.dumps(good), "table1.csv: cannot be read", "--paper", self.folder)
        for name in ("table1", "table2", "table3"):
            (self.folder / f"{name}.csv").write_text((FOLDER / "paper" / f"{name}.csv").read_text())
        (self.folder / "table2.csv").write_text((FOLDER / "paper" / "table2.csv").read_text().replace("9.80", "nine"))
        self.refused(json.dumps(good), r"table2\.csv:7: conference_mrps: \"nine\" is no number", "--paper", self.folder)
        missing = self.command(self.folder / "none.json")
        self.assertEqual(missing.returncode, 1)
        self.assertIn("none.json: No such file", missing.stderr)
        (self.folder / "folder.html").mkdir()  # a page cannot be put in its place: nothing stays behind
        (self.folder / "results.json").write_text(json.dumps(example.document([])))
        unwritable = self.command(self.folder / "results.json", "-o", self.folder / "folder.html")
        self.assertEqual(unwritable.returncode, 1)
        self.assertIn("folder.html: cannot be written", unwritable.stderr)
        self.assertEqual([path.name for path in self.folder.iterdir() if path.name.endswith(".part")], [])
        unwritable = self.command(self.folder / "results.json", "-o", self.folder / "no" / "such" / "page.html")
        self.assertEqual(unwritable.returncode, 1)


if __name__ == "__main__":
    unittest.main()
