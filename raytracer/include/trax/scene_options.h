/* Options that trax-scene and trax-render share: parsers for rows of their tables (trax/options.h). */
#ifndef TRAX_SCENE_OPTIONS_H
#define TRAX_SCENE_OPTIONS_H

#include "trax/options.h"
#include "trax/scene.h"

/* --diffuse and --material; the row's member is a struct trax_import_options, whose overrides are from malloc. */
trax_status trax_take_diffuse(void *target, const trax_option *option, const char *value, trax_error *error);
trax_status trax_take_material(void *target, const trax_option *option, const char *value, trax_error *error);
void trax_put_material_kinds(FILE *out); /* what the completion offers */
/* The moment; the row's member is a struct trax_import_options. */
trax_status trax_take_at(void *target, const trax_option *option, const char *value, trax_error *error);
/* An unsigned. */
trax_status trax_take_texture_size(void *target, const trax_option *option, const char *value, trax_error *error);
/* A size_t. */
trax_status trax_take_unpack_limit(void *target, const trax_option *option, const char *value, trax_error *error);
/* A const char * for trax_node_layout_choose and trax_splits_choose; NULL without the option. */
trax_status trax_take_nodes(void *target, const trax_option *option, const char *value, trax_error *error);
trax_status trax_take_splits(void *target, const trax_option *option, const char *value, trax_error *error);
extern const char *const trax_node_words[], *const trax_normals_words[]; /* what the completion offers */
/* A struct trax_build_options. */
trax_status trax_take_normals(void *target, const trax_option *option, const char *value, trax_error *error);

#endif
