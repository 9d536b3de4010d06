/* Environment maps: pictures of the light from all directions, made into texels that the device program looks up and
   samples (device/environment.h). */
#ifndef TRAX_RENDER_ENVIRONMENT_H
#define TRAX_RENDER_ENVIRONMENT_H

#include "render.h"

#define TRAX_ENVIRONMENT_LOG2 8u /* of the texels along a side */

struct trax_environment {
  float (*radiance)[3]; /* of each texel, row by row, linear, 0 to TRAX_MAX_RADIANCE; from malloc */
  double *probability;  /* that a shadow ray goes to the texel; from malloc; they add up to 1, or all are 0 */
  struct trax_environment_alias *aliases; /* draws from them: Vose, "A linear algorithm for generating random numbers
                                             with a given distribution" (IEEE TSE 17(9), 1991); from malloc */
};

/* Reads an EXR, HDR, PFM or PNG: columns are longitudes, the middle one the direction -z and the right half +x; rows
   are latitudes from +y down to -y. It is turned by `turn` degrees about y, from -z towards +x. Errors: no picture,
   light that is not finite or negative. Release it in any case. */
trax_status trax_environment_read(struct trax_environment *environment, const char *path, float strength, double turn,
                                  trax_error *error);
void trax_environment_release(struct trax_environment *environment);

#endif
