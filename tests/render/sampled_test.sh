#!/bin/sh
# trax-render --sampled: the picture, the estimate and its interval against the exact run, what it refuses.
# Usage: sampled_test.sh BIN, the folder of the programs
. "$(dirname "$0")/head.sh"
scene="$source/box.obj --view $source/box.view"

# render NAME ARGUMENTS...: NAME.png and NAME.json
render() {
  name=$1
  shift
  "$bin/trax-render" $scene -o "$name.png" --stats "$name.json" "$@" >.out 2>.err || fail "$*: status $?: $(cat .err)"
}

number() { # FILE MEMBER: the first one of that name
  sed -n 's/^ *"'"$2"'": \([-0-9.e+]*\),*$/\1/p' "$1" | head -n 1
}

is() { # an expression of awk's
  [ "$(awk "BEGIN { print ($1) ? 1 : 0 }")" = 1 ]
}

# --- all of it: the exact run in every figure, but for what says that it was sampled
render exact --size 96x64 --config 2x32
render all --size 96x64 --config 2x32 --sampled --sample-fraction 1
cmp -s exact.png all.png || fail "--sample-fraction 1: another picture"
without_host() {
  grep -v '"host_seconds"\|"instructions_per_host_second"' "$1" | sed '/"sampled": {/,/}/d'
}
without_host exact.json >exact.txt
without_host all.json >all.txt
cmp -s exact.txt all.txt || fail "--sample-fraction 1: other figures: $(diff exact.txt all.txt | head -n 4)"
[ "$(number all.json cycles_low)" = "$(number all.json cycles_high)" ] || fail "--sample-fraction 1: an interval"

# --- some of it, on two chips: all four are within their intervals
for chip in 1x32 4x48; do
  render exact --size 320x180 --config $chip
  for seed in 1 2; do
    render some --size 320x180 --config $chip --sampled --sample-fraction 0.2 --sample-seed $seed
    cmp -s exact.png some.png || fail "$chip: the picture is not the twin's"
    for figure in rays primary shadow items; do
      [ "$(number exact.json $figure)" = "$(number some.json $figure)" ] || fail "$chip: $figure"
    done
    cycles=$(number exact.json cycles) low=$(number some.json cycles_low) high=$(number some.json cycles_high)
    mrps=$(number exact.json mrps)
    is "$low <= $cycles && $cycles <= $high" || fail "$chip, seed $seed: $cycles is not in $low to $high"
    is "$(number some.json cycles) / $cycles < 1.1 && $(number some.json cycles) / $cycles > 0.9" || fail "$chip: far off"
    is "$(number some.json mrps_low) * $high / $mrps / $cycles < 1.000001" || fail "$chip: mrps_low"
    is "$(number some.json mrps_high) * $low / $mrps / $cycles > 0.999999" || fail "$chip: mrps_high"
    is "$high - $low < 0.25 * $cycles && $high > $low" || fail "$chip: the interval $low to $high"
    is "$(number some.json detailed_cycles) < 0.5 * $cycles" || fail "$chip: too much was simulated"
    is "$(number some.json predicted_cycles) / $cycles < 1.5 && $(number some.json predicted_cycles) / $cycles > 0.6" ||
      fail "$chip: the prediction"
    grep -q '"holds": true' some.json || fail "$chip: the identity"
  done
done

# --- one queue for all TMs, and more queues than TMs
for queues in 1 5; do
  render exact --size 240x136 --config 2x32 --queues $queues
  render some --size 240x136 --config 2x32 --queues $queues --sampled --sample-fraction 0.2
  is "$(number some.json cycles) / $(number exact.json cycles) < 1.1 && $(number some.json cycles) / $(number exact.json cycles) > 0.9" ||
    fail "$queues queues: far off: $(number some.json cycles) for $(number exact.json cycles)"
  [ "$(number some.json queues)" = $queues ] || fail "$queues queues: $(number some.json queues)"
done

# --- what the prediction's constants are not known for is said
render some --size 96x64 --sampled
grep -q '^predicted .* cycles, before any was simulated$' .out || fail "the default chip: $(cat .out)"
render some --size 96x64 --sampled --set special.pipelined=false
grep -q '; uncertain: the model is not fitted to special.pipelined$' .out || fail "another unit: $(cat .out)"
render some --size 96x64 --sampled --program "$bin/../lib/trax/trax-raytracer.elf" --nodes binary
grep -q '; uncertain: the model is not fitted to another program$' .out || fail "another program: $(cat .out)"
render some --size 96x64 --sampled --paths 2
grep -q '; uncertain: the model is not fitted to another workload$' .out || fail "another workload: $(cat .out)"

