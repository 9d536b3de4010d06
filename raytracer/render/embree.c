/* Pictures to compare with: Embree finds the hits, in binary32, or they are found without error (exact.c); binary64
   shades them. They share two things with the device program: the camera's arithmetic, and the points of the sampler,
   which tests/render/light_test.c judges. They share neither BVH, intersection, shading nor parameters of paths. */
#include "embree.h"

#include "reach.h"
#include "rtc_query.h"

#include <stdlib.h>
#include <string.h>

/* Squared pixel values, which are linear in the light. */
static struct double3 shade(const struct trax_frame *frame, uint32_t material, struct double3 normal, double lit) {
  const struct trax_palette_entry *palette = (const struct trax_palette_entry *)(frame->params + 1);
  const struct trax_render_params *params = frame->params;
  double light = params->ambient + dot(normal, from(params->fill)) + params->light_strength * lit;
  struct double3 colour = from(palette[material].colour);
  return (struct double3){colour.x * colour.x * light, colour.y * colour.y * light, colour.z * colour.z * light};
}

static struct double3 squares(uint32_t pixel) {
  double red = pixel & 255, green = pixel >> 8 & 255, blue = pixel >> 16 & 255;
  return (struct double3){red * red, green * green, blue * blue};
}

static struct double3 root(struct double3 squares) {
  return (struct double3){sqrt(squares.x), sqrt(squares.y), sqrt(squares.z)};
}

static uint32_t pixel_of(struct double3 channels) {
  return (uint32_t)floor(channels.x + 0.5) | (uint32_t)floor(channels.y + 0.5) << 8 |
         (uint32_t)floor(channels.z + 0.5) << 16 | 0xFF000000u;
}

bool embree_hit(const struct embree *embree, struct double3 origin, struct double3 direction, struct exact_hit *hit) {
  if (embree->exactly)
    return exact_nearest(embree->scene, origin, direction, hit);
  rtc_context context;
  struct RTCRayHit ray = {.ray = rtc_ray(origin, direction, INFINITY), .hit = {.geomID = RTC_INVALID_GEOMETRY_ID}};
  rtc_intersect(embree->scene, &context, &ray);
  *hit = (struct exact_hit){ray.hit.primID, ray.ray.tfar, ray.hit.u, ray.hit.v};
  return ray.hit.geomID != RTC_INVALID_GEOMETRY_ID;
}

bool embree_blocked(const struct embree *embree, struct double3 origin, struct double3 direction, double distance) {
  if (embree->exactly)
    return exact_any(embree->scene, origin, direction, distance);
  rtc_context context;
  struct RTCRay ray = rtc_ray(origin, direction, (float)distance);
  rtc_occluded(embree->scene, &context, &ray);
  return ray.tfar < 0;
}

double embree_start_bound(const struct embree *embree, const struct trax_triangle *triangle, struct double3 origin,
                          struct double3 sight) {
  const struct double3 v0 = from(triangle->v0);
  const double edges = fmax(greatest(minus(from(triangle->v1), v0)), greatest(minus(from(triangle->v2), v0)));
  return embree_needs(embree, TRAX_FEATURE_EXACT)
             ? trax_exact_start_bound(greatest(v0), edges, greatest(origin), greatest(sight))
             : trax_start_bound(greatest(v0), edges);
}

/* The start is moved along the normal and back along the sight. */
struct double3 embree_start(const struct embree *embree, const struct trax_triangle *triangle, struct double3 point,
                            struct double3 normal, struct double3 origin) {
  const struct double3 sight = minus(point, origin);
  const double bound = embree_start_bound(embree, triangle, origin, sight);
  const double back = fmin(0.5 * bound / exp2(floor(log2(greatest(sight)))), 1);
  return plus_scaled(plus_scaled(point, bound, normal), -back, sight);
}

