/* Step 3: one division a ray. The three reciprocals of a direction become one, of the product of its components, and
   multiplications. Triangles are compared by products, so that only a nearer hit takes a division. A ray to the light
   asks only whether anything is in its way: it takes no other division, and ends at the first hit. */
#include "trax/plain_scene.h"

typedef struct trax_plain_triangle triangle_record;
#include "one-division.h"

struct trax_buffer plain_nodes, plain_triangles, params, image;
unsigned next_pixel; /* shared by all threads */

struct ray {
  struct vector origin, direction, inverse; /* of unit length; 1 / direction */
};

/* Whether the ray hits the box before `nearest`, and where it enters it: the slabs of Kay and Kajiya (SIGGRAPH 1986).
   All distances are bits. Two negative ones of one slab may change places: the ray leaves the box behind its origin
   then in either case, and misses it. */
static inline bool hit_box(const struct ray *ray, const struct trax_plain_node *node, int nearest, int *enter) {
  int x0 = bits((node->min[0] - ray->origin.x) * ray->inverse.x);
  int x1 = bits((node->max[0] - ray->origin.x) * ray->inverse.x);
  int y0 = bits((node->min[1] - ray->origin.y) * ray->inverse.y);
  int y1 = bits((node->max[1] - ray->origin.y) * ray->inverse.y);
  int z0 = bits((node->min[2] - ray->origin.z) * ray->inverse.z);
  int z1 = bits((node->max[2] - ray->origin.z) * ray->inverse.z);
  *enter = larger(larger(smaller(x0, x1), smaller(y0, y1)), smaller(z0, z1));
  int leave = smaller(smaller(larger(x0, x1), larger(y0, y1)), larger(z0, z1));
  return *enter <= leave && leave >= 0 && *enter < nearest;
}

static inline struct ray make_ray(const struct trax_render_params *frame, struct vector origin,
                                  struct vector direction) {
  (void)frame; /* step 5 needs its grid */
  float x = direction.x, y = direction.y, z = direction.z, product = x * y * z;
  if ((bits(product) & ~SIGN_BIT) < bits(0x1p-30f)) { /* along an axis or a plane of two, or nearly so: rarely */
    x = away_from_zero(x), y = away_from_zero(y), z = away_from_zero(z);
    product = x * y * z;
  }
  float reciprocal = 1 / product;
  struct vector inverse = {y * z * reciprocal, x * z * reciprocal, x * y * reciprocal};
  return (struct ray){origin, direction, inverse};
}

#include "any-hit.h"
#include "pixel.h"

int main(void) {
  const struct trax_render_params *frame = params.data;
  check_workload(frame);
  unsigned pixels = frame->width * frame->height;
  for (unsigned pixel = trax_atomic_inc(&next_pixel); pixel < pixels; pixel = trax_atomic_inc(&next_pixel)) {
    trax_store_nt((unsigned *)image.data + pixel, render(frame, pixel % frame->width, pixel / frame->width));
    trax_count_items(1);
  }
  return 0;
}
