#!/usr/bin/env python3
"""Does what the Containerfile says in a Debian of its own: container_test.py ROOT COMMAND...

ROOT is made with debootstrap if it is not there. COPY takes what git tracks, RUN runs in WORKDIR with ENV, and COMMAND
then runs as the container's ENTRYPOINT runs it. Needs root and a mirror (MIRROR, default
http://deb.debian.org/debian)."""

import os
import pathlib
import shutil
import subprocess
import sys

SOURCE = pathlib.Path(__file__).resolve().parents[2]
SUITES = {"debian:12": "bookworm", "debian:13": "trixie"}


def instructions(text):
    """(name, words) of each instruction."""
    for line in text.replace("\\\n", " ").splitlines():
        if line.strip() and not line.startswith("#"):
            name, _, words = line.partition(" ")
            yield name, words.strip()


def main():
    root, command = pathlib.Path(sys.argv[1]).resolve(), " ".join(sys.argv[2:])
    mirror = os.environ.get("MIRROR", "http://deb.debian.org/debian")
    environment = {"HOME": "/root", "PATH": "/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin"}
    folder = "/"

    def inside(script):
        """The commands in the root, which has its own /proc for them."""
        place = ["env", "-i", *(f"{name}={value}" for name, value in environment.items()), "sh", "-c",
                 f"mount -t proc proc /proc; cd {folder} && {script}"]
        subprocess.run(["unshare", "--mount", "--pid", "--fork", "chroot", root, *place], check=True)

    for name, words in instructions((SOURCE / "Containerfile").read_text()):
        print(f"{name} {words}", flush=True)
        if name == "FROM" and not (root / "usr").exists():
            subprocess.run(["debootstrap", "--variant=minbase", SUITES[words], root, mirror], check=True)
            shutil.copy("/etc/resolv.conf", root / "etc/resolv.conf")
        elif name == "COPY":
            assert words.startswith(". /"), words
            to = root / words.split()[1][1:]
            to.mkdir(parents=True, exist_ok=True)
            tracked = subprocess.Popen(["git", "-C", SOURCE, "archive", "HEAD"], stdout=subprocess.PIPE)
            subprocess.run(["tar", "-x", "-C", to], stdin=tracked.stdout, check=True)
            if tracked.wait() != 0:
                raise subprocess.CalledProcessError(tracked.returncode, tracked.args)
        elif name == "WORKDIR":
            folder = words
        elif name == "RUN":
            inside(words)
        elif name == "ENV":
            key, _, value = words.partition("=")
            environment[key] = value.replace("$PATH", environment["PATH"])
        elif name == "ENTRYPOINT":
            assert words == '["/bin/bash"]', words
            inside("exec /bin/bash -c " + "'" + command.replace("'", "'\\''") + "'")
        elif name != "FROM":
            raise AssertionError(f"{name} is not known here")


if __name__ == "__main__":
    sys.exit(main())
