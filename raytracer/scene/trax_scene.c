/* trax-scene: from mesh files to a scene file. */
#define _GNU_SOURCE /* memfd_create */
#include "trax_scene.h"
#include "layouts/layouts.h"

#include "trax/input.h"
#include "trax/message.h"
#include "trax/output.h"
#include "trax/progress.h"
#include "trax/reads.h"
#include "trax/signals.h"

#include <errno.h>
#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

static void show_step(void *context, const char *step, double fraction) {
  trax_progress_line_show(context, step, fraction, NULL);
}

/* --- statistics: declared once, written as text and as JSON --- */

struct figures {
  struct trax_import_report import;
  struct trax_scene_stats tree;
  const struct trax_scene *scene;
  bool imported;
  double import_seconds, build_seconds;
  double import_bytes, build_bytes;
};

enum { max_statistics = 64 };

struct statistic {
  const char *name, *unit, *meaning;
  double value;
};

static size_t list_statistics(struct statistic list[max_statistics], const struct figures *f) {
  size_t n = 0;
  if (f->imported) {
    list[n++] = (struct statistic){"import.triangles", "", "in the meshes", (double)f->import.source_triangles};
    list[n++] = (struct statistic){"import.degenerate", "", "dropped: zero area", (double)f->import.degenerate};
    list[n++] = (struct statistic){"import.nonfinite", "", "dropped: NaN or infinite", (double)f->import.nonfinite};
    list[n++] = (struct statistic){"import.other", "", "points and lines skipped", (double)f->import.other_primitives};
    list[n++] = (struct statistic){"import.seconds", "s", "reading and parsing", f->import_seconds};
    list[n++] = (struct statistic){"build.seconds", "s", "BVH and layout", f->build_seconds};
    list[n++] = (struct statistic){"memory.import", "B", "most resident when the meshes were read", f->import_bytes};
    list[n++] = (struct statistic){"memory.build", "B", "most resident in all", f->build_bytes};
  }
  list[n++] = (struct statistic){"scene.bytes", "B", "size of the file", (double)f->scene->size};
  list[n++] = (struct statistic){"scene.triangles", "", "", f->scene->triangle_count};
  if (f->scene->instances) {
    list[n++] = (struct statistic){"scene.instances", "", "", f->scene->instance_count};
    list[n++] = (struct statistic){"scene.meshes", "", "", f->scene->mesh_count};
  }
  list[n++] = (struct statistic){"scene.materials", "", "in use, each once", f->scene->material_count};
  list[n++] = (struct statistic){"scene.textures", "", "", f->scene->texture_count};
  list[n++] = (struct statistic){"scene.texels", "", "", f->scene->texel_count};
  list[n++] = (struct statistic){"bvh.node_bytes", "B", trax_node_formats[f->scene->header->node_layout].name,
                                 trax_node_formats[f->scene->header->node_layout].bytes};
  list[n++] = (struct statistic){"bvh.nodes", "", "inner nodes", f->scene->node_count};
  list[n++] = (struct statistic){"bvh.leaves", "", "", f->tree.leaves};
  list[n++] = (struct statistic){"bvh.max_depth", "", "most nodes on a path", f->scene->header->max_depth};
  list[n++] = (struct statistic){"bvh.mean_depth", "", "nodes above a leaf", f->tree.mean_leaf_depth};
  list[n++] = (struct statistic){"bvh.sah_nodes", "", "expected visits of a random ray", f->tree.sah_nodes};
  list[n++] = (struct statistic){"bvh.sah_triangles", "", "expected tests of a random ray", f->tree.sah_triangles};
  static const char *const leaf_names[] = {"",
                                           "bvh.leaves_of_1",
                                           "bvh.leaves_of_2",
                                           "bvh.leaves_of_3",
                                           "bvh.leaves_of_4",
                                           "bvh.leaves_of_5",
                                           "bvh.leaves_of_6",
                                           "bvh.leaves_of_7"};
  for (unsigned size = 1; size <= TRAX_SCENE_MAX_LEAF; size++)
    list[n++] = (struct statistic){leaf_names[size], "", "leaves with so many triangles", f->tree.leaf_sizes[size]};
  return n;
}

