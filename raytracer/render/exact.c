#include "exact.h"

#include "double2.h"
#include "placed.h"

#include <gmp.h>

/* --- with bounds on the errors --- */

struct bounded {
  double value, error; /* |value - exact value| <= error */
};

/* The sum of the magnitudes of det(a, b, c)'s products. */
static double volume_size(struct double3 a, struct double3 b, struct double3 c) {
  return fabs(a.x) * (fabs(b.y * c.z) + fabs(b.z * c.y)) + fabs(a.y) * (fabs(b.z * c.x) + fabs(b.x * c.z)) +
         fabs(a.z) * (fabs(b.x * c.y) + fabs(b.y * c.x));
}

/* det(direction, b, c), of vectors whose parts are rounded to binary64 */
static struct bounded volume(struct double3 direction, struct double3 b, struct double3 c) {
  return (struct bounded){dot(direction, cross(b, c)), 0x1p-48 * volume_size(direction, b, c) + 0x1p-900};
}

static struct double3 high(const struct double2_3 *v) {
  return (struct double3){v->x.high, v->y.high, v->z.high};
}

/* det(a, b, c) in double-double; the value is rounded at last. */
static struct bounded long_volume(const struct double2_3 *a, const struct double2_3 *b, const struct double2_3 *c) {
  const struct double2 value = double2_volume(a, b, c);
  const double size = volume_size(high(a), high(b), high(c));
  return (struct bounded){value.high, 0x1p-100 * size + 0x1p-52 * fabs(value.high) + 0x1p-900};
}

static struct bounded sum_of(const struct bounded edge[3]) {
  return (struct bounded){edge[0].value + edge[1].value + edge[2].value, edge[0].error + edge[1].error + edge[2].error};
}

/* Whether the sign is known. A value within its error may have either sign. */
static bool is_certain(struct bounded value) {
  return fabs(value.value) > value.error;
}

static bool is_precise(struct bounded value) {
  return value.error <= 0.25 * EXACT_DISTANCE_ERROR * fabs(value.value);
}

enum answer { MISSED, HIT, UNCERTAIN };

/* edge: the edge values, of the direction and two vertices as seen from the origin. They have one sign if the ray meets
   the triangle. The distance is scaled / slope. */
static enum answer decide(const struct bounded edge[3], struct bounded slope, struct bounded scaled,
                          struct exact_hit *hit) {
  bool positive = false, negative = false, certain = true;
  for (int i = 0; i < 3; i++) {
    positive |= edge[i].value > edge[i].error;
    negative |= edge[i].value < -edge[i].error;
    certain = certain && is_certain(edge[i]);
  }
  if (positive && negative)
    return MISSED;
  const struct bounded sum = sum_of(edge);
  if (!certain || !is_precise(slope) || !is_precise(scaled) || !is_precise(sum))
    return UNCERTAIN;
  hit->distance = scaled.value / slope.value;
  hit->u = edge[1].value / sum.value;
  hit->v = edge[2].value / sum.value;
  return hit->distance > 0 ? HIT : MISSED;
}

/* --- exactly --- */

struct rational3 {
  mpq_t x, y, z;
};

/* A ray and a triangle, relative to the ray's origin. */
struct rational_triangle {
  struct rational3 direction, vertex[3], scratch;
  mpq_t volume[3], determinant, scaled, product;
};

static mpq_t *component(struct rational3 *v, int axis) {
  return axis == 0 ? &v->x : axis == 1 ? &v->y : &v->z;
}

static void rational_init(struct rational_triangle *r) {
  struct rational3 *vectors[] = {&r->direction, &r->vertex[0], &r->vertex[1], &r->vertex[2], &r->scratch};
  for (int i = 0; i < 5; i++)
    mpq_inits(vectors[i]->x, vectors[i]->y, vectors[i]->z, NULL);
  mpq_inits(r->volume[0], r->volume[1], r->volume[2], r->determinant, r->scaled, r->product, NULL);
}

