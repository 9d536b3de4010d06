/* How many nodes and triangles each pixel's rays visit, by the native twin. */
#include "../device/camera.h"
#include "render.h"

#include <stdlib.h>
#include <string.h>

struct counter {
  struct trax_access_log log; /* first: the log's functions get its address */
  trax_access accesses[4096];
  const struct trax_render_params *params;
  struct trax_visits *visits;
  uint32_t nodes, triangles; /* of the slot so far */
};

static void count(struct trax_access_log *log) {
  struct counter *counter = (struct counter *)log;
  for (const trax_access *access = counter->accesses; access < log->end; access++)
    ++*(*access & TRAX_ACCESS_TRIANGLE ? &counter->triangles : &counter->nodes);
  log->end = counter->accesses;
}

static void end_slot(struct trax_access_log *log, uint32_t slot, uint32_t rays) {
  struct counter *counter = (struct counter *)log;
  struct pixel pixel;
  (void)rays;
  count(log);
  if (slot_pixel(counter->params, slot, &pixel)) {
    const size_t number = (size_t)pixel_y(pixel) * counter->params->width + pixel_x(pixel);
    counter->visits->nodes[number] = counter->nodes;
    counter->visits->triangles[number] = counter->triangles;
  }
  counter->nodes = counter->triangles = 0;
}

trax_status trax_visits_count(struct trax_visits *visits, const struct trax_picture *picture,
                              const struct trax_frame *frame, struct trax_render_run *run, trax_error *error) {
  const size_t pixels = (size_t)frame->params->width * frame->params->height;
  struct trax_picture twin = {0};
  struct counter *counter = calloc(1, sizeof *counter);
  visits->nodes = calloc(pixels, sizeof *visits->nodes);
  visits->triangles = calloc(pixels, sizeof *visits->triangles);
  trax_status status = TRAX_OK;
  if (!counter || !visits->nodes || !visits->triangles) {
    status = trax_fail(error, "out of memory for the visits of %zu pixels", pixels);
  } else {
    counter->log = (struct trax_access_log){
        .end = counter->accesses, .limit = counter->accesses + 4096, .full = count, .slot = end_slot};
    counter->params = frame->params;
    counter->visits = visits;
    struct trax_render_run logged = *run;
    logged.accesses = &counter->log;
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
