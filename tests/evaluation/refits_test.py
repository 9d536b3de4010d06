#!/usr/bin/env python3
"""When a new tree pays, with runs that are made up: refits_test.py RAYTRACER/EVALUATION"""

import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(sys.argv.pop(1)).resolve()))
from trax_eval.refits import AT, FROM, NAME, add_rebuilding, moment  # noqa: E402


def rebuilding(frames):
    """The figures by moment. frames: {moment: (key and cycles with a new tree, the same with the first one), ...}; None
    instead of cycles: the run failed."""
    points, runs = [], {}
    for at, pair in frames.items():
        for (key, cycles), more, reference in zip(pair, ({}, {FROM: 0}), (pair[0][0], pair[0][0])):
            points.append({"key": key, "reference": reference, "scene": "s", "program": "p", "config": "4x32",
                           "set": {AT: at, **more}})
            runs.setdefault(key, {"status": "failed" if cycles is None else "done", "stats": {"cycles": cycles},
                                  "values": {}})
    add_rebuilding([{"name": "walk", "points": points}], runs)
    return {at: runs[pair[1][0]]["values"].get(NAME) for at, pair in frames.items()}


class RefitsTest(unittest.TestCase):
    def test_definition(self):
        frames = {at: ((f"n{at}", 100), (f"o{at}", 100 + more)) for at, more in enumerate((0, 3, 5, 4, 9))}
        self.assertEqual(rebuilding(frames), {0: None, 1: 3, 2: 2 * 5 - 3, 3: 3 * 4 - 8, 4: 4 * 9 - 12})

    def test_still_frame(self):
        """A refitted tree with the bytes of the new one is the same run, and counts as a frame that loses nothing."""
        frames = {0: (("n0", 100), ("n0", 100)), 1: (("n1", 100), ("n1", 100)), 2: (("n2", 100), ("o2", 110))}
        self.assertEqual(rebuilding(frames), {0: None, 1: None, 2: 20})

    def test_missing_frame(self):
        """What a frame loses whose run failed is not known, nor what follows from it."""
        for lost in ((("n2", None), ("o2", 5)), (("n2", 100), ("o2", None))):
            frames = {at: ((f"n{at}", 100), (f"o{at}", 107)) for at in range(4)} | {2: lost}
            self.assertEqual(rebuilding(frames), {0: None, 1: 7, 2: None, 3: None})

    def test_reference_of_another_moment(self):
        new, old = {"key": "n", "set": {AT: 0}}, {"key": "o", "set": {AT: 1, FROM: 0}, "reference": "n"}
        runs = {key: {"status": "done", "stats": {"cycles": 9}, "values": {}} for key in "no"}
        add_rebuilding([{"name": "walk", "points": [new, old]}], runs)
        self.assertEqual(runs["o"]["values"], {})

    def test_moments(self):
        texts = (3, 0.5, "2", "1e1", "0x1p3", "0X10", "x", "", None, True, "0x1p9999")
        self.assertEqual([moment(one) for one in texts], [3, 0.5, 2, 10, 8, 16, None, None, None, None, None])
        unknown = [{"key": "o", "set": {FROM: 0}}, {"key": "n", "set": {AT: "x", FROM: 0}}]
        add_rebuilding([{"name": "walk", "points": unknown}], {})


if __name__ == "__main__":
    unittest.main()
