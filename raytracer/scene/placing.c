#include "placing.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const double scene_identity[3][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};

/* A matrix and its inverse stretch a vector by no more than this, so that rays and triangles stay in the range of
   floats (render/frame.c), and together by no more than MOST_CONDITION: flatter meshes would be hit with too large an
   error. */
#define MOST_STRETCH 0x1p17
#define MOST_CONDITION 0x1p14

/* The greatest of the rows' sums of magnitudes: how much a vector's greatest component grows at most. */
static double norm(const float (*m)[3]) {
  double most = 0;
  for (int row = 0; row < 3; row++)
    most = fmax(most, fabs((double)m[row][0]) + fabs((double)m[row][1]) + fabs((double)m[row][2]));
  return most;
}

/* Whether neither the transform nor its inverse rounds anything: each axis goes to an axis, by a power of two. */
static bool is_exact(const struct trax_instance *instance) {
  for (int row = 0; row < 3; row++) {
    unsigned used = 0;
    if (instance->origin[row] != 0)
      return false;
    for (int column = 0; column < 3; column++) {
      int exponent;
      const float value = instance->to_world[row][column];
      used += value != 0;
      if (value != 0 && fabsf(frexpf(value, &exponent)) != 0.5f)
        return false;
    }
    if (used != 1)
      return false;
  }
  return true;
}

const char *scene_derive_instance(struct trax_instance *instance) {
  double cofactor[3][3], determinant = 0;
  for (int row = 0; row < 3; row++) {
    const float *y = instance->to_world[(row + 1) % 3], *z = instance->to_world[(row + 2) % 3];
    if (!(fabsf(instance->origin[row]) <= SCENE_MAX_COORDINATE))
      return "a number is not finite, or too large";
    for (int column = 0; column < 3; column++) {
      const int next = (column + 1) % 3, last = (column + 2) % 3;
      if (!(fabsf(instance->to_world[row][column]) <= SCENE_MAX_COORDINATE))
        return "a number is not finite, or too large";
      cofactor[row][column] = (double)y[next] * (double)z[last] - (double)y[last] * (double)z[next];
    }
  }
  for (int column = 0; column < 3; column++)
    determinant += (double)instance->to_world[0][column] * cofactor[0][column];
  if (determinant == 0)
    return "the transform is singular";
  for (int row = 0; row < 3; row++)
    for (int column = 0; column < 3; column++)
      instance->to_object[row][column] = (float)(cofactor[column][row] / determinant) + 0.0f;
  const double out = norm(instance->to_world), in = norm(instance->to_object);
  if (!(out <= MOST_STRETCH && in <= MOST_STRETCH))
    return "the transform scales by more than 2^17, or by less than 2^-17";
  if (!(out * in <= MOST_CONDITION))
    return "the transform is nearly singular: it stretches one direction 2^14 times as much as another";
  instance->spread = is_exact(instance) ? 0 : (float)(0x1p-19 * out * in);
  instance->flags = determinant < 0 ? TRAX_INSTANCE_MIRRORED : 0;
  return NULL;
}

const char *scene_place_instance(struct trax_instance *instance, const double transform[3][4]) {
  for (int row = 0; row < 3; row++) {
    instance->origin[row] = (float)transform[row][3];
    for (int column = 0; column < 3; column++)
      instance->to_world[row][column] = (float)transform[row][column];
  }
  return scene_derive_instance(instance);
}

struct scene_box scene_part_box(const struct trax_mesh *mesh, uint32_t first, uint32_t count) {
  struct scene_box box = scene_empty_box();
  for (uint32_t i = first; i < first + count; i++) {
    bool good = true;
    for (int k = 0; k < 9; k++)
      good &= fabsf(mesh->vertices[mesh->triangles[i].vertices[k / 3]][k % 3]) <= SCENE_MAX_COORDINATE;
    for (int corner = 0; corner < 3 && good; corner++)
      scene_box_add_point(&box, mesh->vertices[mesh->triangles[i].vertices[corner]]);
  }
  return box;
}

const char *scene_misplaced(const struct scene_box *box, const double transform[3][4]) {
  struct trax_instance placed = {0};
  const char *wrong = scene_place_instance(&placed, transform); /* an empty box is anywhere */
  for (int row = 0; row < 3 && !wrong && box->min[0] <= box->max[0]; row++) {
    double low = transform[row][3], high = low;
    for (int column = 0; column < 3; column++) {
      const double a = transform[row][column] * (double)box->min[column],
                   b = transform[row][column] * (double)box->max[column];
      low += fmin(a, b), high += fmax(a, b);
    }
    if (!(low >= -SCENE_MAX_COORDINATE && high <= SCENE_MAX_COORDINATE))
      wrong = "a coordinate of its box is too large";
  }
  return wrong;
}

