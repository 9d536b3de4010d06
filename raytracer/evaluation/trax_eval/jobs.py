"""Jobs: what decides a run's result, a key made of exactly that, and the run itself.

A folder of results has
  inputs/HASH/    what programs read, as trax-render --prepare writes it; HASH is of what its manifest says of that
  inputs/bytes/   the same files by the hash of their bytes, as hard links
  jobs/KEY.json   a run to be made; KEY is the hash of this
  runs/KEY.json   its result, which is the same in every byte whenever and wherever the job is run
  runs/KEY.host.json   what the run took on the host, which is not
  runs/KEY.csv    its time series, if the job has one
  runs/KEY.error  why it failed
  pictures/HASH.png    pictures by the hash of their pixels
Every file appears complete or not at all, and runs/KEY.json last, so nothing but the runs under way is lost when
processes die. Each has a digest: its name, its last member, or a member of runs/KEY.json. What is damaged is made
anew."""

import csv
import json
import os
import pathlib
import platform
import shutil
import socket
import struct
import subprocess
import time

from .accuracy import measure_error
from .finished import is_done, is_picture
from .inputs import COUNTERS, SOURCE, description_of
from .manifest import NAME, read_manifest
from .pictures import png
from .scratch import new_scratch
from .tools import dying
from .util import Problem, hash_bytes, hash_file, hash_value, read_json, remark, write_file, write_json, write_sealed

FORMAT = 2
# Members of the statistics that are not the machine's.
OF_THE_HOST = ("program", "host_seconds", "instructions_per_host_second")

# --- jobs

MEASURES = ("error", "hits")  # figures of a picture from trax-render, beside the run
ENGINES = {"exact": "fast", "quick": "quick"}


def engine_of(tools, point):
    """Machines whose TPs are lanes of warps have an engine of their own (docs/simt.md)."""
    if point.mode == "exact" and tools.value(point.chip_file, point.machine(), "simt.width") > 1:
        return "simt"
    return ENGINES[point.mode]


def simulator(engine):
    """The program that makes a run."""
    return "trax-render" if engine == "quick" else "trax-sim"


def make_job(tools, inputs, point):
    more = {
        name: value for name, value in (("counters", point.program.counters),
                                        ("measure", [name for name in MEASURES if getattr(point, name)]),
                                        ("ray_cycles", point.ray_cycles)) if value
    }
    engine = engine_of(tools, point)
    if "measure" in more:
        more["renderer"] = tools.hash("trax-render")
        more["judge"] = tools.hash("trax-compare")
    return more | {
        "format": FORMAT,
        "emulator": tools.hash(simulator(engine)),
        "inputs": inputs,
        "configuration": tools.configuration(point.chip_file, point.machine()),
        "engine": engine,
        "series": point.series,
        "ray_kinds": point.ray_kinds,
    }


def key_of(job):
    return hash_value(job)


def write_job(out, job):
    """Returns the job's key."""
    key = key_of(job)
    path = out / "jobs" / f"{key}.json"
    if path.exists() and not is_job(path, key):
        remark(f"{path}: is damaged; it is made anew")
        path.unlink()
    if not path.exists():
        write_json(path, job)
    return key


def is_job(path, key):
    try:
        return hash_value(read_json(path)) == key
    except Problem:
        return False


# --- runs


def renderer(tools, inputs, job, scratch, threads):
    """trax-render on what the job's inputs were made of."""
    whole, size = job["inputs"]["whole"], "{width}x{height}".format_map(job["inputs"]["picture"])
    command = [
        tools.path("trax-render"),
        str(inputs / "whole.trax"), "--view",
        str(inputs / "picture.view"), "--size", size, "--config", f"{scratch}/machine.cfg", "--threads",
        str(threads), "--quiet", *whole["options"]
    ]
    command += ["--program", str(inputs / "program.elf")] if whole["program"] else []
    return [*command, *(["--source", str(inputs / SOURCE)] if whole["source"] else [])]


def command_of(tools, inputs, job, scratch, threads):
    """trax-sim on the job's inputs; what it writes is in scratch."""
    rays = ["--ray-cycles", f"{scratch}/rays.csv"] if job.get("ray_cycles") else []
    if job["engine"] == "quick":
        # The picture would be the native twin's, which is of no other source.
        picture = [] if job["inputs"]["whole"]["source"] else ["-o", f"{scratch}/image.png"]
        return [
            *renderer(tools, inputs, job, scratch, threads), "--sampled", "--stats", f"{scratch}/stats.json", *picture,
            *rays
        ]
    command = [
        tools.path("trax-sim"), "--quiet", "--config", f"{scratch}/machine.cfg", "--engine", job["engine"], "--stats",
        f"{scratch}/stats.json"
    ]
    # Rays that are traced again make no picture.
    output = job["inputs"]["picture"]["buffer"] if "picture" in job["inputs"] else "hits"
    command += ["--dump", f"{output}={scratch}/image.raw", "--host-threads", str(threads)]
    if job.get("counters"):
        command += ["--dump", f"{COUNTERS}={scratch}/counters.raw"]
    if job["series"]:
        command += ["--series", f"{scratch}/series.csv", "--series-interval", str(job["series"])]
    if job["ray_kinds"]:
        command += ["--ray-kinds", f"{scratch}/kinds.csv"]
    return [*command, *rays, str(inputs / NAME)]


