#!/usr/bin/env python3
"""How runs end: backtraces of faults, where threads were, signals: usage endings_test.py BINDIR"""

import json
import os
import pty
import re
import resource
import select
import signal
import subprocess
import sys
import tempfile
import time
import unittest

BIN = os.path.abspath(sys.argv.pop(1))
SIM = os.path.join(BIN, "trax-sim")
SOURCE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "chains.c")
ENGINES = ("fast", "reference", "functional")


def setUpModule():
    global folder
    folder = tempfile.TemporaryDirectory()
    os.chdir(folder.name)
    subprocess.run([f"{BIN}/../tests/bin/emulator-programs", "."], check=True)


def tearDownModule():
    os.chdir("/")
    folder.cleanup()


def build(where, level, *options):
    name = f"chains{where}{level}{''.join(options)}.elf"
    if not os.path.exists(name):
        subprocess.run([f"{BIN}/clang", "--target=trax", level, f"-DWHERE={where}", *options, "-o", name, SOURCE],
                       check=True)
    return name


def run(*words):
    done = subprocess.run([SIM, *words], capture_output=True, timeout=120)
    return done.returncode, done.stdout.decode(), done.stderr.decode()


def line_of(text):
    """Of the source, from 1."""
    with open(SOURCE) as file:
        return next(number for number, line in enumerate(file, 1) if text in line)


def rows(report):
    """Pairs of label and text."""
    return re.findall(r"^  (\S[a-z. ]{0,10}\S)  +(.*)$", report, re.M)


class Backtraces(unittest.TestCase):
    def chain(self, where, level, engine="fast", *options):
        status, out, err = run("--engine", engine, build(where, level, *(options or ("-g",))))
        callers = [text for label, text in rows(err) if label == "called by"]
        return status, err, [re.split(r"[+ ,]", text)[0] for text in callers], callers

    def test_every_engine_and_level(self):
        for engine in ENGINES:
            for level in ("-O0", "-O1", "-Os", "-Oz"):
                status, err, names, callers = self.chain(8, level, engine)
                self.assertEqual(status, 1)
                self.assertRegex(err, rf"in +bottom.* at .*chains.c:{line_of('return *p;')}")
                self.assertEqual(names, ["top"] * 4 + ["main", "_start"], f"{engine} {level}\n{err}")
                self.assertIn(f"chains.c:{line_of('depth = top(p, n - 1)')}", callers[1])
                self.assertIn(f"chains.c:{line_of('? 0 : top(p, 3)')}", callers[4])

    def test_inlined(self):
        status, err, names, callers = self.chain(8, "-O1")
        self.assertRegex(err, rf"called by +top\S*, middle at .*:{line_of('return bottom(p) + 1;')}\S*\n"
                              rf" +inlined into top at .*:{line_of('return middle(p) + 2;')}")

    def test_abort(self):
        status, err, names, callers = self.chain(0, "-O1")
        self.assertEqual((status, names), (134, ["top"] * 4 + ["main", "_start"]))

    def test_jump_to_nowhere(self):
        for level in ("-O0", "-O2"):
            status, err, names, callers = self.chain(4, level)
            self.assertEqual((status, names), (1, ["jump", "main", "_start"]))

    def test_endless_recursion(self):
        """In local memory, and in a stack of megabytes: not all frames are shown."""
        status, err, names, callers = self.chain(1, "-O1")
        self.assertIn("stack overflow", err)
        self.assertEqual(names[-2:], ["main", "_start"])
        self.assertGreater(len(names), 20)
        status, err, names, callers = self.chain(1, "-O1", "functional", "-g", "-mstack=global",
                                                 "-Wl,-z,stack-size=65536")
        self.assertIn("stack overflow", err)
        self.assertEqual(len(names), 28, err)
        self.assertRegex(err, r"\n  \.\.\. +\d{4} frames\n")

    def test_global_stack(self):
        status, err, names, callers = self.chain(8, "-O1", "fast", "-g", "-mstack=global")
        self.assertEqual(names[-3:], ["top", "main", "_start"], err)

    def test_without_debug_information(self):
        """Nothing is known of frames: the return address is all there is."""
        status, err, names, callers = self.chain(8, "-O1", "fast", "-g0")
        self.assertEqual(names, [])
        self.assertIn("ra behind   top", err)
        self.assertNotIn("chains.c", err)

    def test_without_frame_information(self):
        """Lines are known, but not where a caller is."""
        with open(build(8, "-O1", "-g"), "rb") as file:
            data = bytearray(file.read())
        where = data.index(b".debug_frame\0")
        data[where : where + 12] = b".debug_gramf"
        with open("gone.elf", "wb") as file:
            file.write(data)
        status, out, err = run("gone.elf")
        self.assertNotIn("called by", err)
        self.assertIn("ra behind   top", err)


