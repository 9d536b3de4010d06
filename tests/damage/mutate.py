"""Damage to inputs: to bytes, fields of ELF files, lines of text and members of JSON. Each function takes a
random.Random and the bytes of a good input, and returns those of a damaged one."""
import copy
import ctypes
import ctypes.util
import json
import struct
import zlib

WORDS = (0, 1, 2, 3, 4, 7, 16, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF, 0xFFFFFFF0, 0x10000, 0x40000000)
NUMBERS = (
    "0 -1 1 2 nan inf -inf 1e39 1e400 1e-46 4294967296 2147483648 18446744073709551616 0x 99999999999999999999999999 "
    "-0 . 1e + 0.1.2 %s%n 1/2/3/4 -9223372036854775808".split()
)
TEXTS = ["", "x", "../x", "%s%n", "\u0001", "<script>", "$(touch x)", "a" * 300]
MEMBERS = [None, 0, -1, 1, 2**31, 2**32, 2**63 - 1, -(2**63), 1e300, 0.5, [], {}, True, [[]], {"file": "x"}, *TEXTS]


def of_bytes(rng, data):
    """One to eight changes of any bytes."""
    data = bytearray(data)
    for _ in range(rng.choice((1, 1, 1, 2, 3, 8))):
        place, length = rng.randrange(len(data) + 1), rng.choice((1, 1, 2, 4, 8, 64))
        kind = rng.randrange(7)
        if kind == 0 and place < len(data):
            data[place] ^= 1 << rng.randrange(8)
        elif kind == 1:
            data[place : place + length] = bytes(
                rng.choice((0, 0xFF, 0x7F, 0x80, rng.randrange(256))) for _ in range(length)
            )
        elif kind == 2:
            del data[place : place + length]
        elif kind == 3:
            data[place:place] = rng.randbytes(length)
        elif kind == 4:
            other = rng.randrange(len(data) + 1)
            data[place:place] = data[other : other + 16 * length]
        elif kind == 5 and rng.random() < 0.4:
            del data[place:]
        else:  # a word, at its alignment, in the first kilobyte as often as anywhere
            place = min(place, 1024) if rng.random() < 0.5 else place
            data[place & ~3 : (place & ~3) + 4] = struct.pack("<I", rng.choice(WORDS))
    return bytes(data)


class Digest(ctypes.Structure):
    _fields_ = [("low", ctypes.c_uint64), ("high", ctypes.c_uint64)]


def digest_of(data):
    """XXH3's 128 bits."""
    function = ctypes.CDLL(ctypes.util.find_library("xxhash")).XXH3_128bits
    function.restype, function.argtypes = Digest, [ctypes.c_char_p, ctypes.c_size_t]
    digest = function(bytes(data), len(data))
    return struct.pack("<QQ", digest.low, digest.high)


