/* The extreme suite: each case's rays by each method, judged exactly; natively and on the emulated machine.
   Usage: render-extreme --program-directory DIRECTORY [--case NAME] [--rays N] [--csv FILE]
   N rays for each case, 100 N for those of which it takes many; 1000 without the option.
   Prints a table in Markdown, with a figure for each method where they differ. Exit status 1 if the default method does
   what it must not: see check_row.

   Where trax-render would take exact hits for an eye at a ray's origin (render/reach.h), the watertight tests are
   those, and a fourth method is the watertight test in binary32. */
#include "../../../raytracer/device/camera.h"
#include "../../../raytracer/device/ray.h"
#include "cases.h"
#include "exact.h"
#include "machine/machine.h"
#include "machines.h"
#include "reach.h"

#include <getopt.h>
#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

enum { METHODS = 4, BINARY32 = 3, EMULATED_RAYS = 192, CHUNK = 1 << 18, NATIVE_THREADS = 2 };
#define JUDGED_PAIRS 2e6 /* rays times triangles */
#define EMULATED_EXACT_PAIRS 20000
enum { USUAL_RAYS = 1000, LARGE_SCENE = 50000, MANY_EXACT = 1000 }; /* of a case; triangles */

static const struct method {
  const char *name;
  query_function *trace;
  const char *program;
  bool plain_boxes;       /* not widened */
  query_function *placed; /* of scenes with instances */
  const char *placed_program;
} methods[METHODS] = {
    {"watertight", query_watertight, "query-watertight", false, query_instances, "query-instances"},
    {"Moeller-Trumbore", query_moller_trumbore, "query-moller-trumbore", false, query_instances_moller_trumbore,
     "query-instances-moller-trumbore"},
    {"watertight, boxes as they are", query_watertight, "query-watertight", true, query_instances, "query-instances"},
    {"watertight in binary32", query_watertight, "query-watertight", false, query_instances, "query-instances"},
};

struct row {
  struct exact_tally tally;
  uint64_t rays, escapes, not_finite, twin_differs, wrong_winner, variant_differs;
  uint64_t cycles, emulated;
  bool exact; /* hits */
};

struct prepared {
  struct setup setup;
  struct trax_scene scene;
  struct trax_scene variants[2 * TRAX_NODE_LAYOUTS]; /* the same with other nodes, and split, where that can be made */
  struct trax_frame frame;                           /* of cases with pictures */
  struct query_params params;
  bool short_form;        /* less than the usual rays: what takes longest is left out */
  bool exact_hits;        /* the first and the third method have exact hits */
  struct query_ray *rays; /* in the scaled scene */
  struct exact_scene exact;
  struct exact_triangle *triangles;
  struct exact_place *places;
};

static void die(const char *name, const trax_error *error) {
  fprintf(stderr, "render-extreme: error: %s: %s\n", name, error ? error->message : "out of memory");
  exit(1);
}

static void *allocate(size_t size) {
  void *memory = calloc(1, size ? size : 1);
  if (!memory)
    die("rays", NULL);
  return memory;
}

/* Has this method of a case exact hits? */
static bool hits_are_exact(const struct prepared *prepared, int m) {
  return prepared->exact_hits && (m == 0 || m == 2);
}

static struct method method_of(const struct prepared *prepared, int m) {
  struct method method = methods[m];
  if (hits_are_exact(prepared, m))
    method.trace = query_exact, method.program = "query-exact";
  if (prepared->scene.instances)
    method.trace = method.placed, method.program = method.placed_program;
  return method;
}

/* --- preparing a case --- */

static void turn_children(const struct trax_scene *scene) {
  struct trax_bvh_node *nodes = (struct trax_bvh_node *)scene->nodes;
  for (uint32_t i = 0; i < scene->node_count; i++) {
    struct trax_bvh_node old = nodes[i];
    for (int child = 0; child < 2; child++) {
      nodes[i].box[child] = old.box[1 - child];
      nodes[i].child[child] = old.child[1 - child];
    }
  }
}

