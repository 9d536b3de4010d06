/* The camera of a scene, and its lights. Files are libconfig:

     eye = [0.0, 1.0, 4.0];           position, scene units
     direction = [0.0, 0.0, -1.0];    or look_at = a point; any length
     up = [0.0, 1.0, 0.0];            any length, not parallel to the direction
     fov = 45.0;                      vertical, degrees, between 0 and 180
     light = [2.0, 5.0, 3.0];         the point light's position

   A view may have several lights of other kinds instead of the paper's `light`:

     lights = (
       { type = "point"; position = [2.0, 5.0, 3.0]; colour = [1.0, 0.9, 0.8]; strength = 0.5; falloff = 4.0; },
       { type = "directional"; direction = [0.0, -1.0, 0.3]; },
       { type = "rectangle"; corner = [-1.0, 3.0, -1.0]; edges = ( [2.0, 0.0, 0.0], [0.0, 0.0, 2.0] ); strength = 8.0; }
     );

   The defaults are white for colour, 1 for strength and 0 for falloff. */
#ifndef TRAX_VIEW_H
#define TRAX_VIEW_H

#include "trax/status.h"

#include <stdbool.h>
#include <stdint.h>

#define TRAX_VIEW_MAX_LIGHTS 16
#define TRAX_VIEW_MAX_STRENGTH 1e6f

enum trax_light_kind {
  TRAX_LIGHT_POINT,
  TRAX_LIGHT_DIRECTIONAL, /* from infinitely far away */
  TRAX_LIGHT_RECTANGLE    /* emits from one side */
};

/* A light. Its effect is in linear RGB, in units in which a white surface that reflects 1 is as bright as the picture
   can be. A white Lambert surface that faces a point or directional light reflects colour * strength, at any distance
   d if falloff is 0, else times (falloff / d)^2. A rectangle has the radiance colour * strength. */
struct trax_light {
  enum trax_light_kind kind;
  float position[3];  /* of a point light, or of a corner of the rectangle */
  float direction[3]; /* unit length: from a directional light, or the way a rectangle faces, edges[0] x edges[1] */
  float edges[2][3];  /* of a rectangle, perpendicular to each other */
  float colour[3];    /* linear RGB, 0 to 1 */
  float strength;     /* 0 to TRAX_VIEW_MAX_STRENGTH */
  float falloff;      /* of a point light: the distance at which strength applies, scene units; 0: everywhere */
};

struct trax_view {
  bool has_look_at;
  float look_at[3]; /* the point that the view was aimed at, if there is one */
  float eye[3];
  float direction[3]; /* unit length */
  float up[3];        /* unit length, perpendicular to direction */
  float fov;          /* vertical, degrees */
  float light[3];     /* if light_count is 0: a white point light of the strength that ambient light leaves */
  uint32_t light_count;
  struct trax_light lights[TRAX_VIEW_MAX_LIGHTS];
};

/* All five keys are required, with `lights` or `light`, and no other key is allowed. Messages read FILE:LINE: KEY:
   reason, or lights[NUMBER].KEY, from 0. */
trax_status trax_view_read(struct trax_view *view, const char *path, trax_error *error);

struct trax_scene;

/* A view for a scene without one: the whole scene, centred, in 80 % of the picture's width or of its height. The eye is
   in front (+z), a little to the right and above, and y is up; the light is above, to the left and in front. Everything
   turns with `up`, by the smallest rotation that takes the y axis there. fov: degrees; 0: 40. aspect: width / height.
   */
void trax_view_frame(struct trax_view *view, const struct trax_scene *scene, const float up[3], float fov,
                     float aspect);

/* Looks from the eye at a point. Errors: the point is the eye. */
trax_status trax_view_aim(struct trax_view *view, const float look_at[3], trax_error *error);
/* Sets up, which need not be perpendicular. Errors: no length, or parallel to the direction. */
trax_status trax_view_set_up(struct trax_view *view, const float up[3], trax_error *error);

/* Raises eye and camera by `elevation` degrees around a point, then turns them by `angle` degrees, counterclockwise
   from above, around the coordinate axis that points most upwards. Lights do not move. */
void trax_view_orbit(struct trax_view *view, const float centre[3], float angle, float elevation);

/* Writes a view file that reads back as this view. It is written under a temporary name and renamed. */
trax_status trax_view_write(const struct trax_view *view, const char *path, trax_error *error);

#endif
