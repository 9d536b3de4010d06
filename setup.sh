#!/usr/bin/env bash
# Usage: ./setup.sh [--programs] [--quiet]
# Installs the packages that are missing, configures and builds into build/. A second run takes seconds.
#   --programs  only what it takes to compile, run and render; ./demo.sh uses it
#   --quiet     says nothing but errors
#   --help      says this
# Without --programs, the tests and what they need come too; ./test.sh uses it. Programs are in build/bin, what tests need in build/tests/bin.
# Works as root and with sudo, on Debian 12 and 13. The names of packages are also those of Ubuntu 24.04 as far as known; it was not tried there.
# JOBS=N sets the number of build jobs (default: all cores).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

quiet='' programs=''
for argument in "$@"; do
  case $argument in
    -h|--help) sed -n '2,10s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"; exit 0 ;;
    --quiet) quiet=1 ;;
    --programs) programs=1 ;;
    *) echo "setup.sh: unknown option '$argument' (--programs, --quiet, --help)" >&2; exit 1 ;;
  esac
done
say() { [ -n "$quiet" ] || echo "setup: $*"; }
die() { echo "setup.sh: error: $*" >&2; exit 1; }

# A|B is the first that the distribution has: Debian 12, Debian 13, Ubuntu 24.04.
packages=(
  cmake ninja-build gcc g++ pkg-config python3                            # to build
  llvm-19-dev libclang-19-dev libclang-common-19-dev libc++-19-dev
  libelf-dev libdw-dev libconfig-dev libjansson-dev libxxhash-dev         # linker, emulator
  libembree-dev libpng-dev libjpeg-dev libtinyexr-dev liblzma-dev zlib1g-dev libgmp-dev  # ray tracer's host side
  newlib-source                                                           # the mathematical functions of binary64
  glmark2-data                                                            # the demo's bunny
  draco                                                                   # trax-eval fetch-scenes: Crytek Sponza
)
test_packages=(
  make git llvm-19 llvm-19-tools clang-19                                 # the tutorial applies a patch with git
  libcmocka-dev libmpfr-dev gdb gdb-multiarch
  flake8 clang-format-19                                                  # the style of Python, of C and C++
  python3-cffi python3-numpy python3-pandas python3-pytest python3-pip    # the package for Python
  'chromium|chromium-browser'                                             # the evaluation's page in a browser
  mkdocs mkdocs-material                                                  # the pages as a site; PyYAML comes with them
  clangd-19 clang-tidy-19 meson                                           # recipes of docs/compiler.md
  csmith libcsmith-dev gcc-multilib libc6-dev-i386                        # random programs, and a host of 32 bits
  qemu-user lld-19 gcc-12-source libclang-rt-19-dev                        # longer checks: code quality, gcc's torture, fuzzers
)
[ -n "$programs" ] || packages+=("${test_packages[@]}")

is_installed() { [ "$(dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null || true)" = installed ]; }
# Those of the given packages that are not installed; of alternatives the one that can be.
find_missing() {
  missing=()
  for names in "$@"; do
    chosen=
    for name in ${names//|/ }; do
      if is_installed "$name"; then chosen=; continue 2; fi
      if [ -z "$chosen" ] && { [ "$name" = "$names" ] || [ -n "$(apt-cache madison "$name" 2>/dev/null)" ]; }; then chosen=$name; fi
    done
    missing+=("${chosen:-${names%%|*}}")
  done
}

command -v dpkg-query >/dev/null || die "this script installs Debian packages, and there is no dpkg here; install by hand: ${packages[*]}"
find_missing "${packages[@]}"
if [ ${#missing[@]} -gt 0 ]; then
  if [ "$(id -u)" = 0 ]; then as_root=(); elif command -v sudo >/dev/null; then as_root=(sudo); else
    die "packages are missing and neither root nor sudo is at hand: ${missing[*]}"
  fi
  log=$(mktemp)
  trap 'rm -f "$log"' EXIT
  install() { "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get "$@" >"$log" 2>&1; }
  begin=$SECONDS
  install update -q || { tail -n 5 "$log" >&2; die "apt-get update failed"; }
  find_missing "${packages[@]}" # alternatives are known now
  say "installing ${#missing[@]} packages and what they need: ${missing[*]}"
  install install -q -y --no-install-recommends "${missing[@]}" || { tail -n 15 "$log" >&2; die "apt-get install failed"; }
  # apt's own words: so many are new, so much to fetch, so much afterwards.
  new=$(sed -nE 's/.* ([0-9]+) newly installed.*/\1/p' "$log")
  fetched=$(sed -nE 's/^Need to get ([^ /]+)[^ ]* ([kMG]?B).*/\1 \2/p' "$log")
  size=$(sed -nE 's/^After this operation, (.*) of additional.*/\1/p' "$log")
  packages_time="$((SECONDS - begin)) s for ${new:-0} packages (${fetched:-0 B} fetched, ${size:-0 B} installed)"
else
  packages_time="0 s for packages, which are all installed"
fi

configure_time=0
# Configure again only where there is no usable build folder or tests are wanted for the first time: ninja itself notices changed CMake files.
configure() {
  begin=$SECONDS
  mkdir -p build
  cmake --preset release "$@" >build/configure.log 2>&1 || { cat build/configure.log >&2; die "cmake failed"; }
  configure_time=$((SECONDS - begin))
}
if [ ! -f build/build.ninja ]; then
  if [ -n "$programs" ]; then configure -DTRAX_TESTS=OFF; else configure; fi
elif [ -z "$programs" ] && grep -q '^TRAX_TESTS:BOOL=OFF' build/CMakeCache.txt; then
  configure -DTRAX_TESTS=ON
fi

target=${programs:+programs}
target=${target:-all}
say "building (${JOBS:-$(nproc)} jobs)"
begin=$SECONDS
if [ -t 1 ] && [ -z "$quiet" ]; then
  ninja -C build -j "${JOBS:-$(nproc)}" "$target"
else
  ninja -C build -j "${JOBS:-$(nproc)}" "$target" >build/build.log 2>&1 || { tail -n 60 build/build.log >&2; die "the build failed; all of it is in build/build.log"; }
fi
say "done in $SECONDS s: $packages_time, $configure_time s for configuring, $((SECONDS - begin)) s for building"
