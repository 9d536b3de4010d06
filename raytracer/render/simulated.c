/* The picture as the emulated machine renders it. */
#include "layers.h"
#include "plain_scene.h"
#include "rays.h"
#include "trax/explain.h"

#include <stdlib.h>
#include <string.h>

static trax_status take_picture(struct trax_picture *picture, const struct trax_frame *frame, trax_machine *machine,
                                const struct trax_simulated_options *options, trax_error *error) {
  const int exit_status = trax_machine_exit_status(machine);
  if (exit_status != 0)
    return trax_fail(error, "the program ended with status %d", exit_status);
  if (options->run.slots || frame->rays) /* whose hits are taken by trax_rays_take */
    return TRAX_OK;
  const uint8_t *bytes;
  uint32_t size;
  if (trax_machine_read_buffer(machine, "image", &bytes, &size, error) != TRAX_OK)
    return TRAX_ERROR;
  trax_status status = trax_picture_take(picture, frame, bytes, error);
  if (status == TRAX_OK && options->layers)
    status = trax_machine_read_buffer(machine, "record", &bytes, &size, error);
  return status == TRAX_OK && options->layers ? trax_layers_take(picture, frame, bytes, error) : status;
}

static bool has_rays(const void *explain, uint32_t pixel) {
  return trax_explain_has_rays(explain, pixel);
}

/* Names the materials by number and kind: the scene has no other names. The names must be freed. */
static char **name_materials(const struct trax_scene *scene) {
  static const char *const kinds[TRAX_MATERIAL_KINDS] = {"Lambert", "mirror", "glass", "GGX"};
  enum { LENGTH = 32 };
  char **names = calloc(scene->material_count + 1, sizeof *names + LENGTH);
  for (uint32_t i = 0; names && i < scene->material_count; i++) {
    names[i] = (char *)(names + scene->material_count + 1) + (size_t)i * LENGTH;
    snprintf(names[i], LENGTH, "material %u, %s", i, kinds[scene->materials[i].kind % TRAX_MATERIAL_KINDS]);
  }
  return names;
}

/* Writes the outputs that explain the run. The page has the picture, and the visits of its rays. */
static trax_status end_explanation(struct trax_explain *explain, const struct trax_picture *picture,
                                   const struct trax_frame *frame, const struct trax_simulated_options *options,
                                   trax_error *error) {
  struct trax_visits visits = {.wants_rays = has_rays, .context = explain};
  char **materials = NULL;
  struct trax_explore_picture shown = {.width = picture->width, .height = picture->height, .pixels = picture->pixels};
  trax_status status = TRAX_OK;
  if (options->explain && (options->explain->explore || options->explain->story) && options->is_twin) {
    struct trax_render_run twin = {.interrupt = options->run.interrupt};
    status = trax_visits_count(&visits, picture, frame, &twin, error);
  }
  if (visits.nodes) {
    shown.counts[0] =
        (struct trax_explore_counts){"nodes", "nodes", "nodes of the tree that its rays visited", visits.nodes};
    shown.counts[1] = (struct trax_explore_counts){"triangles", "triangles", "triangles that its rays were tested with",
                                                   visits.triangles};
    materials = name_materials(frame->scene);
    shown.rays = materials ? visits.rays : NULL;
    shown.has_instances = frame->scene->instances != NULL;
    shown.ray_count = materials ? visits.ray_count : 0;
    shown.counted_apart = frame->params->features & (TRAX_PATH_FEATURES | TRAX_FEATURE_BIT(RAY_KINDS));
    shown.materials = (const char *const *)materials;
    shown.material_count = frame->scene->material_count;
  }
  trax_explain_picture(explain, &shown);
  if (status == TRAX_OK)
    status = trax_explain_end(explain, error);
  else
    trax_explain_discard(explain);
  trax_visits_release(&visits);
  free(materials);
  return status;
}

/* Replaces the references of the scene in the machine's memory by addresses. */
static trax_status relocate(trax_machine *machine, trax_error *error) {
  uint8_t *bytes;
  uint32_t address, size;
  if (trax_machine_buffer(machine, "scene", &address, &bytes, &size, error) != TRAX_OK)
    return TRAX_ERROR;
  if ((uint64_t)address + size > INT32_MAX)
    return trax_fail(error, "the scene ends above 2 GiB, where a specialised program finds no leaves; "
                            "--no-specialise renders it");
  trax_scene_relocate(bytes, address);
  return TRAX_OK;
}

/* Binds the buffer of a recording program (trax/record.h). */
static trax_status bind_record(trax_machine *machine, const struct trax_render_params *params, trax_error *error) {
  const uint64_t size = trax_record_bytes(params);
  if (size > UINT32_MAX)
    return trax_fail(error, "the record of %u x %u pixels and %u samples exceeds the machine's address space",
                     params->width, params->height, params->samples);
  return trax_machine_bind(machine, "record", NULL, (uint32_t)size, error);
}

/* The size of the program's buffer `paths` on this machine; 0: nothing uses it. */
static uint32_t path_bytes(const trax_machine *machine, const struct trax_frame *frame) {
  double threads = 0;
  trax_stats_get(machine, "threads", &threads);
  return frame->params->features & TRAX_PATH_FEATURES ? TRAX_PATH_BYTES * (uint32_t)threads : 0;
}

