/* The traversal of nodes of up to eight children, after Ylitie, Karras and Laine ("Efficient incoherent ray traversal
   on GPUs through compressed wide BVHs", HPG 2017). All children of a node are tested at once, from the slot that the
   ray reaches last to the first. An entry of the stack is a node with the slots still to be visited, so there is at
   most one for each level. It has the numbers of slots, four bits each, instead of a mask, whose first bit this machine
   cannot find in one instruction. */
enum { wide8_by_sign = 1, wide8_more_entries = 0, wide8_traces = 1 };
#define wide8_visit(...) false

struct slots {
  const char *node;
  uint32_t
      list; /* of slots that are still to be visited, the nearest in the lowest four bits; each has 8 + its number */
};

/* The slot that the ray reaches last, by the signs of its direction. */
static inline uint32_t last_slot(const struct ray *ray) {
  return 7 ^ ((ray->near_offset_x >> 3 & 1) | (ray->near_offset_y >> 2 & 2) | (ray->near_offset_z >> 1 & 4));
}

/* The list of the slots whose children the ray enters. */
static inline __attribute__((always_inline)) uint32_t entered_slots(const char *node, const struct ray *world,
                                                                    uint32_t last, int32_t limit) {
  struct ray ray = *world;
  uint32_t list = 0;
  ray.box = ray_in_frame(&world->box, node);
  KEEP_ROLLED
  for (uint32_t i = 0; i < 8; i++) {
    const uint32_t slot = i ^ last;
    const char *child = node + slot;
    int32_t enter;
    if (enter_box(TRAX_NODES_WIDE8, child, IN_WIDE8(min), &ray, limit, &enter) &&
        *(const uint8_t *)(child + IN_WIDE8(meta)) != 0) /* asking this first takes more cycles */
      list = list << 4 | 8 | slot;
  }
  return list;
}

static inline __attribute__((always_inline)) bool wide8_trace(const char *scene, trax_scene_ref root,
                                                              const struct ray *ray, bool any, struct hit *hit) {
  struct slots stack[TRAX_TREE_DEPTH + 1], *top = stack, at = {NULL, 0};
  const uint32_t last = last_slot(ray);
  int32_t limit = limit_of(TRAX_NODES_WIDE8, hit->distance_bits);
  if (root == 0)
    return false;
  const char *next = scene_at(scene, root);
  for (;;) {
    ACCESS_NODE(next);
    const uint32_t list = entered_slots(next, ray, last, limit);
    if (list) {
      if (at.list)
        *top++ = at;
      at = (struct slots){next, list};
    }
    uint32_t meta;
    for (;;) {
      if (at.list == 0) {
        if (top == stack)
          return hit->triangle != NULL;
        at = *--top;
      }
      meta = *(const uint8_t *)(at.node + IN_WIDE8(meta) + (at.list & 7));
      at.list >>= 4;
      const uint32_t count = meta & 7;
      if (count == 0)
        break;
      const char *triangle = scene_at(scene, load_word(at.node + IN_WIDE8(first_triangle)) +
                                                 (meta >> 3) * (uint32_t)sizeof(struct trax_triangle));
      const char *end = triangle + count * sizeof(struct trax_triangle);
      do {
        HIDE_ORIGIN(triangle);
        ACCESS_TRIANGLE(triangle);
        if (hit_triangle(&ray->triangle, triangle, any, hit) && any)
          return true;
        triangle += sizeof(struct trax_triangle);
      } while (__builtin_expect_with_probability(triangle != end, 1, 0.5));
      limit = limit_of(TRAX_NODES_WIDE8, hit->distance_bits);
    }
    next = scene_at(scene, load_word(at.node + IN_WIDE8(first_node)) +
                               ((meta >> 3) - 1) * (uint32_t)sizeof(struct trax_wide8_node));
  }
}
