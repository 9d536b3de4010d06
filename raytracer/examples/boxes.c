// A ray tracer for a city of boxes, the one of docs/tutorial.md. Every thread of the chip runs main.
#include <math.h>
#include <trax.h>

#ifdef EVENING
enum { WIDTH = 400, HEIGHT = 225 };
#else
enum { WIDTH = 160, HEIGHT = 90 };
#endif
enum { BOXES = 26 };

struct vector {
  float x, y, z;
};
struct box {
  struct vector low, high;
};

struct trax_buffer image;   // made by trax-sim --alloc, written to a file by --dump
static unsigned next_pixel; // the first pixel that nobody has taken

#define TOWER(X, Z, TOP) {{X, 0, Z}, {X + 0.7f, TOP, Z + 0.7f}}
#define STREET(Z, A, B, C, D, E)                                                                                       \
  TOWER(-2.35f, Z, A), TOWER(-1.35f, Z, B), TOWER(-0.35f, Z, C), TOWER(0.65f, Z, D), TOWER(1.65f, Z, E)
static const struct box boxes[BOXES] = {{{-30, -1, -30}, {30, 0, 30}}, // the ground
                                        STREET(-2.35f, 0.6f, 1.9f, 1.2f, 0.8f, 1.4f),
                                        STREET(-1.35f, 1.1f, 0.5f, 2.6f, 1.5f, 0.7f),
                                        STREET(-0.35f, 0.8f, 1.6f, 0.4f, 2.2f, 1.0f),
                                        STREET(0.65f, 0.5f, 0.9f, 1.3f, 0.6f, 0.4f),
                                        STREET(1.65f, 0.3f, 0.6f, 0.5f, 0.9f, 0.3f)};

static const struct vector eye = {-4.0f, 3.6f, 6.0f};

#ifdef INTRINSICS
#include "intrinsics.h"
#else
// The larger of a and of the smaller of b and c; and the other way round.
static inline float max_min(float a, float b, float c) {
  return fmaxf(a, fminf(b, c));
}
static inline float min_max(float a, float b, float c) {
  return fminf(a, fmaxf(b, c));
}
#endif

// The distance to the box in units of the ray's direction, whose reciprocals are r. INFINITY: not before limit.
static inline float enter(const struct box *box, struct vector o, struct vector r, float limit) {
  float x0 = (box->low.x - o.x) * r.x, x1 = (box->high.x - o.x) * r.x;
  float y0 = (box->low.y - o.y) * r.y, y1 = (box->high.y - o.y) * r.y;
  float z0 = (box->low.z - o.z) * r.z, z1 = (box->high.z - o.z) * r.z;
  float near = max_min(max_min(max_min(0, x0, x1), y0, y1), z0, z1);
  float far = min_max(min_max(min_max(limit, x0, x1), y0, y1), z0, z1);
  return near < far ? near : INFINITY;
}

// The nearest box and its distance.
static const struct box *trace(struct vector o, struct vector d, float *distance) {
  struct vector r = {1 / d.x, 1 / d.y, 1 / d.z};
  const struct box *nearest = NULL;
  *distance = INFINITY;
  for (const struct box *box = boxes; box < boxes + BOXES; box++) {
    float t = enter(box, o, r, *distance);
    if (t < *distance) {
      *distance = t;
      nearest = box;
    }
  }
  trax_count_rays(1);
  return nearest;
}

#ifdef EVENING
#include "evening.h"
#else
static const struct vector light = {0.48f, 0.76f, 0.44f}; // the direction to it, of length 1

static unsigned colour_of(unsigned pixel) {
  float x = ((float)(pixel % WIDTH) + 0.5f) * (1.2f / WIDTH) - 0.6f;
  float y = 0.3375f - ((float)(pixel / WIDTH) + 0.5f) * (0.675f / HEIGHT);
  // Forward is (0.53, -0.37, -0.76), right (0.82, 0, 0.57), up (0.21, 0.93, -0.30).
  struct vector d = {0.53f + 0.82f * x + 0.21f * y, -0.37f + 0.93f * y, -0.76f + 0.57f * x - 0.30f * y};
  float t, ignored, grey;
  const struct box *box = trace(eye, d, &t);
  if (!box) {
    grey = 0.75f - 0.4f * y; // the sky
  } else {
    struct vector p = {eye.x + t * d.x, eye.y + t * d.y, eye.z + t * d.z};
    // The side that was hit is the one that the point is nearest to.
    float dx = fminf(fabsf(p.x - box->low.x), fabsf(p.x - box->high.x));
    float dy = fminf(fabsf(p.y - box->low.y), fabsf(p.y - box->high.y));
    float dz = fminf(fabsf(p.z - box->low.z), fabsf(p.z - box->high.z));
    struct vector n = {0, 0, 0};
    if (dy < dx && dy < dz)
      n.y = 1;
    else if (dx < dz)
      n.x = d.x > 0 ? -1 : 1;
    else
      n.z = d.z > 0 ? -1 : 1;
    float cosine = n.x * light.x + n.y * light.y + n.z * light.z;
    struct vector above = {p.x + 1e-3f * n.x, p.y + 1e-3f * n.y, p.z + 1e-3f * n.z};
    grey = 0.15f;
    if (cosine > 0 && !trace(above, light, &ignored))
      grey += 0.8f * cosine;
  }
  unsigned level = (unsigned)(255 * fminf(fmaxf(grey, 0), 1));
  return level | level << 8 | level << 16 | 0xff000000; // R, G, B, A
}
#endif

int main(void) {
  for (unsigned pixel; (pixel = trax_atomic_inc(&next_pixel)) < WIDTH * HEIGHT;) {
    trax_store_nt((unsigned *)image.data + pixel, colour_of(pixel));
    trax_count_items(1);
  }
}
