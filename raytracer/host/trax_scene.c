/* trax-scene: from mesh files to a scene file. */
#include "trax/options.h"
#include "trax/output.h"
#include "trax/scene.h"
#include "trax/signals.h"
#include "trax/version.h"

#include <errno.h>
#include <getopt.h>
#include <jansson.h>
#include <math.h>
#include <signal.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

static const char usage[] =
    "usage: trax-scene [options] MESH... -o SCENE\n"
    "       trax-scene --check SCENE [--stats] [--stats-json FILE]\n"
    "Imports meshes (PLY, OBJ with MTL, glTF, GLB and what else assimp reads, also as .xz or .gz), merges them, "
    "builds\n"
    "the BVH and writes a scene file. The mesh generate:forest[:SEED] is made by the program itself.\n"
    "  -o, --output SCENE           where to write; an existing file is replaced at once or stays as it is\n"
    "      --check SCENE            no import: check a scene file completely\n"
    "      --stats                  print what was read and built\n"
    "      --stats-json FILE        write the same as JSON\n"
    "      --diffuse [NAME=]R,G,B   linear colour, 0 to 1, of the material NAME, or of all (repeatable)\n"
    "      --material [NAME=]KIND   lambert, mirror[:R,G,B], glass[:IOR], ggx:ROUGHNESS[:R,G,B] or emit:R,G,B, of the\n"
    "                               material NAME, or of all (repeatable)\n"
    "      --no-textures            read no images; colours remain\n"
    "      --texture-size N         at most N texels a side, a power of two (default %u)\n"
    "      --drop-nonfinite         leave triangles with NaN or infinite vertices out instead of refusing the mesh\n"
    "      --keep-degenerate        keep triangles of exactly zero area, which no ray can hit\n"
    "      --allow-empty            write a scene without triangles if the mesh has none\n"
    "      --nodes KIND             binary: two boxes a line of memory; quantised: four, on a grid of 2^16 planes an "
    "axis;\n"
    "                               quantised8: four, of 256 planes an axis around each node; wide, wide-quantised,\n"
    "                               wide-quantised8: the same, up to four boxes a node;\n"
    "                               auto (default): quantised, if the grid is fine enough for each large part of the "
    "tree\n"
    "      --leaf N                 at most N triangles in a leaf, 1 to %u\n"
    "      --splits[=FACTOR]        splits large triangles, which then stand in several leaves: room for FACTOR times\n"
    "                               as many, 1 (none) to 8, without FACTOR 1.5; =auto (default): so, if many are "
    "askew\n"
    "      --passes N               N times over the tree after it was built, to move its parts to where they cost\n"
    "                               less, 0 to 16 (default 2)\n"
    "      --depth N                at most N nodes from the root to a leaf, 1 to %u\n"
    "      --traversal-cost X       of a node in the surface-area heuristic\n"
    "      --intersection-cost X    of a triangle\n"
    "      --cache-lines N          order nodes for a direct-mapped cache of N lines, 1 to 4096; 1: depth first\n"
    "      --smooth                 normals for smooth shading, the same as --normals file\n"
    "      --unpack-limit SIZE      of packed files and of pipes, unpacked; K, M and G are powers of 1024 (default "
    "1G)\n"
    "      --normals WHICH          file: the mesh's own, computed where it has none; smooth: computed; flat: none\n"
    "      --crease DEGREES         edges sharper than this stay edges, up to 180 (default %d)\n"
    "      --no-source-ids          leave out each triangle's number in the mesh\n"
    "  -q, --quiet                  no progress and no notes\n"
    "  -h, --help                   this text\n"
    "      --version                prints the version\n";

enum { max_overrides = 256 };

struct arguments {
  const char *const *meshes;
  size_t mesh_count;
  const char *output, *check, *stats_json;
  bool stats, quiet;
  struct trax_material_override overrides[max_overrides];
  struct trax_import_options import;
  struct trax_build_options build;
};

/* --- progress, on a terminal --- */

struct progress {
  bool shown;
  char step[64];
  double step_began, last_drawn; /* seconds */
};

