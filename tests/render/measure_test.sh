#!/bin/sh
# trax-render --layers and --hits from the command line: what they write, keep and refuse.
# Usage: measure_test.sh BIN, the folder of the programs
. "$(dirname "$0")/head.sh"

# measure OPTION...: of the box
measure() {
  "$bin/trax-render" "$source/box.obj" --view "$source/box.view" --size 32x18 $chip "$@" >.out 2>.err
}
chip='--config 1x32'
# value FILE KEY
value() { sed -n "s/^  \"$2\": \([-+.e0-9]*\),\{0,1\}\$/\1/p" "$1"; }
less() { awk -v a="$1" -v b="$2" 'BEGIN { exit !(a != "" && b != "" && a + 0 < b + 0) }'; }

# Layers: the picture and what its rays met, of the program, and the exact one of the same rays.
# compare A B: their figures, to ab.json
judge() { "$bin/trax-compare" --json --at-least 0 "$@" >ab.json 2>.err || fail "trax-compare $*: $(cat .err)"; }
measure --layers -o whole.exr || fail "--layers: $(cat .err)"
measure --layers -o coarse.exr --set special.precision_bits=8 || fail "8 bits: $(cat .err)"
measure -o whole.png || fail "$(cat .err)"
machine=$chip
chip=
measure --layers -o native.exr --engine native || fail "native: $(cat .err)"
measure --layers -o exact.exr --engine exact || fail "exact: $(cat .err)"
measure --layers -o tree.exr --engine exact --nodes binary --splits=4 || fail "other tree: $(cat .err)"
measure --layers -o embree.exr --engine embree || fail "embree: $(cat .err)"
measure --layers -o converged.exr --engine exact --samples 256 || fail "converged: $(cat .err)"
chip=$machine
cmp -s whole.exr native.exr || fail "layers: the twin's differ from the program's"
cmp -s exact.exr tree.exr || fail "layers: another tree, another exact picture"
judge whole.png whole.exr
[ "$(value ab.json largest)" = 0 ] || fail "the program that records renders another picture: $(cat ab.json)"
judge whole.exr exact.exr
[ "$(value ab.json wrong_pixels)$(value ab.json wrong_shadows)" = 00 ] || fail "wrong pixels: $(cat ab.json)"
# The angle to a plain light is taken from the shadow ray's start, up to 3 x 2^-17 of a triangle's edges (2) beside the point; the light is 0.85 away.
start=$(awk 'BEGIN { print 3 / 131072 * 2 / 0.85 * 255 }')
whole=$(value ab.json floats_rmse)
less 0 "$whole" && less "$(value ab.json floats_largest)" $start || fail "$(cat ab.json)"
judge coarse.exr exact.exr
less "$whole" "$(value ab.json floats_rmse)" && less 0.01 "$(value ab.json floats_rmse)" || fail "8 bits are as exact as 24: $(cat ab.json)"
judge embree.exr exact.exr
[ "$(value ab.json wrong_pixels)" = 0 ] || fail "Embree's layers: $(cat ab.json)"
judge exact.exr converged.exr
less 1 "$(value ab.json floats_rmse)" || fail "one sample is as good as 256: $(cat ab.json)"
# Boxes that are too small hide triangles: rays miss, or meet what is behind.
cp -r "$bin/../lib/trax/raytracer" narrow
sed -i 's/run->box_margin, &run->grid/run->box_margin - 0.1f, \&run->grid/' narrow/main.c
measure --layers -o narrow.exr --source narrow || fail "narrow boxes: $(cat .err)"
judge narrow.exr exact.exr
less 0 "$(value ab.json wrong_pixels)" && [ "$(value ab.json grown)" = 0 ] || fail "boxes that are too small: $(cat ab.json)"
measure --hits hits.json -o x.png || fail "--hits: $(cat .err)"

