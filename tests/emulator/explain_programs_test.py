#!/usr/bin/env python3
"""explain_programs_test.py BIN: what explains a run of a program that is large, recursive, foreign or odd."""

import collections
import csv
import json
import os
import pathlib
import re
import resource
import subprocess
import sys
import tempfile
import unittest
import unittest.mock

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "report"))
from explore_page import unpack  # noqa: E402

BIN = pathlib.Path(sys.argv.pop(1)).resolve()


class Elf:
    """An ELF32 file of which numbers are changed, each by its offset."""

    def __init__(self, given):
        self.bytes = bytearray(given)

    def number(self, at, size=4):
        return int.from_bytes(self.bytes[at : at + size], "little")

    def put(self, at, value):
        self.bytes[at : at + 4] = value.to_bytes(4, "little")

    def text(self, at):
        return self.bytes[at : self.bytes.index(0, at)].decode()

    def sections(self):
        return [self.number(32) + i * 40 for i in range(self.number(48, 2))]

    def section(self, name):
        names = self.number(self.sections()[self.number(50, 2)] + 16)
        return next(at for at in self.sections() if self.text(names + self.number(at)) == name)

    def symbol(self, name):
        table = next(at for at in self.sections() if self.number(at + 4) == 2)
        strings, begin = self.number(self.sections()[self.number(table + 24)] + 16), self.number(table + 16)
        return next(
            at
            for at in range(begin, begin + self.number(table + 20), 16)
            if self.text(strings + self.number(at)) == name
        )


class Programs(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name).resolve()

    def compile(self, name, text, *flags):
        (self.folder / f"{name}.c").write_text(text)
        subprocess.run(
            [BIN / "clang", "--target=trax", "-O1", "-g", *flags, f"{name}.c", "-o", name], cwd=self.folder, check=True
        )

    def run_sim(self, *words, status=0, cwd=None, seconds=None):
        """Its messages, and the most memory that it had, in bytes."""
        limit = (lambda: resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds))) if seconds else None
        process = subprocess.Popen(
            [BIN / "trax-sim", *words],
            cwd=cwd or self.folder,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
            preexec_fn=limit,
        )
        said = process.stderr.read()
        process.stderr.close()
        _, ended, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(ended)
        self.assertEqual(process.returncode, status, (words, said))
        return said, usage.ru_maxrss * 1024

    def folded(self, name):
        return {
            stack: int(count)
            for stack, count in (line.rsplit(" ", 1) for line in (self.folder / name).read_text().splitlines())
        }