/* The light through a place of a pixel. *seen receives what the rays meet. */
static struct double3 trace_sample(const struct embree *embree, struct pixel pixel, struct place place,
                                   struct trax_layers *seen, uint64_t *rays) {
  const struct trax_render_params *params = embree->frame->params;
  struct vector camera = camera_direction(params, pixel, place);
  struct double3 direction = {camera.x, camera.y, camera.z};
  struct exact_hit hit;
  *seen = (struct trax_layers){.triangle = TRAX_NO_TRIANGLE, .shadow = TRAX_SHADOW_NOT_ASKED};
  ++*rays;
  if (!embree_hit(embree, from(params->eye), direction, &hit))
    return squares(params->background);
  seen->triangle = hit.triangle;

  const struct trax_triangle *triangle = &embree->frame->scene->triangles[hit.triangle];
  struct double3 v0 = from(triangle->v0), e = minus(from(triangle->v1), v0), f = minus(from(triangle->v2), v0);
  struct double3 normal = cross(e, f);
  double length = sqrt(dot(normal, normal));
  double facing = dot(normal, direction) < 0 ? 1 / length : -1 / length;
  normal = (struct double3){facing * normal.x, facing * normal.y, facing * normal.z};
  const struct double3 point = plus_scaled(plus_scaled(v0, hit.u, e), hit.v, f);
  const struct double3 start = embree_start(embree, triangle, point, normal, from(params->eye));
  struct double3 flat = normal;
  if (embree_needs(embree, TRAX_FEATURE_SMOOTH)) {
    const struct trax_triangle_normals *normals = &embree->frame->scene->normals[hit.triangle];
    struct double3 n0 = from(normals->corner[0]), n1 = from(normals->corner[1]), n2 = from(normals->corner[2]);
    normal = plus_scaled(plus_scaled(n0, hit.u, minus(n1, n0)), hit.v, minus(n2, n0));
    double size = sqrt(dot(normal, normal)) * (dot(normal, flat) < 0 ? -1 : 1);
    normal = (struct double3){normal.x / size, normal.y / size, normal.z / size};
  }

  struct double3 way = minus(from(params->light), point);
  double distance = sqrt(dot(way, way));
  double cosine = distance > 0 ? fmin(dot(normal, way) / distance, 1) : 0;
  if (!(cosine > 0) || !(dot(flat, way) > 0))
    return shade(embree->frame, triangle->material, normal, 0);
  if (!embree_needs(embree, TRAX_FEATURE_SHADOWS))
    return shade(embree->frame, triangle->material, normal, cosine);
  struct double3 towards = {way.x / distance, way.y / distance, way.z / distance};
  const double left = embree_towards(start, from(params->light), &towards);
  const bool blocked = embree_blocked(embree, start, towards, left);
  ++*rays;
  seen->shadow = blocked ? TRAX_SHADOW_BLOCKED : TRAX_SHADOW_LIT;
  return shade(embree->frame, triangle->material, normal, blocked ? 0 : cosine);
}

#define MOST_LIGHT ((double)TRAX_MAX_RADIANCE) /* of a sample */

static void embree_pixel(struct embree *embree, uint32_t x, uint32_t y, uint64_t *rays) {
  const struct trax_render_params *params = embree->frame->params;
  const size_t index = (size_t)y * params->width + x;
  const bool path = params->features & TRAX_PATH_FEATURES;
  struct trax_layers seen;
  struct double3 sum = {0, 0, 0};
  if (embree->hits) {
    const struct vector camera = camera_direction(params, pixel_at(x, y), PIXEL_MIDDLE);
    struct exact_hit hit;
    const struct double3 eye = from(params->eye), direction = {camera.x, camera.y, camera.z};
    const bool found =
        embree->run->holes ? embree_seen(embree, eye, direction, &hit) : embree_hit(embree, eye, direction, &hit);
    embree->hits->triangles[index] = found ? hit.triangle : TRAX_NO_TRIANGLE;
    ++*rays;
    return;
  }
  for (uint32_t sample = 0; sample < params->samples; sample++) {
    struct double3 light = path ? embree_path(embree, pixel_at(x, y), sample, &seen, rays)
                                : trace_sample(embree, pixel_at(x, y), sample_place(sample), &seen, rays);
    if (path)
      light = (struct double3){fmin(light.x, MOST_LIGHT), fmin(light.y, MOST_LIGHT), fmin(light.z, MOST_LIGHT)};
    sum = plus_scaled(sum, 1.0 / params->samples, light);
    if (embree->picture->layers && sample == 0)
      embree->picture->layers[index] = seen;
  }
  if (embree->picture->radiance)
    for (int channel = 0; channel < 3; channel++)
      embree->picture->radiance[3 * index + channel] = (float)((&sum.x)[channel] / (path ? 1 : 65025));
  if (path) /* bounded by 1, in squared pixel values */
    sum = (struct double3){65025 * fmin(sum.x, 1), 65025 * fmin(sum.y, 1), 65025 * fmin(sum.z, 1)};
  embree->picture->pixels[index] = pixel_of(root(sum));
}

static void *render_rows(void *argument) {
  struct embree *embree = argument;
  const struct trax_render_params *params = embree->frame->params;
  uint64_t rays = 0;
  for (;;) {
    pthread_mutex_lock(&embree->lock);
    bool stop = embree->run->interrupt && *embree->run->interrupt;
    uint32_t row = stop ? params->height : embree->next_row++;
    pthread_mutex_unlock(&embree->lock);
    if (row >= params->height)
      break;
    for (uint32_t x = 0; x < params->width; x++)
      embree_pixel(embree, x, row, &rays);
    pthread_mutex_lock(&embree->lock);
    embree->finished_rows++;
    if (embree->run->progress)
      embree->run->progress(embree->run->progress_context, embree->finished_rows, params->height);
    pthread_mutex_unlock(&embree->lock);
  }
  pthread_mutex_lock(&embree->lock);
  embree->rays += rays;
  pthread_mutex_unlock(&embree->lock);
  return NULL;
}

