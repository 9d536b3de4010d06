"""Results as trax-eval writes them, made up: figures follow from a formula, so that a test knows what the page must
show."""

import itertools
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from png_files import png_of  # noqa: E402

CHIPS = [
    "1x32", "1x48", "2x32", "1x64", "2x48", "4x32", "2x64", "6x32", "4x48", "8x32", "4x64", "6x48", "8x48", "6x64",
    "8x64"
]
SCENES = ["conference", "crytek-sponza", "dragon", "forest"]
CAUSES = {
    "issued": 40, "icache_bank_conflict": 11, "icache_miss": 2, "wait_memory": 17, "wait_special": 3, "wait_atomic": 1,
    "fp_add_conflict": 9, "fp_mul_conflict": 6, "special_conflict": 2, "dcache_bank_conflict": 4, "branch_bubble": 1,
    "halted": 4, "wait_local": 0, "memory_queue_full": 0
}


def threads(chip):
    tms, tps = chip.split("x")
    return int(tms) * int(tps)


def mrps(program, scene, chip, bandwidth=8.0):
    """Grows with the threads; the dragon is limited by the bandwidth."""
    rate = (0.061 if program == "era" else 0.097) * threads(chip)**0.97 * (1 - 0.2 * SCENES.index(scene)
                                                                           if scene in SCENES else 1)
    return min(rate, 0.72 * bandwidth) if scene == "dragon" else rate


def run(program, scene, chip, changes=None, mode="exact", experiments=("table2", ), host=20.0, value=None):
    changes = dict(changes or {})
    rate = mrps(program, scene, chip, changes.get("memory.bandwidth_gbps", 8.0)) if value is None else value
    rays, total = 1_800_000, threads(chip) * 90_000_000
    cycles = round(rays * 500 / rate)
    key = f"{program}-{scene}-{chip}-{mode}-{len(changes)}{''.join(str(v) for v in changes.values())}"
    record = {
        "key": key,
        "experiments": list(experiments),
        "scene": scene,
        "view": scene,
        "size": [1280, 720],
        "program": program,
        "config": chip,
        "set": changes,
        "machine": {**({"fpu.compare_units": True} if program == "era" else {}), **changes},
        "mode": mode,
        "status": "done",
        "command": f"trax-render {scene}.ply --config {chip} -o picture.png",
        "json": f"runs/{key}.json",
        "csv": None,
        "picture": f"pictures/{scene}.png",
        "host_seconds": host,
        "stats": {
            "cycles": cycles, "seconds": cycles / 5e8, "threads": threads(chip), "thread_cycles": total, "rays": rays,
            "mrps": rate, "gflops": 1.3 * rate, "peak_gflops": threads(chip) / 8, "area_mm2": 0.06 * threads(chip),
            "flops": 1300 * rays, "memory": {"bytes": 700 * rays, "utilisation": min(0.99, rate / 20)},
            "fp_add": {"utilisation": 0.6}, "fp_mul": {"utilisation": 0.5}, "special": {"utilisation": 0.2},
            "issue": {"utilisation": 0.4}, "dcache": {"hit_rate": 0.93}, "energy": {"average_power": 2.1},
            "causes": {name: total * share // 100 for name, share in CAUSES.items()}, "configuration": {
                "chip": {"tms": int(chip[0]), "tps_per_tm": int(chip[2:]), "clock_mhz": 500},
                "memory": {"bandwidth_gbps": 8.0, "channels": 1}, "fpu": {"tps_per_cluster": 8}
            }
        },
        "values": {},
    }
    for name, setting in changes.items():
        section, name = name.split(".")
        record["stats"]["configuration"].setdefault(section, {})[name] = setting
    if mode == "quick":
        record["stats"]["sampled"] = {"cycles_low": cycles * 0.98, "cycles_high": cycles * 1.02}
    return record


PAPERS = {"conference": "conference", "crytek-sponza": "crytek", "dragon": "dragon", "forest": "fairy",
          "dragon-close": "dragon"}  # what scenes stand for


