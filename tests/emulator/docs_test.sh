#!/bin/sh
# docs_test.sh TRAX_SIM EMULATOR_MD [--update]: a fenced block that begins with `$ trax-sim OPTION` must go on with what that
# command prints. --update puts it there.
set -eu
export LC_ALL=C
sim=$1
page=$2
expected=$(mktemp)
trap 'rm -f "$expected"' EXIT
inside=no
while IFS= read -r line; do
  case $inside$line in
  'yes```') inside=no ;;
  yes*) continue ;;
  'no$ trax-sim '*)
    inside=yes
    printf '%s\n' "$line"
    # shellcheck disable=SC2086 # the options are words
    "$sim" ${line#"$ trax-sim "}
    continue
    ;;
  esac
  printf '%s\n' "$line"
done <"$page" >"$expected"
if [ "${3-}" = --update ]; then
  cat "$expected" >"$page"
elif ! diff -u "$page" "$expected"; then
  printf '%s differs from what trax-sim prints; update it with: %s %s %s --update\n' "$page" "$0" "$sim" "$page"
  exit 1
fi
[ "$(grep -c '^\$ trax-sim ' "$page")" -ge 3 ] || { echo "$page has lost its blocks"; exit 1; }
