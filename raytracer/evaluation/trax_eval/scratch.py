"""Folders for unfinished files."""

import os
import pathlib
import shutil
import socket
import tempfile


def new_scratch(out):
    """A folder for one process's unfinished files, named after the process. out: the folder of results; None: nothing
    may be written there."""
    folder = out / "scratch" if out else pathlib.Path(tempfile.gettempdir())
    folder.mkdir(parents=True, exist_ok=True)
    return tempfile.mkdtemp(prefix=f"{'' if out else 'trax-eval.'}{socket.gethostname()}.{os.getpid()}.", dir=folder)


def process_lives(pid):
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        return True
    return True


def clean_scratch(out):
    """Removes what dead processes of this host have left; of None what they have left in the folder for temporary
    files."""
    host, temporary = f"{socket.gethostname()}.", pathlib.Path(tempfile.gettempdir())
    folders = [out / name
               for name in (".", "scratch", "runs", "jobs", "pictures", "scenes", "sweeps")] if out else [temporary]
    for folder in folders:
        for path in folder.glob(f"*{host}*" if out else f"trax-eval.{host}*"):
            owner = path.name.split(host, 1)[1].split(".")[0]
            if not owner.isdigit() or process_lives(int(owner)) or path.lstat().st_uid != os.getuid():
                continue
            if path.is_dir() and not path.is_symlink():
                shutil.rmtree(path, ignore_errors=True)
            else:
                path.unlink(missing_ok=True)
