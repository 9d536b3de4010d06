/* The triangles of a scene as the judge sees them: with instances, those of each at its place. */
#include "exact.h"
#include "placed.h"
#include "render.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static double norm(const double m[3][3]) {
  double most = 0;
  for (int row = 0; row < 3; row++)
    most = fmax(most, fabs(m[row][0]) + fabs(m[row][1]) + fabs(m[row][2]));
  return most;
}

/* Gauss and Jordan's elimination: the importer takes cofactors. */
static void invert(double out[3][3], const double m[3][3]) {
  double rows[3][6] = {{0}};
  for (int row = 0; row < 3; row++) {
    memcpy(rows[row], m[row], sizeof m[row]);
    rows[row][3 + row] = 1;
  }
  for (int column = 0; column < 3; column++) {
    int pivot = column;
    for (int row = column + 1; row < 3; row++)
      if (fabs(rows[row][column]) > fabs(rows[pivot][column]))
        pivot = row;
    for (int i = 0; i < 6; i++) {
      const double value = rows[pivot][i];
      rows[pivot][i] = rows[column][i];
      rows[column][i] = value;
    }
    for (int row = 0; row < 3; row++) {
      const double factor = row == column ? 0 : rows[row][column] / rows[column][column];
      for (int i = 0; i < 6; i++)
        rows[row][i] -= factor * rows[column][i];
    }
  }
  for (int row = 0; row < 3; row++)
    for (int i = 0; i < 3; i++)
      out[row][i] = rows[row][3 + i] / rows[row][row];
}

static void set_place(struct exact_place *place, const struct trax_instance *instance) {
  double m[3][3];
  for (int row = 0; row < 3; row++) {
    for (int column = 0; column < 3; column++) {
      place->matrix[row][column] = instance->to_world[row][column];
      m[row][column] = (double)instance->to_world[row][column];
    }
    place->matrix[row][3] = instance->origin[row];
  }
  invert(place->inverse, (const double(*)[3])m);
  place->spread = 0x1p-19 * norm((const double(*)[3])m) * norm((const double(*)[3])place->inverse);
}

static struct exact_triangle triangle_of(const struct trax_scene *scene, uint32_t number,
                                         const struct exact_place *place) {
  struct exact_triangle out = {.place = place};
  const struct trax_triangle *triangle = &scene->triangles[number];
  memcpy(out.vertex[0], triangle->v0, sizeof triangle->v0);
  memcpy(out.vertex[1], triangle->v1, sizeof triangle->v1);
  memcpy(out.vertex[2], triangle->v2, sizeof triangle->v2);
  return out;
}

uint32_t exact_triangles(struct exact_triangle **triangles, struct exact_place **places,
                         const struct trax_scene *scene) {
  uint32_t count = scene->instances ? 0 : scene->triangle_count, next = 0;
  for (uint32_t i = 0; i < scene->instance_count; i++)
    count += scene->meshes[scene->instances[i].mesh].triangle_count;
  *triangles = calloc(count + (size_t)1, sizeof **triangles);
  *places = calloc(scene->instance_count + (size_t)1, sizeof **places);
  if (!*triangles || !*places)
    abort();
  for (uint32_t i = 0; i < scene->triangle_count && !scene->instances; i++)
    (*triangles)[i] = triangle_of(scene, i, NULL);
  for (uint32_t i = 0; i < scene->instance_count; i++) {
    const struct trax_scene_mesh *mesh = &scene->meshes[scene->instances[i].mesh];
    set_place(&(*places)[i], &scene->instances[i]);
    for (uint32_t k = 0; k < mesh->triangle_count; k++)
      (*triangles)[next++] = triangle_of(scene, mesh->first_triangle + k, &(*places)[i]);
  }
  return count;
}

int64_t exact_number(const struct trax_scene *scene, const struct query_answer *answer) {
  const uint32_t number = trax_number_of_hit(scene, answer->triangle, answer->instance);
  return number == TRAX_NO_TRIANGLE ? -1 : (int64_t)number;
}

int64_t exact_source(const struct trax_scene *scene, const struct query_answer *answer) {
  const int64_t number = exact_number(scene, answer);
  return number < 0 ? number : (int64_t)trax_source_of(scene, (uint32_t)number);
}
