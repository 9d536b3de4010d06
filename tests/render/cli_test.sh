#!/bin/sh
# The command lines of trax-render and trax-compare: what they refuse, what they leave behind, what they print.
# Usage: cli_test.sh BIN, the folder of the programs
. "$(dirname "$0")/head.sh"
out=$work/out err=$work/err # of the last command
mkdir here && cd here || exit 1

# refuse PATTERN COMMAND...: status 1, nothing on standard output, one line on standard error that matches, no new files.
refuse() {
  pattern=$1
  shift
  before=$(ls -A)
  "$@" >"$out" 2>"$err"
  status=$?
  [ $status -eq 1 ] || fail "$*: status $status instead of 1"
  [ -s "$out" ] && fail "$*: printed $(cat "$out")"
  grep -q -- "$pattern" "$err" || fail "$*: '$(cat "$err")' does not match '$pattern'"
  [ "$(wc -l <"$err")" -eq 1 ] || fail "$*: more than a line of error"
  [ "$(ls -A)" = "$before" ] || fail "$*: left $(ls -A)"
}

# accept COMMAND...: status 0.
accept() {
  "$@" >"$out" 2>"$err" || fail "$*: status $?: $(cat "$err")"
}

render="$bin/trax-render"
compare="$bin/trax-compare"
box="$source/box.obj"
native="--engine native --view $source/box.view"

# --- options
refuse 'no mesh' "$render"
refuse 'no mesh' "$render" -o x.png
refuse 'no picture given' "$render" "$box"
refuse 'nofile.obj: cannot be read: No such file' "$render" "$box" nofile.obj
refuse 'expected generate:forest' "$render" generate:forst
refuse 'did you mean fast' "$render" "$box" --engine fst
refuse 'x.png: is written twice, by --output and by --cost-picture' "$render" "$box" -o x.png --cost-picture x.png
refuse 'x.json: is written twice, by --stats and by --explore' "$render" "$box" -o x.png --stats x.json --explore x.json
refuse 'unknown option --siez; did you mean --size?' "$render" "$box" -o x.png --siez 10x10
refuse 'unknown option -z' "$render" "$box" -o x.png -z
refuse '--size needs WxH' "$render" "$box" -o x.png --size
refuse '--quiet takes no value' "$render" "$box" -o x.png --quiet=1
for size in '' 0x10 10x0 10 10x 10x10x10 -1x5 16385x1 1x16385 1e3x10 99999999999999999999x1 ' 1x1'; do
  refuse '--size' "$render" "$box" -o x.png --size "$size"
done
refuse "--engine: 'gpu' is none of fast, reference, native, embree and exact" "$render" "$box" -o x.png --engine gpu
refuse "--ambient: '2' is not" "$render" "$box" -o x.png --ambient 2
refuse "--ambient: 'nan' is not" "$render" "$box" -o x.png --ambient nan
for samples in 0 4097 2.5 '' -1; do
  refuse '--samples' "$render" "$box" -o x.png --samples "$samples"
done
for depth in 0 65 2.5 '' -1 x; do
  refuse '--paths' "$render" "$box" -o x.png --paths "$depth"
done
for seed in -1 4294967296 '' x; do
  refuse '--seed' "$render" "$box" -o x.png --paths 2 --seed "$seed"
