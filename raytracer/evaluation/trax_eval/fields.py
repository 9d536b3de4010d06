"""Files of JSON that people write: a sweep, a program, a scene, a workload. What is wrong with one is an error with its
name and the key."""

import difflib
import pathlib
import re

from .util import Problem, TEXT_LIMIT, canonical, read_json

FOLDER = pathlib.Path(__file__).resolve().parent.parent  # of sweeps/, programs/, scenes/, workloads/
INSTALLED = FOLDER.parent  # lib/trax: programs for the TPs and sources
NAME = r"[\w.+-]+"


def quoted(names):
    return ", ".join(f'"{name}"' for name in names)


def suggestion(name, names):
    near = difflib.get_close_matches(name, names, 1)
    return f', did you mean "{near[0]}"?' if near else "."


class Fields:
    """The members of an object. path: the file, or the file and the place in it."""
    def __init__(self, path, value, keys):
        self.path, self.value = path, value
        if not isinstance(value, dict):
            self.fail(None, "expected an object")
        for key in value:
            if key not in keys:
                self.fail(None, f'unknown key "{key}"{suggestion(key, keys)} Allowed are {quoted(keys)}')

    def fail(self, key, message):
        raise Problem(f"{self.path}: {key}: {message}" if key else f"{self.path}: {message}")

    def text(self, key, default):
        value = self.value.get(key, default)
        if not isinstance(value, str):
            self.fail(key, f"expected a text, is {canonical(value)}")
        return value

    def name(self):
        name = self.value.get("name", "")
        if not isinstance(name, str) or not re.fullmatch(NAME, name):
            self.fail("name", "expected letters, digits and . + - _")
        return name

    def flag(self, key, default=False):
        value = self.value.get(key, default)
        if type(value) is not bool:
            self.fail(key, f"expected true or false, is {canonical(value)}")
        return value

    def words(self, key, what):
        """A list of texts, which may be missing or empty."""
        value = self.value.get(key, [])
        if not isinstance(value, list) or not all(isinstance(word, str) and word for word in value):
            self.fail(key, f"expected a list of texts, {what}, is {canonical(value)}")
        return value

    def strings(self, key, default, allowed=None):
        """A text or a list of some, none of them twice."""
        value = self.value.get(key, default)
        if isinstance(value, str):
            value = [value]
        if not isinstance(value, list) or not value or not all(isinstance(item, str) for item in value):
            self.fail(key, f"expected a list of texts, is {canonical(value)}")
        for item in value:
            if allowed and item not in allowed:
                self.fail(key, f'"{item}" is unknown; allowed are {quoted(allowed)}')
        if len(set(value)) != len(value):
            self.fail(key, "the same value is there twice")
        return value


def read_fields(path, keys):
    return Fields(path, read_json(path, TEXT_LIMIT), keys)


def installed(kind):
    """Names of what comes with trax, of one kind ("scenes")."""
    return sorted(path.stem for path in (FOLDER / kind).glob("*.json"))


PLACES = {"programs": ("programs", "experiments")}  # of a kind, where not in the folder of its name


def find_file(kind, name, beside):
    """The file of what comes with trax under that name, or NAME.json in the folder `beside`; None if there is none."""
    if not re.fullmatch(r"[\w.+/-]{1,200}", name):
        return None
    places = [pathlib.Path(beside, name)] if name.endswith(".json") else [
        FOLDER / place / f"{name}.json" for place in PLACES.get(kind, (kind, ))
    ]
    return next((path for path in places if path.is_file()), None)


def unknown(kind, name, what):
    return Problem(f'"{name}" is no {what}; allowed are {quoted(installed(kind))}, and files NAME.json')
