"""Estimates the time of a command's missing runs from that of its finished ones."""

from .finished import is_intact
from .util import Problem, read_sealed


def _seconds(out, key):
    try:
        value = read_sealed(out / "runs" / f"{key}.host.json").get("processor_seconds")
    except (Problem, OSError):
        return None
    return value if isinstance(value, (int, float)) else None


def _likeness(point):
    """Groups of runs that take about as long, the most alike first."""
    return ((point.program.name, point.workload, point.chip, point.size, point.mode),
            (point.program.name, point.workload, point.size, point.mode), (point.size, point.mode))


def estimate(out, plans):
    """(seconds of a processor, how many finished runs say so); None if there is none that is alike. plans: of (sweep,
    point -> (key, reason))."""
    known, finished, missing = {}, set(), {}
    for _, keys in plans:
        for point, (key, _) in keys.items():
            seconds = _seconds(out, key) if key and key not in finished and is_intact(out, key) else None
            if seconds is not None:
                finished.add(key)
                for group in _likeness(point):
                    known.setdefault(group, []).append(seconds)
            elif key and key not in finished:
                missing[key] = point
    total = 0
    for point in missing.values():
        times = next((known[group] for group in _likeness(point) if group in known), None)
        if times is None:
            return None
        total += sum(times) / len(times)
    return (total, len(finished)) if missing else None
