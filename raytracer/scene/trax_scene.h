/* trax-scene's command line. */
#ifndef TRAX_SCENE_PROGRAM_H
#define TRAX_SCENE_PROGRAM_H

#include "trax/options.h"
#include "trax/scene.h"

struct arguments {
  char **meshes; /* into argv */
  size_t mesh_count;
  const char *output, *check, *stats_json, *list_files, *write_triangles, *refit;
  const char *nodes, *splits; /* NULL: not given */
  bool stats, quiet;
  struct trax_import_options import; /* its overrides are released with free */
  struct trax_import_options base;   /* only the moment: of the tree that is refitted; moves: it is wanted */
  struct trax_build_options build;
};

extern const trax_command scene_command;

trax_parsed arguments_parse(struct arguments *arguments, int argc, char **argv, trax_error *error);

#endif
