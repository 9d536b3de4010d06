"""Further checks of a sample of Csmith's programs, beside the output at each level.

Each check gets the target, the program, a directory and a limit of cycles; it raises Failure, and may return a run
whose output must be the program's.
"""

import json

import elf
from toolchain import Failure, run


def build_and_run(target, program, directory, name, flags, max_cycles):
    compiled, image = directory / f"{name}.o", directory / name
    target.compile([*flags, *program.flags, "-c", program.source, "-o", compiled], program.language)
    target.link([compiled], image)
    return target.simulate(image, max_cycles)


def smallest(target, program, directory, max_cycles):
    """-Oz."""
    return build_and_run(target, program, directory, "Oz", ["-Oz"], max_cycles)


def sanitized(target, program, directory, max_cycles):
    """Code that traps on undefined behaviour does not trap."""
    return build_and_run(target, program, directory, "sanitized",
                         ["-O1", "-fsanitize=undefined", "-fsanitize-trap=undefined"], max_cycles)


def few_sections(target, program, directory, max_cycles):
    """All code is in one section and nothing is dropped, instead of one section a function and dropped unused ones."""
    flags = ["-O2", "-fno-function-sections", "-fno-data-sections"]
    compiled, image = directory / "few.o", directory / "few"
    target.compile([*flags, *program.flags, "-c", program.source, "-o", compiled], program.language)
    target.link([compiled, "-Wl,--no-gc-sections"], image)
    return target.simulate(image, max_cycles)


def same_object(target, program, directory, name, one, other):
    """Two ways to compile, each a list of argument lists, give the same bytes and relocations."""
    objects = []
    for way, commands in (("first", one), ("second", other)):
        built = directory / f"{name}-{way}.o"
        for command in commands:
            result = target.compile([*command, "-o", built] if command is commands[-1] else command,
                                    "c" if "assembler" in command else program.language)
        objects.append(built)
    how = elf.difference(*objects)
    if how:
        raise Failure(f"{name}: {how} in {objects[0]} and {objects[1]}", result.command)


def debug_information(target, program, directory, max_cycles):
    """The debug information is well-formed, and the program with it runs alike."""
    result = build_and_run(target, program, directory, "debug", ["-O2", "-g"], max_cycles)
    verified = run(["llvm-dwarfdump-19", "--verify", "--quiet", directory / "debug"])
    if verified.status != 0:
        raise Failure(f"debug: llvm-dwarfdump {verified.reason()}", verified.command)
    return result


def assembler(target, program, directory, _):
    """The compiler's assembly language assembles to the compiler's object."""
    for level in ("-O0", "-O2"):
        text = directory / f"program{level}.s"
        same_object(target, program, directory, f"assembler{level}",
                    [[level, *program.flags, "-c", program.source]],
                    [[level, *program.flags, "-S", program.source, "-o", text], ["-x", "assembler", "-c", text]])


def engines(target, program, directory, max_cycles):
    """Both engines count the same, cycle by cycle."""
    compiled, image = directory / "engines.o", directory / "engines"
    target.compile(["-O2", *program.flags, "-c", program.source, "-o", compiled], program.language)
    target.link([compiled], image)
    counted = []
    for engine in ("reference", "fast"):
        statistics = directory / f"{engine}.json"
        result = target.simulate(image, max_cycles, engine, ["--stats", statistics])
        figures = json.loads(statistics.read_text())
        for key in ("host_seconds", "instructions_per_host_second"):
            del figures[key]
        counted.append(figures)
    if counted[0] != counted[1]:
        names = [key for key in counted[0] if counted[0][key] != counted[1].get(key)]
        raise Failure(f"engines: different statistics: {' '.join(names[:5])}", result.command)
    return result


CHECKS = {
    "-Oz": smallest,
    "sanitized": sanitized,
    "few sections": few_sections,
    "debug": debug_information,
    "assembler": assembler,
    "engines": engines,
}
