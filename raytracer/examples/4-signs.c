/* Step 4: planes by sign. The sign of a direction's component says which of a box's two planes the ray meets first
   along that axis, so where the near planes are is found once for a ray, and no pair of distances is compared. An axis
   after which nothing is left of the ray's way through the box ends the test: the other planes are not even loaded. */
#include "trax/plain_scene.h"

typedef struct trax_plain_triangle triangle_record;
#include "one-division.h"

struct trax_buffer plain_nodes, plain_triangles, params, image;
unsigned next_pixel; /* shared by all threads */

struct ray {
  struct vector origin, direction, inverse; /* of unit length; 1 / direction */
  int near_x, near_y,
      near_z; /* bytes from a box's minima to its nearer planes: 0, or 12 if the direction is negative */
};

/* Clips the way of a ray through a box to the slab between two planes. False: nothing of it is left. */
static inline bool clip(const char *near, const char *far, float origin, float inverse, int *enter, int *leave) {
  int near_bits = bits((*(const float *)near - origin) * inverse);
  int far_bits = bits((*(const float *)far - origin) * inverse);
  if (near_bits > *enter)
    *enter = near_bits;
  if (far_bits < *leave)
    *leave = far_bits;
  return *enter <= *leave;
}

/* Whether the ray hits the box before `nearest`, and where it enters it: the slabs of Kay and Kajiya (SIGGRAPH 1986).
   All distances are bits. The way begins at 0, so of two that are compared one is never negative. */
static inline bool hit_box(const struct ray *ray, const struct trax_plain_node *node, int nearest, int *enter) {
  const char *min = (const char *)node->min, *max = (const char *)node->max;
  int leave = nearest;
  *enter = 0;
  return clip(min + ray->near_x, max - ray->near_x, ray->origin.x, ray->inverse.x, enter, &leave) &&
         clip(min + 4 + ray->near_y, max + 4 - ray->near_y, ray->origin.y, ray->inverse.y, enter, &leave) &&
         clip(min + 8 + ray->near_z, max + 8 - ray->near_z, ray->origin.z, ray->inverse.z, enter, &leave);
}

static inline int far_first(float component) {
  return component < 0 ? 12 : 0;
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
  return (struct ray){origin, direction, inverse, far_first(x), far_first(y), far_first(z)};
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
