/* The binary file of rays and their results (docs/traces.md, "Rays"), little endian. --ray-trace and --ray-results
   write it, --rays reads it. */
#ifndef TRAX_RENDER_RAY_FILE_H
#define TRAX_RENDER_RAY_FILE_H

#include <stdint.h>

struct trax_ray_file_header {
  char magic[8];
  uint32_t record_bytes;
  uint32_t width, height, samples; /* of the picture; zeros: of none */
  int32_t exponent;                /* coordinates are the scene's times 2^exponent */
  uint32_t exact;                  /* 1: hits without error (device/exact.h); 0: in binary32 */
};

#define TRAX_RAY_FILE_MAGIC "traxray1"

struct trax_ray_record {
  float origin[3], direction[3];
  float begin, end; /* of the interval in which hits count, in units of the direction */
  uint16_t x, y, sample;
  uint8_t kind;      /* enum trax_ray_kind */
  uint8_t hit;       /* 1: it hit something */
  uint32_t triangle; /* the nearest one's number in the meshes; TRAX_NO_TRIANGLE: none, or any hit sufficed */
  float distance, weight1, weight2; /* of that hit */
  uint32_t nodes, triangles;        /* that the ray visited and was tested with; zeros: not counted */
};

_Static_assert(sizeof(struct trax_ray_file_header) == 32 && sizeof(struct trax_ray_record) == 64, "no padding");

#endif
