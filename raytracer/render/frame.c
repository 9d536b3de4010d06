/* The device program's parameters: camera, light, palette, the order of pixels, the margin of boxes. */
#include "lighting.h"
#include "render.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

/* Coordinates within these need no scaling: products of three lengths, some 2^-24 of the scene, stay normal floats. */
#define LEAST_EXPONENT (-4)
#define GREATEST_EXPONENT 20
#define GREATEST_LIGHT_EXPONENT 40

static double greatest(double so_far, const float values[3]) {
  for (int i = 0; i < 3; i++)
    so_far = fmax(so_far, fabs((double)values[i]));
  return so_far;
}

/* Rounding to subnormals keeps the order of coordinates, so boxes stay exact. */
void trax_scale_scene(struct trax_scene *scene, int exponent) {
  if (exponent == 0)
    return;
  struct trax_scene_header *header = scene->bytes;
  trax_scale_floats(header->bounds_min, 3, exponent);
  trax_scale_floats(header->bounds_max, 3, exponent);
  trax_scale_floats(scene->grid.origin, 3, exponent);
  trax_scale_floats(scene->grid.cell, 3, exponent);
  const struct trax_node_format *format = &trax_node_formats[header->node_layout];
  unsigned char *node = (unsigned char *)scene->nodes;
  for (uint32_t i = 0; i < scene->node_count; i++, node += format->bytes)
    format->code->scale(node, format, exponent);
  struct trax_triangle *triangles = (struct trax_triangle *)scene->triangles;
  for (uint32_t i = 0; i < scene->triangle_count; i++) {
    trax_scale_floats(triangles[i].v0, 3, exponent);
    trax_scale_floats(triangles[i].v1, 3, exponent);
    trax_scale_floats(triangles[i].v2, 3, exponent);
  }
  /* The meshes of instances are scaled as the scene is, so their matrices stay. */
  for (uint32_t i = 0; i < scene->instance_count; i++)
    trax_scale_floats(((struct trax_instance *)scene->instances)[i].origin, 3, exponent);
  for (uint32_t i = 0; i < scene->mesh_count; i++)
    trax_scale_floats(((struct trax_scene_mesh *)scene->meshes)[i].bounds_min, 6, exponent);
  header->checksum = 0;
  header->checksum = (uint32_t)crc32(crc32(0, NULL, 0), scene->bytes, (uInt)scene->size);
}

static void scale_view(struct trax_view *view, int exponent) {
  trax_scale_floats(view->eye, 3, exponent);
  trax_scale_floats(view->look_at, 3, exponent);
  trax_scale_floats(view->light, 3, exponent);
  for (uint32_t i = 0; i < view->light_count; i++) {
    struct trax_light *light = &view->lights[i];
    trax_scale_floats(light->position, 3, exponent);
    trax_scale_floats(light->edges[0], 6, exponent);
    trax_scale_floats(&light->falloff, 1, exponent);
  }
}

trax_status trax_normalise(struct trax_scene *scene, struct trax_view *view, int *exponent, trax_error *error) {
  double size = greatest(greatest(greatest(0, scene->header->bounds_min), scene->header->bounds_max), view->eye);
  if (size == 0)
    size = 1;
  int magnitude = ilogb(size);
  double light = view->light_count ? 0 : greatest(0, view->light);
  for (uint32_t i = 0; i < view->light_count; i++) {
    const struct trax_light *one = &view->lights[i];
    light = greatest(greatest(greatest(light, one->position), one->edges[0]), one->edges[1]);
  }
  if (light > 0 && ilogb(light) - magnitude > GREATEST_LIGHT_EXPONENT)
    return trax_fail(error, "a light is more than 2^%d times as far away as the scene is large",
                     GREATEST_LIGHT_EXPONENT);
  *exponent = 0;
  if (magnitude >= LEAST_EXPONENT && magnitude <= GREATEST_EXPONENT)
    return TRAX_OK;
  /* No further down than necessary, because details of a large scene would lose bits. */
  *exponent = (magnitude > GREATEST_EXPONENT ? GREATEST_EXPONENT : 0) - magnitude;
  trax_scale_scene(scene, *exponent);
  scale_view(view, *exponent);
  return TRAX_OK;
}

