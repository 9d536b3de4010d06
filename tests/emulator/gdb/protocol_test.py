#!/usr/bin/env python3
"""The debugger's stub by its packets, without GDB: usage protocol_test.py BINDIR"""

import json
import os
import re
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest

sys.dont_write_bytecode = True  # not beside the sources
from client import ENGINE, Client, thread_of  # noqa: E402

BIN = os.path.abspath(sys.argv.pop(1))
SIM = os.path.join(BIN, "trax-sim")
HERE = os.path.dirname(os.path.abspath(__file__))
FOUR = ("--set", "chip.tms=2", "--set", "chip.tps_per_tm=2")
SP, RA, A0, A1 = 2, 1, 4, 5
LOCAL = 0xFFFFFE00


def setUpModule():
    global work, symbols
    work = tempfile.TemporaryDirectory()
    symbols = {}
    for name in ("threads", "calls", "loop", "fault", "increments"):
        elf = path(name)
        subprocess.run([f"{BIN}/clang", "--target=trax", "-O1", "-g", "-o", elf, f"{HERE}/{name}.c"], check=True)
        symbols[name] = read_symbols(elf)
    subprocess.run([f"{BIN}/../tests/bin/emulator-programs", work.name], check=True)


def tearDownModule():
    work.cleanup()


def path(name):
    return os.path.join(work.name, name + ".elf")


def read_symbols(elf):
    """Of a little-endian ELF32 file, by name."""
    with open(elf, "rb") as file:
        data = file.read()

    def number(at, size=4):
        return int.from_bytes(data[at:at + size], "little")

    sections = [number(32) + i * number(46, 2) for i in range(number(48, 2))]
    result = {}
    for section in sections:
        if number(section + 4) == 2:  # SHT_SYMTAB
            strings = number(sections[number(section + 24)] + 16)
            for entry in range(number(section + 16), number(section + 16) + number(section + 20), 16):
                name = strings + number(entry)
                result[data[name : data.index(0, name)].decode()] = number(entry + 4)
    return result


def figures(*arguments):
    """The JSON of a run without a debugger, less what depends on the host."""
    stats = os.path.join(work.name, "plain.json")
    subprocess.run([SIM, "--engine", "fast", "--stats", stats, *arguments], stdout=subprocess.DEVNULL, check=False)
    return read_figures(stats)


def read_figures(name):
    with open(name) as file:
        return {key: value for key, value in json.load(file).items() if "host_second" not in key}


