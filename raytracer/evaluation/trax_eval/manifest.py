"""What trax-render --prepare writes (docs/manifest.md)."""

import json
import pathlib

NAME = "manifest.json"


def read_manifest(folder):
    return json.loads(pathlib.Path(folder, NAME).read_text())


def buffer_options(manifest):
    """The buffers as options of trax-sim, relative to the folder: for files that were changed after they were prepared."""
    options = []
    for buffer in manifest["buffers"]:
        if "bytes_per_thread" in buffer:
            raise ValueError(f"the buffer {buffer['symbol']} depends on the machine")
        options += ["--bind", f"{buffer['symbol']}={buffer['file']}"] if "file" in buffer else ["--alloc", f"{buffer['symbol']}={buffer['bytes']}"]
    return options
