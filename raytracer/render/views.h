/* The views that come with trax, and the choice of a default view. */
#ifndef TRAX_RENDER_VIEWS_H
#define TRAX_RENDER_VIEWS_H

#include "options.h"

enum { VIEW_CHOICE_SIZE = 300 };

/* Whether --view names a camera of the meshes. If so, *camera is its name, "" for the first one. */
bool is_camera(const char *view, const char **camera);
/* Finds the file that it names otherwise. */
trax_status find_view(char path[TRAX_PATH_SIZE], const char *view, trax_error *error);

/* The view with the name of one of the meshes: bunny for models/bunny.obj.xz, forest for generate:forest. False: there
   is none, or the command line has a view of its own. */
bool known_view(char path[TRAX_PATH_SIZE], const struct options *options);

/* Prints their names, each with the first sentence of its file. */
void print_views(FILE *out);
void put_view_names(FILE *out); /* with blanks between */

/* The view without --view: that with the mesh's name, if it shows the scene, else the inside of a closed room (room.h),
   else all of the scene. *inside: it is a room; choice: which of the first two it is, in words, else "". */
trax_status default_view(struct trax_view *view, bool *inside, char choice[VIEW_CHOICE_SIZE],
                         const struct trax_scene *scene, const struct options *options, trax_error *error);

#endif
