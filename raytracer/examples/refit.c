/* Refits a tree on the TPs: the scene's triangles have moved, and its nodes get new boxes, from the leaves up. Binary
   nodes. docs/motion.md has the commands and what it takes.

   Of a node's two children the one that is done last, as a counter says, goes on to the parent. */
#include "layouts/records.h"

#include <stdio.h>
#include <trax.h>
#include <trax/parallel.h>

enum { GRAIN = 16 };
#define NO_PARENT UINT32_MAX

struct trax_buffer scene;   /* a scene file with binary nodes */
struct trax_buffer links;   /* of each node: its place in its parent, 2 * parent + child; NO_PARENT */
struct trax_buffer arrived; /* of each node: children that are done; zeros */

struct box {
  float min[3], max[3];
};

static struct trax_bvh_node *nodes;
static unsigned node_count, first_node; /* the offset of the first */

static inline float smaller(float a, float b) {
  return b < a ? b : a;
}
static inline float larger(float a, float b) {
  return b > a ? b : a;
}

static inline void add(struct box *box, const float point[3]) {
  for (int axis = 0; axis < 3; axis++) {
    box->min[axis] = smaller(box->min[axis], point[axis]);
    box->max[axis] = larger(box->max[axis], point[axis]);
  }
}

static struct box leaf_box(trax_scene_ref ref) {
  const struct trax_triangle *triangle = (const void *)((const char *)scene.data + TRAX_SCENE_REF_OFFSET(ref));
  struct box box;
  for (int axis = 0; axis < 3; axis++)
    box.min[axis] = box.max[axis] = triangle->v0[axis];
  for (unsigned i = 0; i < TRAX_SCENE_REF_COUNT(ref); i++, triangle++) {
    add(&box, triangle->v0);
    add(&box, triangle->v1);
    add(&box, triangle->v2);
  }
  return box;
}

/* Finds the place of each node in its parent, once for a topology. */
static void link_nodes(unsigned begin, unsigned end, void *unused) {
  (void)unused;
  for (unsigned i = begin; i < end; i++)
    for (unsigned child = 0; child < 2; child++)
      if (TRAX_SCENE_REF_COUNT(nodes[i].child[child]) == 0)
        ((unsigned *)links.data)[(nodes[i].child[child] - first_node) / sizeof *nodes] = 2 * i + child;
}

/* Past the data cache: another TM may have written it. */
static struct box box_of(const struct trax_bvh_node *node, unsigned child) {
  const unsigned *words = (const unsigned *)&node->box[child];
  unsigned copy[6];
  struct box box;
  for (int i = 0; i < 6; i++)
    copy[i] = trax_load_nt(&words[i]);
  __builtin_memcpy(&box, copy, sizeof box);
  return box;
}

/* Writes a child's box. If its sibling is done, so is the node, and so on up. */
static void put(unsigned place, struct box box) {
  for (;;) {
    struct trax_bvh_node *node = &nodes[place / 2];
    for (int axis = 0; axis < 3; axis++) {
      node->box[place % 2].min[axis] = box.min[axis];
      node->box[place % 2].max[axis] = box.max[axis];
    }
    __atomic_thread_fence(__ATOMIC_RELEASE); /* the increment orders what comes after it, since its value is used */
    if (trax_atomic_inc(&((unsigned *)arrived.data)[place / 2]) == 0)
      return;
    const struct box other = box_of(node, 1 - place % 2);
    add(&box, other.min);
    add(&box, other.max);
    place = ((const unsigned *)links.data)[place / 2];
    if (place == NO_PARENT)
      break;
  }
  struct trax_scene_header *header = scene.data;
  for (int axis = 0; axis < 3; axis++) {
    header->bounds_min[axis] = box.min[axis];
    header->bounds_max[axis] = box.max[axis];
  }
}

static void refit(unsigned begin, unsigned end, void *unused) {
  (void)unused;
  for (unsigned i = begin; i < end; i++)
    for (unsigned child = 0; child < 2; child++)
      if (TRAX_SCENE_REF_COUNT(nodes[i].child[child]))
        put(2 * i + child, leaf_box(nodes[i].child[child]));
}

int main(void) {
  const struct trax_scene_header *header = scene.data;
  const struct trax_scene_section *section = &header->sections[TRAX_SCENE_NODES];
  if (header->magic != TRAX_SCENE_MAGIC || header->node_layout != TRAX_NODES_BINARY || section->count == 0 ||
      links.size < section->count * sizeof(unsigned) || arrived.size < section->count * sizeof(unsigned)) {
    puts("refit: expected a scene with binary nodes, and a word for each node in links and arrived");
    return 1;
  }
  nodes = (void *)((char *)scene.data + section->offset);
  node_count = section->count;
  first_node = section->offset;
  ((unsigned *)links.data)[0] = NO_PARENT;
  const unsigned begin = trax_cycles();
  trax_parallel_for_static(0, node_count, GRAIN, link_nodes, NULL);
  const unsigned linked = trax_cycles();
  trax_parallel_for(0, node_count, GRAIN, refit, NULL);
  printf("%u nodes, %u triangles: links %u cycles, boxes %u cycles\n", node_count, header->triangle_count,
         linked - begin, trax_cycles() - linked);
}
