/* Rays arrive one after another, in the order of the program's slots, and are written at once. */
#include "ray_trace.h"

#include "placed.h"
#include "ray_file.h"
#include "trax/access.h"
#include "trax/output.h"

#include <stdlib.h>
#include <string.h>
#include <trax.h>

struct tracer {
  struct trax_visit_counter counter; /* of the ray; first: the log's functions get its address */
  const struct trax_scene *scene;
  void (*put)(FILE *out, const struct trax_ray_record *ray);
  trax_output output;
};

static void end_slot(struct trax_access_log *log, uint32_t slot, uint32_t rays) {
  (void)log, (void)slot, (void)rays;
}

uint32_t trax_ray_triangle(const struct trax_scene *scene, uint32_t offset, uint32_t instance) {
  const uint32_t number = offset ? trax_number_of_hit(scene, offset, instance) : TRAX_NO_TRIANGLE;
  return number == TRAX_NO_TRIANGLE ? number : trax_source_of(scene, number);
}

/* --- formats --- */

static const char *const kind_names[TRAX_RAY_KIND_COUNT] = {
#define NAME(X, ID, NAME, NUMBER, MEANING) [NUMBER] = #NAME,
    TRAX_RAY_KINDS(NAME, )
#undef NAME
};

static struct trax_ray_record record_of(const struct tracer *tracer, const struct trax_traced_ray *ray) {
  struct trax_ray_record record = {.end = ray->farthest,
                                   .x = (uint16_t)ray->pixel,
                                   .y = (uint16_t)(ray->pixel >> 16),
                                   .sample = (uint16_t)ray->sample,
                                   .kind = (uint8_t)ray->kind,
                                   .hit = (uint8_t)ray->found,
                                   .triangle = trax_ray_triangle(tracer->scene, ray->triangle, ray->instance),
                                   .nodes = tracer->counter.nodes,
                                   .triangles = tracer->counter.triangles};
  memcpy(record.origin, ray->origin, sizeof record.origin);
  memcpy(record.direction, ray->direction, sizeof record.direction);
  if (ray->triangle)
    record.distance = ray->distance, record.weight1 = ray->weight1, record.weight2 = ray->weight2;
  return record;
}

static void put_binary(FILE *out, const struct trax_ray_record *ray) {
  fwrite(ray, sizeof *ray, 1, out);
}

static void put_csv(FILE *out, const struct trax_ray_record *ray) {
  fprintf(out, "%u,%u,%u,%s,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,0,%.9g,%u,", ray->x, ray->y, ray->sample,
          kind_names[ray->kind], (double)ray->origin[0], (double)ray->origin[1], (double)ray->origin[2],
          (double)ray->direction[0], (double)ray->direction[1], (double)ray->direction[2], (double)ray->end, ray->hit);
  if (ray->triangle != TRAX_NO_TRIANGLE)
    fprintf(out, "%u,%.9g,%.9g,%.9g,", ray->triangle, (double)ray->distance, (double)ray->weight1,
            (double)ray->weight2);
  else
    fputs(",,,,", out);
  fprintf(out, "%u,%u\n", ray->nodes, ray->triangles);
}

static void put_header(struct tracer *tracer, const struct trax_render_params *params, int exponent, bool csv) {
  const struct trax_ray_file_header header = {.magic = TRAX_RAY_FILE_MAGIC,
                                              .record_bytes = sizeof(struct trax_ray_record),
                                              .width = params->width,
                                              .height = params->height,
                                              .samples = params->samples,
                                              .exponent = exponent,
                                              .exact = params->features >> TRAX_FEATURE_EXACT & 1};
  if (csv)
    fputs("x,y,sample,kind,origin_x,origin_y,origin_z,direction_x,direction_y,direction_z,begin,end,hit,triangle,"
          "distance,weight1,weight2,nodes,triangles\n",
          tracer->output.file);
  else
    fwrite(&header, sizeof header, 1, tracer->output.file);
}

/* --- the trace --- */

static void end_ray(struct trax_access_log *log, const struct trax_traced_ray *ray) {
  struct tracer *tracer = (struct tracer *)log;
  trax_visit_count(log);
  const struct trax_ray_record record = record_of(tracer, ray);
  tracer->put(tracer->output.file, &record);
  tracer->counter.nodes = tracer->counter.triangles = 0;
}

static trax_status trace(struct tracer *tracer, const struct trax_frame *frame, const struct trax_picture *picture,
                         struct trax_render_run *run, trax_error *error) {
  const size_t pixels = (size_t)frame->params->width * frame->params->height;
  struct trax_picture twin = {0};
  struct trax_render_run logged = *run;
  logged.accesses = &tracer->counter.log;
  trax_status status = trax_render_twin(&twin, frame, 1, &logged, error);
  if (status == TRAX_OK && picture && memcmp(twin.pixels, picture->pixels, pixels * sizeof *twin.pixels) != 0)
    status = trax_fail(error, "--ray-trace: the rays are the native twin's, and this program's picture is another one");
  trax_picture_release(&twin);
  return status;
}

trax_status trax_ray_trace_write(const char *path, const struct trax_frame *frame, int exponent,
                                 const struct trax_picture *picture, struct trax_render_run *run, trax_error *error) {
  const bool csv = trax_output_has_ending(path, "csv");
  struct tracer *tracer = calloc(1, sizeof *tracer);
  if (!tracer)
    return trax_fail(error, "out of memory");
  trax_visit_counter_init(&tracer->counter);
  tracer->counter.log.slot = end_slot;
  tracer->counter.log.ray = end_ray;
  tracer->scene = frame->scene;
  tracer->put = csv ? put_csv : put_binary;
  trax_status status = trax_output_open(&tracer->output, path, error);
  if (status == TRAX_OK) {
    put_header(tracer, frame->params, exponent, csv);
    status = trace(tracer, frame, picture, run, error);
    if (status == TRAX_OK)
      status = trax_output_commit(&tracer->output, error);
    else
      trax_output_discard(&tracer->output);
  }
  free(tracer);
  return status;
}
