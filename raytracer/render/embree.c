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
  if (ray.hit.geomID != RTC_INVALID_GEOMETRY_ID && embree->frame->scene->instances)
    hit->triangle += embree->frame->scene->instances[ray.hit.instID[0]].first_number;
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

double embree_start_bound(const struct embree *embree, const struct placed_triangle *placed, struct double3 origin,
                          struct double3 sight) {
  const struct trax_triangle *triangle = &placed->triangle;
  const struct trax_instance *instance = placed->instance;
  const struct double3 v0 = from(triangle->v0);
  const double edges = fmax(greatest(minus(from(triangle->v1), v0)), greatest(minus(from(triangle->v2), v0)));
  if (instance)
    return trax_start_bound(greatest(v0), edges) +
           (double)instance->spread * (greatest(minus(v0, from(instance->origin))) + edges);
  return embree_needs(embree, TRAX_FEATURE_EXACT)
             ? trax_exact_start_bound(greatest(v0), edges, greatest(origin), greatest(sight))
             : trax_start_bound(greatest(v0), edges);
}

/* The start is moved along the normal and back along the sight. */
struct double3 embree_start(const struct embree *embree, const struct placed_triangle *triangle, struct double3 point,
                            struct double3 normal, struct double3 origin) {
  const struct double3 sight = minus(point, origin);
  const double bound = embree_start_bound(embree, triangle, origin, sight);
  const double back = fmin(0.5 * bound / exp2(floor(log2(greatest(sight)))), 1);
  return plus_scaled(plus_scaled(point, bound, normal), -back, sight);
}

/* The light through a place of a pixel. *seen receives the hits of its rays. */
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

  struct placed_triangle placed;
  trax_place(&placed, embree->frame->scene, hit.triangle);
  const struct trax_triangle *triangle = &placed.triangle;
  struct double3 v0 = from(triangle->v0), e = minus(from(triangle->v1), v0), f = minus(from(triangle->v2), v0);
  struct double3 normal = cross(e, f);
  double length = sqrt(dot(normal, normal));
  double facing = dot(normal, direction) < 0 ? 1 / length : -1 / length;
  normal = (struct double3){facing * normal.x, facing * normal.y, facing * normal.z};
  const struct double3 point = plus_scaled(plus_scaled(v0, hit.u, e), hit.v, f);
  const struct double3 start = embree_start(embree, &placed, point, normal, from(params->eye));
  struct double3 flat = normal;
  if (embree_needs(embree, TRAX_FEATURE_SMOOTH)) {
    double n[3][3];
    trax_place_normals(n, embree->frame->scene, &placed);
    const struct double3 n0 = {n[0][0], n[0][1], n[0][2]}, n1 = {n[1][0], n[1][1], n[1][2]},
                         n2 = {n[2][0], n[2][1], n[2][2]};
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
    const struct double3 direction = {camera.x, camera.y, camera.z};
    const bool found = embree_hit(embree, from(params->eye), direction, &hit);
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

static trax_status committed(RTCDevice device, RTCScene scene, trax_error *error) {
  rtcCommitScene(scene);
  const enum RTCError failure = rtcGetDeviceError(device);
  return failure ? trax_fail(error, "Embree could not build the scene (error %d)", (int)failure) : TRAX_OK;
}

static trax_status no_memory(const struct trax_scene *source, trax_error *error) {
  return trax_fail(error, "out of memory for Embree's scene of %u triangles", source->triangle_count);
}

static trax_status add_triangles(RTCDevice device, RTCScene scene, const struct trax_scene *source, uint32_t first,
                                 uint32_t count, trax_error *error) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  float *vertices =
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, 3 * (size_t)count);
  uint32_t *indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, count);
  if (!vertices || !indices) {
    rtcReleaseGeometry(geometry);
    return no_memory(source, error);
  }
  for (uint32_t i = 0; i < count; i++) {
    memcpy(vertices + 9 * (size_t)i, source->triangles[first + i].v0, 9 * sizeof(float));
    for (uint32_t corner = 0; corner < 3; corner++)
      indices[3 * (size_t)i + corner] = 3 * i + corner;
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
  return TRAX_OK;
}

