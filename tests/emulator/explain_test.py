#!/usr/bin/env python3
"""explain_test.py TRAX_SIM CALLS DEEP EMULATOR_PROGRAMS: what explains a run, on both engines: the same bytes, formats
that their readers accept, and sums that equal the run's statistics."""
import base64
import collections
import csv
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import zlib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import checking  # noqa: E402
from checking import check, equal  # noqa: E402

SIM, PROGRAM, DEEP, WRITE_PROGRAMS = (str(pathlib.Path(p).resolve()) for p in sys.argv[1:5])
FILES = ["explore", "profile", "profile-folded", "heat", "heat-lines", "waits", "items", "series", "trace", "perfetto"]
RESULTS = 400  # words


def run(directory, engine, *options, files=FILES, expected=0, program=None):
    directory.mkdir(exist_ok=True)
    command = [SIM, "--quiet", "--engine", engine, "--stats", "stats.json"]
    if not program:
        command += ["--alloc", f"results={RESULTS * 4}"]
    for name in files:
        command += [f"--{name}", name]
    command += [*options, program or PROGRAM]
    result = subprocess.run(command, cwd=directory, capture_output=True, text=True, timeout=120)
    equal(result.returncode, expected, "status of", " ".join(command), result.stderr)
    return result.stderr


def read(directory, name):
    return (directory / name).read_text()


def page_data(directory):
    """Of --explore; tests/report/explore_test.py has the rest of it."""
    return json.loads(zlib.decompress(base64.b64decode(re.search(r'id="data">([^<]*)<',
                                                                 read(directory, "explore"))[1])))


def rows(directory, name):
    return list(csv.DictReader((directory / name).open()))


def numbers(row, names):
    return {name: int(row[name]) for name in names}


def figure(stats, name):
    for part in name.split("."):
        stats = stats[part]
    return stats


# --- each output against the statistics ---


def check_tps(stats):
    for tm in stats["tms"]:
        for cause, cycles in tm["causes"].items():
            equal(sum(tp["causes"][cause] for tp in tm["tps"]), cycles, "TPs of TM", tm["tm"], cause)
        for share, exact in ((tm["issue"]["utilisation"], tm["causes"]["issued"] / (len(tm["tps"]) * stats["cycles"])),
                             (tm["fp_add"]["utilisation"], tm["fp_add"]["operations"] / stats["cycles"])):
            check(abs(share - exact) <= 1e-14, "share of TM", tm["tm"], share, exact)  # 15 digits are written
        check(tm["special"]["utilisation"] > 0 and 0 < tm["dcache"]["hit_rate"] < 1, "shares of TM", tm["tm"])
        for tp in tm["tps"]:
            equal(sum(tp["causes"].values()), stats["cycles"], "cycles of thread", tp["thread"])
            equal(tp["thread"], tm["tm"] * len(tm["tps"]) + tp["tp"], "thread of", tp["tp"])