/* The same meshes with other layouts of nodes, with triangles split, and with trees improved, scaled alike. Those of
   instances have leaves of other sizes instead. A tree that was made by hand has no other, nor has a large one in the
   short form. */
static void make_variants(struct prepared *prepared, const struct trax_view *view, const char *name) {
  trax_error error;
  for (unsigned i = 1; i < 2 * TRAX_NODE_LAYOUTS; i++) {
    struct trax_build_options build = prepared->setup.build;
    struct trax_view unscaled = *view;
    if (prepared->setup.mesh.triangle_count == 0 || prepared->setup.turned)
      continue;
    if (prepared->setup.mesh.triangle_count >= LARGE_SCENE && prepared->short_form)
      continue;
    build.nodes = i / 2;
    build.splits = i % 2 ? 3 : 0;
    build.passes = i & 2;
    if (prepared->scene.instances)
      build.nodes = TRAX_NODES_BINARY, build.splits = 0, build.max_leaf = 1 + (i - 1) % TRAX_SCENE_MAX_LEAF;
    if (trax_scene_build(&prepared->variants[i], &prepared->setup.mesh, &build, &error) != TRAX_OK ||
        trax_scene_check(NULL, prepared->variants[i].bytes, prepared->variants[i].size, name, &error) != TRAX_OK)
      die(name, &error);
    normalise(&prepared->variants[i], &unscaled);
  }
}

/* The first rays decide in scenes of many triangles. */
static bool needs_exact(const struct prepared *prepared) {
  const double most = JUDGED_PAIRS / fmax(1, prepared->scene.triangle_count);
  for (uint32_t i = 0; i < prepared->params.count && i < most; i++)
    if (trax_needs_exact(&prepared->scene, prepared->rays[i].origin))
      return true;
  return false;
}

/* The rays' extremes decide how the scene is scaled, and how far boxes are widened: no ray starts beyond them. */
static void prepare(struct prepared *prepared, const struct extreme_case *extreme, uint32_t rays, uint32_t seed,
                    bool short_form) {
  trax_error error;
  memset(prepared, 0, sizeof *prepared);
  prepared->short_form = short_form;
  struct setup *setup = &prepared->setup;
  setup->seed = seed;
  setup->numbers = extreme->numbers;
  extreme->make(setup, rays);
  setup->build.allow_empty = true;
  if (setup->premade.bytes) {
    prepared->scene = setup->premade;
    setup->premade.bytes = NULL;
  } else if (trax_scene_build(&prepared->scene, &setup->mesh, &setup->build, &error) != TRAX_OK) {
    die(extreme->name, &error);
  }
  const uint32_t triangles = exact_triangles(&prepared->triangles, &prepared->places, &prepared->scene);
  if (setup->turned)
    turn_children(&prepared->scene);

  bool picture = setup->width > 0;
  struct trax_view view = picture ? setup->view : view_from(0, 0, 0, 0, 0, -1, 60, 0, 0, 0);
  float low[3], high[3];
  for (int axis = 0; axis < 3; axis++) {
    low[axis] = high[axis] = picture ? view.eye[axis] : setup->ray_count ? setup->rays[0].origin[axis] : 0;
    for (uint32_t i = 0; i < setup->ray_count; i++) {
      low[axis] = fminf(low[axis], setup->rays[i].origin[axis]);
      high[axis] = fmaxf(high[axis], setup->rays[i].origin[axis]);
    }
    view.eye[axis] = fabsf(low[axis]) > fabsf(high[axis]) ? low[axis] : high[axis];
    view.light[axis] = setup->light[axis];
  }
  make_variants(prepared, &view, extreme->name);
  int exponent = normalise(&prepared->scene, &view);
  prepared->exact = (struct exact_scene){prepared->triangles, triangles, exponent, {0, 0, 0}};
  memcpy(prepared->exact.light, setup->light, sizeof setup->light);

  prepared->params.shadows = picture || (extreme->flags & CASE_SHADOWS);
  memcpy(prepared->params.light, view.light, sizeof view.light);
  struct trax_frame_options options = {.width = picture ? setup->width : 1,
                                       .height = picture ? setup->height : 1,
                                       .ambient = TRAX_DEFAULT_AMBIENT,
                                       .background = TRAX_DEFAULT_BACKGROUND,
                                       .samples = 1,
                                       .shadows = true};
  for (int corner = 0; corner < 8; corner++) {
    for (int axis = 0; axis < 3; axis++)
      view.eye[axis] = ldexpf(corner >> axis & 1 ? high[axis] : low[axis], exponent);
    trax_frame_release(&prepared->frame);
    if (trax_frame_init(&prepared->frame, &prepared->scene, &view, &options, &error) != TRAX_OK)
      die(extreme->name, &error);
    prepared->params.box_margin = fmaxf(prepared->params.box_margin, prepared->frame.params->box_margin);
  }
  if (picture) {
    free(setup->rays);
    setup->ray_count = setup->width * setup->height;
    setup->rays = allocate(setup->ray_count * sizeof *setup->rays);
    for (uint32_t i = 0; i < setup->ray_count; i++) {
      struct vector way =
          camera_direction(prepared->frame.params, pixel_at(i % setup->width, i / setup->width), PIXEL_MIDDLE);
      memcpy(setup->rays[i].origin, setup->view.eye, sizeof setup->view.eye);
      memcpy(setup->rays[i].direction, (float[]){way.x, way.y, way.z}, 3 * sizeof(float));
    }
  }
  prepared->params.count = setup->ray_count;
  prepared->rays = allocate(setup->ray_count * sizeof *prepared->rays);
  for (uint32_t i = 0; i < setup->ray_count; i++) {
    prepared->rays[i] = setup->rays[i];
    for (int axis = 0; axis < 3; axis++)
      prepared->rays[i].origin[axis] = ldexpf(setup->rays[i].origin[axis], exponent);
  }
  prepared->exact_hits = needs_exact(prepared);
  if (prepared->exact_hits && prepared->scene.instances) {
    trax_fail(&error, "a ray needs exact hits, and those of instances are not");
    die(extreme->name, &error);
  }
}

