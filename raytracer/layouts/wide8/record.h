/* The node of Ylitie, Karras and Laine ("Efficient incoherent ray traversal on GPUs through compressed wide BVHs", HPG
   2017). Plane q of an axis is at origin + q * 2^(scale - 149), with the least scale that has room for all children. A
   child is in one of eight slots. Rays with a positive direction along the axis of bit b of a slot's number visit the
   slots without that bit first. Children that are nodes follow one another in the file in the order of slots, and so
   do the triangles of all leaves, before those of the nodes. Aligned to 16 bytes. */
struct trax_wide8_node {
  float origin[3]; /* the least corner of all children */
  uint8_t scale[3];
  uint8_t reserved;
  trax_scene_ref first_node, first_triangle; /* without a count; 0: no child needs it */
  uint8_t meta[8]; /* a leaf: triangles + 8 * place of its first, counted from first_triangle; a node: 8 * its number
                      from 1; 0: no child, whose planes are 255 to 0 */
  uint8_t min[3][8], max[3][8];
};
_Static_assert(sizeof(struct trax_wide8_node) == 80, "no padding");

enum { wide8_step = 8, wide8_on_grid = 0 };
