"""What the paper says, and whether what was measured says the same: a row for each claim, with the rule by which it is judged."""

from dataclasses import dataclass

from .results import SCENES, deviation, mean, number, ratio

AGREES, DIFFERS, UNKNOWN = "agrees", "differs", "unknown"


@dataclass
class Claim:
    """verdicts: by program, (verdict, what was found)."""

    title: str
    rule: str
    paper: str
    verdicts: dict


def _judged(holds, found):
    return (UNKNOWN, found) if holds is None else (AGREES if holds else DIFFERS, found)


def table2_deviations(results, paper, program, scenes=None):
    """(scene, chip, deviation) of every cell of Table 2 that was measured."""
    found = []
    for scene in scenes or SCENES.values():
        for chip in paper.chips:
            value = deviation(results.figure("mrps", program, scene, chip), paper.mrps(scene, chip))
            if value is not None:
                found.append((scene, chip, value))
    return found


def speedup(results, program, scene, chip):
    """From 1x32 to a chip; pictures of one size and mode only."""
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


def _within(results, paper, program):
    values = [abs(value) for _, _, value in table2_deviations(results, paper, program)]
    cells = len(SCENES) * len(paper.chips)
    if not values:
        return UNKNOWN, "nothing measured"
    near = sum(value <= 0.10 for value in values)
    found = f"{near} of {len(values)} cells within 10 %; median deviation {100 * median(values):.0f} %, largest {100 * max(values):.0f} %"
    if len(values) < cells:
        found += f"; {cells - len(values)} of {cells} cells not measured"
    return _judged(near == len(values) if len(values) == cells else (False if near < len(values) else None), found)


def _scaling(results, paper, program):
    near, known, wanted, worst = 0, 0, 0, None
    for scene in ("conference", "crytek-sponza", "forest"):
        for chip in paper.chips[1:]:
            wanted += 1
            value = deviation(speedup(results, program, scene, chip), paper.speedup(scene, chip))
            if value is None:
                continue
            known += 1
            near += abs(value) <= 0.10
            if worst is None or abs(value) > abs(worst[2]):
                worst = (scene, chip, value)
    if not known:
        return UNKNOWN, "nothing measured"
    found = f"{near} of {known} speed-ups within 10 %; furthest off: {worst[0]} on {worst[1]}, {100 * worst[2]:+.0f} %"
    if known < wanted:
        found += f"; {wanted - known} of {wanted} not measured"
    return _judged(near == wanted if known == wanted else (False if near < known else None), found)


def _saturation(results, paper, program):
    at = results.figure("mrps", program, "dragon", "4x32")
    above = [results.figure("mrps", program, "dragon", chip) for chip in paper.chips if paper.threads(chip) > 128]
    known = [value for value in above if value is not None]
    if at is None or not known:
        return UNKNOWN, "not measured"
    gain = ratio(max(known), at)
    found = f"the fastest chip above 128 threads has {gain:.2f} times the rays of 4x32"
    return _judged(gain <= 1.10 if len(known) == len(above) or gain > 1.10 else None, found)


def _bandwidth(results, paper, program):
    gain = ratio(results.figure("mrps", program, "dragon", "8x32", 16.0), results.figure("mrps", program, "dragon", "8x32"))
    return (UNKNOWN, "not measured") if gain is None else _judged(gain >= 1.6, f"{gain:.2f} times")


def _mrtp(results, paper, program):
    gain = ratio(results.figure("mrps", program, "dragon", "4x32"), number(paper.published.get("mrtp_mrps_scaled", 0.515)))
    published = ratio(paper.mrps("dragon", "4x32"), number(paper.published.get("mrtp_mrps_scaled", 0.515)))
    return (UNKNOWN, "not measured") if gain is None else _judged(abs(gain / published - 1) <= 0.10, f"{gain:.1f} times")


def _frames(results, paper, program):
    run = results.cell(program, "dragon", "4x32")
    value = run.frames_per_second() if run else None
    return (UNKNOWN, "not measured") if value is None else _judged(abs(value / 3.4 - 1) <= 0.10, f"{value:.1f} frames/s")


def _power(results, paper, program):
    value = mean(results.figure("energy.average_power", program, scene, "4x32") for scene in SCENES.values())
    return (UNKNOWN, "not measured") if value is None else _judged(abs(value / 4 - 1) <= 0.25, f"{value:.1f} W, dynamic only")


def _flops(results, paper, program):
    def per_ray(scene):
        return ratio(results.figure("flops", program, scene, "4x32"), results.figure("rays", program, scene, "4x32"))

    value = mean(per_ray(scene) for scene in SCENES.values())
    published = 1e3 * 9.3 / 7.14
    return (UNKNOWN, "not measured") if value is None else _judged(abs(value / published - 1) <= 0.10, f"{value:,.0f}")


def _staggering(results, paper, program):
    found = []  # of each series: the first interval's share, the later ones' median
    for series in results.series:
        run = results.by_key.get(series.get("run"))
        columns, rows = series.get("columns"), series.get("rows")
        if not run or run.program != program or not isinstance(columns, list) or "fetch_refused" not in columns or not isinstance(rows, list):
            continue
        place = columns.index("fetch_refused")
        shares = [number(row[place]) for row in rows if isinstance(row, list) and len(row) > place]
        shares = [share for share in shares if share is not None]
        if len(shares) >= 8:
            found.append((shares[0], median(shares[len(shares) // 8:-len(shares) // 8])))
    if not found:
        return UNKNOWN, "not measured"
    first, later = mean(first for first, _ in found), mean(later for _, later in found)
    text = f"{100 * first:.1f} % of fetches in the first interval, {100 * later:.1f} % later (median)"
    if len(found) > 1:
        text += f"; means of {len(found)} runs"
    return _judged(later < first, text)


_CLAIMS = [
    ("Table 2: rays per second", "each of the 60 cells within 10 %", "1.41 to 32.5 MRPS", _within),
    ("Speed-up from 1x32", "within 10 % of the paper's, for conference, crytek and the fourth scene, on each chip", "up to 13.1 times", _scaling),
    ("The dragon stops scaling at 128 threads at 8 GB/s", "no larger chip has 1.1 times the rays of 4x32", "6.18 MRPS at 4x32, 5.68 to 6.07 above", _saturation),
    ("The dragon gains from 16 GB/s", "at least 1.6 times on 8x32", "1.77 times", _bandwidth),
    ("Against MRTP, scaled to 65 nm and 500 MHz", "within 10 %: dragon on 4x32", "12 times by the paper's figures; it says 13", _mrtp),
    ("Frames per second at 1280x720", "within 10 %: dragon on 4x32, the scene that gives the paper's figure", "3.4", _frames),
    ("Adds and multiplications a ray", "within 10 %: mean of the scenes on 4x32", "about 1,300 (Table 1 over Table 2)", _flops),
    ("Power of 4x32", "within 25 %: the paper calls its own a rough estimate", "4 W", _power),
    ("Threads stagger: instruction-bank conflicts are frequent at first", "of the instructions asked for, the share that a conflict refuses in the first interval is above the later ones' median", "described, no figures", _staggering),
]


def claims(results, paper, programs):
    return [Claim(title, rule, published, {program: judge(results, paper, program) for program in programs}) for title, rule, published, judge in _CLAIMS]