static void print_statistics(const struct statistic *list, size_t count, const struct trax_scene_header *header) {
  for (size_t i = 0; i < count; i++)
    printf("%-20s %14.*f %-2s%s%s\n", list[i].name, list[i].value == floor(list[i].value) ? 0 : 3, list[i].value,
           list[i].unit, list[i].meaning[0] ? "  " : "", list[i].meaning);
  printf("%-20s %g %g %g to %g %g %g\n", "scene.bounds", (double)header->bounds_min[0], (double)header->bounds_min[1],
         (double)header->bounds_min[2], (double)header->bounds_max[0], (double)header->bounds_max[1],
         (double)header->bounds_max[2]);
}

/* --- the program --- */

/* Compares inputs and outputs before anything is read. Files that meshes refer to are compared when they are found. */
static trax_status check_files(trax_files *files, const struct arguments *arguments, trax_error *error) {
  for (size_t i = 0; i < arguments->mesh_count; i++)
    if (!trax_mesh_is_generated(arguments->meshes[i]))
      trax_files_input(files, NULL, arguments->meshes[i]);
  trax_command_files(&scene_command, arguments, files);
  return trax_files_check(files, error) == TRAX_OK ? trax_command_check_outputs(&scene_command, arguments, error)
                                                   : TRAX_ERROR;
}

/* Creates a file without a name, to which the importer appends. */
static trax_status begin_list(int *list, const char *path, trax_error *error) {
  *list = path ? memfd_create("files", MFD_CLOEXEC) : 0;
  if (*list < 0)
    return trax_fail(error, "%s: cannot be collected: %s", path, strerror(errno));
  trax_scene_list_files(*list);
  return TRAX_OK;
}

static trax_status write_list(int list, const char *path, trax_error *error) {
  trax_input input = {.path = path, .descriptor = list};
  trax_status result = lseek(list, 0, SEEK_SET) == 0 ? trax_input_read(&input, SIZE_MAX - 1, error)
                                                     : trax_fail(error, "%s: %s", path, strerror(errno));
  if (result == TRAX_OK)
    result = trax_write_file(path, input.bytes, input.size, error);
  trax_input_close(&input);
  return result;
}

/* Written aside and renamed, as the scene is. */
static trax_status write_json(const char *path, const struct statistic *list, size_t count, trax_error *error) {
  json_t *root = json_object();
  for (size_t i = 0; i < count; i++)
    json_object_set_new(root, list[i].name,
                        list[i].value == floor(list[i].value) ? json_integer((json_int_t)list[i].value)
                                                              : json_real(list[i].value));
  char *text = json_dumps(root, JSON_INDENT(2));
  json_decref(root);
  char *line = text ? realloc(text, strlen(text) + 2) : NULL;
  if (!line) {
    free(text);
    return trax_fail(error, "%s: not enough memory", path);
  }
  strcat(line, "\n");
  trax_status result = trax_write_file(path, line, strlen(line), error);
  free(line);
  return result;
}

static double most_resident(void) {
  struct rusage usage;
  return getrusage(RUSAGE_SELF, &usage) == 0 ? 1024.0 * (double)usage.ru_maxrss : 0;
}

/* The scene whose tree is refitted: from a file, or that of another moment. */
static trax_status find_base(struct trax_scene *base, const struct arguments *arguments, trax_error *error) {
  struct trax_import_options import = arguments->import;
  struct trax_build_options build = arguments->build;
  struct trax_mesh mesh;
  if (arguments->refit)
    return trax_scene_read(base, arguments->refit, import.unpack_limit, error);
  import.at = arguments->base.at;
  build.choose_splits = false;
  trax_status result =
      trax_mesh_import(&mesh, (const char *const *)arguments->meshes, arguments->mesh_count, &import, NULL, error);
  if (result == TRAX_OK)
    result = trax_scene_build(base, &mesh, &build, error);
  trax_mesh_release(&mesh);
  return result;
}

static trax_status build_scene(struct trax_scene *scene, struct figures *figures, const struct trax_mesh *mesh,
                               const struct arguments *arguments, trax_error *error) {
  struct trax_build_options build = arguments->build;
  struct trax_scene base = {0};
  trax_status result = TRAX_OK;
  if (mesh->triangle_count == 0)
    return trax_fail(error, "%s: no triangles%s%s", arguments->meshes[0],
                     arguments->mesh_count > 1 ? " in it and the other meshes" : "",
                     figures->import.source_triangles ? " are left: all are of zero area or not finite" : "");
  if (arguments->refit || arguments->base.moves) {
    result = find_base(&base, arguments, error);
    build.refit = &base;
    build.refit_name = arguments->refit ? arguments->refit : "--refit-from";
  }
  const double began = trax_seconds();
  if (result == TRAX_OK)
    result = trax_scene_build(scene, mesh, &build, error);
  figures->build_seconds = trax_seconds() - began;
  trax_scene_release(&base);
  return result;
}

