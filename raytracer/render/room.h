/* Finds a view inside a closed room, whose walls hide everything from outside. */
#ifndef TRAX_RENDER_ROOM_H
#define TRAX_RENDER_ROOM_H

#include "render.h"

/* The rule. Places are those of a grid in the scene's box. One is enclosed if nearly every ray of a sphere around it
   hits something near, that is, in the scene, and most of these rays hit the front of a triangle: from within a solid
   thing they hit backs. The scene is a closed room if many places are enclosed. The eye is at the enclosed place in the
   lower half from which some level direction is deepest, and looks there. The light is at the enclosed place that
   reaches most of what the eye sees. Rays, places and comparisons are the same on every host.

   *inside: whether the scene is a closed room; if not, *view is left as it was. view: of trax_view_frame; up: the
   direction that it was given; aspect: width / height. */
trax_status trax_view_room(struct trax_view *view, bool *inside, const struct trax_scene *scene, const float up[3],
                           float aspect, trax_error *error);

/* Whether a view shows the scene: at least a tenth of the rays of a coarse picture hit something. */
trax_status trax_view_shows(bool *shows, const struct trax_view *view, const struct trax_scene *scene, float aspect,
                            trax_error *error);

#endif
