"""Random sequences of operations on files, as scripts for operations.c. A sequence follows from its seed and kind."""

import os
import random

# What a sequence may do. `pending`: changes that may wait for a checkpoint; `rights`: run by a user who may not write
# everything.
KINDS = ("all", "pending", "rights")
NAMES = ("a", "b", "c", "n", "d/a", "d/b", "d/n", "e/a", "h", "l", "dead", "ll/a", "d/e/a")
FOLDERS = ("d", "e", "d/e", "f")
LONG = ("x" * 248, "y" * 249, "z" * 250, "v" * 255, "w" * 256)
SIZES = (0, 1, 5, 100, 4095, 4096, 4097, 8191, 8192, 9000, 20000)
FAR = (2**32, 2**32 - 1, 2**32 - 4096, 2**31, 2**31 - 1, 2**33, 100000)
SMALL = (30000, 60000, 100000)  # for --small instead of these
HUGE = (2**62, -(2**62), 2**63 - 1, -(2**63), 2**61)


class Sequence:
    def __init__(self, seed, kind="all", huge=True, small=False):
        self.random = random.Random(f"{kind} {seed}")
        self.kind, self.huge, self.far = kind, huge and not small, SMALL if small else FAR
        self.begin, self.lines, self.open, self.closed, self.folders = [], [], {}, [], []
        self.prepare()
        for _ in range(self.random.randrange(4, 40)):
            self.step()
        if self.random.randrange(4):  # else they are left open
            self.lines += [f"c {slot}" for slot in sorted(self.open)]

    def chance(self, one_in):
        return self.random.randrange(one_in) == 0

    def prepare(self):
        """Files, folders, links and second names that the sequence finds. Permissions come last."""
        pick, rights = self.random, []
        for folder in ("d", "e", "d/e"):
            if pick.randrange(3):
                self.begin.append(f"M {folder}")
        made = {line[2:] for line in self.begin}
        if "d/e" in made and "d" not in made:
            self.begin.remove("M d/e")
            made.discard("d/e")
        for name in ("a", "b", "c", "d/a", "d/b", "e/a"):
            if "/" in name and name.rsplit("/", 1)[0] not in made or self.chance(3):
                continue
            hole = pick.choice((0, 0, 0, 0, 5000, self.far[0] - 30000))
            self.begin.append(
                f"F {name} {pick.choice(SIZES)} {pick.randrange(100)} {pick.choice(('644', '600', '640'))} {hole}"
            )
            made.add(name)
        if "a" in made and self.chance(3):
            self.begin.append("H h a")
        if "d/a" in made and "d/b" not in made and self.chance(4):
            self.begin.append("H d/b d/a")
        self.has_links = any(line.startswith("H") for line in self.begin)
        for name, target in (("l", "a"), ("ll", "d"), ("dead", "n"), ("loop", "loop"), ("l2", "d/../l")):
            if self.chance(2):
                self.begin.append(f"Y {name} {target}")
        if self.kind == "rights":
            for name in sorted(made & {"a", "b", "d/a", "e/a"}):
                if self.chance(3):
                    rights.append(f"P {name} {pick.choice(('444', '000'))}")
            for folder in sorted(made & {"d", "e"}):
                if self.chance(3):  # what is there cannot be written: the program's files are replaced
                    rights += [
                        f"P {name} 444" for name in sorted(made) if name.startswith(folder + "/") and name != "d/e"
                    ]
                    rights.append(f"P {folder} {pick.choice(('555', '444'))}")
        self.begin += rights

    def name(self):
        pick = self.random
        name = pick.choice(LONG) if self.chance(25) else pick.choice(NAMES)
        if self.chance(8):
            name = pick.choice(
                ("l", "ll", "loop", "l2", "d", "e", ".", "..", "d/.", "ll/b", "d/..", "''", "none/x", "a/x")
            )
        if self.chance(8):
            name = pick.choice(("./", "d/../", ".//", "ll/../", "d/./../", "e/../")) + name
        if self.chance(12):
            name += pick.choice(("/", "/", "//", "/.", "/x"))
        return "''" if os.path.normpath(name).startswith("..") else name  # nothing above the sequence's folder

    def step(self):
        kinds = {
            "open": 6,
            "read": 4,
            "write": 7,
            "seek": 3,
            "truncate": 2,
            "close": 5,
            "look": 3,
            "unlink": 3,
            "rename": 5,
            "folder": 3,
            "duplicate": 2,
            "list": 2,
            "open_folder": 2,
            "from_folder": 3,
        }
        getattr(self, "do_" + self.random.choices(tuple(kinds), tuple(kinds.values()))[0])()

    def slot(self):
        if self.open and self.random.randrange(20):
            return self.random.choice(sorted(self.open))
        return self.random.randrange(16)

    def do_open(self):
        slot = self.random.randrange(16)
        if slot in self.open:
            self.do_close(slot)
        flags = self.random.choice(("r", "w", "b", "b")) + "".join(
            c for c, one in (("c", 2), ("t", 3), ("x", 8), ("a", 5), ("n", 6)) if self.chance(one)
        )
        if "x" in flags and "c" not in flags:
            flags = flags.replace("x", "")
        name = self.name()
        self.lines.append(f"o {slot} {name} {flags}")
        self.open[slot] = name

    def do_close(self, slot=None):
        slot = self.slot() if slot is None else slot
        self.lines.append(f"c {slot}")
        self.closed.append(self.open.pop(slot, "a"))

    def do_duplicate(self):
        """Also of nothing, in whose place a file may be."""
        slot, other = self.slot(), self.random.randrange(16)
        if self.chance(4):
            if slot in self.open:
                self.do_close(slot)
            self.lines.append(f"z {slot} {self.random.choice(('r', 'w', 'b', 'bct', 'bcx'))}")
            self.open[slot] = "a"
        if slot in self.open:
            self.lines.append(f"D {slot} {other}")
            self.open[other] = self.open[slot]

    def do_list(self):
        self.lines.append(f"l {self.name() if self.chance(3) else self.random.choice(FOLDERS + ('.',))}")

    def do_open_folder(self):
        slot = self.random.randrange(16)
        if slot in self.open:
            self.do_close(slot)
        name = self.random.choice(FOLDERS + ("ll", ".", "d/..", "a", "l"))
        self.lines.append(f"o {slot} {name} r{self.random.choice(('', 'd', 'dn', 'a'))}")
        self.open[slot] = name
        self.folders.append(slot)

    def do_from_folder(self):
        """Names from an open folder, or from what has its descriptor now."""
        if not self.folders:
            self.do_open_folder()
        if self.kind == "rights" and any(line[0] in "dRev" for line in self.lines):
            return  # a folder that is gone and may not be searched has two errors
        pick = self.random
        slot, name = pick.choice(self.folders), pick.choice(NAMES)
        changes = () if self.kind == "pending" or self.has_links else ("v", "v", "k", "e")
        kind = pick.choice(("A", "A", "a", "X", *changes))
        if kind == "A":
            other = pick.choice([i for i in range(16) if i not in self.open] or [15])
            if other in self.open:
                self.do_close(other)
            flags = pick.choice(("r", "b", "bc", "wct", "rd", "rn"))
            self.lines.append(f"A {slot} {name} {other} {flags}")
            self.open[other] = name
            if pick.randrange(2):
                self.folders.append(other)
        elif kind == "e":
            self.lines.append(f"e {slot} {name} {pick.choice(self.folders)} {pick.choice(NAMES)}")
        else:
            self.lines.append(f"{kind} {slot} {name} {pick.choice('df')}")

    def do_read(self):
        self.lines.append(f"r {self.slot()} {self.random.choice(SIZES)}")

    def do_write(self):
        slot = self.slot()
        self.lines.append(f"w {slot} {self.random.choice(SIZES)} {self.random.randrange(100)}")
        if self.chance(3):
            self.lines.append(f"s {slot} 0 1")
        if self.chance(4):
            self.lines += [f"s {slot} 0 0", f"r {slot} 30000"]

    def do_seek(self):
        pick = self.random
        offset = pick.choice((0, 0, 1, -1, 10, 4096, -4096, pick.randrange(-30000, 30000)))
        if self.chance(6):
            offset = pick.choice(self.far)
        if self.huge and self.chance(8):
            offset = pick.choice(HUGE)
        slot = self.slot()
        self.lines.append(f"s {slot} {offset} {pick.choice((0, 0, 1, 1, 2, 2, 7))}")
        if self.huge and self.chance(8):
            self.lines += [f"s {slot} {2**62} 0", f"s {slot} {2**62} 1", f"s {slot} 0 1"]

    def do_truncate(self):
        size = self.random.choice(SIZES + (-1, 50000)) if self.random.randrange(5) else self.random.choice(self.far)
        self.lines.append(f"t {self.slot()} {size}")

    def do_look(self):
        self.lines.append(
            self.random.choice((f"f {self.slot()}", f"S {self.name()}", f"L {self.name()}", f"S {self.name()}"))
        )
        if self.chance(4):
            name = self.name()
            self.lines.append(f"i {name} {self.random.choice(('./', 'd/../')) + name}")

    def do_unlink(self):
        name = self.name()
        if self.kind == "pending" and self.is_link(name):
            return
        self.lines.append(f"u {name}")
        if self.chance(3):
            self.lines.append(f"o {self.random.choice([i for i in range(16) if i not in self.open] or [0])} {name} bc")
            self.open[int(self.lines[-1].split()[1])] = name

    def is_link(self, name):
        """A link itself, which a run with checkpoints does not change; or a folder."""
        last = [part for part in name.split("/") if part not in (".", "")]
        return (
            not last
            or last[-1] in ("l", "ll", "dead", "loop", "l2", "d", "e", "f", "..", "''")
            or name.endswith(("/", "/."))
        )

    def do_rename(self):
        one, other = self.name(), self.name()
        if self.open and self.chance(3):
            one = self.open[self.random.choice(sorted(self.open))]
        elif self.closed and self.chance(3):
            one = self.random.choice(self.closed)
        if self.chance(4):
            one, other = self.random.choice(FOLDERS), self.random.choice(FOLDERS + ("a", "d/n", "n", "ll"))
        if self.chance(6):
            other = self.random.choice(("", "./", "d/../", "e/../")) + one
        if self.chance(6):  # the usual way to replace a file
            self.lines += [f"o 15 t {self.random.choice(('wct', 'bc'))}", f"w 15 {self.random.choice(SIZES)} 3"]
            one = "t"
            self.open[15] = "t"
            if self.chance(2):
                self.do_close(15)
        if self.has_links and self.place(one) != self.place(other):
            return
        if self.kind == "pending" and (self.is_link(one) or self.is_link(other)):
            return
        self.lines.append(f"R {one} {other}")

    def place(self, name):
        """The folder: a file's other names are found where it is."""
        return os.path.dirname(os.path.normpath(name.replace("ll/", "d/")))

    def do_folder(self):
        if self.kind == "pending":
            return
        name = self.random.choice(FOLDERS) if self.random.randrange(3) else self.name()
        name += "/" if self.chance(8) else ""
        self.lines.append(f"{self.random.choice('md')} {name}")
