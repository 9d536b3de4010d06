"""Finished runs: whether they are there, and as they were written."""

import functools
import os
import struct
import zlib

from .pictures import read_png
from .util import Problem, hash_bytes, hash_file, read_sealed, remark


def is_done(out, key):
    return (out / "runs" / f"{key}.json").exists()


def result_of(out, key):
    """(result, host) or None. A Problem if one of its files is damaged."""
    path, host, series = (out / "runs" / f"{key}.{ending}" for ending in ("json", "host.json", "csv"))
    if not path.exists():
        return None
    result = read_sealed(path)
    if result["key"] != key:
        raise Problem(f"{path}: is damaged: it is of the run {result['key']}")
    if "series" in result and hash_file(series) != result["series"]:
        raise Problem(f"{series}: is damaged: it has not the bytes that were written")
    if result["picture"]:
        picture = out / "pictures" / f"{result['picture']}.png"
        if not is_picture(picture, result["picture"]):
            raise DamagedPicture(picture)
    return result, read_sealed(host) if host.exists() else {}


class DamagedPicture(Problem):
    def __init__(self, picture):
        super().__init__(f"{picture}: is damaged: it has not the pixels of its name")
        self.picture = picture


def is_picture(path, pixels):
    """Returns whether the picture exists and has the pixels of that hash."""
    try:
        status = os.stat(path)
    except OSError:
        return False
    return shows(path, pixels, status.st_ino, status.st_size, status.st_mtime_ns)


@functools.lru_cache(maxsize=None)
def shows(path, pixels, *stamp):
    """stamp: of the file as it is now. The pictures of many runs are the same."""
    try:
        return hash_bytes(read_png(path.read_bytes())[3]) == pixels
    except (OSError, ValueError, IndexError, struct.error, zlib.error):
        return False


def forget_damaged(out, keys):
    """Removes damaged runs, so that they are made again. One of the runs that share a damaged picture is enough."""
    pictures = set()
    for key in keys:
        try:
            result_of(out, key)
        except DamagedPicture as problem:
            if problem.picture not in pictures:
                forget(out, key, problem)
                problem.picture.unlink(missing_ok=True)
                pictures.add(problem.picture)
        except Problem as problem:
            forget(out, key, problem)


def forget(out, key, problem):
    remark(f"{problem}; the run is made anew")
    (out / "runs" / f"{key}.json").unlink(missing_ok=True)  # another command may have removed it


def is_intact(out, key):
    try:
        return result_of(out, key) is not None
    except Problem:
        return False


def error_of(out, key):
    path = out / "runs" / f"{key}.error"
    return path.read_text(errors="replace").strip() if path.exists() else None