/* render/frame.c's margin is 64 units of 2^-24 of D, the greatest distance of a ray's origin from the scene, which is
   twice what tests of boxes and triangles need. In the mesh both tests see one and the same ray, and distances grow by
   the norm of to_object at most. But the margin is added to coordinates of the origin there, which may be larger than
   its distance from the mesh. They are rounded by at most 1 unit of the distance between the ray's origin and the
   instance's, 1 + q times D at most, where q is the distance between the scene's far side and the instance's origin,
   over the scene's extent: 5 units are more than enough. */
float scene_stretch_of(const struct trax_instance *instance, const struct scene_box *bounds) {
  double extent = 0, away = 0;
  for (int axis = 0; axis < 3; axis++) {
    const double low = bounds->min[axis], high = bounds->max[axis], origin = instance->origin[axis];
    extent = fmax(extent, high - low);
    away = fmax(away, fmax(fabs(low - origin), fabs(high - origin)));
  }
  const double in = norm(instance->to_object);
  const double further = instance->spread == 0 ? 0 : 5.0 / 64 * (1 + away / fmax(extent, 0x1p-100));
  return (float)(in * (1 + further) * (1 + 0x1p-20));
}

void scene_multiply(double out[3][4], const double a[3][4], const double b[3][4]) {
  for (int row = 0; row < 3; row++)
    for (int column = 0; column < 4; column++)
      out[row][column] = a[row][0] * b[0][column] + a[row][1] * b[1][column] + a[row][2] * b[2][column] +
                         (column == 3 ? a[row][3] : 0);
}

/* --- boxes --- */

enum { BOX_LEVELS = 5 };

/* Extends *box by an instance's image of a box in the mesh, rounded outwards. */
static void add_image(struct scene_box *box, const struct trax_instance *instance, const float min[3],
                      const float max[3]) {
  for (int row = 0; row < 3; row++) {
    double low = instance->origin[row], high = low, size = fabs(low);
    for (int column = 0; column < 3; column++) {
      const double factor = instance->to_world[row][column], a = factor * (double)min[column],
                   b = factor * (double)max[column];
      low += fmin(a, b), high += fmax(a, b), size += fmax(fabs(a), fabs(b));
    }
    const double error = instance->spread == 0 ? 0 : 0x1p-50 * size;
    low -= error, high += error;
    float least = (float)low, most = (float)high;
    least = (double)least > low ? scene_next_float(least, false) : least;
    most = (double)most < high ? scene_next_float(most, true) : most;
    box->min[row] = least < box->min[row] ? least : box->min[row];
    box->max[row] = most > box->max[row] ? most : box->max[row];
  }
}

static void add_subtree(struct scene_box *box, const struct trax_scene *scene, const struct trax_instance *instance,
                        trax_scene_ref reference, int levels) {
  struct scene_node node;
  const struct trax_scene_section *nodes = &scene->header->sections[TRAX_SCENE_NODES];
  scene_node_of(&node, scene, (reference - nodes->offset) / nodes->record_size);
  for (uint32_t i = 0; i < node.count; i++)
    if (TRAX_SCENE_REF_COUNT(node.child[i]) || levels == 1)
      add_image(box, instance, node.box[i].min, node.box[i].max);
    else
      add_subtree(box, scene, instance, node.child[i], levels - 1);
}

struct scene_box scene_instance_box(const struct trax_scene *scene, const struct trax_instance *instance) {
  const struct trax_scene_mesh *mesh = &scene->meshes[instance->mesh];
  struct scene_box box = scene_empty_box();
  if (TRAX_SCENE_REF_COUNT(mesh->root))
    add_image(&box, instance, mesh->bounds_min, mesh->bounds_max);
  else
    add_subtree(&box, scene, instance, mesh->root, BOX_LEVELS);
  return box;
}

/* --- lamps --- */

static bool emits(const struct trax_material *material) {
  return material->emission[0] > 0 || material->emission[1] > 0 || material->emission[2] > 0;
}

static bool stays(const struct trax_instance *instance) {
  for (int row = 0; row < 3; row++)
    for (int column = 0; column < 3; column++)
      if (instance->origin[row] != 0 || instance->to_world[row][column] != (float)(row == column))
        return false;
  return instance->material == TRAX_NO_MATERIAL;
}

