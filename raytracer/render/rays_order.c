/* Orders of rays. A key ends with the place of its ray in the file, so that no two keys are equal. */
#include "rays.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct key {
  uint64_t first, second;
  uint32_t number;
};

static int compare_keys(const void *a, const void *b) {
  const struct key *k = a, *l = b;
  if (k->first != l->first)
    return k->first < l->first ? -1 : 1;
  if (k->second != l->second)
    return k->second < l->second ? -1 : 1;
  return k->number < l->number ? -1 : k->number > l->number;
}

/* --- RANDOM --- */

/* SplitMix64 (G. Steele, D. Lea, C. Flood, "Fast Splittable Pseudorandom Number Generators", OOPSLA 2014). */
static uint64_t mixed(uint64_t number) {
  uint64_t z = (number + 1) * 0x9E3779B97F4A7C15u;
  z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9u;
  z = (z ^ z >> 27) * 0x94D049BB133111EBu;
  return z ^ z >> 31;
}

/* --- MORTON --- */

enum { CELL_BITS = 5, PLACE_BITS = 16 }; /* along an axis */

struct box {
  double min[3], max[3];
};

static struct box box_of_origins(const struct trax_rays *rays) {
  struct box box = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
  for (uint32_t i = 0; i < rays->count; i++)
    for (int axis = 0; axis < 3; axis++) {
      box.min[axis] = fmin(box.min[axis], (double)rays->records[i].origin[axis]);
      box.max[axis] = fmax(box.max[axis], (double)rays->records[i].origin[axis]);
    }
  return box;
}

static uint64_t morton_key(const struct trax_ray_record *ray, const struct box *box) {
  uint32_t place[3];
  uint64_t code = 0, signs = 0;
  for (int axis = 0; axis < 3; axis++) {
    const double extent = box->max[axis] - box->min[axis];
    const double part = extent > 0 ? ((double)ray->origin[axis] - box->min[axis]) / extent : 0;
    place[axis] = (uint32_t)(part * ((1u << PLACE_BITS) - 1));
    signs = signs << 1 | (signbit(ray->direction[axis]) != 0);
  }
  for (int bit = PLACE_BITS - 1; bit >= 0; bit--) {
    for (int axis = 0; axis < 3; axis++)
      code = code << 1 | (place[axis] >> bit & 1);
    if (bit == PLACE_BITS - CELL_BITS)
      code = code << 3 | signs;
  }
  return code;
}

/* --- TREELET --- */

struct tree {
  const struct trax_scene *scene;
  uint32_t *bytes; /* of each node's subtree, with its triangles */
  uint32_t treelet_bytes;
};

static uint32_t number_of(const struct trax_scene *scene, trax_scene_ref reference) {
  return (TRAX_SCENE_REF_OFFSET(reference) - scene->header->sections[TRAX_SCENE_NODES].offset) /
         trax_node_formats[scene->header->node_layout].bytes;
}

/* Recursion is bounded by the tree's depth, at most TRAX_SCENE_MAX_DEPTH. */
static uint32_t measure(struct tree *tree, trax_scene_ref reference) {
  struct trax_node_children node;
  if (TRAX_SCENE_REF_COUNT(reference))
    return TRAX_SCENE_REF_COUNT(reference) * (uint32_t)sizeof(struct trax_triangle);
  const uint32_t number = number_of(tree->scene, reference);
  trax_node_read(&node, tree->scene, number);
  tree->bytes[number] = trax_node_formats[tree->scene->header->node_layout].bytes;
  for (uint32_t i = 0; i < node.count; i++)
    tree->bytes[number] += measure(tree, node.child[i]);
  return tree->bytes[number];
}

/* The distance at which a ray enters a box; infinity: it misses. */
static double enter(const struct trax_ray_record *ray, const double min[3], const double max[3]) {
  double near = 0, far = ray->end;
  for (int axis = 0; axis < 3; axis++) {
    const double origin = ray->origin[axis], direction = ray->direction[axis];
    if (direction == 0 && (origin < min[axis] || origin > max[axis]))
      return INFINITY;
    if (direction == 0)
      continue;
    const double a = (min[axis] - origin) / direction, b = (max[axis] - origin) / direction;
    near = fmax(near, fmin(a, b));
    far = fmin(far, fmax(a, b));
  }
  return near <= far ? near : INFINITY;
}

/* The offset of the treelet's root, or of the last node that the ray enters. */
static uint64_t treelet_of(const struct tree *tree, const struct trax_ray_record *ray) {
  trax_scene_ref at = tree->scene->header->root;
  while (at && !TRAX_SCENE_REF_COUNT(at) && tree->bytes[number_of(tree->scene, at)] > tree->treelet_bytes) {
    struct trax_node_children node;
    trax_node_read(&node, tree->scene, number_of(tree->scene, at));
    uint32_t nearest = 0;
    double first = INFINITY;
    for (uint32_t i = 0; i < node.count; i++) {
      const double here = enter(ray, node.min[i], node.max[i]);
      nearest = here < first ? i : nearest;
      first = fmin(here, first);
    }
    if (isinf(first))
      break;
    at = node.child[nearest];
  }
  return at;
}

/* --- all of them --- */

static trax_status order_rays(struct trax_rays *rays, struct key *keys, enum trax_ray_order order,
                              const struct trax_scene *scene, uint32_t treelet_bytes, trax_error *error) {
  const struct box box = box_of_origins(rays);
  struct tree tree = {.scene = scene, .treelet_bytes = treelet_bytes};
  if (order == TRAX_RAYS_TREELET) {
    tree.bytes = calloc(scene->node_count + 1, sizeof *tree.bytes);
    if (!tree.bytes)
      return trax_fail(error, "out of memory for the treelets of %u nodes", scene->node_count);
    if (scene->header->root)
      measure(&tree, scene->header->root);
  }
  for (uint32_t i = 0; i < rays->count; i++) {
    const struct trax_ray_record *ray = &rays->records[i];
    keys[i] = (struct key){.number = i};
    if (order == TRAX_RAYS_RANDOM)
      keys[i].first = mixed(i);
    if (order == TRAX_RAYS_TREELET)
      keys[i].first = treelet_of(&tree, ray);
    if (order == TRAX_RAYS_TREELET || order == TRAX_RAYS_MORTON)
      keys[i].second = morton_key(ray, &box);
  }
  free(tree.bytes);
  qsort(keys, rays->count, sizeof *keys, compare_keys);
  for (uint32_t i = 0; i < rays->count; i++)
    rays->order[i] = keys[i].number;
  return TRAX_OK;
}

trax_status trax_rays_order(struct trax_rays *rays, enum trax_ray_order order, const struct trax_scene *scene,
                            uint32_t treelet_bytes, trax_error *error) {
  if (order == TRAX_RAYS_FOUND)
    return TRAX_OK;
  struct key *keys = malloc(rays->count * sizeof *keys);
  const trax_status status = keys ? order_rays(rays, keys, order, scene, treelet_bytes, error)
                                  : trax_fail(error, "out of memory for the order of %u rays", rays->count);
  free(keys);
  return status;
}
