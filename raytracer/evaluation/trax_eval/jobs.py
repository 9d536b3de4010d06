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
Every file appears complete or not at all, and runs/KEY.json last, so nothing but the runs under way is lost when processes die."""

import csv
import json
import os
import pathlib
import platform
import shutil
import socket
import struct
import subprocess
import tempfile
import time

from .manifest import NAME, read_manifest, seal
from .pictures import png
from .programs import convert
from .tools import run_tool
from .util import Problem, hash_bytes, hash_file, hash_value, read_json, write_file, write_json

FORMAT = 1
OF_THE_HOST = ("program", "host_seconds", "instructions_per_host_second")  # in the statistics: they are not the machine's


# --- inputs


COUNTERS = "counters"  # the buffer of a program that counts
QUICK_FILES = ("whole.trax", "picture.view")  # what trax-render makes a program's inputs of: quick runs choose by it what to simulate


def prepare_inputs(out, tools, scene, view, size, program, built, chip, more=(), quick=False, only_look=False):
    """The files that a program reads for a picture; returns their description, which is part of the job. built: options of trax-render that name the
    program. chip: what of it decides about the program, its TMs and the bytes of an instruction cache; None: nothing does. more: options of trax-render.
    only_look: nothing is kept."""
    scratch = tempfile.mkdtemp(prefix="trax-eval.") if only_look else new_scratch(out)
    try:
        command = [tools.path("trax-render"), str(scene), "--size", size, "--prepare", scratch, "--quiet"]
        command += ["--write-view", f"{scratch}/picture.view"] if quick else []
        command += ["--view", view] if view else []
        command += built
        command += ["--queues", str(chip[0]), "--set", f"icache.bytes={chip[1]}"] if chip else []
        command += more
        run = run_tool(command)
        if run.returncode != 0:
            raise Problem(f"{scene}: {run.stderr.strip() or f'trax-render ended with status {run.returncode}'}")
        if program.convert:
            convert(program, scratch)
        if program.convert or program.counters:
            seal_inputs(program, scratch)
        description = description_of(read_manifest(scratch))
        if quick:
            shutil.copyfile(scene, pathlib.Path(scratch, "whole.trax"))
            description["quick"] = {"options": list(more), "program": not program.specialised, "files": {file: hash_file(pathlib.Path(scratch, file)) for file in QUICK_FILES}}
        place = out / "inputs" / hash_value(description)
        if not only_look and not place.exists():
            (place.parent / "bytes").mkdir(parents=True, exist_ok=True)
            os.chmod(scratch, 0o755)
            for buffer in description["buffers"]:
                if "file" in buffer:
                    share(pathlib.Path(scratch, buffer["file"]), place.parent / "bytes" / buffer["xxh128"])
            try:
                os.rename(scratch, place)
            except OSError:
                if not place.exists():  # somebody else was faster otherwise
                    raise
        return description
    finally:
        shutil.rmtree(scratch, ignore_errors=True)


def seal_inputs(program, folder):
    """The manifest of files that the program's converter may have changed, with the buffer of its counters."""
    more = [{"symbol": COUNTERS, "bytes": 4 * len(program.counters), "output": f"{COUNTERS}.raw"}] if program.counters else []
    try:
        seal(folder, more)
    except (OSError, ValueError, TypeError, KeyError) as error:
        raise Problem(f"{program.file}: convert: the manifest or a file of it cannot be read any more: {error}") from None


def description_of(manifest):
    """What of the manifest decides a result: a job has a machine of its own."""
    return {name: manifest[name] for name in ("program", "buffers", "items", "picture")}


def share(path, content):
    """Pictures of several sizes have the same scene: it takes its place once, if the file system has hard links."""
    try:
        if content.exists():
            beside = path.with_name(path.name + ".link")
            os.link(content, beside)
            os.replace(beside, path)
        else:
            os.link(path, content)
    except OSError:
        pass


# --- jobs


ENGINES = {"exact": "fast", "quick": "quick"}


def simulator(engine):
    """The program that makes a run."""
    return "trax-render" if engine == "quick" else "trax-sim"


