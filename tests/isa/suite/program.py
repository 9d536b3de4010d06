"""A conformance program under construction: assembly that stores results to a signature and then compares each with the
word of its own table.

Registers: r31 and r30 both hold the place in the signature from which results are stored with offsets; what a program
tests with r31 it stores by r30. What else a program relies on, in every case, is kept small: lui, addi, lw, sw, beq,
bne, bltu, jal and the exit trap."""

from collections import Counter

UNWRITTEN = 0xDEADBEEF  # the initial words of the signature
WINDOW = 32000  # bytes within which results are stored by offset


class Program:
    """One image and its signature. of: the instruction's mnemonic or the feature; conditions: how many cases of
    each."""

    def __init__(self, name, of, tms=1, tps=1, link=()):
        self.name, self.of, self.tms, self.tps, self.link = name, of, tms, tps, list(link)
        self.conditions = Counter()
        self.places = []  # [end, condition]: whose results those up to the end are
        self.entries = {}  # label of an entry: conditions; an image for each. Empty: one image, at _start
        self.checked = True  # compares its results itself, and ends with status 0
        self.output = b""  # to standard output
        self.statuses = {}  # label of an entry: exit status, where it is not a fault's
        self.faults = {}  # label of an entry: the kind of its fault
        self.lines, self.data, self.sections = [], [], []
        self.results = 0  # words of the signature so far
        self.unchecked = 0  # further words, which the program itself does not compare
        self.base = 0  # of these, the first that r31 and r30 point to
        self.labels = 0
        self.lost = set()  # of r30 and r31: holds something else

    def case(self, condition, count=1):
        """Counted behind its results."""
        self.conditions[condition] += count
        if self.places and self.places[-1][1] == condition:
            self.places[-1][0] = self.results
        else:
            self.places.append([self.results, condition])

    def emit(self, *lines):
        self.lines += [f"  {line}" for line in lines]

    def label(self, text="L"):
        self.labels += 1
        return f"{text}{self.labels}"

    def place(self, label):
        self.lines.append(f"{label}:")

    # --- constants and addresses

    def constant(self, register, value):
        self.lost |= {register} & {"r30", "r31"}
        value &= 0xFFFFFFFF
        low = (value & 0xFFFF) - ((value & 0x8000) << 1)
        high = (value - low) >> 16 & 0xFFFF
        if high:
            self.emit(f"lui {register}, {high:#x}")
        if low or not high:
            self.emit(f"addi {register}, {register if high else 'r0'}, {low}")

    def address(self, register, symbol):
        self.lost |= {register} & {"r30", "r31"}
        self.emit(f"lui {register}, %hi({symbol})", f"addi {register}, {register}, %lo({symbol})")

    def fill(self, value, but=()):
        """Every register but r0, r30, r31 becomes value(number)."""
        for number in range(1, 30):
            if number not in but:
                self.constant(f"r{number}", value(number))

    # --- results

    def begin(self):
        self.place("_start")
        self.rebase()

    def rebase(self):
        """Brings the window to where the results stand."""
        self.base = self.results
        self.restore()

    def restore(self):
        for register in ("r31", "r30"):
            self.address(register, f"begin_signature+{4 * self.base}")
        self.lost.clear()

    def store(self, register):
        """The register's value is the next result."""
        base = "r30" if register == "r31" or "r31" in self.lost else "r31"
        self.emit(f"sw {register}, {self.offset(self.results)}({base})")
        self.results += 1
        self.lost |= {register} & {"r30", "r31"}
        if self.lost:
            self.restore()
        self.reach(1)

    def store_all(self):
        """All 32 registers are results."""
        for number in range(32):
            self.store(f"r{number}")

    def offset(self, result):
        return 4 * (result - self.base)

    def reach(self, words):
        """Rebases unless so many more words can be stored without it. A rebase takes r31 and r30 from a test."""
        if self.offset(self.results + words) > WINDOW:
            self.rebase()

    def reserve(self, words):
        """The next results are written by other means; their first one's number."""
        first = self.results
        self.results += words
        return first

    def table(self, label, words):
        self.data.append(f"{label}:")
        for i in range(0, len(words), 8):
            self.data.append("  .word " + ", ".join(f"{word & 0xFFFFFFFF:#x}" for word in words[i:i + 8]))

    # --- the end

    def end(self):
        """Compares the results with the table behind `expected`, which the reference fills in."""
        self.address("r4", "begin_signature")
        self.address("r5", "expected")
        self.address("r6", "end_results")
        self.emit("addi r7, r0, 0")
        self.lines += ["Lcheck:"]
        self.emit("beq r4, r6, Lpass", "lw r8, 0(r4)", "lw r9, 0(r5)", "addi r7, r7, 1", "addi r4, r4, 4",
                  "addi r5, r5, 4",
                  "beq r8, r9, Lcheck", "addi r8, r0, 255", "bltu r7, r8, Lfail", "addi r7, r8, 0")
        self.lines += ["Lfail:", "  trap r7, exit", "Lpass:", "  trap r0, exit"]

    def text(self):
        """The assembler's input."""
        lines = [f"# {self.of}: generated by tests/isa/suite", "  .text",
                 f"  .globl {', '.join(self.entries) or '_start'}", *self.lines]
        lines += ['  .section .rodata, "a", @progbits', "  .p2align 6", *self.data, *self.sections]
        if self.checked:
            lines += ['  .section .expected, "a", @progbits', "  .p2align 6", "  .globl expected", "expected:",
                      f"  .space {4 * self.results}"]
        lines += ["  .data", "  .p2align 6", "  .globl begin_signature, end_signature", "begin_signature:"]
        lines += [f"  .fill {self.results}, 4, {UNWRITTEN:#x}", "end_results:"]
        if self.unchecked:
            lines += [f"  .fill {self.unchecked}, 4, {UNWRITTEN:#x}"]
        lines += ["end_signature:"]
        return "\n".join(lines) + "\n"
