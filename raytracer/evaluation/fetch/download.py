"""Downloads: by HTTP, which continue where an earlier one ended, and packages of npm by its own client."""

import contextlib
import http.client
import json
import os
import re
import shutil
import socket
import time
import urllib.error
import urllib.parse
import urllib.request

from trax_eval.tools import run_tool
from trax_eval.util import write_json

from .problems import Failed, Missing

TRIES, TIMEOUT = 3, 30  # of a download; seconds without a byte
NPM_RETRY = ("--fetch-retries=1", "--fetch-retry-mintimeout=1000")  # it would try for a minute
LIMIT, CHUNK = 1 << 30, 1 << 16  # bytes
NETWORK = (OSError, http.client.HTTPException)


class Unfinished(Exception):
    """The connection ended early. The received part is kept."""


class Partial:
    """A download as far as it has arrived, beside a record of what the server calls this version of it."""
    def __init__(self, path):
        self.path, self.record = path, path.with_name(path.name + ".json")

    def version(self):
        """The version's name, with which the server can continue; None: from the beginning."""
        if not self.path.exists():
            return None
        with contextlib.suppress(OSError, ValueError, AttributeError):
            return json.loads(self.record.read_text()).get("version")
        return None

    def begin(self, headers):
        tag = headers.get("ETag", "")
        self.remove()
        version = tag if tag.startswith('"') else headers.get("Last-Modified")  # a weak tag is of no use for ranges
        write_json(self.record, {"version": version})

    def remove(self):
        self.path.unlink(missing_ok=True)
        self.record.unlink(missing_ok=True)


def requested(url, partial):
    """The request, and the bytes that are there already."""
    headers = {"User-Agent": "trax-eval fetch-scenes", "Accept-Encoding": "identity"}
    version = partial.version()
    there = partial.path.stat().st_size if version else 0
    if there:
        headers |= {"Range": f"bytes={there}-", "If-Range": version}
    return urllib.request.Request(url, headers=headers), there


def receive(url, partial, show):
    """One try. Raises Unfinished, and what urllib raises."""
    request, there = requested(url, partial)
    with urllib.request.urlopen(request, timeout=TIMEOUT) as answer:
        continued = answer.status == 206 and re.match(f"bytes {there}-", answer.headers.get("Content-Range", ""))
        if not continued:
            partial.begin(answer.headers)
            there = 0
        length = answer.headers.get("Content-Length", "")
        whole = there + int(length) if length.isdecimal() else None
        with open(partial.path, "ab", 0) as file:
            while data := answer.read1(CHUNK):
                file.write(data)
                there += len(data)
                show(there, whole)
                if there > LIMIT:
                    partial.remove()
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


def by_http(url, partial, folder, show):
    """The whole file of the address, in the folder. An interrupted download is continued."""
    for attempt in range(1, TRIES + 1):
        try:
            receive(url, partial, show)
            break
        except (Unfinished, *NETWORK) as error:
            if isinstance(error, urllib.error.HTTPError) and error.code == 416:
                partial.remove()
            if attempt == TRIES or is_final(error):
                gone = isinstance(error, urllib.error.HTTPError) and error.code in (404, 410)
                raise (Missing if gone else Failed)(reason(error)) from error
            time.sleep(attempt / 2)
        except ValueError as error:
            raise Failed(str(error)) from error
    path = folder / file_name(url)
    os.replace(partial.path, path)
    partial.remove()
    return path


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
