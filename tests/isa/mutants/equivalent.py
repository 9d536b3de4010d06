"""Mutants that no signature can show, by name (a pattern of the shell), and why."""

EQUIVALENT = [
    ("s[lr][la]: bit 31 of rb is lost", "only the low five bits of a shift amount count"),
    ("s[bh]: bit 31 of rb is lost", "it is not stored"),
    ("fcvt.s.wu: bit 31 of the result is lost", "the result is not negative"),
    ("l[bh]u: bit 31 of the result is lost", "zeros are above"),
    ("jal: bit 31 of the result is lost", "memory ends below 2 GiB"),
    ("jalr: bit 31 of the result is lost", "memory ends below 2 GiB"),
    ("rdsr: bit 31 of the result is lost", "no number is so large, but the cycle after 2^31 cycles"),
    ("m[ai][nx]: <= for <", "either of two equal words is the result"),
    ("m[ai][nx]u: <= for <", "either of two equal words is the result"),
    ("ftri: r0 keeps what is written to it", "no distance is less than 0, which it reads as"),
    ("feq: two negative numbers are compared by magnitude", "they are equal if their magnitudes are"),
    ("fcvt.wu.s: downwards", "the same for what is not negative, and the rest gives 0"),
    ("trap: rays *", "the host counts, and no signature shows it"),
    ("trap: items *", "the host counts, and no signature shows it"),
    ("trap: kinds *", "the host counts, and no signature shows it"),
    ("local: the fault's address is the word's", "a misaligned access is another fault"),
    ("fetch: the fault's address is the word's", "a misaligned pc is another fault"),
    ("illegal: the fault's address is the word's", "it is 0"),
]
