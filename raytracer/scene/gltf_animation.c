/* glTF's animations: the transforms of nodes and the weights of morph targets at one time, and skins. Only additions,
   multiplications, divisions and square roots are used, so that every host gives the same bytes. */
#include "gltf.h"
#include "placing.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum interpolation { STEP, LINEAR, CUBIC };

/* A channel's sampler at the wanted time. */
struct sample {
  struct gltf_accessor values;
  enum interpolation how;
  uint32_t key;             /* of the two around the time the earlier one; the last one alone */
  bool alone;               /* the time is not between two keys */
  double fraction, seconds; /* of the way to the next key, and between both */
};

static trax_status wrong(const struct gltf *gltf, size_t channel, const char *what) {
  return trax_fail(gltf->error, "%s: channel %zu of its animation: %s", gltf->path, channel, what);
}

/* --- samplers --- */

static trax_status find_key(struct sample *sample, const struct gltf_accessor *times, const struct gltf *gltf,
                            size_t channel) {
  const double at = gltf->options->at;
  float before = -INFINITY;
  sample->key = 0, sample->alone = true;
  for (uint32_t i = 0; i < times->count; i++) {
    float time;
    gltf_read(&time, 1, times, i);
    if (!(time > before) || !isfinite(time))
      return wrong(gltf, channel, "its times do not rise, or are not finite");
    if ((double)time <= at)
      sample->key = i, sample->alone = true;
    else if (i > 0 && i == sample->key + 1 && (double)before <= at) {
      sample->alone = false;
      sample->seconds = (double)time - (double)before;
      sample->fraction = (at - (double)before) / sample->seconds;
    }
    before = time;
  }
  return TRAX_OK;
}

/* per_key: values of a key; 0: as many as there are targets, at least 1. */
static trax_status find_sample(struct sample *sample, struct gltf *gltf, const json_t *animation, size_t channel,
                               const json_t *number, unsigned components, uint32_t *per_key) {
  const json_t *samplers = json_object_get(animation, "samplers");
  const double index = json_is_number(number) ? json_number_value(number) : -1;
  const json_t *sampler = index >= 0 && index < (double)json_array_size(samplers) && index == floor(index)
                              ? json_array_get(samplers, (size_t)index)
                              : NULL;
  struct gltf_accessor times;
  if (!sampler)
    return wrong(gltf, channel, "its sampler is not there");
  const char *how = gltf_text(sampler, "interpolation");
  sample->how = !strcmp(how, "STEP") ? STEP : !strcmp(how, "CUBICSPLINE") ? CUBIC : LINEAR;
  if (gltf_find_accessor(&times, gltf, json_object_get(sampler, "input")) != TRAX_OK ||
      gltf_find_accessor(&sample->values, gltf, json_object_get(sampler, "output")) != TRAX_OK)
    return TRAX_ERROR;
  if (times.components != 1 || sample->values.components != components || times.count == 0)
    return wrong(gltf, channel, "its keys are not of the kind that it sets");
  const uint64_t groups = (uint64_t)times.count * (sample->how == CUBIC ? 3 : 1);
  if (*per_key == 0)
    *per_key = (uint32_t)(sample->values.count / groups);
  if (*per_key == 0 || sample->values.count != groups * *per_key)
    return wrong(gltf, channel, "it has not as many values as times");
  return find_key(sample, &times, gltf, channel);
}

static void read_value(double *out, const struct sample *sample, uint64_t element) {
  float values[4];
  gltf_read(values, sample->values.components, &sample->values, (uint32_t)element);
  for (unsigned i = 0; i < sample->values.components; i++)
    out[i] = (double)values[i];
}

static double normalise(double *q) {
  const double length = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  for (int i = 0; i < 4 && length > 0; i++)
    q[i] /= length;
  return length;
}

/* Along the great circle (slerp), by halving the arc: 2^-40 of it are left. */
static void turn(double out[4], const double from[4], const double to[4], double fraction) {
  double a[4], b[4], dot = 0;
  for (int i = 0; i < 4; i++)
    dot += from[i] * to[i];
  for (int i = 0; i < 4; i++)
    a[i] = from[i], b[i] = dot < 0 ? -to[i] : to[i];
  for (int step = 0; step < 40; step++) {
    double middle[4];
    for (int i = 0; i < 4; i++)
      middle[i] = a[i] + b[i];
    normalise(middle);
    fraction *= 2;
    memcpy(fraction >= 1 ? a : b, middle, sizeof middle);
    fraction -= fraction >= 1;
  }
  memcpy(out, a, sizeof a);
}

