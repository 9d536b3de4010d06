/* The program of trax-render --rays: every TP takes rays from the buffer `rays`, traces them as main.c does, and writes
   what they hit. It is compiled for one file of rays and one scene (run.h). Slots are rays. */
#if TRAX_EXACT_HITS
#include "exact.h" /* before all others: instead of their hits */
#endif

#include "algebra.h"
#include "run.h"
#include "slots.h"
#include "traverse.h"
#include "trax/ray_input.h"

#include <trax.h>

struct trax_buffer scene, params, rays, hits;
unsigned next_slot[TRAX_QUEUES];

/* Shadow and occlusion rays ask only whether there is a hit. */
#define ANY_HIT_KINDS (1u << TRAX_RAY_SHADOW | 1u << TRAX_RAY_OCCLUSION)

static inline __attribute__((always_inline)) void trace_slot(const struct trax_render_params *run, uint32_t slot) {
  const struct trax_input_ray *input = (const struct trax_input_ray *)rays.data + slot;
  struct trax_ray_hit *output = (struct trax_ray_hit *)hits.data + slot;
  const uint32_t kind = input->kind;
  const bool any = ANY_HIT_KINDS >> kind & 1;
  struct hit hit = {float_bits(input->farthest), NULL, 0, 0};
  struct ray ray;
  prepare_ray(&ray, RUN_LAYOUT(run), load_vector(input->origin), load_vector(input->direction), run->box_margin,
              &run->grid);
  trax_count_kinds(TRAX_RAYS(kind, 1));
  const bool found =
      trace_ray(RUN_LAYOUT(run), scene.data, ((const struct trax_scene_header *)scene.data)->root, &ray, any, &hit);
  if (any || !found) {
    trax_store_nt(&output->triangle, found ? TRAX_ANY_TRIANGLE : 0);
    return;
  }
  trax_store_nt(&output->triangle, (unsigned)(hit.triangle - (const char *)scene.data));
  trax_store_nt((unsigned *)&output->distance, (unsigned)hit.distance_bits);
  trax_store_nt((unsigned *)&output->weight1, (unsigned)float_bits(hit.weight1));
  trax_store_nt((unsigned *)&output->weight2, (unsigned)float_bits(hit.weight2));
}

int main(void) {
  const struct trax_render_params *run = RUN_PARAMS;
  check_scene(scene.data);
  uint32_t slot, queue = first_queue();
  while (take_slot(run, next_slot, ask_for_number(next_slot, queue), &queue, &slot)) {
    trace_slot(run, slot);
    trax_count_items(1);
  }
  trax_halt();
}
