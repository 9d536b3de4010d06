"""Workloads: which rays a picture has, as options of trax-render and trax-scene; a file each in ../workloads."""

import pathlib
import re

from .util import Problem, TEXT_LIMIT, read_json

FOLDER = pathlib.Path(__file__).resolve().parent.parent / "workloads"
KEYS = ("name", "title", "render", "scene")
PAPER = ""  # one point light, its shadows, Lambert's law: what a sweep without workloads has


def read_workload(path):
    value = read_json(path, TEXT_LIMIT)
    if not isinstance(value, dict):
        raise Problem(f"{path}: expected an object")
    for key in value:
        if key not in KEYS:
            raise Problem(f'{path}: unknown key "{key}"; allowed are ' + ", ".join(f'"{known}"' for known in KEYS))
    name = value.get("name")
    if not isinstance(name, str) or not re.fullmatch(r"[\w.+-]+", name):
        raise Problem(f"{path}: name: expected letters, digits and . + - _")
    for key in ("render", "scene"):
        words = value.get(key, [])
        if not isinstance(words, list) or not all(isinstance(word, str) for word in words):
            raise Problem(f"{path}: {key}: expected a list of texts, the options and their values")
    if not isinstance(value.get("title", ""), str):
        raise Problem(f"{path}: title: expected a text")
    return {"name": name, "title": value.get("title", name), "render": value.get("render", []), "scene": value.get("scene", [])}


def find_workload(name, beside):
    """The workload of that name, or in the file NAME.json; beside: the folder that relative names of files begin in."""
    path = pathlib.Path(beside, name) if name.endswith(".json") else FOLDER / f"{name}.json"
    if not re.fullmatch(r"[\w.+/-]{1,200}", name) or not path.is_file():
        known = ", ".join(f'"{file.stem}"' for file in sorted(FOLDER.glob("*.json")))
        raise Problem(f'"{name}" is no workload; allowed are {known}, and files NAME.json')
    return read_workload(path)
