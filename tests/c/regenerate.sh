#!/bin/sh
# Writes NAME.expected for every program here from a run on the host, except those whose expected output is by hand. The programs
# avoid what differs between the host and the TP (sizes of long and pointers, the sign of NaNs).
#   tests/c/regenerate.sh [PROGRAM.c ...]
set -eu
cd "$(dirname "$0")"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
[ $# -gt 0 ] || set -- *.c
for source in "$@"; do
  case $source in fault_* | buffers.c | integer_printf_is_small.c) continue ;; esac
  if grep -q 'xpected output by hand' "$source"; then
    continue
  fi
  compiler='gcc -std=gnu17'
  if grep -q 'xpected output by clang' "$source"; then
    compiler='clang-19 -std=gnu2x'
  fi
  $compiler -O1 -fwrapv -ffp-contract=off -w -I../../runtime/include -I../../isa/include "$source" -o "$work/program" -lm -latomic
  "$work/program" >"$work/output"
  mv "$work/output" "${source%.c}.expected"
done
