/* Binds the scene as plain arrays. */
#ifndef TRAX_RENDER_PLAIN_SCENE_H
#define TRAX_RENDER_PLAIN_SCENE_H

#include "trax/plain_scene.h"

#include "render.h"

/* Binds the arrays to those of their buffers that the machine's program defines. */
trax_status trax_plain_scene_bind(trax_machine *machine, const struct trax_scene *scene, trax_error *error);

#endif