trax_status scene_check_lamps(const struct trax_scene *scene, const char *name, trax_error *error) {
  unsigned char *lamps = calloc(scene->mesh_count + (size_t)1, 1); /* of each mesh: 1: it has some; 2: it is placed */
  if (!lamps)
    return scene_out_of_memory(error, name);
  for (uint32_t m = 0; m < scene->mesh_count; m++)
    for (uint32_t i = 0; i < scene->meshes[m].triangle_count && !lamps[m]; i++)
      lamps[m] = emits(&scene->materials[scene->triangles[scene->meshes[m].first_triangle + i].material]);
  trax_status result = TRAX_OK;
  for (uint32_t i = 0; i < scene->instance_count && result == TRAX_OK; i++) {
    const struct trax_instance *instance = &scene->instances[i];
    const bool bright = instance->material != TRAX_NO_MATERIAL && emits(&scene->materials[instance->material]);
    if (bright || (lamps[instance->mesh] && (lamps[instance->mesh] > 1 || !stays(instance))))
      result = trax_fail(error, "%s: an instance emits light: lamps are placed once, where they are (--flatten)", name);
    lamps[instance->mesh] = lamps[instance->mesh] ? 2 : 0;
  }
  for (uint32_t m = 0; m < scene->mesh_count && result == TRAX_OK; m++)
    if (lamps[m] == 1)
      result = trax_fail(error, "%s: mesh %u emits light and is placed nowhere", name, m);
  free(lamps);
  return result;
}

/* --- parts --- */

/* Moves the triangles of a part to the place of number `to`. */
static void move_part(struct trax_mesh *mesh, const struct trax_mesh_part *part, uint32_t to) {
  const size_t from = part->first_triangle, count = part->triangle_count;
  memmove(mesh->triangles + to, mesh->triangles + from, count * sizeof *mesh->triangles);
  if (mesh->normals)
    memmove(mesh->normals + to, mesh->normals + from, count * sizeof *mesh->normals);
  if (mesh->uvs)
    memmove(mesh->uvs + to, mesh->uvs + from, count * sizeof *mesh->uvs);
}

trax_status scene_drop_parts(struct trax_mesh *mesh, trax_error *error) {
  uint32_t kept = 0, parts = 0, triangles = 0;
  uint32_t *numbers = calloc(mesh->part_count + (size_t)1, sizeof *numbers); /* 1: it is placed; then what it becomes */
  if (!numbers)
    return scene_out_of_memory(error, "instances");
  for (uint32_t i = 0; i < mesh->instance_count; i++)
    if (mesh->parts[mesh->instances[i].part].triangle_count) {
      mesh->instances[kept++] = mesh->instances[i];
      numbers[mesh->instances[i].part] = 1;
    }
  mesh->instance_count = kept;
  for (uint32_t i = 0; i < mesh->part_count; i++) {
    if (!numbers[i])
      continue;
    move_part(mesh, &mesh->parts[i], triangles);
    numbers[i] = parts;
    mesh->parts[parts] = mesh->parts[i];
    mesh->parts[parts].first_triangle = triangles;
    triangles += mesh->parts[parts++].triangle_count;
  }
  for (uint32_t i = 0; i < kept; i++)
    mesh->instances[i].part = numbers[mesh->instances[i].part];
  if (mesh->part_count)
    mesh->triangle_count = triangles;
  mesh->part_count = parts;
  free(numbers);
  return TRAX_OK;
}

/* --- flattening --- */

struct vertex_range {
  uint32_t first, end;
};

static struct vertex_range vertices_of(const struct trax_mesh *mesh, const struct trax_mesh_part *part) {
  struct vertex_range range = {UINT32_MAX, 0};
  for (uint32_t i = 0; i < part->triangle_count; i++)
    for (int corner = 0; corner < 3; corner++) {
      const uint32_t vertex = mesh->triangles[part->first_triangle + i].vertices[corner];
      range.first = vertex < range.first ? vertex : range.first;
      range.end = vertex + 1 > range.end ? vertex + 1 : range.end;
    }
  return range;
}

double scene_determinant(const double m[3][4]) {
  double sum = 0;
  for (int i = 0; i < 3; i++)
    sum += m[0][i] * (m[1][(i + 1) % 3] * m[2][(i + 2) % 3] - m[1][(i + 2) % 3] * m[2][(i + 1) % 3]);
  return sum;
}

void scene_place_normal(float out[3], const float n[3], const double m[3][4]) {
  const bool mirror = scene_determinant(m) < 0;
  for (int row = 0; row < 3; row++) {
    const double *y = m[(row + 1) % 3], *z = m[(row + 2) % 3];
    double sum = 0;
    for (int column = 0; column < 3; column++) {
      const int next = (column + 1) % 3, last = (column + 2) % 3;
      sum += (y[next] * z[last] - y[last] * z[next]) * (double)n[column];
    }
    out[row] = (float)(mirror ? -sum : sum);
  }
}

