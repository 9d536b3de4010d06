"""Downloads by HTTP, and packages of npm by its own client."""

import http.client
import re
import shutil
import socket
import time
import urllib.error
import urllib.parse
import urllib.request

from trax_eval.tools import run_tool

from .problems import Failed, Missing

TRIES, TIMEOUT = 3, 30  # of a download; seconds without a byte
NPM_RETRY = ("--fetch-retries=1", "--fetch-retry-mintimeout=1000")  # it would try for a minute
LIMIT, CHUNK = 1 << 30, 1 << 16  # bytes
NETWORK = (OSError, http.client.HTTPException)


class Unfinished(Exception):
    """The connection ended early."""


def receive(url, path, show):
    """One try. Raises Unfinished, and what urllib raises."""
    headers = {"User-Agent": "trax-eval fetch-scenes", "Accept-Encoding": "identity"}
    request = urllib.request.Request(url, headers=headers)
    with urllib.request.urlopen(request, timeout=TIMEOUT) as answer, open(path, "wb") as file:
        length = answer.headers.get("Content-Length", "")
        there, whole = 0, int(length) if length.isdecimal() else None
        while data := answer.read1(CHUNK):
            file.write(data)
            there += len(data)
            show(there, whole)
            if there > LIMIT:
                raise Failed(f"more than {LIMIT} bytes")
    if whole is not None and there != whole:
        raise Unfinished(f"ended after {there:,} of {whole:,} bytes")


def reason(error):
    if isinstance(error, urllib.error.HTTPError):
        return f"{error.code} {error.reason}"
    if isinstance(error, http.client.IncompleteRead):
        return "ended early"
    error = getattr(error, "reason", error)
    return getattr(error, "strerror", None) or str(error) or type(error).__name__


def is_final(error):
    """Returns whether another try would give the same answer."""
    if isinstance(error, urllib.error.HTTPError):
        return error.code < 500 and error.code not in (408, 429)
    return isinstance(getattr(error, "reason", None), (ConnectionRefusedError, socket.gaierror))


def file_name(url):
    """The last part of the address's path, as a name for a file."""
    name = re.sub(r"[^\w.+-]", "_", urllib.parse.urlsplit(url).path.rpartition("/")[2])
    return name if name.strip(".") else "file"


def by_http(url, folder, show):
    """The file of the address, in the folder."""
    path = folder / file_name(url)
    for attempt in range(1, TRIES + 1):
        try:
            receive(url, path, show)
            return path
        except (Unfinished, *NETWORK) as error:
            if attempt == TRIES or is_final(error):
                gone = isinstance(error, urllib.error.HTTPError) and error.code in (404, 410)
                raise (Missing if gone else Failed)(reason(error)) from error
            time.sleep(attempt / 2)
        except ValueError as error:
            raise Failed(str(error)) from error


def npm_reason(said):
    """npm's own reason: the line that has one, or else its first with a text."""
    lines = [re.sub(r"^npm (ERR!|error)\s*", "", line) for line in said.splitlines()]
    named = [line.partition("reason: ")[2] for line in lines if "reason: " in line]
    others = [line for line in lines if line and not re.match("code |errno |syscall ", line)]
    return "".join(f": {line}" for line in [*named, *others][:1])


def by_npm(package, folder):
    """A package of npm, as a file in the folder."""
    npm = shutil.which("npm")
    if not npm:
        raise Failed("npm is not installed: apt-get install npm (Debian)")
    run = run_tool([npm, "pack", "--loglevel=error", *NPM_RETRY, package], cwd=folder)
    if run.returncode != 0:
        raise Failed(f"npm ended with status {run.returncode}{npm_reason(run.stderr)}")
    path = folder / archive_name(package)
    if not path.is_file():
        raise Failed(f"npm made no {path.name}")
    return path


def archive_name(package):
    """The name that npm pack gives NAME@VERSION."""
    name, _, version = package.rpartition("@")
    return f"{name.removeprefix('@').replace('/', '-')}-{version}.tgz"