/* Places a scene for each mesh. They live as long as the instances. */
static void add_instances(RTCDevice device, RTCScene scene, RTCScene *meshes, const struct trax_scene *source) {
  for (uint32_t i = 0; i < source->instance_count; i++) {
    const struct trax_instance *instance = &source->instances[i];
    float rows[3][4];
    for (int row = 0; row < 3; row++) {
      memcpy(rows[row], instance->to_world[row], sizeof instance->to_world[row]);
      rows[row][3] = instance->origin[row];
    }
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(geometry, meshes[instance->mesh]);
    rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, rows);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, i);
    rtcReleaseGeometry(geometry);
  }
}

/* Embree transforms rays in binary32, by an inverse of its own. Boxes must be wide enough for those errors. */
static void set_rooms(struct exact_part *parts, const struct trax_scene *source, const float eye[3]) {
  const double reach =
      fmax(fmax(greatest(from(source->header->bounds_min)), greatest(from(source->header->bounds_max))),
           greatest(from(eye)));
  for (uint32_t i = 0; i < source->instance_count; i++) {
    const struct trax_instance *instance = &source->instances[i];
    struct exact_part *part = &parts[instance->mesh];
    const double room = 4 * fmax((double)instance->spread, 0x1p-19) * (double)instance->stretch *
                        (2 * reach + greatest(from(instance->origin)));
    part->room = fmaxf(part->room, (float)room);
  }
}

/* parts: for hits without error; NULL: Embree's own. */
static trax_status build_scene(RTCDevice device, RTCScene scene, const struct trax_scene *source,
                               struct exact_part *parts, trax_error *error) {
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  const uint32_t count = source->instances ? source->mesh_count : source->triangle_count > 0;
  RTCScene *meshes = calloc(count + (size_t)1, sizeof(RTCScene));
  trax_status status = meshes ? TRAX_OK : no_memory(source, error);
  for (uint32_t i = 0; i < count && status == TRAX_OK; i++) {
    const uint32_t first = source->instances ? source->meshes[i].first_triangle : 0;
    const uint32_t triangles = source->instances ? source->meshes[i].triangle_count : source->triangle_count;
    RTCScene to = scene;
    if (source->instances) {
      to = meshes[i] = rtcNewScene(device);
      rtcSetSceneFlags(to, RTC_SCENE_FLAG_ROBUST);
    }
    if (parts) {
      parts[i].source = source, parts[i].first = first, parts[i].count = triangles;
      status = exact_attach(device, to, &parts[i]) ? TRAX_OK : no_memory(source, error);
    } else {
      status = add_triangles(device, to, source, first, triangles, error);
    }
    if (status == TRAX_OK && source->instances)
      status = committed(device, to, error);
  }
  if (status == TRAX_OK && source->instances)
    add_instances(device, scene, meshes, source);
  for (uint32_t i = 0; i < count && meshes; i++)
    if (meshes[i])
      rtcReleaseScene(meshes[i]);
  free(meshes);
  return status == TRAX_OK ? committed(device, scene, error) : status;
}

trax_status embree_commit(RTCDevice device, RTCScene scene, const struct trax_scene *source, trax_error *error) {
  return build_scene(device, scene, source, NULL, error);
}

static trax_status build(RTCDevice device, struct embree *embree, trax_error *error) {
  const struct trax_scene *source = embree->frame->scene;
  if (!embree->exactly)
    return embree_commit(device, embree->scene, source, error);
  embree->parts = calloc(source->mesh_count + (size_t)1, sizeof *embree->parts);
  if (!embree->parts)
    return no_memory(source, error);
  set_rooms(embree->parts, source, embree->frame->params->eye);
  return build_scene(device, embree->scene, source, embree->parts, error);
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
  trax_status status = build(device, embree, error);
  if (status == TRAX_OK && !embree_prepare_lights(embree))
    status = trax_fail(error, "out of memory for the lights of Embree's picture");
  if (status == TRAX_OK)
    status = render(embree, error);
  free(embree->emitters);
  embree->run->rays = embree->rays;
  rtcReleaseScene(embree->scene);
  free(embree->parts);
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
                      : trax_fail(error, "out of memory for the hits of %u x %u pixels", params->width, params->height);
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