class PostMortem(unittest.TestCase):
    def groups(self, *words):
        status, out, err = run("--post-mortem", "pm.txt", *words)
        with open("pm.txt") as file:
            return status, file.read()

    def test_groups(self):
        for engine in ("fast", "functional"):
            limit = "20000" if engine == "functional" else "3000"
            status, text = self.groups("--config", "4x32", "--engine", engine, "--max-cycles", limit,
                                       build(2, "-O1", "-g"))
            self.assertEqual(status, 124)
            blocks = re.split(r"\n(?=\d)", text.rstrip("\n"))
            self.assertEqual(blocks[0], "128 threads, 1 ended")
            counts = {}
            for block in blocks[1:]:
                first, *others = block.split("\n")
                count, name = re.match(r"(\d+) threads? in (\w+) at .*chains.c:\d+$", first).groups()
                self.assertRegex(others[0], r"    called by main at .*chains.c:\d+")
                self.assertRegex(others[1], r"    called by _start at ")
                numbers = numbers_of(re.fullmatch(r"    threads? (.*)", others[2])[1])
                self.assertEqual(len(numbers), int(count))
                counts.setdefault(name, set()).update(numbers)
            gate = set(range(0, 20, 3))
            self.assertEqual(counts, {"one_of_three": gate, "wait_at_gate": set(range(128)) - gate - {25}})

    def test_finished(self):
        status, text = self.groups("--config", "2x32", "exit3.elf")
        self.assertEqual((status, text), (3, "64 threads, 64 ended\n"))

    def test_nothing_changes(self):
        """Looking at the end changes no statistics."""
        for name, words in (("a", []), ("b", ["--post-mortem", "pm.txt"])):
            run("--config", "2x32", "--max-cycles", "500", "--stats", f"{name}.json", *words, "mix.elf")
        figures = []
        for name in "ab":
            with open(f"{name}.json") as file:
                figures.append({key: value for key, value in json.load(file).items() if "host_second" not in key})
        self.assertEqual(*figures)

    def test_every_engine_with_time(self):
        for words in (("--max-cycles", "3000"), ("--watchdog", "500")):
            texts = [self.groups("--config", "2x32", "--engine", engine, *words,
                                 build(2, "-O1", "-g")) for engine in ("fast", "reference")]
            self.assertEqual(*texts)
            self.assertEqual(texts[0][0], 124)


def numbers_of(text):
    """Of "0-3, 7"."""
    result = []
    for part in text.split(", "):
        first, _, last = part.partition("-")
        result += range(int(first), int(last or first) + 1)
    return result


