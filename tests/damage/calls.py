"""Host calls by chance: any numbers, paths, descriptors, addresses and sizes, some of the blocks themselves where no
memory is. The run ends by itself, or by its limit if a call has overwritten the program's own counter, and nothing
outside the folder that it was given is read or written."""
import os
import pathlib
import random
import tempfile

from runs import CRASHED, run, with_message

CALLS = 3600  # of a case; the engines that count cycles make a tenth
LIMIT = 30_000_000  # instructions or cycles, some ten times what they take
SECRET = b"SECRET of the host"

PROGRAM = r"""
#define _GNU_SOURCE
#include <stdlib.h>
#include <string.h>

static const char *const paths[] = {
    "d", "d/", "d/a", "d/b", "d/sub", "d/sub/c", "d/new", "d/link", "d/away", "d/away/secret", "d/away/new",
    "d/up/secret", "d/pipe", "d//a", "d/./a", "d/../outside/secret", "d/sub/../../outside/secret",
    "d/sub/../../../outside/new", "..", ".", "", "/", "/etc/passwd", "outside/secret", "../outside/secret",
    "/proc/self/mem", "/dev/null", "D/a", "d/\xff", "d/a/b", "d\n/a"};
static char space[1 << 16];
static char name[5000];
static unsigned state;

static unsigned any(unsigned below) {
  state ^= state << 13, state ^= state >> 17, state ^= state << 5;
  return state % below;
}

static unsigned address(void) {
  static const unsigned odd[] = {0,          4,          0xFFC,      0x1000,     0x1001,     0x7FFFFFFC,
                                 0xFFFFF000, 0xFFFFFFFC, 0xFFFFFFFF, 0x3FFFFFFC, 0x40000000, 0x3FFFFFF0};
  const unsigned kind = any(20);
  return kind < 15   ? (unsigned)(size_t)space + any(sizeof space)
         : kind < 18 ? odd[any(sizeof odd / sizeof *odd)]
         : kind < 19 ? (unsigned)(size_t)&paths + any(64)
                     : any(0xFFFFFFFF);
}

static unsigned path(void) {
  const unsigned kind = any(24);
  if (kind == 0)
    return address();
  if (kind == 1) {
    memset(name, 'a', sizeof name - 1);
    memcpy(name, "d/", 2);
    name[any(sizeof name)] = any(2) ? '/' : 0;
    return (unsigned)(size_t)name;
  }
  return (unsigned)(size_t)paths[any(sizeof paths / sizeof *paths)];
}

static unsigned size(void) {
  static const unsigned sizes[] = {0, 1, 100, 4096, 40000, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF};
  return sizes[any(sizeof sizes / sizeof *sizes)];
}

static unsigned descriptor(void) {
  return any(12) ? any(8) : any(2) ? any(400) : any(0xFFFFFFFF);
}

static unsigned offset(void) {
  static const long long offsets[] = {
      0, 1, -1, 5000, 1ll << 32, 1ll << 62, -0x7FFFFFFFFFFFFFFF - 1, 0x7FFFFFFFFFFFFFFF};
  memcpy(space, &offsets[any(sizeof offsets / sizeof *offsets)], 8);
  return any(10) ? (unsigned)(size_t)space : address();
}

int main(int word_count, char **words) {
  (void)word_count;
  static const unsigned blocks[] = {0,          4,          0x1000,     0x1002,     0xFFFFFFE8,
                                    0xFFFFFFF0, 0xFFFFFFFC, 0x40000000, 0x3FFFFFEC, 0x3FFFFFF0};
  state = (unsigned)atoi(words[1]) * 2654435761u + 1;
  for (int i = atoi(words[2]); i > 0; i--) {
    unsigned block[6], at = (unsigned)(size_t)block;
    const unsigned number = any(30) ? 1 + any(15) : any(0xFFFFFFFF);
    if (number >= 10 && number <= 13 && any(12))
      continue; /* few of those that take names away */
    const int named = number == 1 || number == 6 || (number >= 10 && number != 15);
    block[0] = number;
    block[1] = named ? path() : descriptor();
    block[2] = number == 1    ? (any(5) ? any(3) | 0x200 * any(2) | 0x400 * any(2) | 8 * any(2) | 0x800 * !any(5)
                                        : any(0xFFFFFFFF))
               : number == 11 ? path()
               : number == 15 ? descriptor()
               : number == 5 || number == 8 ? offset()
                                            : address();
    block[3] = number == 5 ? any(4) : size();
    block[4] = any(0xFFFFFFFF), block[5] = size();
    if ((number == 4 || number == 15) && block[1] <= 2)
      continue; /* so many messages */
    if (!any(40000))
      at = blocks[any(sizeof blocks / sizeof *blocks)];
    __asm__ volatile("trap %0, host" : : "r"(at) : "memory");
    const unsigned place = block[2] - (unsigned)(size_t)space;
    if (number == 3 && (int)block[0] > 0 && place < sizeof space - 64 && memmem(space + place, 64, "ECRET", 5))
      exit(99);
    if (number == 14 && (int)block[0] > 0 && place < sizeof space - 64 && memmem(space + place, 64, "secret", 6))
      exit(99);
  }
  return 0;
}
"""


def listing(folder):
    """What is there, but not the contents of pipes."""
    return {str(path): path.read_bytes() if path.is_file() and not path.is_symlink() else path.lstat().st_mode
            for path in folder.rglob("*")}


def calls(binaries, good, number, seed):
    rng = random.Random(f"{seed} calls {number}")
    folder = pathlib.Path(tempfile.mkdtemp(prefix=f"calls-{number}-"))
    inside, outside = folder / "in", folder / "outside"
    (inside / "sub").mkdir(parents=True)
    outside.mkdir()
    (outside / "secret").write_bytes(200 * SECRET)
    for name, size in (("a", 5000), ("b", 0), ("sub/c", 100)):
        (inside / name).write_bytes(bytes(size))
    (inside / "link").symlink_to("../outside/secret")
    (inside / "away").symlink_to("../outside")
    (inside / "up").symlink_to("../outside", target_is_directory=True)
    os.mkfifo(inside / "pipe")
    before = listing(outside)
    engine = rng.choice(("functional", "functional", "functional", "fast", "reference"))
    count = CALLS if engine == "functional" else CALLS // 10
    command = ["trax-sim", "--quiet", "--engine", engine, "--config", "1x32", "--main-on", "0",
               "--max-cycles", str(LIMIT), "--dir", f"{inside}::d"]
    command += [str(good / "calls.elf"), str(rng.getrandbits(31)), str(count)]
    result = run(binaries, command, folder)
    fault = None
    silent = result.returncode == 1 and not result.stderr
    if result.returncode not in (0, 1, 124) or CRASHED.search(result.stderr) or silent:
        fault = with_message(f"status {result.returncode}", result)
    elif listing(outside) != before or {path.name for path in folder.iterdir()} != {"in", "outside"}:
        fault = with_message("something outside was written", result)
    return fault, folder, command, result.returncode