static void rational_clear(struct rational_triangle *r) {
  struct rational3 *vectors[] = {&r->direction, &r->vertex[0], &r->vertex[1], &r->vertex[2], &r->scratch};
  for (int i = 0; i < 5; i++)
    mpq_clears(vectors[i]->x, vectors[i]->y, vectors[i]->z, NULL);
  mpq_clears(r->volume[0], r->volume[1], r->volume[2], r->determinant, r->scaled, r->product, NULL);
}

/* sum = det(a, b, c) */
static void rational_volume(struct rational_triangle *r, mpq_t sum, struct rational3 *a, struct rational3 *b,
                            struct rational3 *c) {
  mpq_set_ui(sum, 0, 1);
  for (int i = 0; i < 3; i++)
    for (int odd = 0; odd < 2; odd++) {
      mpq_mul(r->product, *component(b, (i + 1 + odd) % 3), *component(c, (i + 2 - odd) % 3));
      mpq_mul(r->product, r->product, *component(a, i));
      if (odd)
        mpq_sub(sum, sum, r->product);
      else
        mpq_add(sum, sum, r->product);
    }
}

/* place = the coordinate of the instance's image of a corner */
static void rational_place(struct rational_triangle *r, mpq_t place, const struct trax_instance *instance,
                           const float *corner, int axis) {
  mpq_set_d(place, (double)instance->origin[axis]);
  for (int column = 0; column < 3; column++) {
    mpq_set_d(r->scaled, (double)instance->to_world[axis][column] * (double)corner[column]); /* 48 bits at most */
    mpq_add(place, place, r->scaled);
  }
}

/* The triangle is in the instance's mesh; NULL: in the scene. */
static void rational_set(struct rational_triangle *r, const struct trax_triangle *triangle,
                         const struct trax_instance *instance, struct double3 origin, struct double3 direction) {
  const float *const corner[3] = {triangle->v0, triangle->v1, triangle->v2};
  const double from[3] = {origin.x, origin.y, origin.z}, towards[3] = {direction.x, direction.y, direction.z};
  for (int axis = 0; axis < 3; axis++) {
    mpq_set_d(r->product, from[axis]);
    mpq_set_d(*component(&r->direction, axis), towards[axis]);
    for (int i = 0; i < 3; i++) {
      mpq_t *place = component(&r->vertex[i], axis);
      if (instance)
        rational_place(r, *place, instance, corner[i], axis);
      else
        mpq_set_d(*place, (double)corner[i][axis]);
      mpq_sub(*place, *place, r->product);
    }
  }
  mpq_set_ui(r->determinant, 0, 1);
  for (int i = 0; i < 3; i++) {
    rational_volume(r, r->volume[i], &r->direction, &r->vertex[(i + 2) % 3], &r->vertex[(i + 1) % 3]);
    mpq_add(r->determinant, r->determinant, r->volume[i]);
  }
  rational_volume(r, r->scaled, &r->vertex[0], &r->vertex[2], &r->vertex[1]);
}

/* Whether the ray hits the triangle; if so, *distance receives the distance. */
static bool rational_triangle(const struct trax_triangle *triangle, const struct trax_instance *instance,
                              struct double3 origin, struct double3 direction, struct exact_hit *hit, mpq_t distance) {
  struct rational_triangle r;
  rational_init(&r);
  rational_set(&r, triangle, instance, origin, direction);
  bool positive = false, negative = false;
  for (int i = 0; i < 3; i++) {
    positive |= mpq_sgn(r.volume[i]) > 0;
    negative |= mpq_sgn(r.volume[i]) < 0;
  }
  const bool found = !(positive && negative) && mpq_sgn(r.determinant) * mpq_sgn(r.scaled) > 0;
  if (found) {
    mpq_div(distance, r.scaled, r.determinant);
    mpq_div(r.volume[1], r.volume[1], r.determinant);
    mpq_div(r.volume[2], r.volume[2], r.determinant);
    hit->distance = mpq_get_d(distance);
    hit->u = mpq_get_d(r.volume[1]);
    hit->v = mpq_get_d(r.volume[2]);
  }
  rational_clear(&r);
  return found;
}

/* --- the three precisions, in turn until one is certain --- */

