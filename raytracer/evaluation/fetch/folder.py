"""The folder of scenes: meshes appear in it whole, and none is ever replaced."""

import contextlib
import os
import pathlib
import tempfile

from trax_eval.util import Problem


@contextlib.contextmanager
def work_folder(folder):
    """A temporary folder in the folder of scenes, from which files are linked. A new folder of scenes is removed again
    if it stays empty."""
    created = not folder.exists()
    folder.mkdir(parents=True, exist_ok=True)
    try:
        with tempfile.TemporaryDirectory(prefix=".fetch-scenes.", dir=folder) as path:
            yield pathlib.Path(path)
    finally:
        if created:
            with contextlib.suppress(OSError):
                folder.rmdir()


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