class Signals(unittest.TestCase):
    def start(self, *words, **keywords):
        """A program that prints for ever, once it has begun."""
        with open("out", "wb") as out:
            process = subprocess.Popen([SIM, *words], stdout=out, stderr=subprocess.PIPE, **keywords)
        self.addCleanup(process.stderr.close)
        self.addCleanup(lambda: process.poll() is None and process.kill())
        for _ in range(600):
            if os.path.getsize("out"):
                return process
            time.sleep(0.05)
        self.fail("nothing is printed")

    def end(self, process):
        return process.wait(timeout=60), process.stderr.read().decode()

    def partial(self, name):
        with open(name) as file:
            stats = json.load(file)
        return stats["status"], stats["partial"], stats["identity"]["holds"]

    def litter(self, *kept):
        return [
            name for name in os.listdir(".")
            if not re.fullmatch(r".*\.elf|out|pm\.txt|[ab]\.json|" + "|".join(kept), name)]

    def test_every_signal(self):
        """Statistics are written and say that they are partial; buffers are not; nothing half-written is left."""
        for engine in ENGINES:
            for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT):
                with open("s.json", "w") as file:
                    file.write("of before")
                process = self.start("--engine", engine, "--stats", "s.json", "--report", "r.txt", "print.elf")
                process.send_signal(number)
                status, err = self.end(process)
                self.assertEqual(status, -number, f"{engine} {number}")
                self.assertRegex(
                    err, "interrupted in instruction [1-9]" if engine == "functional" else "interrupted in cycle [1-9]")
                self.assertEqual(self.partial("s.json"), ("interrupted", True, True))
                with open("r.txt") as file:
                    self.assertIn("run      interrupted (partial)\n", file.read())
                self.assertEqual(self.litter("s.json", "r.txt"), [])
                for name in ("s.json", "r.txt"):
                    os.remove(name)

    def test_buffers(self):
        """What an earlier run left stays."""
        with open("d.bin", "w") as file:
            file.write("of before")
        status, out, err = run("--alloc", "input=64000000", "--alloc", "output=64000000", "--dump", "output=d.bin",
                               "--max-cycles",
                               "1000", "copy.elf")
        self.assertEqual(status, 124)
        run("--report", "r.txt", "--max-cycles", "1000", "print.elf")
        with open("r.txt") as file:
            self.assertIn("run      stopped at its limit (--max-cycles), before the program ended (partial)\n",
                          file.read())
        os.remove("r.txt")
        with open("d.bin") as file:
            self.assertEqual(file.read(), "of before")
        os.remove("d.bin")

    def test_file_size_limit(self):
        """A file beyond the limit is an error of writing, and nothing of it is left."""
        done = subprocess.run([SIM, "--trace", "trace.txt", "mix.elf"], capture_output=True, text=True, timeout=60,
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096)))
        self.assertEqual((done.returncode, done.stderr),
                         (1, "trax-sim: error: trace.txt: cannot be written: File too large\n"))
        self.assertEqual(self.litter(), [])

    def test_host_threads(self):
        process = self.start("--config", "4x32", "--host-threads", "3", "--stats", "s.json", "print.elf")
        process.send_signal(signal.SIGINT)
        self.assertEqual(self.end(process)[0], -signal.SIGINT)
        self.assertEqual(self.partial("s.json"), ("interrupted", True, True))
        os.remove("s.json")

    def test_quit_tells_where(self):
        process = self.start("--config", "1x32", "print.elf")
        process.send_signal(signal.SIGQUIT)
        status, err = self.end(process)
        self.assertEqual(status, -signal.SIGQUIT)
        self.assertRegex(err, r"32 threads, 0 ended\n(\d+ threads? in outer.*\n    threads? .*\n)+$")

    def test_second_signal(self):
        """While the first one's statistics cannot be written, for nobody reads the pipe."""
        os.mkfifo("pipe")
        process = self.start("--stats", "pipe", "print.elf")
        process.send_signal(signal.SIGINT)
        time.sleep(0.5)
        self.assertIsNone(process.poll())
        process.send_signal(signal.SIGINT)
        self.assertEqual(self.end(process)[0], -signal.SIGINT)
        os.remove("pipe")
        self.assertEqual(self.litter(), [])

    def test_ignored_signal(self):
        """What whoever started it ignores (nohup) stays ignored."""
        process = self.start("--max-cycles", "2000000", "print.elf",
                             preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_IGN))
        process.send_signal(signal.SIGINT)
        self.assertEqual(self.end(process)[0], 124)

    def piped(self, *words):
        """With a standard output that nobody reads: (status, standard error)."""
        reader, writer = os.pipe()
        os.close(reader)
        done = subprocess.run([SIM, *words], stdout=writer, stderr=subprocess.PIPE, timeout=60)
        os.close(writer)
        return done.returncode, done.stderr.decode()

    def test_reader_gone(self):
        """What follows the report is written; a program that writes to nobody is ended; a failure is told all the
        same."""
        buffers = ("--alloc", "input=64", "--alloc", "output=64", "--dump", "output=d.bin", "copy.elf")
        for where in ("--report", "--stats", "--profile"):
            self.assertEqual(self.piped(where, "-", *buffers), (141, ""), where)
            self.assertEqual(os.path.getsize("d.bin"), 64)
            os.remove("d.bin")
        status, err = self.piped("--report", "-", "--stats", "/dev/full", *buffers)
        self.assertEqual(status, 1)
        self.assertIn("/dev/full: cannot be written: No space left", err)
        os.remove("d.bin")
        self.assertEqual(self.piped("--report", "-", "exit3.elf"), (3, ""))
        status, err = self.piped("--stats", "s.json", "print.elf")  # for ever
        self.assertEqual(status, 141)
        self.assertEqual(self.partial("s.json"), ("interrupted", True, True))
        os.remove("s.json")
        self.assertEqual(self.litter(), [])