/* The margin added to each side of a box for rays that begin at the eye or nearer to the scene, so that rounding never
   makes a ray miss the box of a triangle that it hits. In units of 2^-24 and of D, the greatest distance along an axis
   between a ray's origin and the scene:
   - a ray's triangle test sees every vertex displaced across the ray by 6 (the shear's factor, from a reciprocal of
   error 5)
     + 4 (translation and shear) + 3 (edge values): 13;
   - the distances to the planes have a relative error of 7 (reciprocal, subtraction, product), as if each plane were 7
   off;
   - a direction component that was moved away from zero turns the ray by 2^-30, less than 1.
   - of quantised planes: the factor (1), the products of plane and origin with it (2) and the origin's distance from
   the grid's (2) in place of one subtraction: 4 more;
   32 is above the sum. As the margin is added to a ray's origin, it must be no less than that coordinate's rounding:
   hence the doubling and the second term. */
static float box_margin(const struct trax_scene_header *header, const float eye[3]) {
  double distance = 0, magnitude = greatest(greatest(greatest(0, header->bounds_min), header->bounds_max), eye);
  for (int i = 0; i < 3; i++) {
    double low = header->bounds_min[i], high = header->bounds_max[i];
    distance = fmax(distance, fmax(high - low, fmax(fabs(low - eye[i]), fabs(high - eye[i]))));
  }
  return (float)(0x1p-18 * distance + 0x1p-22 * magnitude);
}

/* The parameters of quantised nodes. The traversal's arithmetic has room for cells within 2^-44 and 2^5: more than
   enough once the scene is normalised, unless the eye is very far away from a very small one. */
static trax_status set_grid(struct trax_render_params *params, const struct trax_scene *scene, trax_error *error) {
  params->node_layout = scene->header->node_layout;
  if (trax_node_formats[params->node_layout].plane_bytes == sizeof(float) || scene->triangle_count == 0)
    return TRAX_OK;
  for (int axis = 0; axis < 3; axis++) {
    if (!(scene->grid.cell[axis] >= 0x1p-44f && scene->grid.cell[axis] <= 0x1p6f))
      return trax_fail(error, "the scene is too small, as seen from the eye, for quantised nodes");
    params->grid.origin[axis] = scene->grid.origin[axis];
    params->grid.cell[axis] = scene->grid.cell[axis];
  }
  return TRAX_OK;
}