def make_job(tools, inputs, point):
    more = {name: value for name, value in (("counters", point.program.counters), ("error", point.error), ("hits", point.hits)) if value}
    return more | {
        "format": FORMAT,
        "emulator": tools.hash(simulator(ENGINES[point.mode])),
        "inputs": inputs,
        "configuration": tools.configuration(point.chip_file, point.machine()),
        "engine": ENGINES[point.mode],
        "series": point.series,
        "lockstep": point.lockstep,
        "ray_kinds": point.ray_kinds,
    }


def key_of(job):
    return hash_value(job)


def write_job(out, job):
    """Returns the job's key."""
    key = key_of(job)
    path = out / "jobs" / f"{key}.json"
    if not path.exists():
        write_json(path, job)
    return key


def is_done(out, key):
    return (out / "runs" / f"{key}.json").exists()


def result_of(out, key):
    """(result, host) or None."""
    path = out / "runs" / f"{key}.json"
    if not path.exists():
        return None
    host = out / "runs" / f"{key}.host.json"
    return read_json(path), read_json(host) if host.exists() else {}


def error_of(out, key):
    path = out / "runs" / f"{key}.error"
    return path.read_text().strip() if path.exists() else None


# --- scratch


def new_scratch(out):
    """A folder for one process's unfinished files, named after the process."""
    folder = out / "scratch"
    folder.mkdir(parents=True, exist_ok=True)
    return tempfile.mkdtemp(prefix=f"{socket.gethostname()}.{os.getpid()}.", dir=folder)


def process_lives(pid):
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        return True
    return True


def clean_scratch(out):
    """Removes what dead processes of this host have left."""
    host = socket.gethostname()
    for folder in ("scratch", "runs", "jobs", "pictures"):
        for path in (out / folder).glob(f"*{host}.*"):
            owner = path.name.split(f"{host}.", 1)[1].split(".")[0]
            if owner.isdigit() and not process_lives(int(owner)):
                shutil.rmtree(path, ignore_errors=True) if path.is_dir() else path.unlink(missing_ok=True)


# --- runs


def quick_command(tools, inputs, job, scratch, threads):
    """trax-render on what the job's inputs were made of: some parts of the picture."""
    size = "{width}x{height}".format_map(job["inputs"]["picture"])
    command = [tools.path("trax-render"), str(inputs / "whole.trax"), "--view", str(inputs / "picture.view"), "--size", size, "--config",
               f"{scratch}/machine.cfg", "--sampled", "--threads", str(threads), "--quiet", "--stats", f"{scratch}/stats.json", "-o", f"{scratch}/image.png"]
    quick = job["inputs"]["quick"]
    return [*command, *quick["options"], *(["--program", str(inputs / "program.elf")] if quick["program"] else [])]


def command_of(tools, inputs, job, scratch, threads):
    """trax-sim on the job's inputs; what it writes is in scratch."""
    if job["engine"] == "quick":
        return quick_command(tools, inputs, job, scratch, threads)
    command = [tools.path("trax-sim"), "--quiet", "--config", f"{scratch}/machine.cfg", "--engine", job["engine"], "--stats", f"{scratch}/stats.json"]
    command += ["--dump", f"{job['inputs']['picture']['buffer']}={scratch}/image.raw", "--host-threads", str(threads)]
    if job.get("counters"):
        command += ["--dump", f"{COUNTERS}={scratch}/counters.raw"]
    if job["series"]:
        command += ["--series", f"{scratch}/series.csv", "--series-interval", str(job["series"])]
    if job["lockstep"]:
        command += ["--lockstep", f"{scratch}/lockstep.csv"]
    if job["ray_kinds"]:
        command += ["--ray-kinds", f"{scratch}/kinds.csv"]
        command += ["--lockstep-rays", f"{scratch}/lanes.csv"] if job["lockstep"] else []
    return [*command, str(inputs / NAME)]


def check_inputs(job, inputs):
    """What the manifest names is checked by trax-sim."""
    quick = job["inputs"].get("quick", {}).get("files", {})
    expected = {name: value for name, value in job["inputs"].items() if name != "quick"}
    damaged = [] if description_of(read_manifest(inputs)) == expected else [NAME]
    for file in damaged + [file for file, known in quick.items() if hash_file(inputs / file) != known]:
        raise Problem(f"{inputs / file} is damaged: it has not the bytes of its name; remove the folder and start again")


