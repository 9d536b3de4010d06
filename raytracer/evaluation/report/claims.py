"""The paper's claims: a row for each, with the rule by which it is judged."""

import copy
from dataclasses import dataclass

from .assertions import ASSERTIONS, NOT_MEASURED
from .results import COLUMNS, deviation, mean, number, ratio

AGREES, DIFFERS, UNKNOWN = "agrees", "differs", "unknown"
FITTED = "fitted"  # it agrees by construction


@dataclass
class Claim:
    """verdicts: by program, (verdict, what was found)."""

    title: str
    rule: str
    paper: str
    verdicts: dict


def _judged(holds, found):
    return (UNKNOWN, found) if holds is None else (AGREES if holds else DIFFERS, found)


def table2_deviations(results, paper, program):
    """Returns the deviation of every cell of Table 2 that was measured."""
    found = [
        deviation(results.figure("mrps", program, scene, chip), paper.mrps(column, chip))
        for column, scene in results.columns.items() for chip in paper.chips
    ]
    return [value for value in found if value is not None]


def speedup(results, program, scene, chip):
    """Returns the speed-up of a chip over 1x32, for pictures of one size and mode only."""
    one, many = results.cell(program, scene, "1x32"), results.cell(program, scene, chip)
    if not one or not many or one.size != many.size:
        return None
    return ratio(many.get("mrps"), one.get("mrps"))


def median(values):
    values = sorted(values)
    if not values:
        return None
    middle = len(values) // 2
    return values[middle] if len(values) % 2 else (values[middle - 1] + values[middle]) / 2


def _near(deviations, cells, what):
    """Judges whether all of so many figures are within a tenth of the paper's. `deviations` has None for a figure that
    was not measured."""
    values = [abs(value) for value in deviations if value is not None]
    if not values:
        return UNKNOWN, NOT_MEASURED
    near = sum(value <= 0.10 for value in values)
    what = what.removesuffix("s") if len(values) == 1 else what
    found = f"{near} of {len(values)} {what} within 10 %, median deviation {100 * median(values):.0f} %; " \
            f"largest {100 * max(values):,.0f} %"
    if len(values) < cells:
        found += f"; {cells - len(values)} of {cells} not measured"
    return _judged(near == len(values) if len(values) == cells else (False if near < len(values) else None), found)


def _within(results, paper, program):
    return _near(table2_deviations(results, paper, program), len(COLUMNS) * len(paper.chips), "cells")


def _gflops(results, paper, program):
    ours = {row["name"]: row.get("rt_gflops") for row in paper.table1 if row["name"] in paper.chips}
    return _near([deviation(results.mean_of_papers("gflops", program, chip), wanted) for chip, wanted in ours.items()],
                 len(ours), "chips")


def _area(results, paper, program):
    def measured(chip):  # a chip has one area, whatever the scene
        return next((run for scene in results.papers if (run := results.cell(program, scene, chip)) and run.done), None)

    rows = [(measured(row["name"]), row.get("area_mm2")) for row in paper.table1 if row["name"] in paper.chips]
    verdict, found = _near([deviation(run.get("area_mm2") if run else None, wanted) for run, wanted in rows], len(rows),
                           "chips")
    units = [
        value for run, wanted in rows
        if (value := deviation(run.get("values.area_units") if run else None, wanted)) is not None
    ]
    found += f"; of the sum of units without wires, which is no fit, {100 * median(units):+.0f} %" if units else ""
    return FITTED if verdict != DIFFERS and found != NOT_MEASURED else verdict, found


def _table3(results, paper, program):
    found = []
    for chip, row in paper.table3.items():
        for bandwidth in (8.0, 16.0):
            found.append(
                deviation(results.figure("mrps", program, results.columns["dragon"], chip, bandwidth),
                          row[f"dragon_{bandwidth:g}gbs_mrps"]))
            found.append(
                deviation(results.mean_of_papers("mrps", program, chip, bandwidth),
                          row[f"average_{bandwidth:g}gbs_mrps"]))
    return _near(found, len(found), "figures")


def _bytes(results, paper, program, scene, chip, bandwidth=8.0):
    """Why rates differ where bandwidth binds: what a ray moves, and what it can have moved at the paper's rate."""
    run = results.cell(program, scene, chip, bandwidth)
    moved = ratio(run.get("memory.bytes"), run.get("rays")) if run else None
    used = run.get("memory.utilisation") if run else None
    if bandwidth == 8.0:
        published = results.published(paper, scene, chip)
    else:
        published = (paper.table3.get(chip) or {}).get(f"dragon_{bandwidth:g}gbs_mrps")
    limit = ratio(1e3 * bandwidth, published)
    if None in (moved, used, limit):
        return ""
    return (f"a ray moves {moved:,.0f} bytes, of {bandwidth:g} GB/s {100 * used:.0f} % are in use; "
            f"the paper's moved at most {limit:,.0f}")


