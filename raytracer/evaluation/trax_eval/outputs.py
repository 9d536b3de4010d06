"""Outputs by the rule of all programs (emulator/base/include/trax/output.h): a file is whole, or not there, or the
earlier one; what is no regular file is written to, never replaced; a symbolic link leads to the file that is replaced;
no output is a file that was read."""

import errno
import os
import re
import socket
import stat
import sys
import threading

MOST_LINKS = 40
DESCRIPTORS = re.compile(r"/dev/(?:(stdin)|(stdout)|(stderr)|fd/(\d{1,7}))|/proc/self/fd/(\d{1,7})")
read = set()  # identities of all files that the command under way has opened for reading


def identity(found):
    """A file's identity, by its status. A later file may have the inode of a removed one."""
    return found.st_dev, found.st_ino, found.st_ctime_ns


class IsInput(Exception):
    """The output is an input. The message is for the user."""


def note(event, arguments):
    """Python tells of each file that is opened (sys.addaudithook)."""
    if event != "open" or not isinstance(arguments[0], (str, bytes)):
        return
    if (arguments[2] or 0) & os.O_ACCMODE != os.O_RDONLY:
        return
    try:
        found = os.stat(arguments[0])
    except (OSError, ValueError):
        return
    read.add(identity(found))


sys.addaudithook(note)


def open_standard_streams():
    """A file that is opened while a standard stream is closed would get its number."""
    for number, name, mode in ((0, "stdin", "r"), (1, "stdout", "w"), (2, "stderr", "w")):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)
        if getattr(sys, name) is None:
            setattr(sys, name, os.fdopen(number, mode))


def fail(code, path):
    raise OSError(code, os.strerror(code), str(path))


def behind_links(path):
    for _ in range(MOST_LINKS):
        if not os.path.islink(path):
            return path
        path = os.path.join(os.path.dirname(path), os.readlink(path))
    fail(errno.ELOOP, path)


def write_all(descriptor, data):
    with os.fdopen(descriptor, "wb") as file:
        file.write(data)


def temporary_name(target):
    """Returns a name beside the target, however long the target's is. scratch.py removes those of dead processes."""
    folder, name = os.path.split(target)
    ending = f".{socket.gethostname()}.{os.getpid()}.{threading.get_native_id()}"
    return os.path.join(folder, "." + os.fsdecode(os.fsencode(name)[:254 - len(os.fsencode(ending))]) + ending)


def check_target(target, path, foreign):
    """Returns the status of the file to be replaced, or None. Only a regular file may be replaced, and a foreign one
    only if it was not read."""
    try:
        found = os.lstat(target)
    except FileNotFoundError:
        return None
    if not stat.S_ISREG(found.st_mode):
        fail(errno.EISDIR if stat.S_ISDIR(found.st_mode) else errno.EEXIST, path)
    if foreign and identity(found) in read:
        raise IsInput(f"{path}: is an input and the output")
    if not os.access(target, os.W_OK):
        fail(errno.EACCES, path)
    return found


def write_output(path, data, foreign=False):
    """Writes data (bytes or text). foreign: the user named the file, which this program does not keep and read again.
    Raises OSError, and IsInput."""
    path, data = os.fspath(path), data.encode() if isinstance(data, str) else data
    named = DESCRIPTORS.fullmatch(path)
    if named:
        sys.stdout.flush()
        number = next(at if at < 3 else int(text) for at, text in enumerate(named.groups()) if text)
        return write_all(os.dup(number), data)
    try:
        found = os.stat(path)
    except FileNotFoundError:
        found = None
    if found and not stat.S_ISREG(found.st_mode) and not stat.S_ISDIR(found.st_mode):
        return write_all(os.open(path, os.O_WRONLY | os.O_NOCTTY), data)
    target = behind_links(path)
    existing = check_target(target, path, foreign)
    beside = temporary_name(target)
    try:
        with open(beside, "wb") as file:
            if existing:
                os.fchmod(file.fileno(), stat.S_IMODE(existing.st_mode))
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        check_target(target, path, foreign)
        os.replace(beside, target)
    except BaseException:
        if os.path.lexists(beside):
            os.unlink(beside)
        raise
