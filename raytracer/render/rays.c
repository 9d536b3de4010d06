#include "rays.h"

#include "ray_trace.h"
#include "trax/input.h"
#include "trax/output.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <trax.h>

/* --- the file --- */

/* Limits of quantised nodes (layouts/quantised/planes.h); those of binary ones are wider. */
#define LEAST_DIRECTION 0x1p-2f
#define GREATEST_DIRECTION 0x1p10f

static float greatest(const float values[3]) {
  return fmaxf(fabsf(values[0]), fmaxf(fabsf(values[1]), fabsf(values[2])));
}

static bool are_finite(const float values[3]) {
  return isfinite(values[0]) && isfinite(values[1]) && isfinite(values[2]);
}

/* Returns the error of a ray; NULL: there is none. */
static const char *fault_of(const struct trax_ray_record *ray) {
  const float size = greatest(ray->direction);
  if (!are_finite(ray->origin) || !are_finite(ray->direction))
    return "a coordinate is not finite";
  if (!(size >= LEAST_DIRECTION && size <= GREATEST_DIRECTION))
    return "the largest component of the direction is not within 0.25 and 1024";
  if (ray->begin != 0)
    return "its interval does not begin at 0";
  if (!(ray->end > 0 && isfinite(ray->end)))
    return "its interval has no end above 0 (2^127 is none)";
  if (ray->kind >= TRAX_RAY_KIND_COUNT)
    return "there is no such kind of ray";
  return NULL;
}

static trax_status check(const struct trax_rays *rays, const char *path, trax_error *error) {
  for (uint32_t i = 0; i < rays->count; i++) {
    const char *fault = fault_of(&rays->records[i]);
    if (fault)
      return trax_fail(error, "%s: ray %u: %s", path, i + 1, fault);
  }
  return TRAX_OK;
}

trax_status trax_rays_read(struct trax_rays *rays, const char *path, trax_error *error) {
  uint8_t *bytes;
  size_t size;
  *rays = (struct trax_rays){0};
  /* Offsets of rays on the device have 32 bits. */
  const size_t limit = sizeof rays->header + (UINT32_MAX / sizeof(struct trax_input_ray)) * sizeof *rays->records;
  if (trax_read_file(path, limit, &bytes, &size, error) != TRAX_OK)
    return TRAX_ERROR;
  trax_status status = TRAX_OK;
  if (size >= sizeof rays->header)
    memcpy(&rays->header, bytes, sizeof rays->header);
  if (memcmp(rays->header.magic, TRAX_RAY_FILE_MAGIC, sizeof rays->header.magic) != 0 ||
      rays->header.record_bytes != sizeof *rays->records)
    status = trax_fail(error, "%s: not a binary file of rays, as --ray-trace writes it", path);
  else if (rays->header.exact > 1)
    status = trax_fail(error, "%s: `exact` is %u, neither 0 nor 1", path, rays->header.exact);
  else if (rays->header.exponent < -300 || rays->header.exponent > 300)
    status = trax_fail(error, "%s: no scene is scaled by 2^%d", path, rays->header.exponent);
  else if ((size - sizeof rays->header) % sizeof *rays->records != 0)
    status = trax_fail(error, "%s: ray %zu is cut off", path, (size - sizeof rays->header) / sizeof *rays->records + 1);
  else if (size == sizeof rays->header)
    status = trax_fail(error, "%s: it has no rays", path);
  if (status == TRAX_OK) {
    rays->count = (uint32_t)((size - sizeof rays->header) / sizeof *rays->records);
    rays->records = malloc(rays->count * sizeof *rays->records);
    rays->order = malloc(rays->count * sizeof *rays->order);
    status = rays->records && rays->order ? TRAX_OK : trax_fail(error, "out of memory for %u rays", rays->count);
  }
  if (status == TRAX_OK) {
    memcpy(rays->records, bytes + sizeof rays->header, rays->count * sizeof *rays->records);
    for (uint32_t i = 0; i < rays->count; i++)
      rays->order[i] = i;
    status = check(rays, path, error);
  }
  free(bytes);
  if (status != TRAX_OK)
    trax_rays_release(rays);
  return status;
}

void trax_rays_release(struct trax_rays *rays) {
  free(rays->records);
  free(rays->order);
  free(rays->hits);
  *rays = (struct trax_rays){0};
}

/* --- the frame --- */

/* The origin that is farthest from the scene's box: it decides the margin of the boxes. */
static const float *farthest_origin(const struct trax_rays *rays, const struct trax_scene_header *header) {
  const float *farthest = rays->records[0].origin;
  double most = -1;
  for (uint32_t i = 0; i < rays->count; i++) {
    const float *origin = rays->records[i].origin;
    double distance = 0;
    for (int axis = 0; axis < 3; axis++)
      distance = fmax(distance, fmax(fabs((double)header->bounds_min[axis] - (double)origin[axis]),
                                     fabs((double)header->bounds_max[axis] - (double)origin[axis])));
    if (distance > most)
      most = distance, farthest = origin;
  }
  return farthest;
}

