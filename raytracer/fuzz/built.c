#include "files.h"

#include <stdio.h>
#include <stdlib.h>

void fuzz_check_built(struct trax_scene *scene) {
  trax_error error = {.message = ""};
  if (trax_scene_check(NULL, scene->bytes, scene->size, "scene", &error) != TRAX_OK) {
    fprintf(stderr, "a scene that was built is refused: %s\n", error.message);
    abort();
  }
  trax_scene_release(scene);
}

void fuzz_build(const struct trax_mesh *mesh) {
  struct trax_scene scene;
  trax_error error = {.message = ""};
  const struct trax_build_options options = {.smooth = true, .allow_empty = true};
  if (trax_scene_build(&scene, mesh, &options, &error) != TRAX_OK) {
    if (mesh->instance_count && error.message[0])
      return; /* transforms of groups together may be singular, too large, or move a lamp */
    fprintf(stderr, "an imported mesh makes no scene: %s\n", error.message);
    abort();
  }
  fuzz_check_built(&scene);
}
