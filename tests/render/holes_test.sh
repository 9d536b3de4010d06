#!/bin/sh
# holes_test.sh BIN: --layers has what the picture shows: no back faces with --one-sided, and nothing that is cut out.
. "$(dirname "$0")/head.sh"
set -e
export LC_ALL=C

# A wall, and before it a smaller one: turned away, or of a material that is cut out.
wall() { # SIZE Z
  printf 'v -%s -%s %s\nv %s -%s %s\nv %s %s %s\nv -%s %s %s\n' "$1" "$1" "$2" "$1" "$1" "$2" "$1" "$1" "$2" "$1" "$1" "$2"
}
{ wall 2 0; echo 'f -4 -3 -2 -1'; } >alone.obj
{ cat alone.obj; wall 1 1; echo 'f -1 -2 -3 -4'; } >turned.obj
printf 'newmtl solid\nKd 1 1 1\nnewmtl air\nKd 1 1 1\nd 0\n' >air.mtl
{ echo 'mtllib air.mtl'; echo 'usemtl solid'; cat alone.obj; echo 'usemtl air'; wall 1 1; echo 'f -4 -3 -2 -1'; } >cut.obj

# layers NAME ARGUMENTS...
layers() {
  name=$1
  shift
  "$bin/trax-render" "$@" --size 32x32 --eye 0,0,6 --look-at 0,0,0 --fov 50 --light 3,4,5 -q --layers -o "$name" 2>err || fail "$name: $(cat err)"
}
# wrong_pixels NAME: how many pixels show other triangles than the wall alone.
wrong_pixels() {
  "$bin/trax-compare" --json --at-least 0 "$1" alone.exr | sed -n 's/.*"wrong_pixels": //p'
}
for engine in native embree; do
  layers alone.exr alone.obj --engine $engine
  layers whole.exr turned.obj --engine $engine
  layers turned.exr turned.obj --engine $engine --one-sided
  layers cut.exr cut.obj --engine $engine
  [ "$(wrong_pixels whole.exr)" = 0, ] && fail "$engine: the wall before the other is not seen"
  [ "$(wrong_pixels turned.exr)" = 0, ] || fail "$engine: a back face is seen with --one-sided"
  [ "$(wrong_pixels cut.exr)" = 0, ] || fail "$engine: what is cut out is seen"
done
exit $((failures > 0))
