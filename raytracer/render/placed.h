/* Triangles by their numbers. In a scene with instances each instance has its mesh's triangles, and they are numbered
   through all instances as they are in the file; else a number is that of a triangle of the file. */
#ifndef TRAX_RENDER_PLACED_H
#define TRAX_RENDER_PLACED_H

#include "double3.h"
#include "trax/scene.h"

#include <stdbool.h>

struct placed_triangle {
  struct trax_triangle triangle;        /* in the scene, rounded, with the material that is seen */
  const struct trax_instance *instance; /* NULL: the scene has none */
  uint32_t stored;                      /* its number in the section of triangles */
  bool mirrored;
};

void trax_place(struct placed_triangle *out, const struct trax_scene *scene, uint32_t number);
/* Its normals, in the scene; of any length. */
void trax_place_normals(double out[3][3], const struct trax_scene *scene, const struct placed_triangle *triangle);

/* The number of a triangle, which like its instance is given by its place in the file, in bytes; TRAX_NO_TRIANGLE if no
   triangle is there. */
uint32_t trax_number_of_hit(const struct trax_scene *scene, uint32_t triangle, uint32_t instance);
/* The number among those that were imported; with instances, if all are flattened. */
uint32_t trax_source_of(const struct trax_scene *scene, uint32_t number);

/* The direction or, relative to the instance's origin, the point in the mesh. If instance is NULL, the value itself. */
struct double3 trax_to_object(const struct trax_instance *instance, struct double3 v);

#endif
