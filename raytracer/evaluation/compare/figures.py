"""The figures of runs: units and meanings, as trax-sim --help-stats has them, and the sections of a comparison."""

import functools
import re
import subprocess

# (section, title, what orders its rows: by their difference, or relative to the values; is it shown without --all)
SECTIONS = (
    ("work", "Work", "relative", True),
    ("run", "The run", "relative", True),
    ("units", "Units", "relative", True),
    ("caches", "Caches", "relative", True),
    ("memory", "Memory", "relative", True),
    ("energy", "Energy", "difference", True),
    ("instructions", "Instructions by unit", "difference", True),
    ("operations", "Instructions by operation", "difference", True),
    ("shares", "Causes in per cent of the thread-cycles", "difference", False),
    ("parts", "Single TMs, TPs and channels", "relative", False),
    ("other", "Other members", "relative", False),
)

# Places by the first part of a figure's name. Units have theirs from their figures; all other figures are the run's.
PLACES = {
    "rays": "work", "rays_by_kind": "work", "items": "work", "flops": "work",
    "icache": "caches", "dcache": "caches", "l2": "caches", "local": "caches",
    "memory": "memory", "dram": "memory", "nontemporal": "memory", "stores": "memory", "atomics": "memory",
    "fences": "memory", "energy": "energy", "instructions_by_unit": "instructions",
    "instructions_by_operation": "operations", "cause_percent": "shares", "tms": "parts", "channels": "parts",
    "fault": "other", "identity": "other", "sampled": "other", "trax_sim": "other", "program": "other",
    "status": "other", "partial": "other", "exit_status": "other",
}


class Figures:
    """unit(name) and meaning(name) of a figure."""
    def __init__(self, tools):
        text = subprocess.run([tools.path("trax-sim"), "--help-stats"], capture_output=True, text=True,
                              check=True).stdout
        rows = re.findall(r"^([\w.<>]+) +(\S.*?)  +(\S.*)$", text, re.MULTILINE)
        self.rows = {name: (unit, meaning) for name, unit, meaning in rows}
        names = {name.rpartition(".")[::2] for name in self.rows}
        self.units = {head for head, last in names if last == "utilisation" and (head, "operations") in names}

    @functools.lru_cache(maxsize=None)
    def row(self, name):
        head, _, last = name.partition(".")
        if head == "cause_percent":
            return self.rows.get("cause_percent.<cause>", ("",))[0], self.rows.get(f"causes.{last}", ("", ""))[1]
        if head == "instructions_by_operation":
            return self.rows.get("instructions_by_operation.<op>", ("",))[0], last
        return self.rows.get(name, ("", ""))

    def unit(self, name):
        return self.row(name)[0]

    def meaning(self, name):
        return self.row(name)[1]

    def section(self, name):
        head = name.partition(".")[0]
        return "units" if head in self.units else PLACES.get(head, "run")
