"""A run as its files have it: the statistics of --stats, the page of --explore, and what is beside the statistics."""

import base64
import csv
import json
import pathlib
import re
import zlib

from trax_eval.pictures import read_rgb
from trax_eval.util import FILE_LIMIT, STRICT, Problem, json_of, read_bytes, read_json

TINIEST, LARGEST = 1e-100, 1e100  # quotients and sums of such numbers are finite
HOST = ("host_seconds", "instructions_per_host_second")  # figures of the host, which no comparison is about
HOW = {
    "profile": "--explore FILE.html",
    "kinds": "--explore FILE.html",
    "picture": "--explore FILE.html, or a PNG",
    "costs": "--explore FILE.html",
}


def is_number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def is_figure(value):
    """A number that a run can have: its quotients and sums are finite."""
    return is_number(value) and (value == 0 or TINIEST < abs(value) < LARGEST)


def flat(value, name=""):
    """The leaves of a JSON value, by their names with dots."""
    if isinstance(value, (dict, list)) and value:
        for key, item in value.items() if isinstance(value, dict) else enumerate(value):
            yield from flat(item, f"{name}.{key}" if name else str(key))
    else:
        yield name, value


def is_statistics(value):
    return isinstance(value, dict) and "trax_sim" in value and "causes" in value


def check_statistics(path, stats):
    """Checks the members that every comparison needs."""
    def need(holds, what):
        if not holds:
            raise Problem(f"{path}: is no statistics file (trax-sim --stats): {what}")

    need(isinstance(stats, dict), "it is no object")
    for name in ("cycles", "threads", "thread_cycles"):
        need(is_number(stats.get(name)) and stats[name] >= 0, f'"{name}" is no number of at least 0')
    need(stats["threads"] > 0, '"threads" is 0')
    for name in ("causes", "configuration"):
        need(isinstance(stats.get(name), dict), f'"{name}" is no object')
    need(isinstance(stats["configuration"].get("chip", {}), dict), '"configuration.chip" is no object')
    for name, value in flat(stats):
        need(not is_number(value) or is_figure(value), f'"{name}" is no figure that a run can have')
    for cause, cycles in stats["causes"].items():
        need(is_number(cycles), f'"causes.{cause}" is no number')
    sampled = stats.get("sampled")
    need(sampled is None or isinstance(sampled, dict) and is_number(sampled.get("cycles_low")) and
         is_number(sampled.get("cycles_high")), '"sampled" has no interval of cycles')


class Run:
    """profile: {"functions": {name: {cause: thread-cycles}}, "lines": the same}; kinds: {name: row of --ray-kinds};
    picture: (width, height, bytes of R, G, B); costs: {cause: thread-cycles of each pixel}. None: not known."""
    def __init__(self, path):
        self.path, self.notes = pathlib.Path(path), []
        self.profile = self.kinds = self.picture = self.costs = None
        if self.path.suffix.lower() in (".html", ".htm"):
            self.stats = self.take_page(self.path)
            check_statistics(path, self.stats)
        else:
            data = read_bytes(self.path)  # once: it may be a pipe
            if not data.lstrip().startswith(b"{"):
                raise Problem(f"{path}: is neither a file of --stats nor, as NAME.html, a page of --explore")
            self.stats = json_of(path, data)
            check_statistics(path, self.stats)
            self.take_neighbours()

    def take_neighbours(self):
        """Reads page and picture beside the statistics that have their name."""
        page, picture = self.path.with_suffix(".html"), self.path.with_suffix(".png")
        if page.is_file():
            other = self.take_page(page)
            if {name: value for name, value in self.stats.items() if name not in HOST} != other:
                self.profile = self.kinds = self.picture = self.costs = None
                self.notes.append(f"{page}: is the page of another run, and not used")
        if self.picture is None and picture.is_file():
            self.picture = read_rgb(picture)

    def take_page(self, path):
        """Reads a page of --explore, and returns its statistics."""
        text = read_bytes(path).decode(errors="replace")
        try:
            page = json.loads(unpack(text, "data"), **STRICT)
            names = page["names"]
            causes = list(page["stats"]["causes"])
            self.profile = {"functions": {}, "lines": {}}
            for instruction in page["instructions"][:-1]:
                function, line = instruction[4][0] if instruction[4] else (0, 0)
                places = {"functions": names[function] or "(no function)", "lines": short_line(names[line])}
                for table, name in places.items():
                    for cause, cycles in zip(causes, instruction[5]):
                        add(self.profile[table], name, cause, cycles)
            self.kinds = read_kinds(page["ray_kinds"])
            if "picture" in page:
                self.take_picture(page["picture"], unpack(text, "pixels"))
            return page["stats"]
        except (ValueError, TypeError, KeyError, IndexError, AttributeError, ArithmeticError, RecursionError,
                csv.Error, zlib.error) as error:
            raise Problem(f"{path}: is no page of --explore ({type(error).__name__}: {error})") from error

    def take_picture(self, picture, packed):
        width, height, at = picture["width"], picture["height"], 0
        if min(width, height) < 1:
            raise ValueError("a picture without pixels")
        costs, channels = {}, {}
        for group, name, *_ in picture["columns"][:-1]:
            values, at = numbers(packed, at, width * height)
            if group == "causes":
                costs[name] = values
            elif group == "picture":
                before, channel = 0, bytearray(width * height)
                for place, value in enumerate(values):
                    before = channel[place] = (before + value) & 255
                channels[name] = channel
        planes = [channels[name] for name in ("red", "green", "blue")]
        pixels = bytearray(3 * width * height)
        for place, plane in enumerate(planes):
            pixels[place::3] = plane
        self.picture, self.costs = (width, height, bytes(pixels)), costs


