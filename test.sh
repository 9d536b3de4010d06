#!/usr/bin/env bash
# Sets everything up and runs all tests; arguments go to ctest, as in ./test.sh -R timing
#   ./test.sh [--quick] [CTEST OPTION…]
#   --quick   leaves out the tests of tests/slow.txt: at most two minutes once built
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

without=()
case ${1:-} in
  -h|--help) sed -n '2,4s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"; exit 0 ;;
  --quick)
    shift
    slow=$(sed 's/#.*//' tests/slow.txt | awk 'NF { printf "%s%s", separator, $1; separator = "|" }')
    without=(--exclude-regex "^($slow)\$") ;;
esac
./setup.sh
python3 -m compileall -q build/lib/trax/evaluation # trax-eval starts hundreds of times
jobs=${JOBS:-$(($(nproc) + 2))} # two more than processors: browsers, signals and others wait for part of their time
if [ ${#without[@]} -gt 0 ]; then
  tests=$(ctest --test-dir build -N | sed -n 's/^ *Test *#[0-9]*: //p')
  for name in ${slow//|/ }; do
    grep -qx "$name" <<<"$tests" || { echo "test.sh: error: tests/slow.txt: there is no test $name" >&2; exit 1; }
  done
  lit=$(grep -oE '/[^ "]*/lit\.py' build/tests/CTestTestfile.cmake | head -n 1)
  python3 "$lit" -sv -j "$jobs" build/tests/mc build/tests/codegen build/tests/tools # of the suites of the test lit
fi
exec ctest --test-dir build --output-on-failure --no-tests=error -j "$jobs" "${without[@]}" "$@"
