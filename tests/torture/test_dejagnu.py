#!/usr/bin/env python3
"""The reader of dg- comments: options, conditions on targets and on the command line."""

import unittest

import dejagnu


class Read(unittest.TestCase):
    def test_options(self):
        read = dejagnu.read(
            '/* { dg-do run } */\n/* { dg-options "-O2 -fwrapv" } */ { dg-additional-options { "-g" } }', [])
        self.assertEqual(("run", ["-O2", "-fwrapv", "-g"], "", False),
                         (read.action, read.options, read.unsupported, read.errors))

    def test_options_of_other_machines(self):
        text = '{ dg-options "-msse" { target { i?86-*-* x86_64-*-* } } } { dg-options "-w" { target { ! lp64 } } }'
        self.assertEqual(["-w"], dejagnu.read(text, []).options)

    def test_programs_for_other_machines(self):
        self.assertTrue(dejagnu.read("{ dg-do compile { target mips*-*-* } }", []).unsupported)
        self.assertTrue(dejagnu.read("{ dg-do compile { target { { i?86-*-* x86_64-*-* } && { ! ia32 } } } }",
                                     []).unsupported)
        self.assertFalse(dejagnu.read("{ dg-do compile { target { ptr32plus && { ! llp64 } } } }", []).unsupported)
        self.assertFalse(dejagnu.read("{ dg-do run { target *-*-* } }", []).unsupported)

    def test_what_a_machine_lacks(self):
        self.assertTrue(dejagnu.read("{ dg-require-effective-target int128 }", []).unsupported)
        self.assertFalse(dejagnu.read("{ dg-require-effective-target int32plus }", []).unsupported)

    def test_skipped_with_options(self):
        text = '{ dg-skip-if "why" { *-*-* } "-fomit-frame-pointer" "" }'
        self.assertEqual("why", dejagnu.read(text, ["-fomit-frame-pointer"]).unsupported)
        self.assertEqual("", dejagnu.read(text, []).unsupported)
        text = '{ dg-skip-if "why" { *-*-* } { "*" } { "-O0" } }'
        self.assertEqual("", dejagnu.read(text, ["-O0"]).unsupported)
        self.assertEqual("why", dejagnu.read(text, ["-O2"]).unsupported)
        self.assertEqual("", dejagnu.read('{ dg-skip-if "why" { ! alloca } { "-O0" } { "" } }', ["-O0"]).unsupported)
        self.assertEqual("", dejagnu.read('{ dg-skip-if "why" { avr-*-* m32c-*-* } }', ["-O0"]).unsupported)
        self.assertEqual("why", dejagnu.read('{ dg-skip-if "why" { ! { i?86-*-* x86_64-*-* } } }', []).unsupported)

    def test_errors(self):
        self.assertTrue(dejagnu.read('int x; /* { dg-error "text {with} braces" } */', []).errors)
        self.assertFalse(dejagnu.read('int x; /* { dg-error "text" "" { target avr-*-* } } */', []).errors)

    def test_malformed(self):
        with self.assertRaises(dejagnu.Malformed):
            dejagnu.words('"no end')
        with self.assertRaises(dejagnu.Malformed):
            dejagnu.words("{ { }")


if __name__ == "__main__":
    unittest.main()
