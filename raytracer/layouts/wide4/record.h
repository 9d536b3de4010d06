/* Two binary nodes, one behind the other. Children that are not there follow the others; their reference is 0, and
   their box is that of all children inside out. */
struct trax_wide4_node {
  struct {
    struct {
      float min[3], max[3];
    } box[2];
    trax_scene_ref child[2];
  } pair[2];
  uint32_t reserved[4]; /* zero */
};
_Static_assert(sizeof(struct trax_wide4_node) == 128, "no padding");
