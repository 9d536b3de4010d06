#!/bin/sh
# Every feature of the ray tracer with every other, by the emulated machine: the program for all pictures and the one for this
# picture render the same bits, and so does the native twin; Embree agrees.
# Usage: features_test.sh BIN, the folder of the programs
. "$(dirname "$0")/head.sh"

# Twelve rows in which any two of the eleven columns have all four pairs of values (Plackett and Burman, 1946).
row=11011100010
for number in 1 2 3 4 5 6 7 8 9 10 11 12; do
  [ $number -eq 12 ] && row=00000000000
  options='' parts=0
  [ $number -gt 6 ] && options='--seed 3'
  set -- $(echo $row | sed 's/./& /g')
  for part in 1 2 4 8 16 32; do
    parts=$((parts + part * $1))
    shift
  done
  [ $1 -eq 1 ] && options="$options --smooth"
  [ $2 -eq 1 ] && options="$options --samples 2"
  [ $3 -eq 1 ] && options="$options --no-shadows"
  [ $4 -eq 1 ] && options="$options --float"
  if [ $5 -eq 1 ]; then
    options="$options --paths 4"
  else
    options=$(echo "$options" | sed 's/--seed 3//')
  fi
  "$bin/../tests/bin/render-gallery" made $parts || fail "render-gallery $parts"
  # By twos: lights of the view file, or the one that frames have.
  [ $((number % 2)) -eq 1 ] && options="$options --view made/gallery.view"
  [ $((number % 3)) -eq 1 ] && options="$options --one-sided"
  "$bin/trax-render" made/gallery.trax $options --size 20x14 --config 1x32 --compare -o x.png >.out 2>.err ||
    fail "parts $parts, $options: $(cat .out .err)"
  grep -q '^twin        identical in every bit$' .out || fail "parts $parts, $options: $(cat .out)"
  "$bin/trax-render" made/gallery.trax $options --size 20x14 --config 1x32 --no-specialise -o y.png >.out 2>.err ||
    fail "parts $parts, $options, general: $(cat .err)"
  "$bin/trax-compare" -q x.png y.png || fail "parts $parts, $options: the general program's picture is another"
  row=$(echo $row | sed 's/\(.*\)\(.\)/\2\1/')
done
exit $failures