class Waits(Programs):
    AT = 0x1008  # after the two instructions of la

    BOTH_ENDS = """lw r2, 0(r1)
              lw r3, 64(r1)
              add r4, r2, r3
              lw r5, 4(r1)
              fdiv r9, r4, r4
              add r6, r5, r5
              add r10, r9, r9
              ainc r7, 8(r1)
              add r8, r7, r7
              swnt r8, 72(r1)
              fence w"""

    def build(self, text):
        """Two objects, and a program that has the address of the first one in r1."""
        (self.folder / "waits.s").write_text(f"""
              .globl _start
            _start:
              la r1, first
              {text}
              halt
              .bss
              .balign 64
              .type first, @object
              .size first, 64
            first: .zero 64
              .type second, @object
              .size second, 64
            second: .zero 64
            """)
        command = [BIN / "clang", "--target=trax", "-nostdlib", "waits.s", "-o", "waits"]
        subprocess.run(command, cwd=self.folder, check=True)

    def expect(self, rows, *settings, status=0):
        """Of each row: the number of the instruction that is waited for and its object, that of the waiting one."""
        expected = [(self.AT + 4 * awaited, name, self.AT + 4 * waiting, {cause: cycles})
                    for awaited, name, waiting, cause, cycles in rows]
        settings = ["--quiet", "--set", "icache.line_bytes=1024", *settings]
        for engine in "reference", "fast", "simt":
            self.run_sim(*settings, "--engine", engine, "--waits", "waits.csv", "waits", status=status)
            found = [
                (
                    int(row["address"], 16),
                    row["object"],
                    int(row["waiting_address"], 16),
                    {name: int(row[name]) for name in row if row[name].isdigit() and row[name] != "0"},
                )
                for row in csv.DictReader((self.folder / "waits.csv").read_text().splitlines())
            ]
            self.assertEqual(found, expected, (engine, settings))

    def test_both_ends(self):
        """The first line takes the bus for 4 cycles and 100 more, the second one comes 4 cycles later. The loads are
        issued in t and t + 1, the sum of both in t + 108: from t + 2 it waits 102 cycles for the first and 4 for the
        second. A hit has a latency of 3 here, or of 1, and a division of 8. An increment comes after 101 cycles, and so
        does the end of a store."""
        self.build(self.BOTH_ENDS)
        begin = [(0, "first", 2, "wait_memory", 102), (1, "second", 2, "wait_memory", 4)]
        end = [(7, "first", 8, "wait_atomic", 100), (10, "", 10, "wait_memory", 101)]
        self.expect([*begin, (3, "first", 5, "wait_dcache_hit", 1), (4, "", 6, "wait_special", 5), *end],
                    "--set", "dcache.hit_latency_cycles=3")
        self.expect([*begin, (4, "", 6, "wait_special", 6), *end])

    def test_a_run_that_is_cut(self):
        """The instructions are there after 164 cycles, so the first sum waits from cycle 168 on."""
        self.build(self.BOTH_ENDS)
        self.expect([(0, "first", 2, "wait_memory", 32)], "--max-cycles", "200", status=124)

    def test_a_miss_before_a_division(self):
        """The passage that has the miss writes the quotient, too."""
        self.build("lw r2, 0(r1); fdiv r3, r0, r0; add r4, r3, r3")
        self.expect([(1, "", 2, "wait_special", 7)])

    def test_local_memory(self):
        self.build("sw r0, -8(r0); lw r2, -8(r0); add r3, r2, r2")
        self.expect([(1, "(local memory)", 2, "wait_local", 2)], "--set", "tp.local_latency_cycles=3")


class Heat(Programs):
    def test_lines(self):
        """Two lines that are 48,000 bytes apart."""
        self.compile("lines", """volatile unsigned a[16384] __attribute__((aligned(65536)));
            int main(void) { return a[0] + a[12000] + a[12001]; }""")
        self.run_sim("--quiet", "--heat-lines", "lines.csv", "lines")
        rows = csv.DictReader((self.folder / "lines.csv").read_text().splitlines())
        self.assertEqual([(row["offset"], row["loads"]) for row in rows if row["object"] == "a"],
                         [("0", "1"), ("48000", "2")])


class HostThreads(Programs):
    def count(self, name, text):
        """The profile on three threads of the host has each of the run's thread-cycles once."""
        self.compile(name, text)
        self.run_sim("--quiet", "--config", "4x32", "--host-threads", "3", "--profile-folded", "f", "--stats", "stats",
                     name)
        cycles = json.loads((self.folder / "stats").read_text())["thread_cycles"]
        self.assertEqual(sum(self.folded("f").values()), cycles)

    def test_each_passage_once(self):
        """They share the batches of passages."""
        self.count("loop", """volatile unsigned x[64];
            int main(void) {
              unsigned sum = 0;
              for (unsigned i = 0; i < 400000; i++) sum += x[i % 64];
              return sum;
            }""")

    def test_epochs_that_are_given_up(self):
        """TMs write words that others have loaded, again and again."""
        self.count("races", """#include <trax.h>
            volatile unsigned x[64];
            int main(void) {
              unsigned sum = 0;
              for (unsigned i = 0; i < 20000; i++) {
                sum += x[i % 64];
                if (i % 997 == 0) x[i % 64] = trax_thread();
              }
              return sum == 1;
            }""")


