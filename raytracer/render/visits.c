/* Counts the nodes and triangles that each pixel's rays visit, by the native twin. */
#include "../device/camera.h"
#include "render.h"

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
};

static void end_slot(struct trax_access_log *log, uint32_t slot, uint32_t rays) {
  struct pixel_counter *pixels = (struct pixel_counter *)log;
  struct trax_visit_counter *counter = &pixels->counter;
  struct pixel pixel;
  (void)rays;
  trax_visit_count(log);
  if (slot_pixel(pixels->params, slot, &pixel)) {
    const size_t number = (size_t)pixel_y(pixel) * pixels->params->width + pixel_x(pixel);
    pixels->visits->nodes[number] = counter->nodes;
    pixels->visits->triangles[number] = counter->triangles;
  }
  counter->nodes = counter->triangles = 0;
}

trax_status trax_visits_count(struct trax_visits *visits, const struct trax_picture *picture,
                              const struct trax_frame *frame, struct trax_render_run *run, trax_error *error) {
  const size_t pixels = (size_t)frame->params->width * frame->params->height;
  struct trax_picture twin = {0};
  struct pixel_counter *counter = calloc(1, sizeof *counter);
  visits->nodes = calloc(pixels, sizeof *visits->nodes);
  visits->triangles = calloc(pixels, sizeof *visits->triangles);
  trax_status status = TRAX_OK;
  if (!counter || !visits->nodes || !visits->triangles) {
    status = trax_fail(error, "out of memory for the visits of %zu pixels", pixels);
  } else {
    trax_visit_counter_init(&counter->counter);
    counter->counter.log.slot = end_slot;
    counter->params = frame->params;
    counter->visits = visits;
    struct trax_render_run logged = *run;
    logged.accesses = &counter->counter.log;
    status = trax_render_twin(&twin, frame, 1, &logged, error);
  }
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
  *visits = (struct trax_visits){0};
}
