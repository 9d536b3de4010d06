"""Folders for what is not finished."""

import os
import shutil
import socket
import tempfile


def new_scratch(out):
    """A folder for one process's unfinished files, named after the process."""
    folder = out / "scratch"
    folder.mkdir(parents=True, exist_ok=True)
    return tempfile.mkdtemp(prefix=f"{socket.gethostname()}.{os.getpid()}.", dir=folder)


def process_lives(pid):
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        return True
    return True


def clean_scratch(out):
    """Removes what dead processes of this host have left."""
    host = socket.gethostname()
    for folder in ("scratch", "runs", "jobs", "pictures"):
        for path in (out / folder).glob(f"*{host}.*"):
            owner = path.name.split(f"{host}.", 1)[1].split(".")[0]
            if owner.isdigit() and not process_lives(int(owner)):
                shutil.rmtree(path, ignore_errors=True) if path.is_dir() else path.unlink(missing_ok=True)
