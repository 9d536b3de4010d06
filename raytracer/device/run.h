/* The parameters of the run. The general program finds everything in its parameters. A specialised one is
   compiled behind a file of constants (render/specialise.c writes it) that has

     TRAX_SPECIALISED_FEATURES   the features that the picture needs
     TRAX_TREE_DEPTH             that of this scene
     TRAX_NODE_LAYOUT            that of this scene
     trax_constants              the parameters and what follows them: the first colour of the palette, or struct
                                 trax_path_params; the compiler folds their loads into the instructions

   References of its scene are addresses, which saves an addition for each node and leaf. Those of leaves are negated,
   so that one branch tells them from those of nodes. */
#ifndef TRAX_DEVICE_RUN_H
#define TRAX_DEVICE_RUN_H

#include "bits.h"
#include "trax/render_params.h"
#include "trax/scene_format.h"

#include <stdbool.h>
#include <trax.h>

extern struct trax_buffer scene, params, image;

#ifdef TRAX_SPECIALISED_FEATURES
#define RUN_FEATURES(run) TRAX_SPECIALISED_FEATURES
#else
#define RUN_FEATURES(run) ((run)->features)
#endif

/* Whether the picture needs the feature NAME of features.def. */
#define NEEDS(run, NAME) ((RUN_FEATURES(run) >> TRAX_FEATURE_##NAME & 1u) != 0)

/* Whether rays of the paper's workload are counted where they begin. If not, a pixel's rays are counted at its end. */
#ifdef TRAX_SPECIALISED_FEATURES
#define MARKS_RAYS(run) NEEDS(run, RAY_KINDS)
#else
#define MARKS_RAYS(run) 0
#endif

/* Whether path.h renders the picture, rather than the paper's workload. */
#define NEEDS_PATHS(run) ((RUN_FEATURES(run) & TRAX_PATH_FEATURES) != 0)

/* Whether two loops over nodes fit in the paper's instruction cache: not with samples, smooth normals or path.h. */
#ifdef TRAX_SPECIALISED_FEATURES
#define LOOPS_FOR_BOTH_SIGNS                                                                                           \
  (!(NEEDS(0, SAMPLES) || NEEDS(0, SMOOTH) || (TRAX_SPECIALISED_FEATURES & TRAX_PATH_FEATURES)))
#else
#define LOOPS_FOR_BOTH_SIGNS 0
#endif

/* The layout of the scene's nodes (enum trax_node_layout). */
#ifdef TRAX_NODE_LAYOUT
#define RUN_LAYOUT(run) TRAX_NODE_LAYOUT
#else
#define RUN_LAYOUT(run) ((run)->node_layout)
#endif

/* The defaults of a general program. */
#ifndef TRAX_TREE_DEPTH
#define TRAX_TREE_DEPTH TRAX_SCENE_MAX_DEPTH
#endif

#if defined TRAX_SPECIALISED_FEATURES && !defined TRAX_PARAMS_IN_MEMORY
#define RUN_PARAMS (&trax_constants.params)
#define RUN_PATH(run) ((const struct trax_path_params *)(const void *)&trax_constants.behind)
#define RUN_PALETTE(run)                                                                                               \
  (NEEDS(run, MATERIALS) ? PALETTE_BEHIND((const struct trax_render_params *)params.data)                              \
                         : (const struct trax_palette_entry *)(const void *)&trax_constants.behind)
#define LOAD_AGAIN(run) ((void)0)
#else
#define RUN_PARAMS ((const struct trax_render_params *)params.data)
#define RUN_PATH(run) ((const struct trax_path_params *)((run) + 1))
#define RUN_PALETTE(run) PALETTE_BEHIND(run)
/* Members of *run are loaded again from here on, not kept in registers across the code before. */
#define LOAD_AGAIN(run) HIDE_ORIGIN(run)
#endif
#define PALETTE_BEHIND(params) ((const struct trax_palette_entry *)((params) + 1))

/* Whether the scene has instances (instance.h). The general programs of the TPs know none. */
#ifdef TRAX_TWIN
#define TRAX_INSTANCES 1
#define HAS_INSTANCES NEEDS((const struct trax_render_params *)params.data, INSTANCES)
#elif TRAX_INSTANCES
#define HAS_INSTANCES 1
#endif

/* A table behind trax_path_params. */
static inline const void *path_table(uint32_t offset) {
  return (const char *)params.data + sizeof(struct trax_render_params) + offset;
}

static inline bool leads_to_leaf(trax_scene_ref reference) {
#ifdef TRAX_SPECIALISED_FEATURES
  return (int32_t)reference < 0;
#else
  return TRAX_SCENE_REF_COUNT(reference) != 0;
#endif
}

/* A leaf's place and number of triangles, from a reference to a leaf. */
static inline trax_scene_ref leaf_of(trax_scene_ref reference) {
#ifdef TRAX_SPECIALISED_FEATURES
  return -reference;
#else
  return reference;
#endif
}

#define NO_LEAF leaf_of(1) /* where the scene's header is */

/* The address of a node or triangle, from a reference without its low three bits. */
static inline const char *scene_at(const char *scene_bytes, uint32_t offset) {
#ifdef TRAX_SPECIALISED_FEATURES
  (void)scene_bytes;
  return (const char *)offset;
#else
  return scene_bytes + offset;
#endif
}

#ifdef TRAX_SPECIALISED_FEATURES
static inline void check_scene(const struct trax_scene_header *header) {
  if (header->base != (uint32_t)header)
    trax_abort("the scene's references are addresses of another place than where it is bound");
}
#else
static inline void check_scene(const struct trax_scene_header *header) {
  if (header->max_depth > TRAX_TREE_DEPTH)
    trax_abort("the scene is deeper than this program's stack");
}
#endif

#endif
