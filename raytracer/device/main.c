/* The ray tracer that every TP runs: pixel by pixel, a ray from the eye, and a ray from what it hits towards the light.
   Compiled for the TP, for one picture or for any (run.h), and unchanged for the host as the native twin: the pictures
   are the same bit for bit, since only operations that both round alike are used, in the order written.

   The machine shapes the code. Eight TPs share an adder, which also compares floats, and a data-cache bank; a TM shares
   one divider: so comparisons are of integers, planes and edges are tested one by one, and a pixel takes few divisions.
 */
#if TRAX_EXACT_HITS || defined TRAX_TWIN
#include "exact.h" /* included first, because it replaces the functions of the others */
#endif

#include "camera.h"
#include "path.h"
#include "record.h"
#include "run.h"
#include "shade.h"
#include "slots.h"
#include "traverse.h"
#include "trax/render_params.h"

#include <trax.h>

struct trax_buffer scene;
unsigned next_slot[TRAX_QUEUES]; /* shared by all threads: the atomic increment hands out each queue's pixels */
struct trax_buffer image, params, paths;
#if defined TRAX_RECORD || defined TRAX_TWIN
struct trax_buffer record;
#endif

/* Renders a pixel of the paper's workload and returns its word. All rays go through one copy of the traversal, so that
   the program fits in the instruction cache. *number is requested when all rays are traced, and has arrived when the
   pixel is done. */
static inline __attribute__((always_inline)) uint32_t render_pixel(const struct trax_render_params *run,
                                                                   uint32_t layout, struct pixel pixel, uint32_t queue,
                                                                   uint32_t *number) {
  struct vector sum = {0, 0, 0};
  for (uint32_t sample = 0;;) {
    struct place place = NEEDS(run, SAMPLES) ? sample_place(sample) : PIXEL_MIDDLE;
    struct vector origin = load_vector(run->eye), direction = camera_direction(run, pixel, place);
    struct hit hit = {FARTHEST_BITS, NULL, 0, 0};
    const float *colour = NULL;
    float light = 0, lit = 0;
    unsigned shadow = 0; /* the shadow ray, as it is counted */
    if (MARKS_RAYS(run))
      trax_count_kinds(TRAX_RAYS(TRAX_RAY_PRIMARY, 1));

    for (;;) {
      struct ray ray;
      prepare_ray(&ray, layout, origin, direction, run->box_margin, &run->grid);
      HIDE_ORIGIN(shadow); /* else the compiler specialises the iterations, and allocates registers less well */
      bool found =
          trace_ray(layout, scene.data, ((const struct trax_scene_header *)scene.data)->root, &ray, shadow, &hit);
      ACCESS_RAY(pixel.packed, sample, shadow, origin, direction, shadow ? hit.distance_bits : FARTHEST_BITS, found,
                 &hit);
      LOAD_AGAIN(run);
      if (shadow) {
        RECORD_SHADOW(run, pixel, sample, found);
        if (!found)
          light += lit;
        break;
      }
      RECORD_HIT(run, pixel, sample, &hit);
      if (!found)
        break;

      struct surface surface;
      struct light way;
      struct vector eye = load_vector(run->eye);
      find_surface(&surface, &hit, eye, direction);
      struct vector flat = surface.normal;
      if (NEEDS(run, SMOOTH))
        smooth_surface(&surface, &hit, run->normals_distance);
      aim_at_light(&way, &surface, run->light);
      uint32_t material = NEEDS(run, MATERIALS) ? material_of_hit(&hit) : 0;
      colour = RUN_PALETTE(run)[material].colour;
      light = ambient_light(run, &surface);
      if (way.cosine_bits <= 0 || (NEEDS(run, SMOOTH) && float_bits(dot(flat, way.direction)) <= 0))
        break;
      lit = run->light_strength * bits_float(way.cosine_bits);
      if (!NEEDS(run, SHADOWS)) {
        light += lit;
        break;
      }
      origin = surface.start, direction = way.direction;
      hit = (struct hit){way.distance_bits, NULL, 0, 0};
      shadow = TRAX_RAYS(TRAX_RAY_SHADOW, 1);
      if (MARKS_RAYS(run))
        trax_count_kinds(shadow);
    }

    const bool done = !NEEDS(run, SAMPLES) || ++sample == run->samples;
    if (done)
      *number = ask_for_number(next_slot, queue);
    if (!MARKS_RAYS(run))
      trax_count_kinds(TRAX_RAYS(TRAX_RAY_PRIMARY, 1) + shadow);
    if (!NEEDS(run, SAMPLES))
      return colour ? shade(colour, light) : run->background;
    if (colour)
      add_light(&sum, colour, light);
    else
      add_pixel(&sum, run->background);
    if (done)
      return mean_pixel(&sum, run->sample_weight);
  }
}