def _scaling(results, paper, program):
    near, known, wanted, worst, by_scene = 0, 0, 0, None, []
    for column, scene in results.columns.items():
        if column == "dragon":  # it is the next claim's
            continue
        of_scene = []
        for chip in paper.chips[1:]:
            wanted += 1
            value = deviation(speedup(results, program, scene, chip), paper.speedup(column, chip))
            if value is None:
                continue
            known += 1
            of_scene.append(abs(value) <= 0.10)
            if worst is None or abs(value) > abs(worst[2]):
                worst = (scene, chip, value)
        near += sum(of_scene)
        by_scene.append(f"{scene} {sum(of_scene)} of {len(of_scene)}")
    if not known:
        return UNKNOWN, NOT_MEASURED
    found = f"{near} of {known} speed-ups within 10 %; {', '.join(by_scene)}"
    if near < known:
        scene, chip, off = worst
        one, many = (deviation(results.figure("mrps", program, scene, name), results.published(paper, scene, name))
                     for name in ("1x32", chip))
        reason = _bytes(results, paper, program, scene, chip)
        found += f"; furthest off: {scene} on {chip}, {100 * off:+.0f} %, of rays {100 * one:+.0f} % on 1x32 "
        found += f"and {100 * many:+.0f} % there" + (f": {reason}" if reason else "")
    if known < wanted:
        found += f"; {wanted - known} of {wanted} not measured"
    return _judged(near == wanted if known == wanted else (False if near < known else None), found)


def _largest_gain(results, paper, program, scene):
    """(chip, gain) of the chip above 128 threads with the most rays over 4x32, and whether all were measured."""
    at = results.figure("mrps", program, scene, "4x32")
    chips = [chip for chip in paper.chips if paper.threads(chip) > 128]
    known = [(ratio(value, at), chip) for chip in chips
             if (value := results.figure("mrps", program, scene, chip)) is not None and at]
    gain, chip = max(known, default=(None, None))
    return chip, gain, len(known) == len(chips)


def _views(results):
    """The dragon, and the scene that is another view of it, or None."""
    dragon = results.columns["dragon"]
    return dragon, next(
        (scene for scene, column in results.stands_for.items() if column == "dragon" and scene != dragon), None)


def _saturation(results, paper, program):
    dragon, other_view = _views(results)
    chip, gain, whole = _largest_gain(results, paper, program, dragon)
    if gain is None:
        return UNKNOWN, NOT_MEASURED
    found = f"{chip} has {gain:.2f} times the rays of 4x32"
    if gain > 1.10:
        reason = _bytes(results, paper, program, dragon, "4x32")
        found += f"; on 4x32 memory does not bind yet: {reason}" if reason else ""
    other = _largest_gain(results, paper, program, other_view)
    if other[1] is not None:
        found += f"; {other_view}: {other[1]:.2f} times on {other[0]}"
    return _judged(gain <= 1.10 if whole or gain > 1.10 else None, found)


def _bandwidth(results, paper, program):
    def gain(scene):
        return ratio(results.figure("mrps", program, scene, "8x32", 16.0),
                     results.figure("mrps", program, scene, "8x32"))

    dragon, other_view = _views(results)
    value, other = gain(dragon), gain(other_view)
    if value is None:
        return UNKNOWN, NOT_MEASURED
    found = f"{value:.2f} times"
    if value < 1.6:
        reason = _bytes(results, paper, program, dragon, "8x32", 16.0)
        found += f"; at 16 GB/s memory does not bind: {reason}" if reason else ""
    return _judged(value >= 1.6, found + (f"; {other_view}: {other:.2f} times" if other is not None else ""))


def _mrtp(results, paper, program):
    gain = ratio(results.figure("mrps", program, results.columns["dragon"], "4x32"),
                 number(paper.published.get("mrtp_mrps_scaled", 0.515)))
    published = ratio(paper.mrps("dragon", "4x32"), number(paper.published.get("mrtp_mrps_scaled", 0.515)))
    return (UNKNOWN, NOT_MEASURED) if gain is None else _judged(abs(gain / published - 1) <= 0.10, f"{gain:.1f} times")


def _frames(results, paper, program):
    run = results.cell(program, results.columns["dragon"], "4x32")
    value = run.frames_per_second() if run else None
    return (UNKNOWN, NOT_MEASURED) if value is None else _judged(abs(value / 3.4 - 1) <= 0.10, f"{value:.1f} frames/s")