bool trax_program_has(const trax_machine *machine, const char *symbol) {
  uint32_t address, size;
  return trax_machine_find_symbol(machine, symbol, &address, &size);
}

trax_status trax_simulated_load(trax_machine *machine, const struct trax_frame *frame,
                                const struct trax_program *program, trax_error *error) {
  struct trax_device_scene scene = {0};
  if (frame->scene->size > UINT32_MAX)
    return trax_fail(error, "the scene of %zu bytes exceeds the machine's address space", frame->scene->size);
  trax_status status = trax_machine_load_elf(machine, program->path, error);
  if (status == TRAX_OK && program->specialised) {
    status = trax_device_scene_init(&scene, frame, error);
    if (status == TRAX_OK)
      status = trax_machine_bind(machine, "scene", scene.bytes, scene.size, error);
    if (status == TRAX_OK)
      status = relocate(machine, error);
    trax_device_scene_release(&scene);
  } else if (status == TRAX_OK) {
    /* Only programs of users read the scene as plain arrays. Some of them do not read the scene file. */
    if (frame->scene->instances)
      status = trax_fail(error, "%s: this program knows no instances (trax-scene --flatten)", program->path);
    else if (!trax_program_has(machine, "plain_nodes") || trax_program_has(machine, "scene"))
      status = trax_machine_bind(machine, "scene", frame->scene->bytes, (uint32_t)frame->scene->size, error);
    if (status == TRAX_OK)
      status = trax_plain_scene_bind(machine, frame->scene, error);
  }
  /* A program whose constants are all folded has no params. */
  if (status == TRAX_OK && trax_program_has(machine, "params"))
    status = trax_machine_bind(machine, "params", frame->params, frame->params_size, error);
  if (status == TRAX_OK && frame->rays)
    return trax_rays_bind(machine, frame->rays, error);
  if (status == TRAX_OK)
    status = trax_machine_bind(machine, "image", NULL, trax_frame_image_bytes(frame), error);
  if (status == TRAX_OK && trax_program_has(machine, "paths"))
    status = trax_machine_bind(machine, "paths", NULL, path_bytes(machine, frame), error);
  if (status == TRAX_OK && trax_program_has(machine, "record"))
    status = bind_record(machine, frame->params, error);
  return status;
}

/* The sections of the scene in the machine's memory, if it has them. */
static size_t list_parts(struct trax_explore_part parts[TRAX_SCENE_SECTIONS + 1], trax_machine *machine) {
  static const char *const names[TRAX_SCENE_SECTIONS] = {
      [TRAX_SCENE_NODES] = "scene: nodes",         [TRAX_SCENE_TRIANGLES] = "scene: triangles",
      [TRAX_SCENE_MATERIALS] = "scene: materials", [TRAX_SCENE_SOURCE_IDS] = "scene: source numbers",
      [TRAX_SCENE_NORMALS] = "scene: normals",     [TRAX_SCENE_UVS] = "scene: texture coordinates",
      [TRAX_SCENE_TEXTURES] = "scene: textures",   [TRAX_SCENE_TEXELS] = "scene: texels"};
  uint32_t address, size;
  uint8_t *bytes;
  trax_error none;
  size_t count = 0;
  if (trax_machine_buffer(machine, "scene", &address, &bytes, &size, &none) != TRAX_OK)
    return 0;
  const struct trax_scene_header *header = (const struct trax_scene_header *)bytes;
  for (unsigned kind = 0; kind < TRAX_SCENE_SECTIONS; kind++)
    if (header->sections[kind].size)
      parts[count++] =
          (struct trax_explore_part){names[kind], address + header->sections[kind].offset, header->sections[kind].size};
  if (header->version == TRAX_SCENE_VERSION_INSTANCES) {
    const struct trax_scene_section *instances =
        &((const struct trax_scene_more *)(header + 1))->sections[TRAX_SCENE_INSTANCES];
    parts[count++] = (struct trax_explore_part){"scene: instances", address + instances->offset, instances->size};
  }
  return count;
}

trax_status trax_simulated_run(struct trax_picture *picture, const struct trax_frame *frame, trax_machine *machine,
                               const struct trax_simulated_options *options, trax_error *error) {
  struct trax_explain_options wanted = options->explain ? *options->explain : (struct trax_explain_options){0};
  struct trax_explain *explain;
  if (options->costs || wanted.explore || wanted.story) {
    wanted.item_buffer = "image";
    wanted.item_bytes = trax_frame_image_bytes(frame) / (frame->params->width * frame->params->height);
  }
  struct trax_explore_part parts[TRAX_SCENE_SECTIONS + 1];
  if (wanted.explore) {
    wanted.title = options->title;
    wanted.parts = parts;
    wanted.part_count = list_parts(parts, machine);
  }
  if (trax_explain_begin(&explain, machine, &wanted, error) != TRAX_OK)
    return TRAX_ERROR;
  if (options->costs)
    trax_explain_items(explain, trax_costs_add, options->costs);
  trax_status status = trax_machine_run(machine, &options->run, error);
  if (status == TRAX_OK)
    status = take_picture(picture, frame, machine, options, error);
  if (status == TRAX_OK)
    return end_explanation(explain, picture, frame, options, error);
  trax_explain_discard(explain);
  return status;
}