/* The general program renders each kind of picture in a function with a frame of its own. None returns, since main
   would need its frame all the time. */
#if !defined __trax__
#define RENDER_ALL
#elif defined TRAX_SPECIALISED_FEATURES
#define RENDER_ALL __attribute__((noreturn, always_inline)) inline
#else
#define RENDER_ALL __attribute__((noreturn, noinline))
#endif

#ifdef __trax__
#ifndef END_THREAD /* or as llvm-target/bench/profiled.py says: exit(0), which writes the counters of a profile */
#define END_THREAD() trax_halt()
#endif
#define NO_RETURN __attribute__((noreturn))
#else
#define END_THREAD() ((void)0)
#define NO_RETURN
#endif

/* The paper's workload. Each layout of nodes has a loop of its own, which fits in the instruction cache. */
static inline __attribute__((always_inline)) NO_RETURN void render_layout(const struct trax_render_params *run,
                                                                          uint32_t layout) {
  uint32_t slot, queue = first_queue(), number = ask_for_number(next_slot, queue);
  while (take_slot(run, next_slot, number, &queue, &slot)) {
    struct pixel pixel;
    if (!slot_pixel(run, slot, &pixel)) {
      number = ask_for_number(next_slot, queue);
      continue;
    }
    uint32_t word = render_pixel(run, layout, pixel, queue, &number);
    ACCESS_SLOT(slot);
    LOAD_AGAIN(run);
    RECORD_PIXEL(run, pixel);
    trax_store_nt((unsigned *)image.data + pixel_y(pixel) * run->width + pixel_x(pixel), word);
    trax_count_items(1);
  }
  END_THREAD();
}

#define LAYOUT(number, NAME, name, general, ...)                                                                       \
  static RENDER_ALL void render_##name(const struct trax_render_params *run) {                                         \
    render_layout(run, TRAX_NODES_##NAME);                                                                             \
  }
#include "layouts/table.def"

static RENDER_ALL void refuse_layout(void) {
  trax_abort("this program does not know the scene's layout of nodes");
}

/* Everything else. */
static RENDER_ALL void render_all_paths(const struct trax_render_params *run) {
#ifdef TRAX_PATHS_LOCAL
  struct path local, *path = &local;
#else
  struct path *path = path_of_thread();
#endif
  uint32_t slot, queue = first_queue();
  while (take_slot(run, next_slot, ask_for_number(next_slot, queue), &queue, &slot)) {
    struct pixel pixel;
    if (!slot_pixel(run, slot, &pixel))
      continue;
    render_path_pixel(run, path, pixel);
    ACCESS_SLOT(slot);
    trax_count_items(1);
  }
  END_THREAD();
}

/* On the TP it ends its thread. A function that does not return saves no registers of its caller. */
NO_RETURN int main(void) {
  const struct trax_render_params *run = RUN_PARAMS;
  check_scene(scene.data);
  if (NEEDS_PATHS(run))
    render_all_paths(run);
  else if (RUN_LAYOUT(run) == TRAX_NODES_BINARY)
    render_binary(run); /* the first function of the general program, though the last row */
#define LAYOUT(number, NAME, name, general, ...)                                                                       \
  else if ((general || !GENERAL_LAYOUTS_ONLY) && RUN_LAYOUT(run) == TRAX_NODES_##NAME) render_##name(run);
#include "layouts/table.def"
  else
    refuse_layout();
#ifndef __trax__
  return 0;
#endif
}
