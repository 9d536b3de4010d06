# The head of this folder's test scripts: $1 is the folder of the programs. They begin in a folder of their own, $work, which
# goes when they end, and count what fails in $failures. Their programs are in a cache of this folder's tests.
set -u
bin=$1
source=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
failures=0
export XDG_CACHE_HOME="${XDG_CACHE_HOME:-$work}/render"

fail() {
  echo "FAILED: $*"
  failures=$((failures + 1))
}
