/* Counts the nodes and triangles that each pixel's rays visit, by the native twin. */
#include "../device/camera.h"
#include "render.h"
#include "trax/explain.h"
#include "trax/grow.h"

#include <stdlib.h>
#include <string.h>

void trax_visit_count(struct trax_access_log *log) {
  struct trax_visit_counter *counter = (struct trax_visit_counter *)log;
  for (const trax_access *access = counter->accesses; access < log->end; access++)
    ++*(*access & TRAX_ACCESS_TRIANGLE ? &counter->triangles : &counter->nodes);
  log->end = counter->accesses;
}

void trax_visit_counter_init(struct trax_visit_counter *counter) {
  counter->log.end = counter->accesses;
  counter->log.limit = counter->accesses + sizeof counter->accesses / sizeof *counter->accesses;
  counter->log.full = trax_visit_count;
}

struct pixel_counter {
  struct trax_visit_counter counter; /* first: the log's functions get its address */
  const struct trax_render_params *params;
  struct trax_visits *visits;
  const struct trax_scene *scene;
  uint32_t *begins;          /* of the instances, in the order in which they were placed */
  uint32_t nodes, triangles; /* of the slot's earlier rays */
  bool out_of_memory;
};

static void end_slot(struct trax_access_log *log, uint32_t slot, uint32_t rays) {
  struct pixel_counter *pixels = (struct pixel_counter *)log;
  struct trax_visit_counter *counter = &pixels->counter;
  struct pixel pixel;
  (void)rays;
  trax_visit_count(log);
  counter->nodes += pixels->nodes, counter->triangles += pixels->triangles;
  pixels->nodes = pixels->triangles = 0;
  if (slot_pixel(pixels->params, slot, &pixel)) {
    const size_t number = (size_t)pixel_y(pixel) * pixels->params->width + pixel_x(pixel);
    pixels->visits->nodes[number] = counter->nodes;
    pixels->visits->triangles[number] = counter->triangles;
  }
  counter->nodes = counter->triangles = 0;
}

static int compare_numbers(const void *a, const void *b) {
  const uint32_t *left = a, *right = b;
  return *left < *right ? -1 : *left > *right;
}

/* The first triangle's number of each instance, in the order in which they were placed; in the file they are in the
   tree's order. To be freed. */
static uint32_t *sort_instances(const struct trax_scene *scene) {
  uint32_t *begins = malloc((scene->instance_count + (size_t)1) * sizeof *begins);
  for (uint32_t i = 0; begins && i < scene->instance_count; i++)
    begins[i] = scene->instances[i].first_source;
  if (begins && scene->instance_count)
    qsort(begins, scene->instance_count, sizeof *begins, compare_numbers);
  return begins;
}

/* The number of an instance in this order, from 0. */
static uint32_t placed_number(const struct pixel_counter *pixels, const struct trax_instance *instance) {
  const uint32_t *found = bsearch(&instance->first_source, pixels->begins, pixels->scene->instance_count,
                                  sizeof *pixels->begins, compare_numbers);
  return found ? (uint32_t)(found - pixels->begins) : TRAX_NO_INSTANCE;
}

static void end_ray(struct trax_access_log *log, const struct trax_traced_ray *ray) {
  struct pixel_counter *pixels = (struct pixel_counter *)log;
  struct trax_visit_counter *counter = &pixels->counter;
  struct trax_visits *visits = pixels->visits;
  const uint32_t place = (ray->pixel >> 16) * pixels->params->width + (ray->pixel & 0xffff);
  trax_visit_count(log);
  struct trax_explore_ray known = {.place = place,
                                   .nodes = counter->nodes,
                                   .triangles = counter->triangles,
                                   .kind = (uint8_t)ray->kind,
                                   .hit = ray->found != 0,
                                   .material = TRAX_NO_MATERIAL,
                                   .instance = TRAX_NO_INSTANCE};
  pixels->nodes += counter->nodes, pixels->triangles += counter->triangles;
  counter->nodes = counter->triangles = 0;
  if (!visits->wants_rays(visits->context, place))
    return;
  const char *bytes = (const char *)pixels->scene->bytes;
  if (ray->triangle)
    known.material = ((const struct trax_triangle *)(bytes + ray->triangle))->material;
  if (ray->triangle && ray->instance) {
    const struct trax_instance *instance = (const struct trax_instance *)(bytes + ray->instance);
    known.instance = placed_number(pixels, instance);
    if (instance->material != TRAX_NO_MATERIAL)
      known.material = instance->material;
  }
  if (trax_grow((void **)&visits->rays, visits->ray_count, &visits->ray_capacity, sizeof *visits->rays))
    visits->rays[visits->ray_count++] = known;
  else
    pixels->out_of_memory = true;
}

/* Sorts the rays by their pixel; those of one stay in their order. */
static bool sort_rays(struct trax_visits *visits, size_t pixels) {
  struct trax_explore_ray *sorted = malloc((visits->ray_count + 1) * sizeof *sorted);
  size_t *next = calloc(pixels + 1, sizeof *next);
  if (sorted && next) {
    for (size_t i = 0; i < visits->ray_count; i++)
      next[visits->rays[i].place + 1]++;
    for (size_t i = 0; i < pixels; i++)
      next[i + 1] += next[i];
    for (size_t i = 0; i < visits->ray_count; i++)
      sorted[next[visits->rays[i].place]++] = visits->rays[i];
    free(visits->rays);
    visits->rays = sorted;
  } else {
    free(sorted);
  }
  free(next);
  return sorted && next;
}

trax_status trax_visits_count(struct trax_visits *visits, const struct trax_picture *picture,
                              const struct trax_frame *frame, struct trax_render_run *run, trax_error *error) {
  const size_t pixels = (size_t)frame->params->width * frame->params->height;
  struct trax_picture twin = {0};
  struct pixel_counter *counter = calloc(1, sizeof *counter);
  visits->nodes = calloc(pixels, sizeof *visits->nodes);
  visits->triangles = calloc(pixels, sizeof *visits->triangles);
  trax_status status = TRAX_OK;
  if (counter)
    counter->begins = sort_instances(frame->scene);
  if (!counter || !counter->begins || !visits->nodes || !visits->triangles) {
    status = trax_fail(error, "out of memory for the visits of %zu pixels", pixels);
  } else {
    trax_visit_counter_init(&counter->counter);
    counter->counter.log.slot = end_slot;
    if (visits->wants_rays)
      counter->counter.log.ray = end_ray;
    counter->scene = frame->scene;
    counter->params = frame->params;
    counter->visits = visits;
    struct trax_render_run logged = *run;
    logged.accesses = &counter->counter.log;
    status = trax_render_twin(&twin, frame, 1, &logged, error);
    if (status == TRAX_OK && visits->wants_rays && (counter->out_of_memory || !sort_rays(visits, pixels)))
      status = trax_fail(error, "out of memory for the rays of %zu pixels", pixels);
  }
  if (counter)
    free(counter->begins);
  free(counter);
  const bool same = status == TRAX_OK && memcmp(twin.pixels, picture->pixels, pixels * sizeof *twin.pixels) == 0;
  trax_picture_release(&twin);
  if (!same)
    trax_visits_release(visits);
  return status;
}

void trax_visits_release(struct trax_visits *visits) {
  free(visits->nodes);
  free(visits->triangles);
  free(visits->rays);
  *visits = (struct trax_visits){0};
}
