"""Parts of files_test.py that harm a run: it is killed, or has no room, or another process changes its folder. A file
of the user is then as a whole what it was or what the program wrote, and nothing outside the folder is read or
written."""

import pathlib
import random
import stat
import subprocess
import time

import sequences

NAMES = [f"v{i}" for i in range(5)]


def contents(count, seed):
    """As in operations.c."""
    return (bytes((seed * 31 + i * 7 + (i >> 8)) & 255 for i in range(509)) * (count // 509 + 1))[:count]


class Versions:
    """Files that are written again and again, in each way that programs use. `room`: bytes that the host lets a file
    have."""

    def __init__(self, seed, room=1 << 30):
        pick = random.Random(seed)
        self.begin, self.lines = [], []
        self.last, self.failed = {}, 0
        for name in NAMES:
            size = pick.choice(sequences.SIZES[:6])
            self.begin.append(f"F {name} {size} {pick.randrange(100)} 644 0")
            self.last[name] = contents(size, int(self.begin[-1].split()[3]))
        self.all = {name: [self.last[name]] for name in NAMES}
        self.possible = {name: [self.last[name]] for name in NAMES}  # each write may fail
        for _ in range(120):
            name, size, seed = pick.choice(NAMES), pick.choice(sequences.SIZES), pick.randrange(100)
            written, way = contents(size, seed), pick.randrange(4)
            self.possible[name] += [text + written for text in self.possible[name]] if way == 1 else [written]
            path, flags = (name, "wct") if way == 0 else (name, "wa") if way == 1 else ("t", "wct")
            written = self.last[name] + written if way == 1 else written
            self.lines += (
                [f"o 1 {path} {flags}", f"w 1 {size} {seed}"] + (["R t " + name] if way == 2 else []) + ["c 1"]
            )
            self.lines += [f"R t {name}"] if way == 3 else []
            self.all[name].append(written)
            if len(written) <= room:
                self.last[name] = written
            elif way != 1 or size:
                self.failed += 1

    def scripts(self):
        return "\n".join(["Q q", *self.begin, ""]), "\n".join(["Q q", *self.lines, ""])


def wrong(allowed_by_name, folder):
    """Names of files that are none of their versions."""
    whole = [allowed_by_name[name] for name in NAMES]
    return [name for name, allowed in zip(NAMES, whole) if (folder / "q" / name).read_bytes() not in allowed]


def killed(tools, options):
    """A run without checkpoints."""
    pick, count = random.Random(options.seed), max(3, options.count // 50)
    for i in range(count):
        versions = Versions(options.seed + i)
        begin, script = versions.scripts()
        folder = tools.fresh("guest-files", begin)
        with tools.start(
            tools.simulate("--engine", "functional"), folder, tools.write(tools.root / "script", script)
        ) as process:
            time.sleep(pick.uniform(0, 0.06))
            process.kill()
            process.communicate()
        tools.check(f"killed {options.seed + i}", not wrong(versions.all, folder), wrong(versions.all, folder))
    print(f"killed: {count} runs", flush=True)


def limited(tools, options):
    """Files that become longer than the host lets them be, and a file system that is full."""
    count = max(3, options.count // 50)
    for i in range(count):
        room = random.Random(options.seed + i).choice((3000, 4096, 8192, 15000))
        versions = Versions(options.seed + i, room)
        begin, script = versions.scripts()
        folder = tools.fresh("guest-files", begin)
        path = tools.write(tools.root / "script", script)
        status, output, message = tools.run(tools.simulate("--engine", "functional"), folder, path, room)
        found = {name: (folder / "q" / name).read_bytes() for name in NAMES}
        begun = {name: text[0] for name, text in versions.all.items()}
        tools.check(
            f"limited {options.seed + i}",
            status == 0
            and output.count("c -1 27") == versions.failed
            and {name for name in NAMES if found[name] != versions.last[name] and len(begun[name]) <= room} == set(),
            (status, output.count("c -1 27"), versions.failed, message),
        )
        folder = tools.fresh("guest-files", begin)
        status, _, message = tools.run(tools.simulate("--checkpoint", tools.root / "none"), folder, path, room)
        tools.check(
            f"limited with checkpoints {options.seed + i}",
            not wrong(versions.all, folder) and (status == 0 or "cannot be written" in message),
            (status, message, wrong(versions.all, folder)),
        )
    full(tools, options, count)
    print(f"limited: {count} runs", flush=True)


def full(tools, options, count):
    place = tools.root / "guest-files"
    subprocess.run(["rm", "-rf", place], check=True)
    place.mkdir()
    if (
        subprocess.run(
            ["mount", "-t", "tmpfs", "-o", "size=80k", "none", place], capture_output=True, check=False
        ).returncode
        != 0
    ):
        print("full: skipped, because no small file system can be mounted")
        return
    try:
        for i in range(count):
            versions = Versions(options.seed + i)
            begin, script = versions.scripts()
            for how in (
                ["--engine", "functional"],
                ["--checkpoint", tools.root / "none", "--checkpoint-every", "300000"],
            ):
                subprocess.run(f"rm -rf {place}/*", shell=True, check=True)
                (place / "q").mkdir()
                tools.run([tools.host], place, tools.write(tools.root / "script", begin))
                status, output, message = tools.run(
                    tools.simulate(*how), place, tools.write(tools.root / "script", script)
                )
                tools.check(
                    f"full {how[0]} {options.seed + i}",
                    not wrong(versions.possible, place)
                    and ("c -1 28" in output or status == 0 or "cannot be written" in message),
                    (status, output[-200:], message),
                )
                tools.check(f"full {how[0]} {options.seed + i}: what it left", not list(place.rglob(".trax-*")))
    finally:
        subprocess.run(["umount", place], check=True)


def disturbed(tools, options):
    """Links, pipes and folders appear and go meanwhile."""
    count = max(2, options.count // 100)
    for i in range(count):
        seed, work = options.seed + i, tools.root / f"disturbed{i}"
        inside, outside = work / "in", work / "outside"
        (inside / "q").mkdir(parents=True)
        outside.mkdir()
        (outside / "secret").write_text("SECRET" * 1000)
        (outside / "a").write_text("SECRET" * 2)
        before = listing(outside)
        kind, how = (
            ("all", ["--engine", "functional"]),
            ("pending", ["--checkpoint", work / "state", "--checkpoint-every", "300000"]),
        )[i % 2]
        lines = [
            line
            for number in range(60 if i % 2 else 200)
            for line in ["Q q", *sequences.Sequence(1000 * seed + number, kind, tools.huge, options.small).lines]
        ]
        script = tools.write(tools.root / "script", "\n".join([*lines, ""]))
        with subprocess.Popen([tools.host, "DISTURB", "20", str(seed)], cwd=inside) as other:
            try:
                status, output, message = tools.run(tools.simulate(*how), inside, script)
            finally:
                other.kill()
        good = status == 0 or "cannot be written" in message
        tools.check(f"disturbed {seed}: the run", good, (status, message))
        tools.check(f"disturbed {seed}: read outside", "outside was read" not in output)
        tools.check(f"disturbed {seed}: written outside", listing(outside) == before, listing(outside))
    print(f"disturbed: {count} runs", flush=True)


def listing(folder):
    return {
        str(path): path.read_bytes() if stat.S_ISREG(path.lstat().st_mode) else stat.filemode(path.lstat().st_mode)
        for path in pathlib.Path(folder).rglob("*")
    }


PARTS = {"killed": killed, "limited": limited, "disturbed": disturbed}
