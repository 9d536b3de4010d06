#!/usr/bin/env python3
"""The page of a user's sweeps: own_test.py RAYTRACER/EVALUATION"""

import copy
import html
import itertools
import json
import pathlib
import re
import sys
import tempfile
import unittest

import example

FOLDER = pathlib.Path(sys.argv.pop(1)).resolve()
sys.path.insert(0, str(FOLDER))
from report import make, own  # noqa: E402
from report.results import read_results  # noqa: E402


class OwnTest(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.addCleanup(self.scratch.cleanup)

    def make(self, document):
        source = pathlib.Path(self.scratch.name, "results.json")
        source.write_text(json.dumps(document))
        self.assertEqual(make.main([str(source)]), 0)
        self.results = read_results(source)
        return source.with_name("report.html").read_text()

    def figure(self, text, identity):
        return text.partition(f'<figure id="{identity}">')[2].partition("</figure>")[0]

    def headings(self, text):
        return [html.unescape(one) for one in re.findall("<h2>(.*?)</h2>", text)]

    def test_questions_first(self):
        text = self.make(example.own())
        self.assertIn("<h1>What does bandwidth buy?</h1>", text)
        self.assertEqual(self.headings(text)[:3], ["What does bandwidth buy?",
                                                   "Rays for area, power and bandwidth", "Where the time goes"])
        body = text[text.index("<main>"):]
        places = [body.index(one) for one in ("Memory is the limit.", "5 of 6 runs are there, 1 failed.",
                                              "this program renders &lt;no&gt; textures", "<figcaption>", "<table")]
        self.assertEqual(places, sorted(places))
        self.assertIn("million rays per second / area (mm²)", text)

    def test_leaves_out(self):
        text = self.make(example.own())
        for left_out in ("not known", "not measured</", "Nothing was measured", "Table 2", "claims", "No run has"):
            self.assertNotIn(left_out, text[text.index("<main>"):], left_out)
        for run in (made := example.own())["runs"]:
            run.update(status="failed", error="no", stats={}, values={})
        self.assertEqual(self.headings(self.make(made)), ["What does bandwidth buy?", "Runs", "Configurations"])

    def test_fronts(self):
        """Against the definition: no other run has more rays for less. Of equal runs all are on the front."""
        made = example.own()
        made["runs"].append({**made["runs"][0], "key": "twin", "config": "1x31"})
        self.make(made)
        runs = [run for run in self.results.runs if run.done]
        for _, cost, _ in own.COSTS:
            expected = [one for one in runs if not any(
                other.get(cost) <= one.get(cost) and other.get("mrps") >= one.get("mrps") and
                (other.get(cost), other.get("mrps")) != (one.get(cost), one.get("mrps")) for other in runs)]
            self.assertCountEqual([run.key for run in own.front(runs, cost)], [run.key for run in expected], cost)
            self.assertLess(len(expected), len(runs) + (cost == "memory.bandwidth_gbps"))
        rows = own.front_table(runs).rows
        self.assertEqual(len(rows), 6)
        by_cost = {cost: {run.key for run in own.front(runs, cost)} for _, cost, _ in own.COSTS}
        for run, row in zip(runs, rows):
            on = [identity for identity, cost, _ in own.COSTS if run.key in by_cost[cost]]
            self.assertEqual(row[-1].shown, ", ".join(on))

    def test_other_rays_have_a_front_of_their_own(self):
        """Two samples a pixel are not a faster chip. Options of the tree are designs of the same picture."""
        made = example.own()
        changes = {"trax-render --samples": 2}, {"trax-scene --leaf": 1, "fpu.compare_units": True}
        for run, more in zip(made["runs"], changes):
            run["set"] |= more
        self.assertIn("fpu.compare_units=true", self.make(made))
        runs = [run for run in self.results.runs if run.done]
        self.assertEqual([(key[2:-1], len(some)) for key, some in own.groups(runs).items()],
                         [(("trax-render --samples=2", ), 1), ((), 4)])
        for count in (own.MOST_FRONTS, own.MOST_FRONTS + 1):
            made["runs"] = [{**run, "key": f"{seed}-{run['key']}", "set": {**run["set"], "trax-render --seed": seed}}
                            for seed in range(count) for run in example.own()["runs"][:2]]
            self.assertEqual('id="front-area"' in self.make(made), count == own.MOST_FRONTS)

    def test_moments(self):
        """A sequence: a picture of each moment, of many some; and bars tell moments from each other."""
        frames = [frame / 2 for frame in range(20)]
        runs = []
        for frame, more in itertools.product(frames, ({}, {"trax-scene --refit-from": 0})):
            runs.append(example.run("ours", "bunny", "4x32", experiments=("twist", ), value=1))
            runs[-1].update(set={"trax-scene --at": frame, **more}, size=[32, 18],
                            variant="refitted from the first one" if more else "rebuilt")
        text = self.make(example.document(runs, [{"name": "twist", "x": "trax-scene --at", "file": "mine.json"}]))
        self.assertEqual(re.findall("<figcaption>bunny at (.*?), ours", text),
                         ["0", "1", "2.5", "4", "5", "6.5", "8", "9.5"])
        names = own.short([own.name_of(run, []) for run in self.results.runs])
        self.assertEqual(names[:2], ["rebuilt, at=0.0", "refitted from t…, at=0.0"])
        self.assertEqual(own.short(["1x32, memory.queue_entries=4"]), ["1x32, queue_entries=4"])
        for values in ((50, 200), (8.5, 16.25)):
            names = [f"{chip}, memory.latency_cycles={value}" for chip in ("1x32", "4x32") for value in values]
            found = own.short(names)
            self.assertEqual(len(set(found)), 4, found)
            self.assertTrue(all(name[:4] == one[:4] and len(one) <= 24 for name, one in zip(names, found)), found)
            self.assertTrue(all(name[-3:] == one[-3:] for name, one in zip(names, found)), found)
        self.assertEqual(make.some_of({None: 0, 3: 0, -1: 0}), [None, -1, 3])

    def test_estimates_beside_exact_runs(self):
        """Figures have one mark for each design, whose exact run is in place of its estimate; tables have both."""
        made = example.own()
        names = "sweep-0", "time-0", "front-area"
        known = [self.figure(self.make(made), name) for name in names]
        for record in made["runs"][:2] + made["runs"][3:4]:
            estimate = copy.deepcopy(record)
            estimate.update(key=record["key"] + "-quick", mode="quick")
            estimate["stats"]["mrps"] *= 1.5
            estimate["values"].update(mrps_low=1.0, mrps_high=99.0)
            made["runs"].append(estimate)
        text = self.make(made)
        self.assertEqual([self.figure(text, name) for name in names], known)
        self.assertEqual(text.count(">quick<"), 2 * 3)  # in the sweep's table and in that of runs

    def test_many_series(self):
        """Each has a colour and mark of its own."""
        runs = [example.run("ours", "forest", chip, {"memory.queue_depth": places}, experiments=("queues", ))
                for places in range(1, 10) for chip in ("1x32", "4x32")]
        text = self.make(example.document(runs, [{"name": "queues", "x": "threads", "file": "mine.json"}]))
        key = self.figure(text, "sweep-0").partition('<ul class="key">')[2]
        self.assertEqual(len(set(re.findall('href="(#mark-.*?)".*? class="(s[0-9]+)"', key))), 9, key)

    def test_columns_of_runs(self):
        """The table of runs has no column without data, and keeps the one with links alone."""
        heads = re.findall('<th.*?>(?:<button.*?>)?(.*?)<', self.make(example.own()).partition('id="runs"')[2])
        self.assertEqual([one in heads for one in ("run", "MRPS", "files", "configuration", "against the paper")],
                         [True, True, True, True, False], heads)
        self.assertIn("against the paper", self.make(example.complete()).partition('id="runs"')[2])

    def test_sweeps_of_trax(self):
        """The page is about the paper if a sweep comes with trax."""
        made = example.own()
        made["sweeps"].append({"name": "bandwidth", "x": "memory.bandwidth_gbps"})
        self.assertIn(make.PAPERS_TITLE.replace("'", "&#x27;"), self.make(made))
        self.assertEqual(self.headings(self.make(example.complete()))[:2], ["Summary", "The paper's tables"])


if __name__ == "__main__":
    unittest.main()
