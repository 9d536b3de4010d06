/* Meshes: import in a child process, merge, refuse or drop what no ray can hit. */
#define _GNU_SOURCE /* memfd_create */
#include "internal.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

void trax_mesh_release(struct trax_mesh *mesh) {
  free(mesh->vertices);
  free(mesh->triangles);
  free(mesh->materials);
  free(mesh->textures);
  free(mesh->texels);
  free(mesh->normals);
  free(mesh->uvs);
  *mesh = (struct trax_mesh){0};
}

static const char generated_prefix[] = "generate:";

const struct trax_material trax_default_material = {.diffuse = {0.75f, 0.75f, 0.75f}, .ior = 1, .opacity = 1};

/* What is made, not read: "forest" or "forest:SEED". */
static trax_status generate(struct trax_mesh *mesh, const char *path, struct trax_import_report *report,
                            trax_error *error) {
  static const char name[] = "forest";
  const char *what = path + sizeof generated_prefix - 1, *rest = what + sizeof name - 1;
  uint64_t seed = 0;
  bool good = strncmp(what, name, sizeof name - 1) == 0 && (*rest == '\0' || *rest == ':');
  if (good && *rest == ':') {
    char *end;
    errno = 0;
    seed = strtoull(rest + 1, &end, 10);
    good = rest[1] >= '0' && rest[1] <= '9' && *end == '\0' && errno == 0;
  }
  if (!good)
    return scene_fail(error, "%s: expected %sforest, or %sforest:SEED with a whole number below 2^64", path,
                      generated_prefix, generated_prefix);
  trax_status result = scene_generate_forest(mesh, seed, error);
  report->source_triangles = mesh->triangle_count;
  return result;
}

trax_status scene_read_mesh(struct trax_mesh *mesh, const char *path, struct trax_import_report *report,
                            trax_error *error) {
  *mesh = (struct trax_mesh){0};
  if (strncmp(path, generated_prefix, sizeof generated_prefix - 1) == 0)
    return generate(mesh, path, report, error);
  char *name = scene_unpacked_name(path);
  if (!name)
    return scene_out_of_memory(error, path);
  trax_status (*read)(struct trax_mesh *, const char *, struct trax_import_report *, trax_error *) =
      scene_has_extension(name, ".ply")   ? scene_read_ply
      : scene_has_extension(name, ".obj") ? scene_read_obj
                                          : scene_read_with_assimp;
  free(name);
  return read(mesh, path, report, error);
}

/* --- the child process --- */

/* Processor time after which the importer is taken to hang: the largest scenes need a hundredth. */
enum { max_import_seconds = 600 };

/* The first record of what the child hands back; on success the mesh's three arrays follow. */
struct child_result {
  trax_status status;
  trax_error error;
  struct trax_import_report report;
  uint32_t vertex_count, triangle_count, material_count;
};

static _Noreturn void run_child(FILE *out, const char *path) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  signal(SIGINT, SIG_DFL);
  signal(SIGTERM, SIG_DFL);
  setrlimit(RLIMIT_CPU, &(struct rlimit){max_import_seconds, max_import_seconds});
  /* What a crashing importer prints is of no use to the user. */
  int null = open("/dev/null", O_WRONLY);
  if (null >= 0) {
    dup2(null, STDOUT_FILENO);
    dup2(null, STDERR_FILENO);
  }
  struct child_result result = {0};
  struct trax_mesh mesh;
  result.status = scene_read_mesh(&mesh, path, &result.report, &result.error);
  result.vertex_count = mesh.vertex_count;
  result.triangle_count = mesh.triangle_count;
  result.material_count = mesh.material_count;
  bool wrote = fwrite(&result, sizeof result, 1, out) == 1;
  if (result.status == TRAX_OK)
    wrote = wrote && fwrite(mesh.vertices, sizeof *mesh.vertices, mesh.vertex_count, out) == mesh.vertex_count &&
            fwrite(mesh.triangles, sizeof *mesh.triangles, mesh.triangle_count, out) == mesh.triangle_count &&
            fwrite(mesh.materials, sizeof *mesh.materials, mesh.material_count, out) == mesh.material_count;
  _exit(wrote && fflush(out) == 0 ? 0 : 1);
}

