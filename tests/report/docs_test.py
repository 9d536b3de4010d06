#!/usr/bin/env python3
"""One reader of results: docs_test.py REPORT_FOLDER. The same tables as text, as HTML and in pages of docs; that
`trax-eval docs --check` notices what is stale; that sweeps of strangers are shown as they say."""

import contextlib
import io
import itertools
import json
import pathlib
import random
import re
import sys
import tempfile
import unittest

import example

FOLDER = pathlib.Path(sys.argv.pop(1)).resolve()
sys.path.insert(0, str(FOLDER))

from report import charts, docs, estimates, markup, plots, tables  # noqa: E402
from report.paper import Paper  # noqa: E402
from report.results import Results  # noqa: E402
from trax_eval.util import Problem  # noqa: E402

PAPER = Paper(FOLDER / "paper")
NAMES = ("table2-era", "fpu-sharing", "plot fpu-sharing", "claims")


def page_of(*names):
    return "Before.\n" + "".join(f"<!-- trax-eval {name}: begin -->\n<!-- trax-eval {name}: end -->\nBetween.\n"
                                 for name in names)


def rows_of(text):
    """The cells of the tables of Markdown in a text."""
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in text.splitlines()
            if line.startswith("|") and not re.fullmatch(r"[|\- ]+", line)]


