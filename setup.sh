#!/usr/bin/env bash
# Installs the Debian packages that are missing, configures and builds into build/. A second run takes seconds.
#   ./setup.sh [--quiet]
# Works as root and with sudo. JOBS=N sets the number of build jobs (default: all cores).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

quiet=
for argument in "$@"; do
  case $argument in
    --quiet) quiet=1 ;;
    *) echo "setup.sh: unknown option '$argument' (only --quiet)" >&2; exit 1 ;;
  esac
done
say() { [ -n "$quiet" ] || echo "setup: $*"; }
die() { echo "setup.sh: error: $*" >&2; exit 1; }

packages=(
  cmake ninja-build make gcc g++ pkg-config python3 git                   # to build; the tutorial applies a patch with git
  llvm-19 llvm-19-dev llvm-19-tools libclang-19-dev libclang-common-19-dev clang-19 libc++-19-dev
  libelf-dev libdw-dev libconfig-dev libjansson-dev libxxhash-dev        # linker, emulator
  libassimp-dev libembree-dev libpng-dev libjpeg62-turbo-dev libopenexr-dev liblzma-dev zlib1g-dev libgmp-dev  # ray tracer's host side
  libcmocka-dev libmpfr-dev gdb gdb-multiarch                                                     # tests
  newlib-source                                                          # the mathematical functions of binary64
  gnuplot-nox                                                            # the evaluation's figures
  parallel chromium                                                      # tests: runs handed to GNU parallel; the evaluation's page in a browser
  slurmctld slurmd slurm-client                                          # tests: the same by Slurm; its services do nothing without a configuration
  csmith libcsmith-dev lib32gcc-12-dev libc6-dev-i386                    # tests: random programs, and a host of 32 bits
  glmark2-data                                                           # the demo's bunny
  qemu-user lld-19 gcc-12-source gcc-multilib libclang-rt-19-dev         # longer checks: code quality, gcc's torture, fuzzers
)

command -v dpkg-query >/dev/null || die "this script installs Debian packages, and there is no dpkg here; install by hand: ${packages[*]}"
missing=()
for package in "${packages[@]}"; do
  [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)" = installed ] || missing+=("$package")
done
if [ ${#missing[@]} -gt 0 ]; then
  say "installing ${#missing[@]} packages: ${missing[*]}"
  if [ "$(id -u)" = 0 ]; then as_root=(); elif command -v sudo >/dev/null; then as_root=(sudo); else
    die "packages are missing and neither root nor sudo is at hand: ${missing[*]}"
  fi
  log=$(mktemp)
  trap 'rm -f "$log"' EXIT
  install() { "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get "$@" >"$log" 2>&1; }
  install update -q || { tail -n 5 "$log" >&2; die "apt-get update failed"; }
  install install -q -y --no-install-recommends "${missing[@]}" || { tail -n 15 "$log" >&2; die "apt-get install failed"; }
else
  say "all packages are installed"
fi

# Configure again only where there is no usable build folder: ninja itself notices changed CMake files.
if [ ! -f build/build.ninja ]; then
  say "configuring into build/"
  mkdir -p build
  cmake --preset release >build/configure.log 2>&1 || { cat build/configure.log >&2; die "cmake failed"; }
fi
say "building (${JOBS:-$(nproc)} jobs)"
if [ -t 1 ] && [ -z "$quiet" ]; then
  ninja -C build -j "${JOBS:-$(nproc)}"
else
  ninja -C build -j "${JOBS:-$(nproc)}" >build/build.log 2>&1 || { tail -n 60 build/build.log >&2; die "the build failed; all of it is in build/build.log"; }
fi
say "done: programs are in build/bin"
