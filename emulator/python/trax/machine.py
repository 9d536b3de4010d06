"""Machines and their runs."""

import dataclasses
import functools
import json
import math
import os
import stat

import numpy

from ._library import (Fault, Interrupted, Memory, Stuck, TraxError, check, encoded, ffi, lib, message_of, new_error,
                       printed)
from .config import Config
from .picture import Picture
from .tools import call, sources


# The options of an explanation: their types in C by their names.
TYPES = {name: field.type.cname for name, field in ffi.typeof("struct trax_explain_options").fields}


def flat(statistics, before=""):
    """{"dcache.hits": ...} of an object of objects; lists are left out."""
    found = {}
    for name, value in statistics.items():
        if isinstance(value, dict):
            found |= flat(value, f"{before}{name}.")
        elif not isinstance(value, list):
            found[before + name] = value
    return found


def identity(file):
    """Of a path or descriptor: what a regular file is, whatever its name; None of what may be written at any time."""
    if file == "-":  # standard output
        return None
    try:
        found = os.stat(file)
    except OSError:
        return os.path.realpath(file)
    return (found.st_dev, found.st_ino) if stat.S_ISREG(found.st_mode) else None


def texts(value):
    """All strings of a JSON value."""
    if isinstance(value, str):
        yield value
    for item in value.values() if isinstance(value, dict) else value if isinstance(value, list) else ():
        yield from texts(item)


@dataclasses.dataclass(frozen=True)
class Run:
    """What a run gave.

    output: the text that the program printed. statistics: the object of trax-sim --stats (docs/statistics.md), with
    times in cycles. picture: of a program made from a scene, otherwise None."""
    output: str
    statistics: dict = dataclasses.field(repr=False)
    picture: Picture = None

    def __getitem__(self, name):
        """A figure by its name in the JSON, as in run["dcache.hit_rate"]."""
        return functools.reduce(lambda value, part: value[part], name.split("."), self.statistics)

    @property
    def cycles(self):
        """Length of the run in cycles; 0 of the functional engine."""
        return self.statistics["cycles"]

    @property
    def exit_status(self):
        return self.statistics["exit_status"]

    def figures(self):
        """{name: value} of all figures of the whole chip, without the configuration; names have dots."""
        return flat({name: value for name, value in self.statistics.items() if name != "configuration"})

    def tms(self):
        """pandas.DataFrame with a row for each TM and a column for each of its figures."""
        import pandas
        return pandas.DataFrame([flat(tm) for tm in self.statistics["tms"]]).set_index("tm")

    def tps(self):
        """pandas.DataFrame with a row for each TP: its TM, thread, and its thread-cycles by cause."""
        import pandas
        rows = [{"tm": tm["tm"], **flat(tp)} for tm in self.statistics["tms"] for tp in tm["tps"]]
        return pandas.DataFrame(rows).set_index("thread")