class Stacks(Programs):
    def many_stacks(self, text, all_of):
        """As many stacks as calls are not kept; what is kept adds up."""
        self.compile("many", text)
        plain = self.run_sim("--stats", "stats", "many")[1]
        stats = json.loads((self.folder / "stats").read_text())
        cycles = stats["thread_cycles"]
        reports = ["--profile", "p", "--profile-folded", "f", "--explore", "x", "--heat", "h"]
        self.assertLess(self.run_sim("--quiet", *reports, "many")[1] - plain, 200 << 20)
        self.assertLess(self.run_sim("--profile-sample", "s", "many")[1] - plain, 8 << 20)
        folded = self.folded("f")
        self.assertEqual(sum(folded.values()), cycles)
        heat = list(csv.DictReader((self.folder / "h").read_text().splitlines()))
        for name in "hits", "misses", "merged":
            self.assertEqual(sum(int(row[name]) for row in heat), stats["dcache"][name], name)
        data, _ = unpack(self.folder / "x")
        self.assertEqual(data["folded"], (self.folder / "f").read_text())
        table = {
            line.split()[-1]: line.split()
            for line in (self.folder / "p").read_text().split("\nLines\n")[0].splitlines()
            if line.strip()
        }
        for name in all_of:
            self.assertGreater(float(table[name][2]), 99, table[name])
        return folded

    def test_recursion(self):
        folded = self.many_stacks(
            """volatile unsigned x;
            __attribute__((noinline)) unsigned tree(unsigned d) {
              if (!d) return x;
              unsigned a = tree(d - 1);
              x = a;
              unsigned b = tree(d - 1);
              x = b;
              return a ^ (b + 1);
            }
            int main(void) { x = tree(17); }""",
            ["main", "tree"],
        )
        self.assertEqual({stack.count(";tree") for stack in folded if ";tree" in stack}, set(range(1, 19)))

    def test_mutual_recursion(self):
        text = "volatile unsigned x;\n" + "".join(
            f"__attribute__((noinline)) unsigned f{i}(unsigned);\n" for i in range(3)
        )
        for i in range(3):
            text += f"unsigned f{i}(unsigned d) {{ if (!d) return x; x = f{(i + 1) % 3}(d - 1); "
            text += f"x += f{(i + 2) % 3}(d - 1); return x + {i}; }}\n"
        self.many_stacks(text + "int main(void) { x = f0(17); }", ["main", "f0"])

    def test_paths_without_recursion(self):
        text = "volatile unsigned x;\n__attribute__((noinline)) unsigned f0(void) { return x += 3; }\n"
        for i in range(1, 18):
            text += f"__attribute__((noinline)) unsigned f{i}(void) {{ x = f{i - 1}(); x += f{i - 1}(); "
            text += f"return x + {i}; }}\n"
        self.many_stacks(text + "int main(void) { x = f17(); }", ["main", "f17"])

    def test_jump_within_recursive_function(self):
        """A function that jumps through a table before it makes its frame has not left itself, its caller."""
        self.compile(
            "walk",
            """volatile unsigned x, depth = 6;
            __attribute__((noinline)) unsigned walk(unsigned d, unsigned k) {
              switch (k) {
              case 0: x = 3; return d;
              case 1: x = 5; break;
              case 2: x = d * 7; break;
              case 3: x += 9; break;
              case 4: x ^= 11; break;
              case 5: x -= d; break;
              case 6: x *= d; break;
              default: return 0;
              }
              return walk(d - 1, k - 1) + x;
            }
            int main(void) { x = walk(depth, depth); }""",
            "-O2",
        )
        self.run_sim("--profile-folded", "f", "walk")
        self.assertEqual(
            {len(re.findall(";walk(?=;)", stack)) for stack in self.folded("f") if ";walk;" in stack}, set(range(1, 8))
        )

    def test_other_reports_change_nothing(self):
        """Equal rows are in the order of their names, not of the look-ups that other reports make."""
        self.compile(
            "equal",
            "volatile unsigned x;\n"
            + "".join(f"__attribute__((noinline)) void f{i}(void) {{\n  x = {i};\n}}\n" for i in range(9))
            + "int main(void) {\n"
            + "".join(f"  f{i * 5 % 9}();\n" for i in range(9))
            + "}\n",
        )
        self.run_sim("--profile", "alone", "equal")
        self.run_sim(
            "--quiet",
            "--profile",
            "beside",
            "--explore",
            "x",
            "--trace",
            "t",
            "--perfetto",
            "p",
            "--window",
            "0:1000",
            "equal",
        )
        self.assertEqual((self.folder / "alone").read_text(), (self.folder / "beside").read_text())