static trax_status import_and_build(struct trax_scene *scene, struct figures *figures,
                                    const struct arguments *arguments, trax_error *error) {
  struct trax_mesh mesh;
  const double began = trax_seconds();
  trax_status result = trax_mesh_import(&mesh, (const char *const *)arguments->meshes, arguments->mesh_count,
                                        &arguments->import, &figures->import, error);
  if (result != TRAX_OK)
    return result;
  figures->import_seconds = trax_seconds() - began;
  figures->import_bytes = most_resident();
  if (arguments->write_triangles)
    result = trax_mesh_write_triangles(&mesh, arguments->write_triangles, error);
  figures->imported = result == TRAX_OK && arguments->output;
  if (figures->imported)
    result = build_scene(scene, figures, &mesh, arguments, error);
  trax_mesh_release(&mesh);
  figures->build_bytes = most_resident();
  return result;
}

static trax_status run(const struct arguments *arguments, trax_progress_line *line, trax_error *error) {
  struct trax_scene scene = {0};
  struct figures figures = {.scene = &scene};
  int files = 0;
  trax_status result = begin_list(&files, arguments->list_files, error);
  if (result == TRAX_OK)
    result = arguments->check ? trax_scene_read(&scene, arguments->check, arguments->import.unpack_limit, error)
                              : import_and_build(&scene, &figures, arguments, error);
  if (result == TRAX_OK && trax_signal)
    result = TRAX_INTERRUPTED;
  if (result == TRAX_OK && arguments->output)
    result = trax_scene_write(&scene, arguments->output, error);
  trax_progress_line_clear(line);
  if (result == TRAX_OK && !arguments->quiet)
    trax_import_print_notes(&figures.import, "trax-scene");
  if (result == TRAX_OK && scene.header && (arguments->stats || arguments->stats_json)) {
    struct statistic list[max_statistics];
    trax_scene_measure(&figures.tree, &scene);
    size_t count = list_statistics(list, &figures);
    if (arguments->stats)
      print_statistics(list, count, scene.header);
    if (arguments->stats_json)
      result = write_json(arguments->stats_json, list, count, error);
  }
  if (result == TRAX_OK && files)
    result = write_list(files, arguments->list_files, error);
  trax_scene_release(&scene);
  return result;
}

static int complain(const trax_error *error) {
  trax_message("trax-scene", TRAX_MESSAGE_ERROR, "%s", error->message);
  return 1;
}

/* The status, or 1 if the output could not be written. */
static int end_of_output(int status) {
  trax_error error;
  return trax_output_flush(&error) == TRAX_OK ? status : complain(&error);
}

int main(int argc, char **argv) {
  struct arguments arguments;
  trax_error error;
  trax_reads_begin();
  const trax_parsed parsed = arguments_parse(&arguments, argc, argv, &error);
  if (parsed != TRAX_PARSED_RUN)
    return parsed == TRAX_PARSED_DONE ? end_of_output(0) : complain(&error);
  trax_catch_signals();
  trax_progress_line line;
  trax_files files = {0};
  trax_progress_line_begin(&line, "trax-scene", arguments.quiet);
  arguments.import.progress = arguments.build.progress = show_step;
  arguments.import.progress_context = arguments.build.progress_context = &line;
  arguments.import.interrupt = arguments.build.interrupt = &trax_signal;
  arguments.import.files = &files;
  trax_status result = check_files(&files, &arguments, &error);
  if (result == TRAX_OK)
    result = run(&arguments, &line, &error);
  trax_files_release(&files);
  free((struct trax_material_override *)arguments.import.overrides);
  if (result != TRAX_OK && trax_signal) {
    trax_progress_line_clear(&line);
    fputs("trax-scene: interrupted; nothing was written\n", stderr);
    trax_end_by_signal();
  }
  return result == TRAX_OK ? end_of_output(0) : complain(&error);
}
