/* The device program's records of its picture, for trax-render --layers. Only a program compiled with TRAX_RECORD
   (render/specialise.c) writes them, to its buffer `record`: a struct trax_pixel_record for each pixel of the picture,
   in its order, then a struct trax_sample_record for each sample of each pixel. */
#ifndef TRAX_RECORD_H
#define TRAX_RECORD_H

#include <stdint.h>

struct trax_pixel_record {
  float channel[3]; /* R, G, B as in the picture, 0 to 255, before rounding to whole numbers */
};

struct trax_sample_record {
  uint32_t triangle; /* the triangle that the ray from the eye hit: bytes from the start of the scene; 0: none */
  uint32_t shadow;   /* enum trax_shadow */
  uint32_t instance; /* of the triangle: bytes from the start of the scene; 0: the scene has none */
};

/* The result of the ray towards the light. */
enum trax_shadow { TRAX_SHADOW_NOT_ASKED, TRAX_SHADOW_LIT, TRAX_SHADOW_BLOCKED };

_Static_assert(sizeof(struct trax_pixel_record) == 12 && sizeof(struct trax_sample_record) == 12, "no padding");

#endif
