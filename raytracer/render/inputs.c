/* Scene and views from the command line. */
#include "inputs.h"

#include "emulated.h"
#include "trax/signals.h"
#include "views.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static bool has_suffix(const char *text, const char *suffix) {
  size_t length = strlen(text), suffix_length = strlen(suffix);
  return length > suffix_length && strcmp(text + length - suffix_length, suffix) == 0;
}

/* --- the scene --- */

static void show_scene_step(void *context, const char *step, double fraction) {
  trax_progress_line_show(context, step, fraction, NULL);
}

static trax_status import_scene(struct inputs *inputs, const struct options *options, trax_progress_line *progress,
                                trax_error *error) {
  struct trax_import_options import = options->import;
  import.progress = show_scene_step;
  import.progress_context = progress;
  import.interrupt = &trax_signal;
  struct trax_build_options build = options->build;
  build.progress = show_scene_step;
  build.progress_context = progress;
  build.interrupt = &trax_signal;
  build.passes = options->program ? 0 : TRAX_DEFAULT_PASSES;
  trax_splits_choose(options->splits ? options->splits : options->program ? "1" : "auto", &build);
  trax_node_layout_choose(options->nodes ? options->nodes : options->program ? "binary" : "auto", &build);
  struct trax_mesh mesh = {0};
  struct trax_import_report report;
  trax_status status =
      options->engine <= ENGINE_REFERENCE ? emulated_cache_lines(&build.cache_lines, options, error) : TRAX_OK;
  if (status == TRAX_OK)
    status = trax_mesh_import(&mesh, options->meshes, options->mesh_count, &import, &report, error);
  if (status == TRAX_OK && !options->quiet)
    trax_import_print_notes(&report, "trax-render");
  if (status == TRAX_OK)
    status = trax_scene_build(&inputs->scene, &mesh, &build, error);
  inputs->cameras = mesh.cameras;
  inputs->camera_count = mesh.camera_count;
  mesh.cameras = NULL;
  trax_mesh_release(&mesh);
  return status;
}

static trax_status load_scene(struct inputs *inputs, const struct options *options, trax_progress_line *progress,
                              trax_error *error) {
  struct trax_scene *scene = &inputs->scene;
  for (size_t i = 0; i < options->mesh_count; i++)
    if (has_suffix(options->meshes[i], ".trax")) {
      if (options->mesh_count > 1)
        return trax_fail(error, "%s: a scene file stands alone, it cannot be merged with other meshes",
                         options->meshes[i]);
      if (options->import.override_count || options->import.no_textures || options->import.texture_size ||
          options->build.compute_normals || options->nodes || options->splits || options->import.moves ||
          options->import.instances || options->import.flatten)
        return trax_fail(
            error,
            "%s: a scene file is as trax-scene made it: --material, --diffuse, --at, --no-textures, "
            "--texture-size, --nodes, --splits, --instances, --flatten and --normals smooth are for meshes",
            options->meshes[0]);
      trax_status status = trax_scene_read(scene, options->meshes[0], options->import.unpack_limit, error);
      if (status == TRAX_OK && options->frame.smooth && !scene->normals && scene->triangle_count)
        status = trax_fail(error, "%s: --smooth: the scene has no normals; trax-scene --smooth makes them",
                           options->meshes[0]);
      return status;
    }
  return import_scene(inputs, options, progress, error);
}

/* --- views --- */

static trax_status take_camera(struct trax_view *view, const struct inputs *inputs, const struct options *options,
                               const char *text, trax_error *error) {
  char name[TRAX_MESH_NAME];
  trax_mesh_name(name, text);
  for (uint32_t i = 0; i < inputs->camera_count; i++) {
    const struct trax_mesh_camera *camera = &inputs->cameras[i];
    if (*name && strcmp(name, camera->name) != 0)
      continue;
    memcpy(view->eye, camera->eye, sizeof view->eye);
    memcpy(view->direction, camera->direction, sizeof view->direction);
    memcpy(view->up, camera->up, sizeof view->up);
    view->fov = camera->fov;
    view->has_look_at = false;
    return TRAX_OK;
  }
  if (inputs->camera_count == 0)
    return trax_fail(error, "--view %s: the meshes have no cameras", options->view);
  return trax_fail(error, "--view %s: no camera has this name; the first of %u is '%s'", options->view,
                   inputs->camera_count, inputs->cameras[0].name);
}

