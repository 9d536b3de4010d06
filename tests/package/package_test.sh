#!/usr/bin/env bash
# Makes the Debian package and uses it in a Debian of its own, where nothing else of trax is:
# Usage: tests/package/package_test.sh BUILD ROOT SUITE
# BUILD is a build folder of the same release. ROOT is made with debootstrap (SUITE: bookworm or trixie) if it is not there. Needs root and
# a mirror (MIRROR, default http://deb.debian.org/debian). Exit status 0 if everything works there and lintian has no errors.
set -euo pipefail
[ $# = 3 ] || { sed -n '3,5s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" >&2; exit 1; }
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
build=$1 root=$(realpath -m "$2") suite=$3
[ "$(id -u)" = 0 ] || { echo "package_test.sh: error: this needs root" >&2; exit 1; }

packed=$(mktemp -d)
unmount() { umount "$root/proc" "$root/dev/null" 2>/dev/null || true; rm -rf "$packed"; }
trap unmount EXIT
cpack --config "$build/CPackConfig.cmake" -B "$packed" >"$packed/log" || { cat "$packed/log" >&2; exit 1; }
package=$(echo "$packed"/trax_*_*.deb)
[ -f "$package" ] || { cat "$packed/log" >&2; exit 1; }
dpkg-deb --info "$package"

[ -d "$root/usr" ] || debootstrap --variant=minbase "$suite" "$root" "${MIRROR:-http://deb.debian.org/debian}" >"$packed/log" || { tail "$packed/log" >&2; exit 1; }
mountpoint -q "$root/proc" || mount -t proc proc "$root/proc"
[ -c "$root/dev/null" ] || { touch "$root/dev/null" && mount --bind /dev/null "$root/dev/null"; }
cp /etc/resolv.conf "$root/etc/resolv.conf"
rm -rf "$root/root/package" && mkdir -p "$root/root/package"
cp -r "$package" "$here/in_root.sh" "$here/../clang/Inputs/install" "$root/root/package"
chroot "$root" env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive bash /root/package/in_root.sh
