/* Embree's BVH finds the triangles whose boxes a ray may meet. exact.c decides which it hits. */
#include "exact.h"

#include "placed.h"
#include "rtc_query.h"

#include <string.h>

struct query {
  rtc_context context; /* first: Embree hands its address back */
  struct double3 origin, direction;
  double limit;
  struct exact_hit hit;
  bool found;
};

static void bounds(const struct RTCBoundsFunctionArguments *arguments) {
  const struct exact_part *part = arguments->geometryUserPtr;
  const struct trax_scene *source = part->source;
  const struct trax_triangle *t = &source->triangles[part->first + arguments->primID];
  struct RTCBounds *box = arguments->bounds_o;
  float *low = &box->lower_x, *high = &box->upper_x;
  for (int i = 0; i < 3; i++) {
    /* Room for the rounding of a ray's origin to floats. */
    const float size = fmaxf(fabsf(source->header->bounds_min[i]), fabsf(source->header->bounds_max[i]));
    const float own = 0x1p-20f * fmaxf(size, source->header->bounds_max[i] - source->header->bounds_min[i]);
    const float room = source->instances ? part->room : own;
    low[i] = fminf(fminf(t->v0[i], t->v1[i]), t->v2[i]) - room;
    high[i] = fmaxf(fmaxf(t->v0[i], t->v1[i]), t->v2[i]) + room;
  }
}

/* The order of equal distances, as on the device: by the bits of the vertices in the scene, then by the order of
   import. */
static bool comes_first(const struct trax_scene *source, uint32_t number, uint32_t other) {
  struct placed_triangle placed, rival;
  uint32_t words[9], other_words[9];
  trax_place(&placed, source, number);
  trax_place(&rival, source, other);
  memcpy(words, &placed.triangle, sizeof words);
  memcpy(other_words, &rival.triangle, sizeof other_words);
  for (int i = 0; i < 9; i++)
    if (words[i] != other_words[i])
      return words[i] < other_words[i];
  if (placed.instance != rival.instance)
    return placed.instance->first_source < rival.instance->first_source;
  return placed.stored < rival.stored;
}

/* The number of the triangle that Embree's ray meets. */
static uint32_t number_of(const struct exact_part *part, const struct query *query, uint32_t primitive) {
  return part->source->instances ? part->source->instances[query->context.instID[0]].first_number + primitive
                                 : primitive;
}

/* Whether the first of two triangles that are hit is nearer. If they are at one distance, the first one is. */
static bool is_nearer(const struct query *query, const struct trax_scene *source, const struct exact_hit *hit,
                      const struct exact_hit *other) {
  if (fabs(hit->distance - other->distance) > 2 * EXACT_DISTANCE_ERROR * (hit->distance + other->distance))
    return hit->distance < other->distance;
  const int order = exact_order(source, hit->triangle, other->triangle, query->origin, query->direction);
  return order ? order < 0 : comes_first(source, hit->triangle, other->triangle);
}

/* Embree's own ray, in floats, only rules out triangles that are too far away. Its end is set behind the hit. */
static void nearest(const struct RTCIntersectFunctionNArguments *arguments) {
  struct query *query = (struct query *)arguments->context;
  const struct exact_part *part = arguments->geometryUserPtr;
  const struct trax_scene *source = part->source;
  struct exact_hit hit = {.triangle = number_of(part, query, arguments->primID)};
  if (!arguments->valid[0] || !exact_placed(source, hit.triangle, query->origin, query->direction, &hit) ||
      (query->found && !is_nearer(query, source, &hit, &query->hit)))
    return;
  query->found = true;
  query->hit = hit;
  query->limit = hit.distance;
  struct RTCRayHit *ray = (struct RTCRayHit *)(void *)arguments->rayhit;
  ray->ray.tfar = (float)(hit.distance * (1 + 0x1p-20));
  ray->hit.geomID = arguments->geomID;
  ray->hit.primID = arguments->primID;
}

static void any(const struct RTCOccludedFunctionNArguments *arguments) {
  struct query *query = (struct query *)arguments->context;
  const struct exact_part *part = arguments->geometryUserPtr;
  const struct trax_scene *source = part->source;
  struct exact_hit hit = {.triangle = number_of(part, query, arguments->primID)};
  if (!arguments->valid[0] || !exact_placed(source, hit.triangle, query->origin, query->direction, &hit) ||
      hit.distance >= query->limit)
    return;
  query->found = true;
  ((struct RTCRay *)(void *)arguments->ray)->tfar = -INFINITY;
}

bool exact_attach(RTCDevice device, RTCScene scene, const struct exact_part *part) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  if (!geometry)
    return false;
  rtcSetGeometryUserPrimitiveCount(geometry, part->count);
  rtcSetGeometryUserData(geometry, (void *)part);
  rtcSetGeometryBoundsFunction(geometry, bounds, NULL);
  rtcSetGeometryIntersectFunction(geometry, nearest);
  rtcSetGeometryOccludedFunction(geometry, any);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
  return true;
}

static struct RTCRay ray_of(const struct query *query) {
  return rtc_ray(query->origin, query->direction, (float)(query->limit * (1 + 0x1p-20)));
}

bool exact_nearest(RTCScene scene, struct double3 origin, struct double3 direction, struct exact_hit *hit) {
  struct query query = {.origin = origin, .direction = direction, .limit = INFINITY};
  struct RTCRayHit ray = {.ray = ray_of(&query), .hit = {.geomID = RTC_INVALID_GEOMETRY_ID}};
  rtc_intersect(scene, &query.context, &ray);
  *hit = query.hit;
  return query.found;
}

bool exact_any(RTCScene scene, struct double3 origin, struct double3 direction, double limit) {
  struct query query = {.origin = origin, .direction = direction, .limit = limit};
  struct RTCRay ray = ray_of(&query);
  rtc_occluded(scene, &query.context, &ray);
  return query.found;
}