def check_energy(stats):
    """Against the figures for each access, in nJ, and what docs/statistics.md says is an access. The machine has a
    data cache of 16 kB with one bank, instruction caches of 4 kB with 16, and a second-level cache of 64 kB with 8."""
    count = stats["instructions_by_operation"]
    registers = {"r": 3, "r1": 2, "cmov": 4, "store": 2, "u": 1, "none": 0}
    kinds = {"cmov": ["cmovnz", "cmovz"],
             "store": ["sb", "sh", "sw", "swnt", "beq", "bne", "blt", "bge", "bltu", "bgeu"],
             "u": ["lui", "jal", "rdsr", "trap"], "none": ["halt"],
             "r": ["add", "sub", "and", "or", "xor", "sll", "srl", "sra", "slt", "sltu", "min", "max", "minu",
                   "maxu", "mul", "mulh", "mulhu", "fadd", "fsub", "fmin", "fmax", "feq", "flt", "fle", "fmul", "fdiv"]}
    kind_of = {name: kind for kind, names in kinds.items() for name in names}
    accesses = sum(number * registers[kind_of.get(name, "r1")] for name, number in count.items())
    icache, dcache, local, memory = (stats[name] for name in ("icache", "dcache", "local", "memory"))
    expected = {
        "fp_add": 0.0074 * (count["fadd"] + count["fsub"]),
        "fp_mul": 0.0142 * count["fmul"],
        "fp_other": 0.000536 * sum(count[name] for name in ("fmin", "fmax", "feq", "flt", "fle")) + 0.001 *
        sum(count[name] for name in count if name.startswith("fcvt")),
        "int_mul": 0.0177 * stats["instructions_by_unit"]["int_mul"],
        "special": 0.1563 * stats["instructions_by_unit"]["special"],
        "ray": 0.136568 * count["fbox"] + 0.67738 * count["ftri"],
        "integer": 0.000572 * sum(stats["instructions_by_unit"][unit] for unit in ("int", "control", "memory")),
        "registers": 0.00789613 * accesses,
        "local_memory": 0.00692867 * (local["loads"] + local["stores"]),
        "icache": 0.013490 * (icache["hits"] + 17 * icache["misses"] + icache["merged"]),
        "dcache": 0.126381 * (dcache["hits"] + 2 * dcache["misses"] + dcache["merged"] + dcache["store_hits"] +
                              dcache["store_misses"]),
    }
    expected["l2"] = 0.251421 * (stats["l2"]["hits"] + 2 * stats["l2"]["misses"] + stats["l2"]["merged"] +
                                 stats["l2"]["passed"] + stats["l2"]["store_hits"] + stats["l2"]["store_misses"])
    energy = stats["energy"]
    total = sum(expected.values())
    expected.update(total=total, off_chip=1.95 / 8 * memory["bytes"], average_power=total / stats["seconds"], per_ray=0)
    equal(set(expected), set(energy), "energies")
    for name, value in expected.items():
        check(abs(energy[name] - value * 1e-9) <= 1e-12 * abs(value), "energy", name, energy[name], value * 1e-9)
    check(all(energy[name] for name in ("icache", "dcache", "registers", "special", "int_mul", "local_memory")), energy)


def check_profile(directory, stats):
    sections = re.split(r"\n(Functions|Lines)\n", read(directory, "profile"))
    for title, text in zip(sections[1::2], sections[2::2]):
        table = [line.split() for line in text.strip().split("\n")[1:]]
        equal(sum(int(row[0]) for row in table[:-1]), stats["thread_cycles"], title, "thread-cycles")
        equal(int(table[-1][0]), stats["thread_cycles"], title, "total")
        own = [int(row[0]) for row in table[:-1]]
        equal(own, sorted(own, reverse=True), title, "order")
    named = {line.split()[-1]: line.split() for line in sections[2].strip().split("\n")}
    check(float(named["main"][2]) > 80, "main has most of the thread-cycles below it:", named["main"])
    check(float(named["inlined"][1]) > 0, "the inlined function has some of its own")
    check("calls.c:" in sections[4], "lines name their file")


def check_folded(directory, stats):
    by_cause, stacks = collections.Counter(), set()
    for line in read(directory, "profile-folded").splitlines():
        stack, count = line.rsplit(" ", 1)
        frames = stack.split(";")
        by_cause[frames[-1]] += int(count)
        stacks.add(";".join(frame for frame in frames[:-1] if ":" not in frame))
    equal(dict(by_cause), {k: v for k, v in stats["causes"].items() if v}, "folded causes")
    recursive = sorted(stack for stack in stacks if stack.endswith("recursive"))
    equal(recursive[0], "_start;main;recursive")
    check("_start;main;recursive;recursive" in recursive, "recursion is deeper:", recursive)
    equal({stack for stack in stacks if "recursive" not in stack},
          {"_start", "_start;main", "_start;main;trax_tm", "_start;main;trax_atomic_inc", "_start;main;trax_store_nt",
           "_start;main;trax_count_items", "_start;main;tail", "_start;main;last",  # by a tail call: main called it
           "_start;main;last;leaf", "_start;main;last;inlined", "_start;main;divide", "_start;main;alternate",
           "_start;main;catcher", "_start;main;catcher;setjmp", "_start;main;catcher;thrower",
           "_start;main;catcher;thrower;leaf", "_start;main;catcher;thrower;longjmp",
           "_start;main;catcher;leaf",  # after the longjmp
           "(halted)"}, "stacks")