class Lines(Programs):
    def test_many_functions(self):
        """The time to find lines does not grow with the square of the functions: it was 20 s for these."""
        count = 2500
        text = "volatile unsigned x;\n" + "".join(
            f"__attribute__((noinline)) void f{i}(void) {{\n  x = x * {i}u + 3;\n  if (x & 1)\n    x ^= {i}u;\n}}\n"
            for i in range(count)
        )
        self.compile("large", text + "int main(void) {\n" + "".join(f"  f{i}();\n" for i in range(count)) + "}\n")
        self.run_sim(
            "--quiet",
            "--profile",
            "p",
            "--profile-sample",
            "s",
            "--profile-folded",
            "f",
            "--explore",
            "x",
            "large",
            seconds=8,
        )
        lines = collections.Counter(re.findall(r"large\.c:(\d+)$", (self.folder / "p").read_text(), re.MULTILINE))
        for i in 0, 1, count // 2, count - 1:  # the first line of each body
            self.assertEqual(lines[str(3 + 5 * i)], 1, i)
        sampled = re.findall(r"^f(\d+):", (self.folder / "s").read_text(), re.MULTILINE)
        self.assertEqual(sampled, sorted(map(str, range(count))))
        self.assertEqual(
            {f"f{i}" for i in range(count)}, set(re.findall(r"main;(f\d+);", (self.folder / "f").read_text()))
        )

    def test_symbols_within_symbols(self):
        """The nearest symbol that contains an address names it, the outer one again behind the inner one."""
        self.compile(
            "nested",
            """__asm__(".globl outer, label\\n.type outer, @function\\n.type inner, @function\\n"
            "outer:\\naddi r4, r0, 1\\ninner:\\naddi r4, r4, 2\\n.size inner, . - inner\\n"
            "addi r4, r4, 3\\nlabel:\\naddi r4, r4, 4\\n"
            "jalr r0, 0(r1)\\n.size outer, . - outer\\n");
            int outer(void);
            int main(void) { return outer(); }""",
        )
        self.run_sim("--trace", "t", "nested", status=10)
        named = [
            line.split()[4]
            for line in (self.folder / "t").read_text().splitlines()[1:]
            if re.search(r" (outer|inner|label)\b", line)
        ]
        self.assertEqual(named, ["outer", "inner", "outer+0x8", "label", "label+0x4"])

    def test_frames_behind_a_terminator(self):
        self.compile(
            "ended",
            """__asm__(".pushsection .debug_frame\\n.long 0\\n.popsection");
            __attribute__((noinline)) int bad(volatile int *at) { return *at + 1; }
            int main(void) { return bad((int *)8) + 1; }""",
        )
        said, _ = self.run_sim("ended", status=1)
        self.assertRegex(said, r"called by +main\+0x\w+ at .*ended\.c")


