#include "bench_accuracy.h"

#include "accuracy.h"
#include "emulated.h"
#include "trax/input.h"
#include "trax/output.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>

/* Of C, and of a picture whose difference from C tells how far C has converged. */
#define CONVERGED_SAMPLES 1024
#define ROUGH_SAMPLES 256
#define STACK_BYTES (64u << 10) /* of a thread of the program that records */

struct bench {
  const struct options *options;
  const struct trax_scene *scene;
  const struct trax_view *view;
  trax_progress_line *progress;
  const volatile int *interrupt;
  char root[TRAX_PATH_SIZE];
  uint64_t own_hash; /* of this program, which has the emulator in it */
  struct trax_variant *variants;
  struct trax_accuracy_row *rows; /* of the variants */
  bool *done;                     /* read from a file */
  size_t count;
  double samples, samples_done; /* to render, for the progress */
  double samples_now;
  size_t now; /* the variant that is being measured */
  struct trax_exact converged;
  double rough_rmse;       /* of a picture of ROUGH_SAMPLES against it */
  struct rebuilt *rebuilt; /* the latest first */
};

/* A scene of trax_scene_rebuild. */
struct rebuilt {
  struct trax_scene scene;
  struct trax_rebuild_options how;
  struct rebuilt *next;
};

static bool path_in(const struct bench *bench, char path[TRAX_PATH_SIZE], const char *folder, const char *name,
                    const char *suffix) {
  const int length = snprintf(path, TRAX_PATH_SIZE, "%s%s%s%s", bench->options->output, folder, name, suffix);
  return length > 0 && length < TRAX_PATH_SIZE;
}

static trax_status make_folders(const struct bench *bench, trax_error *error) {
  char path[TRAX_PATH_SIZE];
  for (int kept = 0; kept < 2; kept++) {
    if (!path_in(bench, path, kept ? "/measured" : "", "", ""))
      return trax_fail(error, "%s: the path is too long", bench->options->output);
    if (mkdir(path, 0777) != 0 && errno != EEXIST)
      return trax_fail(error, "%s: %s", path, strerror(errno));
  }
  char probe[TRAX_PATH_SIZE];
  return path_in(bench, probe, "/accuracy.md", "", "") ? trax_output_check(probe, error)
                                                       : trax_fail(error, "%s: the path is too long", path);
}

static trax_status hash_self(uint64_t *hash, trax_error *error) {
  uint8_t *bytes;
  size_t size;
  if (trax_read_file("/proc/self/exe", (size_t)1 << 30, &bytes, &size, error) != TRAX_OK)
    return TRAX_ERROR;
  *hash = XXH3_64bits(bytes, size);
  free(bytes);
  return TRAX_OK;
}

static trax_status frame_of(struct trax_frame *frame, const struct bench *bench, const struct trax_scene *scene,
                            struct trax_method method, uint32_t samples, trax_error *error) {
  struct trax_frame_options options = bench->options->frame;
  options.samples = samples;
  options.method = method;
  return trax_frame_init(frame, scene, bench->view, &options, error);
}

/* As the default has it, of the scene as it is. */
static trax_status plain_frame(struct trax_frame *frame, const struct bench *bench, uint32_t samples,
                               trax_error *error) {
  return frame_of(frame, bench, bench->scene, (struct trax_method){0}, samples, error);
}

static bool same_tree(const struct trax_rebuild_options *a, const struct trax_rebuild_options *b) {
  return a->nodes == b->nodes && a->split == b->split && a->vertex_bits == b->vertex_bits;
}

static trax_status scene_of(const struct trax_scene **scene, struct bench *bench, const struct trax_variant *variant,
                            trax_error *error) {
  *scene = bench->scene;
  if (!variant->rebuilt)
    return TRAX_OK;
  struct rebuilt *rebuilt = bench->rebuilt;
  while (rebuilt && !same_tree(&rebuilt->how, &variant->tree))
    rebuilt = rebuilt->next;
  if (!rebuilt) {
    rebuilt = calloc(1, sizeof *rebuilt);
    const trax_status status =
        rebuilt ? trax_scene_rebuild(&rebuilt->scene, bench->scene, &variant->tree, bench->interrupt, error)
                : trax_fail(error, "out of memory");
    if (status != TRAX_OK) {
      free(rebuilt);
      return status;
    }
    rebuilt->how = variant->tree;
    rebuilt->next = bench->rebuilt;
    bench->rebuilt = rebuilt;
  }
  *scene = &rebuilt->scene;
  return TRAX_OK;
}

/* --- the pictures in binary64 --- */

struct step {
  struct bench *bench;
  const char *name; /* NULL: a part of measuring */
};

