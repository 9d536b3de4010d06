"""What is damaged, how, and by which commands it is read."""
import mutate

# Commands: {x} is the damaged file, {d} the folder of good ones, {o} an output.
SIM = ["trax-sim", "--quiet", "--max-cycles", "20000", "--alloc", "image=64"]
CHIP = [*SIM, "--config", "1x32"]
RENDER = ["trax-render", "-q", "--engine", "native", "--size", "5x3", "-o", "{o}.png"]
CLANG = ["clang", "--target=trax", "-c", "-o", "{o}"]


def each(before, *endings):
    """Commands that begin alike."""
    return [[*before, *ending] for ending in endings]


# Each kind: the whole form's cases, the input, how it is damaged, and the commands, of which each case takes one.
KINDS = {
    "image-run": (
        1017,
        ["program.elf"],
        mutate.of_elf,
        [
            [*SIM, "--engine", engine, *options, "{x}"]
            for engine in ("fast", "functional", "reference")
            for options in ([], ["--main-on", "0"], ["--config", "1x32", "--report", "{o}"])
        ],
    ),
    "image-explain": (
        500,
        ["program.elf"],
        mutate.of_elf,
        each(
            CHIP,
            ["--profile", "{o}", "{x}"],
            ["--explore", "{o}.html", "{x}"],
            ["--heat", "{o}", "{x}"],
            ["--post-mortem", "{o}", "--trace", "{o}2", "--window", "0:300", "{x}"],
            ["--profile-sample", "{o}", "{x}"],
        ),
    ),
    "image-list": (
        1017,
        ["program.elf", "object.o", "archive.a"],
        mutate.of_elf,
        each(["trax-objdump"], ["-d", "-S", "-l", "{x}"], ["-x", "{x}"], ["-D", "-r", "-t", "{x}"], ["{x}"]),
    ),
    "object-link": (
        1017,
        ["object.o"],
        mutate.of_elf,
        each(
            ["trax-ld", "{x}", "-o", "{o}"],
            ["-e", "entry"],
            ["--gc-sections", "-e", "main", "-Map={o}.map"],
            ["--print-stack", "-e", "main"],
        ),
    ),
    "archive-link": (
        1017,
        ["archive.a"],
        mutate.of_bytes,
        each(["trax-ld", "-e", "main", "-o", "{o}"], ["--whole-archive", "{x}"], ["-u", "main", "{x}"]),
    ),
    "checkpoint": (1000, ["run.checkpoint"], mutate.of_checkpoint, [[*CHIP, "--resume", "{x}", "{d}/program.elf"]]),
    "configuration": (300, ["machine.cfg"], mutate.of_text, [["trax-sim", "--config", "{x}", "--print-config"]]),
    "tree": (
        446,
        ["tree.npy"],
        mutate.of_bytes,
        [["trax-scene", "{d}/mesh.ply", "-q", "--tree", "{x}", "--tree-triangles", "{d}/order.npy", "-o", "{o}"]],
    ),
    "mesh": (
        700,
        ["mesh.obj", "mesh.ply", "mesh.mtl"],
        mutate.of_text,
        each(["trax-scene", "{obj}", "-q", "-o", "{o}"], [], ["--smooth"]),
    ),
    "mesh-binary": (
        300,
        ["binary.ply", "mesh.glb", "mesh.obj"],
        mutate.of_bytes,
        [["trax-scene", "{x}", "-q", "-o", "{o}"]],
    ),
    "gltf": (300, ["mesh.gltf"], mutate.of_json, [["trax-scene", "{x}", "-q", "-o", "{o}"]]),
    "texture": (150, ["texture.png"], mutate.of_bytes, [["trax-scene", "{obj}", "-q", "-o", "{o}"]]),
    "scene": (
        300,
        ["scene.trax", "quantised.trax"],
        mutate.of_bytes,
        [["trax-scene", "--check", "{x}"], [*RENDER, "{x}"]],
    ),
    "view": (300, ["mesh.view"], mutate.of_text, [[*RENDER, "{d}/scene.trax", "--view", "{x}"]]),
    "picture": (
        200,
        ["picture.png", "picture.exr", "picture.pfm"],
        mutate.of_bytes,
        each(["trax-compare"], ["{d}/picture.png", "{x}"], ["{x}", "{d}/picture.pfm"]),
    ),
    "assembler": (400, ["text.s"], mutate.of_text, [["trax-mc", "{x}", "-o", "{o}"], [*CLANG, "{x}"]]),
    "bitcode": (980, ["program.bc"], mutate.of_bytes, [[*CLANG, "-O1", "-x", "ir", "{x}"]]),
    "profile": (66, ["program.prof"], mutate.of_text, [[*CLANG, "-O2", "-fprofile-sample-use={x}", "{d}/program.c"]]),
    "sweep": (224, ["sweep.json"], mutate.of_json, [["trax-eval", "{x}", "--dry-run", "-o", "{o}.d"]]),
    "calls": (160, [], None, []),
    "environment": (300, [], None, []),
}
OWN_STATUS = {"image-run", "image-explain", "checkpoint"}  # the status may be that of the program on the TPs
SAME_NAME = {"mesh", "texture", "sweep", "gltf"}  # the damaged file stands beside the files that it names