def _power(results, paper, program):
    value = results.mean_of_papers("energy.average_power", program, "4x32")
    if value is None:
        return UNKNOWN, NOT_MEASURED
    return _judged(abs(value / 4 - 1) <= 0.25, f"{value:.1f} W, dynamic only")


def _flops(results, paper, program):
    def per_ray(scene):
        return ratio(results.figure("flops", program, scene, "4x32"), results.figure("rays", program, scene, "4x32"))

    value = mean(per_ray(scene) for scene in results.papers)
    published = 1e3 * 9.3 / 7.14
    return (UNKNOWN, NOT_MEASURED) if value is None else _judged(abs(value / published - 1) <= 0.10, f"{value:,.0f}")


def _staggering(results, paper, program):
    found = []  # of each series: the first interval's share, the later ones' median
    for series in results.series:
        run = results.by_key.get(series.get("run"))
        columns, rows = series.get("columns"), series.get("rows")
        if not run or run.program != program or not isinstance(
                columns, list) or "fetch_refused" not in columns or not isinstance(rows, list):
            continue
        place = columns.index("fetch_refused")
        shares = [number(row[place]) for row in rows if isinstance(row, list) and len(row) > place]
        shares = [share for share in shares if share is not None]
        if len(shares) >= 8:
            found.append((shares[0], median(shares[len(shares) // 8:-len(shares) // 8])))
    if not found:
        return UNKNOWN, NOT_MEASURED
    first, later = mean(first for first, _ in found), mean(later for _, later in found)
    text = f"{100 * first:.1f} % of fetches in the first interval, {100 * later:.1f} % later (median)"
    if len(found) > 1:
        text += f"; means of {len(found)} runs"
    return _judged(later < first, text)


_CLAIMS = [
    ("Table 1: area of the chips",
     "each of the 15 within 10 %; the area is a fit to these figures, so that it agrees by construction",
     "1.9 to 25.3 mm²", _area),
    ("Table 1: GFLOPS in ray tracing",
     "each of the 15 chips within 10 %, mean of the scenes; it depends on where floats are compared, which the paper "
     "does not say", "2.5 to 23.1", _gflops),
    ("Table 2: rays per second", "each of the 60 cells within 10 %", "1.41 to 32.5 MRPS", _within),
    ("Table 3: 8 and 16 GB/s", "each of the 12 figures within 10 %", "5.69 to 18.5 MRPS", _table3),
    ("Speed-up from 1x32", "within 10 % of the paper's, for conference, crytek and the fourth scene, on each chip",
     "up to 13.1 times", _scaling),
    ("The dragon stops scaling at 128 threads at 8 GB/s", "no larger chip has 1.1 times the rays of 4x32",
     "6.18 MRPS at 4x32, 5.68 to 6.07 above", _saturation),
    ("The dragon gains from 16 GB/s", "at least 1.6 times on 8x32", "almost 2 times; 1.77 by Table 3", _bandwidth),
    ("Against MRTP, scaled to 65 nm and 500 MHz", "within 10 %: dragon on 4x32",
     "12 times by the paper's figures; it says 13", _mrtp),
    ("Frames per second at 1280x720", "within 10 %: dragon on 4x32, the scene that gives the paper's figure", "3.4",
     _frames),
    ("Adds and multiplications a ray", "within 10 %: mean of the scenes on 4x32", "about 1,300 (Table 1 over Table 2)",
     _flops),
    ("Power of 4x32", "within 25 %: the paper calls its own a rough estimate", "4 W", _power),
    ("Threads stagger: instruction-bank conflicts are frequent at first",
     "a conflict refuses a greater share of the fetches in the first interval than in the later ones (median)",
     "described, no figures", _staggering),
    *ASSERTIONS,
]


def _of_scenes(results, scenes):
    """The results with means over these scenes alone."""
    some = copy.copy(results)
    some.papers = scenes
    return some


def _verdict(judge, results, paper, program):
    """Returns a judge's verdict. If scenes are missing the claim stays open, and the text has the finding of the
    others."""
    def judged(some):
        holds, text = judge(some, paper, program)
        return (holds, text) if holds in (AGREES, DIFFERS, UNKNOWN, FITTED) else _judged(holds, text)

    verdict, found = judged(results)
    if verdict != UNKNOWN or found != NOT_MEASURED:
        return verdict, found
    known = [scene for scene in results.papers if judged(_of_scenes(results, [scene]))[1] != NOT_MEASURED]
    if not known:
        return UNKNOWN, NOT_MEASURED
    return UNKNOWN, f"measured on {len(known)} of {len(results.papers)} scenes: {judged(_of_scenes(results, known))[1]}"


def claims(results, paper, programs):
    return [
        Claim(title, rule, published, {program: _verdict(judge, results, paper, program) for program in programs})
        for title, rule, published, judge in _CLAIMS
    ]
