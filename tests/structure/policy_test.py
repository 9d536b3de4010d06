"""A replacement policy is a row and what it does: policy.patch adds the tree of bits that hardware has in place of an
order of uses, and changes a few files. policy_test.py SCRATCH (patched.py has made it)

The engines must agree with the policy on random machines; a small program must hit the lines that the tree leaves; a
checkpoint must have the tree; the page must be that of the patched sources."""

import sys

from patched import Patched

KEYS = ["dcache.bytes=256", "dcache.ways=4", "dcache.replacement=plru"]  # one set of four lines of 64 bytes

# Of the loads A B C D B A E C D those that hit, derived by hand. E replaces A, which came first; C, whose use is the
# longest ago, and C then D; or D: the tree has A and C in its lower half, B and D in the upper one, and after A leads
# to the upper half, there away from B.
HITS = {"fifo": 4, "lru": 2, "plru": 3}


def check_hits(policy):
    for word, hits in HITS.items():
        for engine in ("fast", "reference"):
            got = policy.statistics("lines", KEYS[:-1] + [f"dcache.replacement={word}"], "--engine", engine)["dcache"]
            policy.check((got["hits"], got["misses"]) == (hits, 9 - hits),
                         f"{word}, {engine}: {got}, by hand {hits} hits")


def check_checkpoints(policy):
    """Between all loads."""
    whole = policy.statistics("lines", KEYS)
    for part in range(1, 10):
        at = whole["cycles"] * part // 10
        policy.statistics("lines", KEYS, "--checkpoint", "checkpoint", "--checkpoint-at", at)
        rest = policy.statistics("lines", KEYS, "--resume", "checkpoint")
        for name in ("cycles", "causes", "dcache"):
            policy.check(rest[name] == whole[name],
                         f"{name}, resumed before {at}: {rest[name]}, whole run {whole[name]}")


def main():
    policy = Patched("policy.patch", most_files=4)
    for keys in (KEYS, []):  # small data caches that have it, and any cache
        policy.engines_agree(keys, 15)
    check_hits(policy)
    check_checkpoints(policy)
    return policy.end()


if __name__ == "__main__":
    sys.exit(main())