trax_status embree_commit(RTCDevice device, RTCScene scene, const struct trax_scene *source, trax_error *error) {
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  if (source->triangle_count > 0) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    float *vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12,
                                              3 * (size_t)source->triangle_count);
    uint32_t *indices =
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, source->triangle_count);
    if (!vertices || !indices) {
      rtcReleaseGeometry(geometry);
      return trax_fail(error, "out of memory for Embree's scene of %u triangles", source->triangle_count);
    }
    for (uint32_t i = 0; i < source->triangle_count; i++) {
      memcpy(vertices + 9 * (size_t)i, source->triangles[i].v0, 36);
      for (uint32_t corner = 0; corner < 3; corner++)
        indices[3 * (size_t)i + corner] = 3 * i + corner;
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
  }
  rtcCommitScene(scene);
  enum RTCError failure = rtcGetDeviceError(device);
  return failure ? trax_fail(error, "Embree could not build the scene (error %d)", (int)failure) : TRAX_OK;
}

static trax_status build_scene(RTCDevice device, struct embree *embree, trax_error *error) {
  const struct trax_scene *source = embree->frame->scene;
  if (!embree->exactly || source->triangle_count == 0)
    return embree_commit(device, embree->scene, source, error);
  rtcSetSceneFlags(embree->scene, RTC_SCENE_FLAG_ROBUST);
  if (!exact_attach(device, embree->scene, source))
    return trax_fail(error, "out of memory for Embree's scene of %u triangles", source->triangle_count);
  rtcCommitScene(embree->scene);
  enum RTCError failure = rtcGetDeviceError(device);
  return failure ? trax_fail(error, "Embree could not build the scene (error %d)", (int)failure) : TRAX_OK;
}

static trax_status render(struct embree *embree, trax_error *error) {
  const unsigned processors = trax_host_processors(), count = processors > 64 ? 64 : processors;
  unsigned started = 0;
  pthread_t threads[64];
  while (started < count && pthread_create(&threads[started], NULL, render_rows, embree) == 0)
    started++;
  for (unsigned i = 0; i < started; i++)
    pthread_join(threads[i], NULL);
  if (started == 0)
    return trax_fail(error, "cannot start a thread for Embree's picture");
  return embree->finished_rows < embree->frame->params->height ? TRAX_INTERRUPTED : TRAX_OK;
}

static trax_status run_embree(struct embree *embree, trax_error *error) {
  RTCDevice device = rtcNewDevice(NULL);
  if (!device)
    return trax_fail(error, "Embree does not start (error %d)", (int)rtcGetDeviceError(NULL));
  embree->scene = rtcNewScene(device);
  trax_status status = build_scene(device, embree, error);
  if (status == TRAX_OK && !embree_prepare_lights(embree))
    status = trax_fail(error, "out of memory for the lights of Embree's picture");
  if (status == TRAX_OK)
    status = render(embree, error);
  free(embree->emitters);
  embree->run->rays = embree->rays;
  rtcReleaseScene(embree->scene);
  rtcReleaseDevice(device);
  return status;
}

trax_status trax_render_embree(struct trax_picture *picture, const struct trax_frame *frame,
                               struct trax_render_run *run, trax_error *error) {
  trax_status status = trax_picture_init(picture, frame->params->width, frame->params->height, error);
  if (status)
    return status;
  if (frame->params->features & TRAX_FEATURE_BIT(FLOATS) &&
      !(picture->radiance = calloc(3 * (size_t)picture->width * picture->height, sizeof *picture->radiance))) {
    trax_picture_release(picture);
    return trax_fail(error, "out of memory for a picture of %u x %u", frame->params->width, frame->params->height);
  }
  struct embree embree = {.frame = frame, .picture = picture, .run = run, .lock = PTHREAD_MUTEX_INITIALIZER};
  embree.exactly = run->exactly || embree_needs(&embree, TRAX_FEATURE_EXACT); /* as the program's hits are */
  if (run->layers && trax_layers_init(picture, frame, error) != TRAX_OK)
    return TRAX_ERROR;
  status = run_embree(&embree, error);
  if (status != TRAX_OK)
    trax_picture_release(picture);
  return status;
}

static trax_status find_hits(struct trax_hits *hits, const struct trax_frame *frame, bool exactly,
                             struct trax_render_run *run, trax_error *error) {
  const struct trax_render_params *params = frame->params;
  *hits = (struct trax_hits){.width = params->width, .height = params->height};
  hits->triangles = malloc((size_t)params->width * params->height * sizeof *hits->triangles);
  struct embree embree = {
      .frame = frame, .hits = hits, .exactly = exactly, .run = run, .lock = PTHREAD_MUTEX_INITIALIZER};
  const trax_status status =
      hits->triangles ? run_embree(&embree, error)
                      : trax_fail(error, "out of memory for what %u x %u pixels hit", params->width, params->height);
  if (status != TRAX_OK)
    trax_hits_release(hits);
  return status;
}

trax_status trax_hits_embree(struct trax_hits *hits, const struct trax_frame *frame, struct trax_render_run *run,
                             trax_error *error) {
  return find_hits(hits, frame, false, run, error);
}

trax_status trax_hits_exact(struct trax_hits *hits, const struct trax_frame *frame, struct trax_render_run *run,
                            trax_error *error) {
  return find_hits(hits, frame, true, run, error);
}
