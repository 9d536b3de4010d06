/* How far a picture is from what it should be. */
#ifndef TRAX_RENDER_METRICS_H
#define TRAX_RENDER_METRICS_H

#include "render.h"

/* Pictures here are R, G, B of each pixel, row by row from the top left, 0 to 255 with gamma 2 as in a picture of 8
   bits, but not rounded. */

struct trax_channel_errors {
  double rmse;    /* root of the mean square of the differences of all channels */
  double largest; /* difference */
};

void trax_channel_errors(struct trax_channel_errors *errors, const double *picture, const double *reference,
                         size_t pixels);

/* What the rays met that a program recorded, against what they meet in binary64 (trax_render_exact). */
struct trax_hit_errors {
  uint64_t samples;
  uint64_t missed;       /* samples whose ray should have hit something and hit nothing */
  uint64_t grown;        /* the reverse */
  uint64_t other;        /* another triangle, farther from the right one than TRAX_TIE */
  uint64_t tied;         /* another triangle within that: either answer is right */
  uint64_t shadow;       /* the right triangle or one tied with it, but light for shadow or the reverse */
  uint64_t wrong_pixels; /* with a sample that is missed, grown or other */
};

/* Where the ray meets the planes of two triangles, relatively: 32 units of 2^-24, the bound on the errors of a ray in
   binary32 that box_margin in frame.c allows for. */
#define TRAX_TIE 0x1p-19

/* recorded[i] is what the program recorded for the sample that exact->seen[i] is; both are of the frame. */
void trax_hit_errors(struct trax_hit_errors *errors, const struct trax_exact *exact,
                     const struct trax_sample_record *recorded, const struct trax_frame *frame);

/* The difference that an observer sees when two pictures are shown one after the other: LDR-FLIP (Andersson, Nilsson,
   Akenine-Moeller, Oskarsson, Astrom, Fairchild, "FLIP: A Difference Evaluator for Alternating Images", Proc. ACM
   Comput. Graph. Interact. Tech. 3(2), 2020), the mean over the pixels, 0 to 1, for 67 pixels to a degree: a screen of
   3,840 pixels and 0.7 m, at 0.7 m. */
trax_status trax_flip(double *mean, const double *picture, const double *reference, uint32_t width, uint32_t height,
                      trax_error *error);

#endif