trax_status trax_rays_frame(struct trax_frame *frame, struct trax_scene *scene, const struct trax_rays *rays,
                            trax_error *error) {
  struct trax_view view = {.direction = {0, 0, -1}, .up = {0, 1, 0}, .fov = 60};
  const struct trax_frame_options options = {.width = 1, .height = 1, .samples = 1};
  int exponent;
  if (scene->instances)
    return trax_fail(error, "--rays traces no rays of a scene with instances (--flatten)");
  trax_scale_scene(scene, rays->header.exponent);
  if (!are_finite(scene->header->bounds_min) || !are_finite(scene->header->bounds_max))
    return trax_fail(error, "the rays are of another scene: this one has no coordinates times 2^%d",
                     rays->header.exponent);
  const float *farthest = farthest_origin(rays, scene->header);
  memcpy(view.eye, farthest, sizeof view.eye);
  if (trax_normalise(scene, &view, &exponent, error) != TRAX_OK)
    return TRAX_ERROR;
  if (exponent)
    return trax_fail(error, "the rays are of another scene: with their coordinates this one would be scaled by 2^%d",
                     exponent);
  if (trax_frame_init(frame, scene, &view, &options, error) != TRAX_OK)
    return TRAX_ERROR;
  struct trax_render_params *params = frame->params;
  params->features = rays->header.exact ? TRAX_FEATURE_BIT(EXACT) : 0;
  params->slot_count = params->width = rays->count;
  params->tile_log2_side = TRAX_RAYS_LOG2_SIDE;
  frame->rays = rays;
  return TRAX_OK;
}

/* --- the run --- */

trax_status trax_rays_bind(trax_machine *machine, const struct trax_rays *rays, trax_error *error) {
  if (trax_machine_bind(machine, "rays", NULL, rays->count * (uint32_t)sizeof(struct trax_input_ray), error) !=
          TRAX_OK ||
      trax_machine_bind(machine, "hits", NULL, rays->count * (uint32_t)sizeof(struct trax_ray_hit), error) != TRAX_OK)
    return TRAX_ERROR;
  uint32_t address, size;
  uint8_t *bytes;
  if (trax_machine_buffer(machine, "rays", &address, &bytes, &size, error) != TRAX_OK)
    return TRAX_ERROR;
  for (uint32_t i = 0; i < rays->count; i++) {
    const struct trax_ray_record *record = &rays->records[rays->order[i]];
    struct trax_input_ray ray = {.farthest = record->end, .kind = record->kind};
    memcpy(ray.origin, record->origin, sizeof ray.origin);
    memcpy(ray.direction, record->direction, sizeof ray.direction);
    memcpy(bytes + i * sizeof ray, &ray, sizeof ray);
  }
  return TRAX_OK;
}

trax_status trax_rays_take(struct trax_rays *rays, trax_machine *machine, trax_error *error) {
  const uint8_t *bytes;
  uint32_t size;
  if (trax_machine_read_buffer(machine, "hits", &bytes, &size, error) != TRAX_OK)
    return TRAX_ERROR;
  rays->hits = malloc(rays->count * sizeof *rays->hits);
  if (!rays->hits)
    return trax_fail(error, "out of memory for the hits of %u rays", rays->count);
  memcpy(rays->hits, bytes, rays->count * sizeof *rays->hits);
  return TRAX_OK;
}

/* --- the results --- */

/* The record of the program's ray with the run's result in place of the file's. */
static struct trax_ray_record result_of(const struct trax_rays *rays, const struct trax_scene *scene, uint32_t ray) {
  const struct trax_ray_hit *hit = &rays->hits[ray];
  struct trax_ray_record record = rays->records[rays->order[ray]];
  record.hit = hit->triangle != 0;
  record.triangle = TRAX_NO_TRIANGLE;
  record.distance = record.weight1 = record.weight2 = 0;
  record.nodes = record.triangles = 0;
  if (hit->triangle > TRAX_ANY_TRIANGLE) {
    record.triangle = trax_ray_triangle(scene, hit->triangle, 0);
    record.distance = hit->distance, record.weight1 = hit->weight1, record.weight2 = hit->weight2;
  }
  return record;
}

uint32_t trax_rays_unequal(const struct trax_rays *rays, const struct trax_scene *scene, uint32_t *first) {
  uint32_t unequal = 0;
  *first = UINT32_MAX;
  for (uint32_t i = 0; i < rays->count; i++) {
    const struct trax_ray_record expected = rays->records[rays->order[i]], found = result_of(rays, scene, i);
    const bool any = expected.kind == TRAX_RAY_SHADOW || expected.kind == TRAX_RAY_OCCLUSION;
    const bool same =
        found.hit == expected.hit && (any || (found.triangle == expected.triangle &&
                                              memcmp(&found.distance, &expected.distance, sizeof found.distance) == 0 &&
                                              memcmp(&found.weight1, &expected.weight1, sizeof found.weight1) == 0 &&
                                              memcmp(&found.weight2, &expected.weight2, sizeof found.weight2) == 0));
    unequal += !same;
    if (!same && rays->order[i] < *first)
      *first = rays->order[i];
  }
  return unequal;
}

trax_status trax_rays_write(const struct trax_rays *rays, const struct trax_scene *scene, const char *path,
                            trax_error *error) {
  struct trax_ray_record *results = malloc(rays->count * sizeof *results);
  trax_output output;
  if (!results)
    return trax_fail(error, "out of memory for the results of %u rays", rays->count);
  for (uint32_t i = 0; i < rays->count; i++)
    results[rays->order[i]] = result_of(rays, scene, i);
  trax_status status = trax_output_open(&output, path, error);
  if (status == TRAX_OK) {
    fwrite(&rays->header, sizeof rays->header, 1, output.file);
    fwrite(results, sizeof *results, rays->count, output.file);
    status = trax_output_commit(&output, error); /* which finds earlier failures to write */
  }
  free(results);
  return status;
}
