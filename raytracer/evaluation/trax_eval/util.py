"""Common parts: errors for the user, hashes, files that appear complete or not at all."""

import argparse
import difflib
import hashlib
import json
import math
import os
import pathlib
import stat
import sys

from .outputs import write_output


class Problem(Exception):
    """An error for the user. The command ends with status 1."""


def complain(program, problem, kind="error", colour="1;31"):
    """Prints an error as every program does (emulator/base/message.c)."""
    coloured = not os.environ.get("NO_COLOR") and os.environ.get("TERM", "dumb") != "dumb" and sys.stderr.isatty()
    begin, end = (f"{chr(27)}[{colour}m", f"{chr(27)}[0m") if coloured else ("", "")
    print(f"{program}: {begin}{kind}: {end}{problem}", file=sys.stderr, flush=True)


def shown(value):
    """A value of a key as trax-sim reads it."""
    return str(value).lower() if isinstance(value, bool) else str(value)


def nearest(word, names):
    """"; did you mean NAME?", or nothing if no name is near."""
    found = difflib.get_close_matches(word, names, 1, 0.75)
    return f"; did you mean {found[0]}?" if found else ""


class Once(argparse.Action):
    """An option that names an output: given twice, the first output would be missing. As base/options.c has it."""
    given = False

    def __call__(self, parser, namespace, values, option_string=None):
        if self.given:
            parser.error(f"{self.option_strings[-1]} is given twice")
        self.given = True
        setattr(namespace, self.dest, values)


class Parser(argparse.ArgumentParser):
    """Its errors are Problems. An unknown option suggests one. An empty value is an error, as in -o "$UNSET"."""
    def _get_value(self, action, text):
        if text == "" and action.option_strings:
            raise Problem(f"{action.option_strings[-1]}: the value is empty")
        return super()._get_value(action, text)

    def error(self, message):
        wrong = message.startswith("unrecognized arguments: ")
        known = [name for action in self._actions for name in action.option_strings]
        guess = nearest(message.split()[2], known) if wrong else ""
        raise Problem(f"{message}{guess} ({self.prog} --help lists the options)")


def remark(text):
    complain("trax-eval", text, "note", "1;36")


def canonical(value):
    """The one text of a JSON value: hashes are of it."""
    return json.dumps(value, sort_keys=True, separators=(",", ":"), allow_nan=False)


def hash_bytes(data):
    return hashlib.sha256(data).hexdigest()[:32]


def hash_value(value):
    return hash_bytes(canonical(value).encode())


def hash_file(path):
    try:
        with open(path, "rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest()[:32]
    except OSError as error:
        raise Problem(f"{path}: {error.strerror}") from error


def write_file(path, data):
    """Replaces path at once by data (bytes or text). A process that dies on the way leaves path as it was."""
    path = pathlib.Path(path)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        write_output(path, data)
    except OSError as error:
        raise Problem(f"{path}: {error.strerror}") from error


def identity(path):
    """Identifies the file that a path names, whatever its spelling; None for anything but a regular file, which may be
    written any number of times."""
    try:
        found = os.stat(path)
    except OSError:
        return os.path.realpath(path)
    return (found.st_dev, found.st_ino) if stat.S_ISREG(found.st_mode) else None


def check_files(inputs, outputs):
    """No output may be an input, and none may be written twice. As base/files.c has it for the programs in C."""
    known = {identity(path): path for path in inputs}
    written = {}
    for path in outputs:
        which = identity(path)
        if which is None:
            continue
        if which in known:
            raise Problem(f"{path}: is an input and the output" +
                          ("" if str(path) == str(known[which]) else f"; it is the same file as {known[which]}"))
        if which in written:
            raise Problem(f"{written[which]}: is written twice" +
                          ("" if str(path) == str(written[which]) else f" as {path}"))
        written[which] = path


def write_json(path, value):
    write_file(path, json.dumps(value, indent=1, allow_nan=False) + "\n")


# A sealed file ends with the digest of what is before it: every later change of a byte is noticed.
SEAL = ',\n "digest": "%s"\n}\n'


def write_sealed(path, value):
    """value: an object with members."""
    text = json.dumps(value, indent=1, allow_nan=False).removesuffix("\n}")
    write_file(path, text + SEAL % hash_bytes(text.encode()))


def read_sealed(path):
    """Returns its value without the digest. A Problem: it does not have the bytes that were written."""
    data = read_bytes(path)
    text = data[:-len(SEAL % hash_bytes(b""))]
    if data != text + (SEAL % hash_bytes(text)).encode():
        raise Problem(f"{path}: is damaged, or of an older trax-eval: it has not the bytes of its digest")
    return json.loads(text + b"}")


def refuse_duplicates(pairs):
    members = {}
    for key, value in pairs:
        if key in members:
            raise ValueError(f'the key "{key}" is there twice')
        members[key] = value
    return members


def refuse_constant(text):
    raise ValueError(f"{text} is no number of JSON")


def finite(text):
    value = float(text)
    return value if math.isfinite(value) else refuse_constant(text)


def check_texts(value):
    """Refuses texts that JSON can have and no name, path or argument can."""
    if isinstance(value, str) and ("\0" in value or any("\ud800" <= letter <= "\udfff" for letter in value)):
        raise ValueError(f"{json.dumps(value)} is no text: it has a character of no encoding, or NUL")
    if isinstance(value, dict):
        value = [*value, *value.values()]
    for item in value if isinstance(value, list) else ():
        check_texts(item)


# bytes of what people write, and of what this program does; the largest has a hundredth
TEXT_LIMIT, FILE_LIMIT = 1 << 20, 1 << 28


def read_bytes(path, limit=FILE_LIMIT):
    try:
        with open(path, "rb") as file:
            data = file.read(limit + 1)
    except OSError as error:
        raise Problem(f"{path}: {error.strerror}") from error
    if len(data) > limit:
        raise Problem(f"{path}: more than {limit} bytes")
    return data


STRICT = {"object_pairs_hook": refuse_duplicates, "parse_constant": refuse_constant, "parse_float": finite}


def read_json(path, limit=FILE_LIMIT, strict=True):
    return json_of(path, read_bytes(path, limit), strict)


def json_of(path, data, strict=True):
    """The value of a file's bytes. strict: without duplicate keys, numbers that are not finite, and texts that no name
    can have."""
    try:
        value = json.loads(data.decode("utf-8"), **(STRICT if strict else {}))
        if strict:
            check_texts(value)
        return value
    except json.JSONDecodeError as error:
        raise Problem(f"{path}:{error.lineno}:{error.colno}: {error.msg}") from error
    except RecursionError:
        raise Problem(f"{path}: is nested too deeply") from None
    except ValueError as error:
        raise Problem(f"{path}: {error}") from error


def duration(seconds):
    minutes, seconds = divmod(int(seconds + 0.5), 60)
    return f"{minutes // 60}:{minutes % 60:02}:{seconds:02}" if minutes >= 60 else f"{minutes}:{seconds:02}"
