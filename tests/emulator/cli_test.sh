#!/bin/sh
# cli_test.sh TRAX_SIM EMULATOR_PROGRAMS: programs, buffers, statistics, checkpoints and configurations of trax-sim, and what
# it says when something is wrong. options_test.py has the values of each option, endings_test.py interrupts and progress,
# tests/commands outputs.
set -u
export LC_ALL=C
sim=$1
machines=$(cd "$(dirname "$0")/../../emulator/machines" && pwd) || exit 1
directory=$(mktemp -d) || exit 1
trap 'chmod -R u+w "$directory"; rm -rf "$directory"' EXIT
"$2" "$directory" || exit 1
cd "$directory" || exit 1
failures=0

fail() {
  printf 'FAILED: %s\n' "$*"
  sed 's/^/    /' out err
  failures=$((failures + 1))
}

# run STATUS ARGUMENT...: standard output goes to `out`, standard error to `err`.
run() {
  expected=$1
  shift
  timeout 60 "$sim" "$@" >out 2>err
  status=$?
  [ "$status" -eq "$expected" ] || fail "status $status, not $expected, of: $*"
  command="$*"
}

says() { grep -qF -e "$1" err || fail "\"$1\" is not in what is said by: $command"; }
prints() { grep -qF -e "$1" out || fail "\"$1\" is not printed by: $command"; }
silent() { [ ! -s err ] || fail "something is said by: $command"; }
nothing() { [ ! -s out ] || fail "something is printed by: $command"; }
absent() { [ ! -e "$1" ] || fail "$1 exists after: $command"; }
# Nothing but what is listed: no temporary file is left.
no_litter() {
  for file in *; do
    case $file in *.elf | out | err | *.cfg | *.json | *.txt | *.bin | closed | link) ;; *) fail "$file is left by: $command" ;; esac
  done
}
# refuse MESSAGE ARGUMENT...: an error of use, with status 1, one line and no output.
refuse() {
  message=$1
  shift
  run 1 "$@"
  says "trax-sim: error: "
  says "$message"
  nothing
  [ "$(wc -l <err)" -eq 1 ] || fail "more than a line is said by: $command"
  no_litter
}

# --- running programs
run 0 hello.elf
[ "$(cat out)" = hello ] || fail "hello.elf"
silent
run 3 exit3.elf
silent
nothing
run 3 --config 4x32 exit3.elf
run 3 -- exit3.elf
run 1 null.elf
says "trax-sim: fault: access to the null page"
says "outer+0x8, inner at dir/source.c:5:3"
nothing
run 134 abort.elf
says "out of luck"
run 124 spin.elf --max-cycles 10000
says "the program has not ended after 10000 cycles; the statistics are partial"
run 124 spin.elf --max-cycles=0x100

# --- buffers
printf 'twelve bytes' >input.bin
run 0 --bind input=input.bin --alloc output=64 --dump output=output.bin copy.elf
silent
nothing
{ cat input.bin; head -c 52 /dev/zero; } >expected.bin
cmp -s output.bin expected.bin || fail "output.bin is not the copy"
run 0 copy.elf --alloc=input=0 --alloc output=0 --dump output=empty.bin
[ -f empty.bin ] && [ ! -s empty.bin ] || fail "empty.bin"
refuse "the program has no symbol scene" --scene input.bin copy.elf
refuse "no buffer output is bound" --dump output=x.bin copy.elf
refuse "buffer input is bound twice" --alloc input=4 --bind input=input.bin copy.elf
refuse "does not fit into memory" --alloc input=2000000000 copy.elf
refuse "buffer input: nowhere.bin: cannot be read" --bind input=nowhere.bin copy.elf
absent x.bin