static void release(struct prepared *prepared) {
  trax_frame_release(&prepared->frame);
  trax_scene_release(&prepared->scene);
  for (unsigned i = 0; i < 2 * TRAX_NODE_LAYOUTS; i++)
    trax_scene_release(&prepared->variants[i]);
  free(prepared->rays);
  free(prepared->triangles);
  free(prepared->places);
  setup_release(&prepared->setup);
}

/* --- tracing --- */

struct share {
  pthread_t thread;
  const struct method *method;
  const struct prepared *prepared;
  const struct trax_scene *scene;
  const struct query_params *params;
  struct query_answer *answers;
  uint32_t first, last;
};

static void *trace_share(void *argument) {
  const struct share *share = argument;
  share->method->trace(share->scene->bytes, share->params, share->prepared->rays, share->answers, share->first,
                       share->last);
  return NULL;
}

/* The parameters of the method's program for a scene, which is prepared->scene or one with other nodes. */
static struct query_params params_for(const struct prepared *prepared, const struct trax_scene *scene,
                                      const struct method *method) {
  struct query_params params = prepared->params;
  if (method->plain_boxes)
    params.box_margin = 0;
  params.node_layout = scene->header->node_layout;
  memcpy(params.grid.origin, scene->grid.origin, sizeof params.grid.origin);
  memcpy(params.grid.cell, scene->grid.cell, sizeof params.grid.cell);
  return params;
}

static struct query_answer *trace(const struct prepared *prepared, const struct trax_scene *scene,
                                  const struct method *method) {
  const struct query_params params = params_for(prepared, scene, method);
  struct query_answer *answers = allocate(params.count * sizeof *answers);
  struct share shares[NATIVE_THREADS];
  for (uint32_t i = 0; i < NATIVE_THREADS; i++) {
    shares[i] = (struct share){.method = method,
                               .prepared = prepared,
                               .scene = scene,
                               .params = &params,
                               .answers = answers,
                               .first = (uint32_t)((uint64_t)params.count * i / NATIVE_THREADS),
                               .last = (uint32_t)((uint64_t)params.count * (i + 1) / NATIVE_THREADS)};
    if (pthread_create(&shares[i].thread, NULL, trace_share, &shares[i]) != 0)
      die("threads", NULL);
  }
  for (int i = 0; i < NATIVE_THREADS; i++)
    pthread_join(shares[i].thread, NULL);
  return answers;
}