def of_checkpoint(rng, data):
    """Of its contents, which keep their size, with a right digest; a twelfth of them as of any bytes. The header
    (emulator/host/checkpoint.c) has the size of what follows in bytes 32 to 39, and the digest at its end."""
    if rng.randrange(12) == 0:
        return of_bytes(rng, data)
    (compressed,) = struct.unpack_from("<Q", data, 32)
    header, body = bytearray(data[:-compressed]), bytearray(zlib.decompress(data[-compressed:]))
    for _ in range(rng.choice((1, 1, 2, 3, 8))):
        length = rng.choice((1, 2, 4, 8))
        place, other = (rng.randrange(len(body) // length) * length for _ in range(2))
        old = int.from_bytes(body[place : place + length], "little")
        flipped = old ^ 1 << rng.randrange(8 * length)
        new = rng.choice((0, -1, old + 1, old - 1, flipped, rng.getrandbits(8 * length)))
        body[place : place + length] = rng.choice(
            ((new & ((1 << 8 * length) - 1)).to_bytes(length, "little"), body[other : other + length])
        )
    packed = zlib.compress(bytes(body), 1)
    struct.pack_into("<Q", header, 32, len(packed))
    header[-16:] = bytes(16)
    header[-16:] = digest_of(bytes(header) + packed)
    return bytes(header) + packed


def elf_tables(data):
    """Yields (offset, size of an entry, entries) of the tables of a 32-bit file, which may be in an archive.

    These are its header, segments, sections, and each section that has entries."""
    begin = data.index(b"\x7fELF")
    yield begin + 16, 36, 1
    (programs, sections), (size, count, section_size, section_count) = struct.unpack_from(
        "<II", data, begin + 28
    ), struct.unpack_from("<4H", data, begin + 42)
    yield begin + programs, size, count
    yield begin + sections, section_size, section_count
    for index in range(section_count):
        header = struct.unpack_from("<10I", data, begin + sections + index * section_size)
        if header[9] and header[1] != 8:
            yield begin + header[4], header[9], header[5] // header[9]


def of_elf(rng, data):
    """Changes a field of a table; sometimes bytes as well."""
    data = bytearray(data)
    tables = [table for table in elf_tables(data) if table[1] and table[2]]
    for _ in range(rng.choice((1, 1, 2, 3))):
        offset, size, count = rng.choice(tables)
        length = rng.choice((1, 2, 4, 4, 4))
        place = offset + rng.randrange(count) * size + rng.randrange(max(1, size // length)) * length
        if place + length > len(data):
            continue
        old = int.from_bytes(data[place : place + length], "little")
        value = rng.choice(
            (*WORDS, old + 1, old - 1, old * 2, old ^ 1 << rng.randrange(32), len(data), rng.randrange(len(data)))
        )
        data[place : place + length] = (value % (1 << 8 * length)).to_bytes(length, "little")
    return bytes(data) if rng.random() < 0.8 else of_bytes(rng, data)


def of_text(rng, data):
    """Changes of words and lines; sometimes bytes as well."""
    lines = data.split(b"\n")
    for _ in range(rng.choice((1, 1, 2, 4))):
        at = rng.randrange(len(lines))
        kind = rng.randrange(6)
        if kind == 0:
            lines[at:at] = [lines[rng.randrange(len(lines))]] * rng.choice((1, 1, 2, 300))
        elif kind == 1 and len(lines) > 1:
            del lines[at]
        elif kind == 2:
            other = rng.randrange(len(lines))
            lines[at], lines[other] = lines[other], lines[at]
        else:
            words = lines[at].split(b" ")
            place = rng.randrange(len(words))
            words[place] = rng.choice(
                (
                    rng.choice(NUMBERS).encode(),
                    rng.choice(words),
                    words[place] * rng.choice((2, 2, 3000)),
                    b"\xff\xfe",
                    b"\0",
                    b"",
                )
            )
            lines[at] = b" ".join(words)
    data = b"\n".join(lines)
    return data if rng.random() < 0.8 else of_bytes(rng, data)


def places_of(node):
    """Paths of all members."""
    below = node.items() if isinstance(node, dict) else enumerate(node) if isinstance(node, list) else ()
    for key, value in below:
        yield [key]
        yield from ([key, *path] for path in places_of(value))


def of_json(rng, data):
    """Changes, removes or adds members; sometimes bytes."""
    if rng.random() < 0.2:
        return of_bytes(rng, data)
    document = json.loads(data)
    for _ in range(rng.choice((1, 1, 2))):
        paths = list(places_of(document))
        if not paths:
            break
        path = rng.choice(paths)
        place = document
        for step in path[:-1]:
            place = place[step]
        kind = rng.randrange(5)
        if kind == 0:
            del place[path[-1]]
        elif kind == 1 and isinstance(place, dict):
            place[path[-1] + rng.choice(("s", "x", ""))] = copy.deepcopy(rng.choice(MEMBERS))
        elif kind == 2 and isinstance(place, list):
            place *= rng.choice((2, 40))
        else:
            place[path[-1]] = copy.deepcopy(rng.choice(MEMBERS))
    return json.dumps(document).encode()