static trax_status load_view(struct inputs *inputs, const struct options *options, trax_error *error) {
  struct trax_view *view = &inputs->view;
  const char *camera;
  char path[TRAX_PATH_SIZE];
  if (options->view && !is_camera(options->view, &camera))
    return find_view(path, options->view, error) == TRAX_OK ? trax_view_read(view, path, error) : TRAX_ERROR;
  const trax_status status = default_view(view, &inputs->inside, inputs->choice, &inputs->scene, options, error);
  return status == TRAX_OK && options->view ? take_camera(view, inputs, options, camera, error) : status;
}

/* Replaces values of the view by those of single options. */
static trax_status change_view(struct trax_view *view, const struct camera_options *camera, trax_error *error) {
  const float up[3] = {view->up[0], view->up[1], view->up[2]};
  if (camera->eye.given)
    memcpy(view->eye, camera->eye.at, sizeof view->eye);
  trax_status status = TRAX_OK;
  if (camera->look_at.given)
    status = trax_view_aim(view, camera->look_at.at, error);
  else if (camera->eye.given && view->has_look_at)
    status = trax_view_aim(view, view->look_at, error);
  if (status == TRAX_OK)
    status = trax_view_set_up(view, camera->up.given ? camera->up.at : up, error);
  if (camera->fov > 0)
    view->fov = camera->fov;
  if (camera->light_count)
    view->light_count = 0;
  if (camera->light_count == 1)
    memcpy(view->light, camera->lights[0], sizeof view->light);
  for (uint32_t i = 0; camera->light_count > 1 && i < camera->light_count; i++) {
    struct trax_light *light = &view->lights[view->light_count++];
    *light =
        (struct trax_light){.kind = TRAX_LIGHT_POINT, .colour = {1, 1, 1}, .strength = 1 / (float)camera->light_count};
    memcpy(light->position, camera->lights[i], sizeof light->position);
  }
  return status;
}

trax_status inputs_load(struct inputs *inputs, const struct options *options, trax_progress_line *progress,
                        trax_error *error) {
  *inputs = (struct inputs){0};
  trax_status status = load_scene(inputs, options, progress, error);
  if (options->rays)
    return status;
  if (status == TRAX_OK && options->environment)
    status = trax_environment_read(&inputs->environment, options->environment, options->environment_strength,
                                   options->environment_turn, error);
  if (status == TRAX_OK)
    status = load_view(inputs, options, error);
  if (status == TRAX_OK)
    status = change_view(&inputs->view, &options->camera, error);
  for (int axis = 0; axis < 3 && status == TRAX_OK; axis++) {
    const struct trax_scene_header *header = inputs->scene.header;
    inputs->centre[axis] = inputs->inside ? inputs->view.eye[axis]
                           : inputs->view.has_look_at
                               ? inputs->view.look_at[axis]
                               : header->bounds_min[axis] * 0.5f + header->bounds_max[axis] * 0.5f;
  }
  return status;
}

void inputs_view(struct trax_view *view, const struct inputs *inputs, const struct options *options) {
  const float *orbit = options->camera.orbit;
  *view = inputs->view;
  if (orbit[0] != 0 || orbit[1] != 0)
    trax_view_orbit(view, inputs->centre, orbit[0], orbit[1]);
}

void inputs_release(struct inputs *inputs) {
  free(inputs->cameras);
  trax_environment_release(&inputs->environment);
  trax_scene_release(&inputs->scene);
  *inputs = (struct inputs){0};
}
