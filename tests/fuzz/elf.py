"""The parts of an object file that are loaded, to compare two objects that should be the same."""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import elf_files  # noqa: E402


def read(path):
    """{section name: (flags, alignment, bytes or size of zeros, relocations)} of the allocated sections of an
    object. Sections of one name, as COMDAT groups have them, are told apart by their order."""
    try:
        elf = elf_files.ElfFile(pathlib.Path(path).read_bytes())
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None
    sections = {}
    for number, section in enumerate(elf.sections):
        if not section.flags & elf_files.ALLOC:
            continue
        key = section.name
        while key in sections:
            key = f"{section.name} ({len(sections)})"
        content = section.size if section.kind == elf_files.NOBITS else elf.contents(section)
        sections[key] = (section.flags, section.alignment, content, list(elf.relocations(number)))
    return sections


def difference(one, other):
    """None, or how the objects of two paths differ."""
    first, second = read(one), read(other)
    if list(first) != list(second):
        return f"different sections: {' '.join(sorted(set(first) ^ set(second))) or 'another order'}"
    for name, section in first.items():
        for what, mine, theirs in zip(("flags", "alignment", "bytes", "relocations"), section, second[name]):
            if mine != theirs:
                return f"different {what} of section {name}"
    return None
