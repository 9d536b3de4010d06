"""Configurations of chips."""

import collections.abc
import json
import re

import numpy

from ._library import check, encoded, ffi, lib, new_error, printed


def presets():
    """Names of the paper's chips, "1x32" to "8x64"."""
    names, found = lib.trax_config_presets(), []
    while names[len(found)] != ffi.NULL:
        found.append(ffi.string(names[len(found)]).decode())
    return found


def describe_keys():
    """Every key with type, range, default, unit and meaning, as trax-sim --help-config prints them."""
    return printed(lib.trax_config_describe)


class Config(collections.abc.MutableMapping):
    """A chip: a mapping from keys such as "memory.latency_cycles" to numbers, flags (bool) and words.

    chip: a preset's name, a libconfig file, or None for one TP with the paper's defaults. settings: keys to change.
    Errors: TraxError for an unknown key and for a value out of range."""
    def __init__(self, chip=None, settings=None):
        self.handle = ffi.gc(lib.trax_config_create(), lib.trax_config_destroy)
        if chip is not None:
            error = new_error()
            check(lib.trax_config_load(self.handle, encoded(chip), error), error)
        self.update(settings or {})

    def copy(self):
        """A configuration of its own with the same values."""
        other = Config()
        other.handle = ffi.gc(lib.trax_config_copy(self.handle), lib.trax_config_destroy)
        return other

    def __setitem__(self, key, value):
        text = str(value).lower() if isinstance(value, (bool, numpy.bool_)) else str(value)
        error = new_error()
        check(lib.trax_config_set(self.handle, key.encode(), text.encode(), error), error)

    def __getitem__(self, key):
        return self._values()[key]

    def __delitem__(self, key):
        raise TypeError("every key of a configuration has a value")

    def __iter__(self):
        return iter(self._values())

    def __len__(self):
        return len(self._values())

    def changes(self):
        """Returns {key: value} of the keys whose values are not the defaults."""
        found, key, values = {}, ffi.NULL, self._values()
        while (key := lib.trax_config_next_change(self.handle, key)) != ffi.NULL:
            name = ffi.string(key).decode()
            found[name] = values[name]
        return found

    def text(self):
        """All keys as a file that trax-sim --config reads."""
        return printed(lib.trax_config_print, self.handle)

    def _values(self):
        """{key: value} of all keys, in the order of the file."""
        values, section = {}, ""
        for line in self.text().splitlines():
            if begin := re.fullmatch(r"(\w+): \{", line):
                section = begin[1]
            elif member := re.match(r"  (\w+) = (.*?);", line):
                values[f"{section}.{member[1]}"] = json.loads(member[2])
        return values

    def __repr__(self):
        return f"Config({self.changes()!r})"
