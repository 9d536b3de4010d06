/* One ray through Embree's BVH, by Embree 3 or 4, whose queries take their context in different ways. */
#ifndef TRAX_RENDER_RTC_QUERY_H
#define TRAX_RENDER_RTC_QUERY_H

#include "double3.h"

#include <rtcore.h>

/* A ray from origin to origin + far * direction. */
static inline struct RTCRay rtc_ray(struct double3 origin, struct double3 direction, float far) {
  return (struct RTCRay){.org_x = (float)origin.x,
                         .org_y = (float)origin.y,
                         .org_z = (float)origin.z,
                         .dir_x = (float)direction.x,
                         .dir_y = (float)direction.y,
                         .dir_z = (float)direction.z,
                         .tfar = far,
                         .mask = 0xFFFFFFFFu};
}

#if RTC_VERSION_MAJOR >= 4

typedef struct RTCRayQueryContext rtc_context;

static inline void rtc_intersect(RTCScene scene, rtc_context *context, struct RTCRayHit *ray) {
  struct RTCIntersectArguments arguments;
  rtcInitRayQueryContext(context);
  rtcInitIntersectArguments(&arguments);
  arguments.context = context;
  rtcIntersect1(scene, ray, &arguments);
}

static inline void rtc_occluded(RTCScene scene, rtc_context *context, struct RTCRay *ray) {
  struct RTCOccludedArguments arguments;
  rtcInitRayQueryContext(context);
  rtcInitOccludedArguments(&arguments);
  arguments.context = context;
  rtcOccluded1(scene, ray, &arguments);
}

#else

typedef struct RTCIntersectContext rtc_context;

static inline void rtc_intersect(RTCScene scene, rtc_context *context, struct RTCRayHit *ray) {
  rtcInitIntersectContext(context);
  rtcIntersect1(scene, context, ray);
}

static inline void rtc_occluded(RTCScene scene, rtc_context *context, struct RTCRay *ray) {
  rtcInitIntersectContext(context);
  rtcOccluded1(scene, context, ray);
}

#endif

#endif
