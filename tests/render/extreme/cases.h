/* The extreme suite's scenes and rays. */
#ifndef TRAX_EXTREME_CASES_H
#define TRAX_EXTREME_CASES_H

#include "../meshes.h"
#include "query.h"

#include <stdbool.h>
#include <stdint.h>

/* What make() fills, all of it zero before. */
struct setup {
  struct trax_mesh mesh;
  struct trax_scene premade; /* instead of the mesh */
  struct trax_build_options build;
  bool turned; /* the children of every node change places */
  struct query_ray *rays;
  uint32_t ray_count, ray_capacity;
  float light[3];
  struct trax_view view;  /* of cases with pictures: the rays are its pixels' */
  uint32_t width, height; /* 0: no picture */
  uint32_t seed;
};

enum case_flags {
  CASE_CLOSED = 1,          /* every ray is inside a closed surface: none may escape */
  CASE_SHADOWS = 2,         /* with rays to the light */
  CASE_DUPLICATES = 4,      /* of triangles at equal distances the one with the lowest number must win */
  CASE_HARDWARE = 8,        /* the picture on machines at the ends of what there is */
  CASE_MANY_RAYS = 16,      /* a hundred times as many rays; a sample is judged exactly */
  CASE_BELOW_ROUNDING = 32, /* the scene is finer than binary32 at that place: what is lost is shown, not forbidden */
  CASE_DEPTH = 64           /* short stacks on the emulated machine, too */
};

struct extreme_case {
  const char *name, *what;
  void (*make)(struct setup *setup, uint32_t rays);
  unsigned flags;
};

extern const struct extreme_case extreme_cases[];
extern const unsigned extreme_case_count;

void setup_release(struct setup *setup);

#endif
