#!/usr/bin/env python3
"""ray_orders_test.py --bin BIN: sweeps whose workloads trace the rays of one kind again. Their runs are those of
trax-render --rays on these rays, in each order; and what they cannot do is an error with its place."""
import argparse
import json
import pathlib
import subprocess
import sys

parser = argparse.ArgumentParser()
parser.add_argument("--bin", type=pathlib.Path, required=True)
BIN = parser.parse_args().bin.resolve()
sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
import checking  # noqa: E402
from checking import check  # noqa: E402

BUNNY, ORDERS, KINDS = "/usr/share/glmark2/models/bunny.obj", ("found", "treelet"), {"primary": 0, "diffuse": 3}
CACHE = 4096  # bytes, which decide on the treelets and on the order of nodes
SWEEP = {
    "name": "orders", "scenes": [{"name": "bunny", "meshes": [BUNNY], "view": "bunny"}], "programs": "ours",
    "chips": ["1x32"], "workloads": ["primary-alone", "diffuse-alone"], "size": "48x27",
    "set": {"trax-render --ray-order": list(ORDERS), "dcache.bytes": CACHE}
}


def run(*words):
    return subprocess.run([str(word) for word in words], capture_output=True, text=True)


def swept():
    """(kind, order): (rays, cycles)"""
    pathlib.Path("orders.json").write_text(json.dumps(SWEEP))
    done = run(BIN / "trax-eval", "orders.json", "-o", "out", "--quiet")
    check(done.returncode == 0, "the sweep:", done.stderr)
    found = {}
    for one in json.loads(pathlib.Path("out/results.json").read_text())["runs"]:
        changes = one["points"][0]["set"]
        kind, order = one["workload"].partition("-")[0], changes["trax-render --ray-order"]
        found[kind, order] = one["stats"]["items"], one["stats"]["cycles"]
        check(one["picture"] is None, "a run without a picture:", one["picture"])
    return found


def direct():
    run(BIN / "trax-render", BUNNY, "--view", "bunny", "--size", "48x27", "--paths", "4", "--engine", "native",
        "--ray-trace", "all.bin", "-q")
    data, found = pathlib.Path("all.bin").read_bytes(), {}
    for kind, number in KINDS.items():
        rays = [data[at:at + 64] for at in range(32, len(data), 64) if data[at + 38] == number]
        pathlib.Path("kind.bin").write_bytes(data[:32] + b"".join(rays))
        for order in ORDERS:
            done = run(BIN / "trax-render", BUNNY, "--rays", "kind.bin", "--ray-order", order, "--config", "1x32",
                       "--set", f"dcache.bytes={CACHE}", "--stats", "s.json", "-q")
            check(done.returncode == 0, "trax-render --rays:", done.stderr)
            found[kind, order] = len(rays), json.loads(pathlib.Path("s.json").read_text())["cycles"]
    return found


def errors():
    for changes, message in (
            ({"workloads": ["primary-shadow"]}, "set: --ray-order needs workloads with"),
            ({"ray_kinds": True}, '"primary-alone" traces rays of one kind again'),
            ({"mode": "quick"}, 'workloads with "rays"'),
            ({"workloads": ["mine.json"]}, 'mine.json: rays: allowed are primary, shadow')):
        pathlib.Path("mine.json").write_text('{"name": "mine", "rays": "light"}')
        pathlib.Path("wrong.json").write_text(json.dumps(SWEEP | changes))
        done = run(BIN / "trax-eval", "wrong.json", "-o", "wrong", "--quiet")
        check(done.returncode == 1 and message in done.stderr, changes, done.returncode, done.stderr)
    pathlib.Path("mine.json").write_text('{"name": "mine", "rays": "glass"}')
    pathlib.Path("wrong.json").write_text(json.dumps(SWEEP | {"workloads": ["mine.json"]}))
    done = run(BIN / "trax-eval", "wrong.json", "-o", "none", "--quiet")
    check(done.returncode == 1 and "has no rays of kind glass" in done.stderr, "no such rays:", done.stderr)


def orders():
    one, other = swept(), direct()
    check(one == other, "sweep and trax-render --rays:", one, other)
    check(len(set(other.values())) == 4, "orders make no difference:", other)


sys.exit(checking.run(orders, errors))