done
refuse '--seed is for --paths' "$render" "$box" -o x.png --seed 3
refuse "--material: 'wood' is not" "$render" "$box" -o x.png --material wood
refuse "no material is named 'tin'" "$render" "$box" -o x.png --material tin=mirror
refuse "--diffuse: 'red=2,0,0'" "$render" "$box" -o x.png --diffuse red=2,0,0
refuse "--nodes: 'octal' is none of auto, binary, quantised, wide4, wide4-quantised and wide8" "$render" "$box" -o x.png --nodes octal
refuse "--texture-size: '3' is not a power of two" "$render" "$box" -o x.png --texture-size 3
refuse "--normals: 'round' is none of file" "$render" "$box" -o x.png --normals round
refuse '--background' "$render" "$box" -o x.png --background 12345g
refuse "--set: 'bandwidth' is not of the form KEY=VALUE" "$render" "$box" -o x.png --set bandwidth
refuse '--threads' "$render" "$box" -o x.png --engine native --threads 0
refuse '--stats needs the emulator' "$render" "$box" -o x.png --engine native --stats s.json
refuse 'need the emulator' "$render" "$box" -o x.png --engine embree --config 4x32
refuse 'need the emulator' "$render" "$box" -o x.png --engine native --cost-picture c.png
refuse 'need the emulator' "$render" "$box" -o x.png --engine native --explore p.html
refuse 'need the emulator' "$render" "$box" -o x.png --engine native --no-specialise
refuse '--no-specialise asks for none' "$render" "$box" -o x.png --no-specialise --cache here
refuse '--program asks for another' "$render" "$box" -o x.png --program x.elf --cache here
refuse '--cache /dev/null/x' "$render" "$box" -o x.png --cache /dev/null/x
refuse "--triangle has been removed" "$render" "$box" -o x.png --triangle moller-trumbore
refuse "--queues: '65' is neither tms nor a whole number from 1 to 64" "$render" "$box" -o x.png --queues 65
refuse "--queues: '0' is neither" "$render" "$box" -o x.png --queues 0
refuse '--queues needs a program.*--no-specialise' "$render" "$box" -o x.png --queues tms --no-specialise
refuse '--queues needs the emulator' "$render" "$box" -o x.png --engine native --queues tms
refuse '--fast-math has been removed; -ffast-math in a file flags.txt' "$render" "$box" -o x.png --fast-math
refuse "--cost: 'time' is none of cycles" "$render" "$box" -o x.png --cost-picture c.png --cost time
for option in '-o x.png' '--stats s.json' --compare '--explore p.html' '--cost-picture c.png'; do
  refuse '--prepare renders nothing' "$render" "$box" --prepare prepared $option
done
refuse 'need the emulator' "$render" "$box" --prepare prepared --engine native
refuse '--cost without' "$render" "$box" -o x.png --cost cycles

for option in eye look-at up light; do
  for value in '' 1,2 1,2,3,4 1,2,x 1,,3 1,2,1e30 nan,0,0; do
    refuse "--$option" "$render" "$box" -o x.png --$option "$value"
  done
done
refuse "--fov: '180' is not" "$render" "$box" -o x.png --fov 180
refuse "--orbit: '1,2,3' is not" "$render" "$box" -o x.png --orbit 1,2,3
refuse "--frames: '1' is not a whole number" "$render" "$box" -o x.png --frames 1
refuse '--frames is for a sequence, --at X:Y; --orbit' "$render" "$box" -o x.png --frames 2
refuse '--animation without --at' "$render" "$box" -o x.png --animation run
refuse 'the meshes have no cameras' "$render" "$box" -o x.png --view file:main
refuse 'is the eye itself' "$render" "$box" -o x.png --eye 1,2,3 --look-at 1,2,3
refuse 'in which the eye looks' "$render" "$box" -o x.png --eye 1,2,3 --look-at 1,2,5 --up 0,0,1

# --- files
refuse 'missing.obj' "$render" missing.obj -o x.png
refuse 'nowhere' "$render" "$box" -o nowhere/x.png
refuse 'nowhere' "$render" "$box" -o x.png --stats nowhere/s.json
for option in explore cost-picture cost-values; do
  refuse 'nowhere' "$render" "$box" -o x.png --$option nowhere/x