static double seconds(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void draw_progress(void *context, const char *step, double fraction) {
  struct progress *progress = context;
  double now = seconds();
  if (strncmp(step, progress->step, sizeof progress->step - 1) != 0) {
    snprintf(progress->step, sizeof progress->step, "%s", step);
    progress->step_began = now;
    progress->last_drawn = 0;
  }
  if (now - progress->last_drawn < 0.1)
    return;
  progress->last_drawn = now;
  progress->shown = true;
  if (fraction < 0)
    fprintf(stderr, "\r\033[K%s", progress->step);
  else if (fraction > 0.05)
    fprintf(stderr, "\r\033[K%s: %.0f%%, %.0f s left", progress->step, 100 * fmin(fraction, 1),
            (now - progress->step_began) * fmax(1 / fraction - 1, 0));
  else
    fprintf(stderr, "\r\033[K%s: %.0f%%", progress->step, 100 * fraction);
  fflush(stderr);
}

static void clear_progress(struct progress *progress) {
  if (progress->shown)
    fputs("\r\033[K", stderr);
  progress->shown = false;
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
    list[n++] = (struct statistic){"memory.import", "B", "most resident in the importer's process", f->import_bytes};
    list[n++] = (struct statistic){"memory.build", "B", "most resident in this process", f->build_bytes};
  }
  list[n++] = (struct statistic){"scene.bytes", "B", "size of the file", (double)f->scene->size};
  list[n++] = (struct statistic){"scene.triangles", "", "", f->scene->triangle_count};
  list[n++] = (struct statistic){"scene.materials", "", "in use, each once", f->scene->material_count};
  list[n++] = (struct statistic){"scene.textures", "", "", f->scene->texture_count};
  list[n++] = (struct statistic){"scene.texels", "", "", f->scene->texel_count};
  list[n++] = (struct statistic){"bvh.node_bytes", "B", trax_node_formats[f->scene->header->node_layout].name,
                                 trax_node_formats[f->scene->header->node_layout].bytes};
  list[n++] = (struct statistic){"bvh.nodes", "", "inner nodes", f->scene->node_count};
  list[n++] = (struct statistic){"bvh.leaves", "", "", f->tree.leaves};
  list[n++] = (struct statistic){"bvh.max_depth", "", "most nodes on a path; of wide ones, their children but one",
                                 f->scene->header->max_depth};
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

/* --- the command line --- */

static void __attribute__((format(printf, 1, 2))) complain(const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  fputs("trax-scene: error: ", stderr);
  vfprintf(stderr, format, arguments);
  fputc('\n', stderr);
  va_end(arguments);
}

static bool parse_unsigned(const char *option, const char *text, unsigned least, unsigned most, unsigned *value) {
  char *end;
  errno = 0;
  long number = strtol(text, &end, 10);
  if (end == text || *end || errno || number < (long)least || number > (long)most) {
    complain("--%s: '%s' is not a number from %u to %u", option, text, least, most);
    return false;
  }
  *value = (unsigned)number;
  return true;
}

static bool parse_cost(const char *option, const char *text, float *value) {
  char *end;
  float number = strtof(text, &end);
  if (end == text || *end || !(number > 0) || !isfinite(number)) {
    complain("--%s: '%s' is not a positive number", option, text);
    return false;
  }
  *value = number;
  return true;
}

static bool parse_crease(const char *text, float *degrees) {
  char *end;
  float number = strtof(text, &end);
  if (end == text || *end || !(number > 0) || number > 180) {
    complain("--crease: '%s' is not an angle above 0 and up to 180 degrees", text);
    return false;
  }
  *degrees = number;
  return true;
}

static bool parse_override(struct arguments *arguments, char *text,
                           trax_status (*parse)(struct trax_material_override *, char *, trax_error *)) {
  trax_error error;
  if (arguments->import.override_count == max_overrides)
    complain("more than %d materials on the command line", (int)max_overrides);
  else if (parse(&arguments->overrides[arguments->import.override_count], text, &error) != TRAX_OK)
    complain("%s", error.message);
  else {
    arguments->import.override_count++;
    return true;
  }
  return false;
}

static bool parse_texture_size(const char *text, unsigned *size) {
  char *end;
  unsigned long number = strtoul(text, &end, 10);
  if (end == text || *end || number < 1 || number > 1u << TRAX_TEXTURE_MAX_LOG2 || (number & (number - 1))) {
    complain("--texture-size: '%s' is not a power of two up to %u", text, 1u << TRAX_TEXTURE_MAX_LOG2);
    return false;
  }
  *size = (unsigned)number;
  return true;
}

/* file: smooth by the mesh's own; smooth: by computed ones; flat: none. */
static bool parse_normals(const char *text, struct trax_build_options *build) {
  build->smooth = strcmp(text, "flat") != 0;
  build->compute_normals = !strcmp(text, "smooth");
  if (!strcmp(text, "file") || build->compute_normals || !build->smooth)
    return true;
  complain("--normals: '%s' is not file, smooth or flat", text);
  return false;
}

/* Returns an exit status, or -1 to go on. */
static int parse_arguments(struct arguments *arguments, int argc, char **argv) {
  enum {
    check = 256,
    stats,
    stats_json,
    diffuse,
    material,
    no_textures,
    texture_size,
    normals,
    drop,
    keep,
    empty,
    nodes,
    splits,
    leaf,
    passes,
    depth,
    traversal,
    intersection,
    cache,
    smooth,
    crease,
    unpack_limit,
    no_ids,
    version
  };
  static const struct option options[] = {{"output", required_argument, NULL, 'o'},
                                          {"check", required_argument, NULL, check},
                                          {"stats", no_argument, NULL, stats},
                                          {"stats-json", required_argument, NULL, stats_json},
                                          {"diffuse", required_argument, NULL, diffuse},
                                          {"material", required_argument, NULL, material},
                                          {"no-textures", no_argument, NULL, no_textures},
                                          {"texture-size", required_argument, NULL, texture_size},
                                          {"normals", required_argument, NULL, normals},
                                          {"drop-nonfinite", no_argument, NULL, drop},
                                          {"keep-degenerate", no_argument, NULL, keep},
                                          {"allow-empty", no_argument, NULL, empty},
                                          {"nodes", required_argument, NULL, nodes},
                                          {"splits", optional_argument, NULL, splits},
                                          {"leaf", required_argument, NULL, leaf},
                                          {"passes", required_argument, NULL, passes},
                                          {"depth", required_argument, NULL, depth},
                                          {"traversal-cost", required_argument, NULL, traversal},
                                          {"intersection-cost", required_argument, NULL, intersection},
                                          {"cache-lines", required_argument, NULL, cache},
                                          {"smooth", no_argument, NULL, smooth},
                                          {"crease", required_argument, NULL, crease},
                                          {"unpack-limit", required_argument, NULL, unpack_limit},
                                          {"no-source-ids", no_argument, NULL, no_ids},
                                          {"quiet", no_argument, NULL, 'q'},
                                          {"help", no_argument, NULL, 'h'},
                                          {"version", no_argument, NULL, version},
                                          {0}};
  opterr = 0;
  for (int option, index = 0; (option = getopt_long(argc, argv, ":o:qh", options, &index)) != -1;) {
    bool good = true;
    trax_error error;
    if (optarg && !*optarg) {
      complain("--%s: the value is empty", option == 'o' ? "output" : options[index].name);
      return 1;
    }
    switch (option) {
    case 'o':
      arguments->output = optarg;
      break;
    case check:
      arguments->check = optarg;
      break;
    case stats:
      arguments->stats = true;
      break;
    case stats_json:
      arguments->stats_json = optarg;
      break;
    case diffuse:
      good = parse_override(arguments, optarg, trax_override_diffuse);
      break;
    case material:
      good = parse_override(arguments, optarg, trax_override_material);
      break;
    case no_textures:
      arguments->import.no_textures = true;
      break;
    case texture_size:
      good = parse_texture_size(optarg, &arguments->import.texture_size);
      break;
    case normals:
      good = parse_normals(optarg, &arguments->build);
      break;
    case drop:
      arguments->import.drop_nonfinite = true;
      break;
    case keep:
      arguments->import.keep_degenerate = true;
      break;
    case empty:
      arguments->build.allow_empty = true;
      break;
    case nodes:
      good = trax_node_layout_choose(optarg, &arguments->build);
      if (!good)
        complain(
            "--nodes: '%s' is none of auto, binary, quantised, quantised8, wide, wide-quantised and wide-quantised8",
            optarg);
      break;
    case splits:
      good = trax_splits_choose(optarg, &arguments->build);
      if (!good)
        complain("--splits: '%s' is neither auto nor a number from 1 to %g", optarg, (double)TRAX_SCENE_MAX_SPLITS);
      break;
    case leaf:
      good = parse_unsigned(options[index].name, optarg, 1, TRAX_SCENE_MAX_LEAF, &arguments->build.max_leaf);
      break;
    case passes:
      good = parse_unsigned(options[index].name, optarg, 0, TRAX_SCENE_MAX_PASSES, &arguments->build.passes);
      break;
    case depth:
      good = parse_unsigned(options[index].name, optarg, 1, TRAX_SCENE_MAX_DEPTH, &arguments->build.max_depth);
      break;
    case traversal:
      good = parse_cost(options[index].name, optarg, &arguments->build.traversal_cost);
      break;
    case intersection:
      good = parse_cost(options[index].name, optarg, &arguments->build.intersection_cost);
      break;
    case cache:
      good = parse_unsigned(options[index].name, optarg, 1, 4096, &arguments->build.cache_lines);
      break;
    case smooth:
      arguments->build.smooth = true;
      break;
    case crease:
      good = parse_crease(optarg, &arguments->build.crease_degrees);
      break;
    case unpack_limit:
      good = trax_parse_size(optarg, &arguments->import.unpack_limit);
      if (!good)
        complain("--unpack-limit: '%s' is not a size from 1 byte to 4G", optarg);
      break;
    case no_ids:
      arguments->build.without_source_ids = true;
      break;
    case 'q':
      arguments->quiet = true;
      break;
    case 'h':
      printf(usage, 1u << TRAX_TEXTURE_MAX_LOG2, TRAX_SCENE_MAX_LEAF, TRAX_SCENE_MAX_DEPTH, TRAX_DEFAULT_CREASE);
      return 0;
    case version:
      puts("trax-scene " TRAX_VERSION);
      return 0;
    default:
      trax_wrong_option(options, argv, option, &error);
      complain("%s", error.message);
      good = false;
    }
    if (!good)
      return 1;
  }
  arguments->import.overrides = arguments->overrides;
  arguments->meshes = (const char *const *)argv + optind;
  arguments->mesh_count = (size_t)(argc - optind);
  if (arguments->check && (arguments->mesh_count || arguments->output)) {
    complain("--check takes neither meshes nor an output");
    return 1;
  }
  if (arguments->build.crease_degrees > 0 && !arguments->build.smooth) {
    complain("--crease without --smooth or --normals");
    return 1;
  }
  if (!arguments->check && (!arguments->mesh_count || !arguments->output)) {
    complain("%s", arguments->mesh_count ? "no output; give one with -o" : "no mesh; try --help");
    return 1;
  }
  return -1;
}

/* Before anything is read. What the meshes refer to is compared when it is found. */
static trax_status check_files(trax_files *files, const struct arguments *arguments, trax_error *error) {
  for (size_t i = 0; i < arguments->mesh_count; i++)
    if (!trax_mesh_is_generated(arguments->meshes[i]))
      trax_files_input(files, NULL, arguments->meshes[i]);
  trax_files_input(files, NULL, arguments->check);
  trax_files_output(files, "--output", arguments->output);
  trax_files_output(files, "--stats-json", arguments->stats_json);
  if (trax_files_check(files, error) != TRAX_OK ||
      (arguments->output && trax_output_check(arguments->output, error) != TRAX_OK))
    return TRAX_ERROR;
  return arguments->stats_json ? trax_output_check(arguments->stats_json, error) : TRAX_OK;
}

/* --- the program --- */

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

static double most_resident(int who) {
  struct rusage usage;
  return getrusage(who, &usage) == 0 ? 1024.0 * (double)usage.ru_maxrss : 0;
}

static trax_status import_and_build(struct trax_scene *scene, struct figures *figures,
                                    const struct arguments *arguments, trax_error *error) {
  struct trax_mesh mesh;
  double began = seconds();
  trax_status result =
      trax_mesh_import(&mesh, arguments->meshes, arguments->mesh_count, &arguments->import, &figures->import, error);
  if (result != TRAX_OK)
    return result;
  double imported = seconds();
  if (mesh.triangle_count == 0 && !arguments->build.allow_empty) {
    result = trax_fail(error, "%s: no triangles%s%s; --allow-empty makes a scene without any", arguments->meshes[0],
                       arguments->mesh_count > 1 ? " in it and the other meshes" : "",
                       figures->import.source_triangles ? " are left: all are of zero area or not finite" : "");
  } else
    result = trax_scene_build(scene, &mesh, &arguments->build, error);
  trax_mesh_release(&mesh);
  figures->imported = true;
  figures->import_seconds = imported - began;
  figures->build_seconds = seconds() - imported;
  figures->import_bytes = most_resident(RUSAGE_CHILDREN);
  figures->build_bytes = most_resident(RUSAGE_SELF);
  return result;
}

static trax_status run(const struct arguments *arguments, struct progress *progress, trax_error *error) {
  struct trax_scene scene = {0};
  struct figures figures = {.scene = &scene};
  trax_status result = arguments->check
                           ? trax_scene_read_within(&scene, arguments->check, arguments->import.unpack_limit, error)
                           : import_and_build(&scene, &figures, arguments, error);
  if (result == TRAX_OK && trax_signal)
    result = TRAX_INTERRUPTED;
  if (result == TRAX_OK && arguments->output)
    result = trax_scene_write(&scene, arguments->output, error);
  clear_progress(progress);
  if (result == TRAX_OK) {
    struct statistic list[max_statistics];
    trax_scene_measure(&figures.tree, &scene);
    size_t count = list_statistics(list, &figures);
    if (!arguments->quiet)
      trax_import_print_notes(&figures.import, "trax-scene", stderr);
    if (arguments->stats)
      print_statistics(list, count, scene.header);
    if (arguments->stats_json)
      result = write_json(arguments->stats_json, list, count, error);
  }
  trax_scene_release(&scene);
  return result;
}

/* The status, unless what was printed could not be written. */
static int end_of_output(int status) {
  if (fflush(stdout) == 0 && !ferror(stdout))
    return status;
  complain("cannot write to standard output: %s", strerror(errno));
  return 1;
}

int main(int argc, char **argv) {
  static struct arguments arguments = {
      .build = {.choose_nodes = true, .choose_splits = true, .passes = TRAX_DEFAULT_PASSES}};
  int status = parse_arguments(&arguments, argc, argv);
  if (status >= 0)
    return end_of_output(status);
  trax_catch_signals();
  signal(SIGXFSZ, SIG_IGN); /* a file beyond the limit is one that cannot be written */
  struct progress progress = {0};
  if (!arguments.quiet && isatty(STDERR_FILENO)) {
    arguments.import.progress = arguments.build.progress = draw_progress;
    arguments.import.progress_context = arguments.build.progress_context = &progress;
  }
  arguments.import.interrupt = arguments.build.interrupt = &trax_signal;
  trax_files files = {0};
  arguments.import.files = &files;
  trax_error error = {{0}};
  trax_status result = check_files(&files, &arguments, &error);
  if (result == TRAX_OK)
    result = run(&arguments, &progress, &error);
  trax_files_release(&files);
  if (result != TRAX_OK && trax_signal) {
    fputs("trax-scene: interrupted; nothing was written\n", stderr);
    trax_end_by_signal();
  }
  if (result != TRAX_OK) {
    complain("%s", error.message);
    return 1;
  }
  return end_of_output(0);
}
