"""Workloads: which rays a picture has, as options of trax-render and trax-scene; a file each in ../workloads."""

from .fields import find_file, read_fields, unknown

KEYS = ("name", "title", "render", "scene", "rays")
# The order is that of their numbers in files of rays (trax/ray_kinds.h).
KINDS = ("primary", "shadow", "occlusion", "diffuse", "glossy", "mirror", "glass", "other")
PAPER = ""  # one point light, its shadows, Lambert's law: what a sweep without workloads has


def no_workload():
    return {"name": PAPER, "title": "", "render": [], "scene": [], "rays": "", "file": ""}


def read_workload(path):
    fields = read_fields(path, KEYS)
    name, rays = fields.name(), fields.text("rays", "")
    if rays and rays not in KINDS:
        fields.fail("rays", f'allowed are {", ".join(KINDS)}, is "{rays}"')
    return {
        "name": name, "title": fields.text("title", name), "rays": rays, "file": str(path),
        **{key: fields.words(key, "the options and their values") for key in ("render", "scene")}
    }


def find_workload(name, beside):
    """The workload of that name, or in the file NAME.json; beside: the folder that relative names of files begin in."""
    path = find_file("workloads", name, beside)
    if not path:
        raise unknown("workloads", name, "workload")
    return read_workload(path)
