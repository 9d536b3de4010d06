#!/bin/sh
# Pictures by the emulated machine: the same bits as the native twin's, and close to Embree's, on several chips.
# Usage: emulator_test.sh BIN, the folder of the programs
. "$(dirname "$0")/head.sh"
bunny=/usr/share/glmark2/models/bunny.obj

# same ARGUMENTS...: --compare finds nothing; what it printed stays in .out.
same() {
  "$bin/trax-render" "$@" -o x.png --compare >.out 2>.err || fail "$*: status $?: $(cat .out .err)"
  grep -q '^twin        identical in every bit$' .out || fail "$*: $(cat .out)"
}

# again NAME ARGUMENTS...: the picture of the box as before, which was compared then.
again() {
  reason=$1
  shift
  "$bin/trax-render" "$source/box.obj" $view --size 64x36 -o x.png "$@" >.out 2>.err || fail "$reason: status $?: $(cat .out .err)"
  "$bin/trax-compare" -q x.png box.png || fail "$reason: another picture"
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
  again "$chip" --config $chip
done
again "other times" --config 1x32 --set memory.latency_cycles=7 --set dcache.bytes=1024
# Queues of pixels, as many as TMs, one, and more: every pixel once.
for queues in 1 64 tms; do
  again "--queues $queues" --config 6x32 --queues $queues --stats queues$queues.json
  grep -q '"items": 2304' queues$queues.json || fail "--queues $queues: not every pixel counted"
done
bytes() { sed -n 's/^ *"data_read_bytes": \([0-9]*\),*$/\1/p' "$1" | head -n 1; }
if [ -r $bunny ]; then
  "$bin/trax-scene" -q $bunny -o bunny.trax || fail "trax-scene"
  bunny=bunny.trax
  for queues in 1 tms; do
    "$bin/trax-render" $bunny --view bunny --size 160x90 --config 8x32 --queues $queues -o x.png -q --stats bunny$queues.json || fail "bunny"
  done
  [ "$(bytes bunnytms.json)" -lt "$(bytes bunny1.json)" ] || fail "--queues tms: no fewer bytes: $(bytes bunnytms.json)"
fi
same "$source/box.obj" --size 1x1 # one pixel, 128 threads
same "$source/box.obj" $view --size 1x61
same "$source/box.obj" $view --size 61x1

# A less precise divider changes the picture: --compare tells.
"$bin/trax-render" "$source/box.obj" $view --size 64x36 --config 1x32 --set special.precision_bits=8 -o x.png --compare \
  >.out 2>.err && fail "8 bits of precision go unnoticed"
grep -q 'pixels differ' .out || fail "8 bits: $(cat .out .err)"

# The machine's statistics do not depend on what the host does.
again "again" --stats b.json
for name in cycles instructions; do
  [ "$(grep -m1 "\"$name\"" a.json)" = "$(grep -m1 "\"$name\"" b.json)" ] || fail "$name differ between two runs"
done

# Costs of pixels, with the rest that belongs to none, add up to the run; both engines and both formats have the same.
thread_cycles=$(sed -n 's/^  "thread_cycles": \([0-9]*\).*/\1/p' a.json)
instructions=$(sed -n 's/^  "instructions": \([0-9]*\).*/\1/p' a.json)
for engine in fast reference; do
  for what in cycles $([ $engine = fast ] && echo instructions wait_memory); do # the pages have every cause from both
    again "--cost $what" --engine $engine --cost $what --cost-picture $engine-$what.png --cost-values $engine-$what.csv \
      $([ $what = cycles ] && echo --explore $engine.html --stats $engine.json)
    elsewhere=$(sed -n 's/^cost .* and \([0-9]*\) for no pixel$/\1/p' .out)
    sum=$(awk -F, 'NR > 1 { sum += $3 } END { printf "%d", sum }' $engine-$what.csv)
    grep -q " of a pixel: .* sum $sum, and" .out || fail "--cost-values sums to $sum, not: $(cat .out)"
    echo "$((sum + elsewhere))" >$engine-$what.total
    [ "$(wc -l <$engine-$what.csv)" -eq 2305 ] || fail "not every pixel has a value"
  done
done
# The same statistics from both engines, all of them, with what explains them and without.
for file in a fast reference; do
  grep -v host_second $file.json >$file.figures
  cmp -s a.figures $file.figures || fail "$file.json: statistics differ: $(diff a.figures $file.figures | head -n 4)"
done
[ "$(cat fast-cycles.total)" -eq "$thread_cycles" ] || fail "cost $(cat fast-cycles.total), not $thread_cycles thread-cycles"
[ "$(cat fast-instructions.total)" -eq "$instructions" ] || fail "cost $(cat fast-instructions.total), not $instructions instructions"
for what in -cycles.png -cycles.csv .html; do
  cmp -s fast$what reference$what || fail "the engines differ in $what"
done
again "--cost-values x.pfm" --cost-values x.pfm
tail -c 9216 x.pfm | od -An -v -tf4 -w256 | tac | tr -s ' ' '\n' | grep . | awk '{ printf "%.0f\n", $1 }' >pfm.values
sed 1d fast-cycles.csv | cut -d, -f3 | awk '{ printf "%.0f\n", $1 }' | cmp -s - pfm.values || fail "PFM and CSV differ"
head -n 2 x.pfm | tr '\n' ' ' | grep -qx 'Pf 64 36 ' || fail "x.pfm begins with $(head -n 2 x.pfm)"

# A program for one picture and the one for all: the same bits from both engines, and what is left out is out.
# both ARGUMENTS...: the same picture, with no more of the scene, and code that fits in the cache. What each reads stays in
# special and general.
code() { sed -n '/"code"/,/}/s/^ *"'"$1"'": \([0-9]*\).*/\1/p' special/manifest.json; }
scene_bytes() { wc -c <"$1/scene.trax"; }
has_features() { tr -d ' \n' <special/manifest.json | grep -q "\"features\":\[$1\]"; }
both() {
  same "$@" --keep special
  cp x.png special.png
  "$bin/trax-render" "$@" --no-specialise --keep general -o x.png >.out 2>.err || fail "$*: general: $(cat .err)"
  "$bin/trax-compare" -q x.png special.png || fail "$*: the general program's picture is another"
  [ "$(scene_bytes special)" -le "$(scene_bytes general)" ] || fail "$*: the specialised scene is larger"
  [ "$(code bytes)" -le "${code_bytes:-4096}" ] || fail "$*: $(code bytes) bytes are more than the instruction cache"
}
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >triangle.obj
both "$source/box.obj" $view --size 64x36
has_features '"shadows","materials"' || fail "box: $(cat special/manifest.json)"
both "$source/box.obj" $view --size 32x18 --engine reference --config 1x32
both "$source/box.obj" $view --size 40x30 --no-shadows
has_features '"materials"' || fail "box without shadows: $(cat special/manifest.json)"
both "$source/box.obj" $view --size 20x30 --samples 4 --no-shadows --ambient 0 --background 102030
both triangle.obj --size 30x20
"$bin/trax-scene" "$source/box.obj" --smooth -o smooth.trax || fail "trax-scene --smooth"
both smooth.trax $view --size 20x30 --smooth
has_features '.*"smooth"' || fail "smooth: $(cat special/manifest.json)"
with_normals=$(scene_bytes special)
both smooth.trax $view --size 20x30 # the normals are in the file and nothing reads them
[ "$(scene_bytes special)" -lt "$with_normals" ] || fail "normals that nothing reads are written"
both "$source/box.obj" --size 1x1 --samples 2 # more threads than pixels
[ -r $bunny ] && both $bunny --view bunny --size 64x36
# With a stack as deep as a scene may be, constants in registers would overflow it: the parameters stay in memory.
awk 'BEGIN { for (i = 0; i < 5000; i++) {
               x = 2 ^ (59 - 0.0358 * i); printf "v %.9g 0 0\nv 0 %.9g 0\nv 0 0 %.9g\nf -3 -2 -1\n", x, x, x } }' >deep.obj
