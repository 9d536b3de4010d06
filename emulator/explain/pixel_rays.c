/* The rays of each pixel: what the caller knows of them, and what each took, by the traps that count them. */
#include "explain/page.h"
#include "explain/ray_kinds.h"
#include "explain/stories.h"
#include "trax/grow.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_MARKS = 1 << 22 }; /* beyond, only those of stories are kept */

/* The trap that counted a ray, and what followed up to the next one. */
struct mark {
  uint32_t place, cycles, instructions;
  uint8_t kind;
};

struct trax_pixel_rays {
  struct mark *marks;
  size_t count, capacity;
  bool too_many;
};

struct trax_pixel_rays *trax_pixel_rays_create(void) {
  return calloc(1, sizeof(struct trax_pixel_rays));
}

void trax_pixel_rays_destroy(struct trax_pixel_rays *rays) {
  if (rays)
    free(rays->marks);
  free(rays);
}

bool trax_pixel_rays_add(struct trax_pixel_rays *rays, uint32_t place, unsigned kind, uint64_t cycles,
                         uint64_t instructions) {
  if (rays->too_many || (rays->too_many = rays->count == MOST_MARKS))
    return true;
  if (!trax_grow((void **)&rays->marks, rays->count, &rays->capacity, sizeof *rays->marks))
    return false;
  rays->marks[rays->count++] = (struct mark){place, (uint32_t)cycles, (uint32_t)instructions, (uint8_t)kind};
  return true;
}

/* Replaces too many rays by those of the stories. */
static bool take_stories(struct trax_pixel_rays *rays, struct trax_stories *stories) {
  size_t count;
  const struct trax_story *story = trax_stories_sorted(stories, &count);
  rays->too_many = false;
  rays->count = 0;
  for (size_t i = 0; i < count; i++, story++)
    for (size_t k = 1; k < story->ray_count; k++) {
      const struct trax_story_ray *ray = &story->rays[k];
      uint64_t cycles = 0;
      for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++)
        cycles += ray->cycles[cause];
      if (!trax_pixel_rays_add(rays, story->place, ray->kind, cycles, ray->cycles[TRAX_CAUSE_ISSUED]))
        return false;
    }
  return true;
}

/* Sorts the marks by their place; those of one stay in their order. counts: of each place. */
static bool sort(struct trax_pixel_rays *rays, size_t places, uint32_t *counts) {
  struct mark *sorted = malloc((rays->count + 1) * sizeof *sorted);
  size_t *next = calloc(places + 1, sizeof *next);
  for (size_t i = 0; sorted && next && i < rays->count; i++)
    counts[rays->marks[i].place]++;
  for (size_t i = 0; sorted && next && i < places; i++)
    next[i + 1] = next[i] + counts[i];
  for (size_t i = 0; sorted && next && i < rays->count; i++)
    sorted[next[rays->marks[i].place]++] = rays->marks[i];
  free(next);
  if (!sorted || !next) {
    free(sorted);
    return false;
  }
  free(rays->marks);
  rays->marks = sorted;
  return true;
}

/* Whether the marks are those of the caller's rays. */
static bool are_those(const struct trax_pixel_rays *rays, const struct trax_explore_picture *picture) {
  bool same = picture->counted_apart && rays->count == picture->ray_count;
  for (size_t i = 0; same && i < rays->count; i++)
    same = rays->marks[i].place == picture->rays[i].place && rays->marks[i].kind == picture->rays[i].kind;
  return same;
}

static void put_known(const struct trax_explore_picture *picture, FILE *members, FILE *columns) {
  const struct trax_explore_ray *rays = picture->rays;
  fputs("\"kind\", \"hit\", \"material\", \"nodes\", \"triangles\"", members);
  if (picture->has_instances)
    fputs(", \"instance\"", members);
  for (size_t i = 0; i < picture->ray_count; i++)
    trax_page_number(columns, rays[i].kind);
  for (size_t i = 0; i < picture->ray_count; i++)
    trax_page_number(columns, rays[i].hit);
  for (size_t i = 0; i < picture->ray_count; i++)
    trax_page_number(columns, rays[i].material == TRAX_NO_MATERIAL ? 0 : rays[i].material + 1);
  for (size_t i = 0; i < picture->ray_count; i++)
    trax_page_number(columns, rays[i].nodes);
  for (size_t i = 0; i < picture->ray_count; i++)
    trax_page_number(columns, rays[i].triangles);
  for (size_t i = 0; i < picture->ray_count && picture->has_instances; i++)
    trax_page_number(columns, rays[i].instance == TRAX_NO_INSTANCE ? 0 : rays[i].instance + 1);
}

static void put_costs(const struct trax_pixel_rays *rays, FILE *members, FILE *columns) {
  fputs(", \"cycles\", \"instructions\"", members);
  for (size_t i = 0; i < rays->count; i++)
    trax_page_number(columns, rays->marks[i].cycles);
  for (size_t i = 0; i < rays->count; i++)
    trax_page_number(columns, rays->marks[i].instructions);
}

trax_status trax_pixel_rays_put(struct trax_explain *explain, size_t places, FILE *members, FILE *columns,
                                trax_error *error) {
  const struct trax_explore_picture *picture = &explain->picture;
  struct trax_pixel_rays *rays = explain->pixel_rays;
  if (!rays || !picture->rays)
    return TRAX_OK;
  uint32_t *counts = calloc(places + 1, sizeof *counts);
  if (!counts || (rays->too_many && !take_stories(rays, explain->stories)) || !sort(rays, places, counts)) {
    free(counts);
    return trax_fail(error, "out of memory for the rays of %zu pixels", places);
  }
  memset(counts, 0, places * sizeof *counts);
  for (size_t i = 0; i < picture->ray_count; i++)
    counts[picture->rays[i].place]++;
  fputs("\"rays\": {\"kinds\": [", members);
  for (unsigned kind = 0; kind < TRAX_RAY_KIND_COUNT; kind++)
    fprintf(members, "%s\"%s\"", kind ? ", " : "", trax_ray_kind_names[kind]);
  fputs("],\n\"materials\": [", members);
  for (uint32_t i = 0; i < picture->material_count; i++)
    fprintf(members, "%s\"%s\"", i ? ", " : "", picture->materials[i]);
  fputs("],\n\"fields\": [", members);
  for (size_t i = 0; i < places; i++)
    trax_page_number(columns, counts[i]);
  put_known(picture, members, columns);
  if (are_those(rays, picture))
    put_costs(rays, members, columns);
  fputs("]},\n", members);
  free(counts);
  return TRAX_OK;
}

bool trax_pixel_rays_all(const struct trax_pixel_rays *rays) {
  return !rays->too_many;
}
