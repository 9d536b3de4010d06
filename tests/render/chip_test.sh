#!/bin/sh
# chip_test.sh BIN: the program and the order of nodes follow the caches of the chip that is asked for. The paper's caches
# are the default.
. "$(dirname "$0")/head.sh"
set -e
export LC_ALL=C

# A bumpy ground of 3,200 triangles.
awk 'BEGIN {
  for (y = 0; y <= 40; y++) for (x = 0; x <= 40; x++) print "v", x, (x * 7 + y * 5) % 11 / 4, y
  for (y = 0; y < 40; y++) for (x = 1; x <= 40; x++) { a = y * 41 + x; print "f", a, a + 41, a + 42, a + 1 }
}' >ground.obj

# code.py FILE: the bytes of its executable sections.
cat >code.py <<'END'
import struct, sys
elf = open(sys.argv[1], "rb").read()
at, size, count = struct.unpack_from("<I", elf, 32)[0], *struct.unpack_from("<HH", elf, 46)
for section in range(count):
    _, kind, flags, _, offset, length = struct.unpack_from("<6I", elf, at + section * size)
    sys.stdout.buffer.write(elf[offset:offset + length] if kind == 1 and flags & 4 else b"")
END

# moved.py A B: whether two scenes are the same but for their place in memory, which follows the program's end.
cat >moved.py <<'END'
import array, sys
a, b = (array.array("I", open(path, "rb").read()) for path in sys.argv[1:])
sys.exit(len(a) != len(b) or len({(y - x) & 0xFFFFFFFF for x, y in zip(a, b)} - {0}) > 1)
END

# kept NAME OPTIONS...: the inputs of a run in NAME, with the program's code alone in NAME/code.
kept() {
  name=$1
  shift
  "$bin/trax-render" ground.obj --size 16x9 --smooth --config 1x32 "$@" --keep "$name" -o x.png -q 2>err || fail "$name: $(cat err)"
  python3 code.py "$name/program.elf" >"$name/code"
}
kept plain
kept same --set icache.bytes=4096 --set dcache.bytes=16384
kept small --set icache.bytes=1024
kept ordered --set dcache.bytes=1024
cmp -s plain/code same/code || fail "the paper's instruction cache makes another program"
cmp -s plain/scene.trax same/scene.trax || fail "the paper's data cache makes another scene"
[ "$(stat -c %s small/code)" -lt "$(stat -c %s plain/code)" ] || fail "a small instruction cache does not make a smaller program"
python3 moved.py plain/scene.trax small/scene.trax || fail "a small instruction cache makes another scene"
cmp -s plain/code ordered/code || fail "a small data cache makes another program"
python3 moved.py plain/scene.trax ordered/scene.trax && fail "a small data cache does not make another order of nodes"
"$bin/trax-render" ground.obj --size 16x9 --config 1x32 --set dcache.bytes=1024 --compare -o y.png -q 2>err >out || fail "another order of nodes: $(cat err out)"
exit $((failures > 0))
