"""How cheap a new tree must be so that it pays, of runs whose trees are refitted (trax-scene --refit-from)."""

AT, FROM = "trax-scene --at", "trax-scene --refit-from"
NAME = "rebuild_pays_below"  # a figure: cycles


def moment(value):
    """A number, or one in a text as C reads it; None: it is none."""
    try:
        text = str(value).lower()
        return float.fromhex(text) if "0x" in text else float(text)
    except (ValueError, OverflowError):
        return None


def add_rebuilding(plans, runs):
    """A refitted tree of age n, in runs of the sweep, takes x_n cycles more than a new one, the sweep's reference. If
    every n-th frame has a new tree, which costs R, a frame loses (R + x_1 + ... + x_(n-1)) / n. Another frame with the
    old tree makes that more if R is below n x_n - (x_1 + ... + x_(n-1)). A run without a new tree of its moment, and
    later ones, have no figure. runs: records, by key."""
    series = {}
    for plan in plans:
        known = {(point["key"], moment(point["set"].get(AT))) for point in plan["points"]}
        for point in plan["points"]:
            now, begin = moment(point["set"].get(AT)), moment(point["set"].get(FROM))
            if None in (now, begin):
                continue
            pair = [runs.get(point["key"]), runs.get(point.get("reference"))]
            complete = all(run and run["status"] == "done" for run in pair) and (point["reference"], now) in known
            same = [(name, value) for name, value in point.items()
                    if name in ("scene", "program", "config", "size", "mode", "workload", "variant")]
            rest = [item for item in point["set"].items() if item[0] != AT]
            series.setdefault(repr((plan["name"], same, rest)), {})[abs(now - begin)] = pair if complete else None
    for ages in series.values():
        before = 0
        for age, distance in enumerate(sorted(distance for distance in ages if distance), 1):
            if not ages[distance]:
                break
            run, new = ages[distance]
            more = run["stats"]["cycles"] - new["stats"]["cycles"]
            if run is not new:
                run["values"][NAME] = age * more - before
            before += more
