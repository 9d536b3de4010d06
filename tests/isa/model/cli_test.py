#!/usr/bin/env python3
"""The program trax-isa-model: options, exit statuses, signatures, files that are not images.

  cli_test.py MODEL MC LD
"""

import os
import subprocess
import sys
import tempfile
import unittest

MODEL, MC, LD = (os.path.abspath(path) for path in sys.argv[1:4])

SIGNATURE = """
.globl _start, begin_signature, end_signature
.data
.balign 4
begin_signature:
.word 0x12345678
.space 16
end_signature:
.text
_start:
la a0, begin_signature
rdsr a1, thread
"""


class Cli(unittest.TestCase):
    def setUp(self):
        self.directory = tempfile.TemporaryDirectory()
        self.addCleanup(self.directory.cleanup)
        self.signature = self.path("signature")

    def path(self, name):
        return os.path.join(self.directory.name, name)

    def link(self, text, name="image"):
        source, part, image = self.path(name + ".s"), self.path(name + ".o"), self.path(name)
        with open(source, "w", encoding="ascii") as file:
            file.write(text)
        subprocess.run([MC, "-filetype=obj", "-o", part, source], check=True)
        subprocess.run([LD, part, "-o", image], check=True)
        return image

    def run_model(self, *options):
        return subprocess.run([MODEL, *options], stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=60,
                              check=False)

    def read(self):
        with open(self.signature, encoding="ascii") as file:
            return file.read().split("\n")[:-1]

    def expect(self, status, *options, message=None):
        result = self.run_model(*options)
        self.assertEqual(result.returncode, status, result.stderr)
        if message is not None:
            self.assertIn(message, result.stderr.decode())
        return result

    def test_signature(self):
        image = self.link(SIGNATURE + "li a2, -2\nsw a2, 4(a0)\nsb a2, 8(a0)\nli a3, 65\ntrap a3, putc\nhalt\n")
        result = self.expect(0, "--signature", self.signature, image)
        self.assertEqual(result.stdout, b"A")
        self.assertEqual(self.read(), ["12345678", "fffffffe", "000000fe", "00000000", "00000000"])
        result = self.expect(0, "--signature", "-", image)
        self.assertEqual(result.stdout, b"A12345678\nfffffffe\n000000fe\n00000000\n00000000\n")

    def test_threads(self):
        """Words 1 to 3 count the threads in three ways; the exit status is the lowest thread's that is not 0."""
        image = self.link(SIGNATURE + "ainc r0, 4(a0)\nrdsr a2, threads\nsw a2, 8(a0)\nli a3, 66\ntrap a3, putc\n"
                          "rdsr a4, tm\nrdsr a5, tp\nadd a4, a4, a5\nslti a5, a4, 2\nbnez a5, 8\ntrap a4, exit\nhalt\n")
        result = self.expect(2, "--tms", "2", "--tps", "3", "--signature", self.signature, image)
        self.assertEqual(result.stdout, b"BBBBBB")
        self.assertEqual(self.read()[:3], ["12345678", "00000006", "00000006"])

    def test_cycle_counts_turns(self):
        image = self.link(SIGNATURE + "rdsr a2, cycle\nrdsr a3, cycleh\nsw a2, 4(a0)\nsw a3, 8(a0)\nhalt\n")
        self.expect(0, "--tps", "4", "--signature", self.signature, image)
        self.assertEqual(self.read()[:3], ["12345678", "00000003", "00000000"])

    def test_precision(self):
        image = self.link(SIGNATURE + "li a2, 0x40400000\nfrsqrt a3, a2\nsw a3, 4(a0)\nli a4, 0x3f800000\n"
                          "fdiv a3, a4, a2\nsw a3, 8(a0)\nhalt\n")
        self.expect(0, "--signature", self.signature, image)
        self.assertEqual(self.read()[1:3], ["3f13cd3a", "3eaaaaab"])
        self.expect(0, "--precision", "10", "--signature", self.signature, image)
        self.assertEqual(self.read()[1:3], ["3f13c000", "3eaac000"])  # to nearest, ten significant bits

    def test_faults(self):
        cases = {"lw a2, 2(a0)": ("misaligned", "0000100c", None), "sw a2, 0(r0)": ("null", "0000100c", "00000000"),
                 "lw a2, -513(r0)": ("stack", "0000100c", "fffffdff"),
                 "ainc a2, -4(r0)": ("local", "0000100c", "fffffffc"),
                 "lui a2, 0x8000\nlb a2, 5(a2)": ("unmapped", "00001010", "80000005"),
                 "lui a2, 0\nsw a2, %lo(_start)(r0)": ("readonly", "00001010", "00001000"),
                 "jr a0": ("fetch", None, None), "addi a0, a0, 2\njr a0": ("misaligned-pc", None, None),
                 ".word 0": ("illegal", "0000100c", "00000000"), "trap a1, abort": ("abort", "0000100c", "00000000")}
        for text, (kind, pc, address) in cases.items():
            with self.subTest(text):
                image = self.link(SIGNATURE + text + "\nli a1, 1\nsw a1, 4(a0)\nhalt\n")
                result = self.expect(134 if kind == "abort" else 1, "--signature", self.signature, image,
                                     message=f"fault: {kind}, ")
                self.assertEqual(result.stdout, b"")
                lines = self.read()
                self.assertEqual(lines[:2], ["12345678", "00000000"])
                words = lines[-1].split()
                self.assertEqual(words[:2], ["fault", kind])
                if pc:
                    self.assertEqual(words[3], pc)
                if address:
                    self.assertEqual(words[5], address)

    def test_limit(self):
        image = self.link(SIGNATURE + "j 0\n")
        self.expect(124, "--limit", "1000", "--signature", self.signature, image, message="1000 instructions")
        self.assertFalse(os.path.exists(self.signature))

    def test_wrong_images(self):
        image = self.link(".globl _start\n_start: halt\n")
        self.expect(0, image)
        self.expect(1, "--signature", self.signature, image, message="begin_signature")
        self.expect(1, self.path("none"), message="none: cannot be read")
        self.expect(1, self.path("image.o"), message="not an executable for the machine")
        self.expect(1, MODEL, message="not an executable for the machine")
        self.expect(1, __file__, message="not an ELF file")
        half = self.link(".globl _start, begin_signature\n_start: halt\nbegin_signature:\n", "half")
        self.expect(1, half, message="do not enclose")
        with open(image, "rb") as file:
            data = file.read()
        for at in range(0, len(data)):  # whatever is damaged: an orderly end, the status of an error or of the program
            damaged = bytearray(data)
            damaged[at] ^= 1 << at % 8
            with open(self.path("damaged"), "wb") as file:
                file.write(damaged)
            if at % 19 == 0 or at < 84:
                self.assertIn(self.run_model("--limit", "1000", self.path("damaged")).returncode, (0, 1, 124), at)

    def test_wrong_options(self):
        image = self.link(".globl _start\n_start: halt\n")
        for options, message in ((["--tms", "0"], "from 1 to 64"), (["--tps", "65"], "from 1 to 64"),
                                 (["--limit", "x"], "from 1 to"), (["--precision", "25"], "from 1 to 24"),
                                 (["--memory-mib", "-1"], "from 1 to 4095"), ([image], "one image"),
                                 (["--frobnicate"], "frobnicate"),
                                 (["--manual", self.path("none")], "none: cannot be read"),
                                 (["--manual", __file__], "the page describes no instruction"),
                                 (["--signature", self.path("no/where")], "begin_signature")):
            with self.subTest(options):
                self.expect(1, *options, image, message=message)
        self.expect(1, message="an image is needed")
        image = self.link(SIGNATURE + "halt\n")
        self.expect(1, "--signature", self.path("no/where"), image, message="cannot be written")

    def test_a_manual_with_a_word_too_many(self):
        page = self.path("page.md")
        with open(page, "w", encoding="ascii") as file:
            file.write("### halt\n 31..26 25..0\n| 42 | 0 |\nSemantics: `HALT(); SLEEP();`\n")
        image = self.link(".globl _start\n_start: halt\n")
        self.expect(1, "--manual", page, image, message="page.md:4:21: halt: unknown word 'SLEEP'")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
