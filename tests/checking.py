"""Functions that tests in Python share: checks of conditions, whose failures `failures` counts, and the runs of a
test's parts and of a program."""
import os
import subprocess
import tempfile

failures = 0


def fail(*message):
    global failures
    failures += 1
    print("FAILED:", *(str(part)[:1000] for part in message), flush=True)


def check(condition, *message):
    if not condition:
        fail(*message)


def equal(a, b, *what):
    if isinstance(a, str) and isinstance(b, str) and a != b:  # the first lines that differ
        a, b = next(((x, y) for x, y in zip(a.split("\n"), b.split("\n")) if x != y), (len(a), len(b)))
    check(a == b, *what, a, "is not", b)


def call(folder, program, *words, status=0):
    """Runs a program of the folder, which must end with the status."""
    command = [folder / program, *map(str, words)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=280, check=False)
    check(done.returncode == status, program, *words, "status", done.returncode, done.stdout, done.stderr)
    return done


def run(*parts):
    """Runs the parts of a test in a temporary folder, and returns the exit status."""
    with tempfile.TemporaryDirectory(dir=os.environ.get("TRAX_TEST_FOLDER")) as folder:
        os.chdir(folder)
        for part in parts:
            part()
        os.chdir("/")
    return failures != 0


def run_measured(command):
    """Runs a command; (exit status, standard error, the most bytes of memory that it had)."""
    with tempfile.TemporaryFile("w+") as error:
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=error)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        error.seek(0)
        return process.returncode, error.read(), usage.ru_maxrss << 10