class Machine:
    """A chip with one program, which it runs once.

    program: an executable for the TPs, or the manifest of a run (trax.prepare writes one), whose buffers and machine
    come with it. chip: a preset, a file or a Config; None: the manifest's, otherwise one TP. settings: {key: value}
    changed in it. arguments: words for main after the program's name. folders: {name: folder of the host} that the
    program may read and write. Errors: TraxError."""
    def __init__(self, program, chip=None, settings=None, arguments=None, folders=None):
        self._manifest, self._ran, self._stop = None, False, ffi.new("int *")
        self._inputs = [program, *([chip] if isinstance(chip, (str, os.PathLike)) and os.path.isfile(chip) else [])]
        error = new_error()
        if lib.trax_manifest_is(encoded(program)):
            found = lib.trax_manifest_read(encoded(program), error)
            self._require(found, error)
            self._manifest = ffi.gc(found, lib.trax_manifest_release)
            with open(program, "rb") as file:
                folder = os.path.dirname(os.fsdecode(program))
                paths = [os.path.join(folder, name) for name in texts(json.load(file)) if "\0" not in name]
            self._inputs += filter(os.path.isfile, paths)
        self.config = self._configuration(chip, settings, error)
        made = lib.trax_machine_create(self.config.handle, error)
        self._require(made, error)
        self._handle = ffi.gc(made, lib.trax_machine_destroy)
        if self._manifest:
            check(lib.trax_manifest_load(self._manifest, self._handle, error), error)
        else:
            check(lib.trax_machine_load_elf(self._handle, encoded(program), error), error)
        if arguments is not None:
            words = [ffi.new("char[]", encoded(word)) for word in (program, *arguments)]
            check(lib.trax_machine_set_arguments(self._handle, ffi.new("char *[]", words), len(words), error), error)
        for name, folder in (folders or {}).items():
            check(lib.trax_machine_allow(self._handle, encoded(folder), name.encode(), error), error)

    @staticmethod
    def _require(pointer, error):
        if pointer == ffi.NULL:
            raise TraxError(message_of(error))

    def _configuration(self, chip, settings, error):
        config = chip.copy() if isinstance(chip, Config) else Config(chip)
        if chip is None and self._manifest:
            check(lib.trax_manifest_configure(self._manifest, config.handle, error), error)
        config.update(settings or {})
        return config

    # --- memory

    def bind(self, symbol, data):
        """Fills a new buffer of the program with the bytes of data (bytes or a contiguous array), or with zeros if data
        is a number of bytes. To be called before the run. Error: the program has no trax_buffer of that name."""
        error = new_error()
        zeros = isinstance(data, int)
        view = None if zeros else ffi.from_buffer(data)
        size = data if zeros else len(view)
        if not 0 <= size < 1 << 32:
            raise TraxError(f"{symbol}: a buffer has 0 to {(1 << 32) - 1} bytes, not {size}")
        check(lib.trax_machine_bind(self._handle, symbol.encode(), ffi.NULL if zeros else view, size, error), error)

    def buffer(self, symbol, dtype=numpy.uint8):
        """The contents of a buffer: a read-only array [bytes / size of dtype] over the machine's memory, without a
        copy, which shows what the run stores."""
        return self._array(lib.trax_machine_read_buffer, symbol, dtype)

    def symbol(self, symbol, dtype=numpy.uint32):
        """The contents of a global object of the program, as `buffer` has them."""
        return self._array(lib.trax_machine_read_symbol, symbol, dtype)

    def _array(self, read, symbol, dtype):
        error, data, size = new_error(), ffi.new("uint8_t **"), ffi.new("uint32_t *")
        check(read(self._handle, symbol.encode(), data, size, error), error)
        memory = ffi.gc(data[0], lambda pointer, machine=self._handle: None)  # the array keeps the machine
        array = numpy.frombuffer(ffi.buffer(memory, size[0]), dtype)
        array.flags.writeable = False
        return array

    # --- the run

    def run(self, engine=None, threads=0, max_cycles=0, input=None, progress=None, **explain):
        """Runs the program to its end and returns the Run.

        engine: "fast", "reference", "functional" or "simt"; None: as trax-sim chooses. threads: of the host, 0 for all
        processors; results do not depend on it. max_cycles: 0 for no limit. input: an open file, the standard input of
        the program. progress: called about ten times a second with (cycle, instructions, items). explain: files to
        write, by the names of trax-sim's options, such as explore="run.html" or profile="profile.txt"; source_folders:
        a list of folders whose files the page may contain.
        Errors: Fault, Stuck, Interrupted, TraxError. Ctrl-C ends it by KeyboardInterrupt."""
        error, keep = new_error(), []
        if self._ran:
            raise TraxError("a machine runs once; make another one")
        raised, callback = [], ffi.NULL

        def called(_, status):
            if progress is not None:
                progress(status.cycle, status.instructions, status.items)

        def failed(kind, value, _):  # also KeyboardInterrupt, which Python raises between its own instructions
            raised.append(value or kind())
            self.interrupt()

        callback = ffi.callback("void(void *, const trax_progress *)", called, onerror=failed)
        options = ffi.new("trax_run_options *", {
            "max_cycles": max_cycles, "host_threads": threads, "progress": callback, "interrupt": self._stop})
        if engine is not None:
            keep.append(ffi.new("char[]", engine.encode()))
            options.engine = keep[-1]
        if input is not None:
            options.input = ffi.cast("FILE *", input)
        self._check_outputs(explain, [] if input is None else [input.fileno()])
        if self._manifest:
            options.total_items = lib.trax_manifest_items(self._manifest)
        report = self._explanation(explain, keep, error)
        self._ran = True
        output = Memory()
        options.output = output.file
        status = lib.trax_machine_run(self._handle, options, error)
        printed_text, message = output.text(), message_of(error)
        if report != ffi.NULL:
            check(lib.trax_explain_end(report, error), error)
            if "against" in explain:  # by the trax-eval that belongs to this package, not to the interpreter
                call("trax-eval", "compare", "--add", "--", explain["against"], explain["explore"])
        if raised:
            raise raised[0]
        return self._result(status, message, printed_text)

    def interrupt(self):
        """Ends the run that is under way in another thread, by the exception Interrupted there."""
        self._stop[0] = 1

    def _check_outputs(self, explain, inputs):
        """No file of an explanation may be an input of the run, and none may be written twice."""
        inputs = [*self._inputs, *inputs, *([explain["against"]] if "against" in explain else [])]
        known = {identity(file) for file in inputs}
        for name, path in explain.items():
            if TYPES.get(name) != "char *" or name in ("item_buffer", "title", "against"):
                continue
            which = identity(path)
            if which is not None and which in known:
                raise TraxError(f"{path}: {name} is an input of the run, or is written twice")
            known.add(which)

    def _explanation(self, explain, keep, error):
        if not explain:
            return ffi.NULL
        options, report = ffi.new("struct trax_explain_options *"), ffi.new("struct trax_explain **")
        keep.append(options)
        for name, value in explain.items():
            kind = TYPES.get(name)
            if name == "source_folders":
                continue
            if kind == "char *":
                keep.append(ffi.new("char[]", encoded(value)))
                setattr(options, name, keep[-1])
            elif kind and kind.isidentifier() and not name.endswith("_count"):  # counts are of arrays
                setattr(options, name, value)
            else:
                raise TraxError(f"run has no option \"{name}\"")
        for folder in (*explain.get("source_folders", ()), *([sources()] if sources() else [])):
            keep.append(ffi.new("char[]", encoded(folder)))
            check(lib.trax_explain_add_source_folder(options, keep[-1], error), error)
        check(lib.trax_explain_check_against(options, error), error)
        options.against = ffi.NULL
        check(lib.trax_explain_begin(report, self._handle, options, error), error)
        return report[0]

    def _result(self, status, message, output):
        name = ffi.string(ffi.cast("trax_status", status))
        if name == "TRAX_ERROR":
            raise TraxError(message)
        error = new_error()
        memory = Memory()
        found = lib.trax_stats_put_json(self._handle, True, memory.file, error)
        text = memory.text()
        check(found, error)
        run = Run(output, json.loads(text), self._picture())
        if name == "TRAX_FAULT":
            report = printed(lib.trax_machine_print_fault, self._handle)
            raise Fault(message or report.splitlines()[0], report, run)
        if name != "TRAX_OK":
            raise (Stuck if name == "TRAX_STUCK" else Interrupted)(message, run)
        return run

    def _picture(self):
        symbol, width, height = ffi.new("char **"), ffi.new("uint32_t *"), ffi.new("uint32_t *")
        is_float = ffi.new("bool *")
        if not self._manifest or not lib.trax_manifest_picture(self._manifest, symbol, width, height, is_float):
            return None
        shape = height[0], width[0], 3 if is_float[0] else 4
        values = self.buffer(ffi.string(symbol[0]).decode(), numpy.float32 if is_float[0] else numpy.uint8)
        return Picture(values[:math.prod(shape)].reshape(shape))
