"""No list of the state is forgotten: patched.py added a field to structures of the fast engine, at random places, and
the engine brings each back after it has gone back, and from a checkpoint, whose layout is another one.

  state_test.py SCRATCH TIMING-ROLLBACK-TEST

SCRATCH is patched.py's, the program that of the sources without the fields."""

import os
import sys

import patched

SCRATCH, WITHOUT = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])


def layout(program):
    return dict(line.split() for line in patched.run(program, "--layout").splitlines())


def main():
    program = os.path.join(SCRATCH, "build", "tests", "bin", "timing-rollback-test")
    with open(os.path.join(SCRATCH, patched.ADDED), encoding="utf-8") as file:
        names = file.read().split()
    print(f"a field is added to {' '.join(names)}")
    print(patched.run(program, env=os.environ | {"TRAX_ADDED_FIELDS": " ".join(names)}).strip())
    before, after = layout(WITHOUT), layout(program)
    same = [name for name in names if name in before and before[name] == after[name]]
    if same:
        print(f"the layout is the same: {' '.join(same)}")
    return 1 if same or len(names) < 8 else 0


if __name__ == "__main__":
    sys.exit(main())
