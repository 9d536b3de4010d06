/* Rays arrive one after another, in the order of the program's slots, and are written at once. */
#include "ray_trace.h"

#include "trax/access.h"
#include "trax/output.h"

#include <stdlib.h>
#include <string.h>
#include <trax.h>

struct tracer {
  struct trax_visit_counter counter; /* of the ray; first: the log's functions get its address */
  const struct trax_scene *scene;
  void (*put)(FILE *out, const struct tracer *tracer, const struct trax_traced_ray *ray);
  trax_output output;
};

static void end_slot(struct trax_access_log *log, uint32_t slot, uint32_t rays) {
  (void)log, (void)slot, (void)rays;
}

static void end_ray(struct trax_access_log *log, const struct trax_traced_ray *ray) {
  struct tracer *tracer = (struct tracer *)log;
  trax_visit_count(log);
  tracer->put(tracer->output.file, tracer, ray);
  tracer->counter.nodes = tracer->counter.triangles = 0;
}

/* Its number in the meshes, as --id-picture shows it less 1; in scenes without these numbers its place in the file. */
static uint32_t triangle_number(const struct trax_scene *scene, uint32_t offset) {
  if (!offset)
    return TRAX_NO_TRIANGLE;
  const uint32_t number =
      (offset - scene->header->sections[TRAX_SCENE_TRIANGLES].offset) / sizeof(struct trax_triangle);
  return scene->source_ids ? scene->source_ids[number] : number;
}

/* --- formats --- */

static const char *const kind_names[TRAX_RAY_KIND_COUNT] = {
#define NAME(X, ID, NAME, NUMBER, MEANING) [NUMBER] = #NAME,
    TRAX_RAY_KINDS(NAME, )
#undef NAME
};

static uint8_t *put_number(uint8_t *to, uint32_t value, unsigned bytes) {
  for (unsigned i = 0; i < bytes; i++)
    *to++ = (uint8_t)(value >> 8 * i);
  return to;
}

static uint8_t *put_float(uint8_t *to, float value) {
  uint32_t bits;
  memcpy(&bits, &value, sizeof bits);
  return put_number(to, bits, 4);
}

static void put_binary(FILE *out, const struct tracer *tracer, const struct trax_traced_ray *ray) {
  uint8_t record[TRAX_RAY_TRACE_RECORD], *to = record;
  for (int axis = 0; axis < 3; axis++)
    to = put_float(to, ray->origin[axis]);
  for (int axis = 0; axis < 3; axis++)
    to = put_float(to, ray->direction[axis]);
  to = put_float(to, 0);
  to = put_float(to, ray->farthest);
  to = put_number(to, ray->pixel & 0xFFFF, 2);
  to = put_number(to, ray->pixel >> 16, 2);
  to = put_number(to, ray->sample, 2);
  to = put_number(to, ray->kind, 1);
  to = put_number(to, ray->found, 1);
  to = put_number(to, triangle_number(tracer->scene, ray->triangle), 4);
  to = put_float(to, ray->triangle ? ray->distance : 0);
  to = put_float(to, ray->triangle ? ray->weight1 : 0);
  to = put_float(to, ray->triangle ? ray->weight2 : 0);
  to = put_number(to, tracer->counter.nodes, 4);
  put_number(to, tracer->counter.triangles, 4);
  fwrite(record, sizeof record, 1, out);
}

static void put_csv(FILE *out, const struct tracer *tracer, const struct trax_traced_ray *ray) {
  fprintf(out, "%u,%u,%u,%s,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,0,%.9g,%u,", ray->pixel & 0xFFFF, ray->pixel >> 16,
          ray->sample, kind_names[ray->kind], (double)ray->origin[0], (double)ray->origin[1], (double)ray->origin[2],
          (double)ray->direction[0], (double)ray->direction[1], (double)ray->direction[2], (double)ray->farthest,
          ray->found);
  if (ray->triangle)
    fprintf(out, "%u,%.9g,%.9g,%.9g,", triangle_number(tracer->scene, ray->triangle), (double)ray->distance,
            (double)ray->weight1, (double)ray->weight2);
  else
    fputs(",,,,", out);
  fprintf(out, "%u,%u\n", tracer->counter.nodes, tracer->counter.triangles);
}

static void put_header(struct tracer *tracer, const struct trax_render_params *params, bool csv) {
  if (csv) {
    fputs("x,y,sample,kind,origin_x,origin_y,origin_z,direction_x,direction_y,direction_z,begin,end,hit,triangle,"
          "distance,weight1,weight2,nodes,triangles\n",
          tracer->output.file);
    return;
  }
  uint8_t header[TRAX_RAY_TRACE_HEADER] = "traxray1", *to = header + 8;
  to = put_number(to, TRAX_RAY_TRACE_RECORD, 4);
  to = put_number(to, params->width, 4);
  to = put_number(to, params->height, 4);
  put_number(to, params->samples, 4);
  fwrite(header, sizeof header, 1, tracer->output.file);
}

/* --- the trace --- */

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

trax_status trax_ray_trace_write(const char *path, const struct trax_frame *frame, const struct trax_picture *picture,
                                 struct trax_render_run *run, trax_error *error) {
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
    put_header(tracer, frame->params, csv);
    status = trace(tracer, frame, picture, run, error);
    if (status == TRAX_OK)
      status = trax_output_commit(&tracer->output, error);
    else
      trax_output_discard(&tracer->output);
  }
  free(tracer);
  return status;
}
