"""The hash of the sources of a checkpoint's state changes with the order of an enumeration, and only with contents.

  sources_test.py SOURCE, the tree"""

import pathlib
import shutil
import subprocess
import sys
import tempfile

FOLDER = pathlib.Path(sys.argv[1], "emulator")


def hash_of(folder):
    sources = ",".join(str(path) for path in sorted(folder.glob("*/**/*.h")))
    words = ["-D", f"OUTPUT={folder}/out.h", "-D", f"SOURCES={sources}", "-P", FOLDER / "engine/state_sources.cmake"]
    subprocess.run(["cmake", *words], check=True)
    return (folder / "out.h").read_text()


def main():
    with tempfile.TemporaryDirectory() as name:
        copy = pathlib.Path(name)
        for room in ("machine", "fast", "engine", "dram", "calls"):
            for header in (FOLDER / room).rglob("*.h"):
                (copy / header.relative_to(FOLDER)).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(header, copy / header.relative_to(FOLDER))
        first = hash_of(copy)
        if hash_of(copy) != first:
            return print("the same sources have another hash") or 1
        header = copy / "machine/address_space.h"
        text = header.read_text()
        swapped = text.replace("TRAX_PERMIT_READ = 1, TRAX_PERMIT_WRITE = 2",
                               "TRAX_PERMIT_READ = 2, TRAX_PERMIT_WRITE = 1")
        header.write_text(swapped)
        if swapped == text or hash_of(copy) == first:
            return print("another order of an enumeration has the same hash") or 1
    return 0


sys.exit(main())