static enum answer in_binary64(const struct trax_triangle *triangle, struct double3 origin, struct double3 direction,
                               struct exact_hit *hit) {
  const struct double3 a = minus(from(triangle->v0), origin), b = minus(from(triangle->v1), origin),
                       c = minus(from(triangle->v2), origin);
  /* Edges of the triangle itself, with the rounding of differences of floats. */
  const struct double3 e = minus(from(triangle->v1), from(triangle->v0)),
                       f = minus(from(triangle->v2), from(triangle->v0));
  const struct bounded edge[3] = {volume(direction, c, b), volume(direction, a, c), volume(direction, b, a)};
  return decide(edge, volume(direction, e, f), volume(a, e, f), hit);
}

static enum answer in_double2(const struct trax_triangle *triangle, struct double3 origin, struct double3 direction,
                              struct exact_hit *hit) {
  const struct double2_3 a = double2_difference(triangle->v0, origin), b = double2_difference(triangle->v1, origin),
                         c = double2_difference(triangle->v2, origin),
                         way = {{direction.x, 0}, {direction.y, 0}, {direction.z, 0}};
  const struct bounded edge[3] = {long_volume(&way, &c, &b), long_volume(&way, &a, &c), long_volume(&way, &b, &a)};
  return decide(edge, sum_of(edge), long_volume(&a, &c, &b), hit);
}

/* A corner as seen from the origin, and the sums of the magnitudes that were added up: all errors are within 2^-100 of
   these. */
static struct double2_3 placed_corner(struct double3 *size, const struct trax_instance *instance, const float v[3],
                                      struct double3 origin) {
  struct double2_3 corner;
  for (int row = 0; row < 3; row++) {
    const double start = (&origin.x)[row];
    struct double2 *sum = &(&corner.x)[row];
    double *magnitude = &(&size->x)[row];
    *sum = double2_of_sum((double)instance->origin[row], -start);
    *magnitude = fabs((double)instance->origin[row]) + fabs(start);
    for (int column = 0; column < 3; column++) {
      const double product = (double)instance->to_world[row][column] * (double)v[column];
      *sum = double2_plus(*sum, (struct double2){product, 0});
      *magnitude += fabs(product);
    }
  }
  return corner;
}

/* Places a corner in binary64: errors are within 2^-49 of the magnitudes. */
static struct double3 rounded_corner(struct double3 *size, const struct trax_instance *instance, const float v[3],
                                     struct double3 origin) {
  struct double3 corner;
  for (int row = 0; row < 3; row++) {
    const float *a = instance->to_world[row];
    const double x = (double)a[0] * (double)v[0], y = (double)a[1] * (double)v[1], z = (double)a[2] * (double)v[2],
                 at = (double)instance->origin[row], start = (&origin.x)[row];
    (&corner.x)[row] = at - start + x + y + z;
    (&size->x)[row] = fabs(at) + fabs(start) + fabs(x) + fabs(y) + fabs(z);
  }
  return corner;
}

static struct bounded rounded_volume(struct double3 a, struct double3 b, struct double3 c, struct double3 size_a,
                                     struct double3 size_b, struct double3 size_c) {
  return (struct bounded){dot(a, cross(b, c)), 0x1p-46 * volume_size(size_a, size_b, size_c) + 0x1p-900};
}

static enum answer placed_in_binary64(const struct trax_triangle *triangle, const struct trax_instance *instance,
                                      struct double3 origin, struct double3 way, struct exact_hit *hit) {
  struct double3 sa, sb, sc;
  const struct double3 a = rounded_corner(&sa, instance, triangle->v0, origin),
                       b = rounded_corner(&sb, instance, triangle->v1, origin),
                       c = rounded_corner(&sc, instance, triangle->v2, origin);
  const struct bounded edge[3] = {rounded_volume(way, c, b, way, sc, sb), rounded_volume(way, a, c, way, sa, sc),
                                  rounded_volume(way, b, a, way, sb, sa)};
  return decide(edge, sum_of(edge), rounded_volume(a, c, b, sa, sc, sb), hit);
}

static struct bounded placed_volume(const struct double2_3 *a, const struct double2_3 *b, const struct double2_3 *c,
                                    struct double3 size_a, struct double3 size_b, struct double3 size_c) {
  const struct double2 value = double2_volume(a, b, c);
  return (struct bounded){value.high,
                          0x1p-96 * volume_size(size_a, size_b, size_c) + 0x1p-52 * fabs(value.high) + 0x1p-900};
}

