#!/usr/bin/env python3
"""trax-eval space: which runs are made exactly, with runs that are made up: space_test.py RAYTRACER/EVALUATION"""

import contextlib
import io
import json
import pathlib
import random
import sys
import tempfile
import types
import unittest

FOLDER = pathlib.Path(sys.argv.pop(1)).resolve()
sys.path.insert(0, str(FOLDER))
from command import space  # noqa: E402
from report import own  # noqa: E402
from report.results import Results  # noqa: E402
from trax_eval.util import Problem  # noqa: E402

CHIPS = ["1x32", "2x32", "4x32", "8x32"]
SWEEP = {"name": "mine", "scenes": ["forest"], "programs": "ours", "chips": CHIPS, "size": "320x180",
         "set": {"icache.bytes": [4096, 8192], "memory.bandwidth_gbps": [2, 4, 8]}}
OPTIONS = {"all": False, "mode": None, "prepare": False, "programs": None, "chip": None, "scene": None,
           "variant": None, "size": None, "dry_run": False}


class Made:
    """Runs whose true rates, intervals and areas are random; each interval has the true rate."""
    def __init__(self, seed):
        self.random, self.asked, self.designs = random.Random(seed), [], {}

    def design(self, point):
        name = point.chip, point.settings
        if name not in self.designs:
            true = self.random.uniform(1, 10)
            self.designs[name] = (true, true * self.random.uniform(0.8, 1), true * self.random.uniform(1, 1.2),
                                  float(self.random.randint(1, 12)))
        return self.designs[name]

    def runs_of(self, sweep):
        self.asked.append(sweep.points)
        keys, runs = {}, []
        for number, point in enumerate(sweep.points):
            keys[point] = f"{point.mode}-{number}", None
            true, low, high, area = self.design(point)
            values = {"area_units": area} | ({"mrps_low": low, "mrps_high": high} if point.mode == "quick" else {})
            runs.append({
                "key": keys[point][0], "scene": point.scene, "program": point.program.name, "config": point.chip,
                "set": dict(point.settings), "size": [320, 180], "mode": point.mode, "status": "done",
                "experiments": ["mine"], "stats": {"mrps": (low + high) / 2 if point.mode == "quick" else true},
                "values": values, "points": []
            })
        document = {"format": "trax-eval-results", "version": 2, "runs": runs, "sweeps": [], "series": [],
                    "programs": [], "scenes": []}
        return 0, document, [(sweep, keys)]


class SpaceTest(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.addCleanup(self.scratch.cleanup)
        self.file = pathlib.Path(self.scratch.name, "mine.json")
        self.file.write_text(json.dumps(SWEEP))

    def explore(self, made, **changes):
        out = io.StringIO()
        with contextlib.redirect_stdout(out):
            status = space.explore(types.SimpleNamespace(**OPTIONS | changes), [self.file], made.runs_of)
        return status, out.getvalue()

    def test_front(self):
        fewest = 24
        for seed in range(200):
            made = Made(seed)
            status, text = self.explore(made)
            self.assertEqual((status, len(made.asked)), (0, 2))
            quick, exact = made.asked
            self.assertEqual([{point.mode for point in quick}, {point.mode for point in exact} - {"exact"}],
                             [{"quick"}, set()])
            self.assertEqual([len(quick), {point.size for point in quick}], [24, {"320x180"}])
            self.assertEqual(text, f"{len(exact)} of 24 runs may be on the front, and are made exactly\n")
            chosen = {(point.chip, point.settings) for point in exact}
            for name, (true, low, high, area) in made.designs.items():
                others = [other for key, other in made.designs.items() if key != name]
                on_front = not any(other[3] <= area and other[0] >= true for other in others)
                certainly_not = any(other[3] <= area and other[1] >= high for other in others)
                self.assertLessEqual(on_front, name in chosen, (seed, name))
                self.assertNotEqual(certainly_not, name in chosen, (seed, name))
            fewest = min(fewest, len(exact))
        self.assertLess(fewest, 8)

    def test_equal_runs(self):
        """Runs of one rate and area are both on the front."""
        made = Made(0)
        made.designs = {(chip, (("icache.bytes", size), ("memory.bandwidth_gbps", rate))): (2.0, 2.0, 2.0, 3.0)
                        for chip in CHIPS for size in (4096, 8192) for rate in (2, 4, 8)}
        self.explore(made)
        self.assertEqual(len(made.asked[1]), 24)

    def test_unknown_area(self):
        """Runs without an area are named; they neither are on the front nor keep others from it."""
        made = Made(2)
        made.designs = {(chip, (("icache.bytes", size), ("memory.bandwidth_gbps", rate))):
                        (9.0, 9.0, 9.0, None) if rate == 8 else (2.0, 2.0, 2.0, 3.0)
                        for chip in CHIPS for size in (4096, 8192) for rate in (2, 4, 8)}
        _, text = self.explore(made)
        self.assertEqual(text, "8 of 24 runs are on no front: no area is known of their caches\n"
                         "16 of 24 runs may be on the front, and are made exactly\n")
        made.designs = dict.fromkeys(made.designs, (9.0, 9.0, 9.0, None))
        self.assertEqual(self.explore(made)[1], "24 of 24 runs are on no front: no area is known of their caches\n")
        self.assertEqual(len(made.asked), 3)

    def test_report_takes_the_exact_run(self):
        made = Made(1)
        self.explore(made)
        value = made.runs_of(types.SimpleNamespace(points=[*made.asked[0], *made.asked[1]]))[1]
        some, = own.groups(Results(value).runs).values()
        self.assertEqual(len(some), 24)
        self.assertEqual(sum(run.mode == "exact" for run in some), len(made.asked[1]))

    def test_no_run(self):
        """If no estimate could be made, nothing is made exactly."""
        asked = []

        def runs_of(sweep):
            asked.append(sweep)
            document = {"format": "trax-eval-results", "version": 2, "runs": []}
            return 1, document, [(sweep, {point: (None, "no scene") for point in sweep.points})]

        self.assertEqual(self.explore(types.SimpleNamespace(runs_of=runs_of)), (1, ""))
        self.assertEqual(len(asked), 1)

    def test_refused(self):
        for name, value in (("all", True), ("mode", "quick"), ("prepare", True)):
            with self.assertRaisesRegex(Problem, f"--{name}"):
                self.explore(Made(0), **{name: value})
        for name, value in (("scene", "forests"), ("variant", "none")):
            with self.assertRaisesRegex(Problem, f"--{name} {value}: the sweep has"):
                self.explore(Made(0), **{name: [value]})
        made = Made(0)
        self.assertEqual(self.explore(made, dry_run=True), (0, ""))
        self.assertEqual(len(made.asked), 1)


if __name__ == "__main__":
    unittest.main()
