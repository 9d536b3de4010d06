#!/usr/bin/env bash
# The part of package_test.sh that runs inside the new Debian.
set -euo pipefail
cd /root/package
quietly() { "$@" >log 2>&1 || { tail -n 20 log >&2; echo "FAILED: $*" >&2; exit 1; }; }
expect() { # expect TEXT COMMAND...: the command succeeds and prints the text
  local text=$1
  shift
  "$@" >log 2>&1 || { cat log >&2; echo "FAILED: $*" >&2; exit 1; }
  grep -qF -- "$text" log || { cat log >&2; echo "FAILED: $*: there is no \"$text\"" >&2; exit 1; }
  echo "works: $*"
}

quietly apt-get update -q
quietly apt-get install -q -y --no-install-recommends ./trax_*.deb
! command -v clang >/dev/null || { echo "FAILED: the package has a program called clang" >&2; exit 1; }

printf '#include <stdio.h>\nint main(void) { puts("hello"); }\n' >hello.c
printf '#include <array>\n#include <cstdio>\nint main() { std::array<int, 3> a{1, 2, 3}; std::printf("%%d\\n", a[0] + a[1] + a[2]); }\n' >sum.cpp
quietly trax-clang --target=trax -O2 -g hello.c -o hello
expect hello trax-sim hello
quietly trax-clang++ -O2 sum.cpp -o sum # the name alone chooses the target
expect 6 trax-sim sum
expect main trax-objdump -d hello
expect cycles trax-render generate:forest --view forest --size 32x18 --config 1x32 -o picture.png
expect identical trax-render generate:forest --view forest --size 32x18 --config 1x32 --paths 2 --compare -o picture.exr
echo '{"name": "x", "scenes": [{"name": "f", "meshes": ["generate:forest"], "view": "forest"}], "programs": "ours", "chips": "1x32", "size": "16x9"}' >sweep.json
quietly trax-eval sweep.json . -o out
expect '"runs"' cat out/results.json

for program in trax-clang trax-clang++ trax-compare trax-eval trax-ld trax-mc trax-objdump trax-render trax-scene trax-sim; do quietly "$program" --version; done
quietly apt-get install -q -y --no-install-recommends man-db
for page in trax-clang trax-clang++ trax-compare trax-eval trax-ld trax-mc trax-objdump trax-render trax-scene trax-sim; do
  expect "SYNOPSIS" man "$page"
done
for page in trax-clang trax-clang++ trax-compare trax-eval trax-ld trax-mc trax-objdump trax-render trax-scene trax-sim; do
  expect "complete" bash -c ". /usr/share/bash-completion/completions/$page && complete -p $page"
done

quietly apt-get install -q -y --no-install-recommends cmake make gcc g++ pkgconf libelf-dev libdw-dev libconfig-dev libjansson-dev libxxhash-dev zlib1g-dev
quietly cmake -S install -B host
quietly cmake --build host
expect "sum 4950" host/host host/device.elf
quietly cmake -S install -B tp -DCMAKE_TOOLCHAIN_FILE=/usr/lib/trax/trax-toolchain.cmake
quietly cmake --build tp
expect "sum 4950" trax-sim tp/device.elf
pkg-config --cflags --libs trax-emulator >flags.txt
quietly cc install/host.c @flags.txt -o by-pkg-config
expect "sum 4950" ./by-pkg-config host/device.elf

quietly apt-get install -q -y --no-install-recommends python3-cffi python3-numpy
expect "sum 4950" python3 -c 'import trax; print(trax.Machine("host/device.elf").run().output); trax.compile("hello.c")'

quietly apt-get install -q -y --no-install-recommends lintian
lintian --allow-root --fail-on error ./trax_*.deb || { echo "FAILED: lintian has errors" >&2; exit 1; }
quietly apt-get remove -q -y trax
[ ! -e /usr/lib/trax ] || { echo "FAILED: /usr/lib/trax is still there after the package was removed" >&2; exit 1; }
echo "the package works"