def unpack(text, name):
    found = re.search(rf'<script type="application/octet-stream" id="{name}">([A-Za-z0-9+/=]*)</script>', text)
    if not found:
        raise ValueError(f"no part {name}")
    unpacker = zlib.decompressobj()
    data = unpacker.decompress(base64.b64decode(found[1]), FILE_LIMIT)
    if not unpacker.eof:
        raise ValueError(f"the part {name} ends early, or has more than {FILE_LIMIT} bytes")
    return data


def numbers(packed, at, count):
    """LEB128 numbers from a place on, and the place behind them."""
    values = []
    for _ in range(count):
        value = shift = 0
        while packed[at] >= 128:
            if shift > 63:
                raise ValueError("a number of more than 64 bits")
            value |= (packed[at] & 127) << shift
            shift, at = shift + 7, at + 1
        values.append(value | packed[at] << shift)
        at += 1
    return values, at


def add(table, name, cause, cycles):
    if not isinstance(name, str) or not is_figure(cycles):
        raise ValueError(f"{cycles!r:.40} thread-cycles of {name!r:.40}")
    if cycles:
        row = table.setdefault(name, {})
        row[cause] = row.get(cause, 0) + cycles


def short_line(name):
    """FILE:LINE without the folder, which differs between builds."""
    return name.rpartition("/")[2] or "(no line)"


def read_kinds(text):
    """The rows of --ray-kinds by kind, without the two that are sums and remainders. None: the page has none."""
    rows = list(csv.DictReader(text.splitlines()))
    kinds = {row["kind"]: {name: float(value) if "." in value or "e" in value else int(value)
                           for name, value in row.items() if name not in ("kind", "part")}
             for row in rows if row["kind"] not in ("rest", "all")}
    if not all({"rays", "thread_cycles"} <= row.keys() and all(map(is_figure, row.values())) for row in kinds.values()):
        raise ValueError("a kind of rays has a figure that no run can have")
    return kinds if rows else None


def runs_of(folder):
    """The runs of a folder by name: its statistics, and pages of --explore that have none beside them."""
    found = {}
    for path in sorted(pathlib.Path(folder).iterdir()):
        if path.suffix == ".json" and path.is_file() and is_statistics(read_json(path, strict=False)):
            found[path.stem] = path
    for path in sorted(pathlib.Path(folder).glob("*.html")):
        if path.stem not in found and path.is_file() and b'id="pixels"' in read_bytes(path):
            found[path.stem] = path
    if not found:
        raise Problem(f"{folder}: has no run, neither statistics (--stats NAME.json) nor a page (--explore NAME.html)")
    return {name: Run(path) for name, path in found.items()}