def document(runs, sweeps=(), series=()):
    programs = sorted({one["program"] for one in runs if isinstance(one.get("program"), str)})
    return {
        "programs": [{"name": name} for name in programs],
        "scenes": [{"name": name, "paper": paper} for name, paper in PAPERS.items()],
        "format": "trax-eval-results", "version": 2, "trax": "0.1.0", "command": "trax-eval --all -o out/eval",
        "created": "2026-01-01T00:00:00Z", "host": {"processors": 2, "model": "any"}, "host_seconds": 3600.0,
        "runs": list(runs), "sweeps": list(sweeps), "series": list(series)
    }


def complete():
    runs = [run(program, scene, chip) for program in ("era", "ours") for scene in SCENES for chip in CHIPS]
    runs += [
        run(program, scene, chip, {"memory.bandwidth_gbps": 16.0}, experiments=("table3", ))
        for program in ("era", "ours") for scene in SCENES for chip in ("8x32", "8x48", "8x64")
    ]
    runs += [
        run("ours", scene, "4x32", mode="quick", host=3.0,
            value=mrps("ours", scene, "4x32") * {"dragon": 1.05, "forest": 0.95}.get(scene, 1.01)) for scene in SCENES
    ]
    runs += [
        run("ours", scene, "4x32", {"fpu.tps_per_cluster": n}, experiments=("fpu-sharing", ),
            value=mrps("ours", scene, "4x32") / (1 + n / 32)) for scene in ("conference", "dragon")
        for n in (1, 2, 4, 8, 16)
    ]
    runs.append(run("era", "conference", "4x32", {"fpu.compare_units": False}, experiments=("compare-units", )))
    runs.append(run("ours", "dragon", "4x32", experiments=("size", )))
    runs[-1].update(key="small", size=[160, 90], values={"frames_per_second": 3})
    sweeps = [{"name": "size", "x": "threads", "y": "values.frames_per_second"},
              {"name": "table2", "title": "Table 2", "x": "threads", "y": "mrps"}, {
                  "name": "fpu-sharing", "title": "TPs that share an FPU", "x": "fpu.tps_per_cluster", "y": "mrps",
                  "claim": "Eight are sufficient.", "file": "sweeps/fpu.json"
              }, {
                  "name": "fpu-density", "title": "The same for each mm²", "x": "fpu.tps_per_cluster", "y": "mrps",
                  "y_per": "area_mm2"
              }]
    for record in runs[-7:-2]:
        record["experiments"].append("fpu-density")
    rows = [[10_000 * (n + 1), 0.4 / (1 + n) + 0.05, 0.3 + 0.002 * n] for n in range(100)]
    series = [{
        "name": "staggering", "title": "Instruction-bank conflicts over time", "run": "era-conference-4x32-exact-0",
        "columns": ["cycle", "fetch_refused", "issued"], "rows": rows
    }]
    return document(runs, sweeps, series)


def assertions():
    """Runs of the sweeps that show why the machine is as it is, and of the dragon's other view; ours loses nothing by
    sharing, the era program does."""
    runs = []
    for program, lost in (("ours", 0.01), ("era", 0.2)):
        for scene in SCENES:
            rate = mrps(program, scene, "4x32")
            for name, key, values in (("fpu-sharing", "fpu.tps_per_cluster", (1, 4, 8, 16)),
                                      ("icache-banks", "icache.banks", (32, 16)), ("dcache-banks",
                                                                                   "dcache.tps_per_bank", (2, 8))):
                for place, value in enumerate(values):
                    made = run(program, scene, "4x32",
                               {key: value} if value not in (8, 16) or name == "fpu-sharing" and value == 16 else {},
                               experiments=(name, ), value=rate * (1 - lost * (place > 0)))
                    section, name_of_key = key.split(".")
                    made["stats"]["configuration"].setdefault(section, {})[name_of_key] = value
                    made["stats"]["cause_percent"] = {"icache_bank_conflict": 3.5}
                    made["values"]["mrps_per_mm2"] = 10 + place
                    runs.append(made)
            for units in (1, 2):
                made = run(program, scene, "1x32",
                           {"chip.tps_per_tm": 64} | ({"special.units_per_tm": 2} if units == 2 else {}),
                           experiments=("special-unit", ), value=10 - lost * 10 * (units == 1))
                made["stats"]["configuration"]["special"] = {"units_per_tm": units, "pipelined": True}
                runs.append(made)
            for size, moved in ((16384, 700), (32768, 700 * (1.3 - lost * 10))):
                made = run(program, scene, "8x32", {"dcache.bytes": size} if size > 16384 else {},
                           experiments=("dcache-bytes", ))
                made["stats"]["configuration"]["dcache"] = {"bytes": size}
                made["values"]["bytes_per_ray"] = moved
                runs.append(made)
    for chip in CHIPS:
        runs.append(run("era", "dragon-close", chip, value=1.9 if chip == "1x32" else 6.0))
    runs.append(run("era", "dragon-close", "8x32", {"memory.bandwidth_gbps": 16.0}, value=10.5))
    for index, record in enumerate(runs):
        record["key"] = f"assertion-{index}"
    return runs


