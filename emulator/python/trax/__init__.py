"""The emulator of the TRaX accelerator for Python.

    import trax
    manifest = trax.prepare("bunny.ply", folder="bunny", size=(320, 180))
    run = trax.Machine(manifest, "4x32", {"memory.bandwidth_gbps": 16}).run()
    print(run.cycles, run["mrps"])
    run.picture.save("bunny.png")
    table = trax.sweep(manifest, chips=["1x32", "4x32"], settings={"memory.latency_cycles": [100, 200]})
"""

from ._library import Fault, Interrupted, Stuck, TraxError
from .config import Config, describe_keys, presets
from .machine import Machine, Run
from .picture import Picture
from .sweep import results, sweep, table
from .tools import compile, prepare, tool

__all__ = [
    "Config", "Fault", "Interrupted", "Machine", "Picture", "Run", "Stuck", "TraxError", "compile", "describe_keys",
    "prepare", "presets", "results", "sweep", "table", "tool"
]