/* The value number `index` of a key's `per_key`. */
static void evaluate(double *out, const struct sample *sample, uint32_t per_key, uint32_t index, bool is_rotation) {
  const unsigned count = sample->values.components, triple = sample->how == CUBIC ? 3 : 1;
  const uint64_t group = (uint64_t)sample->key * triple * per_key;
  double from[4], to[4], leave[4], arrive[4];
  read_value(from, sample, group + (uint64_t)(sample->how == CUBIC) * per_key + index);
  memcpy(out, from, count * sizeof *out);
  if (sample->alone || sample->how == STEP)
    return;
  const uint64_t next = group + (uint64_t)triple * per_key;
  const double t = sample->fraction;
  read_value(to, sample, next + (uint64_t)(sample->how == CUBIC) * per_key + index);
  if (sample->how == LINEAR && is_rotation) {
    turn(out, from, to, t);
    return;
  }
  if (sample->how == LINEAR) {
    for (unsigned i = 0; i < count; i++)
      out[i] = from[i] + t * (to[i] - from[i]);
    return;
  }
  read_value(leave, sample, group + (uint64_t)2 * per_key + index);
  read_value(arrive, sample, next + index);
  for (unsigned i = 0; i < count; i++) /* Hermite's basis */
    out[i] = (2 * t * t * t - 3 * t * t + 1) * from[i] + sample->seconds * (t * t * t - 2 * t * t + t) * leave[i] +
             (3 * t * t - 2 * t * t * t) * to[i] + sample->seconds * (t * t * t - t * t) * arrive[i];
}

/* --- the animation --- */

static trax_status apply_weights(struct gltf *gltf, struct gltf_pose *pose, const json_t *animation, size_t channel,
                                 const json_t *number) {
  struct sample sample;
  uint32_t count = 0;
  if (find_sample(&sample, gltf, animation, channel, number, 1, &count) != TRAX_OK)
    return TRAX_ERROR;
  free(pose->weights);
  pose->weights = malloc(count * sizeof *pose->weights);
  pose->weight_count = count;
  for (uint32_t i = 0; pose->weights && i < count; i++)
    evaluate(&pose->weights[i], &sample, count, i, false);
  return pose->weights ? TRAX_OK : scene_out_of_memory(gltf->error, gltf->path);
}

static trax_status apply_channel(struct gltf *gltf, const json_t *animation, size_t number) {
  const json_t *channel = json_array_get(json_object_get(animation, "channels"), number);
  const json_t *target = json_object_get(channel, "target"), *sampler = json_object_get(channel, "sampler");
  const size_t node = gltf_index(gltf, "nodes", json_object_get(target, "node"));
  const char *path = gltf_text(target, "path");
  struct sample sample;
  uint32_t one = 1;
  if (!json_object_get(target, "node"))
    return TRAX_OK; /* of an extension */
  if (node == SIZE_MAX)
    return wrong(gltf, number, "its node is not there");
  struct gltf_pose *pose = &gltf->poses[node];
  if (!strcmp(path, "weights"))
    return apply_weights(gltf, pose, animation, number, sampler);
  const bool turns = !strcmp(path, "rotation");
  double *value = turns                          ? pose->turn
                  : !strcmp(path, "translation") ? pose->move
                  : !strcmp(path, "scale")       ? pose->scale
                                                 : NULL;
  if (!value)
    return wrong(gltf, number, "it sets none of translation, rotation, scale and weights");
  if (find_sample(&sample, gltf, animation, number, sampler, turns ? 4 : 3, &one) != TRAX_OK)
    return TRAX_ERROR;
  evaluate(value, &sample, 1, 0, turns);
  pose->is_matrix = false;
  return TRAX_OK;
}

/* The animation of that name, or the first. */
static trax_status find_animation(const json_t **animation, const struct gltf *gltf) {
  const char *name = gltf->options->animation;
  const json_t *all = json_object_get(gltf->root, "animations");
  *animation = json_array_get(all, 0);
  for (size_t i = 0; name && i < json_array_size(all); i++)
    if (!strcmp(gltf_text(json_array_get(all, i), "name"), name)) {
      *animation = json_array_get(all, i);
      return TRAX_OK;
    }
  return name && *animation ? trax_fail(gltf->error, "%s: it has no animation \"%s\"", gltf->path, name) : TRAX_OK;
}

