"""The folder of scenes: meshes appear in it whole, and none is ever replaced."""

import contextlib
import fcntl
import os
import pathlib
import shutil

from trax_eval.util import Problem

WORK = ".fetch-scenes"  # in the folder: downloads as far as they have arrived, and one process's work


def lock(path):
    """A lock of a folder, as a descriptor. The process that has had the lock until then may remove the folder."""
    while True:
        path.mkdir(parents=True, exist_ok=True)
        descriptor = os.open(path, os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC)
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
            if os.path.samestat(os.fstat(descriptor), os.stat(path)):
                return descriptor
        except FileNotFoundError:
            pass
        except OSError as error:
            os.close(descriptor)
            raise Problem(f"{path.parent}: another trax-eval fetch-scenes is at work there") from error
        os.close(descriptor)


@contextlib.contextmanager
def work_folder(folder):
    """Two folders, for downloads, which the next call continues, and for other files, which end with this call."""
    path, created = folder / WORK, not folder.exists()
    descriptor = lock(path)
    downloads, scratch = path / "downloads", path / "scratch"
    shutil.rmtree(scratch, ignore_errors=True)  # of a process that was killed
    downloads.mkdir(exist_ok=True)
    scratch.mkdir()
    try:
        yield downloads, scratch
    finally:
        shutil.rmtree(scratch, ignore_errors=True)
        with contextlib.suppress(OSError):  # unless there is a download to continue
            downloads.rmdir()
            path.rmdir()
            if created:  # and nothing has come into it
                folder.rmdir()
        os.close(descriptor)


def present(folder, name):
    """The file of that name in the folder, which may be packed; None. What a run of trax-eval would find."""
    return next((path for path in (folder / name, folder / f"{name}.xz") if os.path.lexists(path)), None)


def put(path, folder, name):
    """Moves a whole file into the folder. A file that has appeared there meanwhile stays."""
    with open(path, "rb") as file:
        os.fsync(file.fileno())
    target = pathlib.Path(folder, name)
    try:
        os.link(path, target)
    except FileExistsError:
        raise Problem(f"{target}: is there already, and is not replaced") from None
    except OSError:  # a file system without links
        if os.path.lexists(target):
            raise Problem(f"{target}: is there already, and is not replaced") from None
        os.rename(path, target)
