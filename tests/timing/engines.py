"""Runs of trax-sim and trax-render in several engines, and what differs between two of them."""

import dataclasses
import json
import os
import subprocess

HOST = ("host_seconds", "instructions_per_host_second")  # what depends on the host


@dataclasses.dataclass
class Run:
    """What a run left behind: exit status, both outputs, statistics and the bytes of files."""

    status: int
    output: bytes
    errors: bytes
    statistics: dict
    files: dict
    host_seconds: float = 0.0


def run(command, engine, folder, files=(), seconds=3600, extra=()):
    """Run the command with its files and statistics in folder/engine, and read them."""
    place = os.path.join(folder, engine)
    os.makedirs(place, exist_ok=True)
    for name in (*files, "statistics.json"):
        if os.path.exists(os.path.join(place, name)):
            os.remove(os.path.join(place, name))
    done = subprocess.run([*command, "--engine", engine.partition("-")[0], "--stats", "statistics.json", *extra],
                          cwd=place, capture_output=True,
                          timeout=seconds, check=False)
    statistics = {}
    if os.path.exists(os.path.join(place, "statistics.json")):
        with open(os.path.join(place, "statistics.json"), encoding="utf-8") as file:
            statistics = json.load(file)
    contents = {}
    for name in files:
        if os.path.exists(os.path.join(place, name)):
            with open(os.path.join(place, name), "rb") as file:
                contents[name] = file.read()
    host_seconds = statistics.get("host_seconds", 0.0)
    for name in HOST:
        statistics.pop(name, None)
    return Run(done.returncode, done.stdout, done.stderr, statistics, contents, host_seconds)


def find_difference(a, b, path=""):
    """Return where two values of JSON differ first, or None."""
    if isinstance(a, dict) and isinstance(b, dict):
        for name in sorted(a.keys() | b.keys()):
            if name not in a or name not in b:
                return f"{path}{name} is in one only"
            found = find_difference(a[name], b[name], f"{path}{name}.")
            if found:
                return found
        return None
    if isinstance(a, list) and isinstance(b, list) and len(a) == len(b):
        for i, (x, y) in enumerate(zip(a, b)):
            found = find_difference(x, y, f"{path}{i}.")
            if found:
                return found
        return None
    return None if a == b else f"{path.rstrip('.')}: {a} and {b}"


def difference(a, b):
    """Return in words how two runs differ, or None."""
    if a.status != b.status:
        return f"exit status {a.status} and {b.status}: {(a.errors + b.errors).decode(errors='replace')[:300]}"
    for name in ("output", "errors"):
        if getattr(a, name) != getattr(b, name):
            return f"standard {name}: {getattr(a, name)[:200]} and {getattr(b, name)[:200]}"
    for name in sorted(a.files.keys() | b.files.keys()):
        if a.files.get(name) != b.files.get(name):
            return f"{name} differs"
    return find_difference(a.statistics, b.statistics)


def violation(one):
    """Return in words what docs/timing.md promises of every run and this one breaks, or None."""
    if not one.statistics:
        return f"no statistics: {one.errors.decode(errors='replace')[:300]}"
    identity = one.statistics["identity"]
    if not identity["holds"] or identity["cause_sum"] != identity["thread_cycles"]:
        return f"identity: {identity}"
    clock = one.statistics["configuration"]["chip"]["clock_mhz"] * 1e6
    gbps = one.statistics["memory"]["bytes"] / max(one.statistics["cycles"], 1) * clock / 1e9
    memory, dram = (one.statistics["configuration"][section] for section in ("memory", "dram"))
    allowed = memory["bandwidth_gbps"] if memory[
        "model"] == "limit" else dram["mtps"] * dram["bus_bits"] / 8 * memory["channels"] / 1e3
    if one.status == 0 and gbps > allowed * (1 + 1e-12):
        return f"{gbps} GB/s of {allowed}"
    return None