done
refuse 'view missing.view: there is no such file, and trax comes with no such view' "$render" "$box" -o x.png --view missing.view
refuse 'nowhere/a.view: ' "$render" "$box" -o x.png --view nowhere/a.view
refuse 'did you mean bunny? (--views lists them)' "$render" "$box" -o x.png --view buny
# A folder of that name, as --prepare bunny makes it, hides no view.
mkdir bunny
accept "$render" "$box" -o view.png --engine native --size 8x8 --view bunny
rmdir bunny
"$render" --views >views.txt
grep -q '^bunny  *The Stanford bunny of glmark2 (bunny.obj, .* a little above$' views.txt || fail "--views has no line about bunny"
grep -q '^forest  *The generated forest (generate:forest, 174,117 triangles), from .* into the clearing$' views.txt || fail "--views: $(grep forest views.txt)"
[ "$(cut -d ' ' -f 1 views.txt)" = "$(cd "$source/../../raytracer/views" && ls *.view | sed 's/\.view$//' | LC_ALL=C sort)" ] || fail "--views: $(cat views.txt)"
# A known mesh has its view, unless it is told otherwise; another mesh of that name is framed.
bunny=/usr/share/glmark2/models/bunny.obj
accept "$render" $bunny -o known.png --engine native --size 32x24
accept "$render" $bunny -o view.png --engine native --size 32x24 --view bunny
cmp -s known.png view.png || fail "the bunny has another view than --view bunny"
accept "$render" $bunny -o up.png --engine native --size 32x24 --up 0,1,0
cmp -s known.png up.png && fail "--up takes the view by name"
printf 'v 900 0 0\nv 901 0 0\nv 900 1 0\nf 1 2 3\n' >bunny.obj
accept "$render" bunny.obj -o other.png --engine native --size 32x24 --write-view other.view
grep -q 'eye = \[9' other.view || fail "another mesh with the name of a known one is not framed"
printf 'eye = [0, 0];\n' >bad.view
refuse 'bad.view:1' "$render" "$box" -o x.png --view bad.view
printf 'not a scene' >bad.trax
refuse 'bad.trax' "$render" bad.trax -o x.png
refuse 'stands alone' "$render" bad.trax "$box" -o x.png
printf 'o nothing\n' >empty.obj
refuse 'empty.obj\|triangle' "$render" empty.obj -o x.png
sed 's/^light.*/light = [1e30, 1e30, 1e30];/' "$source/box.view" >far.view
refuse 'light' "$render" "$box" -o x.png --engine native --view far.view

# --- pictures
accept "$render" "$box" -o a.png $native --size 32x24
grep -q '^picture     a.png$' "$out" || fail "no line about the picture"
accept "$render" "$box" -o b.png $native --size 32x24 --quiet --threads 7
[ -s "$out" ] && fail "--quiet printed $(cat "$out")"
accept "$compare" a.png b.png
accept "$render" "$box" -o reference.png --engine embree --view "$source/box.view" --size 32x24
accept "$compare" a.png reference.png --within 2 --at-least 99
cp a.png kept.png
refuse 'missing.obj' "$render" missing.obj -o a.png
cmp -s a.png kept.png || fail "a failed run changed an earlier picture"
accept "$bin/trax-scene" "$box" -o box.trax
accept "$render" box.trax -o b.png $native --size 32x24
refuse 'box.trax: --smooth: the scene has no normals' "$render" box.trax -o x.png $native --smooth
accept "$compare" a.png b.png
refuse '--nodes, --splits, --instances, --flatten and --normals smooth are for meshes' "$render" box.trax -o x.png $native --nodes binary

# The picture does not depend on how the tree is stored; the file does.
refuse "--splits: '0.5' is neither auto nor a number from 1 to 8" "$render" "$box" -o x.png --splits=0.5
for nodes in binary quantised wide4 wide4-quantised wide8 auto; do
  accept "$bin/trax-scene" "$box" -o "$nodes.trax" --nodes "$nodes"
  accept "$bin/trax-scene" "$box" -o "split-$nodes.trax" --nodes "$nodes" --splits=4
  for input in "$nodes.trax" "$box --nodes $nodes" "split-$nodes.trax" "$box --nodes $nodes --splits"; do
    accept "$render" $input -o b.png $native --size 32x24
    accept "$compare" a.png b.png
  done
done
refuse 'wide8 nodes: the general program knows binary and quantised ones only' "$render" wide8.trax -o x.png --size 4x4 --no-specialise
refuse 'wide4.trax: only binary and quantised nodes are refitted; its nodes are wide4' "$bin/trax-scene" "$box" --refit wide4.trax -o x.trax
cmp -s binary.trax quantised.trax && fail "--nodes makes no difference"
cmp -s quantised.trax auto.trax || fail "--nodes auto is not quantised"
accept "$render" "$box" -o tiny.png --engine native --size 1x1
accept "$render" "$box" -o line.png --engine native --size 1x1000
accept "$render" "$box" -o sky.png --engine native --size 4x3 --background 123456
accept "$render" "$box" -o b.png $native --size 32x24 --ambient 0.5
"$compare" -q a.png b.png && fail "other ambient light makes no difference"
"$render" --help | grep -q -- --compare || fail "--help"
"$render" --version | grep -q '^trax-render [0-9]' || fail "--version"