# Hits: what --compare prints.
measure --compare -o x.png || fail "--compare: $(cat .out .err)"
line="hits        $(value hits.json nearest) of $(value hits.json pixels) pixels hit the nearest triangle, $(value hits.json tied) another within the error bound, $(value hits.json beyond) beyond it"
grep -q "^$line" .out && grep -q "^            $(value hits.json embree) pixels hit the triangle that Embree hits" .out || fail "--hits: $(cat hits.json .out)"
[ "$(value hits.json pixels)" = 576 ] || fail "--hits: $(cat hits.json)"
rm -f x.png
# Any other output does without a picture, and is the same then.
for words in '--stats x.json' '--explore x.html' '--cost-picture x.png' '--cost-values x.csv' '--memory-trace x.csv' '--keep x.dir' \
  '--ray-trace x.csv' '--write-view x.view' '--sampled --stats x.json'; do
  file=${words##* }
  rm -rf x.* with.png
  measure $words -o with.png || fail "$words: $(cat .err)"
  [ -s with.png ] && mv $file with.$file || fail "$words: $(ls)"
  measure $words && [ "$(ls -d x.*)" = "$file" ] || fail "$words without -o: $(cat .err; ls)"
  for each in $file with.$file; do
    [ ! -f $each ] || sed -i '/"\(instructions_per_\)*host_second/d' $each
  done
  diff -r $file with.$file >/dev/null || fail "$words: differs without -o"
done
rm -rf x.* with.*
measure --compare && grep -q "^$line" .out || fail "--compare alone: $(cat .out .err)"
chip=
measure --hits again.json --engine native && cmp -s hits.json again.json && [ ! -e x.png ] || fail "--hits alone: $(cat .err)"
measure --source . --engine native -o x.png && fail "--source --engine native"
grep -q -- '--source and --no-specialise need the emulator' .err || fail "--source --engine native: $(cat .err)"
chip='--config 1x32'

# refuse PATTERN OPTION...: status 1, a line on standard error, nothing written.
refuse() {
  pattern=$1
  shift
  measure "$@"
  status=$?
  [ $status -eq 1 ] && grep -q -- "error: .*$pattern" .err && [ ! -s .out ] || fail "$*: $status, $(cat .err)"
  [ ! -e x.json ] || fail "$*: left x.json"
}
for words in -q --sampled --mark-rays "--samples 2"; do
  refuse 'no picture given' $words
done
refuse 'nowhere/x.json' --hits nowhere/x.json
refuse '--error has been removed; --layers' --error x.json
refuse '--layers needs -o FILE.exr' --layers -o x.png
refuse '--layers needs a program that records' --layers -o x.exr --stats x.json
refuse '--report has been removed; run twice' --report -o x.png
refuse '--stack has been removed; .*each level of the tree' --stack 4 -o x.png

# The program's source from elsewhere: the same program, wherever it lies; another one if it is changed.
for copy in one two; do
  cp -r "$bin/../lib/trax/raytracer" $copy
  measure --source $copy --cache programs --keep kept-$copy -o $copy.png || fail "--source: $(cat .err)"
done
cmp -s kept-one/program.elf kept-two/program.elf || fail "--source: the program depends on the folder"
[ "$(ls programs/*.elf | wc -l)" -eq 1 ] || fail "--source: $(ls programs)"
measure -o x.png && "$bin/trax-compare" -q x.png one.png || fail "--source: another picture"
sed -i 's/enter0 <= enter1/true/' two/layouts/binary/visit.h
measure --source two --cache programs --keep kept-two -o x.png || fail "--source, changed: $(cat .err)"
"$bin/trax-compare" -q x.png one.png || fail "--source, changed: another picture"
cmp -s kept-one/program.elf kept-two/program.elf && fail "--source, changed: the same program"
rm -f x.png
# Without room for the scene below 2 GiB, beside the program's own memory.
cp -r one far
sed -i '1s/^/static char most[0x7ffff000];\n/; s/^NO_RETURN int main(void) {/&\n  __asm__ volatile("" : : "r"(most));/' far/main.c
refuse 'the scene ends above 2 GiB' --source far --set memory.size_mib=4095 -o x.png
[ ! -e x.png ] || fail "above 2 GiB: left x.png"
echo 'not C' >two/main.c
refuse '--source two: there is no program: .*main.c' --source two -o x.png
refuse '--source three: there is no program: .*three' --source three -o x.png
refuse '--source are about the specialised program' --source one --no-specialise -o x.png
[ $failures -eq 0 ] && echo "as expected"
exit $((failures > 0))
