"""The part that mutants.py here and in extreme share: a changed copy of the device program."""

import shutil

from mutation import ROOT

DEVICE = ROOT / "raytracer/device"


def changed_copy(folder, tests, mutant):
    """Gives the folder raytracer/device, changed as the mutant says, and the folder tests of the tree."""
    for part in ("raytracer/device", "raytracer/layouts", tests):
        shutil.rmtree(folder / part, ignore_errors=True)
        shutil.copytree(ROOT / part, folder / part)
    (folder / "raytracer/device" / mutant.file).write_text(mutant.changed(DEVICE))


def first_in(folder):
    """Options of a compiler that includes "layouts/..." from the copy."""
    return "-iquote", folder / "raytracer"