/* Exact hits take fifty times as long, and of triangles one behind the other each is tested: of many, the short form
   emulates the first method alone. */
static bool emulation_is_long(const struct prepared *prepared) {
  return prepared->short_form && prepared->exact_hits && prepared->scene.triangle_count > MANY_EXACT;
}

/* The short form emulates with time only the first method, unless hits are exact: it takes ten times as long. */
static bool is_timed(const struct prepared *prepared, int m) {
  return !prepared->short_form || (m == 0 && !prepared->exact_hits);
}

static uint32_t emulated_rays(const struct prepared *prepared) {
  if (!prepared->exact_hits)
    return EMULATED_RAYS;
  const uint32_t rays = EMULATED_EXACT_PAIRS / (prepared->scene.triangle_count + 1);
  const uint32_t least = prepared->short_form ? 2 : 4;
  return rays < least ? least : rays < 32 ? rays : 32;
}

/* The first rays again, on the emulated machine: the same bits. Without `cycles`, in its functional engine. */
static void emulate(struct row *row, uint64_t *cycles, const struct prepared *prepared, const struct trax_scene *scene,
                    const struct method *method, const char *directory, const struct query_answer *native) {
  char program[4096];
  snprintf(program, sizeof program, "%s/%s%s.elf", directory, method->program,
           scene->header->max_depth > TRAX_SCENE_DEFAULT_DEPTH ? "-deep" : "");
  struct query_params params = params_for(prepared, scene, method);
  const uint32_t most = emulated_rays(prepared);
  params.count = params.count < most ? params.count : most;
  struct query_answer answers[EMULATED_RAYS];
  trax_error error;
  if (machine_trace(program, scene, &params, prepared->rays, answers, cycles, &error) != TRAX_OK)
    die(method->program, &error);
  row->emulated = params.count;
  for (uint32_t i = 0; i < params.count; i++)
    row->twin_differs += memcmp(&answers[i], &native[i], sizeof answers[i]) != 0;
}

/* --- judging --- */

static bool finite_answer(const struct query_answer *answer) {
  float distance = bits_float((int32_t)answer->distance_bits);
  return isfinite(distance) && isfinite(answer->weight1) && isfinite(answer->weight2) && isfinite(answer->origin[0]) &&
         isfinite(answer->origin[1]) && isfinite(answer->origin[2]);
}

/* Is there a triangle at the same place with a lower number? */
static bool has_lower_duplicate(const struct prepared *prepared, int64_t number) {
  const struct trax_scene *scene = &prepared->scene;
  for (uint32_t i = 0; i < scene->triangle_count; i++)
    if (scene->source_ids[i] < scene->source_ids[number] &&
        !memcmp(&prepared->triangles[i], &prepared->triangles[number], sizeof prepared->triangles[i]))
      return true;
  return false;
}

static void count_all(struct row *row, const struct prepared *prepared, const struct extreme_case *extreme,
                      const struct query_answer *answers) {
  row->rays += prepared->params.count;
  for (uint32_t i = 0; i < prepared->params.count; i++) {
    int64_t number = exact_number(&prepared->scene, &answers[i]);
    row->escapes += (extreme->flags & CASE_CLOSED) && number < 0;
    row->not_finite += !finite_answer(&answers[i]);
    row->wrong_winner += (extreme->flags & CASE_DUPLICATES) && number >= 0 && has_lower_duplicate(prepared, number);
  }
}