class Sources(Programs):
    """The page contains what belongs to the program, and nothing else that its debug information names."""

    def setUp(self):
        super().setUp()
        (self.folder / "home/.hidden").mkdir(parents=True)
        (self.folder / "home/sub").mkdir()
        (self.folder / "elsewhere").mkdir()
        for name in "elsewhere/secret.txt", "home/.hidden/key", "home/.rc", "home/sub/own.h":
            (self.folder / name).write_text(f"contents of {name}\n")
        (self.folder / "home/link.h").symlink_to("../elsewhere/secret.txt")
        (self.folder / "home/inside.h").symlink_to("sub/own.h")
        (self.folder / "way").symlink_to("home")

    def page(self, *words, where="home/main", cwd=None):
        said, _ = self.run_sim("--explore", self.folder / "x.html", *words, self.folder / where, cwd=cwd)
        data, _ = unpack(self.folder / "x.html")
        names = {
            path: path.replace(str(self.folder) + "/", "") for path in data["sources"]
        }  # some are relative to where the program was compiled
        return (
            {
                name if "/" in name and name != "sub/own.h" else f"home/{name}": data["sources"][path]
                for path, name in names.items()
            },
            data["left_out"],
            said,
        )

    def build(
        self,
        *flags,
        names=(
            "elsewhere/secret.txt",
            "home/.hidden/key",
            "home/.rc",
            "home/link.h",
            "home/inside.h",
            "home/sub/own.h",
        ),
    ):
        text = "volatile unsigned x;\n"
        for i, name in enumerate(names):
            text += f'#line 1 "{self.folder}/{name}"\n__attribute__((noinline)) void f{i}(void) {{ x += {i}; }}\n'
        text += (
            f'#line 20 "{self.folder}/home/main.c"\nint main(void) {{ '
            + "".join(f"f{i}(); " for i in range(len(names)))
            + "}\n"
        )
        (self.folder / "home/main.c").write_text(text)
        subprocess.run(
            [
                BIN / "clang",
                "--target=trax",
                "-O1",
                "-g",
                *flags,
                self.folder / "home/main.c",
                "-o",
                self.folder / "home/main",
            ],
            cwd=self.folder / "home",
            check=True,
        )

    def test_foreign(self):
        """Wherever it says that it was compiled."""
        for compiled in "/", "home", ".":
            self.build(
                f"-fdebug-compilation-dir={self.folder / compiled}" if compiled != "/" else "-fdebug-compilation-dir=/"
            )
            for cwd in self.folder / "home", self.folder / "elsewhere", pathlib.Path("/"):
                sources, left_out, said = self.page(cwd=cwd)
                own = {"home/main.c", "home/inside.h", "home/sub/own.h"}
                self.assertEqual(
                    set(sources),
                    own
                    | (
                        {"elsewhere/secret.txt", "home/link.h"}
                        if cwd.name == "elsewhere" and compiled != "home"
                        else set()
                    ),
                    (compiled, cwd),
                )
                for name in "main.c", "sub/own.h":
                    self.assertIn(name, said.split("; it lacks")[0])
                for name in ".hidden/key", ".rc":
                    self.assertIn(name, left_out)
                self.assertEqual(said.count("\n"), 1, said)
                self.assertRegex(said, "^trax-sim: note: .*x.html contains .*; it lacks .*--source-folder")

    def test_home(self):
        """A home is no project's folder, for all that a user has is in it."""
        self.build("-fdebug-compilation-dir=/")
        for home, expected in (self.folder / "home", 0), (self.folder / "way", 0), (self.folder / "elsewhere", 3):
            with unittest.mock.patch.dict(os.environ, HOME=str(home)):
                sources, _, _ = self.page(cwd=self.folder / "home")
            self.assertEqual(len(sources), expected, home)

    def test_compiled_elsewhere(self):
        self.build(f"-fdebug-compilation-dir={self.folder / 'elsewhere'}")
        self.assertEqual(self.page(cwd=self.folder / "home")[0], {})

    def test_given(self):
        self.build("-fdebug-compilation-dir=/nowhere")
        self.assertEqual(self.page()[0], {})
        sources, left_out, _ = self.page("--source-folder", "elsewhere")
        self.assertEqual(
            sources, {name: "contents of elsewhere/secret.txt\n" for name in ("elsewhere/secret.txt", "home/link.h")}
        )
        self.assertNotIn("secret", left_out)
        sources, left_out, _ = self.page("--source-folder", "elsewhere", "--source-folder", "way")
        self.assertEqual((len(sources), left_out), (7, ""))
        self.assertEqual(self.page("--source-folder", "home/sub")[0].keys(), {"home/sub/own.h", "home/inside.h"})

    def test_quiet(self):
        self.build()
        self.assertEqual(self.page("--quiet")[2], "")

    def test_refused(self):
        self.build()
        for words, message in (
            (["--source-folder", "home", "home/main"], "--source-folder without --explore"),
            (
                ["--explore", "y", "--source-folder", "home/main", "home/main"],
                "--source-folder: 'home/main' is no folder",
            ),
            (
                ["--explore", "y", *["--source-folder=home"] * 17, "home/main"],
                "--source-folder: 'home' is one too many: 16",
            ),
        ):
            self.assertIn(message, self.run_sim(*words, status=1)[0])