static void show_row(void *context, double fraction);

static void show_step(void *context, uint64_t done, uint64_t total) {
  const struct step *step = context;
  if (step->name)
    trax_progress_line_show(step->bench->progress, step->name, (double)done / (double)total, NULL);
  else
    show_row(step->bench, 0);
}

static trax_status render_exact(struct trax_exact *exact, struct bench *bench, const struct trax_frame *frame,
                                const char *step_name, bool seen, trax_error *error) {
  struct step step = {bench, step_name};
  struct trax_render_run run = {.progress = show_step, .progress_context = &step, .interrupt = bench->interrupt};
  return trax_render_exact(exact, frame, seen, &run, error);
}

/* C and the difference from one of fewer samples. */
static trax_status render_converged(struct bench *bench, trax_error *error) {
  struct trax_frame frame = {0};
  struct trax_exact rough = {0};
  trax_status status = plain_frame(&frame, bench, CONVERGED_SAMPLES, error);
  if (status == TRAX_OK)
    status = render_exact(&bench->converged, bench, &frame, "the converged picture", false, error);
  trax_frame_release(&frame);
  if (status == TRAX_OK)
    status = plain_frame(&frame, bench, ROUGH_SAMPLES, error);
  if (status == TRAX_OK)
    status = render_exact(&rough, bench, &frame, "how far it has converged", false, error);
  if (status == TRAX_OK) {
    struct trax_channel_errors errors;
    trax_channel_errors(&errors, rough.channels, bench->converged.channels, (size_t)rough.width * rough.height);
    bench->rough_rmse = errors.rmse;
  }
  trax_frame_release(&frame);
  trax_exact_release(&rough);
  return status;
}

static trax_status write_converged(const struct bench *bench, const char *path, size_t count, trax_error *error) {
  trax_output output;
  if (trax_output_open(&output, path, error) != TRAX_OK)
    return TRAX_ERROR;
  if (fwrite(bench->converged.channels, sizeof(double), count, output.file) == count &&
      fwrite(&bench->rough_rmse, sizeof(double), 1, output.file) == 1)
    return trax_output_commit(&output, error);
  trax_output_discard(&output);
  return trax_fail(error, "%s: %s", path, strerror(errno));
}

/* C, from its file or into it. */
static trax_status converge(struct bench *bench, trax_error *error) {
  struct trax_frame frame = {0};
  trax_status status = plain_frame(&frame, bench, CONVERGED_SAMPLES, error);
  if (status != TRAX_OK)
    return status;
  const uint64_t parts[] = {XXH3_64bits(frame.params, frame.params_size), bench->scene->header->checksum,
                            bench->scene->size, bench->own_hash};
  const uint32_t width = frame.params->width, height = frame.params->height;
  trax_frame_release(&frame);
  char name[48], path[TRAX_PATH_SIZE];
  snprintf(name, sizeof name, "converged-%016llx", (unsigned long long)XXH3_64bits(parts, sizeof parts));
  if (!path_in(bench, path, "/measured/", name, ""))
    return trax_fail(error, "%s: the path is too long", bench->options->output);
  const size_t count = 3 * (size_t)width * height, size = (count + 1) * sizeof(double);
  uint8_t *bytes = NULL;
  size_t got = 0;
  trax_error unread;
  if (trax_read_file(path, size, &bytes, &got, &unread) == TRAX_OK && got == size) {
    bench->converged = (struct trax_exact){
        .width = width, .height = height, .samples = CONVERGED_SAMPLES, .channels = (double *)(void *)bytes};
    bench->rough_rmse = bench->converged.channels[count];
    return TRAX_OK;
  }
  free(bytes);
  status = render_converged(bench, error);
  return status == TRAX_OK ? write_converged(bench, path, count, error) : status;
}

/* --- rows --- */

static void show_row(void *context, double fraction) {
  const struct bench *bench = context;
  const double done = bench->samples_done + fraction * bench->samples_now;
  trax_progress_line_show(bench->progress, "measuring", bench->samples > 0 ? done / bench->samples : -1,
                          bench->variants[bench->now].name);
}

static struct trax_accuracy_run run_of(struct bench *bench, const trax_config *config, const struct trax_exact *exact) {
  const unsigned queues = bench->options->queues;
  const uint32_t icache_bytes = (uint32_t)trax_config_get(config, "icache.bytes");
  return (struct trax_accuracy_run){
      .specialise = {.root = bench->root,
                     .cache = bench->options->cache,
                     .icache_bytes = icache_bytes,
                     .queues = queues ? queues : (unsigned)trax_config_get(config, "chip.tms"),
                     .interrupt = bench->interrupt},
      .config = config,
      .original = bench->scene,
      .exact = exact,
      .converged = &bench->converged,
      .host_threads = bench->options->threads,
      .progress = show_row,
      .progress_context = bench};
}

