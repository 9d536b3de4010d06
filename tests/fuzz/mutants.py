#!/usr/bin/env python3
"""Breaks the compiler's pass over outer loops (llvm-target/TraxLoops.cpp), one line at a time: does loops.py notice
on the seeds of its test?

    mutants.py [SCRATCH] [--build build] [--only EXPRESSION]
    mutants.py --stale             only lists texts that are not there
"""

import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from mutation import ROOT, Mutant, command, main  # noqa: E402

SOURCE = ROOT / "llvm-target"
SEEDS = "1-2"

# Name, text, what it becomes. Nothing is wrong without "Distance->getLoop() != &L": stores of a loop within or around L
# move away, too.
MUTANTS = [
    ("offset", "Offset->isZero() ? &Phi : Builder.CreatePtrAdd(&Phi, Offset->getValue())", "&Phi"),
    ("step", "Builder.CreatePtrAdd(Phi, Step->getValue())", "Builder.CreatePtrAdd(Phi, Builder.getInt32(4))"),
    ("start", "Value *Start = expand(Recurrence->getStart(),",
     "Value *Start = expand(Recurrence->getPostIncExpr(*SE),"),
    ("end", "Value *NextEnd = Builder.CreateAdd(End, Step);", "Value *NextEnd = End;"),
    ("end-invariant", "!Counter->getType()->isIntegerTy(32) || !L.isLoopInvariant(End))",
     "!Counter->getType()->isIntegerTy(32))"),
    ("first", "First.sge(DL.getTypeStoreSize(Load.getType()).getFixedValue())", "First.sge(-400)"),
    ("direction", "return Further.isNonNegative() ?", "return Further.isNonPositive() ?"),
    ("aliases", "return AA->isNoAlias(MemoryLocation::get(Store), MemoryLocation::get(Load)) || ", "return Store || "),
    ("calls", "else if (I.mayWriteToMemory() || I.mayThrow())", "else if (I.mayThrow())")]


def compiler(folder, build, text):
    """A folder like that of the build, with a clang of this text; None if it cannot be compiled."""
    changed, made = folder / "TraxLoops.cpp", folder / "TraxLoops.o"
    changed.write_text(text)
    unity = next((build / "llvm-target/CMakeFiles/LLVMTrax.dir/Unity").glob("*.cxx"))
    words = command(build, str(unity.relative_to(build)) + ".o")
    words[words.index(str(unity))] = changed
    words[words.index("-MF") + 1] = "/dev/null"
    words[words.index("-o") + 1] = made
    if subprocess.run([*words, f"-I{SOURCE}", "-w"], cwd=build, check=False).returncode:
        return None
    (folder / "bin").mkdir(exist_ok=True)
    for file in (build / "bin").iterdir():
        if file.name != "clang" and not (folder / "bin" / file.name).exists():
            (folder / "bin" / file.name).symlink_to(file)
    if not (folder / "lib").exists():
        (folder / "lib").symlink_to(build / "lib")
    words = command(build, "bin/clang")
    words[words.index("-o") + 1] = folder / "bin" / "clang"
    at = next(i for i, word in enumerate(words) if str(word).endswith(".a"))
    subprocess.run([*words[:at], made, "-Wl,--allow-multiple-definition", *words[at:]], cwd=build, check=True)
    return folder


def noticed(folder, build, mutant):
    if not compiler(folder, build, mutant.changed(SOURCE)):
        return ["does not compile"] if mutant.text == mutant.other else sys.exit(f"does not compile: {mutant}")
    done = subprocess.run([sys.executable, HERE / "loops.py", "--build", folder, "--work", folder / "work", "--seeds",
                           SEEDS, "--rounds", "1"], capture_output=True, text=True, check=False)
    return [f"loops.py {SEEDS}"] if done.returncode else []


if __name__ == "__main__":
    sys.exit(main(__doc__, SOURCE, [Mutant("TraxLoops.cpp", text, other, name) for name, text, other in MUTANTS],
                  noticed))
