#include "prepare.h"

#include "trax/manifest.h"

#include <jansson.h>
#include <stdlib.h>

static const struct trax_manifest_buffer buffers[] = {{"scene", .file = "scene.trax"},
                                                      {"plain_nodes", .file = "nodes.bin"},
                                                      {"plain_triangles", .file = "triangles.bin"},
                                                      {"params", .file = "params.bin"},
                                                      {"image", .output = "image.raw"},
                                                      {"rays", .file = "rays.bin"},
                                                      {"hits", .output = "hits.bin"},
                                                      {"paths", .bytes_per_thread = TRAX_PATH_BYTES}};
enum { BUFFERS = sizeof buffers / sizeof *buffers };

const char *prepared_file(size_t number) {
  size_t i = 0;
  for (; i < BUFFERS; i++)
    if ((buffers[i].file || buffers[i].output) && number-- == 0)
      return buffers[i].file ? buffers[i].file : buffers[i].output;
  return number == 0 ? TRAX_MANIFEST_PROGRAM : number == 1 ? TRAX_MANIFEST_NAME : NULL;
}

/* --- members that trax-sim ignores --- */

static json_t *vector(const float value[3]) {
  return json_pack("[fff]", (double)value[0], (double)value[1], (double)value[2]);
}

static json_t *light_of(const struct trax_light *light) {
  static const char *const names[] = {"point", "directional", "rectangle"};
  json_t *object = json_pack("{ss so sf}", "type", names[light->kind], "colour", vector(light->colour), "strength",
                             (double)light->strength);
  if (light->kind == TRAX_LIGHT_POINT) {
    json_object_set_new(object, "position", vector(light->position));
    json_object_set_new(object, "falloff", json_real((double)light->falloff));
  } else if (light->kind == TRAX_LIGHT_DIRECTIONAL) {
    json_object_set_new(object, "direction", vector(light->direction));
  } else {
    json_object_set_new(object, "corner", vector(light->position));
    json_object_set_new(object, "edges", json_pack("[oo]", vector(light->edges[0]), vector(light->edges[1])));
  }
  return object;
}

/* The keys are those of a view's file (trax/view.h). */
static json_t *view_of(const struct trax_view *view) {
  json_t *object = json_pack("{so so so sf}", "eye", vector(view->eye), "direction", vector(view->direction), "up",
                             vector(view->up), "fov", (double)view->fov);
  if (view->light_count == 0)
    json_object_set_new(object, "light", vector(view->light));
  else
    json_object_set_new(object, "lights", json_array());
  for (uint32_t i = 0; i < view->light_count; i++)
    json_array_append_new(json_object_get(object, "lights"), light_of(&view->lights[i]));
  return object;
}

static json_t *features_of(const struct trax_frame *frame) {
  json_t *names = json_array();
  for (unsigned feature = 0; feature < TRAX_FEATURE_COUNT; feature++)
    if (frame->params->features >> feature & 1)
      json_array_append_new(names, json_string(trax_feature_name(feature)));
  return names;
}

/* NULL of a program that cannot be measured. */
static json_t *code_of(const struct trax_program *program) {
  struct trax_program_size size;
  trax_error unmeasured;
  return trax_program_measure(&size, program->path, &unmeasured) == TRAX_OK
             ? json_pack("{si si}", "bytes", (int)size.code_bytes, "stack_bytes", (int)size.stack_bytes)
             : NULL;
}

trax_status prepare_write(const char *folder, const struct trax_frame *frame, const struct trax_program *program,
                          trax_machine *machine, trax_error *error) {
  const bool floats = frame->params->features & TRAX_FEATURE_BIT(FLOATS);
  json_t *root = json_pack("{so* so}", "code", code_of(program), "features", features_of(frame));
  if (root && !frame->rays)
    json_object_update_new(root,
                           json_pack("{so s{ss si si ss}}", "view", view_of(&frame->view), "picture", "buffer", "image",
                                     "width", (int)frame->params->width, "height", (int)frame->params->height, "layout",
                                     floats ? "rgb float32" : "rgba uint8"));
  char *more = root ? json_dumps(root, 0) : NULL;
  json_decref(root);
  if (!more)
    return trax_fail(error, "%s: out of memory for the manifest", folder);
  const struct trax_manifest_contents contents = {
      buffers, BUFFERS, .items = (uint64_t)frame->params->width * frame->params->height, .more = more};
  const trax_status status = trax_manifest_write(machine, folder, &contents, error);
  free(more);
  return status;
}
