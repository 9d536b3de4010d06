#!/bin/sh
# trax-render --bench-accuracy from the command line: what it writes, goes on with, leaves behind and refuses.
# Usage: bench_accuracy_test.sh BIN, the folder of the programs
. "$(dirname "$0")/head.sh"

bench() {
  "$bin/trax-render" --bench-accuracy "$source/box.obj" --view "$source/box.view" --size 48x27 "$@" >.out 2>.err
}

# Interrupted while it measures: status 130, what was measured is kept, no report; the next run goes on from there.
env --default-signal=INT "$bin/trax-render" --bench-accuracy "$source/box.obj" --view "$source/box.view" --size 48x27 -o out >.out 2>.err &
process=$!
for _ in $(seq 600); do
  [ "$(find out/measured -name '*.json' 2>/dev/null | wc -l)" -ge 3 ] && break
  sleep 0.05
done
kill -INT $process
wait $process
status=$?
[ $status -eq 130 ] || fail "interrupted: status $status instead of 130: $(cat .err)"
kept=$(find out/measured -name '*.json' | wc -l)
[ "$kept" -ge 3 ] || fail "interrupted: $kept rows kept"
ls out | grep -v '^measured$' | grep . && fail "interrupted: left $(ls out)"
find out cache -name '*.??????' | grep . && fail "interrupted: left unfinished files"
find out/measured -name '*.json' -newermt '2020-01-01' -exec touch -d '2020-01-01' {} +
bench -o out || fail "the second run: $(cat .err)"
[ "$(find out/measured -name '*.json' ! -newermt '2020-01-02' | wc -l)" -eq "$kept" ] || fail "rows were measured again"

# The reports agree with each other.
rows=$(sed 1d out/accuracy.csv | wc -l)
[ "$rows" -eq "$(grep -c '^| ' out/accuracy.md | awk '{ print $1 - 2 }')" ] || fail "table and CSV are of different length"
[ "$rows" -eq "$(grep -c '"method":' out/accuracy.json)" ] || fail "JSON and CSV are of different length"
[ "$rows" -eq "$(find out/measured -name '*.json' | wc -l)" ] || fail "a row was not kept"
head -n "$(wc -l <out/accuracy.md)" .out | cmp -s - out/accuracy.md || fail "what is printed is not accuracy.md"
for column in cycles numerical_rmse total_rmse wrong_pixels energy; do
  head -n 1 out/accuracy.csv | grep -q ",$column," || fail "no column $column"
done
grep -q '^$numerical_unit << EOD$' out/accuracy.gnuplot || fail "no data in the script"
grep "^set xtics" out/accuracy.gnuplot | grep "\('[0-9.]*'\).*\1" && fail "two places of an axis have one number"
if command -v gnuplot >/dev/null; then
  grep -q '</svg>' out/accuracy.svg || fail "no diagram: $(cat .err)"
fi
# field NAME ROW: a column of a row
field() { awk -F'"?,"?' -v name="$1" -v row="$2" 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == name) column = i }
  NR > 1 { sub(/^"/, "", $0); gsub(/, /, "_", $0); $0 = $0; if ($1 == row) print $column }' out/accuracy.csv; }
[ "$(field wrong_pixels default)" = 0 ] || fail "wrong pixels of the default: '$(field wrong_pixels default)'"
awk -v a="$(field numerical_rmse default)" -v b="$(field numerical_rmse 8\ bits_digits)" 'BEGIN { exit !(a > 0 && b > 100 * a) }' ||
  fail "8 bits are as exact as 24: $(field numerical_rmse default), $(field numerical_rmse 8\ bits_digits)"
awk -v a="$(field total_rmse default)" -v b="$(field total_rmse 16\ samples)" 'BEGIN { exit !(b > 0 && a > 2 * b) }' ||
  fail "16 samples are as noisy as one"

# Nothing changed: the same reports, and nothing is measured.
for file in csv json md svg; do [ -e out/accuracy.$file ] && cp out/accuracy.$file before.$file; done
touch stamp
bench -o out || fail "the third run: $(cat .err)"
find out/measured -newer stamp -name '*.json' | grep . && fail "measured again"
for file in csv json md; do cmp -s out/accuracy.$file before.$file || fail "another accuracy.$file"; done
# Without gnuplot everything but the diagrams.
mkdir nowhere && rm -f out/accuracy.svg
(PATH=$work/nowhere; bench -o out) || fail "without gnuplot: $(cat .err)"
grep -q 'no diagrams: gnuplot' .err && [ ! -e out/accuracy.svg ] || fail "without gnuplot: $(cat .err)"

# refuse PATTERN OPTION...: status 1, a line on standard error, nothing written.
refuse() {
  pattern=$1
  shift
  bench "$@"
  status=$?
  [ $status -eq 1 ] && grep -q -- "error: .*$pattern" .err && [ ! -s .out ] || fail "$*: $status, $(cat .err)"
  [ ! -e x ] || fail "$*: left $(ls x)"
}
refuse 'no picture given'
refuse 'varies --samples' -o x --samples 2
refuse 'varies --samples.*--triangle' -o x --triangle moller-trumbore
refuse 'chooses engines' -o x --engine native
refuse 'chooses engines' -o x --no-specialise
refuse 'of its own, and nothing else' -o x --compare
refuse 'of its own, and nothing else' -o x --stats s.json
refuse 'nowhere/near/x' -o nowhere/near/x
refuse '/dev/null' -o /dev/null
refuse 'no.such' -o out --set no.such=1
sed 's/^light.*/lights = ( { type = "directional"; direction = [0.0, -1.0, -0.3]; } );/' "$source/box.view" >lights.view
refuse 'this picture needs lights' -o out --view lights.view
refuse 'this picture needs paths' -o out --paths 3

[ $failures -eq 0 ] && echo "as expected"
exit $((failures > 0))
