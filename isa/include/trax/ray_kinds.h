/* The kinds of rays that the trap `kinds` counts (docs/isa.md, "Traps"). */
#ifndef TRAX_RAY_KINDS_H
#define TRAX_RAY_KINDS_H

/* Kinds of rays: Y(X, ID, name, number, meaning). The operand of the trap `kinds` has TRAX_KIND_BITS bits for each,
   kind 0 in the lowest. */
#define TRAX_RAY_KINDS(Y, X)                                                                                           \
  Y(X, PRIMARY, primary, 0, "from the eye")                                                                            \
  Y(X, SHADOW, shadow, 1, "towards a light")                                                                           \
  Y(X, OCCLUSION, occlusion, 2, "ambient occlusion: is something near the surface?")                                   \
  Y(X, DIFFUSE, diffuse, 3, "scattered by a diffuse surface")                                                          \
  Y(X, GLOSSY, glossy, 4, "scattered by a surface with a rough layer")                                                 \
  Y(X, MIRROR, mirror, 5, "reflected by a mirror or by glass")                                                         \
  Y(X, GLASS, glass, 6, "refracted by glass")                                                                          \
  Y(X, OTHER, other, 7, "of no stated kind, as all that the trap rays counts")

#define TRAX_RAY_KIND_COUNT 8
#define TRAX_KIND_BITS 4

#endif