/* Other nodes, the same answers but for where in the file the triangle stands. */
static void compare_variants(struct row *row, const struct prepared *prepared, const char *directory, bool first,
                             const struct query_answer *answers) {
  for (unsigned v = 0; v < 2 * TRAX_NODE_LAYOUTS; v++) {
    const struct trax_scene *scene = &prepared->variants[v];
    if (!scene->bytes)
      continue;
    const struct method emulated = method_of(prepared, 0);
    struct query_answer *others = trace(prepared, scene, &emulated);
    if (first && !emulation_is_long(prepared))
      emulate(row, NULL, prepared, scene, &emulated, directory, others);
    for (uint32_t i = 0; i < prepared->params.count; i++) {
      row->variant_differs += exact_source(scene, &others[i]) != exact_source(&prepared->scene, &answers[i]);
      others[i].triangle = answers[i].triangle, others[i].instance = answers[i].instance;
      row->variant_differs += memcmp(&others[i], &answers[i], sizeof others[i]) != 0;
    }
    free(others);
  }
}

static void judge(struct row rows[METHODS], const struct prepared *prepared,
                  struct query_answer *const answers[METHODS]) {
  double most = JUDGED_PAIRS / fmax(1, prepared->exact.count);
  uint32_t judged = most < prepared->params.count ? (uint32_t)most : prepared->params.count;
  struct exact_tally tallies[METHODS];
  for (int m = 0; m < METHODS; m++)
    tallies[m] = rows[m].tally;
  for (uint32_t i = 0; i < judged; i++) {
    const struct query_ray *ray = &prepared->setup.rays[i];
    struct exact_answer answer[METHODS];
    int exponent = ilogbf(direction_scale(load_vector(ray->direction)));
    for (int m = 0; m < METHODS; m++) {
      const struct query_answer *given = &answers[m][i];
      answer[m] = (struct exact_answer){.triangle = exact_number(&prepared->scene, given),
                                        .distance = bits_float((int32_t)given->distance_bits),
                                        .direction_exponent = exponent,
                                        .light = (enum query_light)given->light,
                                        .exact = hits_are_exact(prepared, m)};
      memcpy(answer[m].origin, given->origin, sizeof given->origin);
    }
    exact_judge(tallies, &prepared->exact, ray, answer, METHODS);
  }
  for (int m = 0; m < METHODS; m++)
    rows[m].tally = tallies[m];
}

/* On a terminal. */
static void show_progress(const char *name, uint64_t done, uint64_t rays) {
  static time_t begun;
  if (!isatty(STDERR_FILENO))
    return;
  if (done == 0)
    begun = time(NULL);
  fprintf(stderr, "\r\33[K%s: %llu of %llu rays", name, (unsigned long long)done, (unsigned long long)rays);
  if (done > 0)
    fprintf(stderr, ", %.0f s left", difftime(time(NULL), begun) * (double)(rays - done) / (double)done);
  fflush(stderr);
}

static void clear_progress(void) {
  if (isatty(STDERR_FILENO))
    fputs("\r\33[K", stderr);
}

static void run_case(struct row rows[METHODS], const struct extreme_case *extreme, uint64_t rays,
                     const char *directory) {
  memset(rows, 0, METHODS * sizeof *rows);
  const bool short_form = rays < USUAL_RAYS;
  if (extreme->flags & CASE_MANY_RAYS)
    rays *= 100;
  uint32_t seed = 1;
  for (uint64_t done = 0; done < rays; done += CHUNK, seed++) {
    show_progress(extreme->name, done, rays);
    struct prepared prepared;
    struct query_answer *answers[METHODS];
    prepare(&prepared, extreme, (uint32_t)(rays - done < CHUNK ? rays - done : CHUNK), seed, short_form);
    for (int m = 0; m < METHODS; m++) {
      const struct method method = method_of(&prepared, m);
      answers[m] = trace(&prepared, &prepared.scene, &method);
      count_all(&rows[m], &prepared, extreme, answers[m]);
      rows[m].exact = hits_are_exact(&prepared, m);
      if (done == 0 && (m != BINARY32 || prepared.exact_hits) && (m == 0 || !emulation_is_long(&prepared)))
        emulate(&rows[m], is_timed(&prepared, m) ? &rows[m].cycles : NULL, &prepared, &prepared.scene, &method,
                directory, answers[m]);
    }
    compare_variants(&rows[0], &prepared, directory, done == 0, answers[0]);
    if (done == 0)
      judge(rows, &prepared, answers);
    if (done == 0 && prepared.setup.width > 0) {
      trax_error error;
      if (machine_pictures(directory, &prepared.frame, extreme->flags & CASE_HARDWARE, &error) != TRAX_OK)
        die(extreme->name, &error);
    }
    for (int m = 0; m < METHODS; m++)
      free(answers[m]);
    release(&prepared);
  }
}

