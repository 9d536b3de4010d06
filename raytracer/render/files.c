/* Lists the inputs and outputs of trax-render, which are compared before it begins (trax/files.h). */
#include "files.h"

#include "prepare.h"
#include "trax/output.h"
#include "views.h"

#include <dirent.h>
#include <string.h>

/* The sources in the folder of --source, and in the folder of its headers. Headers elsewhere are found
   when they are compiled. */
static void add_sources(trax_files *files, const char *source) {
  static const char *const folders[] = {"%s/%s", "%s/trax/%s"};
  for (size_t i = 0; i < sizeof folders / sizeof *folders; i++) {
    char folder[TRAX_PATH_SIZE], path[TRAX_PATH_SIZE];
    if (snprintf(folder, sizeof folder, folders[i], source, "") >= (int)sizeof folder)
      continue; /* a longer one is refused later */
    DIR *entries = opendir(folder);
    for (const struct dirent *entry; entries && (entry = readdir(entries));)
      if (trax_is_source_name(entry->d_name) &&
          snprintf(path, sizeof path, folders[i], source, entry->d_name) < (int)sizeof path)
        trax_files_input(files, NULL, path);
    if (entries)
      closedir(entries);
  }
}

static trax_status add_inputs(trax_files *files, const struct options *options, trax_error *error) {
  for (size_t i = 0; i < options->mesh_count; i++)
    if (!trax_mesh_is_generated(options->meshes[i]))
      trax_files_input(files, NULL, options->meshes[i]);
  if (options->config && !trax_config_is_preset(options->config))
    trax_files_input(files, NULL, options->config);
  if (options->source)
    add_sources(files, options->source);
  char view[TRAX_PATH_SIZE];
  const char *camera;
  if (known_view(view, options))
    trax_files_input(files, NULL, view);
  if (!options->view || is_camera(options->view, &camera))
    return TRAX_OK;
  const trax_status status = find_view(view, options->view, error);
  if (status == TRAX_OK)
    trax_files_input(files, NULL, view);
  return status;
}

static void add_in_folder(trax_files *files, const char *option, const char *folder, const char *name) {
  char path[TRAX_PATH_SIZE];
  if (snprintf(path, sizeof path, "%s/%s", folder, name) < (int)sizeof path) /* a longer one is refused later */
    trax_files_output(files, option, path);
}

trax_status check_files(trax_files *files, const struct options *options, trax_error *error) {
  if (add_inputs(files, options, error) != TRAX_OK)
    return TRAX_ERROR;
  trax_files_output(files, "--output", options->output);
  trax_command_files(&render_command, options, files);
  for (size_t i = 0; options->keep && prepared_file(i); i++)
    add_in_folder(files, options->prepare ? "--prepare" : "--keep", options->keep, prepared_file(i));
  if (trax_files_check(files, error) != TRAX_OK ||
      (options->output && trax_output_name_check(options->output, "png pfm exr", error) != TRAX_OK) ||
      (options->output && trax_output_check(options->output, error) != TRAX_OK))
    return TRAX_ERROR;
  return trax_command_check_outputs(&render_command, options, error);
}