static void cross(double result[3], const double a[3], const double b[3]) {
  for (int i = 0; i < 3; i++)
    result[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

static void set_camera(struct trax_render_params *params, const struct trax_view *view) {
  const double degree = 3.14159265358979323846 / 180;
  double forward[3], up[3], right[3];
  for (int i = 0; i < 3; i++)
    forward[i] = view->direction[i], up[i] = view->up[i];
  cross(right, forward, up);
  double half_height = tan(0.5 * view->fov * degree);
  double half_width = half_height * params->width / params->height;
  for (int i = 0; i < 3; i++) {
    params->eye[i] = view->eye[i];
    params->light[i] = view->light[i];
    params->corner[i] = (float)(forward[i] - half_width * right[i] + half_height * up[i]);
    params->step_x[i] = (float)(2 * half_width / params->width * right[i]);
    params->step_y[i] = (float)(-2 * half_height / params->height * up[i]);
  }
}

/* The ambient light depends on the direction, so that shapes show in the shadow, too. It is least for surfaces that
   face away from a point up and to the right of the viewer. */
static void set_ambient(struct trax_render_params *params, const struct trax_view *view, double ambient) {
  const double evenly = 0.65, weights[3] = {-0.75, 0.55, 0.35}; /* of direction, up, right */
  double forward[3], up[3], right[3], length = 0;
  for (int i = 0; i < 3; i++) {
    forward[i] = view->direction[i], up[i] = view->up[i];
    length += weights[i] * weights[i];
  }
  cross(right, forward, up);
  for (int i = 0; i < 3; i++)
    params->fill[i] = (float)((1 - evenly) * ambient / sqrt(length) *
                              (weights[0] * forward[i] + weights[1] * up[i] + weights[2] * right[i]));
  params->ambient = (float)(evenly * ambient);
  params->light_strength = (float)(1 - ambient);
}

static uint32_t log2_ceiling(uint32_t value) {
  uint32_t result = 0;
  while (result < 31 && 1u << result < value)
    result++;
  return result;
}

/* Sets tiles of 2^log2_side x 2^log2_side pixels, or of fewer columns in a narrower picture. With s =
   ceil(log2(across)) and m = floor(2^(31+s) / across) + 1, (2 * tile * m) >> (32 + s) is exactly tile / across while 2
   * tile < 2^30: the excess of m over the quotient adds less than 1 / across. */
void trax_frame_set_tiles(struct trax_render_params *params, uint32_t log2_side) {
  uint32_t width = log2_ceiling(params->width), height = log2_ceiling(params->height);
  uint32_t shorter = width < height ? width : height;
  log2_side = shorter < log2_side ? shorter : log2_side;
  params->tile_log2_side = log2_side;
  uint32_t across = (params->width + (1u << log2_side) - 1) >> log2_side;
  uint32_t down = (params->height + (1u << log2_side) - 1) >> log2_side;
  params->tiles_across = across;
  params->slot_count = (across * down) << 2 * log2_side;
  params->row_shift = log2_ceiling(across);
  params->row_multiplier = (uint32_t)(((uint64_t)1 << (31 + params->row_shift)) / across + 1);
}

/* --- features --- */

trax_status trax_frame_init(struct trax_frame *frame, const struct trax_scene *scene, const struct trax_view *view,
                            const struct trax_frame_options *options, trax_error *error) {
  if (options->width < 1 || options->width > TRAX_RENDER_MAX_SIDE || options->height < 1 ||
      options->height > TRAX_RENDER_MAX_SIDE)
    return trax_fail(error, "a picture of %u x %u: width and height must be 1 to %u", options->width, options->height,
                     TRAX_RENDER_MAX_SIDE);
  if (!(options->ambient >= 0 && options->ambient <= 1))
    return trax_fail(error, "ambient light of %g: it must be 0 to 1", (double)options->ambient);
  if (options->samples < 1 || options->samples > TRAX_RENDER_MAX_SAMPLES)
    return trax_fail(error, "%u samples: there must be 1 to %u", options->samples, TRAX_RENDER_MAX_SAMPLES);
  if (options->paths > TRAX_RENDER_MAX_DEPTH)
    return trax_fail(error, "paths of %u surfaces: there must be %u at most", options->paths, TRAX_RENDER_MAX_DEPTH);
  const uint32_t features = trax_features_of(options, view, scene);
  if (scene->instances && features & TRAX_FEATURE_BIT(EXACT))
    return trax_fail(error,
                     "hits of instances are not exact, and a triangle is too large or too small for others, as seen "
                     "from the eye (--flatten)");
  const bool lighting = features & TRAX_PATH_FEATURES;
  size_t size =
      sizeof(struct trax_render_params) + (lighting ? trax_lighting_bytes(scene, view, options)
                                                    : scene->material_count * sizeof(struct trax_palette_entry));
  if (size > UINT32_MAX || !(frame->params = calloc(1, size)))
    return trax_fail(error, "out of memory for %u materials", scene->material_count);
  frame->params_size = (uint32_t)size;
  frame->scene = scene;
  frame->view = *view;
  frame->options = *options;

  struct trax_render_params *params = frame->params;
  params->width = options->width;
  params->height = options->height;
  params->background = options->background;
  params->samples = options->samples;
  params->sample_weight = 1 / (float)options->samples;
  const struct trax_scene_section *sections = scene->header->sections;
  if (scene->normals)
    params->normals_distance = sections[TRAX_SCENE_NORMALS].offset - sections[TRAX_SCENE_TRIANGLES].offset;
  params->features = features;
  params->box_margin = box_margin(scene->header, view->eye);
  if (set_grid(params, scene, error) != TRAX_OK) {
    trax_frame_release(frame);
    return TRAX_ERROR;
  }
  set_camera(params, view);
  set_ambient(params, view, options->paths ? 0 : options->ambient);
  trax_frame_set_tiles(params, TRAX_TILE_LOG2_SIDE);
  if (lighting) {
    trax_lighting_fill(params, scene, view, options);
    return TRAX_OK;
  }
  struct trax_palette_entry *palette = (struct trax_palette_entry *)(params + 1);
  for (uint32_t i = 0; i < scene->material_count; i++)
    for (int channel = 0; channel < 3; channel++)
      palette[i].colour[channel] = (float)(255 * sqrt(fmin(fmax(scene->materials[i].diffuse[channel], 0), 1)));
  return TRAX_OK;
}

uint32_t trax_frame_image_bytes(const struct trax_frame *frame) {
  const uint32_t a_pixel = frame->params->features & TRAX_FEATURE_BIT(FLOATS) ? 3 * sizeof(float) : sizeof(uint32_t);
  return a_pixel * frame->params->width * frame->params->height;
}

void trax_frame_release(struct trax_frame *frame) {
  free(frame->params);
  memset(frame, 0, sizeof *frame);
}
