"""A run of a program with limits of memory and time."""
import os
import re
import resource
import subprocess

MEMORY, PROCESSOR_SECONDS = 4 << 30, 60
# Messages of libraries, interpreters and sanitizers: a program that prints them has not checked its input.
CRASHED = re.compile(
    rb"PLEASE submit|PLEASE ATTACH|Stack dump|LLVM ERROR|Assertion|terminate called|Traceback \(most|"
    rb"runtime error:|ERROR: AddressSanitizer|core dumped|UNREACHABLE",
    re.IGNORECASE,
)


def limits():
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    resource.setrlimit(resource.RLIMIT_CPU, (PROCESSOR_SECONDS, PROCESSOR_SECONDS))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def run(binaries, words, folder, environment=None, closed=()):
    def prepare():
        limits()
        for descriptor in closed:
            os.close(descriptor)

    return subprocess.run(
        [binaries / words[0], *words[1:]],
        cwd=folder,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        preexec_fn=prepare,
        timeout=900,
        env=environment,
        check=False,
    )


def with_message(fault, result):
    return f"{fault}\n{result.stderr[-600:].decode(errors='replace')}"