/* Waits for the child, or kills it when *interrupt becomes true. */
static trax_status wait_for_child(pid_t child, const char *path, const volatile int *interrupt, trax_error *error) {
  const struct timespec pause = {.tv_nsec = 2000000};
  int status;
  for (;;) {
    pid_t ended = waitpid(child, &status, interrupt ? WNOHANG : 0);
    if (ended == child)
      break;
    if (ended < 0 && errno != EINTR)
      return scene_fail(error, "%s: cannot wait for the importer: %s", path, strerror(errno));
    if (interrupt && *interrupt) {
      kill(child, SIGKILL);
      while (waitpid(child, &status, 0) < 0 && errno == EINTR)
        ;
      return TRAX_INTERRUPTED;
    }
    if (ended == 0)
      nanosleep(&pause, NULL);
  }
  if (interrupt && *interrupt)
    return TRAX_INTERRUPTED;
  if (WIFSIGNALED(status))
    return scene_fail(error, "%s: the importer crashed on it (%s): the file is damaged or not a mesh", path,
                      strsignal(WTERMSIG(status)));
  if (WEXITSTATUS(status) != 0)
    return scene_fail(error, "%s: the importer failed on it", path);
  return TRAX_OK;
}

static trax_status receive_mesh(struct trax_mesh *mesh, FILE *in, const char *path, struct trax_import_report *report,
                                trax_error *error) {
  struct child_result result;
  rewind(in);
  if (fread(&result, sizeof result, 1, in) != 1)
    return scene_fail(error, "%s: the importer failed on it", path);
  if (result.status != TRAX_OK) {
    if (error)
      *error = result.error;
    return result.status;
  }
  *report = result.report;
  mesh->vertex_count = result.vertex_count;
  mesh->triangle_count = result.triangle_count;
  mesh->material_count = result.material_count;
  mesh->vertices = malloc(((size_t)mesh->vertex_count + 1) * sizeof *mesh->vertices);
  mesh->triangles = malloc(((size_t)mesh->triangle_count + 1) * sizeof *mesh->triangles);
  mesh->materials = malloc(((size_t)mesh->material_count + 1) * sizeof *mesh->materials);
  if (!mesh->vertices || !mesh->triangles || !mesh->materials)
    return scene_out_of_memory(error, path);
  if (fread(mesh->vertices, sizeof *mesh->vertices, mesh->vertex_count, in) != mesh->vertex_count ||
      fread(mesh->triangles, sizeof *mesh->triangles, mesh->triangle_count, in) != mesh->triangle_count ||
      fread(mesh->materials, sizeof *mesh->materials, mesh->material_count, in) != mesh->material_count)
    return scene_fail(error, "%s: the importer's result is incomplete", path);
  return TRAX_OK;
}

trax_status scene_read_mesh_isolated(struct trax_mesh *mesh, const char *path, const volatile int *interrupt,
                                     struct trax_import_report *report, trax_error *error) {
  *mesh = (struct trax_mesh){0};
  int descriptor = memfd_create("mesh", MFD_CLOEXEC);
  FILE *exchange = descriptor < 0 ? NULL : fdopen(descriptor, "w+b");
  if (!exchange) {
    if (descriptor >= 0)
      close(descriptor);
    return scene_fail(error, "%s: cannot start the importer: %s", path, strerror(errno));
  }
  fflush(NULL); /* or the child would write what is buffered a second time */
  trax_status result;
  pid_t child = fork();
  if (child == 0)
    run_child(exchange, path);
  if (child < 0)
    result = scene_fail(error, "%s: cannot start the importer: %s", path, strerror(errno));
  else
    result = wait_for_child(child, path, interrupt, error);
  if (result == TRAX_OK)
    result = receive_mesh(mesh, exchange, path, report, error);
  fclose(exchange);
  if (result != TRAX_OK)
    trax_mesh_release(mesh);
  return result;
}

/* --- merging --- */

