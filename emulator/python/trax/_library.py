"""The shared library, declared by its own headers, and what every call of it needs."""

import os
import pathlib

import cffi

HERE = pathlib.Path(__file__).resolve().parent
ffi = cffi.FFI()
ffi.cdef((HERE / "declarations.h").read_text())
ffi.cdef("""
FILE *open_memstream(char **text, size_t *size);
int fclose(FILE *file);
int fflush(FILE *file);
void free(void *memory);
""")
libc = ffi.dlopen(None)


def _find():
    """libtraxemu.so: of a wheel beside this file, otherwise two folders above the package."""
    for path in (HERE / "libtraxemu.so", HERE.parents[1] / "libtraxemu.so"):
        if path.exists():
            return str(path)
    raise ImportError(f"libtraxemu.so is neither in {HERE} nor in {HERE.parents[1]}")


lib = ffi.dlopen(_find())


class TraxError(Exception):
    """Bad input: a wrong key, value, file or program. The message names the place."""


class Fault(TraxError):
    """The program caused a fault. `report` is what trax-sim prints of it; `run` has the figures up to then."""
    def __init__(self, message, report="", run=None):
        super().__init__(message)
        self.report, self.run = report, run


class Stuck(TraxError):
    """The run passed `max_cycles`, or the watchdog ended it. `run` has the figures up to then."""
    def __init__(self, message, run=None):
        super().__init__(message)
        self.run = run


class Interrupted(Stuck):
    """Machine.interrupt ended the run. `run` has the figures up to then."""


def new_error():
    return ffi.new("trax_error *")


def message_of(error):
    return ffi.string(error.message).decode(errors="replace")


def check(status, error):
    """Raises TraxError unless the status is TRAX_OK."""
    if status != lib.TRAX_OK:
        raise TraxError(message_of(error))


def encoded(path):
    """A path or word as the bytes that the library reads up to a zero."""
    text = os.fsencode(path)
    if b"\0" in text:
        raise TraxError(f"{path!r} has a zero byte")
    return text


class Memory:
    """A stream of C whose text is kept: for what the library prints."""
    def __init__(self):
        self._text, self._size = ffi.new("char **"), ffi.new("size_t *")
        self.file = libc.open_memstream(self._text, self._size)
        if self.file == ffi.NULL:
            raise MemoryError

    def text(self):
        """Closes the stream, and returns the text written to it."""
        libc.fclose(self.file)
        data = ffi.buffer(self._text[0], self._size[0])[:]
        libc.free(self._text[0])
        return data.decode(errors="replace")


def printed(function, *arguments):
    """What a function prints to its last argument, a FILE."""
    memory = Memory()
    function(*arguments, memory.file)
    return memory.text()