static enum answer placed_in_double2(const struct trax_triangle *triangle, const struct trax_instance *instance,
                                     struct double3 origin, struct double3 direction, struct exact_hit *hit) {
  struct double3 sa, sb, sc;
  const struct double2_3 a = placed_corner(&sa, instance, triangle->v0, origin),
                         b = placed_corner(&sb, instance, triangle->v1, origin),
                         c = placed_corner(&sc, instance, triangle->v2, origin),
                         way = {{direction.x, 0}, {direction.y, 0}, {direction.z, 0}};
  const struct bounded edge[3] = {placed_volume(&way, &c, &b, direction, sc, sb),
                                  placed_volume(&way, &a, &c, direction, sa, sc),
                                  placed_volume(&way, &b, &a, direction, sb, sa)};
  return decide(edge, sum_of(edge), placed_volume(&a, &c, &b, sa, sc, sb), hit);
}

/* Whether the triangle lies in a plane perpendicular to an axis, at this place. Rooms have many such triangles. A ray
   that starts in their plane meets it at a distance of 0, and all triangles of a plane have one distance. Both are
   found without rational numbers. */
static bool lies_at(const struct trax_triangle *triangle, int axis, double place) {
  return triangle->v0[axis] == place && triangle->v1[axis] == place && triangle->v2[axis] == place;
}

bool exact_triangle(const struct trax_triangle *triangle, struct double3 origin, struct double3 direction,
                    struct exact_hit *hit) {
  enum answer answer = in_binary64(triangle, origin, direction, hit);
  if (answer == UNCERTAIN &&
      (lies_at(triangle, 0, origin.x) || lies_at(triangle, 1, origin.y) || lies_at(triangle, 2, origin.z)))
    return false;
  if (answer == UNCERTAIN)
    answer = in_double2(triangle, origin, direction, hit);
  if (answer != UNCERTAIN)
    return answer == HIT;
  mpq_t distance;
  mpq_init(distance);
  const bool found = rational_triangle(triangle, NULL, origin, direction, hit, distance);
  mpq_clear(distance);
  return found;
}

bool exact_placed(const struct trax_scene *scene, uint32_t number, struct double3 origin, struct double3 direction,
                  struct exact_hit *hit) {
  if (!scene->instances)
    return exact_triangle(&scene->triangles[number], origin, direction, hit);
  struct placed_triangle placed;
  trax_place(&placed, scene, number);
  const struct trax_triangle *triangle = &scene->triangles[placed.stored];
  enum answer answer = placed_in_binary64(triangle, placed.instance, origin, direction, hit);
  if (answer == UNCERTAIN)
    answer = placed_in_double2(triangle, placed.instance, origin, direction, hit);
  if (answer != UNCERTAIN)
    return answer == HIT;
  mpq_t distance;
  mpq_init(distance);
  const bool found = rational_triangle(triangle, placed.instance, origin, direction, hit, distance);
  mpq_clear(distance);
  return found;
}

int exact_order(const struct trax_scene *scene, uint32_t number, uint32_t other, struct double3 origin,
                struct double3 direction) {
  struct placed_triangle placed[2];
  const struct trax_triangle *triangles[2];
  struct exact_hit ignored;
  mpq_t distances[2];
  for (int i = 0; i < 2; i++) {
    trax_place(&placed[i], scene, i ? other : number);
    triangles[i] = &scene->triangles[placed[i].stored];
  }
  for (int axis = 0; axis < 3 && !scene->instances; axis++)
    if (lies_at(triangles[0], axis, triangles[0]->v0[axis]) && lies_at(triangles[1], axis, triangles[0]->v0[axis]))
      return 0;
  mpq_inits(distances[0], distances[1], NULL);
  for (int i = 0; i < 2; i++)
    rational_triangle(triangles[i], placed[i].instance, origin, direction, &ignored, distances[i]);
  const int order = mpq_cmp(distances[0], distances[1]);
  mpq_clears(distances[0], distances[1], NULL);
  return order;
}