/* Appends the triangles and materials of one file; part's arrays are released. */
static trax_status append(struct trax_mesh *mesh, struct trax_mesh *part, uint32_t first_source_id, const char *path,
                          trax_error *error) {
  uint64_t vertices = (uint64_t)mesh->vertex_count + part->vertex_count;
  uint64_t triangles = (uint64_t)mesh->triangle_count + part->triangle_count;
  uint64_t materials = (uint64_t)mesh->material_count + part->material_count;
  if (vertices > UINT32_MAX || triangles > UINT32_MAX || materials > UINT32_MAX)
    return scene_fail(error, "%s: too large together with the files before it", path);
  for (uint32_t i = 0; i < part->triangle_count; i++) {
    struct trax_mesh_triangle *triangle = &part->triangles[i];
    for (int corner = 0; corner < 3; corner++)
      triangle->vertices[corner] += mesh->vertex_count;
    triangle->material += mesh->material_count;
    triangle->source_id += first_source_id;
  }
  if (mesh->material_count == 0) { /* the first file: no copy */
    *mesh = *part;
    *part = (struct trax_mesh){0};
    return TRAX_OK;
  }
  void *grown = realloc(mesh->vertices, (vertices + 1) * sizeof *mesh->vertices);
  if (!grown)
    return scene_out_of_memory(error, path);
  mesh->vertices = grown;
  if (!(grown = realloc(mesh->triangles, (triangles + 1) * sizeof *mesh->triangles)))
    return scene_out_of_memory(error, path);
  mesh->triangles = grown;
  if (!(grown = realloc(mesh->materials, (materials + 1) * sizeof *mesh->materials)))
    return scene_out_of_memory(error, path);
  mesh->materials = grown;
  memcpy(mesh->vertices + mesh->vertex_count, part->vertices, part->vertex_count * sizeof *part->vertices);
  memcpy(mesh->triangles + mesh->triangle_count, part->triangles, part->triangle_count * sizeof *part->triangles);
  memcpy(mesh->materials + mesh->material_count, part->materials, part->material_count * sizeof *part->materials);
  mesh->vertex_count = (uint32_t)vertices;
  mesh->triangle_count = (uint32_t)triangles;
  mesh->material_count = (uint32_t)materials;
  trax_mesh_release(part);
  return TRAX_OK;
}

/* --- triangles that cannot be traced --- */

static bool is_traceable_point(const float point[3]) {
  return fabsf(point[0]) <= SCENE_MAX_COORDINATE && fabsf(point[1]) <= SCENE_MAX_COORDINATE &&
         fabsf(point[2]) <= SCENE_MAX_COORDINATE;
}

/* Whether a * b == c * d in exact arithmetic; the operands' products must not underflow, which products of differences
   of binary32 numbers cannot. */
static bool equal_products(double a, double b, double c, double d) {
  double left = a * b, right = c * d;
  return left == right && fma(a, b, -left) == fma(c, d, -right);
}

/* *difference = a - b; returns whether that is exact (Knuth's TwoSum). */
static bool exact_difference(double a, double b, double *difference) {
  double d = a - b, virtual_b = a - d, virtual_a = d + virtual_b;
  *difference = d;
  return a - virtual_a == 0 && virtual_b - b == 0;
}

/* Zero area, decided exactly: no false positives whatever the scale. Triangles whose edges need more than 53 bits are
   kept unless two corners coincide, which costs time but never a hit. */
static bool is_degenerate(const float p[3], const float q[3], const float r[3]) {
  double u[3], v[3];
  bool exact = true;
  for (int axis = 0; axis < 3; axis++) {
    bool exact_u = exact_difference(q[axis], p[axis], &u[axis]), exact_v = exact_difference(r[axis], p[axis], &v[axis]);
    exact = exact && exact_u && exact_v;
  }
  bool same_pq = u[0] == 0 && u[1] == 0 && u[2] == 0, same_pr = v[0] == 0 && v[1] == 0 && v[2] == 0;
  bool same_qr = q[0] == r[0] && q[1] == r[1] && q[2] == r[2];
  if (same_pq || same_pr || same_qr)
    return true;
  return exact && equal_products(u[1], v[2], u[2], v[1]) && equal_products(u[2], v[0], u[0], v[2]) &&
         equal_products(u[0], v[1], u[1], v[0]);
}

