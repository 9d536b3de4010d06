/* Statistics of a tree: its shape, and expected work by surface areas (MacDonald and Booth, "Heuristics for ray tracing
   using space subdivision", 1990). */
#include "internal.h"

#include <stdlib.h>

struct walk {
  const struct trax_scene *scene;
  struct trax_scene_stats *stats;
  double area, share; /* of the tree's box; of the rays that enter it */
  double *entered;    /* of the tree over instances: of each mesh, how often rays enter it; else NULL */
};

static uint32_t instances_offset(const struct trax_scene *scene) {
  return (uint32_t)((const char *)scene->instances - (const char *)scene->header);
}

static double half_area(const double min[3], const double max[3]) {
  const double x = max[0] - min[0], y = max[1] - min[1], z = max[2] - min[2];
  return x * y + y * z + z * x;
}

/* probability: that a ray which hits the scene's box enters the subtree at ref. */
static void measure(const struct walk *walk, trax_scene_ref ref, unsigned depth, double probability) {
  uint32_t count = TRAX_SCENE_REF_COUNT(ref);
  const uint32_t instances = walk->entered ? instances_offset(walk->scene) : 0;
  if (count && walk->entered) { /* the mesh is measured later */
    walk->entered[walk->scene->instances[(TRAX_SCENE_REF_OFFSET(ref) - instances) / sizeof *walk->scene->instances]
                      .mesh] += probability;
    return;
  }
  if (count) {
    walk->stats->leaves++;
    walk->stats->leaf_sizes[count]++;
    walk->stats->mean_leaf_depth += depth;
    walk->stats->sah_triangles += probability * count;
    return;
  }
  const struct trax_scene_section *section = &walk->scene->header->sections[TRAX_SCENE_NODES];
  struct trax_node_children node;
  trax_node_read(&node, walk->scene, (ref - section->offset) / section->record_size);
  walk->stats->sah_nodes += probability;
  for (uint32_t i = 0; i < node.count; i++)
    measure(walk, node.child[i], depth + 1,
            walk->area > 0 ? walk->share * half_area(node.min[i], node.max[i]) / walk->area : 0);
}

void trax_scene_measure(struct trax_scene_stats *stats, const struct trax_scene *scene) {
  *stats = (struct trax_scene_stats){0};
  if (scene->triangle_count == 0)
    return;
  const struct trax_scene_header *header = scene->header;
  struct walk walk = {.scene = scene,
                      .stats = stats,
                      .area = scene_half_area(header->bounds_min, header->bounds_max),
                      .share = 1,
                      .entered = scene->instances ? calloc(scene->mesh_count, sizeof *walk.entered) : NULL};
  if (scene->instances && !walk.entered)
    return;
  measure(&walk, header->root, 0, 1);
  double *const entered = walk.entered;
  walk.entered = NULL;
  for (uint32_t i = 0; i < scene->mesh_count; i++) {
    const struct trax_scene_mesh *mesh = &scene->meshes[i];
    walk.area = scene_half_area(mesh->bounds_min, mesh->bounds_max);
    walk.share = entered[i];
    measure(&walk, mesh->root, 0, entered[i]);
  }
  free(entered);
  stats->mean_leaf_depth /= stats->leaves;
}