class Progress(unittest.TestCase):
    """The line on a terminal, of a program that finishes an item every few hundred cycles and does not end."""

    SOURCE = """#include <trax.h>
    int main(void) {
      for (volatile unsigned i = 0;; i++)
        if (i % 64 == 0)
          trax_count_items(1);
    }"""
    LINE = (
        r"trax-sim: running, ([\d.]+) million cycles, ([\d.]+) million instructions/s, (\d+) of 100000000 items, "
        r"([\d.]+) %"
        r"(?:, (?:(\d+):)?(\d+):(\d\d) left)?")

    def on_a_terminal(self, *words, seconds=0.7):
        """What is written to a terminal on standard error until the run is interrupted, after so many seconds and some
        lines."""
        master, slave = pty.openpty()
        process = subprocess.Popen([SIM, *words], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=slave)
        os.close(slave)
        written, deadline = b"", time.monotonic() + 60
        interrupt = None
        try:
            while time.monotonic() < deadline:
                if select.select([master], [], [], 0.1)[0]:
                    try:
                        data = os.read(master, 4096)
                    except OSError:  # nobody has the other end any more
                        break
                    written += data
                if interrupt is None and (b"left" in written or words[0] == "--quiet"):
                    interrupt = time.monotonic() + seconds
                if interrupt and time.monotonic() > interrupt and (written.count(b"\r") > 8 or words[0] == "--quiet"):
                    process.send_signal(signal.SIGINT)
                    interrupt = float("inf")
        finally:
            os.close(master)
            if time.monotonic() > deadline:
                process.kill()
        self.assertEqual(process.wait(timeout=60), -signal.SIGINT)
        return written.decode()

    def test_line(self):
        subprocess.run([f"{BIN}/clang", "--target=trax", "-O1", "-o", "forever.elf", "-x", "c", "-"], check=True,
                       input=self.SOURCE, text=True)
        for engine in ENGINES:
            text = self.on_a_terminal("--engine", engine, "--progress-total", "100000000", "forever.elf")
            shown, _, message = text.rpartition("\r\033[K")  # the line goes before the message comes
            self.assertRegex(message, r"^trax-sim: .*interrupted")
            lines = [line.removesuffix("\033[K") for line in shown.split("\r") if line]
            self.assertGreater(len(lines), 3, text)
            figures = [re.fullmatch(self.LINE, line) for line in lines]
            self.assertTrue(all(figures), lines)
            items = [int(figure[3]) for figure in figures]
            self.assertEqual(items, sorted(items))
            self.assertLess(items[0], items[-1])
            for figure in figures:
                self.assertAlmostEqual(float(figure[4]), int(figure[3]) / 1e6, delta=0.06)
                self.assertGreater(float(figure[2]), 0)
            self.assertIsNotNone(figures[-1][6])
            if engine != "functional":
                self.assertGreater(float(figures[-1][1]), 0)
        self.assertNotIn("million",
                         self.on_a_terminal("--quiet", "--progress-total", "100000000", "forever.elf", seconds=0.5))

    def test_summary(self):
        """The line at the end, on a terminal alone."""
        for words, expected in (((), r"trax-sim: \d+ cycles, [\d.e-]+ ms\r\n"), (("--quiet",), ""),
                                (("--stats", "s.json", "--report", "-", "--profile", "r.txt"),
                                 r"trax-sim: \d+ cycles, [\d.e-]+ ms; wrote s.json, r.txt\r\n"),
                                (("--engine", "functional"), r"trax-sim: \d+ instructions\r\n"),
                                (("--stats", "/dev/full"), r"trax-sim: .*error: .*\r\n")):
            master, slave = pty.openpty()
            subprocess.run([SIM, *words, "exit3.elf"], stdout=subprocess.DEVNULL, stderr=slave, timeout=60)
            os.close(slave)
            written = b""
            try:
                while data := os.read(master, 4096):
                    written += data
            except OSError:  # nobody has the other end any more
                pass
            os.close(master)
            self.assertRegex(written.decode().rpartition("\r\033[K")[2], f"^{expected}$")
        for name in ("s.json", "r.txt"):
            os.remove(name)


if __name__ == "__main__":
    unittest.main()
