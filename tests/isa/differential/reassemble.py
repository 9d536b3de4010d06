#!/usr/bin/env python3
"""Disassembles and assembles again: the words of random programs, every format with its fields at both ends and each of
their bits, and a sample of all legal words of every instruction (isa-differential --words). trax-objdump's text, with
aliases and without, goes through clang --target=trax, and must give the same words.

  reassemble.py --bin build/bin --count 300

Targets of branches and jumps are printed as addresses and assembled as distances, so they are taken back to these.
"""

import argparse
import array
import os
import pathlib
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2]))
import elf_files  # noqa: E402
from progress import Progress  # noqa: E402

CHUNK = 1 << 18  # words of one object
LINE = re.compile(r"^\s*([0-9a-f]+): ([0-9a-f]{8})\s+(.*?)\s*$")
TARGET = re.compile(r"(?:^|(?<=[\s,]))0x([0-9a-f]+)$")


class Failure(Exception):
    pass


def run(*command, output=None):
    result = subprocess.run(command, stdout=output or subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
    if result.returncode:
        raise Failure(f"{' '.join(command)}: exit status {result.returncode}\n{result.stderr[:2000]}")
    return result.stdout


def read_words(path):
    words = array.array("I")
    with open(path, "rb") as file:
        words.frombytes(file.read())
    if sys.byteorder == "big":
        words.byteswap()
    return words


def text_section(path):
    """The words of .text of an object, which must have no relocations: every field is in its word."""
    elf = elf_files.ElfFile(pathlib.Path(path).read_bytes())
    if any(section.kind in (elf_files.RELA, elf_files.REL) and section.size for section in elf.sections):
        raise Failure(f"{path}: there are relocations")
    words = array.array("I", elf.contents(elf.section(".text")))
    if sys.byteorder == "big":
        words.byteswap()
    return words


def as_distance(text, address):
    def distance(match):
        difference = (int(match[1], 16) - address) & 0xFFFFFFFF
        return str(difference - (1 << 32) if difference >> 31 else difference)
    return TARGET.sub(distance, text)


def disassemble(bin_directory, path, words, options):
    texts = []
    for line in run(os.path.join(bin_directory, "trax-objdump"), "-d", *options, path).splitlines():
        match = LINE.match(line)
        if not match:
            continue
        address, word = int(match[1], 16), int(match[2], 16)
        if address != 4 * len(texts) or address // 4 >= len(words) or word != words[address // 4]:
            raise Failure(f"trax-objdump prints another word: {line}")
        texts.append(as_distance(match[3], address))
    if len(texts) != len(words):
        raise Failure(f"trax-objdump prints {len(texts)} of {len(words)} instructions")
    return texts


def compare(words, again, texts):
    """Prints the first few differences and returns how many there are."""
    if len(again) != len(words):
        raise Failure(f"{len(words)} words became {len(again)}")
    differences = [i for i in range(len(words)) if words[i] != again[i]] if words != again else []
    for i in differences[:20]:
        print(f"0x{words[i]:08x} is disassembled as '{texts[i]}' and assembled as 0x{again[i]:08x}")
    return len(differences)


def round_trip(options, directory, words):
    source, first, second = (os.path.join(directory, name) for name in ("words.s", "first.o", "second.o"))
    with open(source, "w", encoding="ascii") as file:
        file.write("\n".join(f".word {word}" for word in words) + "\n")
    run(os.path.join(options.bin, "trax-mc"), "-filetype=obj", "-o", first, source)
    if text_section(first) != words:
        raise Failure(f"{first}: other words than were assembled")
    different = 0
    for aliases in ([], ["--no-aliases"]):
        texts = disassemble(options.bin, first, words, aliases)
        with open(source, "w", encoding="ascii") as file:
            file.write("\n".join(texts) + "\n")
        run(os.path.join(options.bin, "clang"), "--target=trax", "-c", source, "-o", second)
        different += compare(words, text_section(second), texts)
    return different


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("--bin", required=True, help="directory of the project's programs")
    parser.add_argument("--count", type=int, default=300, help="random programs")
    parser.add_argument("--seed", type=int, default=1, help="of the first")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as directory:
        path = os.path.join(directory, "words")
        run(os.path.join(options.bin, "../tests/bin/isa-differential"), "--seed", str(options.seed), "--count",
            str(options.count),
            "--words", path)
        all_words = read_words(path)
        words = array.array("I", dict.fromkeys(all_words))
        different, progress = 0, Progress(len(words))
        for begin in range(0, len(words), CHUNK):
            different += round_trip(options, directory, words[begin:begin + CHUNK])
            progress.show(min(begin + CHUNK, len(words)), "words")
        progress.clear()
    print(f"{len(all_words)} words of {options.count} programs and all formats, {len(words)} of them different, "
          f"disassembled with and without aliases and assembled again: {different} differences")
    return different != 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except Failure as failure:
        sys.exit(f"reassemble.py: {failure}")
