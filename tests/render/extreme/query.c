#include "query.h"

#if TRAX_EXACT_HITS
#include "../../../raytracer/device/exact.h"
#endif

#include "../../../raytracer/device/aim.h"
#include "../../../raytracer/device/traverse.h"

#include <trax.h>

static inline void answer_query(const char *scene, const struct query_params *params, const struct query_ray *query,
                                struct query_answer *answer) {
  const trax_scene_ref root = ((const struct trax_scene_header *)(const void *)scene)->root;
  struct vector origin = load_vector(query->origin), direction = load_vector(query->direction);
  direction = times(direction_scale(direction), direction);
  struct hit hit = {0x7F000000, NULL, 0, 0};
  unsigned shadow = 0;
  for (;;) {
    struct ray ray;
    prepare_ray(&ray, RUN_LAYOUT(params), origin, direction, params->box_margin, &params->grid);
    HIDE_ORIGIN(shadow); /* one copy of the traversal */
    bool found = trace_ray(RUN_LAYOUT(params), scene, root, &ray, shadow, &hit);
    if (shadow) {
      answer->light = found ? QUERY_SHADOWED : QUERY_LIT;
      break;
    }
    *answer = (struct query_answer){.distance_bits = (uint32_t)hit.distance_bits};
    if (!found)
      break;
    answer->triangle = (uint32_t)(hit.triangle - scene);
#if TRAX_INSTANCES
    answer->instance = (uint32_t)(hit.instance - scene);
#endif
    answer->weight1 = hit.weight1, answer->weight2 = hit.weight2;
    if (!params->shadows)
      break;
    struct surface surface;
    struct light way;
    find_surface(&surface, &hit, origin, direction);
    aim_at_light(&way, &surface, params->light);
    answer->origin[0] = surface.start.x, answer->origin[1] = surface.start.y, answer->origin[2] = surface.start.z;
    answer->light = QUERY_BEHIND;
    if (way.cosine_bits <= 0)
      break;
    origin = surface.start, direction = way.direction;
    hit = (struct hit){way.distance_bits, NULL, 0, 0};
    shadow = 1;
  }
  trax_count_rays(1 + shadow);
}

#ifdef __trax__

struct trax_buffer scene, params, rays, answers;
unsigned next_ray;

int main(void) {
  const struct query_params *asked = params.data;
  uint32_t number;
  while ((number = trax_atomic_inc(&next_ray)) < asked->count)
    answer_query(scene.data, asked, (const struct query_ray *)rays.data + number,
                 (struct query_answer *)answers.data + number);
  return 0;
}

#else

void QUERY_FUNCTION(const void *scene, const struct query_params *params, const struct query_ray *rays,
                    struct query_answer *answers, uint32_t first, uint32_t last) {
  for (uint32_t i = first; i < last; i++)
    answer_query(scene, params, &rays[i], &answers[i]);
}

#endif
