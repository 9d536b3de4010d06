/* Normals for smooth shading: those of the mesh's files or, where these have none, computed ones. At each corner a
   computed normal is the mean of the faces around it, weighted by area, without those that differ from the corner's own
   face by more than the crease angle. The faces around a corner are found by place, not by index, so the result does
   not depend on the format. Correctly rounded operations in binary64 give the same bytes everywhere. */
#include "internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The mean of all is taken if more faces meet at one place, as at the tip of a fine cone: angles would have to be
   compared pair by pair. */
enum { MOST_FACES = 64 };

/* If the mean differs more from the face's own normal, that is taken. */
#define LEAST_COSINE 0.1

struct corner {
  float place[3];
  uint32_t number; /* 3 * triangle + corner */
};

struct direction {
  double x, y, z;
};

static double dot(struct direction a, struct direction b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

static int compare_corners(const void *a, const void *b) {
  const struct corner *left = a, *right = b;
  for (int axis = 0; axis < 3; axis++)
    if (left->place[axis] != right->place[axis])
      return left->place[axis] < right->place[axis] ? -1 : 1;
  return left->number < right->number ? -1 : left->number > right->number;
}

static bool same_place(const struct corner *a, const struct corner *b) {
  return a->place[0] == b->place[0] && a->place[1] == b->place[1] && a->place[2] == b->place[2];
}

/* The face's normal, of a length of twice the area. */
static struct direction face_of(const float v0[3], const float v1[3], const float v2[3]) {
  struct direction e = {(double)v1[0] - v0[0], (double)v1[1] - v0[1], (double)v1[2] - v0[2]};
  struct direction f = {(double)v2[0] - v0[0], (double)v2[1] - v0[1], (double)v2[2] - v0[2]};
  return (struct direction){e.y * f.z - e.z * f.y, e.z * f.x - e.x * f.z, e.x * f.y - e.y * f.x};
}

/* Returns a vector of length 1; +z if a face has no direction. */
static struct direction unit(struct direction v) {
  double length = sqrt(dot(v, v));
  return length > 0 ? (struct direction){v.x / length, v.y / length, v.z / length} : (struct direction){0, 0, 1};
}

/* The corner's normal from all those at its place. */
static struct direction smooth_corner(const struct corner *group, size_t count, uint32_t number,
                                      const struct direction *faces, double least_cosine) {
  const struct direction own = unit(faces[number / 3]);
  struct direction sum = {0, 0, 0};
  for (size_t i = 0; i < count; i++) {
    struct direction face = faces[group[i].number / 3];
    if (count > MOST_FACES || dot(unit(face), own) >= least_cosine)
      sum.x += face.x, sum.y += face.y, sum.z += face.z;
  }
  sum = unit(sum);
  return dot(sum, own) >= LEAST_COSINE ? sum : own;
}

trax_status scene_smooth_normals(struct trax_triangle_normals *normals, const struct trax_triangle *triangles,
                                 uint32_t count, double crease_cosine, trax_error *error) {
  const size_t corner_count = 3 * (size_t)count;
  struct corner *corners = malloc((corner_count + 1) * sizeof *corners);
  struct direction *faces = malloc(((size_t)count + 1) * sizeof *faces);
  if (!corners || !faces || corner_count > UINT32_MAX) {
    free(corners);
    free(faces);
    return scene_out_of_memory(error, "normals");
  }
  for (uint32_t i = 0; i < count; i++) {
    const float *places[3] = {triangles[i].v0, triangles[i].v1, triangles[i].v2};
    faces[i] = face_of(places[0], places[1], places[2]);
    for (uint32_t k = 0; k < 3; k++) {
      corners[3 * i + k].number = 3 * i + k;
      memcpy(corners[3 * i + k].place, places[k], sizeof corners->place);
    }
  }
  qsort(corners, corner_count, sizeof *corners, compare_corners);
  for (size_t first = 0, next; first < corner_count; first = next) {
    for (next = first + 1; next < corner_count && same_place(&corners[first], &corners[next]); next++)
      ;
    for (size_t i = first; i < next; i++) {
      const uint32_t number = corners[i].number;
      struct direction normal = smooth_corner(corners + first, next - first, number, faces, crease_cosine);
      float *out = normals[number / 3].corner[number % 3];
      out[0] = (float)normal.x, out[1] = (float)normal.y, out[2] = (float)normal.z;
    }
  }
  free(corners);
  free(faces);
  return TRAX_OK;
}

/* --- normals of files --- */

void scene_mend_normals(struct trax_mesh *mesh, struct trax_import_report *report) {
  for (uint32_t i = 0; mesh->normals && i < mesh->triangle_count; i++) {
    const uint32_t *vertices = mesh->triangles[i].vertices;
    const struct direction face =
        unit(face_of(mesh->vertices[vertices[0]], mesh->vertices[vertices[1]], mesh->vertices[vertices[2]]));
    struct direction normals[3];
    bool given = false, mended = false;
    int away = 0;
    for (int corner = 0; corner < 3; corner++) {
      const float *n = mesh->normals[i][corner];
      given = given || n[0] != 0 || n[1] != 0 || n[2] != 0; /* NaN is not 0 */
      normals[corner] = (struct direction){n[0], n[1], n[2]};
      away += dot(normals[corner], face) < 0;
    }
    for (int corner = 0; given && corner < 3; corner++) {
      struct direction n = normals[corner];
      const double length = sqrt(dot(n, n)) * (away == 3 ? -1 : 1), cosine = dot(n, face) / length;
      float *out = mesh->normals[i][corner];
      if (isfinite(length) && cosine >= LEAST_COSINE) {
        out[0] = (float)(n.x / length), out[1] = (float)(n.y / length), out[2] = (float)(n.z / length);
      } else {
        out[0] = out[1] = out[2] = 0;
        mended = true;
      }
    }
    report->turned_normals += given && away == 3;
    report->mended_normals += mended;
  }
}

trax_status scene_complete_normals(struct trax_triangle_normals *normals, const struct trax_triangle *triangles,
                                   uint32_t count, double crease_cosine, trax_error *error) {
  struct trax_triangle_normals *computed = NULL;
  for (uint32_t i = 0; i < count; i++)
    for (int corner = 0; corner < 3; corner++) {
      float *n = normals[i].corner[corner];
      if (n[0] != 0 || n[1] != 0 || n[2] != 0)
        continue;
      if (!computed) {
        computed = calloc(count, sizeof *computed);
        if (!computed)
          return scene_out_of_memory(error, "normals");
        if (scene_smooth_normals(computed, triangles, count, crease_cosine, error) != TRAX_OK) {
          free(computed);
          return TRAX_ERROR;
        }
      }
      memcpy(n, computed[i].corner[corner], sizeof normals[i].corner[corner]);
    }
  free(computed);
  return TRAX_OK;
}