/* --- the report --- */

static void write_csv(FILE *csv, const struct extreme_case *extreme, const struct row rows[METHODS]) {
  for (int m = 0; m < METHODS; m++) {
    const struct exact_tally *t = &rows[m].tally;
    fprintf(csv, "%s,\"%s\",%llu,%llu,%llu,%llu,%llu,%llu,%llu,%llu,%llu,%llu,%.9g,%llu,%llu\n", extreme->name,
            methods[m].name, (unsigned long long)rows[m].rays, (unsigned long long)rows[m].escapes,
            (unsigned long long)t->judged, (unsigned long long)t->hits, (unsigned long long)t->missed,
            (unsigned long long)t->wrong, (unsigned long long)t->unexplained, (unsigned long long)t->lit,
            (unsigned long long)t->leaks, (unsigned long long)t->acne, t->worst_ulp,
            (unsigned long long)rows[m].emulated, (unsigned long long)rows[m].cycles);
  }
}

/* One figure for each method, or one for all; of the last method if it is another one than the first. */
static void print_cell(const double values[METHODS], int count) {
  char text[METHODS][32];
  bool same = true;
  for (int m = 0; m < count; m++) {
    bool whole = values[m] == floor(values[m]) && values[m] < 1e6;
    snprintf(text[m], sizeof text[m], whole ? "%.0f" : "%.2g", values[m]);
    same &= !strcmp(text[m], text[0]);
  }
  printf(" %s", text[0]);
  for (int m = 1; m < count && !same; m++)
    printf(" / %s", text[m]);
  printf(" |");
}

static void print_row(const struct extreme_case *extreme, const struct row rows[METHODS]) {
  printf("| %s | %s | %s | %llu |", extreme->name, extreme->what, rows[0].exact ? "exact" : "binary32",
         (unsigned long long)rows[0].rays);
  double cells[7][METHODS];
  for (int m = 0; m < METHODS; m++) {
    const struct exact_tally *t = &rows[m].tally;
    cells[0][m] = (double)(extreme->flags & CASE_CLOSED ? rows[m].escapes : t->missed);
    cells[1][m] = (double)t->wrong;
    cells[2][m] = (double)t->unexplained;
    cells[3][m] = (double)t->leaks;
    cells[4][m] = (double)t->acne;
    cells[5][m] = t->worst_ulp;
    cells[6][m] = rows[m].emulated ? round((double)rows[m].cycles / (double)rows[m].emulated) : 0;
  }
  for (int i = 0; i < 7; i++)
    print_cell(cells[i], rows[0].exact ? METHODS : BINARY32);
  putchar('\n');
  fflush(stdout);
}

static unsigned complain(const char *name, const char *what, uint64_t count) {
  if (count)
    fprintf(stderr, "FAILED: %s: %s: %llu rays\n", name, what, (unsigned long long)count);
  return count != 0;
}