# --- statistics
run 0 --config 2x32 --stats stats.json --report report.txt mix.elf
silent
nothing
grep -q '"status": "finished"' stats.json || fail "stats.json"
grep -q '"rays": 3200' stats.json || fail "stats.json: rays"
grep -q 'threads x cycles, as it must be' report.txt || fail "report.txt"
grep -q 'tps_per_tm = 32;' report.txt || fail "report.txt: configuration"
run 0 --report quick.txt --config 2x32 --quiet mix.elf
# slow ROW REASON OPTIONS...: the report has the row with the reason, and that of the plain machine does not; the
# reference engine, which has no such paths, has the same statistics.
slow() {
  row=$1 reason=$2
  shift 2
  run 0 --config 2x32 --report report.txt --stats fast.json "$@" mix.elf
  grep "^  $row" report.txt | grep -q "$reason" || fail "report.txt with $*: no '$row' because of '$reason': $(sed -n '/^Slow/,/^$/p' report.txt)"
  ! grep "^  $row" quick.txt | grep -q "$reason" || fail "quick.txt: '$row' because of '$reason'"
  run 0 --config 2x32 --engine reference --report reference.txt --stats reference.json "$@" mix.elf
  ! grep -q '^Slow paths' reference.txt || fail "reference.txt"
  grep -v host_second fast.json >fast.txt
  grep -v host_second reference.json | cmp -s - fast.txt || fail "the engines differ with $*"
}
grep -q '^Slow paths' quick.txt || fail "quick.txt"
slow "TMs cycle by cycle" "(memory.latency_cycles)" --set memory.latency_cycles=10
slow "TMs cycle by cycle" "(l2.latency_cycles)" --set l2.bytes=524288 --set l2.latency_cycles=15
slow "TMs cycle by cycle" "(memory.latency_cycles)" --set memory.model=dram --set memory.latency_cycles=9
slow "fetches bank by bank .* 100.00 % of the cycles" "icache.tps_per_cache is not 16" --set icache.tps_per_cache=8
slow "fetches bank by bank .* 100.00 % of the cycles" "icache.ports_per_bank is above 1" --set icache.ports_per_bank=2
slow "fetches bank by bank .* 100.00 % of the cycles" "icache.banks is above 16" --set icache.banks=32
slow "adders group by group .* 100.00 % of the cycles" "do not have one adder and one multiplier each" --set fpu.adders_per_cluster=2
slow "data banks one by one .* 100.00 % of the cycles" "more than 8 banks" --set dcache.tps_per_bank=2
slow "TMs cycle by cycle .* of the cycles" "the memory latency is too short" --set memory.latency_cycles=1
grep '^  TMs cycle by cycle' quick.txt | grep -q 'stops close together (0 cycles)' || fail "quick.txt: stops"
run 0 --config 2x32 --report report.txt --checkpoint often.bin --checkpoint-every 10 mix.elf
grep '^  TMs cycle by cycle' report.txt | grep -q ' 9[0-9.]* % of the cycles: .* stops close together ([1-9][0-9]* cycles)' ||
  fail "report.txt: checkpoints in every tenth cycle"
run 0 --stats - hello.elf
prints hello
prints '"cycles": '
run 0 --report - hello.elf
prints "Thread-cycles by cause"
run 0 --config 2x32 --stats again.json mix.elf
for file in stats again; do grep -vE 'host_second' $file.json >$file.txt; done
cmp -s stats.txt again.txt || fail "two runs differ"
run 1 --stats stats.json null.elf
grep -q '"status": "fault"' stats.json || fail "stats.json of a fault"
run 124 --stats stats.json --max-cycles 1000 spin.elf
grep -q '"status": "limit"' stats.json || fail "stats.json of a program that was stopped at its limit"
grep -q '"exit_status": null' stats.json || fail "stats.json of a program without an exit status"
grep -q '"cycles": 1000,' stats.json || fail "stats.json: --max-cycles"

# --- without time
# --- signatures
cat >expected.txt <<'end'
fedcba98
0000002a
fault null pc 00001018 address 00000004
end
for engine in reference fast functional; do
  run 1 --engine $engine --signature signature.txt signature.elf
  cmp -s expected.txt signature.txt || fail "signature in the engine $engine"
  rm -f signature.txt
done
run 1 --signature - signature.elf
cmp -s expected.txt out || fail "signature on standard output"
refuse "copy.elf: the program has no symbol begin_signature, and so no signature" --signature signature.txt copy.elf
absent signature.txt
run 124 --signature signature.txt --max-cycles 3 signature.elf
absent signature.txt

