/* Attributes of the corners of a mesh's triangles: normals and texture coordinates. */
#include "internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

bool scene_reach(void *array, size_t record_size, uint32_t count, size_t *capacity) {
  if (count <= *capacity)
    return true;
  size_t larger = *capacity ? *capacity : 1024;
  while (larger < count)
    larger *= 2;
  void **pointer = array;
  char *moved = realloc(*pointer, larger * record_size);
  if (!moved)
    return false;
  memset(moved + *capacity * record_size, 0, (larger - *capacity) * record_size);
  *pointer = moved;
  *capacity = larger;
  return true;
}

/* Coordinates beyond this many repeats move towards zero, where floats have more bits for a texel's place. */
#define ORDINARY_REPEATS 16

void scene_mend_uvs(struct trax_mesh *mesh, struct trax_import_report *report) {
  for (uint32_t i = 0; mesh->uvs && i < mesh->triangle_count; i++) {
    const uint32_t texture = mesh->materials[mesh->triangles[i].material].surface.texture;
    if (texture == 0)
      continue;
    const bool clamp = mesh->textures[texture - 1].flags & TRAX_TEXTURE_CLAMP;
    bool mended = false;
    for (int axis = 0; axis < 2; axis++) {
      float *const values[3] = {&mesh->uvs[i][0][axis], &mesh->uvs[i][1][axis], &mesh->uvs[i][2][axis]};
      float least = INFINITY, most = 0;
      for (int corner = 0; corner < 3; corner++) {
        if (!isfinite(*values[corner]))
          *values[corner] = 0, mended = true;
        least = fminf(least, *values[corner]);
        most = fmaxf(most, fabsf(*values[corner]));
      }
      for (int corner = 0; corner < 3; corner++) {
        if (most > ORDINARY_REPEATS && !clamp)
          *values[corner] -= floorf(least);
        if (fabsf(*values[corner]) > TRAX_SCENE_MAX_UV)
          *values[corner] = copysignf(TRAX_SCENE_MAX_UV, *values[corner]), mended = true;
      }
    }
    report->mended_uvs += mended;
  }
}