def warps(rates, efficiency=0.7):
    """Runs of the sweep `simd`: rates[workload][width] is a factor to MIMD's rays for each mm2, which are 2. A second
    program has half as many."""
    runs = []
    for workload, by_width in rates.items():
        for width, factor in {1: 1, **by_width}.items():
            for scene in SCENES:
                for program, part in (("ours", 1), ("straight", 0.5)):
                    made = run(program, scene, "1x32", {"memory.bandwidth_gbps": 2.0}, experiments=("simd", ),
                               value=6 * factor * part)
                    if width > 1:
                        made["set"] |= {"simt.width": width, "fpu.tps_per_cluster": 1}
                    made.update(workload=workload, key=f"simd-{workload}-{width}-{program}-{scene}", size=[64, 36])
                    made["values"] = {"area_units": 3, "rays.primary.count": 10, "rays.primary.mrps": 6 * factor * part}
                    made["stats"]["simt"] = {"efficiency": efficiency * part if width == 32 else 1}
                    runs.append(made)
    return runs


def stranger():
    """Version 2, as another researcher's sweep gives it: a program, scene and chip of their own, variants, kinds of
    rays, and tables that the sweep describes."""
    runs = []
    for scene_index, scene in enumerate(("cube", "dragon")):
        for chip_index, chip in enumerate(("tiny", "4x32")):
            for variant, rate in (("as it is", 10.0), ("sorted", 12.5)):
                made = run("beam", scene, "4x32", experiments=("tracing", ),
                           value=rate * (1 + chip_index) / (1 + scene_index))
                made.update(config=chip, variant=variant, workload="fog", machine={},
                            set={"trax-render --queues": 3} if variant == "sorted" else {}, picture=None)
                made["points"] = [{
                    "experiment": "tracing", "variant": variant, "config": chip, "set": made["set"], "machine": {}
                }]
                made["values"] = {"rays.none.count": 0}
                for place, kind in enumerate(("shadow", "primary")):
                    made["values"] |= {
                        f"rays.{kind}.{name}": value for name, value in {
                            "count": 100, "mrps": rate * (2 - place), "bytes_per_ray": 64 *
                            (1 + place), "energy_per_ray": 3.5, "utilisation": 0.5, "fetch": 0.2, "memory": 0.2,
                            "dcache": 0.05, "units": 0.05, "rest": 0
                        }.items()
                    }
                runs.append(made)
    table = [{"rows": ["chip", "variant"], "columns": "scene", "relative": {"variant": "as it is"}}, {
        "id": "by-kind", "title": "Kinds", "rows": "kind", "each": "chip", "mean": "scene",
        "where": {"variant": "sorted"}, "values": ["kind.mrps", "kind.fetch"]
    }]
    made = document(runs, [{
        "name": "tracing", "title": "Beams", "claim": "They are fast.", "x": "threads", "y": "mrps",
        "reference": "as it is", "variants": ["as it is", "sorted"], "table": table
    }, {"name": "plain", "x": "variant", "y": "values.bytes_per_ray"}])
    for place, record in enumerate(runs):
        record["key"] = f"beam-{place}"
        record["experiments"].append("plain")
        record["points"].append({**record["points"][0], "experiment": "plain"})
        record["values"]["bytes_per_ray"] = 100 + place
    made.update(
        programs=[{"name": "beam", "title": "Beams of a stranger"}],
        scenes=[{"name": "cube", "title": "A cube", "paper": None},
                {"name": "dragon", "title": "Dragon", "paper": "dragon"}], workloads=[{"name": "fog", "title": "Fog"}])
    return made


