/* The log of the nodes and triangles that the twin reads, ray by ray and slot by slot. By one thread at a time. */
#ifndef TRAX_ACCESS_H
#define TRAX_ACCESS_H

#include <stdint.h>

/* An access: the record's offset in the scene, a multiple of 8, with a 1 added for a triangle. */
typedef uint32_t trax_access;
#define TRAX_ACCESS_TRIANGLE 1u

/* A ray, after it was traced. */
struct trax_traced_ray {
  float origin[3], direction[3];
  float farthest;    /* limit of the distances of hits, in units of the direction */
  uint32_t pixel;    /* y << 16 | x */
  uint32_t sample;   /* of the pixel */
  uint32_t kind;     /* enum trax_ray_kind */
  uint32_t found;    /* it hit something */
  uint32_t triangle; /* the nearest: bytes from the start of the scene; 0: none, or any hit sufficed */
  uint32_t instance; /* of the triangle: bytes from the start of the scene; 0: the scene has none */
  float distance, weight1,
      weight2; /* of that: in units of the direction; barycentric, of the second and third corner */
};

struct trax_access_log {
  trax_access *end, *limit; /* the place of the next one, and the end of the room */
  /* The log is full: makes room, or discards the entries. */
  void (*full)(struct trax_access_log *log);
  /* The slot is done, with this many rays; its accesses are those since the previous call. */
  void (*slot)(struct trax_access_log *log, uint32_t slot, uint32_t rays);
  /* The ray was traced; its accesses are those in the log since the call before, and those that were discarded. NULL:
     not called. */
  void (*ray)(struct trax_access_log *log, const struct trax_traced_ray *ray);
};

#endif