def check_trace_and_page(directory, stats):
    issued, instructions, registers = collections.Counter(), 0, {}
    previous = (-1, -1)
    for line in read(directory, "trace").splitlines()[1:]:
        match = re.match(r" *(\d+) +(\d+) +(\d+)\.(\d+) +(\w+) ", line)
        cycle, thread, tm, tp = (int(match[i]) for i in range(1, 5))
        equal(thread, tm * 8 + tp, "thread of", line)
        state = registers.setdefault(thread, collections.defaultdict(int))
        value = re.search(r"  r(\d+)=(\w{8})| r(\d+)=(\w{8})$", line)
        if match[5] == "arrival":
            state[int(value[3] or value[1])] = int(value[4] or value[2], 16)
            continue
        check((cycle, thread) > previous, "order at", line)
        previous = (cycle, thread)
        issued[match[5]] += 1
        instructions += 1
        addi = re.search(r"  addi r(\d+), r(\d+), (-?\d+) ", line)
        if addi and addi[1] != "0":
            equal(int(value[2], 16), state[int(addi[2])] + int(addi[3]) & 0xFFFFFFFF, "value in", line)
        store = re.search(r"  sw r(\d+), .*  (\w{8}) \[", line)
        if store:
            equal(int(store[2], 16), state[int(store[1])], "value in", line)
        if value:
            state[int(value[1])] = int(value[2], 16)
    equal(instructions, stats["instructions"], "lines of the trace")
    # On the page each instruction has what the trace has of it. The bubble, of one cycle here, belongs to the branch
    # that was taken.
    causes, page = list(stats["causes"]), [one for one in page_data(directory)["instructions"] if one]
    counts = {f"{one[0]:08x}" if one[0] is not None else "": dict(zip(causes, one[5])) for one in page}
    equal({pc: count["issued"] for pc, count in counts.items() if count["issued"]}, dict(issued), "instructions by pc")
    jumped = collections.Counter(re.match(r" *\d+ +\d+ +\S+ +(\w+) ", line)[1]
                                 for line in read(directory, "trace").splitlines() if re.search(r"  to \w{8}$", line))
    equal({pc: count["branch_bubble"] for pc, count in counts.items() if count["branch_bubble"]}, dict(jumped),
          "bubbles by pc")
    check(
        any(one[5][causes.index("wait_memory")] for one in page if one[1].split(" ")[0] not in ("lui", "jal", "halt")),
        "nobody waits for memory")
    equal({cause: sum(count[cause] for count in counts.values()) for cause in causes}, stats["causes"],
          "causes on the page")


def check_heat(directory, stats):
    columns = ["loads", "stores", "atomics", "load_bytes", "store_bytes", "hits", "misses", "merged", "combined"]
    total, lines, local = collections.Counter(), collections.Counter(), collections.Counter()
    for row in rows(directory, "heat"):
        (local if row["object"] == "(local memory)" else total).update(numbers(row, columns))
    loads_by_line = collections.Counter()
    for row in rows(directory, "heat-lines"):
        lines.update(numbers(row, columns))
        loads_by_line[row["object"]] += int(row["loads"])
    equal(+lines, +total, "heat by line and by object")
    loads = {row["object"]: int(row["loads"]) for row in rows(directory, "heat")}
    for name in "even", "odd":  # which have lines of their own
        check(loads[name] > RESULTS / 4, name, "is hardly loaded")
        equal(loads[name], loads_by_line[name], "loads of", name, "by line and by object")
    equal([total["hits"], total["misses"], total["merged"], total["atomics"], total["combined"]],
          [figure(stats, name) for name in
           ("dcache.hits", "dcache.misses", "dcache.merged", "atomics", "stores.combined")], "heat")
    equal([local["loads"], local["stores"]], [figure(stats, "local.loads"), figure(stats, "local.stores")],
          "local heat")
    equal(total["loads"], total["hits"] + total["misses"] + total["merged"] + figure(stats, "nontemporal.loads"))
    equal(total["stores"], figure(stats, "dcache.store_hits") + figure(stats, "dcache.store_misses") +
          figure(stats, "nontemporal.stores"))
    objects = {row["object"]: row for row in rows(directory, "heat") if row["stores"] != "0"}
    equal(int(objects["results"]["store_bytes"]), RESULTS * 4, "bytes stored to the buffer")
    check("table" in objects, "the table is stored to")