# Views by options: the same values make the same picture, a whole turn leads back, a view that is written is that view.
accept "$render" "$box" -o b.png --engine native --size 32x24 --eye 0.03,1.02,3.8 --look-at 0,1,0 --up 0,1,0 \
  --fov 40 --light 0.1,1.85,0.1 --write-view written.view
accept "$render" "$box" -o c.png --engine native --size 32x24 --view written.view
accept "$compare" b.png c.png
accept "$render" "$box" -o c.png --engine native --size 32x24 --view written.view --orbit 30,10
"$compare" -q b.png c.png && fail "--orbit makes no difference"
accept "$render" "$box" -o c.png --engine native --size 32x24 --view written.view --orbit 360
accept "$compare" b.png c.png --within 2 --at-least 99

# A camera of a glTF file, by its name or the first; what stands in its place is the same view.
cat >camera.gltf <<'END'
{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1]}],
 "nodes":[{"mesh":0},{"name":"front","camera":0,"translation":[0.25,0,4]}],
 "cameras":[{"type":"perspective","perspective":{"yfov":0.7853981633974483,"znear":0.1}}],
 "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
 "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[-1,-1,0],"max":[1,1,0]}],
 "bufferViews":[{"buffer":0,"byteLength":36}],
 "buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AACAvwAAgL8AAAAAAACAPwAAgL8AAAAAAAAAAAAAgD8AAAAA"}]}
END
accept "$render" camera.gltf -o b.png --engine native --size 32x24 --view file:front --light 1,2,3
accept "$render" camera.gltf -o c.png --engine native --size 32x24 --view file: --light 1,2,3
accept "$compare" b.png c.png
accept "$render" camera.gltf -o c.png --engine native --size 32x24 --eye 0.25,0,4 --look-at 0.25,0,0 --up 0,1,0 --fov 45 \
  --light 1,2,3
accept "$compare" b.png c.png --within 2 --at-least 98
refuse "no camera has this name; the first of 1 is 'front'" "$render" camera.gltf -o x.png --view file:back

# Samples, light without shadows: each its own picture, near the reference's.
for options in '--samples 5' '--no-shadows' '--samples 2 --no-shadows --smooth'; do
  # shellcheck disable=SC2086
  accept "$render" "$box" -o b.png $native --size 32x24 $options
  "$compare" -q a.png b.png && fail "$options makes no difference"
  # shellcheck disable=SC2086
  accept "$render" "$box" -o reference.png --engine embree --view "$source/box.view" --size 32x24 $options
  accept "$compare" b.png reference.png --within 2 --at-least 99
done

# Paths: noise follows from the seed; the reference has the same light.
accept "$render" "$box" -o p.png $native --size 64x48 --paths 3 --samples 4
accept "$render" "$box" -o q.png $native --size 64x48 --paths 3 --samples 4 --seed 0 --threads 5
accept "$compare" -q p.png q.png
accept "$render" "$box" -o q.png $native --size 64x48 --paths 3 --samples 4 --seed 1 --compare
grep -q '^            light of the whole picture [-+]0[.]0' "$out" || fail "--compare of paths: $(cat "$out")"
"$compare" -q p.png q.png && fail "another seed makes no difference"

# Linear floats: both kinds of files hold the same ones, and they are what the pixels are made of.
accept "$render" "$box" -o floats.pfm $native --size 33x25
accept "$render" "$box" -o floats.exr $native --size 33x25
accept "$render" "$box" -o pixels.png $native --size 33x25
accept "$compare" floats.pfm floats.exr
grep -q '^RMSE 0 of linear floats, 0 channels not finite, 100.0000 % of the pixels within 0/255 of their brightness$' "$out" || fail "PFM and EXR: $(cat "$out")"
accept "$compare" pixels.png floats.exr --within 1
grep -q 'of linear floats' "$out" && fail "a PNG has no floats"
[ "$(wc -c <floats.pfm)" -eq $((14 + 12 * 33 * 25)) ] || fail "floats.pfm has $(wc -c <floats.pfm) bytes"
accept "$render" "$box" -o again.exr $native --size 33x25 --threads 3
cmp -s floats.exr again.exr || fail "not the same EXR again"
accept "$render" "$box" -o b.pfm $native --size 33x25 --ambient 0.5
"$compare" floats.exr b.pfm >"$out" && fail "other ambient light makes no difference to the floats"
grep -q '^RMSE 0\.[0-9]* of linear floats' "$out" || fail "no RMSE: $(cat "$out")"
# Floats are judged, not what a display shows of them: 2 and 1.8 are both white.
for value in '\000\000\000@' 'ff\346?'; do
  printf 'PF\n1 1\n-1\n%b%b%b' "$value" "$value" "$value"
