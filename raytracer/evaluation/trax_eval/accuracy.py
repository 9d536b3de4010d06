"""The error of a run's picture, by three pictures with layers: the program's, the exact one of the same rays, and the
exact one of so many rays that it has converged. trax-compare judges them."""

import fcntl
import json
import os
import pathlib

from .pictures import png
from .tools import run_tool
from .util import Problem, hash_file, hash_value, remark, write_file

CONVERGED_SAMPLES = 1024
MOST_CHANGED = 0.001  # of the pixels: the program that records must render the same picture


def measure_error(tools, out, inputs, job, scratch, render, run):
    """The figures `error`. render: trax-render on the job's inputs; run(program, command) runs a command."""
    picture = job["inputs"]["picture"]
    measured, recorded, exact = (f"{scratch}/{name}" for name in ("measured.png", "recorded.exr", "exact.exr"))
    exactly = [tools.path("trax-render"), str(inputs / "whole.trax"), "--view", str(inputs / "picture.view"), "--size",
               "{width}x{height}".format_map(picture), "--quiet", "--engine", "exact", "--layers",
               *job["inputs"]["whole"]["options"]]
    write_file(pathlib.Path(measured), png(picture, pathlib.Path(scratch, "image.raw").read_bytes()))
    run("trax-render", [*render, "--layers", "-o", recorded])
    run("trax-render", [*exactly, "-o", exact])
    converged = converge(out, job, scratch, exactly, run)
    changed = compare(tools, measured, recorded, "--within", "1")["beyond"]
    if changed > MOST_CHANGED * picture["width"] * picture["height"]:
        raise Problem(f"{changed} pixels of the program that records are not those of the program that was measured")
    numerical = compare(tools, recorded, exact)
    return {"numerical_rmse": numerical["floats_rmse"], "numerical_largest": numerical["floats_largest"],
            **{name: numerical[name] for name in ("wrong_pixels", "missed", "grown", "other", "tied", "wrong_shadows")},
            "recorded_differently": changed, "sampling_rmse": compare(tools, exact, converged)["floats_rmse"],
            "total_rmse": compare(tools, recorded, converged)["floats_rmse"], "converged_samples": CONVERGED_SAMPLES}


def converge(out, job, scratch, exactly, run):
    """The converged picture, which runs with the same scene and view share. One process renders it, others wait. Its
    hash stands beside it."""
    folder = out / "converged"
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{hash_value([job['renderer'], job['inputs']['whole'], job['inputs']['picture']])}.exr"
    digest = path.with_suffix(".hash")
    with open(folder / "lock", "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if path.exists() and not (digest.exists() and digest.read_text(errors="replace") == hash_file(path)):
            remark(f"{path}: is damaged; it is made anew")
            path.unlink()
        if not path.exists():
            unfinished = f"{scratch}/converged.exr"
            run("trax-render", [*exactly, "--samples", str(CONVERGED_SAMPLES), "-o", unfinished])
            write_file(digest, hash_file(unfinished))
            os.replace(unfinished, path)
    return str(path)


def compare(tools, picture, right, *options):
    done = run_tool([tools.path("trax-compare"), "--json", picture, right, "--at-least", "0", *options])
    if done.returncode != 0:
        raise Problem(done.stderr.strip() or f"trax-compare ended with status {done.returncode}")
    return json.loads(done.stdout)