trax_status gltf_find_poses(struct gltf *gltf, const uint32_t *parents) {
  const json_t *animation, *nodes = json_object_get(gltf->root, "nodes");
  const size_t count = gltf_count(gltf, "nodes");
  if (!gltf->options->moves || find_animation(&animation, gltf) != TRAX_OK)
    return gltf->options->moves ? TRAX_ERROR : TRAX_OK;
  if (!animation)
    return TRAX_OK;
  gltf->report->moved = true;
  gltf->poses = calloc(count + 1, sizeof *gltf->poses);
  if (!gltf->poses)
    return scene_out_of_memory(gltf->error, gltf->path);
  for (size_t i = 0; i < count; i++)
    gltf_rest(&gltf->poses[i], json_array_get(nodes, i));
  for (size_t i = 0; i < json_array_size(json_object_get(animation, "channels")); i++)
    if (apply_channel(gltf, animation, i) != TRAX_OK)
      return TRAX_ERROR;
  for (size_t i = 0; i < count; i++) {
    struct gltf_pose *pose = &gltf->poses[i];
    gltf_transform(pose->global, pose);
    for (uint32_t above = parents[i]; above; above = parents[above - 1]) {
      double own[3][4], product[3][4];
      gltf_transform(own, &gltf->poses[above - 1]);
      scene_multiply(product, own, pose->global);
      memcpy(pose->global, product, sizeof product);
    }
  }
  return TRAX_OK;
}

/* --- skins --- */

static trax_status find_joints(struct gltf_deform *deform, struct gltf *gltf, const json_t *node) {
  const json_t *skin = gltf_item(gltf, "skins", json_object_get(node, "skin")),
               *joints = json_object_get(skin, "joints");
  const json_t *inverse = json_object_get(skin, "inverseBindMatrices");
  struct gltf_accessor matrices;
  if (!json_object_get(node, "skin"))
    return TRAX_OK;
  if (!skin || json_array_size(joints) == 0 || json_array_size(joints) > UINT16_MAX + 1)
    return trax_fail(gltf->error, "%s: a node has a skin that is not there, or that has no joints", gltf->path);
  if (inverse && gltf_find_accessor(&matrices, gltf, inverse) != TRAX_OK)
    return TRAX_ERROR;
  if (inverse && (matrices.components != 16 || matrices.count < json_array_size(joints)))
    return trax_fail(gltf->error, "%s: a skin has not a matrix for each joint", gltf->path);
  deform->joint_count = (uint32_t)json_array_size(joints);
  deform->joints = malloc(deform->joint_count * sizeof *deform->joints);
  if (!deform->joints)
    return scene_out_of_memory(gltf->error, gltf->path);
  for (uint32_t i = 0; i < deform->joint_count; i++) {
    const size_t joint = gltf_index(gltf, "nodes", json_array_get(joints, i));
    float columns[16] = {[0] = 1, [5] = 1, [10] = 1, [15] = 1};
    double bind[3][4];
    if (joint == SIZE_MAX)
      return trax_fail(gltf->error, "%s: a skin has a joint that is not there", gltf->path);
    if (inverse)
      gltf_read(columns, 16, &matrices, i);
    for (int k = 0; k < 12; k++)
      bind[k / 4][k % 4] = (double)columns[4 * (k % 4) + k / 4];
    scene_multiply(deform->joints[i], gltf->poses[joint].global, bind);
  }
  return TRAX_OK;
}

trax_status gltf_find_deform(struct gltf_deform *deform, struct gltf *gltf, size_t node_number) {
  const json_t *node = json_array_get(json_object_get(gltf->root, "nodes"), node_number);
  const json_t *rest = json_object_get(node, "weights");
  *deform = (struct gltf_deform){0};
  if (!gltf->poses)
    return TRAX_OK;
  const struct gltf_pose *pose = &gltf->poses[node_number];
  if (!rest)
    rest = json_object_get(gltf_item(gltf, "meshes", json_object_get(node, "mesh")), "weights");
  deform->weight_count = pose->weights ? pose->weight_count : (uint32_t)json_array_size(rest);
  deform->weights = calloc(deform->weight_count + (size_t)1, sizeof *deform->weights);
  if (!deform->weights)
    return scene_out_of_memory(gltf->error, gltf->path);
  for (uint32_t i = 0; i < deform->weight_count; i++)
    deform->weights[i] = pose->weights ? pose->weights[i] : json_number_value(json_array_get(rest, i));
  return find_joints(deform, gltf, node);
}

void gltf_release_deform(struct gltf_deform *deform) {
  free(deform->weights);
  free(deform->joints);
  *deform = (struct gltf_deform){0};
}

void gltf_release_poses(struct gltf *gltf) {
  for (size_t i = 0; gltf->poses && i < gltf_count(gltf, "nodes"); i++)
    free(gltf->poses[i].weights);
  free(gltf->poses);
  gltf->poses = NULL;
}
