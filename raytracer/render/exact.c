#include "exact.h"

#include <string.h>

/* Edges are triple products of the direction and two vertices as seen from the origin: two triangles that share an edge
   compute the same value for it with opposite signs, since a product's terms change places and nothing else. So no ray
   passes between them, as with the watertight test of the device. Vertices and the eye are floats, whose differences
   are exact unless their exponents are more than 29 apart. */
bool exact_triangle(const struct trax_triangle *triangle, struct double3 origin, struct double3 direction,
                    struct exact_hit *hit) {
  const struct double3 a = minus(from(triangle->v0), origin), b = minus(from(triangle->v1), origin),
                       c = minus(from(triangle->v2), origin);
  const double edge_a = dot(direction, cross(c, b)), edge_b = dot(direction, cross(a, c)),
               edge_c = dot(direction, cross(b, a));
  if ((edge_a < 0 || edge_b < 0 || edge_c < 0) && (edge_a > 0 || edge_b > 0 || edge_c > 0))
    return false;
  const double sum = edge_a + edge_b + edge_c;
  const struct double3 normal = cross(minus(b, a), minus(c, a));
  const double slope = dot(normal, direction);
  if (sum == 0 || slope == 0)
    return false;
  const double distance = dot(normal, a) / slope;
  if (!(distance > 0))
    return false;
  hit->distance = distance;
  hit->u = edge_b / sum;
  hit->v = edge_c / sum;
  return true;
}

/* --- Embree's callbacks --- */

struct query {
  struct RTCIntersectContext context; /* first: Embree hands its address back */
  struct double3 origin, direction;
  double limit;
  struct exact_hit hit;
  bool found;
};

static void bounds(const struct RTCBoundsFunctionArguments *arguments) {
  const struct trax_scene *source = arguments->geometryUserPtr;
  const struct trax_triangle *t = &source->triangles[arguments->primID];
  struct RTCBounds *box = arguments->bounds_o;
  float *low = &box->lower_x, *high = &box->upper_x;
  for (int i = 0; i < 3; i++) {
    /* Room for the rounding of a ray's origin to floats. */
    const float size = fmaxf(fabsf(source->header->bounds_min[i]), fabsf(source->header->bounds_max[i]));
    const float room = 0x1p-20f * fmaxf(size, source->header->bounds_max[i] - source->header->bounds_min[i]);
    low[i] = fminf(fminf(t->v0[i], t->v1[i]), t->v2[i]) - room;
    high[i] = fmaxf(fmaxf(t->v0[i], t->v1[i]), t->v2[i]) + room;
  }
}

/* As device/triangle.h has it. */
static bool comes_first(const struct trax_triangle *triangle, const struct trax_triangle *other) {
  uint32_t words[9], other_words[9];
  memcpy(words, triangle, sizeof words);
  memcpy(other_words, other, sizeof other_words);
  for (int i = 0; i < 9; i++)
    if (words[i] != other_words[i])
      return words[i] < other_words[i];
  return triangle < other;
}

/* Of the float rays Embree's own is only to leave out what is too far: its end lies behind the hit. */
static void nearest(const struct RTCIntersectFunctionNArguments *arguments) {
  struct query *query = (struct query *)arguments->context;
  const struct trax_scene *source = arguments->geometryUserPtr;
  struct exact_hit hit = {.triangle = arguments->primID};
  if (!arguments->valid[0] ||
      !exact_triangle(&source->triangles[hit.triangle], query->origin, query->direction, &hit) ||
      hit.distance > query->limit ||
      (query->found && hit.distance == query->hit.distance &&
       !comes_first(&source->triangles[hit.triangle], &source->triangles[query->hit.triangle])))
    return;
  query->found = true;
  query->hit = hit;
  query->limit = hit.distance;
  struct RTCRayHit *ray = (struct RTCRayHit *)(void *)arguments->rayhit;
  ray->ray.tfar = (float)(hit.distance * (1 + 0x1p-20));
  ray->hit.geomID = arguments->geomID;
  ray->hit.primID = hit.triangle;
}

static void any(const struct RTCOccludedFunctionNArguments *arguments) {
  struct query *query = (struct query *)arguments->context;
  const struct trax_scene *source = arguments->geometryUserPtr;
  struct exact_hit hit = {.triangle = arguments->primID};
  if (!arguments->valid[0] ||
      !exact_triangle(&source->triangles[hit.triangle], query->origin, query->direction, &hit) ||
      hit.distance >= query->limit)
    return;
  query->found = true;
  ((struct RTCRay *)(void *)arguments->ray)->tfar = -INFINITY;
}

bool exact_attach(RTCDevice device, RTCScene scene, const struct trax_scene *source) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  if (!geometry)
    return false;
  rtcSetGeometryUserPrimitiveCount(geometry, source->triangle_count);
  rtcSetGeometryUserData(geometry, (void *)source);
  rtcSetGeometryBoundsFunction(geometry, bounds, NULL);
  rtcSetGeometryIntersectFunction(geometry, nearest);
  rtcSetGeometryOccludedFunction(geometry, any);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
  return true;
}

static struct RTCRay ray_of(const struct query *query) {
  return (struct RTCRay){.org_x = (float)query->origin.x,
                         .org_y = (float)query->origin.y,
                         .org_z = (float)query->origin.z,
                         .dir_x = (float)query->direction.x,
                         .dir_y = (float)query->direction.y,
                         .dir_z = (float)query->direction.z,
                         .tfar = (float)(query->limit * (1 + 0x1p-20)),
                         .mask = 0xFFFFFFFFu};
}

bool exact_nearest(RTCScene scene, struct double3 origin, struct double3 direction, struct exact_hit *hit) {
  struct query query = {.origin = origin, .direction = direction, .limit = INFINITY};
  rtcInitIntersectContext(&query.context);
  struct RTCRayHit ray = {.ray = ray_of(&query), .hit = {.geomID = RTC_INVALID_GEOMETRY_ID}};
  rtcIntersect1(scene, &query.context, &ray);
  *hit = query.hit;
  return query.found;
}

bool exact_any(RTCScene scene, struct double3 origin, struct double3 direction, double limit) {
  struct query query = {.origin = origin, .direction = direction, .limit = limit};
  rtcInitIntersectContext(&query.context);
  struct RTCRay ray = ray_of(&query);
  rtcOccluded1(scene, &query.context, &ray);
  return query.found;
}
