"""The page of --explore as tests read it."""

import base64
import json
import re
import zlib


def unpack(path):
    """The data of a page, and its picture's columns by name."""
    packed = {
        name: zlib.decompress(base64.b64decode(text))
        for name, text in re.findall(r'octet-stream" id="(\w+)">([^<]*)</script>', path.read_text())
    }
    data, numbers, columns = json.loads(packed["data"]), iter(packed["pixels"]), {}
    if "picture" in data:
        for column in filter(None, data["picture"]["columns"]):
            values = columns[f"{column[0]}.{column[1]}"] = []
            for _ in range(data["picture"]["width"] * data["picture"]["height"]):
                value = shift = 0
                while (byte := next(numbers)) >= 128:
                    value |= (byte & 127) << shift
                    shift += 7
                values.append(value | byte << shift)
    assert next(numbers, None) is None
    return data, columns