# The simulator dies with this process, whatever ends it: also if that was before the kernel had been asked for it.
DIES_WITH_PARENT = ("setpriv", "--pdeathsig", "KILL", "sh", "-c", '[ "$PPID" = "$0" ] && exec "$@"')


def run_job(out, tools, key, threads=1, on_start=None):
    """Makes runs/KEY.json, unless it is there. on_start is told the process."""
    if is_done(out, key):
        return
    job = read_json(out / "jobs" / f"{key}.json")
    if hash_value(job) != key:
        raise Problem(f"{out}/jobs/{key}.json is damaged: its name is not its hash")
    emulator = simulator(job["engine"])
    if job["emulator"] != hash_file(tools.path(emulator)):  # hashed anew: it may have been built since the command began
        raise Problem(f"job {key} is for another {emulator} than {tools.path(emulator)}")
    inputs = out / "inputs" / hash_value(job["inputs"])
    check_inputs(job, inputs)
    scratch = new_scratch(out)
    try:
        write_file(pathlib.Path(scratch, "machine.cfg"), job["configuration"])
        begin = time.monotonic()
        with open(f"{scratch}/errors", "wb") as errors:
            process = subprocess.Popen([*DIES_WITH_PARENT, str(os.getpid()), *command_of(tools, inputs, job, scratch, threads)],
                                       stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=errors)
        if on_start:
            on_start(process)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode != 0:
            text = pathlib.Path(scratch, "errors").read_text(errors="replace").strip()
            raise Problem(text.removeprefix(f"{emulator}: error: ") or f"{emulator} ended with status {process.returncode}")
        statistics = json.loads(pathlib.Path(scratch, "stats.json").read_text())
        host = {"host_seconds": round(time.monotonic() - begin, 3), "simulator_seconds": statistics.get("host_seconds"), "threads": threads,
                "processor_seconds": round(usage.ru_utime + usage.ru_stime, 3), "name": socket.gethostname(), "processor": processor()}
        keep_results(out, key, job, scratch, {name: value for name, value in statistics.items() if name not in OF_THE_HOST}, host)
    finally:
        shutil.rmtree(scratch, ignore_errors=True)


def keep_results(out, key, job, scratch, statistics, host):
    picture = None
    if job["engine"] != "quick":  # a quick one is the native twin's, and of nothing that was simulated
        pixels = pathlib.Path(scratch, "image.raw").read_bytes()
        picture = hash_bytes(pixels)
        path = out / "pictures" / f"{picture}.png"
        if not path.exists():
            write_file(path, png(job["inputs"]["picture"], pixels))
    if job["series"]:
        write_file(out / "runs" / f"{key}.csv", pathlib.Path(scratch, "series.csv").read_bytes())
    result = {"key": key, "job": job, "picture": picture, "statistics": statistics}
    if job.get("counters"):
        words = pathlib.Path(scratch, "counters.raw").read_bytes()
        result["counters"] = dict(zip(job["counters"], struct.unpack(f"<{len(job['counters'])}I", words)))
    if job["lockstep"]:
        columns, rows = read_csv(pathlib.Path(scratch, "lockstep.csv"))
        result["lockstep"] = [dict(zip(columns, map(float, row))) for row in rows]
    if job["ray_kinds"]:
        result["ray_kinds"] = read_kinds(pathlib.Path(scratch, "kinds.csv"))
        if job["lockstep"]:
            result["ray_lanes"] = read_kinds(pathlib.Path(scratch, "lanes.csv"))
    write_json(out / "runs" / f"{key}.host.json", host)
    write_json(out / "runs" / f"{key}.json", result)
    (out / "runs" / f"{key}.error").unlink(missing_ok=True)


def processor():
    """What the host calls its processor."""
    try:
        for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
            if line.startswith("model name"):
                return line.split(":", 1)[1].strip()
    except OSError:
        pass
    return platform.machine()


def read_kinds(path):
    """Rows of numbers, but for the kind."""
    columns, rows = read_csv(path)
    return [{name: value if name == "kind" else float(value) for name, value in zip(columns, row)} for row in rows]


def read_csv(path):
    """(columns, rows)"""
    with open(path, newline="") as file:
        rows = list(csv.reader(file))
    return rows[0], rows[1:]
