/* box[c] bounds every triangle below child[c] exactly: the least and the greatest of its vertices' coordinates, never
   rounded outwards. The traversal allows for the rounding of a ray's own arithmetic. */
struct trax_bvh_node {
  struct {
    float min[3], max[3];
  } box[2];
  trax_scene_ref child[2]; /* never 0 */
  uint32_t reserved[2];    /* zero */
};
_Static_assert(sizeof(struct trax_bvh_node) == 64, "no padding");

enum { binary_step = 4, binary_on_grid = 0 };