static trax_status row_path(char path[TRAX_PATH_SIZE], struct bench *bench, const struct trax_variant *variant,
                            const struct trax_frame *frame, const trax_config *config, trax_error *error) {
  char key[33], name[64];
  const struct trax_accuracy_run run = run_of(bench, config, NULL);
  const trax_status status = trax_accuracy_key(key, variant, frame, &run, error);
  if (status != TRAX_OK)
    return status;
  snprintf(name, sizeof name, "%s-%016llx", key, (unsigned long long)bench->own_hash);
  return path_in(bench, path, "/measured/", name, ".json")
             ? TRAX_OK
             : trax_fail(error, "%s: the path is too long", bench->options->output);
}

/* The chip, with memory for what is recorded and for the stacks of the threads that record. */
static trax_status chip(trax_config **config, const struct bench *bench, const struct trax_frame *frame,
                        trax_error *error) {
  *config = trax_config_create();
  if (!*config)
    return trax_fail(error, "out of memory");
  const struct trax_render_params *params = frame->params;
  const uint64_t recorded = (uint64_t)params->width * params->height *
                            (sizeof(struct trax_pixel_record) + params->samples * sizeof(struct trax_sample_record));
  return emulated_config(*config, bench->options, frame, recorded + 4096ull * STACK_BYTES, error);
}

/* With measure false the row is only looked for. */
static trax_status take_row(struct bench *bench, size_t i, const struct trax_exact *exact, bool measure,
                            trax_error *error) {
  struct trax_frame frame = {0};
  trax_config *config = NULL;
  char path[TRAX_PATH_SIZE];
  const struct trax_variant *variant = &bench->variants[i];
  const struct trax_scene *scene;
  trax_status status = scene_of(&scene, bench, variant, error);
  if (status == TRAX_OK)
    status = frame_of(&frame, bench, scene, variant->method, variant->samples, error);
  if (status == TRAX_OK)
    status = chip(&config, bench, &frame, error);
  if (status == TRAX_OK)
    status = row_path(path, bench, variant, &frame, config, error);
  if (status == TRAX_OK && !measure) {
    bench->done[i] = trax_accuracy_read_row(&bench->rows[i], path);
  } else if (status == TRAX_OK) {
    const struct trax_accuracy_run run = run_of(bench, config, exact);
    status = trax_accuracy_measure(&bench->rows[i], variant, &frame, &run, error);
    if (status == TRAX_OK)
      status = trax_accuracy_write_row(&bench->rows[i], path, error);
  }
  bench->rows[i].variant = *variant;
  trax_config_destroy(config);
  trax_frame_release(&frame);
  return status;
}

/* What is known to be right is the picture that the reference in binary64 renders. */
static trax_status check_workload(const struct bench *bench, trax_error *error) {
  struct trax_frame frame = {0};
  trax_status status = plain_frame(&frame, bench, 1, error);
  if (status != TRAX_OK)
    return status;
  const uint32_t others = frame.params->features & TRAX_PATH_FEATURES;
  unsigned feature = 0;
  while (feature < TRAX_FEATURE_COUNT && !(others >> feature & 1))
    feature++;
  trax_frame_release(&frame);
  return others
             ? trax_fail(error,
                         "--bench-accuracy measures the paper's workload, one point light and Lambert surfaces; this "
                         "picture needs %s",
                         trax_feature_name(feature))
             : TRAX_OK;
}

static trax_status find_rows(struct bench *bench, trax_error *error) {
  trax_status status = TRAX_OK;
  for (size_t i = 0; i < bench->count && status == TRAX_OK; i++) {
    trax_progress_line_show(bench->progress, "compiling", (double)i / (double)bench->count, NULL);
    status = take_row(bench, i, NULL, false, error);
    if (!bench->done[i])
      bench->samples += bench->variants[i].samples;
  }
  return status;
}

/* Rows of as many samples share E; they stand together. */
static trax_status measure_rows(struct bench *bench, trax_error *error) {
  trax_status status = TRAX_OK;
  struct trax_exact exact = {0};
  for (size_t i = 0; i < bench->count && status == TRAX_OK; i++) {
    if (bench->done[i])
      continue;
    const uint32_t samples = bench->variants[i].samples;
    bench->now = i;
    bench->samples_now = 0;
    if (exact.samples != samples) {
      struct trax_frame frame = {0};
      trax_exact_release(&exact);
      status = plain_frame(&frame, bench, samples, error);
      if (status == TRAX_OK)
        status = render_exact(&exact, bench, &frame, NULL, true, error);
      trax_frame_release(&frame);
    }
    bench->samples_now = samples;
    if (status == TRAX_OK)
      status = take_row(bench, i, &exact, true, error);
    bench->samples_done += samples;
  }
  trax_exact_release(&exact);
  return status;
}