done >both.pfm
head -c 22 both.pfm >two.pfm
tail -c 22 both.pfm >less.pfm
"$compare" two.pfm less.pfm --within 2 >"$out" && fail "2 and 1.8 are the same to trax-compare"
grep -q '^100.0000 % of 1 pixels within 2/255, 1 differ' "$out" || fail "what a display shows: $(cat "$out")"
grep -q '0.0000 % of the pixels within 2/255 of their brightness$' "$out" || fail "2 and 1.8: $(cat "$out")"
accept "$compare" two.pfm less.pfm --within 14
for file in floats.pfm floats.exr; do
  head -c 700 $file >cut
  refuse 'cut: not a readable' "$compare" cut pixels.png
done
sed '2s/.*/33/' floats.pfm >odd.pfm
refuse 'odd.pfm: not a readable PFM' "$compare" odd.pfm pixels.png
printf 'PF\n99999 99999\n-1.0\n' >vast.pfm
refuse 'vast.pfm: a picture of 99999 x 99999' "$compare" vast.pfm pixels.png
refuse 'nowhere' "$render" "$box" -o nowhere/x.exr $native
refuse 'x.JPG: there is no writer for .JPG, only for .png, .pfm and .exr' "$render" "$box" -o x.JPG $native

accept "$render" "$box" -o h.png $native --size 32x24 --compare
grep -q '^hits        7[0-9][0-9] of 768 pixels hit the nearest triangle, [0-9]* another .* 0 beyond it, of which 0 are holes$' "$out" ||
  fail "no line about hits: $(cat "$out")"

# --- comparison
refuse 'two pictures' "$compare" a.png
refuse 'missing.png' "$compare" a.png missing.png
refuse 'not a readable PNG' "$compare" a.png bad.trax
head -c 200 a.png >cut.png
refuse 'cut.png: not a readable PNG' "$compare" cut.png a.png
refuse '32 x 24.*1 x 1' "$compare" a.png tiny.png
refuse '--within' "$compare" --within 256 a.png a.png
refuse '--at-least' "$compare" --at-least 101 a.png a.png
refuse 'unknown option' "$compare" --nonsense a.png a.png
"$compare" a.png b.png --within 255 | grep -q '^100.0000 %' || fail "everything is within 255"
"$compare" a.png b.png --within 2 --at-least 99.9 >"$out" && fail "different pictures agree"
grep -q 'differ, by up to' "$out" || fail "the difference is not told: $(cat "$out")"

# --- options that went
refuse 'show has been removed; --engine native' "$render" "$box" -o x.png --show
refuse 'progress-png has been removed; --engine native' "$render" "$box" -o x.png --progress-png frames.png
refuse 'id-picture has been removed; -o FILE.exr --layers' "$render" "$box" -o x.png --id-picture ids.png

# --- interrupted: status 130 and no picture
env --default-signal=INT "$render" "$box" -o interrupted.png $native --size 16384x16384 2>"$err" &
process=$!
until [ "$(ls "/proc/$process/task" | wc -l)" -gt 1 ] || ! kill -0 $process; do # its threads render
  sleep 0.05
done
kill -INT $process 2>/dev/null
wait $process
status=$?
[ $status -eq 130 ] || fail "interrupted: status $status instead of 130"
for file in interrupted.png*; do
  [ -e "$file" ] && fail "interrupted: left $file"
done

# --- nobody reads what is printed: the picture is written all the same
mkfifo reader
(exec 3<>reader 4>reader 3<&- && "$render" "$box" -o piped.png $native --size 32x24 >&4 2>"$err")
status=$?
rm reader
[ $status -eq 141 ] || fail "a reader that is gone: status $status instead of 141"
[ -s "$err" ] && fail "a reader that is gone: $(cat "$err")"
[ -s piped.png ] || fail "a reader that is gone: $(ls)"
rm -f piped.png

[ $failures -eq 0 ] && echo "all command lines as expected"
exit $((failures > 0))
