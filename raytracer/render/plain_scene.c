/* The scene as plain arrays (trax/plain_scene.h). */
#include "plain_scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct walk {
  struct trax_plain_node *nodes;
  const struct trax_scene *scene;
  uint32_t used;
};

/* The greatest float that is not above the value: planes of quantised boxes need not be floats. */
static float not_above(double value) {
  const float rounded = (float)value;
  return rounded > value ? nextafterf(rounded, -INFINITY) : rounded;
}

/* Recursion is as deep as the tree: TRAX_PLAIN_MAX_DEPTH. */
static void place(struct walk *walk, uint32_t number, trax_scene_ref reference) {
  struct trax_plain_node *node = &walk->nodes[number];
  const uint32_t offset = TRAX_SCENE_REF_OFFSET(reference);
  if (TRAX_SCENE_REF_COUNT(reference)) {
    const uint32_t triangles = walk->scene->header->sections[TRAX_SCENE_TRIANGLES].offset;
    node->count = (int32_t)TRAX_SCENE_REF_COUNT(reference);
    node->first = (offset - triangles) / (uint32_t)sizeof(struct trax_triangle);
    return;
  }
  const struct trax_scene_section *section = &walk->scene->header->sections[TRAX_SCENE_NODES];
  struct trax_node_children source;
  trax_node_read(&source, walk->scene, (offset - section->offset) / section->record_size);
  const uint32_t first = walk->used;
  walk->used += 2;
  node->count = -1;
  node->first = first;
  for (uint32_t child = 0; child < 2; child++) {
    for (int axis = 0; axis < 3; axis++) {
      walk->nodes[first + child].min[axis] = not_above(source.min[child][axis]);
      walk->nodes[first + child].max[axis] = -not_above(-source.max[child][axis]);
    }
    place(walk, first + child, source.child[child]);
  }
}

static trax_status make_nodes(struct trax_plain_node **nodes, const struct trax_scene *scene, uint32_t count,
                              trax_error *error) {
  *nodes = calloc(count, sizeof **nodes);
  if (!*nodes)
    return trax_fail(error, "out of memory for the scene as plain arrays");
  struct walk walk = {*nodes, scene, 2};
  memcpy((*nodes)->min, scene->header->bounds_min, sizeof(*nodes)->min);
  memcpy((*nodes)->max, scene->header->bounds_max, sizeof(*nodes)->max);
  if (scene->header->root)
    place(&walk, 0, scene->header->root);
  return TRAX_OK;
}

trax_status trax_plain_scene_bind(trax_machine *machine, const struct trax_scene *scene, trax_error *error) {
  trax_status status = TRAX_OK;
  if (trax_program_has(machine, "plain_nodes")) {
    if (scene->header->max_depth > TRAX_PLAIN_MAX_DEPTH)
      return trax_fail(error,
                       "the program takes scenes of %d nodes from the root to a leaf, not %u (trax-scene --depth)",
                       TRAX_PLAIN_MAX_DEPTH, scene->header->max_depth);
    if (trax_node_formats[scene->header->node_layout].children > 2)
      return trax_fail(error, "the program takes nodes of two children, not %s ones (--nodes binary)",
                       trax_node_formats[scene->header->node_layout].name);
    const uint32_t count = 2 * scene->node_count + 2;
    struct trax_plain_node *nodes = NULL;
    status = make_nodes(&nodes, scene, count, error);
    if (status == TRAX_OK)
      status = trax_machine_bind(machine, "plain_nodes", nodes, count * (uint32_t)sizeof *nodes, error);
    free(nodes);
  }
  _Static_assert(sizeof(struct trax_plain_triangle) == sizeof(struct trax_triangle), "the same record");
  if (status == TRAX_OK && trax_program_has(machine, "plain_triangles"))
    status = trax_machine_bind(machine, "plain_triangles", scene->triangles,
                               scene->triangle_count * (uint32_t)sizeof *scene->triangles, error);
  return status;
}