run 0 --engine functional hello.elf
[ "$(cat out)" = hello ] || fail "hello.elf"
run 3 --config 4x32 --engine functional exit3.elf
run 1 --engine functional null.elf
says "outer+0x8, inner at dir/source.c:5:3"
run 134 --engine functional abort.elf
says "out of luck"
run 124 --engine functional spin.elf --max-cycles 10000
says "the program has not ended after 10000 instructions of a thread"
run 0 --engine functional --bind input=input.bin --alloc output=64 --dump output=output.bin copy.elf
cmp -s output.bin expected.bin || fail "output.bin is not the copy"
run 0 --config 2x32 --stats stats.json mix.elf
run 0 --config 2x32 --engine functional --stats timeless.json --report timeless.txt mix.elf
for key in rays items instructions flops; do
  [ "$(grep -m1 "\"$key\"" timeless.json)" = "$(grep -m1 "\"$key\"" stats.json)" ] || fail "timeless.json: $key"
done
grep -q '"cycles": 0,' timeless.json || fail "timeless.json: cycles"

# --- checkpoints: the run goes on as if nothing had been, in every figure and byte
run 0 --config 4x32 --stats stats.json --bind input=input.bin --alloc output=64 --dump output=output.bin copy.elf
cycles=$(sed -n 's/^  "cycles": \(.*\),/\1/p' stats.json)
for at in 1 $((cycles / 3)) $((cycles / 2)) $((cycles - 1)); do
  run 124 --config 4x32 --max-cycles $at --checkpoint checkpoint.bin --bind input=input.bin --alloc output=64 copy.elf
  rm -f output.bin
  run 0 --config 4x32 --resume checkpoint.bin --stats again.json --bind input=input.bin --alloc output=64 --dump output=output.bin copy.elf
  silent
  for file in stats again; do grep -vE 'host_second' $file.json >$file.txt; done
  cmp -s stats.txt again.txt || fail "checkpoint at $at: other statistics"
  cmp -s output.bin expected.bin || fail "checkpoint at $at: output.bin"
done
run 0 --config 2x32 --stats stats.json mix.elf
run 0 --config 2x32 --checkpoint checkpoint.bin --checkpoint-every 1000 --checkpoint-at 1500 --stats again.json mix.elf
for file in stats again; do grep -vE 'host_second' $file.json >$file.txt; done
cmp -s stats.txt again.txt || fail "a run that writes checkpoints: other statistics"
run 0 --config 2x32 --resume checkpoint.bin --stats again.json mix.elf
grep -vE 'host_second' again.json >again.txt
cmp -s stats.txt again.txt || fail "the last of several checkpoints: other statistics"
refuse "checkpoint.bin: a checkpoint of another program, machine, or buffer" --config 4x32 --resume checkpoint.bin mix.elf
refuse "checkpoint.bin: a checkpoint of another program, machine, or buffer" --config 2x32 --resume checkpoint.bin spin.elf
refuse "checkpoint.bin: a checkpoint of another program, machine, or buffer" --config 2x32 --set memory.latency_cycles=99 --resume checkpoint.bin mix.elf
refuse "hello.elf: not a checkpoint" --resume hello.elf hello.elf
head -c 2000 checkpoint.bin >cut.bin
refuse "cut.bin: truncated or damaged" --config 2x32 --resume cut.bin mix.elf
refuse "need --checkpoint" --checkpoint-at 5 hello.elf
refuse "are for the engine fast, not functional" --checkpoint c.bin --engine functional hello.elf

# --- watchdog: the same from both engines
for engine in fast reference; do
  run 124 --engine $engine --config 2x32 --watchdog 10000 --stats stats.json idle.elf
  says "no thread has ended, and no ray, item or output was seen, between the cycles 10000 and 20000"
  says "64 threads, as 0: issued "
  says " icache_bank_conflict "
  says "the statistics are partial"
  grep -q '"cycles": 20000,' stats.json || fail "stats.json of the watchdog"
done
run 124 --max-cycles 30000 --watchdog 10000 spin.elf # which counts items
says "has not ended after 30000 cycles"
run 3 --watchdog 10000 exit3.elf
refuse "--watchdog needs the engine fast, reference or simt, not functional" --watchdog 5 --engine functional hello.elf

# --- standard output
"$sim" hello.elf >/dev/full 2>err
[ $? -eq 1 ] || fail "a full standard output is no error"
command="hello.elf >/dev/full"
says "standard output cannot be written: No space left on device"
"$sim" --help-config >/dev/full 2>err && fail "a full standard output is no error for --help-config"

