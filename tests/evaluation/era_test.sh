#!/bin/sh
# The era program: its pictures beside Embree's (its epsilon costs it pixels at edges), its size, what it refuses.
# Usage: era_test.sh BIN SOURCE; BIN has the programs, SOURCE is tests/render.
set -u
bin=$1
source=$2
era=$bin/../lib/trax/trax-era.elf
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
failures=0
fail() {
  echo "FAILED: $*"
  failures=$((failures + 1))
}

picture() {
  "$bin/trax-render" "$@" --engine embree -q -o reference.png || fail "$*: no reference"
  "$bin/trax-render" "$@" --program "$era" -q --config 2x32 --stats stats.json -o picture.png --keep kept || fail "$*: no picture"
  "$bin/trax-compare" picture.png reference.png --within 2 --at-least 99 >differences || fail "$*: $(cat differences)"
}
picture "$source/box.obj" --view "$source/box.view" --size 64x36
picture /usr/share/glmark2/models/bunny.obj --view bunny --size 96x54
grep -q '"items": 5184' stats.json || fail "not every pixel was counted once"
# The files of --keep run to the same picture, which no machine changes.
"$bin/trax-sim" kept/manifest.json --quiet || fail "the manifest"
cp kept/image.raw whole.raw
"$bin/trax-sim" kept/manifest.json --config 1x48 --set fpu.compare_units=true --quiet || fail "the manifest on another machine"
cmp -s kept/image.raw whole.raw || fail "the picture depends on the machine"

# Within the instruction cache, as the paper's must be: only cold misses.
misses=$(sed -n '/^  "icache": {/,/}/s/.*"misses": \([0-9]*\).*/\1/p' stats.json)
[ "$misses" -le 256 ] || fail "$misses misses of instructions in 4 caches of 64 lines"

for option in --smooth --no-shadows '--samples 4'; do
  "$bin/trax-render" "$source/box.obj" --program "$era" --size 8x8 --config 1x32 $option -q -o wrong.png 2>error && fail "$option: no error"
  grep -q "paper's workload only" error || fail "$option: $(cat error)"
done
# Boxes on a grid are a little larger, and hide nothing.
picture "$source/box.obj" --view "$source/box.view" --size 64x36 --nodes quantised
# A scene of one triangle has a leaf for its root.
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >one.obj
picture one.obj --size 32x32
[ $failures -eq 0 ]
