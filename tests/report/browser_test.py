#!/usr/bin/env python3
"""The report's page in Chromium without a window: browser_test.py REPORT_FOLDER [--keep DIR]. Whether it is whole
there, sorts, tells values, follows light and dark, fits a narrow window and prints. --keep leaves the page, its
pictures and its PDF in a folder, to be looked at."""

import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import example
from browser import Browser, PageTests, find_chromium, take_keep

FOLDER = pathlib.Path(sys.argv.pop(1)).resolve()


class BrowserTest(PageTests, unittest.TestCase):
    KEEP = take_keep()
    CLOSELY = "complete"
    REQUESTS = r"^(file://.*\.html$|data:image/png)"
    TEXTS, PAPER = 8, (8, 40)

    @classmethod
    def setUpClass(cls):
        program = find_chromium()
        cls.scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.scratch.cleanup)
        folder = pathlib.Path(cls.scratch.name)
        (folder / "pictures").mkdir()
        for scene in example.SCENES:
            (folder / "pictures" / f"{scene}.png").write_bytes(example.picture())
        cls.pages = {}
        for name in ("complete", "partial", "hostile", "hostile_own", "own"):
            source, cls.pages[name] = folder / f"{name}.json", folder / f"{name}.html"
            source.write_text(json.dumps(getattr(example, name)()))
            subprocess.run([sys.executable, "-B", "-m", "report.make", source, "-o", cls.pages[name]], cwd=FOLDER,
                           check=True)
        cls.browser = Browser(program)
        cls.addClassCleanup(cls.browser.close)

    def test_whole(self):
        for name in self.pages:
            with self.subTest(name):
                self.load(name)
                figures = self.browser.run("""Array.from(document.querySelectorAll("main figure"), figure => {
                    const inner = figure.querySelector(":scope > svg, :scope > img, :scope > p");
                    const box = inner.getBoundingClientRect();
                    const selected = ["use", "polygon", "path", "text"].map(name => `:scope > svg ${name}`).join(", ");
                    const marks = Array.from(figure.querySelectorAll(selected), mark => mark.getBoundingClientRect());
                    const outside = mark => mark.right > box.right + 1 || mark.bottom > box.bottom + 1 ||
                                            mark.left < box.left - 1 || mark.top < box.top - 1;
                    return {id: figure.id, width: box.width, height: box.height,
                            complete: inner.tagName !== "IMG" || inner.naturalWidth > 0,
                            text: inner.textContent, outside: marks.some(outside)}; })""")
                self.assertGreaterEqual(len(figures), 3 if name.endswith("own") else 8)
                for figure in figures:
                    self.assertGreater(figure["width"], 100, figure)
                    self.assertGreater(figure["height"], 10, figure)
                    self.assertTrue(figure["complete"], figure)
                    self.assertFalse(figure["outside"], figure)
                if name == "complete":
                    self.assertEqual([figure["id"] for figure in figures if "Nothing was measured" in figure["text"]],
                                     [])
                    self.assertEqual(len(figures), 4 + 8 + 2 + 1 + 2 + 1 + 8)
                    self.nothing_is_hidden_from_view()
                    self.cells_hold_their_text()
                self.is_quiet()

    def nothing_is_hidden_from_view(self):
        """Marks are drawn in colours of their own: what is behind them shows another."""
        ground = self.ground()
        colours = self.browser.run(
            """Array.from(document.querySelectorAll("figure polygon"), mark => getComputedStyle(mark).fill)
            .concat(Array.from(document.querySelectorAll("figure svg:not(.mark) use"),
                    mark => getComputedStyle(mark).color))""")
        self.assertGreater(len(colours), 1000)
        for colour in set(colours):
            rgb = [float(part) for part in re.findall(r"[\d.]+", colour)[:3]]
            self.assertGreater(max(abs(a - b) for a, b in zip(rgb, ground)), 30, colour)
        self.assertGreaterEqual(len(set(colours)), 12)

    def cells_hold_their_text(self):
        self.browser.run("for (const closed of document.querySelectorAll('details')) closed.open = true")
        over = self.browser.run("""Array.from(document.querySelectorAll("td, th"), e => {
            const range = document.createRange(); range.selectNodeContents(e);
            const inner = range.getBoundingClientRect(), outer = e.getBoundingClientRect();
            const over = inner.width && (inner.right > outer.right + 1 || inner.left < outer.left - 1);
            return over ? e.closest("table").id + ": " + e.textContent.slice(0, 60) : null; }).filter(x => x)""")
        self.assertEqual(over, [])

    def test_sorts(self):
        self.load("complete")
        rows = """Array.from(document.querySelector("#table2-ours").tBodies[0].rows"""
        column = rows + """, row => row.cells[{}].dataset.value ?? null)"""
        before = self.browser.run(column.format(0))
        for place, key in ((3, float), (1, float)):
            press = f"""document.querySelector("#table2-ours").tHead.rows[0].cells[{place}]"""
            box = self.centre(f"{press}.firstChild")
            self.browser.press(*box)
            self.assertEqual(self.browser.run(press + ".getAttribute('aria-sort')"), "ascending")
            values = self.browser.run(column.format(place))
            self.assertEqual(values, sorted(values, key=key))
            self.browser.press(*box)
            self.assertEqual(self.browser.run(press + ".getAttribute('aria-sort')"), "descending")
            values = self.browser.run(column.format(place))
            self.assertEqual(values, sorted(values, key=key, reverse=True))
        self.assertEqual(sorted(before), sorted(self.browser.run(column.format(0))))
        # Keys of the keyboard do as well; what is missing stays at the end, both ways; text sorts as text.
        self.load("partial")
        for presses in (1, 2):
            self.browser.run("""document.querySelector("#table2-ours").tHead.rows[0].cells[3].firstChild.focus()""")
            self.browser.call("Input.dispatchKeyEvent", type="keyDown", key="Enter", code="Enter", text="\r",
                              windowsVirtualKeyCode=13)
            self.browser.call("Input.dispatchKeyEvent", type="keyUp", key="Enter", code="Enter",
                              windowsVirtualKeyCode=13)
            values = self.browser.run(column.format(3))
            known = [value for value in values if value is not None]
            self.assertEqual(len(values), 15)
            self.assertEqual(values[:len(known)], sorted(known, key=float, reverse=presses == 2))
        self.browser.run("""document.querySelector("#runs").tHead.rows[0].cells[6].firstChild.click()""")
        states = self.browser.run(
            """Array.from(document.querySelector("#runs").tBodies[0].rows,
                row => row.cells[6].textContent.slice(0, 4))""")
        self.assertEqual(states, sorted(states))
        self.is_quiet()

    def centre(self, element):
        """Scrolls to an element; the place of its middle."""
        return self.browser.run(f"""(e => {{ e.scrollIntoView({{block: "center"}});
            const b = e.getBoundingClientRect(); return [b.x + b.width / 2, b.y + b.height / 2]; }})({element})""")

    def test_tells_values(self):
        self.load("complete")
        box = self.centre('document.querySelectorAll("#stalls-ours-dragon polygon")[0]')
        self.assertTrue(self.browser.run("document.getElementById('tip').hidden"))
        self.browser.call("Input.dispatchMouseEvent", type="mouseMoved", x=box[0], y=box[1])
        self.assertEqual(
            self.browser.run("[document.getElementById('tip').hidden, document.getElementById('tip').textContent]"),
            [False, "1x32: issued 40.0 % (issued 40.0 %)"])
        inside = self.browser.run("""(b => b.left >= 0 && b.top >= 0 && b.right <= innerWidth &&
            b.bottom <= innerHeight)(document.getElementById('tip').getBoundingClientRect())""")
        self.assertTrue(inside)
        self.browser.call("Input.dispatchMouseEvent", type="mouseMoved", x=2, y=2)
        self.assertTrue(self.browser.run("document.getElementById('tip').hidden"))
        self.browser.run("document.querySelector('#scaling-dragon .hit').focus()")
        self.assertRegex(self.browser.run("document.getElementById('tip').textContent"),
                         r"^paper, 1x32: 1\.00 times, 1\.94 MRPS$")


if __name__ == "__main__":
    unittest.main()
