#!/usr/bin/env bash
# cpack without the programs that find a package's dependencies: it names the Debian package that has the program, and makes none itself.
# Usage: tools_test.sh BUILD CPACK
set -u
build=$1 cpack=$2
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
failures=0
for missing in dpkg-shlibdeps:dpkg-dev file:file; do
  rm -rf "$work/bin" "$work/package" && mkdir "$work/bin"
  for program in bash sh gzip strip objdump dpkg dpkg-architecture dpkg-shlibdeps file; do
    [ "$program" = "${missing%:*}" ] || { command -v "$program" >/dev/null && ln -s "$(command -v "$program")" "$work/bin"; }
  done
  for other in dpkg-shlibdeps file; do # on a host that has neither
    [ "$other" = "${missing%:*}" ] || [ -e "$work/bin/$other" ] || ln -s /bin/true "$work/bin/$other"
  done
  if PATH=$work/bin "$cpack" -D CMAKE_FIND_USE_CMAKE_SYSTEM_PATH=OFF --config "$build/CPackConfig.cmake" -B "$work/package" >"$work/log" 2>&1; then
    echo "FAILED: without ${missing%:*} cpack ends with status 0"
    failures=1
  fi
  tr -s '\n ' '  ' <"$work/log" | grep -q "apt-get install ${missing#*:}" || { echo "FAILED: without ${missing%:*}:"; tail -n 5 "$work/log"; failures=1; }
  ls "$work"/package/*.deb 2>/dev/null && { echo "FAILED: without ${missing%:*} there is a package"; failures=1; }
done
exit $failures
