"""What a host of the project runs, .github/workflows and the Containerfile: hosting_test.py SOURCE

The YAML can be read, commands are what a shell can read, and the scripts, options and targets that they name are in the
sources. The workflow runs both commands of README on Debian 12 and 13. What is broken on purpose is noticed. Skipped
without PyYAML."""

import os
import pathlib
import re
import shlex
import subprocess
import sys

try:
    import yaml
except ImportError:
    print("skipped: PyYAML is not installed")
    sys.exit(77)

SOURCE = pathlib.Path(sys.argv[1]).resolve()
sys.path.insert(0, str(SOURCE / "tests/package"))
from container_test import instructions  # noqa: E402

TARGETS = "\n".join(path.read_text() for folder in ("tests", "cmake", "isa", "raytracer")
                    for path in (SOURCE / folder).rglob("CMakeLists.txt"))


def commands(script):
    """Words of each command of a script."""
    for line in script.replace("\\\n", " ").splitlines():
        for part in re.split(r"&&|\|\||;|\|", line):
            words = shlex.split(part, comments=True)
            if words:
                yield words


def faults(script):
    """What is wrong with a script of a step."""
    read = subprocess.run(["bash", "-n"], input=script, text=True, capture_output=True)
    if read.returncode != 0:
        yield f"bash cannot read {script!r}: {read.stderr.strip()}"
        return
    for words in commands(script):
        if words[0].startswith("./"):
            path = SOURCE / words[0]
            if not os.access(path, os.X_OK):
                yield f"there is no {words[0]}"
                continue
            text = path.read_text()
            yield from (f"{words[0]} has no {word}" for word in words[1:] if word.startswith("-") and word not in text)
        elif words[:3] == ["ninja", "-C", "build"]:
            yield from (f"there is no target {word}" for word in words[3:]
                        if not re.search(rf"add_custom_target\({re.escape(word)}\b", TARGETS))
        elif words[0] not in ("apt-get", "git", "rm"):
            yield f"{words[0]} is a command that this test does not know"


def workflow(path):
    jobs = yaml.safe_load(path.read_text())["jobs"]
    for name, job in jobs.items():
        scripts = [step["run"] for step in job["steps"] if "run" in step]
        for step in job["steps"]:
            if ("run" in step) == ("uses" in step):
                yield f"{path.name}, {name}: a step has neither or both of run and uses: {step}"
        for script in scripts:
            yield from (f"{path.name}, {name}: {fault}" for fault in faults(script))
        first = [words[0] for script in scripts for words in commands(script)]
        for command in ("./demo.sh", "./test.sh"):
            if command not in first:
                yield f"{path.name}, {name}: does not run {command}"
        systems = job.get("strategy", {}).get("matrix", {}).get("system", [])
        if systems != ["debian:12", "debian:13"] or job.get("container") != "${{ matrix.system }}":
            yield f"{path.name}, {name}: does not run on Debian 12 and 13"


def container(text):
    found = list(instructions(text))
    names = [name for name, _ in found]
    if names[:1] != ["FROM"] or names[-1:] != ["ENTRYPOINT"]:
        yield f"Containerfile: begins and ends with {names[:1]}, {names[-1:]}"
    for name, words in found:
        if name == "FROM" and words != "debian:12":
            yield f"Containerfile: is made of {words}"
        elif name == "COPY" and not (SOURCE / words.split()[0]).exists():
            yield f"Containerfile: there is no {words.split()[0]}"
        elif name == "RUN":
            yield from (f"Containerfile: {fault}" for fault in faults(words))
        elif name not in ("FROM", "COPY", "RUN", "WORKDIR", "ENV", "ENTRYPOINT"):
            yield f"Containerfile: {name} is not known"


def main():
    paths = sorted((SOURCE / ".github/workflows").glob("*.yml"))
    wrong = [] if paths else ["there is no workflow"]
    for path in paths:
        wrong += workflow(path)
    text = (SOURCE / "Containerfile").read_text()
    wrong += container(text)
    for script in ("./none.sh", "./setup.sh --none", "ninja -C build none", "none", "if true"):
        if not list(faults(script)):
            wrong.append(f"{script!r} is not noticed")
    for old, new in (("FROM", "FORM"), ("COPY .", "COPY none"), ("--programs", "--program-files"),
                     ("debian:12", "debian")):
        if not list(container(text.replace(old, new))):
            wrong.append(f"{new} in the Containerfile is not noticed")
    for fault in wrong:
        print(fault)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
