/* Planes in binary32, exact. */
enum { binary_unit = 0 };

static inline void binary_prepare(struct box_ray *box, struct vector origin, struct vector inverse,
                                  struct vector margin, const struct trax_ray_grid *grid) {
  (void)grid;
  box->inverse = inverse;
  box->near_origin = plus(origin, margin);
  box->far_origin = minus(origin, margin);
}

static inline int32_t binary_plane(const char *plane, float origin, float inverse) {
  return float_bits((load_float(plane) - origin) * inverse);
}