/* --- the report --- */

static const char *base_name(const char *path) {
  const char *slash = strrchr(path, '/');
  return slash ? slash + 1 : path;
}

static bool is_moved(const struct camera_options *camera) {
  return camera->eye.given || camera->look_at.given || camera->up.given || camera->fov > 0 || camera->orbit[0] != 0 ||
         camera->orbit[1] != 0 || camera->light_count > 0;
}

static trax_status report(struct bench *bench, trax_error *error) {
  const struct options *options = bench->options;
  char view[256];
  snprintf(view, sizeof view, "%.200s%s", options->view ? base_name(options->view) : "of the whole",
           is_moved(&options->camera) ? ", changed by options" : "");
  trax_accuracy_fronts(bench->rows, bench->count);
  const struct trax_accuracy_report report = {.rows = bench->rows,
                                              .count = bench->count,
                                              .scene = base_name(options->meshes[0]),
                                              .view = view,
                                              .chip = options->config ? base_name(options->config) : "4x32",
                                              .width = options->frame.width,
                                              .height = options->frame.height,
                                              .converged_samples = CONVERGED_SAMPLES,
                                              .rough_samples = ROUGH_SAMPLES,
                                              .rough_rmse = bench->rough_rmse};
  char path[TRAX_PATH_SIZE];
  trax_output output;
  bool drawn = false;
  path_in(bench, path, "/accuracy", "", ".md");
  trax_status status = trax_output_open(&output, path, error);
  if (status != TRAX_OK)
    return status;
  trax_accuracy_print(&report, output.file);
  status = trax_output_commit(&output, error);
  path_in(bench, path, "/accuracy", "", ".csv");
  if (status == TRAX_OK)
    status = trax_accuracy_write_csv(&report, path, error);
  path_in(bench, path, "/accuracy", "", ".json");
  if (status == TRAX_OK)
    status = trax_accuracy_write_json(&report, path, error);
  if (status == TRAX_OK)
    status = trax_accuracy_draw(&report, options->output, &drawn, error);
  if (status != TRAX_OK)
    return status;
  trax_progress_line_clear(bench->progress);
  if (!drawn)
    fprintf(stderr,
            "trax-render: note: no diagrams: gnuplot does not run (Debian's gnuplot-nox); "
            "gnuplot %s/accuracy.gnuplot > accuracy.svg draws them\n",
            options->output);
  if (!options->quiet) {
    trax_accuracy_print(&report, stdout);
    printf("\nwritten     %s/accuracy.md, .csv, .json%s\n", options->output, drawn ? ", .svg" : "");
  }
  return TRAX_OK;
}

trax_status bench_accuracy(const struct options *options, const struct trax_scene *scene, const struct trax_view *view,
                           trax_progress_line *progress, const volatile int *interrupt, trax_error *error) {
  struct bench bench = {.options = options, .scene = scene, .view = view, .progress = progress, .interrupt = interrupt};
  if (!installation(bench.root))
    return trax_fail(error, "the place of trax-render itself is not known: %s", strerror(errno));
  trax_status status = make_folders(&bench, error);
  if (status == TRAX_OK)
    status = hash_self(&bench.own_hash, error);
  if (status == TRAX_OK)
    status = trax_variants(&bench.variants, &bench.count, scene, error);
  if (status == TRAX_OK) {
    bench.rows = calloc(bench.count, sizeof *bench.rows);
    bench.done = calloc(bench.count, sizeof *bench.done);
    if (!bench.rows || !bench.done)
      status = trax_fail(error, "out of memory");
  }
  if (status == TRAX_OK)
    status = check_workload(&bench, error);
  if (status == TRAX_OK)
    status = converge(&bench, error);
  if (status == TRAX_OK)
    status = find_rows(&bench, error);
  if (status == TRAX_OK)
    status = measure_rows(&bench, error);
  if (status == TRAX_OK)
    status = report(&bench, error);
  trax_exact_release(&bench.converged);
  for (struct rebuilt *next; bench.rebuilt; bench.rebuilt = next) {
    next = bench.rebuilt->next;
    trax_scene_release(&bench.rebuilt->scene);
    free(bench.rebuilt);
  }
  free(bench.variants);
  free(bench.rows);
  free(bench.done);
  return status;
}