# --- the same for any number of host threads, and as precise as asked
render one --size 320x180 --sampled --threads 1
render two --size 320x180 --sampled --threads 2
grep -v host_ one.json >one.txt
grep -v host_ two.json >two.txt
cmp -s one.txt two.txt || fail "--threads 2: other figures"
grep -q '^sampled .* cycles with 95 % confidence, .* of the slots in [0-9]* ranges simulated$' .out || fail "$(cat .out)"
render longer --size 320x180 --sampled --sample-unit 1000 --sample-warm-up 100 # whole blocks of 32
[ "$(number longer.json unit) $(number longer.json warm_up)" = "1024 128" ] || fail "--sample-unit, --sample-warm-up"
render rough --size 320x180 --config 1x32 --sampled --sample-error 10
render fine --size 320x180 --config 1x32 --sampled --sample-error 3
is "$(number fine.json windows) > $(number rough.json windows)" || fail "--sample-error: no more ranges"
is "$(number fine.json cycles_high) <= 1.030001 * $(number fine.json cycles)" || fail "--sample-error 3: the interval"

# --- another order of pixels; a program that counts them nowhere
if [ -e "$bin/../lib/trax/trax-era.elf" ]; then
  render exact --size 240x136 --config 1x32 --program "$bin/../lib/trax/trax-era.elf"
  render some --size 240x136 --config 1x32 --program "$bin/../lib/trax/trax-era.elf" --sampled --sample-fraction 0.2
  is "$(number some.json cycles) / $(number exact.json cycles) < 1.1 && $(number some.json cycles) / $(number exact.json cycles) > 0.9" ||
    fail "era: far off: $(number some.json cycles) for $(number exact.json cycles)"
  [ "$(number some.json rays)" = "$(number exact.json rays)" ] || fail "era: $(number some.json rays) rays, not $(number exact.json rays)"
fi
# --- what costs much is drawn more often, and stands for no more of the picture than it is: a pixel is stored once, whatever it cost
if [ -e "$bin/../lib/trax/trax-era.elf" ]; then
  "$bin/trax-render" /usr/share/glmark2/models/bunny.obj --fov 60 --size 320x180 --config 1x32 --program "$bin/../lib/trax/trax-era.elf" --sampled \
    --sample-fraction 0.2 -q --stats bunny.json -o bunny.png || fail "the bunny"
  stored=$(sed -n '/"nontemporal": {/,/}/s/.*"stores": \([0-9]*\).*/\1/p' bunny.json | head -n 1)
  is "$stored > 0.9 * 57600 && $stored < 1.1 * 57600" || fail "$stored of 57600 pixels stored"
fi

refuse() {
  pattern=$1
  shift
  rm -f x.png
  "$bin/trax-render" $scene -o x.png --size 64x36 "$@" >.out 2>.err && fail "$*: no error"
  grep -q -- "$pattern" .err || fail "$*: '$(cat .err)' does not match '$pattern'"
  [ -e x.png ] && fail "$*: left a picture"
}
printf 'int main(void) { return 0; }\n' >nothing.c
"$bin/clang" --target=trax -O2 nothing.c -o nothing.elf || fail "nothing.c"
refuse 'scene' --sampled --program nothing.elf
printf '#include <trax.h>\nstruct trax_buffer scene, image;\nint main(void) { return scene.size + image.size == 0; }\n' >still.c
"$bin/clang" --target=trax -O2 still.c -o still.elf || fail "still.c"
refuse 'neither next_slot nor next_pixel' --sampled --program still.elf
printf '#include <trax.h>\nstruct trax_buffer scene, image;\nunsigned next_slot;\nint main(void) { return scene.size + image.size + next_slot == 0; }\n' >idle.c
"$bin/clang" --target=trax -O2 idle.c -o idle.elf || fail "idle.c"
refuse 'not taken by increments' --sampled --program idle.elf --size 320x180
printf '#include <trax.h>\nstruct trax_buffer scene, image;\nunsigned next_slot[65];\nint main(void) { return scene.size + image.size + next_slot[64] == 0; }\n' >many.c
"$bin/clang" --target=trax -O2 many.c -o many.elf || fail "many.c"
refuse 'next_slot has 65 queues; allowed are 64 at most' --sampled --program many.elf
refuse 'no interval is narrower than plus and minus 1 %' --sampled --sample-error 1
refuse 'and 1.10 % would take more ranges than there is work for' --sampled --sample-error 1.1 --size 320x180 --config 1x32
for value in 0 1.5 -0.1 nan 5%; do
  refuse '--sample-fraction: .* is not a number above' --sampled --sample-fraction "$value"
done
for value in 0 51 -1 x; do
  refuse '--sample-error: .* is not per cent' --sampled --sample-error "$value"
done
for option in fraction error; do
  refuse "--sample-$option: the value is empty" --sampled --sample-$option ''
done
for option in seed unit warm-up; do
  refuse 'is not a whole number' --sampled --sample-$option 0
  refuse 'is not a whole number' --sampled --sample-$option 2.5
  refuse 'are for --sampled' --sample-$option 3
done
refuse 'is not a whole number' --sampled --sample-unit 99999999
refuse 'one follows from the other' --sampled --sample-fraction 0.5 --sample-error 2
refuse 'engine fast' --sampled --engine reference
refuse 'engine fast' --sampled --engine native
refuse 'nothing to compare' --sampled --compare
refuse 'nothing to compare' --sampled --explore x.html
refuse 'nothing to compare' --sampled --cost-picture y.png

[ $failures -eq 0 ] && echo "sampled runs as expected"
exit $((failures > 0))