code_bytes=6656 # sizes that binary32 cannot tell apart: hits are exact
"$bin/trax-scene" deep.obj -o deep.trax --stats | grep -q 'bvh.max_depth *32\>' || fail "deep.trax is not deep"
both deep.trax --size 16x9 --config 1x32
# Deeper than the TPs' own memory has room for: the stack is in global memory.
"$bin/trax-scene" deep.obj --depth 62 --passes 0 -o deeper.trax --stats | grep -q 'bvh.max_depth *5[0-9]\>' || fail "deeper.trax is not deeper"
both deeper.trax --size 16x9 --config 1x32
"$bin/trax-render" deeper.trax --size 16x9 --config 1x32 -o x.png --program "$bin/../lib/trax/trax-raytracer.elf" >.out 2>.err && fail "too deep for its stack"
grep -q "the scene is deeper than this program's stack" .err || fail "too deep for its stack: $(cat .err)"
code_bytes=4096
# A constant that the compiler folds differs from a less precise divider's result.
for how in '' --no-specialise; do
  "$bin/trax-render" triangle.obj --size 1x1 --config 1x32 --set special.precision_bits=8 $how -o "8$how.png" >.out 2>.err || fail "8 bits of precision: $(cat .err)"
done
"$bin/trax-compare" -q 8.png 8--no-specialise.png || fail "8 bits of precision: another picture"

# A source of one's own may have options for the compiler: here, to reorder.
cp -r "$bin/../lib/trax/raytracer" own-source
printf -- '-ffast-math\n  -funroll-loops ' >own-source/flags.txt
if [ -r $bunny ]; then
  for method in '' '--source own-source'; do
    "$bin/trax-render" $bunny --view bunny --size 48x27 --cache methods $method -o method.png --stats m.json \
      >.out 2>.err || fail "$method: $(cat .out .err)"
    grep -m1 '"cycles"' m.json
  done >methods.cycles
  [ "$(sort -u methods.cycles | wc -l)" -eq 2 ] || fail "flags.txt has no effect on time: $(cat methods.cycles)"