class Protocol(unittest.TestCase):
    def client(self, name, *arguments, **keywords):
        client = Client(SIM, *arguments, path(name), **keywords)
        self.addCleanup(client.process.stdout.close)
        self.addCleanup(client.process.stderr.close)
        self.addCleanup(client.socket.close)
        self.addCleanup(lambda: client.process.poll() is None and client.process.kill())
        return client

    def test_acknowledgement(self):
        client = self.client("calls", acknowledge=True)
        client.socket.sendall(b"$?#00")  # a wrong sum
        self.assertEqual(client.byte(), b"-")
        first = client.ask("?")
        client.socket.sendall(b"-")  # once more, please
        self.assertEqual(client.receive(), first)
        client.socket.sendall(b"$g$?#3f")  # one that has lost its end
        self.assertEqual(client.byte(), b"+")
        self.assertEqual(client.receive(), first)
        self.assertEqual(client.ask("QStartNoAckMode"), "OK")
        client.acknowledge = False
        self.assertEqual(client.ask("?"), first)
        self.assertEqual(client.ask("vMustReplyEmpty"), "")

    def test_unknown_and_bad(self):
        client = self.client("calls")
        for packet in ("", "!", "b", "vFile:open:0", "qTStatus", "QNonStop:1", "Z5,0,4", "qXfer:auxv:read::0,10"):
            self.assertEqual(client.ask(packet), "", packet)
        bad = ["p", "p99", "P5", "P5=1", "P99=00000000", "m", "m1000", "m10000000000,4", "M1000,4:00", "M10000,1:0",
               "X10000,4:ab", "Hx1", "H", "Hg", "Hg999", "T0", "Tff", "Z0,1000", "Z0,2,4", "Z0,7fffffff,4", "Z2,1000,0",
               "z0,1", "vCont;q", "vCont;c:99", "vCont;r1", "vCont;r1,2x", "vCont;", "qXfer:features:read:target.xml:0",
               "qThreadExtraInfo,0", "qRcmd,4", "qRcmd,zz", "Gabc", "c12345", "sffffffff", "C", "S"]
        for packet in bad:
            self.assertRegex(client.ask(packet), "^E..$", packet)
        client.socket.sendall(b"$" + b"a" * 50000 + b"#00")  # too long: not acknowledged, not answered
        self.assertEqual(client.ask("qC"), "QC1")

    def test_description(self):
        client = self.client("calls")
        whole = client.ask("qXfer:features:read:target.xml:0,4000")
        parts, text = 0, ""
        while True:
            part = client.ask(f"qXfer:features:read:target.xml:{len(text):x},64")
            text += part[1:]
            parts += 1
            if part[0] == "l":
                break
        self.assertEqual(whole, "l" + text)
        self.assertGreater(parts, 10)
        self.assertIn("<architecture>riscv:rv32</architecture>", text)
        self.assertEqual(len(re.findall("<reg ", text)), 65)
        self.assertEqual(client.ask("qXfer:features:read:target.xml:10000,10"), "l")

    def test_threads(self):
        client = self.client("threads", *FOUR)
        self.assertEqual(client.ask("qfThreadInfo"), "m1,2,3,4")
        self.assertEqual(client.ask("qsThreadInfo"), "l")
        self.assertEqual(bytes.fromhex(client.ask("qThreadExtraInfo,4")), b"TM 1 TP 1")
        self.assertIn('<thread id="3" core="1" name="TM 1 TP 0"/>', client.ask("qXfer:threads:read::0,1000"))
        self.assertEqual([client.ask(f"T{i}") for i in (1, 4, 5)], ["OK", "OK", "E03"])
        # A thread that has ended is no thread any more.
        end = symbols["threads"]["main"]
        client.ask(f"Z0,{end:x},4")
        self.assertEqual(thread_of(client.resume()), 0)
        self.assertEqual(client.ask(f"z0,{end:x},4"), "OK")
        while client.ask("T1") == "OK":
            stop = client.resume("vCont;s:1;c")
        self.assertEqual(stop[:2], ("T", 5))  # of another thread, since the stepping one will have no stop any more
        self.assertEqual(client.ask(f"T{thread_of(stop) + 1:x}"), "OK")
        self.assertEqual(client.resume()[:2], ("W", 0))

    def test_registers(self):
        client = self.client("calls")
        client.ask(f"Z0,{symbols['calls']['walk']:x},4")
        client.resume()
        self.assertEqual(client.register("pc"), symbols["calls"]["walk"])
        self.assertEqual(client.register(A1), 3)
        self.assertEqual(client.register(0), 0)
        everything = client.ask("g")
        self.assertEqual(len(everything), 65 * 8)
        words = [int.from_bytes(bytes.fromhex(everything[i : i + 8]), "little") for i in range(0, 65 * 8, 8)]
        self.assertEqual((words[11], words[33 + A1], words[32]), (3, 3, client.register("pc")))
        self.assertEqual(client.set_register(A1, 1), "OK")
        self.assertEqual(client.register(A1), 1)
        self.assertRegex(client.set_register(0, 1), "^E")
        self.assertRegex(client.set_register("pc", 0x40), "^E")
        self.assertRegex(client.set_register("pc", symbols["calls"]["walk"] + 2), "^E")
        self.assertEqual(client.ask("G" + everything), "OK")
        self.assertEqual(client.register(A1), 3)
        own = everything[: (33 + A1) * 8] + "02000000" + everything[(34 + A1) * 8 :]
        self.assertEqual(client.ask("G" + own), "OK")  # by our own number
        self.assertEqual(client.register(A1), 2)
        client.ask(f"z0,{symbols['calls']['walk']:x},4")
        self.assertEqual(client.resume()[:2], ("W", 7 + 2 + 2 + 4 + 3))  # walk(&p, 2)
        self.assertEqual(client.end()[0], "18\n")

    def test_pc(self):
        """A function is called twice: the thread is sent back."""
        client = self.client("calls")
        walk = symbols["calls"]["walk"]
        client.ask(f"Z0,{walk:x},4")
        client.resume()
        arguments = client.register(A0), client.register(SP), client.register(RA)
        client.ask(f"z0,{walk:x},4")
        client.ask(f"Z0,{arguments[2]:x},4")
        while client.register(SP) != arguments[1] or client.register("pc") != arguments[2]:
            client.resume()
        self.assertEqual(client.register(A0), 28)
        total = client.word(symbols["calls"]["total"])
        for number, value in ((A0, arguments[0]), (A1, 1), (RA, arguments[2])):
            client.set_register(number, value)
        self.assertEqual(client.set_register("pc", walk), "OK")
        self.assertEqual(client.resume()[0], "T")
        self.assertEqual(client.register(A0), 11)
        self.assertEqual(client.word(symbols["calls"]["total"]), total + 7)
        client.ask(f"z0,{arguments[2]:x},4")
        self.assertEqual(client.resume()[:2], ("W", 11))

    def test_memory(self):
        client = self.client("threads", *FOUR)
        shared, mine = symbols["threads"]["shared"], symbols["threads"]["mine"]
        self.assertGreaterEqual(mine, LOCAL)
        for thread in range(4):
            client.select(thread)
            self.assertEqual(client.ask(f"M{mine:x},4:{thread + 10:02x}000000"), "OK")
        for thread in range(4):
            client.select(thread)
            self.assertEqual(client.word(mine), thread + 10)
        self.assertEqual(client.ask(f"X{shared:x},4:}}\x03*\x7f}}]"), "OK")  # escaped: # * 0x7f }
        self.assertEqual(client.read(shared, 4), b"#*\x7f}")
        self.assertEqual(client.ask(f"X{shared:x},0:"), "OK")
        self.assertEqual(client.ask("mfffffffe,10"), "0000")  # what there is
        for address in (0, 0xFFC, 0xF0000000, LOCAL - 4):
            self.assertIsNone(client.read(address, 4), hex(address))
        before = client.read(0x1000, 8)
        self.assertRegex(client.ask("M1000,4:00000000"), "^E")
        self.assertEqual(client.read(0x1000, 8), before)
        self.assertRegex(client.ask("Mfffffffe,4:00000000"), "^E")
        self.assertEqual(client.read(0xFFFFFFFE, 2), b"\0\0")
        # What was written is what the program finds: work adds 1 + 2 + 3.
        client.resume()
        self.assertEqual(client.end()[2], 1)

    def test_breakpoints_of_all_threads(self):
        """Every thread stops at every one of its visits, and the run is not disturbed."""
        stats = os.path.join(work.name, "debugged.json")
        client = self.client("threads", *FOUR, "--stats", stats)
        at = symbols["threads"]["work"]
        self.assertEqual(client.ask(f"Z0,{at:x},4"), "OK")
        self.assertEqual(client.ask(f"Z0,{at:x},4"), "OK")  # twice is once
        visits, cycles = [], []
        while (stop := client.resume())[0] == "T":
            self.assertEqual((stop[1], "swbreak" in stop[2]), (5, True))
            self.assertEqual(client.register("pc"), at)
            visits.append((thread_of(stop), client.register(A0)))
            cycles.append(client.cycle())
        self.assertEqual(stop[:2], ("W", 0))
        self.assertEqual(sorted(visits), [(thread, i) for thread in range(4) for i in (1, 2, 3)])
        self.assertEqual(cycles, sorted(cycles))
        client.end()
        self.assertEqual(read_figures(stats), figures(*FOUR, path("threads")))

    def test_as_gdb_steps_over(self):
        """As GDB does it: the breakpoint is taken away, one thread is stepped alone, the breakpoint comes back. The
        others miss nothing, and no stop but the stepped thread's comes while it is stepped."""
        stats = os.path.join(work.name, "debugged.json")
        client = self.client("threads", *FOUR, "--stats", stats)
        at, visits = symbols["threads"]["work"], []
        client.ask(f"Z0,{at:x},4")
        stop = client.resume("vCont;c")
        while stop[0] == "T":
            thread = thread_of(stop)
            visits.append((thread, client.register(A0)))
            client.ask(f"z0,{at:x},4")
            step = client.resume(f"vCont;s:{thread + 1:x}")
            self.assertEqual((step[0], step[1], thread_of(step)), ("T", 5, thread))
            self.assertEqual(client.register("pc"), at + 4)
            self.assertEqual(step[2]["20"], (at + 4).to_bytes(4, "little").hex())
            client.ask(f"Z0,{at:x},4")
            stop = client.resume("vCont;c")
        self.assertEqual(stop[:2], ("W", 0))
        self.assertEqual(sorted(visits), [(thread, i) for thread in range(4) for i in (1, 2, 3)])
        client.end()
        self.assertEqual(read_figures(stats), figures(*FOUR, path("threads")))

    def test_breakpoints_on_neighbours(self):
        """Every thread meets each of three breakpoints in a row, as GDB steps over them."""
        stats = os.path.join(work.name, "debugged.json")
        client = self.client("threads", *FOUR, "--stats", stats)
        work_at = symbols["threads"]["work"]
        places = [work_at, work_at + 4, work_at + 8]
        for place in places:
            client.ask(f"Z0,{place:x},4")
        visits = []
        stop = client.resume("vCont;c")
        while stop[0] == "T":
            thread, pc = thread_of(stop), int.from_bytes(bytes.fromhex(stop[2]["20"]), "little")
            visits.append((thread, pc))
            client.ask(f"z0,{pc:x},4")
            stop = client.resume(f"vCont;s:{thread + 1:x}")
            self.assertEqual((stop[:2], thread_of(stop)), (("T", 5), thread))
            client.ask(f"Z0,{pc:x},4")
            self.assertEqual(client.register("pc"), pc + 4)
            if pc == places[-1]:
                stop = client.resume("vCont;c")
        self.assertEqual(stop[:2], ("W", 0))
        self.assertEqual(sorted(visits),
                         sorted((thread, place) for thread in range(4) for place in places for _ in range(3)))
        client.end()
        self.assertEqual(read_figures(stats), figures(*FOUR, path("threads")))

    def test_removed_for_good(self):
        client = self.client("threads", *FOUR)
        at = symbols["threads"]["work"]
        client.ask(f"Z1,{at:x},4")
        client.resume()
        client.ask(f"z1,{at:x},4")
        self.assertEqual(client.resume()[:2], ("W", 0))

    def test_step(self):
        """A thread that is stepped issues one instruction, in the cycle in which it would."""
        client = self.client("threads", *FOUR)
        trace, last = [], -1
        while (stop := client.resume("vCont;s:3;c"))[0] == "T" and len(trace) < 2000:
            self.assertEqual(thread_of(stop), 2)
            self.assertGreater(client.cycle(), last)
            last = client.cycle()
            trace.append((last, client.register("pc")))
            if client.ask("T3") != "OK":
                break
        self.assertEqual(stop[:2], ("W", 0))
        again = self.client("threads", *FOUR)
        again.ask("Hc3")
        for cycle, pc in trace[:100]:
            again.resume("s")
            self.assertEqual((again.cycle(), again.register("pc")), (cycle, pc))

    def test_range(self):
        client = self.client("calls")
        walk = symbols["calls"]["walk"]
        client.ask(f"Z0,{walk:x},4")
        client.resume()
        stop = client.resume(f"vCont;r{walk:x},{walk + 8:x}:1;c")
        self.assertEqual((stop[0], client.register("pc")), ("T", walk + 8))

    def test_all_step(self):
        client = self.client("threads", *FOUR)
        self.assertEqual(client.resume("vCont;s")[:2], ("T", 5))

    def watch(self, client, kind, name, size=4, program="threads"):
        self.assertEqual(client.ask(f"Z{kind},{symbols[program][name]:x},{size:x}"), "OK")

    def test_watch_write(self):
        client = self.client("threads", *FOUR)
        shared = symbols["threads"]["shared"]
        self.watch(client, 2, "shared", 16)
        seen = []
        while (stop := client.resume())[0] == "T":
            place = int(stop[2]["watch"], 16)
            self.assertEqual(place, shared + 4 * thread_of(stop))
            seen.append((thread_of(stop), client.word(place)))
        self.assertEqual(sorted(seen), [(thread, sum) for thread in range(4) for sum in (1, 3, 6)])

    def test_watch_read_and_access(self):
        for kind, word, accesses in ((3, "rwatch", 1), (4, "awatch", 2)):
            client = self.client("threads", *FOUR)
            shared = symbols["threads"]["shared"]
            client.ask(f"Z{kind},{shared + 8:x},4")
            seen = 0
            while (stop := client.resume())[0] == "T":
                self.assertEqual((thread_of(stop), int(stop[2][word], 16)), (2, shared + 8))
                seen += 1
            self.assertEqual(seen, 3 * accesses, word)

    def test_watch_local(self):
        """Local memory is that of the thread that was selected."""
        client = self.client("threads", *FOUR)
        client.select(3)
        self.watch(client, 2, "mine")
        seen = []
        while (stop := client.resume())[0] == "T":
            self.assertEqual(thread_of(stop), 3)
            seen.append(client.word(symbols["threads"]["mine"]))
        self.assertEqual(seen, [1, 3, 6])

    def test_watch_local_stays(self):
        """GDB removes and inserts watchpoints at each stop, whichever thread is selected then."""
        client = self.client("threads", *FOUR)
        mine, work_at = symbols["threads"]["mine"], symbols["threads"]["work"]
        client.select(3)
        self.watch(client, 2, "mine")
        client.ask(f"Z0,{work_at:x},4")
        seen = []
        while (stop := client.resume())[0] == "T":
            client.select(thread_of(stop))
            if "watch" in stop[2]:
                seen.append((thread_of(stop), client.word(mine)))
            for change in "zZ":
                self.assertEqual(client.ask(f"{change}2,{mine:x},4"), "OK")
        self.assertEqual(seen, [(3, 1), (3, 3), (3, 6)])

    def test_watch_removed_for_good(self):
        """A watchpoint that was away while the run continued is the selected thread's again."""
        client = self.client("threads", *FOUR)
        mine, work_at = symbols["threads"]["mine"], symbols["threads"]["work"]
        client.select(3)
        self.watch(client, 2, "mine")
        self.assertEqual(thread_of(client.resume()), 3)
        client.ask(f"z2,{mine:x},4")
        client.ask(f"Z0,{work_at:x},4")
        while thread_of(client.resume()) != 3:
            pass
        client.ask(f"z0,{work_at:x},4")
        client.select(1)
        self.watch(client, 2, "mine")
        seen = []
        while (stop := client.resume())[0] == "T":
            seen.append(thread_of(stop))
        self.assertEqual(set(seen), {1})

    def test_watch_increments_without_result(self):
        """An increment with r0 has no arrival; the word changes."""
        client = self.client("increments")
        self.watch(client, 2, "first", program="increments")
        self.watch(client, 2, "second", program="increments")
        seen = []
        while (stop := client.resume())[0] == "T":
            values = [client.word(symbols["increments"][name]) for name in ("first", "second")]
            seen.append((int(stop[2]["watch"], 16) - symbols["increments"]["first"], values))
        self.assertEqual(seen, [(0, [1, 0]), (4, [1, 1]), (0, [2, 1])])

    def test_watch_atomic(self):
        client = self.client("threads", *FOUR)
        self.watch(client, 2, "counter")
        seen, values = [], []
        while (stop := client.resume())[0] == "T":
            seen.append(thread_of(stop))
            values.append(client.word(symbols["threads"]["counter"]))
        self.assertEqual(sorted(seen), sorted(3 * [0, 1, 2, 3]))
        self.assertEqual(values, sorted(values))
        self.assertEqual(values[-1], 12)

    def test_watch_removed(self):
        client = self.client("threads", *FOUR)
        self.watch(client, 2, "shared", 16)
        client.resume()
        self.assertEqual(client.ask(f"z2,{symbols['threads']['shared']:x},10"), "OK")
        self.assertEqual(client.resume()[:2], ("W", 0))

    def test_interrupt(self):
        stats = os.path.join(work.name, "interrupted.json")
        client = self.client("loop", "--stats", stats)
        stops, deadline = 0, time.monotonic() + 60
        while time.monotonic() < deadline and (stops < 3 or client.word(symbols["loop"]["turns"]) <= 100):
            client.send("vCont;c")
            time.sleep(0.05)
            stop = client.interrupt()
            self.assertEqual(stop[:2], ("T", 2))
            stops += 1
        self.assertGreater(client.word(symbols["loop"]["turns"]), 100)
        self.assertEqual(client.ask(f"M{symbols['loop']['go_on']:x},4:00000000"), "OK")
        self.assertEqual(client.resume()[:2], ("W", 5))
        self.assertEqual(client.end()[2], 5)
        self.assertEqual(read_figures(stats)["status"], "finished")

    def test_fault(self):
        client = self.client("fault")
        stop = client.resume()
        self.assertEqual(stop[:2], ("T", 11))
        self.assertEqual(client.register("pc"), symbols["fault"]["load"])
        self.assertEqual(client.register(A0), 8)
        self.assertEqual(client.ask("?")[:3], "T0b")
        self.assertRegex(client.set_register(A0, 0x2000), "^E")
        self.assertEqual(client.resume(), ("X", 11, {}))
        out, err, status = client.end()
        self.assertIn("fault: access to the null page", err)
        self.assertEqual(status, 1)

    def test_fault_beside_a_step(self):
        client = self.client("fault", *FOUR)
        client.ask(f"Z0,{symbols['fault']['load']:x},4")
        client.resume()
        client.ask(f"z0,{symbols['fault']['load']:x},4")
        while (stop := client.resume("vCont;s:1"))[0] == "T" and stop[1] == 5:
            self.assertEqual(thread_of(stop), 0)
        self.assertEqual(stop[:2], ("T", 11))

    def test_abort(self):
        client = self.client("abort")
        self.assertEqual(client.resume()[:2], ("T", 6))
        self.assertEqual(client.resume()[:2], ("X", 6))
        self.assertEqual(client.end()[2], 134)

    def test_limit(self):
        client = self.client("spin", "--max-cycles", "3000")
        self.assertEqual(client.resume()[:2], ("X", 24))
        self.assertEqual(client.end()[2], 124)

    def test_kill(self):
        for packet, answer in (("k", None), ("vKill;1", "OK")):
            client = self.client("spin")
            client.send(packet)
            if answer:
                self.assertEqual(client.receive(), answer)
            self.assertEqual(client.end()[2], 128 + 9)

    def test_detach(self):
        stats = os.path.join(work.name, "detached.json")
        client = self.client("threads", *FOUR, "--stats", stats)
        client.ask(f"Z0,{symbols['threads']['work']:x},4")
        client.resume()
        self.assertEqual(client.ask("D"), "OK")
        self.assertEqual(client.end()[2], 0)
        self.assertEqual(read_figures(stats), figures(*FOUR, path("threads")))

    def test_closed(self):
        """A debugger that goes away leaves the program to itself, stopped or running."""
        client = self.client("calls")
        client.socket.close()
        self.assertEqual(client.end()[::2], ("28\n", 28))
        client = self.client("spin", "--max-cycles", "300000")
        client.send("vCont;c")
        client.socket.close()
        self.assertEqual(client.end()[2], 124)

    def test_monitor(self):
        client = self.client("threads", *FOUR)
        self.assertEqual(client.monitor("cycle"), "0\n")
        client.ask(f"Z0,{symbols['threads']['work']:x},4")
        client.resume()
        self.assertIn("=> 0x%08x" % symbols["threads"]["work"], client.monitor("disassemble"))
        self.assertIn("0x00001000", client.monitor("disassemble 0x1000 3"))
        self.assertEqual(len(client.monitor("disassemble 0x1000 3").splitlines()), 3)
        self.assertIn("r5  a1", client.monitor("registers"))
        self.assertIn("instructions", client.monitor("stats"))
        self.assertRegex(client.monitor("where"),
                         r"^work at .*threads.c:7\n    called by main at .*\n    called by _start at .*\n$")
        self.assertRegex(client.monitor("threads"),
                         r"^4 threads, 0 ended\n(4 threads in work at (.*\n){3}    threads 0-3|[1-3] thr)")
        self.assertIn("monitor cycle", client.monitor("help"))
        for command in ("", "cycles", "cycle now", "disassemble x", "disassemble 2", "disassemble 0x1000 5 5"):
            self.assertIn("not understood", client.monitor(command), command)

    def test_statistics_between(self):
        """monitor stats counts up to here, and changes nothing."""
        stats = os.path.join(work.name, "asked.json")
        client = self.client("threads", *FOUR, "--stats", stats)
        client.ask(f"Z0,{symbols['threads']['work']:x},4")
        seen = 0
        while client.resume()[0] == "T":
            told = {line.split()[0]: float(line.split()[1]) for line in client.monitor("stats").splitlines()}
            causes = sum(value for name, value in told.items() if name.startswith("causes."))
            self.assertEqual((told["cycles"], causes), (client.cycle(), 4 * client.cycle()))
            self.assertEqual(told["causes.issued"], told["instructions"])
            self.assertGreaterEqual(told["instructions"], seen)
            seen = told["instructions"]
        self.assertGreater(seen, 100)
        client.end()
        self.assertEqual(read_figures(stats), figures(*FOUR, path("threads")))

    @unittest.skipUnless(ENGINE == "fast", "the engine has no checkpoints")
    def test_resumed(self):
        """The rest of a run that a checkpoint holds."""
        stats, checkpoint = (os.path.join(work.name, name) for name in ("resumed.json", "checkpoint"))
        subprocess.run([SIM, *FOUR, "--checkpoint", checkpoint, "--max-cycles", "200", path("threads")],
                       stderr=subprocess.PIPE)
        client = self.client("threads", *FOUR, "--resume", checkpoint, "--stats", stats)
        self.assertEqual(client.cycle(), 200)
        client.ask(f"Z0,{symbols['threads']['work']:x},4")
        while client.resume()[0] == "T":
            self.assertGreater(client.cycle(), 200)
        client.end()
        self.assertEqual(read_figures(stats), figures(*FOUR, path("threads")))

    def test_signal_while_stopped(self):
        stats = os.path.join(work.name, "signal.json")
        client = self.client("spin", "--stats", stats)
        client.resume("vCont;s:1;c")
        client.process.send_signal(signal.SIGINT)
        self.assertEqual(client.receive()[:3], "X02")
        self.assertEqual(client.end()[2], -signal.SIGINT)
        self.assertEqual(read_figures(stats)["partial"], True)

    def test_signal_while_nobody_reads(self):
        """A debugger that asks and does not read does not keep trax-sim from ending."""
        packet = b"m1000,2000"
        for _ in range(6):  # how much of a reply waits differs
            client = self.client("spin")
            client.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
            client.socket.sendall(b"$%b#%02x" % (packet, sum(packet) % 256) * 3000)
            time.sleep(0.2)
            client.process.send_signal(signal.SIGINT)
            self.assertEqual(client.process.wait(timeout=20), -signal.SIGINT)
            client.process.communicate()

    def test_too_long(self):
        for acknowledge in (False, True):
            client = Client(SIM, path("calls"), acknowledge=acknowledge)
            self.assertEqual(client.ask("m" + "1" * 20000), "E5a")
            self.assertEqual(client.ask("T1"), "OK")
            client.send("k")
            client.end()

    def test_signal_while_waiting(self):
        stats = os.path.join(work.name, "never.json")
        process = subprocess.Popen([SIM, "--gdb", "0", "--stats", stats, path("spin")], stderr=subprocess.PIPE)
        process.stderr.readline()
        process.send_signal(signal.SIGTERM)
        self.assertIn(b"interrupted before a debugger came", process.communicate(timeout=60)[1])
        self.assertEqual(process.returncode, -signal.SIGTERM)
        self.assertFalse(os.path.exists(stats))

    def refused(self, *arguments):
        run = subprocess.run([SIM, *arguments], capture_output=True, timeout=60)
        self.assertEqual((run.returncode, run.stdout), (1, b""), arguments)
        return run.stderr.decode()

    def test_options(self):
        with socket.socket() as taken:
            taken.bind(("127.0.0.1", 0))
            taken.listen(1)
            port = str(taken.getsockname()[1])
            self.assertIn("Address already in use", self.refused("--gdb", port, path("calls")))
        self.assertIn("--gdb: '65536' is not a whole number", self.refused("--gdb", "65536", path("calls")))
        self.assertIn("--gdb needs the engine fast, reference or simt, not functional",
                      self.refused("--gdb", "0", "--engine", "functional", path("calls")))


if __name__ == "__main__":
    unittest.main()
