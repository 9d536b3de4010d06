/* The twin writes the rays that it traces, and the nodes and triangles that they read, to its log if it has one
   (trax/access.h). Programs of the TPs contain none of this. */
#ifndef TRAX_DEVICE_ACCESS_H
#define TRAX_DEVICE_ACCESS_H

#ifdef TRAX_TWIN

#include "algebra.h"
#include "bits.h"
#include "run.h"
#include "trax/access.h"
#include "triangle.h"

#include <stdbool.h>

extern struct trax_access_log *trax_access_log;

static inline void log_access(const char *record, trax_access kind) {
  struct trax_access_log *log = trax_access_log;
  if (__builtin_expect(!log, 1))
    return;
  if (log->end == log->limit)
    log->full(log);
  *log->end++ = (trax_access)(record - (const char *)scene.data) | kind;
}

static inline void log_slot(uint32_t slot) {
  if (!trax_access_log)
    return;
  trax_access_log->slot(trax_access_log, slot, (uint32_t)trax_native.rays);
  trax_native.rays = 0;
}

/* pixel: struct pixel's word; rays: the ray's term of trax_count_kinds, 0 for one from the eye. */
static inline void log_ray(uint32_t pixel, uint32_t sample, uint32_t rays, struct vector origin,
                           struct vector direction, int32_t farthest, bool found, const struct hit *hit) {
  if (!trax_access_log || !trax_access_log->ray)
    return;
  const struct trax_traced_ray ray = {
      .origin = {origin.x, origin.y, origin.z},
      .direction = {direction.x, direction.y, direction.z},
      .farthest = bits_float(farthest),
      .pixel = pixel,
      .sample = sample,
      .kind = rays ? (uint32_t)__builtin_ctz(rays) / TRAX_KIND_BITS : TRAX_RAY_PRIMARY,
      .found = found,
      .triangle = hit->triangle ? (uint32_t)(hit->triangle - (const char *)scene.data) : 0,
      .instance = hit->triangle && hit->instance ? (uint32_t)(hit->instance - (const char *)scene.data) : 0,
      .distance = bits_float(hit->distance_bits),
      .weight1 = hit->weight1,
      .weight2 = hit->weight2};
  trax_access_log->ray(trax_access_log, &ray);
}

#define ACCESS_RAY(pixel, sample, rays, origin, direction, farthest, found, hit)                                       \
  log_ray(pixel, sample, rays, origin, direction, farthest, found, hit)
#define ACCESS_NODE(node) log_access(node, 0)
#define ACCESS_TRIANGLE(triangle) log_access(triangle, TRAX_ACCESS_TRIANGLE)
#define ACCESS_SLOT(slot) log_slot(slot)

#else
#define ACCESS_RAY(pixel, sample, rays, origin, direction, farthest, found, hit) ((void)0)
#define ACCESS_NODE(node) ((void)0)
#define ACCESS_TRIANGLE(triangle) ((void)0)
#define ACCESS_SLOT(slot) ((void)0)
#endif

#endif
