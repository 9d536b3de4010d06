/* Step 9: a wavefront (S. Laine, T. Karras, T. Aila, "Megakernels Considered Harmful", HPG 2013). All threads do one
   thing at a time to all rays of a wave: make the rays from the eye, trace them, shade what they hit, sort the rays to
   the light by place and direction, trace them. In between rays wait in memory. The sort is a counting sort across all
   threads. The program traces the rays of step 7 and is compared with step 7. */
#include "one-ray.h"
#include "stages.h"

#ifndef SORTED
#define SORTED 1 /* 0: rays to the light are traced in the order in which they were made */
#endif
#ifndef CELL_BITS
#define CELL_BITS 3 /* of a cell's number along an axis */
#endif
#define WAVE (1u << 16)                  /* rays at once */
#define KEYS (1u << (3 * CELL_BITS + 3)) /* a cell and an octant of directions each */

struct queued_ray {
  struct vector origin, direction;
  float distance; /* to the light; infinite for a ray from the eye */
  unsigned pixel; /* NO_PIXEL: there is no ray */
};
#define NO_PIXEL 0xFFFFFFFFu

static _Alignas(64) struct queued_ray eye_rays[WAVE], light_rays[WAVE];
static struct hit hits[WAVE];    /* of the rays from the eye */
static unsigned lit[WAVE];       /* the pixel of a ray to the light if nothing is in its way */
static unsigned keys[WAVE];      /* of a ray to the light */
static unsigned ranks[WAVE];     /* its number among the rays with this key */
static unsigned order[WAVE];     /* the rays to the light, sorted */
static unsigned counts[2][KEYS]; /* rays with a key; then where the first of them is in `order` */
static unsigned light_ray_count;

struct wave {
  const struct trax_render_params *frame;
  unsigned number, first_slot, count;
  unsigned stage; /* barriers before it */
  float cells;    /* in a unit of length */
};

static __attribute__((noinline)) void make_eye_rays(struct wave *wave) {
  const struct trax_render_params *frame = wave->frame;
  FOR_ALL(i, wave->stage, wave->count) {
    unsigned x, y;
    eye_rays[i].pixel = NO_PIXEL;
    if (slot_pixel(frame, wave->first_slot + i, &x, &y))
      eye_rays[i] = (struct queued_ray){load(frame->eye), eye_direction(frame, x, y), INFINITY, y * frame->width + x};
  }
  light_ray_count = 0;
  barrier(&wave->stage);
}

static inline __attribute__((always_inline)) bool trace_queued(const struct wave *wave, const struct queued_ray *queued,
                                                               bool any, struct hit *hit) {
  struct queued_ray now;
  load_once(&now, queued, sizeof now);
  struct ray ray = make_ray(wave->frame, now.origin, now.direction);
  *hit = (struct hit){now.distance, NULL};
  trax_count_rays(1);
  const trax_scene_ref root = ((const struct trax_scene_header *)scene.data)->root;
  return trace_below(&root, &ray, any, hit);
}

static __attribute__((noinline)) void trace_eye_rays(struct wave *wave) {
  FOR_ALL(i, wave->stage, wave->count)
  if (eye_rays[i].pixel != NO_PIXEL)
    trace_queued(wave, &eye_rays[i], false, &hits[i]);
  barrier(&wave->stage);
}

/* The number of the origin's cell along Morton's curve, then the octant of the direction. */
static inline unsigned key_of(float cells, struct vector origin, struct vector direction) {
  struct vector place =
      scale(subtract(origin, load(((const struct trax_scene_header *)scene.data)->bounds_min)), cells);
  unsigned x = (unsigned)(int)place.x, y = (unsigned)(int)place.y, z = (unsigned)(int)place.z, code = 0;
  for (int bit = CELL_BITS - 1; bit >= 0; bit--)
    code = code << 3 | (x >> bit & 1) << 2 | (y >> bit & 1) << 1 | (z >> bit & 1);
  return code << 3 | (unsigned)(direction.x < 0) << 2 | (unsigned)(direction.y < 0) << 1 | (direction.z < 0);
}

/* Writes pixels as they are in shadow, and makes rays to the light. */
static __attribute__((noinline)) void shade(struct wave *wave) {
  const struct trax_render_params *frame = wave->frame;
  FOR_ALL(i, wave->stage, wave->count) {
    struct queued_ray seen;
    struct hit hit;
    load_once(&seen, &eye_rays[i], sizeof seen);
    load_once(&hit, &hits[i], sizeof hit);
    if (seen.pixel == NO_PIXEL)
      continue;
    trax_count_items(1);
    if (!hit.triangle) {
      write_pixel(seen.pixel, frame->background);
      continue;
    }
    struct surface at = surface_at(frame, seen.origin, seen.direction, hit);
    write_pixel(seen.pixel, colour_of(frame, at.material, at.light));
    if (at.from_light == 0)
      continue;
    unsigned number = trax_atomic_inc(&light_ray_count);
    light_rays[number] = (struct queued_ray){at.origin, at.direction, at.distance, seen.pixel};
    lit[number] = colour_of(frame, at.material, at.light + at.from_light);
    if (SORTED) {
      unsigned key = key_of(wave->cells, at.origin, at.direction);
      keys[number] = key;
      ranks[number] = trax_atomic_inc(&counts[wave->number % 2][key]);
    }
  }
  barrier(&wave->stage);
}

static __attribute__((noinline)) void sort(struct wave *wave) {
  unsigned *places = counts[wave->number % 2];
  sum_counts(places, counts[(wave->number + 1) % 2], KEYS, &wave->stage);
  FOR_ALL(i, wave->stage, light_ray_count) {
    order[places[trax_load_nt(&keys[i])] + trax_load_nt(&ranks[i])] = i;
  }
  barrier(&wave->stage);
}

static __attribute__((noinline)) void trace_light_rays(struct wave *wave) {
  struct hit hit;
  FOR_ALL(i, wave->stage, light_ray_count) {
    unsigned number = SORTED ? trax_load_nt(&order[i]) : i;
    if (!trace_queued(wave, &light_rays[number], true, &hit))
      write_pixel(trax_load_nt(&light_rays[number].pixel), trax_load_nt(&lit[number]));
  }
  barrier(&wave->stage);
}

int main(void) {
  struct wave wave = {.frame = params.data};
  const struct trax_scene_header *header = scene.data;
  check_scene(wave.frame);
  check_threads();
  struct vector size = subtract(load(header->bounds_max), load(header->bounds_min));
  wave.cells = (1 << CELL_BITS) / value(larger(bits(size.x), larger(bits(size.y), bits(size.z))));
  for (; wave.first_slot < wave.frame->slot_count; wave.first_slot += WAVE, wave.number++) {
    wave.count = wave.frame->slot_count - wave.first_slot;
    if (wave.count > WAVE)
      wave.count = WAVE;
    make_eye_rays(&wave);
    trace_eye_rays(&wave);
    shade(&wave);
    if (SORTED)
      sort(&wave);
    trace_light_rays(&wave);
  }
  return 0;
}