def own():
    """Several bandwidths on two chips; one run failed."""
    runs = []
    for chip, rate in itertools.product(("1x32", "4x32"), (4, 8, 16)):
        made = run("ours", "forest", chip, {"memory.bandwidth_gbps": rate}, experiments=("rates", ),
                   value=threads(chip) * rate / (rate + 8) / 16)
        made["values"] = {"area_units": 0.06 * threads(chip) + (rate == 8)}
        made["stats"]["energy"]["average_power"] = 2.0 + threads(chip) / 100 - rate / 50
        made["stats"]["memory"]["bandwidth_gbps"] = 1.0 + rate / 8
        runs.append(made)
    runs[2].update(status="failed", error="this program renders <no> textures", stats={}, values={})
    return document(runs, [{
        "name": "rates", "title": "What does bandwidth buy?", "claim": "Memory is the limit.",
        "x": "memory.bandwidth_gbps", "y": "mrps", "y_per": "values.area_units", "file": "mine.json"
    }])


def partial():
    """Some cells, some that failed, some that are not there yet; members that are null or absent."""
    runs = [run("ours", "conference", chip) for chip in CHIPS[:6]] + [run("ours", "dragon", "1x32")]
    runs[1].update(status="failed", error="simulation stopped: out of memory", stats=None)
    runs[2].update(status="missing", stats=None, host_seconds=None, json=None)
    del runs[3]["stats"]["memory"], runs[3]["stats"]["causes"], runs[3]["stats"]["configuration"]
    runs[4]["stats"]["mrps"] = None
    runs[5] = {"key": "bare", "status": "done", "scene": "conference", "program": "ours", "config": "4x32"}
    made = document(runs, [{"name": "nothing", "x": "memory.latency_cycles"}, {}],
                    [{"name": "none", "run": "?", "columns": ["cycle"], "rows": []}, {}])
    made.update(host=None, created=None, host_seconds=None)
    return made


HOSTILE = "</script><script>hostile()</script><img src=x onerror=hostile()>\"'&\x07"


def hostile():
    """Markup in every text, and figures that are none."""
    runs = [run("ours", "conference", "1x32"), run("ours", "conference", "4x32"), run("ours", "dragon", "1x32")]
    for record in runs[1:]:
        record.update(error=HOSTILE, command=HOSTILE, view=HOSTILE, json="javascript:" + HOSTILE, csv="../" + HOSTILE,
                      picture=HOSTILE, experiments=[HOSTILE], set={HOSTILE: HOSTILE}, key=HOSTILE, mode=HOSTILE)
    runs[2].update(scene=HOSTILE, program=HOSTILE, config=HOSTILE)
    stats = runs[1]["stats"]
    stats.update(mrps=float("nan"), gflops=float("inf"), cycles=10**400, seconds=-float("inf"), rays="many", flops=True,
                 memory=[])
    stats["configuration"] = {HOSTILE: HOSTILE, "list": [1, HOSTILE]}
    runs[1]["machine"] = {HOSTILE: HOSTILE}
    runs[1]["host_seconds"] = float("nan")
    sweep = {"name": HOSTILE, "title": HOSTILE, "x": HOSTILE, "y": HOSTILE, "claim": HOSTILE}
    series = {
        "name": HOSTILE, "title": HOSTILE, "run": HOSTILE, "columns": ["cycle", HOSTILE],
        "rows": [[1, float("nan")], [2, 0.5], [3, None], [4, 0.25], "x"]
    }
    made = document(runs, [sweep, {"name": "size"}], [series])
    made.update(trax=HOSTILE, command=HOSTILE, created=HOSTILE, host={HOSTILE: HOSTILE})
    return made


def hostile_own():
    """The hostile results without a sweep that comes with trax: the page is that of the user's sweeps."""
    made = hostile()
    made["sweeps"] = made["sweeps"][:1]
    return made


def picture(width=32, height=18):
    """A PNG file."""
    return png_of([b"".join(bytes((8 * x % 256, 14 * y % 256, 128)) for x in range(width)) for y in range(height)])