def check_waits(directory, stats):
    """Both views of a wait: by what is waited for, and by the instruction that waits, as the page has it."""
    waits = rows(directory, "waits")
    columns = [name for name in waits[0] if name in stats["causes"]]
    total, waiting = collections.Counter(), collections.Counter()
    for row in waits:
        cost = numbers(row, columns)
        total.update(cost)
        waiting.update({(row["waiting_address"], name): cycles for name, cycles in cost.items()})
        equal(bool(row["object"]), not cost["wait_special"], "the object of", row)  # divisions access none
    equal(columns, [name for name in stats["causes"] if name.startswith("wait_") or name == "dcache_bank_conflict"])
    equal(dict(total), {name: stats["causes"][name] for name in columns}, "waits")
    causes = list(stats["causes"])
    page = {(f"0x{one[0]:08x}", name): one[5][causes.index(name)] for one in page_data(directory)["instructions"]
            if one and one[0] is not None for name in columns if one[5][causes.index(name)]}
    equal(dict(+waiting), page, "waits by the instruction that waits")
    equal(page_data(directory)["waits"], read(directory, "waits"), "waits of the page")


def check_items(directory, stats):
    causes, places, ends = collections.Counter(), [], {}
    for row in rows(directory, "items"):
        cost = numbers(row, [name for name in stats["causes"] if name != "issued"])
        causes.update(cost)
        causes["issued"] += int(row["instructions"])
        equal(int(row["end"]) - int(row["begin"]), sum(cost.values()) + int(row["instructions"]), "length of", row)
        equal(int(row["begin"]), ends.get(row["thread"], 0), "begin of", row)
        ends[row["thread"]] = int(row["end"])
        if row["kind"] == "item":
            places.append(int(row["place"]))
    equal(sorted(places), list(range(RESULTS)), "places of items")
    equal(dict(+causes), {k: v for k, v in stats["causes"].items() if v}, "causes of items")
    equal(set(ends.values()), {stats["cycles"]}, "ends of threads")


def check_series(directory, stats):
    series = rows(directory, "series")
    names = list(series[0])[3:-1]
    for tm in ["all", "0", "1"]:
        of_tm = [row for row in series if row["tm"] == tm]
        equal([int(row["end"]) - int(row["begin"]) for row in of_tm[:-1]], [500] * (len(of_tm) - 1), "intervals")
        equal(int(of_tm[-1]["end"]), stats["cycles"], "the end of the series")
        whole = stats if tm == "all" else stats["tms"][int(tm)]
        for name in names:
            if tm != "all" and of_tm[0][name] == "":  # counted beyond the TMs
                continue
            key = f"causes.{name}" if name in stats["causes"] else name
            equal(sum(int(row[name]) for row in of_tm), figure(whole, key), "series of", name, "in TM", tm)
        for row in of_tm:
            threads = 16 if tm == "all" else 8
            equal(sum(int(row[name]) for name in stats["causes"]),
                  threads * (int(row["end"]) - int(row["begin"])), "causes in", row["begin"])


def check_perfetto(directory, begin, end, tms=2):
    """Complete events of a track do not overlap; begins and ends are nested and in the order of time."""
    events = json.loads(read(directory, "perfetto"))["traceEvents"]
    causes, until, open_frames, last = collections.Counter(), {}, collections.defaultdict(list), {}
    names = {"process_name": set(), "thread_name": set()}
    for event in events:
        check(set(event) >= {"ph", "pid", "tid", "ts", "name"}, "members of", event)
        track = (event["pid"], event["tid"])
        if event["ph"] == "M":
            names[event["name"]].add(track)
            continue
        check(begin <= event["ts"] <= end, "time of", event)
        if event["ph"] == "X":
            check(event["ts"] >= until.get(track, begin) and event["dur"] > 0, "overlap at", event)
            until[track] = event["ts"] + event["dur"]
            causes[event["name"]] += event["dur"]
        elif event["ph"] in "BE":
            check(event["ts"] >= last.get(track, begin), "order at", event)
            last[track] = event["ts"]
            if event["ph"] == "B":
                open_frames[track].append(event["name"])
            else:
                equal(open_frames[track].pop(), event["name"], "nesting at", event)
        else:
            equal(event["ph"], "C")
            check(isinstance(event["args"]["value"], (int, float)), "counter", event)
    check(not any(open_frames.values()), "functions left open", open_frames)
    check(set(until) <= names["thread_name"], "tracks without names")
    equal(len(names["process_name"]), tms, "processes")
    return causes


