/* Planes are numbers: a box is the smallest one on the grid that contains the child's. Aligned to 32 bytes. */
struct trax_quantised_node {
  struct {
    uint16_t min[3], max[3];
  } box[2];
  trax_scene_ref child[2]; /* never 0 */
};
_Static_assert(sizeof(struct trax_quantised_node) == 32, "no padding");

enum { quantised_step = 2, quantised_on_grid = 1 };