/* Appends an instance to `out`, which has room. */
static void place_part(struct trax_mesh *out, const struct trax_mesh *mesh, const struct trax_mesh_instance *instance,
                       struct vertex_range range, uint32_t first_source) {
  const struct trax_mesh_part *part = &mesh->parts[instance->part];
  double m[3][4]; /* as floats, which an instance has */
  for (int row = 0; row < 3; row++)
    for (int column = 0; column < 4; column++)
      m[row][column] = (double)(float)instance->transform[row][column];
  const bool mirror = scene_determinant(m) < 0;
  const uint32_t first = out->vertex_count;
  for (uint32_t i = range.first; i < range.end; i++) {
    const float *v = mesh->vertices[i];
    for (int row = 0; row < 3; row++)
      out->vertices[out->vertex_count][row] =
          (float)(m[row][0] * (double)v[0] + m[row][1] * (double)v[1] + m[row][2] * (double)v[2] + m[row][3]);
    out->vertex_count++;
  }
  for (uint32_t i = part->first_triangle; i < part->first_triangle + part->triangle_count; i++) {
    const struct trax_mesh_triangle *triangle = &mesh->triangles[i];
    const uint32_t number = out->triangle_count++;
    out->triangles[number] = (struct trax_mesh_triangle){
        .material = instance->material == TRAX_NO_MATERIAL ? triangle->material : instance->material,
        .source_id = first_source + triangle->source_id};
    for (int corner = 0; corner < 3; corner++) {
      const int from = mirror && corner ? 3 - corner : corner;
      out->triangles[number].vertices[corner] = triangle->vertices[from] - range.first + first;
      if (out->normals)
        scene_place_normal(out->normals[number][corner], mesh->normals[i][from], m);
      if (out->uvs)
        memcpy(out->uvs[number][corner], mesh->uvs[i][from], sizeof out->uvs[number][corner]);
    }
  }
}

trax_status scene_flatten_mesh(struct trax_mesh *mesh, trax_error *error) {
  struct vertex_range *ranges = malloc((mesh->part_count + (size_t)1) * sizeof *ranges);
  uint64_t vertices = 0, triangles = 0, sources = 0;
  if (!ranges)
    return scene_out_of_memory(error, "instances");
  for (uint32_t i = 0; i < mesh->part_count; i++)
    ranges[i] = vertices_of(mesh, &mesh->parts[i]);
  for (uint32_t i = 0; i < mesh->instance_count; i++) {
    const struct trax_mesh_part *part = &mesh->parts[mesh->instances[i].part];
    vertices += ranges[mesh->instances[i].part].end - ranges[mesh->instances[i].part].first;
    triangles += part->triangle_count, sources += part->source_count;
  }
  struct trax_mesh out = *mesh;
  const size_t a_triangle =
      sizeof *out.triangles + (mesh->normals ? sizeof *out.normals : 0) + (mesh->uvs ? sizeof *out.uvs : 0);
  if (vertices > UINT32_MAX || sources > UINT32_MAX ||
      vertices * sizeof *out.vertices + triangles * a_triangle > scene_memory_for(scene_bytes_read())) {
    free(ranges);
    return trax_fail(error, "the instances are too large to be flattened: %llu vertices and %llu triangles",
                     (unsigned long long)vertices, (unsigned long long)triangles);
  }
  out.vertices = malloc(vertices * sizeof *out.vertices);
  out.triangles = malloc(triangles * sizeof *out.triangles);
  out.normals = mesh->normals ? malloc(triangles * sizeof *out.normals) : NULL;
  out.uvs = mesh->uvs ? malloc(triangles * sizeof *out.uvs) : NULL;
  out.vertex_count = out.triangle_count = out.part_count = out.instance_count = 0;
  out.parts = NULL, out.instances = NULL;
  const bool room = out.vertices && out.triangles && !out.normals == !mesh->normals && !out.uvs == !mesh->uvs;
  uint32_t first_source = 0;
  for (uint32_t i = 0; i < mesh->instance_count && room; i++) {
    const struct trax_mesh_instance *instance = &mesh->instances[i];
    place_part(&out, mesh, instance, ranges[instance->part], first_source);
    first_source += mesh->parts[instance->part].source_count;
  }
  free(ranges);
  struct trax_mesh *const gone = room ? mesh : &out;
  free(gone->vertices);
  free(gone->triangles);
  free(gone->normals);
  free(gone->uvs);
  if (!room)
    return scene_out_of_memory(error, "instances");
  free(mesh->parts);
  free(mesh->instances);
  *mesh = out;
  return TRAX_OK;
}
