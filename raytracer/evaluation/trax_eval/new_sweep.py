"""trax-eval new-sweep: asks what a sweep is to be, and writes it. Every answer is checked as the finished file will be."""

import json
import os
import pathlib
import tempfile

from .fields import installed
from .sweep import CHIPS, option_of, read_sweep
from .util import Problem, write_file


def words(text):
    return [word.strip() for word in text.split(",") if word.strip()]


def one_or_all(values):
    return values[0] if len(values) == 1 else values


def value_of(text):
    """A number, true or false, or the text as it is."""
    try:
        value = json.loads(text)
    except (ValueError, RecursionError):
        return text
    return value if isinstance(value, (bool, int, float)) else text


def ask(question, default, out):
    out.write(f"{question}{f' [{default}]' if default else ''}: ")
    out.flush()
    try:
        answer = input().strip()
    except EOFError:
        out.write("\n")
        raise Problem("new-sweep: the answers ended early; nothing was written") from None
    except UnicodeDecodeError:
        raise Problem("new-sweep: the answers are no text") from None
    return answer or default


def questions(path):
    """(key, question, default, what the answer becomes)"""
    return [("name", "Name, letters, digits and . + - _", path.stem, str),
            ("title", "Title", "", str),
            ("scenes", f"Scenes, with commas between: {', '.join(installed('scenes'))}, or files NAME.json", "paper", lambda text: one_or_all(words(text))),
            ("programs", f"Programs: {', '.join(installed('programs'))}, or files NAME.json", "paper", lambda text: one_or_all(words(text))),
            ("workloads", f"Workloads: {', '.join(installed('workloads'))}, or files NAME.json; none: a ray from the eye and one to the light", "", words),
            ("chips", f"Chips: {CHIPS[0]} to {CHIPS[-1]}, paper (these fifteen), or files NAME.cfg", "4x32", lambda text: one_or_all(words(text))),
            ("size", "Size of the pictures", "1280x720", str)]


def check(value, path, check_machines):
    """As the file will be read, beside its programs and scenes. What is not asked for yet is what most have."""
    whole = {"name": "new", "scenes": "paper", "chips": "4x32"} | value
    handle, name = tempfile.mkstemp(prefix=".new-sweep.", suffix=".json", dir=path.parent)
    try:
        with open(handle, "w") as file:
            json.dump(whole, file)
        sweep = read_sweep(name)
        check_machines([sweep])
        return sweep
    except Problem as problem:
        raise Problem(str(problem).removeprefix(f"{name}: ")) from None
    finally:
        os.unlink(name)


def text_of(value):
    """A member a line, and one for each key of `set`."""
    lines = []
    for key, member in value.items():
        if key == "set":
            inner = ",\n".join(f"    {json.dumps(one)}: {json.dumps(values, ensure_ascii=False)}" for one, values in member.items())
            lines.append(f'  "set": {{\n{inner}\n  }}')
        else:
            lines.append(f"  {json.dumps(key)}: {json.dumps(member, ensure_ascii=False)}")
    return "{\n" + ",\n".join(lines) + "\n}\n"


def new_sweep(path, check_machines, out):
    """check_machines: of a list of sweeps, fails by a Problem."""
    path = pathlib.Path(path)
    if path.suffix != ".json":
        raise Problem(f"new-sweep: {path}: expected NAME.json")
    if path.exists():
        raise Problem(f"new-sweep: {path}: is there already")
    if not path.parent.is_dir():
        raise Problem(f"new-sweep: {path.parent}: there is no such folder")
    value, varied = {}, {}

    def accepted(changes):
        try:
            check(value | changes, path, check_machines)
        except Problem as problem:
            out.write(f"  {problem}\n")
            return False
        value.update(changes)
        return True

    for key, question, default, become in questions(path):
        while (answer := ask(question, default, out)) and not accepted({key: become(answer)}):
            pass
    while key := ask("A key that varies: of the machine (trax-sim --help-config), or trax-scene --OPTION, trax-render --OPTION; none: that is all", "", out):
        values = [value_of(word) for word in words(ask(f"Values of {key}, with commas between" + ("; true: given, false: left out" if option_of(key) else ""), "", out))]
        if accepted({"set": varied | {key: values}}):
            varied[key] = values
    if varied:
        first = next(iter(varied))
        while not accepted({"x": ask("What a plot has on its x axis: threads, or a key that varies", first if not option_of(first) else "threads", out),
                            "y": ask("And on y: a statistic (trax-sim --help-stats) or values.NAME", "mrps", out)}):
            pass
    sweep = check(value, path, check_machines)
    write_file(path, text_of(value))
    out.write(f"{path}: {len(sweep.points)} runs. To make them: trax-eval {path} SCENES --report\n")
    return 0
