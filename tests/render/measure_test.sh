#!/bin/sh
# trax-render --error and --hits from the command line: what they write, keep and refuse.
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

# Without a picture nothing is simulated in time; the converged picture is computed once.
measure --error whole.json --converged kept || fail "--error: $(cat .err)"
[ "$(ls kept | wc -l)" -eq 1 ] || fail "kept: $(ls kept)"
touch -d 2020-01-01 kept/*
measure --error coarse.json --converged kept --set special.precision_bits=8 || fail "8 bits: $(cat .err)"
measure --error samples.json --converged kept --samples 16 || fail "16 samples: $(cat .err)"
measure --error nodes.json --converged kept --nodes binary --splits=4 || fail "other nodes: $(cat .err)"
[ "$(find kept -type f ! -newermt 2020-01-02 | wc -l)" -eq 1 ] && [ "$(ls kept | wc -l)" -eq 1 ] || fail "converged again: $(ls -l kept)"
[ "$(value whole.json wrong_pixels)" = 0 ] || fail "wrong pixels: $(cat whole.json)"
# The angle to a plain light is taken from the shadow ray's start, up to 3 x 2^-17 of a triangle's edges (2) beside the point; the light is 0.85 away.
start=$(awk 'BEGIN { print 3 / 131072 * 2 / 0.85 * 255 }')
less 0 "$(value whole.json numerical_rmse)" && less "$(value whole.json numerical_largest)" $start || fail "$(cat whole.json)"
less "$(value whole.json numerical_rmse)" "$(value coarse.json numerical_rmse)" && less 0.01 "$(value coarse.json numerical_rmse)" ||
  fail "8 bits are as exact as 24: $(cat coarse.json)"
less "$(value samples.json total_rmse)" "$(awk -v x="$(value whole.json total_rmse)" 'BEGIN { print x / 2 }')" || fail "16 samples are as noisy as one"
for file in coarse nodes; do
  [ "$(value $file.json sampling_rmse)" = "$(value whole.json sampling_rmse)" ] || fail "$file: another exact picture"
done
measure --error alone.json || fail "without --converged: $(cat .err)"
cmp -s whole.json alone.json || fail "--converged changes: $(diff whole.json alone.json)"
# Two at once: one of them computes it.
for run in 1 2; do
  "$bin/trax-render" "$source/box.obj" --view "$source/box.view" --size 96x54 $chip --error twice$run.json --converged twice -q &
done
wait
cmp -s twice1.json twice2.json && [ "$(ls twice | wc -l)" -eq 1 ] || fail "two at once: $(ls twice)"
# With a picture, its figures as well as the others.
measure --error both.json --converged kept --hits hits.json -o x.png --stats s.json || fail "with a picture: $(cat .err)"
cmp -s whole.json both.json && [ -s x.png ] && [ -s s.json ] || fail "with a picture: $(ls)"
grep -q '^error       both.json$' .out && grep -q '^hits        hits.json$' .out || fail "with a picture: $(cat .out)"

# Hits: what --compare prints.
measure --compare -o x.png || fail "--compare: $(cat .out .err)"
line="hits        $(value hits.json nearest) of $(value hits.json pixels) pixels hit the nearest triangle, $(value hits.json tied) another within the error bound, $(value hits.json beyond) beyond it"
grep -q "^$line" .out && grep -q "^Embree      $(value hits.json embree) pixels" .out || fail "--hits: $(cat hits.json .out)"
[ "$(value hits.json pixels)" = 576 ] || fail "--hits: $(cat hits.json)"
rm -f x.png
# Any other output does without a picture, and is the same then.
for words in '--stats x.json' '--explore x.html' '--cost-picture x.png' '--cost-values x.csv' '--memory-trace x.csv' '--id-picture x.png' '--keep x.dir' \
  '--ray-trace x.csv' '--progress-png x.png' '--write-view x.view' '--sampled --stats x.json'; do
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
measure --error x.json --stats s.json --converged kept && cmp -s whole.json x.json && [ -s s.json ] || fail "--error --stats: $(cat .err)"
rm -f x.json
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
refuse '--frames needs -o' --frames 2 --progress-png x.png
refuse 'compiled for the picture' --error x.json --engine native
refuse 'compiled for the picture' --error x.json --no-specialise
refuse 'one whole picture' --error x.json -o x.png --sampled
refuse '--converged is for --error' --hits x.json --converged kept
refuse 'watertight' --hits x.json --triangle moller-trumbore
refuse '--prepare renders nothing' --error x.json --prepare here
refuse 'only for .json' --error x.csv
refuse 'nowhere/near' --error x.json --converged nowhere/near
refuse 'Not a directory\|File exists' --error x.json --converged /dev/null
refuse 'nowhere/x.json' --hits nowhere/x.json
refuse 'no.such' --error x.json --set no.such=1
sed 's/^light.*/lights = ( { type = "directional"; direction = [0.0, -1.0, -0.3]; } );/' "$source/box.view" >lights.view
refuse 'this picture needs lights' --error x.json --view lights.view
refuse 'this picture needs paths' --error x.json --paths 3
refuse '--bench-accuracy has been removed; --error' --bench-accuracy -o x
refuse '--report has been removed; run twice' --report -o x.png
refuse '--stack has been removed; .*experiments/stack' --stack 4 -o x.png

# Interrupted while it converges: nothing is left.
env --default-signal=INT "$bin/trax-render" "$source/box.obj" --size 320x180 --error x.json --converged stopped >.out 2>.err &
process=$!
for _ in $(seq 600); do [ -d stopped ] && break; sleep 0.05; done
kill -INT $process
wait $process
[ $? -eq 130 ] && [ ! -e x.json ] && [ "$(ls stopped | wc -l)" -eq 0 ] || fail "interrupted: $(ls . stopped) $(cat .err)"

# The program's source from elsewhere: the same program, wherever it lies; another one if it is changed.
for copy in one two; do
  cp -r "$bin/../lib/trax/raytracer" $copy
  measure --source $copy --cache programs --keep kept-$copy -o $copy.png || fail "--source: $(cat .err)"
done
cmp -s kept-one/program.elf kept-two/program.elf || fail "--source: the program depends on the folder"
[ "$(ls programs/*.elf | wc -l)" -eq 1 ] || fail "--source: $(ls programs)"
measure -o x.png && "$bin/trax-compare" -q x.png one.png || fail "--source: another picture"
sed -i 's/enter0 <= enter1/true/' two/traverse.h
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