/* Counts results that the default method must never have. The others must agree with their emulated twins, too. */
static unsigned check_row(const struct extreme_case *extreme, const struct row *row, bool is_default) {
  const char *name = extreme->name;
  unsigned failures = complain(name, "the emulated machine answers otherwise", row->twin_differs);
  if (!is_default)
    return failures;
  failures += complain(name, "other nodes of the same triangles answer otherwise", row->variant_differs);
  failures += complain(name, "wrong beyond what rounding explains", row->tally.unexplained);
  if (!(extreme->flags & CASE_BELOW_ROUNDING)) {
    failures += complain(name, "left a closed surface", row->escapes);
    failures +=
        complain(name, "light or shadow beyond the bound on where shadow rays start", row->tally.unexplained_lights);
  }
  if (!(extreme->flags & (CASE_BELOW_ROUNDING | CASE_BELOW_OFFSET))) {
    failures += complain(name, "light where there is none", row->tally.leaks);
    failures += complain(name, "shadow where there is none", row->tally.acne);
  }
  failures += complain(name, "infinity or NaN", row->not_finite);
  failures += complain(name, "not the first of several triangles at one place", row->wrong_winner);
  return failures;
}

static uint64_t parse_rays(const char *text) {
  char *end;
  unsigned long long rays = strtoull(text, &end, 10);
  if (*text < '0' || *text > '9' || *end || rays == 0 || rays > 1000000000) {
    fprintf(stderr, "render-extreme: error: --rays %s: expected 1 to 1000000000\n", text);
    exit(1);
  }
  return rays;
}

int main(int argc, char **argv) {
  static const struct option names[] = {{"program-directory", required_argument, NULL, 'p'},
                                        {"case", required_argument, NULL, 'c'},
                                        {"rays", required_argument, NULL, 'r'},
                                        {"csv", required_argument, NULL, 'o'},
                                        {NULL, 0, NULL, 0}};
  const char *directory = ".", *only = NULL, *csv_path = NULL;
  uint64_t rays = USUAL_RAYS;
  int option;
  while ((option = getopt_long(argc, argv, "", names, NULL)) != -1) {
    if (option == 'p')
      directory = optarg;
    else if (option == 'c')
      only = optarg;
    else if (option == 'r')
      rays = parse_rays(optarg);
    else if (option == 'o')
      csv_path = optarg;
    else
      return 1;
  }
  FILE *csv = csv_path ? fopen(csv_path, "w") : NULL;
  if (csv_path && !csv) {
    perror(csv_path);
    return 1;
  }
  if (csv)
    fprintf(csv, "case,method,rays,escapes,judged,hits,missed,wrong,unexplained,lit,leaks,acne,worst_ulp,emulated_rays,"
                 "cycles\n");
  printf("| case | what | hits | rays | missed | wrong | unexplained | leaks | acne | worst ulp | cycles a ray |\n"
         "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
  unsigned failures = 0, run = 0;
  uint64_t faults[METHODS] = {0};
  const struct extreme_case *extreme;
  for (unsigned i = 0; (extreme = extreme_case(i)); i++) {
    if (only && strcmp(only, extreme->name) != 0)
      continue;
    struct row rows[METHODS];
    run_case(rows, extreme, rays, directory);
    clear_progress();
    print_row(extreme, rows);
    if (csv)
      write_csv(csv, extreme, rows);
    for (int m = 0; m < METHODS; m++) {
      failures += check_row(extreme, &rows[m], m == 0);
      faults[m] += m == BINARY32 && !rows[0].exact ? 0 : rows[m].escapes + rows[m].tally.unexplained;
    }
    if (extreme->flags & CASE_BEYOND_BINARY32 && rows[BINARY32].escapes + rows[BINARY32].tally.unexplained == 0) {
      fprintf(stderr, "FAILED: %s: binary32 is good enough\n", extreme->name);
      failures++;
    }
    run++;
  }
  if (csv && fclose(csv) != 0) {
    perror(csv_path);
    failures++;
  }
  if (run == 0) {
    fprintf(stderr, "render-extreme: error: no case is called %s\n", only);
    return 1;
  }
  if (!only) /* cases that no method could fail would prove nothing */
    for (int m = 1; m < METHODS; m++)
      if (faults[m] == 0) {
        fprintf(stderr, "FAILED: nothing is too hard for %s\n", methods[m].name);
        failures++;
      }
  printf("\n%u cases, %u failures\n", run, failures);
  return failures > 0;
}
