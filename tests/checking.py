"""What tests in Python share: a condition that must hold, and a command that is run. `failures` counts what did not
hold."""
import subprocess

failures = 0


def check(condition, *message):
    global failures
    if not condition:
        failures += 1
        print("FAILED:", *(str(part)[:1000] for part in message), flush=True)


def equal(a, b, *what):
    if isinstance(a, str) and isinstance(b, str) and a != b:  # the first lines that differ
        a, b = next(((x, y) for x, y in zip(a.split("\n"), b.split("\n")) if x != y), (len(a), len(b)))
    check(a == b, *what, a, "is not", b)


def call(folder, program, *words, status=0):
    """A program of the folder, which must end with the status."""
    done = subprocess.run([folder / program, *map(str, words)], capture_output=True, text=True, timeout=280,
                          check=False)
    check(done.returncode == status, program, *words, "status", done.returncode, done.stdout, done.stderr)
    return done
