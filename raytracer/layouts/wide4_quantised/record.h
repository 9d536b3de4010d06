/* Two quantised nodes, one behind the other, as binary ones in struct trax_wide4_node. */
struct trax_wide4_quantised_node {
  struct {
    struct {
      uint16_t min[3], max[3];
    } box[2];
    trax_scene_ref child[2];
  } pair[2];
};
_Static_assert(sizeof(struct trax_wide4_quantised_node) == 64, "no padding");
