"""A replacement policy is a row and an implementation: policy.patch adds tree pseudo-LRU and changes a few files.
policy_test.py SCRATCH (patched.py has made it)

The engines must agree with the policy on random machines. A small program must hit the lines that the tree keeps. A
checkpoint must contain the tree. The page must be that of the patched sources."""

import sys

from patched import Patched

KEYS = ["dcache.bytes=256", "dcache.ways=4", "dcache.replacement=plru"]  # one set of four lines of 64 bytes

# The number of hits of the loads A B C D B A E C D, derived by hand. By FIFO, E replaces A, which came first. By LRU,
# E replaces C, and C then D. By the tree, E replaces D: A and C are in its lower half, B and D in the upper one. After
# the load of A it leads to the upper half, and there away from B.
HITS = {"fifo": 4, "lru": 2, "plru": 3}


def check_hits(policy):
    for word, hits in HITS.items():
        for engine in ("fast", "reference"):
            got = policy.statistics("lines", KEYS[:-1] + [f"dcache.replacement={word}"], "--engine", engine)["dcache"]
            good = (got["hits"], got["misses"]) == (hits, 9 - hits)
            policy.check(good, f"{word}, {engine}: {got}, by hand {hits} hits")


def check_checkpoints(policy):
    """Between all loads."""
    whole = policy.statistics("lines", KEYS)
    for part in range(1, 10):
        at = whole["cycles"] * part // 10
        policy.statistics("lines", KEYS, "--checkpoint", "checkpoint", "--checkpoint-at", at)
        rest = policy.statistics("lines", KEYS, "--resume", "checkpoint")
        for name in ("cycles", "causes", "dcache"):
            policy.check(rest[name] == whole[name], f"{name}, resumed before {at}: {rest[name]}, whole {whole[name]}")


def main():
    policy = Patched("policy.patch", most_files=4)
    for keys in (KEYS, []):  # small data caches that have it, and any cache
        policy.engines_agree(keys, 10)
    check_hits(policy)
    check_checkpoints(policy)
    return policy.end()


if __name__ == "__main__":
    sys.exit(main())
