/* Where a scene is seen from, and its light. Files are libconfig:

     eye = [0.0, 1.0, 4.0];           position, scene units
     direction = [0.0, 0.0, -1.0];    or look_at = a point; any length
     up = [0.0, 1.0, 0.0];            any length, not parallel to the direction
     fov = 45.0;                      vertical, degrees, between 0 and 180
     light = [2.0, 5.0, 3.0];         the point light's position */
#ifndef TRAX_VIEW_H
#define TRAX_VIEW_H

#include "trax/emulator.h" /* trax_status, trax_error */

#ifdef __cplusplus
extern "C" {
#endif

struct trax_view {
  float eye[3];
  float direction[3]; /* unit length */
  float up[3];        /* unit length, perpendicular to direction */
  float fov;          /* vertical, degrees */
  float light[3];
};

/* All five keys are needed and no other is allowed. Messages read FILE:LINE: KEY: reason. */
trax_status trax_view_read(struct trax_view *view, const char *path, trax_error *error);

/* A view for a scene that has none: the whole of its bounds in the picture, seen from the front (+z), a little from the
   right and above, y up; the light above, to the left and in front. aspect is width / height. */
void trax_view_frame(struct trax_view *view, const float bounds_min[3], const float bounds_max[3], float aspect);

#ifdef __cplusplus
}
#endif

#endif