# --- options
refuse "no program is given"
refuse "unknown option --sats; did you mean --stats?" --sats x.json hello.elf
refuse "unknown option -v" -v hello.elf
refuse "'exit3.elf' follows hello.elf, whose main has no parameters: it takes no arguments" hello.elf exit3.elf
refuse "missing.elf: cannot be read: No such file or directory" missing.elf word
refuse "--engine: 'slow' is not fast, reference, functional or simt" --engine slow hello.elf
refuse 'is not fast, reference, functional or simt' --engine sampled hello.elf
refuse '--sample has been removed; for estimates use trax-render --sampled' --sample window=100 hello.elf
refuse '--bench-modes has been removed; run with --engine fast and --engine functional' --bench-modes hello.elf
refuse "--dump: 'output=q.jpg:160x90' has no writer for such pictures" --alloc input=4 --alloc output=57600 --dump output=q.jpg:160x90 copy.elf
refuse "has no writer for such pictures" --alloc input=4 --alloc output=57600 --dump output=q:160x90 copy.elf
refuse "input.bin: not an ELF file" input.bin
head -c 300 hello.elf >cut.elf
refuse "cut.elf: truncated or corrupt" cut.elf
refuse "no file and no preset \"4x31\" (did you mean" --config 4x31 hello.elf
refuse "./none.cfg: cannot be read" --config ./none.cfg hello.elf

# --- configuration: printed, and read back as it was, for every preset
presets=$("$sim" --help-config | sed -n 's/^Presets.*: //p')
[ "$(echo "$presets" | wc -w)" -eq 15 ] || fail "not fifteen presets: $presets"
for preset in $presets; do
  "$sim" --config "$preset" --set memory.bandwidth_gbps=12.8 --set special.pipelined=true --print-config >first.cfg || fail "$preset"
  run 0 --config first.cfg --print-config
  cmp -s first.cfg out || fail "$preset is not read back as it was"
  run 0 --config "$preset" --set "chip.tms=1" --set "chip.tps_per_tm=1" --print-config
  mv out single.cfg
  run 0 --print-config
  cmp -s single.cfg out || fail "$preset differs from the default in more than its TMs and TPs"
done
for machine in "$machines"/*.cfg; do # the examples: no longer than a page, read back, and programs run on them
  [ "$(wc -l <"$machine")" -le 50 ] || fail "$machine is no longer short"
  "$sim" --config "$machine" --print-config >first.cfg || fail "$machine"
  run 0 --config first.cfg --print-config
  cmp -s first.cfg out || fail "$machine is not read back as it was"
  run 0 --config "$machine" --stats stats.json --report report.txt mix.elf
  grep -q '"rays": 12800' stats.json || fail "stats.json of $machine: rays"
done
run 0 --config "$machines/modern.cfg" --stats stats.json --report report.txt mix.elf
[ "$(grep -c '"channel": ' stats.json)" -eq 4 ] || fail "stats.json: channels"
grep -q '"merged": [1-9]' stats.json && grep -q '^  l2.misses ' report.txt || fail "statistics of the second-level cache"
run 0 --config "$machines/modern.cfg" --set l2.bytes=0 --stats stats.json mix.elf
refuse "dcache.line_bytes is 64; it must not be more than l2.line_bytes = 32" --set l2.bytes=4096 --set l2.line_bytes=32 \
  --set icache.line_bytes=32 hello.elf
refuse "l2.bytes is 256; it must hold l2.ways = 8 lines of l2.line_bytes = 64" --set l2.bytes=256 hello.elf
refuse "l2.bytes is 100; allowed are 0 and the powers of two from 1 to 268435456 bytes" --set l2.bytes=100 hello.elf
refuse "icache.line_bytes is 128; it must not be more than memory.interleave_bytes = 64" --set memory.channels=2 \
  --set memory.interleave_bytes=64 --set icache.line_bytes=128 hello.elf
printf 'preset = "2x32";\nmemory: {\n  latency = 5;\n};\n' >bad.cfg
refuse "bad.cfg:3: unknown key \"memory.latency\"" --config bad.cfg hello.elf
run 0 --set chip.tms=2 --config 4x32 --print-config # --set is applied last, wherever it stands
prints "tms = 2;"

[ $failures -eq 0 ] || { printf '%d failures\n' $failures; exit 1; }
