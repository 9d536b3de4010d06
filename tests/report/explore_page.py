"""The page of --explore as tests read it."""

import base64
import json
import re
import zlib


def numbers_in(packed):
    """LEB128 numbers, one after another."""
    value = shift = 0
    for byte in packed:
        value |= (byte & 127) << shift
        shift += 7
        if byte < 128:
            yield value
            value = shift = 0


def unpack(path):
    """The data of a page, and its picture's columns by name. data["rays"]: of each pixel the rays, as objects."""
    packed = {
        name: zlib.decompress(base64.b64decode(text))
        for name, text in re.findall(r'octet-stream" id="(\w+)">([^<]*)</script>', path.read_text())
    }
    data, numbers, columns = json.loads(packed["data"]), numbers_in(packed["pixels"]), {}
    if "picture" in data:
        picture = data["picture"]
        pixels = range(picture["width"] * picture["height"])
        for column in filter(None, picture["columns"]):
            columns[f"{column[0]}.{column[1]}"] = [next(numbers) for _ in pixels]
        if "rays" in picture:
            counts = [next(numbers) for _ in pixels]
            fields = [[next(numbers) for _ in range(sum(counts))] for _ in picture["rays"]["fields"]]
            each = (dict(zip(picture["rays"]["fields"], values)) for values in zip(*fields))
            data["rays"] = [[next(each) for _ in range(count)] for count in counts]
    assert next(numbers, None) is None
    return data, columns
