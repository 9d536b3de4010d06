#!/bin/sh
# Pictures by the emulated machine: the same bits as the native twin's, and close to Embree's, on several chips.
# Usage: emulator_test.sh BIN SOURCE [CASE...]
set -u
bin=$1
source=$2
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
failures=0
bunny=/usr/share/glmark2/models/bunny.obj

fail() {
  echo "FAILED: $*"
  failures=$((failures + 1))
}

# same ARGUMENTS...: --compare finds nothing; what it printed stays in .out.
same() {
  "$bin/trax-render" "$@" -o x.png --compare >.out 2>.err || fail "$*: status $?: $(cat .out .err)"
  grep -q '^twin        identical in every bit$' .out || fail "$*: $(cat .out)"
}

view="--view $source/box.view"
same "$source/box.obj" $view --size 64x36 --stats a.json
cp x.png box.png
grep -q '"rays": [1-9]' a.json || fail "no rays counted"
grep -q '"items": 2304' a.json || fail "not every pixel counted"
# The program fits in the instruction cache: what is fetched is once 4 kB at most for each of the 8 caches.
fetched=$(sed -n 's/.*"instruction_read_bytes": \([0-9]*\).*/\1/p' a.json | head -n 1)
[ "${fetched:-0}" -gt 0 ] && [ "$fetched" -le 32768 ] || fail "$fetched bytes of instructions fetched"
for chip in 1x32 2x64; do # the same picture on any chip
  same "$source/box.obj" $view --size 64x36 --config $chip
  "$bin/trax-compare" -q x.png box.png || fail "$chip renders another picture"
done
same "$source/box.obj" $view --size 64x36 --config 1x32 --set memory.latency_cycles=7 --set dcache.bytes=1024
"$bin/trax-compare" -q x.png box.png || fail "timing changes the picture"
same "$source/box.obj" --size 1x1 # one pixel, 128 threads
same "$source/box.obj" $view --size 1x61
same "$source/box.obj" $view --size 61x1
[ -r $bunny ] && same $bunny --view bunny --size 64x36

# A less precise divider changes the picture: --compare tells.
"$bin/trax-render" "$source/box.obj" $view --size 64x36 --config 1x32 --set special.precision_bits=8 -o x.png --compare \
  >.out 2>.err && fail "8 bits of precision go unnoticed"
grep -q 'pixels differ' .out || fail "8 bits: $(cat .out .err)"

# The machine's statistics do not depend on what the host does.
same "$source/box.obj" $view --size 64x36 --stats b.json
for name in cycles instructions; do
  [ "$(grep -m1 "\"$name\"" a.json)" = "$(grep -m1 "\"$name\"" b.json)" ] || fail "$name differ between two runs"
done

# The reference engine: the same picture and the same statistics, all of them.
same "$source/box.obj" $view --size 64x36 --engine reference --stats reference.json
"$bin/trax-compare" -q x.png box.png || fail "the reference engine renders another picture"
for file in a reference; do grep -v host_second $file.json >$file.figures; done
cmp -s a.figures reference.figures || fail "the reference engine's statistics differ: $(diff a.figures reference.figures | head -n 4)"

# What a pixel cost: with what belongs to no pixel, that is all there is; the same from both engines, in both formats.
thread_cycles=$(sed -n 's/^  "thread_cycles": \([0-9]*\).*/\1/p' a.json)
instructions=$(sed -n 's/^  "instructions": \([0-9]*\).*/\1/p' a.json)
for engine in fast reference; do
  for what in cycles instructions wait_memory; do
    "$bin/trax-render" "$source/box.obj" $view --size 64x36 --engine $engine -o x.png --cost $what \
      --cost-picture $engine-$what.png --cost-values $engine-$what.csv --profile $engine.profile \
      --profile-folded $engine.folded >.out 2>.err || fail "--cost $what: $(cat .err)"
    elsewhere=$(sed -n 's/^cost .* and \([0-9]*\) for no pixel$/\1/p' .out)
    sum=$(awk -F, 'NR > 1 { sum += $3 } END { printf "%d", sum }' $engine-$what.csv)
    grep -q " of a pixel: .* sum $sum, and" .out || fail "--cost-values sums to $sum, not: $(cat .out)"
    echo "$((sum + elsewhere))" >$engine-$what.total
    [ "$(wc -l <$engine-$what.csv)" -eq 2305 ] || fail "not every pixel has a value"
    "$bin/trax-compare" -q x.png box.png || fail "the picture changes when it is explained"
  done
done
[ "$(cat fast-cycles.total)" -eq "$thread_cycles" ] || fail "cost $(cat fast-cycles.total), not $thread_cycles thread-cycles"
[ "$(cat fast-instructions.total)" -eq "$instructions" ] || fail "cost $(cat fast-instructions.total), not $instructions instructions"
grep -q "^ *$thread_cycles 100.00 100.00 *$instructions .* total$" fast.profile || fail "the profile's total"
[ "$(awk '{ sum += $NF } END { printf "%d", sum }' fast.folded)" -eq "$thread_cycles" ] || fail "the folded profile's total"
for what in -cycles.png -cycles.csv -instructions.csv -wait_memory.png .profile .folded; do
  cmp -s fast$what reference$what || fail "the engines differ in $what"
done
"$bin/trax-render" "$source/box.obj" $view --size 64x36 -o x.png --cost-values x.pfm >.out 2>.err || fail "$(cat .err)"
tail -c 9216 x.pfm | od -An -v -tf4 -w256 | tac | tr -s ' ' '\n' | grep . | awk '{ printf "%.0f\n", $1 }' >pfm.values
sed 1d fast-cycles.csv | cut -d, -f3 | awk '{ printf "%.0f\n", $1 }' | cmp -s - pfm.values || fail "PFM and CSV differ"
head -n 2 x.pfm | tr '\n' ' ' | grep -qx 'Pf 64 36 ' || fail "x.pfm begins with $(head -n 2 x.pfm)"

# What --keep writes runs by itself to the same picture.
same "$source/box.obj" $view --size 16x9 --config 1x32 --keep kept
TRAX_SIM=$bin/trax-sim sh kept/run.sh >.out 2>.err || fail "run.sh: $(cat .err)"
[ "$(wc -c <kept/image.raw)" -eq 576 ] || fail "image.raw has $(wc -c <kept/image.raw) bytes"

# Faults and wrong programs end in an error, without a picture.
refuse() {
  pattern=$1
  shift
  rm -f x.png
  "$bin/trax-render" "$@" -o x.png >.out 2>.err && fail "$*: no error"
  grep -q -- "$pattern" .err || fail "$*: '$(cat .err)' does not match '$pattern'"
  [ -e x.png ] && fail "$*: left a picture"
}
refuse 'missing.elf' "$source/box.obj" --program missing.elf
refuse 'box.obj' "$source/box.obj" --program "$source/box.obj"
refuse 'memory' "$source/box.obj" --set memory.size_mib=1 --size 1000x1000
refuse 'no.such' "$source/box.obj" --set no.such=1
refuse 'no-such-chip' "$source/box.obj" --config no-such-chip

[ $failures -eq 0 ] && echo "all pictures as expected"
exit $((failures > 0))
