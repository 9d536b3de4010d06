/* Scene and views of the command line. */
#ifndef TRAX_RENDER_INPUTS_H
#define TRAX_RENDER_INPUTS_H

#include "environment.h"
#include "options.h"
#include "trax/progress.h"
#include "views.h"

struct inputs {
  struct trax_scene scene;
  struct trax_mesh_camera *cameras; /* of the meshes */
  uint32_t camera_count;
  struct trax_environment environment; /* if the options have one */
  struct trax_view view;               /* before it orbits; in the scene's unit of length as the files have it */
  char choice[VIEW_CHOICE_SIZE];       /* the choice of a view, in words; "": none */
  bool inside;                         /* the view is inside of a closed room */
  float centre[3];                     /* the point that it orbits; in a room the eye itself */
};

trax_status inputs_load(struct inputs *inputs, const struct options *options, trax_progress_line *progress,
                        trax_error *error);
/* Sets the view, after it has orbited. */
void inputs_view(struct trax_view *view, const struct inputs *inputs, const struct options *options);
void inputs_release(struct inputs *inputs);

#endif