class Odd(Programs):
    def test_start_code(self):
        """A symbol table may give the start code any size and place."""
        self.compile(
            "start",
            """__asm__(".globl _start\\n.type _start, @function\\n_start:\\n"
                       "add r0, r0, r0\\ntrap r0, exit\\n.size _start, 8\\n.word main\\n");
            int main(void) { return 0; }""",
            "-nostartfiles",
        )
        elf = Elf((self.folder / "start").read_bytes())
        self.assertEqual(elf.number(elf.symbol("_start") + 8), 8)
        elf.symbol("main")  # the word keeps it
        for size in 8, 12, 0x7FFFFFFF, 0xF0000000, 0xFFFFFFFF:
            elf.put(elf.symbol("_start") + 8, size)
            (self.folder / "odd").write_bytes(elf.bytes)
            self.assertRegex(
                self.run_sim("--main-on", "0", "odd", status=1)[0],
                "^trax-sim: error: odd: main cannot be called on one thread",
            )
        # The start code for the other threads is where no instruction is.
        self.compile(
            "others",
            """int __trax_others[2], __trax_waiting[2];
            int main(void) { return __trax_others[0] + __trax_waiting[0]; }""",
        )
        self.assertRegex(
            self.run_sim("--main-on", "0", "others", status=1)[0],
            "^trax-sim: error: others: its start code for other threads is at 0x.*, where no instruction is",
        )

    def test_time_line_of_some_tms(self):
        self.compile("plain", "volatile unsigned x;\nint main(void) { for (int i = 0; i < 50; i++) x += 1; }")
        for tms, expected in (("0", {0}), ("1,3", {1, 3}), ("0-3", {0, 1, 2, 3})):
            self.run_sim("--config", "4x32", "--window", "100:3000", "--window-tms", tms, "--perfetto", "p", "plain")
            events = json.loads((self.folder / "p").read_text())["traceEvents"]
            for phase in "CXM":
                self.assertEqual({event["pid"] for event in events if event["ph"] == phase}, expected, (tms, phase))

    def test_names_in_tables(self):
        self.compile(
            "quoted",
            'volatile unsigned named[9] __asm__("a\\"b,c\\"\\"");\n'
            'int main(void) { for (unsigned i = 0; i < 9; i++) named[i] = i; }',
        )
        self.run_sim("--heat", "h", "--heat-lines", "l", "quoted")
        for name in "h", "l":
            rows = list(csv.DictReader((self.folder / name).read_text().splitlines()))
            self.assertEqual([row["object"] for row in rows if row["stores"] == "9"], ['a"b,c""'], name)
            self.assertEqual({None in row for row in rows}, {False})


if __name__ == "__main__":
    unittest.main()
