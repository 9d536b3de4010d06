#!/usr/bin/env python3
"""rays_test.py BIN: rays by kind, programs that count each ray where it begins, and ambient occlusion."""
import csv
import functools
import json
import math
import os
import pathlib
import re
import shutil
import struct
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import checking  # noqa: E402
from checking import check  # noqa: E402

BIN, SOURCE = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(__file__).resolve().parent
KINDS = ["primary", "shadow", "occlusion", "diffuse", "glossy", "mirror", "glass", "other"]
SIZE, PIXELS = "25x15", 25 * 15
call = functools.partial(checking.call, BIN)


def render(*words):
    """(statistics, the picture's bytes)"""
    call("trax-render", *words, "--config", "1x32", "--size", SIZE, "--quiet", "--stats", "s.json", "-o", "p.png")
    return json.loads(pathlib.Path("s.json").read_text()), pathlib.Path("p.png").read_bytes()


def present(stats):
    check(
        sum(stats["rays_by_kind"].values()) == stats["rays"], "kinds do not add up to", stats["rays"],
        stats["rays_by_kind"])
    return {kind for kind in KINDS if stats["rays_by_kind"][kind]}


def count_kinds():
    """Pictures have these kinds by the program for one picture, by the one for all, and natively."""
    cases = [
        ([], {"primary", "shadow"}, 1),
        (["--no-shadows"], {"primary"}, 1),
        (["--samples", "3"], {"primary", "shadow"}, 3),
        (["--occlusion", "5"], {"primary", "shadow", "occlusion"}, 1),
        (["--paths", "1"], {"primary", "shadow", "diffuse"}, 1),
        (["--paths", "4", "--no-shadows"], {"primary", "diffuse"}, 1),
        (["--material", "mirror"], {"primary", "mirror"}, 1),
        (["--material", "glass:1.5"], {"primary", "mirror", "glass"}, 1),
        (["--material", "ggx:0.3", "--paths", "3"], {"primary", "shadow", "glossy"}, 1),
    ]
    for words, expected, samples in cases:
        stats, picture = render("box.obj", *words)
        check(present(stats) == expected, words, "has", present(stats), "not", expected)
        kinds = stats["rays_by_kind"]
        check(kinds["primary"] == PIXELS * samples, words, "primary rays", kinds["primary"])
        general, same = render("box.obj", *words, "--no-specialise")
        check(general["rays_by_kind"] == kinds and same == picture, words, "in general", general["rays_by_kind"], "not",
              kinds)
        native = call("trax-render", "box.obj", *words, "--size", SIZE, "--engine", "native", "-o", "n.png").stdout
        check(re.search(rf"^rays +{stats['rays']} ", native, re.M), words, "natively", native)
        if "--occlusion" in words:  # flat surfaces: each that is seen sends all of them
            plain, _ = render("box.obj")
            check(
                kinds["shadow"] == plain["rays_by_kind"]["shadow"] and kinds["occlusion"] % 5 == 0 and
                kinds["occlusion"] >= 5 * kinds["shadow"], kinds)


def mark_rays():
    """The paper's workload counts a pixel's rays with one instruction, as ever; with --mark-rays each where it
    begins."""
    for words in ([], ["--samples", "3"], ["--smooth", "--normals", "smooth"], ["--no-shadows"]):
        plain, picture = render("box.obj", *words)
        marked, same = render("box.obj", *words, "--mark-rays")
        samples = 3 if "--samples" in words else 1
        traps = [stats["instructions_by_operation"]["trap"] for stats in (plain, marked)]
        check(traps == [PIXELS * (samples + 1), PIXELS + plain["rays"]], words, "traps", traps)
        check(same == picture and marked["rays_by_kind"] == plain["rays_by_kind"], words,
              "the marked program has another picture, or rays")
        # A trap a ray, and what registers for it cost: 2.6 % where each pixel has one ray.
        check(
            abs(marked["instructions"] / plain["instructions"] - 1) < 0.03, words, marked["instructions"],
            plain["instructions"])
    for words, least, most in ((["--mark-rays"], 0.05, 0.3), ([], 0.9, 1)):
        call("trax-render", "box.obj", *words, "--size", SIZE, "--config", "1x32", "--prepare", "run", "--quiet")
        call("trax-sim", "run/manifest.json", "--quiet", "--ray-kinds", "kinds.csv")
        rows = {row["kind"]: row for row in csv.DictReader(open("kinds.csv"))}
        share = int(rows["none"]["issued"]) / int(rows["all"]["issued"])
        check(least < share < most, words, "the share of what is done for no ray", share)
        check((int(rows["shadow"]["issued"]) > 0) == bool(words), "shadow rays", rows["shadow"]["issued"])


