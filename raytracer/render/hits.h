/* The triangles that rays through the middles of pixels hit: by the device program, by Embree, and without error. */
#ifndef TRAX_RENDER_HITS_H
#define TRAX_RENDER_HITS_H

#include "render.h"

struct trax_hits {
  uint32_t width, height;
  uint32_t *triangles; /* numbers in the scene file, TRAX_NO_TRIANGLE: none; row by row from the top left */
};

/* Finds hits by the device program compiled for the host, which records them (trax/record.h); twin.c. Holes are
   surfaces. */
trax_status trax_hits_native(struct trax_hits *hits, const struct trax_frame *frame, unsigned threads,
                             struct trax_render_run *run, trax_error *error);
/* Finds hits by Embree in robust mode; embree.c. */
trax_status trax_hits_embree(struct trax_hits *hits, const struct trax_frame *frame, struct trax_render_run *run,
                             trax_error *error);
/* Finds hits without error (exact.h); embree.c. */
trax_status trax_hits_exact(struct trax_hits *hits, const struct trax_frame *frame, struct trax_render_run *run,
                            trax_error *error);
void trax_hits_release(struct trax_hits *hits);

struct trax_hits_difference {
  uint64_t pixels, same;
  uint64_t tied;  /* another answer that rounding explains */
  uint64_t holes; /* of the other pixels: the ray hits a triangle, the answer is none */
  uint64_t wrong; /* of the other pixels: any other wrong answer */
  uint32_t x, y;  /* the first of those two */
};

/* Judges answers of the device program by the exact hits. Triangles with the same number in the mesh are the
   same.

   In exact hits (TRAX_FEATURE_EXACT) only the distance is rounded. Another triangle is tied with the nearest one if the
   ray hits it, too, and the distances are within 2^-21 of each other.

   For other hits, rounding explains an answer if a watertight test can give it in which each coordinate of a vertex
   across the ray is off by 14 units of 2^-24 of its distance (frame.c adds them up), or of TRAX_REACH times the
   distance of the hit, which is more in every scene whose hits are not exact (reach.h). That is, the ray passes through
   the triangle or within that error of an edge, and the nearest triangle need not be found before it. */
void trax_hits_judge(struct trax_hits_difference *difference, const struct trax_hits *answers,
                     const struct trax_hits *exact, const struct trax_frame *frame);

/* The number of pixels that have the same triangle. */
uint64_t trax_hits_same(const struct trax_hits *a, const struct trax_hits *b, const struct trax_frame *frame);

#endif
