/* Layers of a picture: the triangle that the first ray through each pixel met, its distance, normal and shadow. */
#ifndef TRAX_RENDER_LAYERS_H
#define TRAX_RENDER_LAYERS_H

#include "render.h"

struct trax_layers {
  uint32_t triangle; /* until trax_layers_finish its number in the scene file, TRAX_NO_TRIANGLE: none; then that in the
                        meshes plus 1, 0: none */
  uint32_t shadow;   /* enum trax_shadow: the first light ray of the paper's workload */
  float depth;       /* distance from the eye; 0 without a triangle */
  float normal[3];   /* the triangle's, of unit length, towards the eye */
};

/* Memory for layers and, if the frame's picture has none, for linear floats. Releases the picture on an error. */
trax_status trax_layers_init(struct trax_picture *picture, const struct trax_frame *frame, trax_error *error);
/* The size of trax/record.h's records. */
uint64_t trax_record_bytes(const struct trax_render_params *params);
/* Makes layers and the linear floats of the paper's workload from records. */
trax_status trax_layers_take(struct trax_picture *picture, const struct trax_frame *frame, const void *record,
                             trax_error *error);
/* Numbers in the meshes, depth and normal. The frame's scene was scaled by 2^scaled. */
void trax_layers_finish(struct trax_picture *picture, const struct trax_frame *frame, int scaled);

/* Two hits are tied if their distances differ by less than 32 units of 2^-24 relatively: the error bound of a ray in
   binary32 that box_margin in frame.c allows for. */
#define TRAX_TIE 0x1p-19

struct trax_layers_difference {
  uint64_t missed; /* pixels whose ray should have met something and met nothing */
  uint64_t grown;  /* the reverse */
  uint64_t other;  /* another triangle, beyond TRAX_TIE */
  uint64_t tied;   /* another triangle within TRAX_TIE; both are right */
  uint64_t wrong;  /* missed, grown or other */
  uint64_t shadow; /* the right or a tied triangle, but light for shadow or the reverse */
};

void trax_layers_compare(struct trax_layers_difference *difference, const struct trax_picture *picture,
                         const struct trax_picture *right);

#endif
