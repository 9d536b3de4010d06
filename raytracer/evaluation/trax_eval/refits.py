"""How cheap a new tree must be so that it pays, of runs whose trees are refitted (trax-scene --refit-from)."""

AT, FROM = "trax-scene --at", "trax-scene --refit-from"
NAME = "rebuild_pays_below"  # a figure: cycles


def add_rebuilding(plans, runs):
    """A refitted tree of age n, in runs of the sweep, takes x_n cycles more than a new one, the sweep's reference. If
    every n-th frame has a new tree, which costs R, a frame loses (R + x_1 + ... + x_(n-1)) / n. Another frame with the
    old tree makes that more if R is below n x_n - (x_1 + ... + x_(n-1)). runs: records, by key."""
    series = {}
    for plan in plans:
        for point in plan["points"]:
            run, other, begin = runs.get(point["key"]), runs.get(point.get("reference")), point["set"].get(FROM)
            if begin is None or run is other or not all(one and one["status"] == "done" for one in (run, other)):
                continue
            same = [(name, value) for name, value in point.items()
                    if name in ("scene", "program", "config", "size", "mode", "workload", "variant")]
            rest = [pair for pair in point["set"].items() if pair[0] != AT]
            age = abs(float(point["set"][AT]) - float(begin))
            series.setdefault(repr((plan["name"], same, rest)), {})[age] = run, other
    for ages in series.values():
        before = 0
        for age, (_, (run, other)) in enumerate(sorted(pair for pair in ages.items() if pair[0]), 1):
            more = run["stats"]["cycles"] - other["stats"]["cycles"]
            run["values"][NAME] = age * more - before
            before += more