/* Removes what options say from one file's mesh. */
static trax_status filter(struct trax_mesh *mesh, const struct trax_import_options *options, const char *path,
                          struct trax_import_report *report, trax_error *error) {
  uint32_t kept = 0, nonfinite = 0, first_nonfinite = 0;
  for (uint32_t i = 0; i < mesh->triangle_count; i++) {
    struct trax_mesh_triangle triangle = mesh->triangles[i];
    const float *p = mesh->vertices[triangle.vertices[0]], *q = mesh->vertices[triangle.vertices[1]],
                *r = mesh->vertices[triangle.vertices[2]];
    if (!is_traceable_point(p) || !is_traceable_point(q) || !is_traceable_point(r)) {
      if (nonfinite++ == 0)
        first_nonfinite = i;
    } else if (!options->keep_degenerate && is_degenerate(p, q, r))
      report->degenerate++;
    else
      mesh->triangles[kept++] = triangle;
  }
  if (nonfinite && !options->drop_nonfinite)
    return scene_fail(error,
                      "%s: %u of %u triangles have a vertex that is NaN, infinite or beyond %g; the first is triangle "
                      "%u (from 0)",
                      path, nonfinite, mesh->triangle_count, (double)SCENE_MAX_COORDINATE, first_nonfinite);
  report->nonfinite += nonfinite;
  mesh->triangle_count = kept;
  return TRAX_OK;
}

static trax_status override_materials(struct trax_mesh *mesh, const struct trax_import_options *options,
                                      trax_error *error) {
  for (size_t i = 0; i < options->override_count; i++) {
    const struct trax_material_override *override = &options->overrides[i];
    bool found = false;
    for (uint32_t m = 0; m < mesh->material_count; m++) {
      if (override->name && strcmp(override->name, mesh->materials[m].name) != 0)
        continue;
      memcpy(mesh->materials[m].surface.diffuse, override->diffuse, sizeof override->diffuse);
      found = true;
    }
    if (!found)
      return scene_fail(error, "no material is named '%s'", override->name ? override->name : "*");
  }
  return TRAX_OK;
}

trax_status trax_mesh_import(struct trax_mesh *mesh, const char *const *paths, size_t path_count,
                             const struct trax_import_options *options, struct trax_import_report *report,
                             trax_error *error) {
  static const struct trax_import_options defaults;
  if (!options)
    options = &defaults;
  *mesh = (struct trax_mesh){0};
  struct trax_import_report total = {0};
  trax_status result = TRAX_OK;
  for (size_t i = 0; i < path_count && result == TRAX_OK; i++) {
    if (options->progress)
      options->progress(options->progress_context, paths[i], -1);
    struct trax_mesh part;
    struct trax_import_report part_report = {0};
    result = options->in_process ? scene_read_mesh(&part, paths[i], &part_report, error)
                                 : scene_read_mesh_isolated(&part, paths[i], options->interrupt, &part_report, error);
    if (result == TRAX_OK)
      result = filter(&part, options, paths[i], &part_report, error);
    if (result == TRAX_OK && total.source_triangles + part_report.source_triangles > UINT32_MAX)
      result = scene_fail(error, "%s: too large together with the files before it", paths[i]);
    if (result == TRAX_OK)
      result = append(mesh, &part, (uint32_t)total.source_triangles, paths[i], error);
    trax_mesh_release(&part);
    if (result != TRAX_OK)
      break;
    total.source_triangles += part_report.source_triangles;
    total.degenerate += part_report.degenerate;
    total.nonfinite += part_report.nonfinite;
    total.other_primitives += part_report.other_primitives;
    if (part_report.missing_files && total.missing_files == 0)
      memcpy(total.first_missing_file, part_report.first_missing_file, sizeof total.first_missing_file);
    total.missing_files += part_report.missing_files;
  }
  if (result == TRAX_OK)
    result = override_materials(mesh, options, error);
  if (result != TRAX_OK) {
    trax_mesh_release(mesh);
    return result;
  }
  if (report)
    *report = total;
  return TRAX_OK;
}
