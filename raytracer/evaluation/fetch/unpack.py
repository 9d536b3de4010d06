"""Takes one file out of an archive or a packed file. Nothing else of an archive is written anywhere."""

import errno
import gzip
import lzma
import pathlib
import tarfile
import zipfile
import zlib

from .problems import Failed

LIMIT = 1 << 30  # bytes of an unpacked file, as of trax-scene
CHUNK = 1 << 18
DAMAGE = (tarfile.TarError, zipfile.BadZipFile, EOFError, lzma.LZMAError, zlib.error, gzip.BadGzipFile,
          UnicodeDecodeError,  # a name in a zip file
          NotImplementedError, RuntimeError)  # a zip file that is encrypted or packed in an unknown way


def copy(source, path, name):
    size = 0
    with open(path, "wb") as target:
        while data := source.read(CHUNK):
            size += len(data)
            if size > LIMIT:
                raise Failed(f"{name}: more than {LIMIT} bytes unpacked")
            target.write(data)


def chosen(names, member, archive):
    """The member of that path, or else the only one of its name in some folder."""
    known = {str(pathlib.PurePosixPath(name)): name for name in names}
    last = member.rpartition("/")[2]
    same = [name for path, name in known.items() if path.rpartition("/")[2] == last]
    if member in known or len(same) == 1:
        return known.get(member) or same[0]
    raise Failed(f"{archive.name} holds no {member}")


def take_from_tar(archive, member, path):
    with tarfile.open(archive) as tar:
        files = {one.name: one for one in tar if one.isreg()}
        with tar.extractfile(files[chosen(files, member, archive)]) as source:
            copy(source, path, member)


def take_from_zip(archive, member, path):
    with zipfile.ZipFile(archive) as packed:
        files = [name for name in packed.namelist() if not name.endswith("/")]
        with packed.open(chosen(files, member, archive)) as source:
            copy(source, path, member)


def take(archive, member, path):
    """Writes the member of an archive to path."""
    try:
        (take_from_zip if zipfile.is_zipfile(archive) else take_from_tar)(archive, member, path)
    except DAMAGE as error:
        raise Failed(f"{archive.name}: damaged: {error}") from error
    except OSError as error:
        if error.errno != errno.EINVAL:  # zipfile seeks a place before the file's first byte
            raise
        raise Failed(f"{archive.name}: damaged: a place outside of it") from error


def unpacked(path):
    """The file without its packing: a name that ends in .gz or .xz loses this ending."""
    opener = {".gz": gzip.open, ".xz": lzma.open}.get(path.suffix)
    if not opener:
        return path
    try:
        with opener(path) as source:
            copy(source, path.with_suffix(""), path.name)
    except DAMAGE as error:
        raise Failed(f"{path.name}: damaged: {error}") from error
    return path.with_suffix("")
