/* A wavefront (9-wavefront.c) of all that the general device program renders: paths over many surfaces, all materials
   and lights. A pixel's path waits in memory, and functions of the device program handle it: follow_ray traces its
   ray, after_ray shades the result and makes the next ray (raytracer/device/path.h). In a round all threads sort the
   rays of all paths, trace them, and shade them. A pixel takes its samples one after the other, so every sum is in the
   same order, and the picture is the general program's in every bit.

     clang --target=trax -std=c17 -O3 -DTRAX_TREE_DEPTH=TRAX_SCENE_DEFAULT_DEPTH -DQUEUES=4 -I raytracer/include
       -I raytracer raytracer/examples/wavefront-paths.c -o wavefront-paths.elf
     trax-render SCENE --paths 4 --program wavefront-paths.elf   (compare with --no-specialise) */
#define TILE_BITS 6
#include "../device/path.h"
#include "stages.h"

#ifndef SORTED
#define SORTED 1 /* 0: rays are traced in the order in which they were made */
#endif
#ifndef CELL_BITS
#define CELL_BITS 3 /* of a cell's number along an axis */
#endif
#ifndef WAVE
#define WAVE (1u << 14) /* pixels at once */
#endif
#define KEYS (1u << (3 * CELL_BITS + 4)) /* nearest hit or any, a cell, and an octant of directions */

struct trax_buffer scene, params, image;

static _Alignas(64) struct path waiting[WAVE];
static uint32_t kinds[WAVE];     /* of a path's ray, as a term of trax_count_kinds */
static uint32_t found[WAVE];     /* whether it hit something */
static unsigned queue[2][WAVE];  /* the paths with a ray in this round and in the next */
static unsigned keys[WAVE];      /* of those rays */
static unsigned ranks[WAVE];     /* the number of each among the rays with its key */
static unsigned sorted[WAVE];    /* the queue */
static unsigned counts[2][KEYS]; /* rays with a key; then where the first of them is in `sorted` */
static unsigned queued[3];       /* rays of a round */

struct state {
  const struct trax_render_params *run;
  float cells;    /* in a unit of length */
  unsigned stage; /* barriers before it */
  unsigned round;
};

static inline unsigned cell_of(float place) {
  return (unsigned)(int32_t)at_most(at_least(place, 0), (1 << CELL_BITS) - 1);
}

/* The kind of ray, the number of the origin's cell along Morton's curve, then the octant of the direction. */
static unsigned key_of(const struct state *state, const struct path *path, uint32_t rays) {
  const struct vector corner = load_vector(((const struct trax_scene_header *)scene.data)->bounds_min);
  const struct vector place = times(state->cells, minus(path->origin, corner)), way = path->direction;
  const unsigned x = cell_of(place.x), y = cell_of(place.y), z = cell_of(place.z);
  unsigned code = IS_SHADOW(state->run, rays);
  for (int bit = CELL_BITS - 1; bit >= 0; bit--)
    code = code << 3 | (x >> bit & 1) << 2 | (y >> bit & 1) << 1 | (z >> bit & 1);
  return code << 3 | (unsigned)(way.x < 0) << 2 | (unsigned)(way.y < 0) << 1 | (way.z < 0);
}

/* Lets a path wait with its next ray for the round. */
static void enqueue(const struct state *state, unsigned round, unsigned number, uint32_t rays) {
  const unsigned place = trax_atomic_inc(&queued[round % 3]);
  kinds[number] = rays;
  queue[round % 2][place] = number;
  if (SORTED) {
    keys[place] = key_of(state, &waiting[number], rays);
    ranks[place] = trax_atomic_inc(&counts[round % 2][keys[place]]);
  }
}

static __attribute__((noinline)) void begin_pixels(struct state *state, unsigned first_slot, unsigned count) {
  FOR_ALL(i, state->stage, count) {
    struct path *path = &waiting[i];
    struct pixel pixel;
    if (!slot_pixel(state->run, first_slot + i, &pixel))
      continue;
    path->pixel = pixel.packed;
    path->key = hash_word(pixel.packed ^ hash_word(RUN_PATH(state->run)->seed));
    path->sum = (struct vector){0, 0, 0};
    path->sample = 0;
    begin_sample(path, state->run);
    enqueue(state, state->round, i, PRIMARY_RAY);
  }
  barrier(&state->stage);
}

static __attribute__((noinline)) void sort(struct state *state) {
  unsigned *places = counts[state->round % 2];
  sum_counts(places, counts[(state->round + 1) % 2], KEYS, &state->stage);
  FOR_ALL(i, state->stage, queued[state->round % 3]) {
    sorted[places[trax_load_nt(&keys[i])] + trax_load_nt(&ranks[i])] = trax_load_nt(&queue[state->round % 2][i]);
  }
  barrier(&state->stage);
}

static __attribute__((noinline)) void trace_rays(struct state *state, const unsigned *order, unsigned count) {
  FOR_ALL(i, state->stage, count) {
    const unsigned number = trax_load_nt(&order[i]);
    found[number] = follow_ray(state->run, &waiting[number], kinds[number]);
  }
  if (trax_thread() == 0) /* no ray of the next round is there yet */
    queued[(state->round + 1) % 3] = 0;
  barrier(&state->stage);
}

static __attribute__((noinline)) void shade_paths(struct state *state, const unsigned *order, unsigned count) {
  FOR_ALL(i, state->stage, count) {
    const unsigned number = trax_load_nt(&order[i]);
    struct path *path = &waiting[number];
    uint32_t rays = after_ray(state->run, path, kinds[number], found[number] != 0);
    if (!rays && end_sample(state->run, path)) {
      begin_sample(path, state->run);
      rays = PRIMARY_RAY;
    }
    if (rays)
      enqueue(state, state->round + 1, number, rays);
    else
      trax_count_items(1);
  }
  barrier(&state->stage);
}

int main(void) {
  const struct trax_scene_header *header = scene.data;
  struct state state = {.run = RUN_PARAMS};
  check_scene(header);
  check_threads();
  if (!NEEDS_PATHS(state.run))
    trax_abort("this program renders pictures with paths, materials or lights (trax-render --paths)");
  const struct vector size = minus(load_vector(header->bounds_max), load_vector(header->bounds_min));
  state.cells = (1 << CELL_BITS) / at_least(bits_float(greatest_magnitude(size)), 0x1p-100f);
  for (unsigned first = 0, count; first < state.run->slot_count; first += WAVE) {
    const unsigned left = state.run->slot_count - first;
    if (first > 0)
      barrier(&state.stage); /* all have seen that no ray of the last wave is queued */
    begin_pixels(&state, first, left < WAVE ? left : WAVE);
    while ((count = queued[state.round % 3]) > 0) {
      if (SORTED)
        sort(&state);
      const unsigned *order = SORTED ? sorted : queue[state.round % 2];
      trace_rays(&state, order, count);
      shade_paths(&state, order, count);
      state.round++;
    }
  }
  return 0;
}