def measure(tools, out, inputs, job, scratch, threads, run):
    """The figures of the picture that the job asks for: {name: {figure: value}}."""
    render = renderer(tools, inputs, job, scratch, threads)
    figures = {}
    if "error" in job["measure"]:
        figures["error"] = measure_error(tools, out, inputs, job, scratch, render, run)
    if "hits" in job["measure"]:
        run("trax-render", [*render, "--hits", f"{scratch}/hits.json"])
        figures["hits"] = read_json(pathlib.Path(scratch, "hits.json"))
    return figures


def check_inputs(job, inputs):
    """Checks the files beside the manifest. trax-sim checks those that the manifest names."""
    whole = job["inputs"].get("whole", {}).get("files", {})
    expected = {name: value for name, value in job["inputs"].items() if name != "whole"}
    damaged = [] if description_of(read_manifest(inputs)) == expected else [NAME]
    for file in damaged + [file for file, known in whole.items() if hash_file(inputs / file) != known]:
        raise Problem(f"{inputs / file}: is damaged: it has not the bytes of its name; "
                      "the command that asked for the run makes it anew")


def run_process(program, command, scratch, on_start):
    """Runs a command and returns its resource usage; a Problem if it fails. on_start receives the process."""
    with open(f"{scratch}/errors", "wb") as errors:
        process = subprocess.Popen(dying(command, "KILL"), stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                   stderr=errors)
    if on_start:
        on_start(process)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        text = pathlib.Path(scratch, "errors").read_text(errors="replace").strip()
        raise Problem(text.removeprefix(f"{program}: error: ") or f"{program} ended with status {process.returncode}")
    return usage


def run_job(out, tools, key, threads=1, on_start=None):
    """Makes runs/KEY.json, unless it exists. on_start receives each process that is started."""
    if is_done(out, key):
        return
    job = read_json(out / "jobs" / f"{key}.json")
    if hash_value(job) != key:
        raise Problem(f"{out}/jobs/{key}.json is damaged: its name is not its hash")
    emulator = simulator(job["engine"])
    for program, known in ((emulator, job["emulator"]), ("trax-render", job.get("renderer")),
                           ("trax-compare", job.get("judge"))):
        if known and known != hash_file(
                tools.path(program)):  # hashed again: it may have been built since the command began
            raise Problem(f"job {key} is for another {program} than {tools.path(program)}")
    inputs = out / "inputs" / hash_value(job["inputs"])
    check_inputs(job, inputs)
    scratch = new_scratch(out)
    try:
        write_file(pathlib.Path(scratch, "machine.cfg"), job["configuration"])
        begin = time.monotonic()
        usage = run_process(emulator, command_of(tools, inputs, job, scratch, threads), scratch, on_start)
        statistics = json.loads(pathlib.Path(scratch, "stats.json").read_text())
        host = {
            "host_seconds": round(time.monotonic() - begin, 3), "simulator_seconds": statistics.get("host_seconds"),
            "threads": threads, "processor_seconds": round(usage.ru_utime + usage.ru_stime,
                                                           3), "name": socket.gethostname(), "processor": processor()
        }
        figures = {}
        if "measure" in job:
            figures = measure(tools, out, inputs, job, scratch, threads,
                              lambda program, command: run_process(program, command, scratch, on_start))
        code = read_manifest(inputs).get("code")
        statistics = {name: value for name, value in statistics.items() if name not in OF_THE_HOST}
        keep_results(out, key, job, scratch, statistics, figures, code, host)
    finally:
        shutil.rmtree(scratch, ignore_errors=True)


def keep_results(out, key, job, scratch, statistics, figures, code, host):
    picture = None
    # A quick one is the native twin's, and of nothing that was simulated.
    if job["engine"] != "quick" and "picture" in job["inputs"]:
        pixels = pathlib.Path(scratch, "image.raw").read_bytes()
        picture = hash_bytes(pixels)
        path = out / "pictures" / f"{picture}.png"
        if not is_picture(path, picture):
            write_file(path, png(job["inputs"]["picture"], pixels))
    result = {"key": key, "job": job, "picture": picture, "statistics": statistics} | ({"code": code} if code else {})
    if job["series"]:
        write_file(out / "runs" / f"{key}.csv", pathlib.Path(scratch, "series.csv").read_bytes())
        result["series"] = hash_file(pathlib.Path(scratch, "series.csv"))
    result |= figures
    if job.get("counters"):
        words = pathlib.Path(scratch, "counters.raw").read_bytes()
        result["counters"] = dict(zip(job["counters"], struct.unpack(f"<{len(job['counters'])}I", words)))
    if job["ray_kinds"]:
        result["ray_kinds"] = read_kinds(pathlib.Path(scratch, "kinds.csv"))
    if job.get("ray_cycles"):
        result["ray_cycles"] = read_kinds(pathlib.Path(scratch, "rays.csv"))
    write_sealed(out / "runs" / f"{key}.host.json", host)
    write_sealed(out / "runs" / f"{key}.json", result)
    (out / "runs" / f"{key}.error").unlink(missing_ok=True)


def processor():
    """The host's name of its processor."""
    try:
        for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
            if line.startswith("model name"):
                return line.split(":", 1)[1].strip()
    except OSError:
        pass
    return platform.machine()


def read_kinds(path):
    """Rows of numbers, but for the kind and the part of the run."""
    columns, rows = read_csv(path)
    words = ("kind", "part")
    return [{name: value if name in words else float(value) for name, value in zip(columns, row)} for row in rows]


def read_csv(path):
    """(columns, rows)"""
    with open(path, newline="") as file:
        rows = list(csv.reader(file))
    return rows[0], rows[1:]
