"""Programs that the tests share."""

import pathlib

import pytest

import trax

TRIPLE = """
#include <stdio.h>
#include <trax.h>
struct trax_buffer data;
unsigned counter;
int main(int count, char **words) {
  for (unsigned i; (i = trax_atomic_inc(&counter)) * 4 < data.size;)
    ((unsigned *)data.data)[i] *= 3;
  if (trax_thread() == 0)
    printf("%d %s\\n", count, count > 1 ? words[1] : "");
  return 0;
}
"""
LOOP = "int main(void) { for (volatile int i = 0;; i++) {} }"
FAULT = "int main(void) { return *(volatile int *)0x70000000; }"
ECHO = '#include <stdio.h>\nint main(void) { int c; while ((c = getchar()) != EOF) putchar(c + 1); return 3; }'


@pytest.fixture(scope="session")
def programs(tmp_path_factory):
    """name -> executable"""
    folder = tmp_path_factory.mktemp("programs")
    found = {}
    for name, text in {"triple": TRIPLE, "loop": LOOP, "fault": FAULT, "echo": ECHO}.items():
        source = pathlib.Path(folder, f"{name}.c")
        source.write_text(text)
        found[name] = trax.compile(source, output=folder / f"{name}.elf")
    return found


@pytest.fixture(scope="session")
def manifest(tmp_path_factory):
    """A small picture of the forest."""
    return trax.prepare("generate:forest", folder=tmp_path_factory.mktemp("forest") / "run", size=(48, 27))