fi
for text in -fno-such-option "$(seq -s ' ' 33)" "$(seq -s '' 600)"; do
  echo "$text" >own-source/flags.txt
  "$bin/trax-render" "$source/box.obj" $view --size 16x9 --source own-source -o y.png >.out 2>.err && fail "flags.txt: $text"
  grep -q 'error: .*\(no-such-option\|flags.txt: too many options\|flags.txt: more than\)' .err || fail "flags.txt: $(cat .err)"
done

# An option of the picture makes another program; the same source makes the same one. cache_test.py has the rest.
cp -r "$bin/../lib/trax/raytracer" tiny
printf '#include <trax.h>\nstruct trax_buffer scene, image;\nint main(void) { return scene.size + image.size == 0; }\n' >tiny/main.c
tiny() { "$bin/trax-render" "$source/box.obj" $view --size 16x9 --config 1x32 --source tiny --cache cached -o x.png -q "$@" || fail "tiny $*"; }
programs() { find "$1" -name '*.elf' | wc -l; }
tiny
before=$(cat cached/*.elf | cksum)
rm cached/*.elf
tiny
[ "$(cat cached/*.elf | cksum)" = "$before" ] || fail "the same source gives another program"
tiny --background 000000
[ "$(programs cached)" -eq 2 ] || fail "another background: $(ls cached)"
unfinished=cached/0123456789abcdef0123456789abcdef.elf.
: >${unfinished}aaaaaa && touch -d '2020-01-01' ${unfinished}aaaaaa && : >${unfinished}bbbbbb
tiny --background 000001
[ ! -e ${unfinished}aaaaaa ] && [ -e ${unfinished}bbbbbb ] || fail "what was never finished: $(ls cached/*.elf.*)"

# Without a compiler, or a place for programs, the general program renders, and a line says why.
mkdir -p bare/bin bare/lib/trax
cp "$bin/trax-render" bare/bin && cp "$bin/../lib/trax/trax-raytracer.elf" bare/lib/trax
note() {
  pattern=$1
  shift
  "$@" "$source/box.obj" $view --size 64x36 -o x.png >.out 2>.err || fail "$*: status $?: $(cat .err)"
  grep -q "^trax-render: note: the general program .*$pattern" .err || fail "$*: no note: $(cat .err)"
  "$bin/trax-compare" -q x.png box.png || fail "$*: another picture"
}
note 'bin/trax-clang' bare/bin/trax-render
note '/dev/null/trax' env XDG_CACHE_HOME=/dev/null "$bin/trax-render"
note 'neither XDG_CACHE_HOME nor HOME' env -u XDG_CACHE_HOME -u HOME "$bin/trax-render"
bare/bin/trax-render "$source/box.obj" $view --size 16x9 -o y.png --mark-rays >.out 2>.err && fail "--mark-rays without a compiler"
grep -q "error: --mark-rays: there is no program for it: .*bin/trax-clang" .err && [ ! -e y.png ] || fail "--mark-rays: $(cat .err)"
"$bin/trax-render" "$source/box.obj" $view --size 64x36 --no-specialise -o x.png >.out 2>.err || fail "--no-specialise"
[ -s .err ] && fail "--no-specialise has a note: $(cat .err)"
"$bin/trax-compare" -q x.png box.png || fail "--no-specialise: another picture"
# The files of --keep run by themselves to the same picture.
same "$source/box.obj" $view --size 16x9 --config 1x32 --keep kept
"$bin/trax-sim" kept/manifest.json >.out 2>.err || fail "the manifest: $(cat .err)"
[ "$(wc -c <kept/image.raw)" -eq 576 ] || fail "image.raw has $(wc -c <kept/image.raw) bytes"
cp kept/image.raw specialised.raw
same "$source/box.obj" $view --size 16x9 --config 1x32 --keep kept --no-specialise
"$bin/trax-sim" kept/manifest.json >.out 2>.err || fail "the manifest, general: $(cat .err)"
cmp -s kept/image.raw specialised.raw || fail "the manifest: the general program's picture is another"
# --prepare writes the same files and renders nothing.
"$bin/trax-render" "$source/box.obj" $view --size 16x9 --config 1x32 --prepare prepared >.out 2>.err || fail "--prepare: $(cat .err)"
same "$source/box.obj" $view --size 16x9 --config 1x32 --keep kept
rm -f kept/image.raw
diff -r kept prepared >.out || fail "--prepare: other files than --keep: $(cat .out)"
# A scene that was made for another place in memory is refused, not traversed.
same "$source/box.obj" $view --size 16x9 --config 1x32 --keep moved
python3 -c 'import json; it = json.load(open("moved/manifest.json")); it["buffers"].reverse(); json.dump(it, open("moved/manifest.json", "w"))'
"$bin/trax-sim" moved/manifest.json >.out 2>.err && fail "a scene at another address: no error"
grep -q 'addresses of another place' .err || fail "a scene at another address: $(cat .err)"

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
