#!/usr/bin/env bash
# Sets everything up and runs all tests; arguments go to ctest, as in ./test.sh -R timing
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
./setup.sh
exec ctest --test-dir build --output-on-failure --no-tests=error -j "${JOBS:-$(nproc)}" "$@"