class DocsTest(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        self.page, self.data = self.folder / "page.md", self.folder / "page.json"

    def results(self, document, name="results"):
        path = self.folder / f"{name}.json"
        path.write_text(json.dumps(document))
        return path

    def docs(self, *arguments):
        """(status, what it said)"""
        errors = io.StringIO()
        with contextlib.redirect_stderr(errors):
            status = docs.main([str(argument) for argument in arguments])
        return status, errors.getvalue()

    def write(self, *names):
        self.page.write_text(page_of(*names))
        self.assertEqual(self.docs(self.results(example.complete()), self.page), (0, ""))

    def test_blocks(self):
        self.write(*NAMES)
        text = self.page.read_text()
        block = docs.MARK.search(text)[2]
        self.assertIn("`trax-eval table2 SCENES` at 1280x720; measured with trax 0.1.0 (2026-01-01):", block)
        rows = {row[0]: row for row in rows_of(block)}
        for chip in example.CHIPS:
            ours = example.mrps("era", "conference", chip)
            self.assertAlmostEqual(float(rows[chip][3].split()[0]), ours, delta=0.001 * ours)
        self.assertEqual(text.count("Between."), len(NAMES))
        svg = (self.folder / "page-fpu-sharing.svg").read_text()
        self.assertIn("![mrps against fpu.tps_per_cluster](page-fpu-sharing.svg)", text)
        self.assertLess(svg.count("\n"), 40)
        self.assertNotIn("<title>", svg)
        self.assertEqual(self.docs("--check", self.page), (0, ""))
        before = {path.name: path.read_bytes() for path in self.folder.iterdir()}
        self.assertEqual(self.docs(self.page), (0, ""))
        self.assertEqual({path.name: path.read_bytes() for path in self.folder.iterdir()}, before)

    def test_stale(self):
        self.write(*NAMES)
        svg = self.folder / "page-fpu-sharing.svg"
        good = {path: path.read_text() for path in (self.page, self.data, svg)}
        sixth = re.search(r"\| 4x32 \|[^\n]*", good[self.page])[0]
        measured = f"{example.mrps('era', 'conference', '4x32'):.6g}"
        changes = [(self.page, sixth, sixth.replace("9.80", "9.81"), "table2-era"),
                   (self.page, "Before.", "After.", None), (self.page, "| 4x32 |", "| 4x33 |", "table2-era"),
                   (self.data, measured, "99.9", "table2-era"), (svg, "<path", "<path id='x'", "page-fpu-sharing.svg"),
                   (self.page, "](page-fpu", "](page-FPU", "plot fpu-sharing")]
        for path, before, after, name in changes:
            path.write_text(good[path].replace(before, after, 1))
            status, said = self.docs("--check", self.page)
            self.assertEqual(status, 0 if name is None else 1, (before, after, said))
            if name:
                self.assertNotEqual(path.read_text(), good[path], before)
                self.assertIn(name, said)
                self.assertEqual({other: other.read_text() for other in good if other != path},
                                 {other: text for other, text in good.items() if other != path})
            path.write_text(good[path])
        svg.write_bytes(b"\xff")
        self.assertEqual(self.docs("--check", self.page)[0], 1)
        svg.unlink()
        self.assertEqual(self.docs("--check", self.page)[0], 1)
        self.page.write_text(good[self.page].replace("| 4x32 |", "| 4x33 |", 1))
        self.assertEqual(self.docs(self.page), (0, ""))
        self.assertEqual({path: path.read_text() for path in good}, good)

    def test_data(self):
        """A page's file has the figures that its blocks need, and takes in others' sweeps."""
        self.write("fpu-sharing")
        text = self.data.read_text()
        self.assertIn("fpu-sharing", text)
        for other in ("table3", "compare-units", "energy", "command", "host"):
            self.assertNotIn(other, text)
        self.write("fpu-sharing", "table2-era")
        first = self.page.read_text()
        other = example.complete()
        other["created"] = "2026-02-02T00:00:00Z"
        other["runs"] = [run for run in other["runs"] if "fpu-sharing" in run["experiments"]]
        for run in other["runs"]:
            run["stats"]["mrps"] = 77.7
        self.assertEqual(self.docs(self.results(other, "other"), self.page), (0, ""))
        blocks = {match[1]: match[2] for match in docs.MARK.finditer(self.page.read_text())}
        self.assertEqual(blocks["table2-era"],
                         {match[1]: match[2] for match in docs.MARK.finditer(first)}["table2-era"])
        self.assertEqual({cell for row in rows_of(blocks["fpu-sharing"])[1:] for cell in row[1:]}, {"77.7"})
        self.assertIn("trax 0.1.0 (2026-02-02)", blocks["fpu-sharing"])
        # Another size stands beside the first, or with --anew in its place.
        for run in other["runs"]:
            run["size"] = [64, 36]
        for words, sizes in ([], ["1280x720", "64x36"]), (["--anew"], ["64x36"]):
            self.assertEqual(self.docs(*words, self.results(other, "other"), self.page), (0, ""))
            block = next(match[2] for match in docs.MARK.finditer(self.page.read_text()) if match[1] == "fpu-sharing")
            self.assertEqual(sorted(set(re.findall(r"\d+x\d+", block)) - {"4x32"}), sizes)
            self.assertEqual(
                next(match[2] for match in docs.MARK.finditer(self.page.read_text()) if match[1] == "table2-era"),
                blocks["table2-era"])

    def test_wrong(self):
        results = self.results(example.complete())
        for text, message in (("", "has no block"), (page_of("table2-era") * 2, "is to begin and end once"),
                              ("<!-- trax-eval a: begin -->\n", "is to begin and end once"),
                              (page_of("no-such"), "there is no table \"no-such\""), (page_of("plot no-such"),
                                                                                      "there is no plot \"no-such\"")):
            self.page.write_text(text)
            status, said = self.docs(results, self.page)
            self.assertEqual((status, said.count("\n"), self.page.read_text(), self.data.exists()), (1, 1, text, False),
                             said)
            self.assertIn(message, said)
        self.page.write_text(page_of("table2-era"))
        for data in (
                "{", "[]", "{}", '{"tables": 3}',
                '{"format": "trax-eval-results", "version": 2, "tables": [{"experiments": [], "names": ["a"], "runs": '
                '[[1, 2]]}]}',
                '{"format": "trax-eval-results", "version": 2, "tables": [{"experiments": [], "names": ["set.x"], '
                '"runs": [[1]]}]}'
        ):
            self.data.write_text(data)
            for words in (["--check"], []):
                status, said = self.docs(*words, self.page)
                self.assertEqual((status, said.count("\n"), self.page.read_text()), (1, 1, page_of("table2-era")),
                                 (data, said))
        self.assertEqual(self.docs("--check", results, self.page)[0], 1)
        (self.folder / "folder.md").mkdir()
        (self.folder / "zero.md").symlink_to("/dev/zero")
        (self.folder / "binary.md").write_bytes(bytes(range(256)))
        for name in ("folder", "zero", "binary", "none"):
            self.assertEqual(self.docs(results, self.folder / f"{name}.md")[0], 1, name)
        self.assertEqual(self.docs(results)[0], 1)
        self.assertEqual(self.docs(self.folder / "page.txt")[0], 1)
        status, said = self.docs("--bogus")
        self.assertEqual((status, said.count("\n")), (1, 1))
        self.assertRegex(said, "^trax-eval docs: error: the following arguments are required")

    def test_wrong_data(self):
        self.page.write_text(page_of("table2-era"))
        good = {"format": "trax-eval-results", "version": 2, "tables": []}
        for change, message in (
                *(({"tables": [{"experiments": [], "names": ["source"], "runs": [[source]]}]}, "no .source. of the")
                  for source in (9, -1, 0.5, "0", True)),
                ({"sources": [7]}, ".sources. is no list of objects"),
                ({"sweeps": [7]}, ".sweeps. is no list of objects"),
                ({"scenes": [{"name": []}]}, r"scenes\[0\].name is list, not a string")):
            self.data.write_text(json.dumps(good | change))
            status, said = self.docs("--check", self.page)
            self.assertEqual((status, said.count("\n")), (1, 1))
            self.assertRegex(said, message)

    def test_stranger(self):
        """The tables that somebody else's sweep describes stand in all three, with the same figures, and each has a
        plot."""
        results = Results(example.stranger())
        out = io.StringIO()
        tables.print_tables(results, PAPER, ["tracing", "plain"], out)
        text = out.getvalue()
        self.page.write_text(page_of("tracing", "by-kind-tiny", "by-kind-4x32", "plain", "plot tracing", "plot plain"))
        self.assertEqual(self.docs(self.results(example.stranger()), self.page), (0, ""))
        rows = rows_of(self.page.read_text())
        self.assertEqual(rows[:5],
                         [["chip", "variant", "cube", "dragon"], ["4x32", "as it is", "20.0 (0.0 %)", "10.0 (0.0 %)"],
                          ["4x32", "sorted", "25.0 (+25.0 %)", "12.5 (+25.0 %)"],
                          ["tiny", "as it is", "10.0 (0.0 %)", "5.00 (0.0 %)"],
                          ["tiny", "sorted", "12.5 (+25.0 %)", "6.25 (+25.0 %)"]])
        self.assertEqual(rows[5:8],
                         [["kind", "MRPS", "fetch"], ["primary", "12.5", "20 %"], ["shadow", "25.0", "20 %"]])
        # The command's text has the host's time besides; the page has the same cells.
        self.assertEqual([row[:4] for row in rows_of(text)[:5]], rows[:5])
        shown = {
            table.identity: re.sub(r"<small>([^<]*)</small>", r" (\1)", markup.table(table)) for sweep in results.sweeps
            for table in tables.of_sweep(results, PAPER, sweep)
        }
        self.assertEqual(list(shown), ["tracing", "by-kind-4x32", "by-kind-tiny", "plain"])
        for name, place in (("tracing", 0), ("by-kind-tiny", 5)):
            cells = [
                re.sub(r"<[^>]*>", "", cell).replace("\u00a0", " ") for cell in re.findall(r"<td.*?</td>", shown[name])
            ]
            for row in rows[place + 1:place + 3]:
                for cell in row:
                    self.assertIn(cell, cells)
        for name in ("tracing", "plain"):
            self.assertTrue((self.folder / f"page-{name}.svg").exists())
        self.assertIn("Beams: MRPS (beam, fog, 1280x720, exact)\nThey are fast.\n", text)

    def test_plots(self):
        """Variants are marks of one series, without lines, if x is a statistic. Figures of many decades have a
        logarithmic axis."""
        made = example.stranger()
        for place, record in enumerate(made["runs"]):
            record["values"] = {"error.rmse": 10.0**(place - 4), "count": 1}
            record["stats"]["cycles"] = 1000 + place
        made["sweeps"][0].update(x="cycles", y="values.error.rmse", table=None)
        figure = charts.sweep_figure(Results(made), PAPER, made["sweeps"][0], "figure")
        self.assertTrue(figure.log_y)
        self.assertEqual([(series.label, series.line, len(series.points)) for series in figure.series],
                         [(f"{scene}, {chip}", False, 2) for scene in ("cube", "dragon") for chip in ("tiny", "4x32")])
        heights = {
            tip.split()[-1]: float(re.search(r'cy="([\d.]+)"', element)[1]) for element in figure.elements()
            if element.startswith("<circle") for tip in [re.search("<title>(.*)</title>", element)[1]]
        }
        gaps = [heights[a] - heights[b] for a, b in zip(("0.0001", "0.001", "0.01"), ("0.001", "0.01", "0.1"))]
        self.assertLess(max(gaps) - min(gaps), 0.3)  # a decade is as high as any other
        self.assertGreater(min(gaps), 20)
        # Values that no axis can have are left out; the rest is drawn, on every kind of axis.
        for values in ((5e-324, 1), (1e308, -1e308, 3), (1, 1), (2.5, 2.6), (-1e-90, 1e90)):
            for log_x, log_y in itertools.product((False, True), repeat=2):
                series = [plots.Series("a", 1, [(x, y, f"{x} {y}") for x in values for y in values])]
                lines = plots.Lines("a", "a", "x", "y", series, log_x=log_x, log_y=log_y, base=2)
                drawn = [(x, y) for x, y, _ in lines.drawn(series[0])]
                self.assertEqual(plots.draw(lines).count("<circle class"), len(drawn))
                self.assertTrue(all(1e-100 < abs(part) < 1e100 for point in drawn for part in point))
            bars = plots.Bars("a", "a", "x", [("a", [(10, value, "") for value in values])], [(10, "issued")])
            self.assertEqual(plots.draw(bars).count("<polygon"), sum(1e-100 < value < 1e100 for value in values))
        # No two series of a figure look alike, with scenes, programs and modes in one.
        results = Results(example.complete())
        figure = charts.sweep_figure(results, PAPER, results.sweeps[1], "figure")
        self.assertEqual(len(figure.series), 3 * 4)
        self.assertEqual(len({(series.style, series.mark) for series in figure.series}), 3 * 4)

    def test_descriptions(self):
        for table, message in (
            ({"row": "chip"}, 'unknown key "row"'),
            ({"values": [3]}, "values: expected names"),
            ({"values": [{"name": "mrps", "as": "x"}]}, "values.as: allowed are"),
            ({"values": [{"name": "mrps", "digits": "2"}]}, "values.digits: expected a number from 1 to 15"),
            ({"values": [{"name": "mrps", "per": 3}]}, "values.per: expected a text"),
            ({"values": [{"name": "mrps", "unit": "1"}]}, 'values: unknown key "unit"'),
            ({"relative": "a"}, "relative: expected an object of axes"),
            ({"relative": {"chip": ["1x32"]}}, "relative: expected an object of axes"),
            ({"where": {"chip": {}}}, "where: expected an object of axes"),
            ({"as": "x"}, "as: allowed are"),
            ({"summary": "mean"}, "summary: allowed are geometric mean, least, greatest"),
            ({"title": 1}, "title: expected a text"),
            (3, "table: expected an object or a list of objects"),
            ([{}, 3], "table: expected an object or a list of objects"),
            ([{"id": "a"}, {"id": "a"}], "the same id"),
        ):
            made = example.stranger()
            made["sweeps"][0]["table"] = table
            with self.assertRaisesRegex(Problem, message):
                list(tables.of_sweep(Results(made), PAPER, made["sweeps"][0]))

    def test_nothing_varies(self):
        """A sweep over scenes alone has a row and a mark for each; a single run has a table without a plot."""
        made = example.stranger()
        made["runs"] = [made["runs"][0], made["runs"][4]]
        for record in made["runs"]:
            record["values"] = {}
        results = Results(made)
        for count in (2, 1):
            results = Results({**made, "runs": made["runs"][:count]})
            table, = tables.of_sweep(results, PAPER, {**results.sweeps[0], "table": None, "reference": ""})
            self.assertEqual(rows_of("\n".join(table.without_empty().lines(False)))[0][:2], ["scene", "MRPS"])
            self.assertEqual([row[0].shown for row in table.rows], ["cube", "dragon"][:count])
            figure = charts.sweep_figure(results, PAPER, results.sweeps[0], "figure")
            self.assertEqual(figure and [[point[0] for point in series.points] for series in figure.series],
                             [[0, 1]] if count == 2 else None)

    def test_only(self):
        made = example.stranger()
        made["sweeps"][0]["table"] = {
            "rows": "chip", "columns": ["scene", "variant"], "relative": {"variant": "as it is"}, "as": "times",
            "only": {"variant": "sorted", "chip": ["tiny"]}
        }
        table, = tables.of_sweep(Results(made), PAPER, made["sweeps"][0])
        self.assertEqual([row[:3] for row in rows_of("\n".join(table.lines(False)))],
                         [["chip", "cube, sorted", "dragon, sorted"], ["tiny", "1.25", "1.25"]])

    def test_what_pixels_differ_from(self):
        made = example.stranger()
        made["sweeps"][0].update(
            table={
                "rows": ["chip", "variant"], "mean": "scene",
                "values": [{"name": "values.picture.pixels_that_differ", "title": "pixels that differ"}]
            })
        for record in made["runs"]:
            record["values"]["picture.pixels_that_differ"] = 3
        table, = tables.of_sweep(Results(made), PAPER, made["sweeps"][0])
        self.assertEqual([title for title, _ in table.columns][2:3], ['pixels that differ from "as it is"'])

    def test_relations(self):
        """A table may have per cent and times instead of figures, figures beside them, and a row's summary."""
        made = example.stranger()
        made["sweeps"][0]["table"] = {
            "rows": "variant", "columns": "scene", "where": {"chip": "4x32"}, "relative": {"variant": "as it is"},
            "as": "percent", "summary": ["geometric mean", "least",
                                         "greatest"], "values": [{"name": "mrps", "title": "rate"}]
        }
        made["runs"][3]["stats"]["mrps"] = 30.0  # the cube, sorted: 30 for 20, beside the dragon's 12.5 for 10
        table, = tables.of_sweep(Results(made), PAPER, made["sweeps"][0])
        self.assertEqual([row[:6] for row in rows_of("\n".join(table.lines(False)))],
                         [["variant", "cube", "dragon", "geometric mean", "least", "greatest"],
                          ["as it is", "0.0 %", "0.0 %", "0.0 %", "0.0 %", "0.0 %"],
                          ["sorted", "+50.0 %", "+25.0 %", "+36.9 %", "+25.0 %", "+50.0 %"]])
        made["sweeps"][0]["table"] |= {
            "values": [{"name": "mrps", "as": "figure"}, {"name": "mrps", "title": "rate", "as": "times"}],
            "summary": "greatest"
        }
        table, = tables.of_sweep(Results(made), PAPER, made["sweeps"][0])
        self.assertEqual(
            rows_of("\n".join(table.lines(False)))[2][:7], ["sorted", "30.0", "1.50", "12.5", "1.25", "30.0", "1.50"])
        made["runs"][3].update(status="failed", error="x", stats=None, values=None)
        table, = tables.of_sweep(Results(made), PAPER, made["sweeps"][0])
        self.assertEqual(rows_of("\n".join(table.lines(False)))[2][:7], ["sorted", "-", "-", "12.5", "1.25", "-", "-"])

    def test_own_sweeps(self):
        """A page's file has only the name of a sweep that comes with trax: the tables are those of the sweep's file."""
        made = example.complete()
        for sweep in made["sweeps"]:
            sweep["file"] = f"/anywhere/lib/trax/evaluation/sweeps/{sweep['name']}.json"
        self.page.write_text(page_of("table2-bytes-era", "size"))
        self.assertEqual(self.docs(self.results(made), self.page), (0, ""))
        self.assertEqual([set(sweep) for sweep in json.loads(self.data.read_text())["sweeps"]], [{"name"}] * 2)
        self.assertIn("bandwidth in use", self.page.read_text())
        self.data.write_text(self.data.read_text().replace('{"name":"size"}', '{"name":"no-such"}'))
        status, said = self.docs("--check", self.page)
        self.assertEqual((status, said.count("\n")), (1, 1))
        self.assertIn("no-such.json", said)

    def test_folder(self):
        """A folder stands for its pages that have blocks."""
        for name in ("one", "two"):
            (self.folder / f"{name}.md").write_text("<!-- trax-eval data: both.json -->\n" +
                                                    page_of("table2-era" if name == "one" else "plot fpu-sharing"))
        (self.folder / "three.md").write_bytes(b"No block, and no UTF-8: \xff\n")
        self.assertEqual(self.docs(self.results(example.complete()), self.folder), (0, ""))
        self.assertEqual(self.docs("--check", self.folder), (0, ""))
        self.assertTrue((self.folder / "both-fpu-sharing.svg").exists())
        (self.folder / "two.md").write_text(
            (self.folder / "two.md").read_text().replace("mrps against", "rays against"))
        status, said = self.docs("--check", self.folder)
        self.assertEqual((status, said.count("\n")), (1, 1))
        self.assertIn("two.md", said)

    def test_estimates(self):
        """A quick run is compared with the exact run of the same job: the error, whether its interval holds, and the
        host's time."""
        made = example.complete()
        quick = []
        for run in [
                run for run in made["runs"] if "table2" in run["experiments"] and run["program"] == "era" and
                run["scene"] == "dragon" and run["config"] in ("1x32", "4x32")
        ]:
            exact = run["stats"]["mrps"]
            factor = 1.1 if run["config"] == "1x32" else 0.98
            quick.append({
                **run, "key": run["key"] + "q", "mode": "quick", "host": {"processor_seconds": 1.0},
                "set": {**run["set"], "trax-render --sample-seed": 3},
                "stats": {**run["stats"], "mrps": factor * exact},
                "values": {**run["values"], "mrps_low": 0.97 * factor * exact,
                           "mrps_high": 1.03 * factor * exact}, "points": None
            })
            run["host"] = {"processor_seconds": 8.0}
        made["runs"] += quick
        self.page.write_text(page_of("estimates-table2"))
        self.assertEqual(self.docs(self.results(made), self.page), (0, ""))
        rows = rows_of(self.page.read_text())
        self.assertEqual(next(row for row in rows if row[0] == "era"),
                         ["era", "dragon", "2", "1", "6.0 %", "10.0 %", "3.0 %", "2.00 s", "16.0 s", "8.0"])
        self.assertEqual(self.docs("--check", self.page), (0, ""))

    def test_estimates_of_workloads(self):
        """An estimate stands beside the exact run of its own workload, view, variant and settings, in any order of
        runs."""
        made = example.complete()
        first = next(run for run in made["runs"]
                     if run["program"] == "era" and run["scene"] == "dragon" and run["config"] == "4x32")
        settings = {"dcache.bytes": 32768}
        places = ({}, {"workload": "occlusion"}, {"variant": "wide"}, {"view": "other"},
                  {"set": {**first["set"], **settings}})
        exact = [
            {**first, **place, "key": f"exact-{number}", "points": None, "stats": {**first["stats"], "mrps": rate}}
            for number, (place, rate) in enumerate(zip(places, (10.0, 3.0, 5.0, 7.0, 9.0)))
        ]
        quick = [{
            **one, "key": f"quick-{one['key']}", "mode": "quick",
            "stats": {**one["stats"], "mrps": 1.01 * one["stats"]["mrps"]},
            "values": {"mrps_low": 0.98 * one["stats"]["mrps"], "mrps_high": 1.03 * one["stats"]["mrps"]}
        } for one in exact]
        for order in (exact + quick, quick + exact[::-1]):
            found = estimates.estimates(Results({**made, "runs": order}).runs)
            self.assertEqual(sorted((one.value, round(one.error, 6), one.holds) for one in found),
                             [(value, 0.01, True) for value in (3.0, 5.0, 7.0, 9.0, 10.0)])
        self.assertEqual(
            [one.value for one in estimates.estimates(Results({**made, "runs": exact[1:] + quick[:1]}).runs)], [None])
        self.assertNotIn("0 of 0", estimates.every(Results({**made, "runs": quick})).note)
        table = estimates.every(Results({**made, "runs": exact[:2] + quick[:2]}))
        self.assertEqual([title for title, _ in table.columns][:4], ["mode", "program", "scene", "workload"])
        # The summary of a sweep has a row for each workload.
        results = Results({**made, "runs": exact[:2] + quick[:2]})
        table = estimates.of_sweep(results, {"name": "table2"})()
        self.assertEqual([row[:5] for row in rows_of("\n".join(table.lines(False)))],
                         [["program", "scene", "workload", "estimates", "intervals that hold the exact figure"],
                          ["era", "dragon", "", "1", "1"], ["era", "dragon", "occlusion", "1", "1"]])

    def test_chips_front(self):
        """A chip is on a front unless another one costs no more and has as many rays."""
        document, costs = example.complete(), {"area": 3, "power": 4, "bandwidth": 5}
        numbers = random.Random(35)
        for chip in example.CHIPS:
            rate, values = numbers.randint(5, 60), [numbers.randint(1, 9) for _ in costs]
            for scene in example.SCENES:
                run = example.run("ours", scene, chip, experiments=("rays", ), value=rate)
                run["workload"], run["values"] = "primary-shadow", {**run["values"], "area_units": values[0]}
                run["stats"]["energy"] = {"average_power": values[1]}
                run["stats"]["memory"]["bandwidth_gbps"] = values[2]
                document["runs"].append({**run, "key": f"front-{run['key']}"})
        document["sweeps"].append({"name": "rays"})
        self.page.write_text(page_of("chips-front", "plot chips-front"))
        self.assertEqual(self.docs(self.results(document), self.page), (0, ""))
        rows = rows_of(self.page.read_text())[1:]
        self.assertEqual(sorted(row[0] for row in rows), sorted(example.CHIPS))
        for row in rows:
            # The first of two chips with the same figures is on the front.
            place = {name: (float(row[column]), -float(row[2]), rows.index(row)) for name, column in costs.items()}
            on = [name for name, column in costs.items()
                  if not any(other is not row and float(other[2]) >= float(row[2])
                             and (float(other[column]), -float(other[2]), rows.index(other)) < place[name]
                             for other in rows)]
            self.assertEqual([name for name in row[8].split(", ") if name], on, row)

    def test_missing(self):
        """A mean with a run that is not there is not a mean of the others."""
        made = example.stranger()
        made["runs"][7].update(status="failed", error="x", stats=None, values=None)
        self.page.write_text(page_of("by-kind-4x32", "by-kind-tiny"))
        self.assertEqual(self.docs(self.results(made), self.page), (0, ""))
        rows = rows_of(self.page.read_text())
        self.assertEqual(rows[:1] + rows[1:3], [["kind"], ["primary"], ["shadow"]])
        self.assertEqual(rows[4], ["primary", "12.5", "20 %"])
        self.page.write_text(page_of("tracing"))
        self.assertEqual(self.docs(self.results(made), self.page), (0, ""))
        self.assertEqual(
            rows_of(self.page.read_text())[1:3],
            [["4x32", "as it is", "20.0 (0.0 %)", "10.0 (0.0 %)"], ["4x32", "sorted", "25.0 (+25.0 %)", "-"]])

    def test_programs_are_not_named(self):
        for path in (FOLDER / "report").glob("*.py"):
            self.assertNotRegex(path.read_text(), r"\b(ours|era)\"|\"(ours|era)\b", path.name)


if __name__ == "__main__":
    unittest.main()