def read_pixel(path):
    """The first pixel of a colour PFM."""
    data = path.read_bytes()
    return struct.unpack("<3f", data[data.index(b"-1") :].split(b"\n", 1)[1][:12])


def corner_occlusion():
    """A wall blocks those rays from a floor that reach it. The directions are distributed by the cosine, so their
    shadows on the floor are evenly spread over a disk."""
    pathlib.Path("corner.obj").write_text("v -100 0 -100\nv 100 0 -100\nv 100 0 100\nv -100 0 100\nf 1 2 3 4\n"
                                          "v 0 0 -100\nv 0 100 -100\nv 0 100 100\nv 0 0 100\nf 5 6 7 8\n")
    diagonal = math.sqrt(200**2 + 100**2 + 200**2)
    for distance, reach in ((0.5, 0.1), (9, 0.04), (9, 0.1), (50, 0.1)):
        words = ["corner.obj", "--eye", f"{distance},50,0", "--look-at", f"{distance},0,0", "--up", "0,0,-1", "--fov",
                 "0.01", "--light", f"{distance},60,0", "--size", "1x1", "--ambient", "1", "--engine", "native",
                 "--quiet", "--samples", "16"]
        call("trax-render", *words, "-o", "open.pfm")
        call("trax-render", *words, "--occlusion", "64", "--occlusion-reach", reach, "-o", "occluded.pfm")
        ratio = read_pixel(pathlib.Path("occluded.pfm"))[0] / read_pixel(pathlib.Path("open.pfm"))[0]
        a = min(1, distance / (reach * diagonal))
        expected = 0.5 + (a * math.sqrt(1 - a * a) + math.asin(a)) / math.pi
        check(abs(ratio - expected) < 0.01, "at", distance, "reach", reach, "open", ratio, "not", expected)


def compare_occlusion():
    """Pictures with everything else that they may have are the same bits by all three programs."""
    for parts, words in ((0, []), (63, ["--samples", "4", "--smooth"]),
                         (63, ["--one-sided", "--float", "--seed", "7"])):
        call("../tests/bin/render-gallery", "made", parts)
        words = [
            "made/gallery.trax", *words, "--occlusion", "4", "--ambient", "0.6", "--occlusion-reach", "0.3", "--size",
            "24x17", "--config", "1x32"
        ]
        result = call("trax-render", *words, "--compare", "-o", "x.png")
        check(re.search("^twin        identical in every bit$", result.stdout, re.M), parts, words, result.stdout)
        call("trax-render", *words, "--no-specialise", "-o", "y.png")
        call("trax-compare", "-q", "x.png", "y.png")
    first = render("box.obj", "--occlusion", "5", "--no-specialise")[1]
    other = render("box.obj", "--occlusion", "5", "--no-specialise", "--seed", "9")[1]
    check(first != other, "another seed has the same noise")
    check(first != render("box.obj")[1], "occlusion changes nothing")


def refusals():
    for words, reason in (("--occlusion 65", "64"), ("--occlusion 0", "1 to 64"),
                          ("--occlusion 2 --paths 2", "--paths"), ("--occlusion 2 --no-shadows", "--no-shadows"),
                          ("--occlusion 64 --samples 1025", "65536 points"),
                          ("--occlusion-reach 0.5", "without --occlusion"),
                          ("--occlusion 2 --occlusion-reach 1.5", "above 0 to 1"), ("--seed 3", "--occlusion"),
                          ("--mark-rays --no-specialise", "--no-specialise"),
                          ("--mark-rays --engine native", "emulator"), ("--mark-rays --program box.obj", "--program")):
        result = call("trax-render", "box.obj", *words.split(), "-o", "no.png", status=1)
        check(reason in result.stderr and not os.path.exists("no.png"), words, result.stderr)


def copy_box():
    for name in ("box.obj", "box.mtl"):
        shutil.copy(SOURCE / name, name)


sys.exit(checking.run(copy_box, count_kinds, mark_rays, corner_occlusion, compare_occlusion, refusals))