def check_host_threads(directory):
    """The same bytes from any number of the host's threads, which share the passages of four TMs, as from the other
    engine, which tells of each issue."""
    files = ["explore", "profile", "heat", "heat-lines", "waits", "items"]
    chip = ["--config", "4x32", "--item-buffer", "results"]
    run(directory / "apart", "reference", *chip, files=files)
    for threads in (1, 2, 3, 8):
        for _ in range(3):
            run(directory / "shared", "fast", *chip, "--host-threads", str(threads), files=files)
            for name in files:
                equal(read(directory / "shared", name), read(directory / "apart", name), name, "of", threads,
                      "threads of the host")


def main(directory):
    check_host_threads(directory)
    machine = ["--config", "2x32", "--set", "chip.tps_per_tm=8", "--set", "tp.branch_bubble_cycles=1",
               "--set", "memory.queue_depth=4"]
    whole = ["--item-buffer", "results", "--series-interval", "500"]
    far = 1 << 40
    for engine in ["reference", "fast"]:
        run(directory / engine, engine, *machine, *whole, "--window", f"0:{far}")
    run(directory / "again", "fast", *machine, *whole, "--window", f"0:{far}")
    for name in FILES:
        equal((directory / "fast" / name).read_bytes(), (directory / "reference" / name).read_bytes(), "engines:", name)
        equal((directory / "fast" / name).read_bytes(), (directory / "again" / name).read_bytes(), "two runs:", name)
    # Checkpoints on the way change nothing.
    run(directory / "checkpoints", "fast", *machine, *whole, "--window", f"0:{far}", "--checkpoint", "c",
        "--checkpoint-every", "333")
    for name in FILES:
        equal(read(directory / "checkpoints", name), read(directory / "fast", name), "with checkpoints:", name)
    # A series needs no observer: then the engine runs ahead, and its TMs of each other.
    run(directory / "series", "fast", *machine, *whole[2:], files=["series"])
    equal(read(directory / "series", "series"), read(directory / "fast", "series"), "a series alone")
    # A slow bus still moves the last stores when all threads have ended.
    for engine in "reference", "fast":
        run(directory / f"slow-{engine}", engine, *machine, "--set", "memory.bandwidth_gbps=0.1", "--set",
            "memory.latency_cycles=1", "--series-interval", "7", files=["series"])
    equal(read(directory / "slow-fast", "series"), read(directory / "slow-reference", "series"), "series of a slow bus")
    # A unit that is not pipelined refuses TPs for more cycles than the fast engine counts in a byte.
    for engine in "reference", "fast":
        run(directory / f"busy-{engine}", engine, "--config", "1x32", "--set", "special.pipelined=false", "--set",
            "special.latency_cycles=40", files=["profile", "waits"])
    for name in "profile", "waits":
        equal(read(directory / "busy-fast", name), read(directory / "busy-reference", name), "a busy unit:", name)
    # A hit is waited for, too, if it takes several cycles: by the instruction that uses it.
    for engine in "reference", "fast":
        run(directory / f"hits-{engine}", engine, *machine, "--set", "dcache.hit_latency_cycles=3",
            files=["waits", "profile"])
        hits = {(row["function"], row["object"]) for row in rows(directory / f"hits-{engine}", "waits")
                if row["wait_dcache_hit"] != "0"}
        check({("alternate", "even"), ("alternate", "odd"), ("divide", "divisor")} <= hits, "waits for hits:", hits)
        check(all(function in ("alternate", "divide", "inlined") for function, _ in hits), "waits for hits:", hits)
    equal(read(directory / "hits-fast", "profile"), read(directory / "hits-reference", "profile"), "bubbles by line")
    run(directory / "plain", "fast", *machine, files=[])
    stats = json.loads(read(directory / "fast", "stats.json"))
    plain = json.loads(read(directory / "plain", "stats.json"))
    for each in stats, plain:
        for key in "host_seconds", "instructions_per_host_second":
            del each[key]
    equal(stats, plain, "statistics with and without explanation")
    check(all(stats["causes"][name] for name in
              ("icache_miss", "wait_memory", "wait_special", "wait_atomic", "memory_queue_full", "branch_bubble")),
          "the program is too tame:", stats["causes"])

    check_tps(stats)
    check_energy(stats)
    equal(stats["energy"]["l2"], 0, "energy of no second-level cache")
    for engine in "reference", "fast":
        run(directory / f"l2-{engine}", engine, *machine, *whole, "--set", "l2.bytes=65536", "--set",
            "memory.channels=2",
            "--window", f"0:{far}")
    for name in FILES:
        equal(read(directory / "l2-fast", name), read(directory / "l2-reference", name), "engines, second-level cache:",
              name)
    with_l2 = json.loads(read(directory / "l2-fast", "stats.json"))
    check(with_l2["energy"]["l2"] > 0, "energy of the second-level cache")
    check_energy(with_l2)
    check_series(directory / "l2-fast", with_l2)
    here = directory / "fast"
    check_profile(here, stats)
    check_folded(here, stats)
    check_trace_and_page(here, stats)
    check_heat(here, stats)
    check_waits(here, stats)
    check_items(here, stats)
    check_series(here, stats)
    causes = check_perfetto(here, 0, stats["cycles"])
    equal(dict(causes), {k: v for k, v in stats["causes"].items() if v}, "causes on the time line")

    # A window in the middle, of some TPs.
    window = directory / "window"
    run(window, "fast", *machine, "--window", "2000:3000", "--window-tms", "1", "--window-tps", "0,2-4",
        files=["trace", "perfetto"])
    chosen = [line for line in read(here, "trace").splitlines()
              if re.match(r" +2\d\d\d +\d+ +1\.[0234] ", line)]
    equal(read(window, "trace").splitlines()[1:], chosen, "trace of the window")
    events = json.loads(read(window, "perfetto"))["traceEvents"]
    equal({(e["pid"], e["tid"] // 2) for e in events if e["ph"] == "X"}, {(1, tp) for tp in (0, 2, 3, 4)}, "window")
    equal(sum(e["dur"] for e in events if e["ph"] == "X"), 4 * 1000, "cycles of the window")

    # A run that does not finish is explained as far as it came.
    for engine in ["reference", "fast"]:
        run(directory / f"cut-{engine}", engine, *machine, "--max-cycles", "2222", "--window", f"0:{far}", expected=124)
    for name in FILES:
        equal(read(directory / "cut-fast", name), read(directory / "cut-reference", name), "engines, cut:", name)
    cut = json.loads(read(directory / "cut-fast", "stats.json"))
    equal(dict(check_perfetto(directory / "cut-fast", 0, 2222)), {k: v for k, v in cut["causes"].items() if v})
    check_series_end = rows(directory / "cut-fast", "series")[-1]["end"]
    equal(check_series_end, "2222", "the end of a cut series")

    # A window that nothing happens in, and programs without debug information, or that fault, or that do nothing.
    run(directory / "late", "fast", *machine, "--window", f"{far}:{far + 9}", files=["trace", "perfetto"])
    equal(dict(check_perfetto(directory / "late", far, far + 9)), {})
    equal(len(read(directory / "late", "trace").splitlines()), 1)
    (directory / "programs").mkdir()
    subprocess.run([WRITE_PROGRAMS, directory / "programs"], check=True)
    for name, status in ("null", 1), ("abort", 134), ("exit3", 3), ("mix", 0):
        for engine in ["reference", "fast"]:
            run(directory / f"{name}-{engine}", engine, "--config", "1x32", "--window", f"0:{far}", expected=status,
                program=str(directory / "programs" / f"{name}.elf"))
        for file in FILES:
            equal(read(directory / f"{name}-fast", file), read(directory / f"{name}-reference", file), "engines:", name,
                  file)
        ended = json.loads(read(directory / f"{name}-fast", "stats.json"))
        equal(dict(check_perfetto(directory / f"{name}-fast", 0, ended["cycles"], 1)),
              {k: v for k, v in ended["causes"].items() if v}, "causes on the time line of", name)
        folded = [line.rsplit(" ", 1) for line in read(directory / f"{name}-fast", "profile-folded").splitlines()]
        equal(sum(int(count) for _, count in folded), ended["thread_cycles"], "folded profile of", name)

    # Deeper than the stacks that are kept; what comes after is where it was called.
    run(directory / "deep", "fast", "--window", "0:9", program=DEEP)
    deep = [line.rsplit(" ", 1) for line in read(directory / "deep", "profile-folded").splitlines()]
    stats = json.loads(read(directory / "deep", "stats.json"))
    equal(sum(int(count) for _, count in deep), stats["thread_cycles"], "folded profile of deep calls")
    equal({re.sub(r";[^;]*:[^;]*", "", stack) for stack, _ in deep if "after" in stack and stack.endswith("issued")},
          {"_start;main;after;issued"}, "after deep calls")
    check(500 < max(stack.count("recursive") for stack, _ in deep) < 1500, "the depth of the stacks")
    objects = {row["object"]: int(row["stores"]) for row in rows(directory / "deep", "heat")}
    check(objects["(stacks)"] > 1500 * 2, "stores to the stacks", objects)

    # The report says which slow paths the fast engine took, and why; those of loads and of long programs, which the
    # tests of the command line lack.
    def slow(row, reason, *options, program=None):
        """The share of it."""
        run(directory / "slow", "fast", *machine, *options, files=["report"],
            **({"program": program} if program else {}))
        report = read(directory / "slow", "report")
        found = re.search(f"^  {row} .* ([0-9.]+) % of the .*: .*{reason}", report, re.MULTILINE)
        check(found, f"no '{row}' because of '{reason}' with {options}:", report[report.find("\nSlow paths"):])
        return float(found[1]) if found else 0

    slow("lines looked up", "a line of the burst was not resident")
    # Of up to 1023 lines the engine knows which are resident, and looks up few; of more it does not.
    longest, icache = str(directory / "programs" / "long.elf"), ("--set", "icache.bytes=8192", "--set")
    share = slow("lines looked up", "a line of the burst was not resident", *icache, "icache.line_bytes=8",
                 program=longest)
    check(share < 5, share, "% of the fetches look up one of 753 lines")
    share = slow("lines looked up", "the program has more than 1023 lines of instructions", *icache,
                 "icache.line_bytes=4", program=longest)
    check(20 < share < 100, share, "% of the fetches look up one of 1505 lines")
    slow("hits one by one", "dcache.hit_latency_cycles", "--set", "dcache.hit_latency_cycles=2")
    slow("hits one by one", "dcache.replacement", "--set", "dcache.ways=2", "--set", "dcache.replacement=lru")

    # What cannot be.
    def refuse(message, *options, files=()):
        said = run(directory / "refused", "fast", *machine, *options, files=list(files), expected=1)
        check(message in said and said.count("\n") == 1, f'"{message}" is not what is said of {options}:', said)
        check(not list((directory / "refused").iterdir()), "something is left by", options)

    refuse("--konata has been removed; --perfetto FILE", files=["konata"])
    refuse("--lockstep has been removed; --set simt.width", files=["lockstep"])
    refuse("--perfetto needs --window", files=["perfetto"])
    refuse("--window without --trace or --perfetto", "--window", "1:2")
    refuse("--window: '5' is not of the form BEGIN:END", "--window", "5", files=["trace"])
    refuse("--window: '5' is not a whole number from 10", "--window", "9:5", files=["trace"])
    refuse("--window-tps: '1-' is no list", "--window-tps", "1-", files=["trace"])
    refuse("--window-tms: '64' is no list", "--window-tms", "64", files=["trace"])
    refuse("the window has TM 2, but the chip has 2", "--window-tms", "2", files=["trace"])
    refuse("the window has TP 9, but a TM has 8", "--window-tps", "9", files=["trace"])
    refuse("--series-interval without --series", "--series-interval", "5")
    refuse("--item-buffer without --items or --explore", "--item-buffer", "results")
    refuse("no buffer nothing is bound, to which items store", "--item-buffer", "nothing", files=["items"])
    refuse("--resume: a run cannot be explained without its cycles", "--resume", "x", "--trace", "t")
    refuse("a run is explained by the engine fast, reference or simt, not functional", "--engine", "functional",
           "--profile", "x")
    for name in FILES:
        (directory / "full").mkdir(exist_ok=True)
        other = "heat" if name != "heat" else "profile"
        said = run(directory / "full", "fast", *machine, f"--{name}=/dev/full", "--window", "0:5000",
                   "--item-buffer=results",
                   *(["--items=i"] if name != "items" else []), *(["--trace=t"] if name != "trace" else []),
                   files=[other], expected=1)
        check("/dev/full: cannot be written: No space left on device" in said, f"--{name}=/dev/full:", said)
        equal(read(directory / "full", other), read(here, other), f"what else is written when --{name} fails")
        refuse("none/x: cannot be written", f"--{name}", "none/x", "--window", "0:9",
               "--trace=t" if name != "trace" else
               "--profile=t")
        refuse(f"--{name} is given twice", f"--{name}=a", f"--{name}=b")
    print(f"{checking.failures} failures" if checking.failures else "all hold")
    sys.exit(checking.failures != 0)


with tempfile.TemporaryDirectory() as scratch:
    main(pathlib.Path(scratch))
