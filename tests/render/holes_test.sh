#!/bin/sh
# holes_test.sh BIN: --id-picture shows what the picture shows: not back faces with --one-sided, and not what is cut out.
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

# ids NAME ARGUMENTS...: the picture of triangles.
ids() {
  name=$1
  shift
  "$bin/trax-render" "$@" --size 32x32 --eye 0,0,6 --look-at 0,0,0 --fov 50 --light 3,4,5 -q -o x.png --id-picture "$name" 2>err || fail "$name: $(cat err)"
}
for engine in native embree; do
  ids alone.png alone.obj --engine $engine
  ids whole.png turned.obj --engine $engine
  ids turned.png turned.obj --engine $engine --one-sided
  ids cut.png cut.obj --engine $engine
  cmp -s alone.png whole.png && fail "$engine: the wall before the other is not seen"
  cmp -s alone.png turned.png || fail "$engine: a back face is seen with --one-sided"
  cmp -s alone.png cut.png || fail "$engine: what is cut out is seen"
done
exit $((failures > 0))
