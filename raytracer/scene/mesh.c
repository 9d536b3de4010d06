/* Meshes: import by the reader of each format, merging, and triangles that no ray can hit. */
#include "placing.h"
#include "trax/message.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

void trax_mesh_release(struct trax_mesh *mesh) {
  free(mesh->vertices);
  free(mesh->triangles);
  free(mesh->materials);
  free(mesh->textures);
  free(mesh->texels);
  free(mesh->cameras);
  free(mesh->normals);
  free(mesh->uvs);
  free(mesh->parts);
  free(mesh->instances);
  *mesh = (struct trax_mesh){0};
}

static const char generated_prefix[] = "generate:";

bool trax_mesh_is_generated(const char *path) {
  return strncmp(path, generated_prefix, sizeof generated_prefix - 1) == 0;
}

const struct trax_material trax_default_material = {.diffuse = {0.75f, 0.75f, 0.75f}, .ior = 1, .opacity = 1};

static const struct generator {
  const char *name;
  trax_status (*generate)(struct trax_mesh *mesh, uint64_t seed, trax_error *error);
} generators[] = {{"forest", scene_generate_forest}, {"fir", scene_generate_fir}};

/* Parses "generate:NAME" or "generate:NAME:SEED". */
static trax_status parse_generated(const char *path, const struct generator **generator, uint64_t *seed,
                                   trax_error *error) {
  const char *what = path + sizeof generated_prefix - 1;
  const size_t length = strcspn(what, ":");
  const char *rest = what + length;
  *seed = 0;
  *generator = NULL;
  for (size_t i = 0; i < sizeof generators / sizeof *generators; i++)
    if (strlen(generators[i].name) == length && strncmp(what, generators[i].name, length) == 0)
      *generator = &generators[i];
  bool good = *generator;
  if (good && *rest == ':') {
    char *end;
    errno = 0;
    *seed = strtoull(rest + 1, &end, 10);
    good = rest[1] >= '0' && rest[1] <= '9' && *end == '\0' && errno == 0;
  }
  return good ? TRAX_OK
              : trax_fail(error, "%s: expected %sforest, %sfir, or either with :SEED, a whole number below 2^64", path,
                          generated_prefix, generated_prefix);
}

trax_status trax_mesh_check(const char *path, trax_error *error) {
  const struct generator *generator;
  uint64_t seed;
  int digits;
  size_t length;
  if (trax_mesh_is_generated(path))
    return parse_generated(path, &generator, &seed, error);
  return strcmp(path, "-") == 0 || scene_find_number(path, &digits, &length) || access(path, R_OK) == 0
             ? TRAX_OK
             : trax_fail(error, "%s: cannot be read: %s", path, strerror(errno));
}

static trax_status generate(struct trax_mesh *mesh, const char *path, struct trax_import_report *report,
                            trax_error *error) {
  const struct generator *generator;
  uint64_t seed;
  if (parse_generated(path, &generator, &seed, error) != TRAX_OK)
    return TRAX_ERROR;
  trax_status result = generator->generate(mesh, seed, error);
  report->source_triangles = mesh->triangle_count;
  return result;
}

static trax_status read_mesh(struct trax_mesh *mesh, const char *path, const struct trax_import_options *options,
                             struct trax_import_report *report, trax_error *error) {
  static const struct {
    const char *extension;
    scene_reader *read;
  } readers[] = {{".ply", scene_read_ply},
                 {".obj", scene_read_obj},
                 {".gltf", scene_read_gltf},
                 {".glb", scene_read_gltf},
                 {".instances", scene_read_instances}};
  *mesh = (struct trax_mesh){0};
  if (trax_mesh_is_generated(path))
    return generate(mesh, path, report, error);
  char *name = scene_unpacked_name(path);
  if (!name)
    return scene_out_of_memory(error, path);
  scene_reader *read = NULL;
  for (size_t i = 0; i < sizeof readers / sizeof *readers; i++)
    if (scene_has_extension(name, readers[i].extension))
      read = readers[i].read;
  free(name);
  if (!read && access(path, R_OK) != 0)
    return trax_fail(error, "%s: cannot be read: %s", path, strerror(errno));
  return read ? read(mesh, path, options, report, error)
              : trax_fail(error,
                          "%s: not a mesh that can be read: its name ends in none of .ply, .obj, .gltf, .glb and "
                          ".instances, with "
                          ".xz or .gz if it is packed; Blender, for example, exports glTF from other formats",
                          path);
}

/* --- names --- */

void trax_mesh_name(char name[TRAX_MESH_NAME], const char *text) {
  enum { digits = 17 };
  const size_t length = strlen(text);
  uint64_t hash = 0xCBF29CE484222325u; /* FNV-1a */
  memset(name, 0, TRAX_MESH_NAME);
  if (length < TRAX_MESH_NAME) {
    memcpy(name, text, length);
    return;
  }
  for (size_t i = 0; i < length; i++)
    hash = (hash ^ (unsigned char)text[i]) * 0x100000001B3u;
  memcpy(name, text, TRAX_MESH_NAME - 1 - digits);
  snprintf(name + TRAX_MESH_NAME - 1 - digits, digits + 1, "~%016llx", (unsigned long long)hash);
}

/* --- merging --- */

/* Appends `size` bytes of records after `used` bytes. If the array is shorter, zeros fill it up. */
static bool append_records(void *array, size_t used, const void *records, size_t size) {
  void **pointer = array;
  if (!*pointer && !records)
    return true;
  char *grown = *pointer ? realloc(*pointer, used + size + 1) : calloc(used + size + 1, 1);
  if (!grown)
    return false;
  *pointer = grown;
  if (records)
    memcpy(grown + used, records, size);
  else
    memset(grown + used, 0, size);
  return true;
}

/* Makes all triangles one part, at its place. */
static bool make_part(struct trax_mesh *mesh, uint32_t sources) {
  mesh->parts = malloc(sizeof *mesh->parts);
  mesh->instances = malloc(sizeof *mesh->instances);
  if (!mesh->parts || !mesh->instances)
    return false;
  mesh->parts[0] = (struct trax_mesh_part){0, mesh->triangle_count, sources};
  mesh->instances[0] = (struct trax_mesh_instance){.material = TRAX_NO_MATERIAL};
  memcpy(mesh->instances[0].transform, scene_identity, sizeof scene_identity);
  mesh->part_count = mesh->instance_count = 1;
  return true;
}

/* If either mesh has instances, triangles are numbered part by part, and each part is placed at least once. */
static bool unite_parts(struct trax_mesh *mesh, struct trax_mesh *part, uint32_t first_source_id,
                        uint32_t part_sources) {
  if (mesh->part_count + part->part_count == 0)
    return true;
  if ((mesh->triangle_count && !mesh->part_count && !make_part(mesh, first_source_id)) ||
      (part->triangle_count && !part->part_count && !make_part(part, part_sources)))
    return false;
  for (uint32_t i = 0; i < part->part_count; i++)
    part->parts[i].first_triangle += mesh->triangle_count;
  for (uint32_t i = 0; i < part->instance_count; i++) {
    struct trax_mesh_instance *instance = &part->instances[i];
    instance->part += mesh->part_count;
    instance->material += instance->material == TRAX_NO_MATERIAL ? 0 : mesh->material_count;
  }
  return true;
}

/* sources: of the part, with those that were dropped. */
trax_status scene_append_mesh(struct trax_mesh *mesh, struct trax_mesh *part, uint32_t first_source_id,
                              uint32_t part_sources, const char *path, trax_error *error) {
  if (!unite_parts(mesh, part, first_source_id, part_sources))
    return scene_out_of_memory(error, path);
  const uint64_t counts[] = {
      (uint64_t)mesh->vertex_count + part->vertex_count,     (uint64_t)mesh->triangle_count + part->triangle_count,
      (uint64_t)mesh->material_count + part->material_count, (uint64_t)mesh->texture_count + part->texture_count,
      (uint64_t)mesh->texel_count + part->texel_count,       (uint64_t)mesh->camera_count + part->camera_count,
      (uint64_t)mesh->part_count + part->part_count,         (uint64_t)mesh->instance_count + part->instance_count};
  for (size_t i = 0; i < sizeof counts / sizeof *counts; i++)
    if (counts[i] > UINT32_MAX)
      return trax_fail(error, "%s: too large together with the files before it", path);
  for (uint32_t i = 0; i < part->triangle_count; i++) {
    struct trax_mesh_triangle *triangle = &part->triangles[i];
    for (int corner = 0; corner < 3; corner++)
      triangle->vertices[corner] += mesh->vertex_count;
    triangle->material += mesh->material_count;
    triangle->source_id += part->part_count ? 0 : first_source_id;
  }
  for (uint32_t i = 0; i < part->material_count; i++)
    if (part->materials[i].surface.texture)
      part->materials[i].surface.texture += mesh->texture_count;
  for (uint32_t i = 0; i < part->texture_count; i++)
    part->textures[i].first_texel += mesh->texel_count;
  if (mesh->material_count == 0) { /* the first file: no copy */
    *mesh = *part;
    *part = (struct trax_mesh){0};
    return TRAX_OK;
  }
#define APPEND(name, count)                                                                                            \
  append_records(&mesh->name, mesh->count * sizeof *mesh->name, part->name, part->count * sizeof *part->name)
  if (!APPEND(vertices, vertex_count) || !APPEND(triangles, triangle_count) || !APPEND(materials, material_count) ||
      !APPEND(textures, texture_count) || !APPEND(texels, texel_count) || !APPEND(cameras, camera_count) ||
      !APPEND(normals, triangle_count) || !APPEND(uvs, triangle_count) || !APPEND(parts, part_count) ||
      !APPEND(instances, instance_count))
    return scene_out_of_memory(error, path);
#undef APPEND
  mesh->vertex_count = (uint32_t)counts[0];
  mesh->triangle_count = (uint32_t)counts[1];
  mesh->material_count = (uint32_t)counts[2];
  mesh->texture_count = (uint32_t)counts[3];
  mesh->texel_count = (uint32_t)counts[4];
  mesh->camera_count = (uint32_t)counts[5];
  mesh->part_count = (uint32_t)counts[6];
  mesh->instance_count = (uint32_t)counts[7];
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

/* Removes triangles from one file's mesh, as the options say. */
static trax_status filter(struct trax_mesh *mesh, const struct trax_import_options *options, const char *path,
                          struct trax_import_report *report, trax_error *error) {
  uint32_t kept = 0, nonfinite = 0, first_nonfinite = 0, next_part = 0;
  for (uint32_t i = 0; i <= mesh->triangle_count; i++) {
    for (; next_part < mesh->part_count && mesh->parts[next_part].first_triangle == i; next_part++)
      mesh->parts[next_part].first_triangle = kept;
    if (i == mesh->triangle_count)
      break;
    struct trax_mesh_triangle triangle = mesh->triangles[i];
    const float *p = mesh->vertices[triangle.vertices[0]], *q = mesh->vertices[triangle.vertices[1]],
                *r = mesh->vertices[triangle.vertices[2]];
    if (!is_traceable_point(p) || !is_traceable_point(q) || !is_traceable_point(r)) {
      if (nonfinite++ == 0)
        first_nonfinite = i;
    } else if (is_degenerate(p, q, r))
      report->degenerate++;
    else {
      mesh->triangles[kept] = triangle;
      if (mesh->normals)
        memmove(mesh->normals[kept], mesh->normals[i], sizeof *mesh->normals);
      if (mesh->uvs)
        memmove(mesh->uvs[kept], mesh->uvs[i], sizeof *mesh->uvs);
      kept++;
    }
  }
  if (nonfinite && !options->drop_nonfinite)
    return trax_fail(error,
                     "%s: %u of %u triangles have a vertex that is NaN, infinite or beyond %g; the first is triangle "
                     "%u (from 0)",
                     path, nonfinite, mesh->triangle_count, (double)SCENE_MAX_COORDINATE, first_nonfinite);
  report->nonfinite += nonfinite;
  mesh->triangle_count = kept;
  for (uint32_t i = 0; i < mesh->part_count; i++)
    mesh->parts[i].triangle_count =
        (i + 1 < mesh->part_count ? mesh->parts[i + 1].first_triangle : kept) - mesh->parts[i].first_triangle;
  return TRAX_OK;
}

void scene_add_report(struct trax_import_report *total, const struct trax_import_report *part) {
  total->source_triangles += part->source_triangles;
  total->degenerate += part->degenerate;
  total->nonfinite += part->nonfinite;
  total->other_primitives += part->other_primitives;
  total->turned_normals += part->turned_normals;
  total->mended_normals += part->mended_normals;
  total->mended_uvs += part->mended_uvs;
  if (part->missing_files && total->missing_files == 0)
    memcpy(total->first_missing_file, part->first_missing_file, sizeof total->first_missing_file);
  total->missing_files += part->missing_files;
  if (part->bad_images && total->bad_images == 0)
    memcpy(total->first_bad_image, part->first_bad_image, sizeof total->first_bad_image);
  total->bad_images += part->bad_images;
  total->moved |= part->moved;
  total->unread |= part->unread;
}

/* Leaves out instances of nothing, and what no instance places. Gives all others triangles of their own if that is
   asked for. name: of the file, for messages. */
static trax_status place_instances(struct trax_mesh *mesh, const char *name, const struct trax_import_options *options,
                                   struct trax_import_report *report, trax_error *error) {
  if (scene_drop_parts(mesh, error) != TRAX_OK)
    return TRAX_ERROR;
  if (mesh->instance_count == 0 || !options->flatten)
    return TRAX_OK;
  trax_status result = scene_flatten_mesh(mesh, error);
  if (result == TRAX_OK) /* transforms may make triangles flat, or too large */
    result = filter(mesh, options, name, report, error);
  if (result == TRAX_OK)
    scene_mend_normals(mesh, report);
  return result;
}

trax_status scene_import_meshes(struct trax_mesh *mesh, const char *const *paths, size_t path_count,
                                const struct trax_import_options *options, struct trax_import_report *total,
                                trax_error *error) {
  *mesh = (struct trax_mesh){0};
  *total = (struct trax_import_report){0};
  trax_status result = TRAX_OK;
  for (size_t i = 0; i < path_count && result == TRAX_OK; i++) {
    if (options->progress)
      options->progress(options->progress_context, paths[i], -1);
    struct trax_mesh part = {0};
    struct trax_import_report part_report = {0};
    char *path = NULL;
    result = scene_name_at(&path, paths[i], options, &part_report, error);
    if (result == TRAX_OK)
      result = read_mesh(&part, path, options, &part_report, error);
    if (result == TRAX_OK)
      result = filter(&part, options, path, &part_report, error);
    free(path);
    if (scene_is_interrupted(options->interrupt))
      result = TRAX_INTERRUPTED;
    if (result == TRAX_OK) {
      scene_mend_normals(&part, &part_report);
      scene_mend_uvs(&part, &part_report);
    }
    if (result == TRAX_OK && total->source_triangles + part_report.source_triangles > UINT32_MAX)
      result = trax_fail(error, "%s: too large together with the files before it", paths[i]);
    if (result == TRAX_OK)
      result = scene_append_mesh(mesh, &part, (uint32_t)total->source_triangles, (uint32_t)part_report.source_triangles,
                                 paths[i], error);
    trax_mesh_release(&part);
    if (result != TRAX_OK)
      break;
    scene_add_report(total, &part_report);
  }
  if (result != TRAX_OK)
    trax_mesh_release(mesh);
  return result;
}

trax_status trax_mesh_import(struct trax_mesh *mesh, const char *const *paths, size_t path_count,
                             const struct trax_import_options *options, struct trax_import_report *report,
                             trax_error *error) {
  static const struct trax_import_options defaults;
  if (!options)
    options = &defaults;
  struct trax_import_report total;
  trax_status result = scene_import_meshes(mesh, paths, path_count, options, &total, error);
  if (result == TRAX_OK && options->moves && !total.moved)
    result = trax_fail(error, "%s: nothing moves: no glTF file has an animation, and no name has %%d for the frame",
                       path_count ? paths[0] : "no mesh");
  if (result == TRAX_OK)
    result = place_instances(mesh, path_count == 1 ? paths[0] : "the instances", options, &total, error);
  if (result == TRAX_OK)
    result = scene_override_materials(mesh, options, error);
  if (result != TRAX_OK) {
    trax_mesh_release(mesh);
    return result;
  }
  if (report)
    *report = total;
  return TRAX_OK;
}

void trax_import_print_notes(const struct trax_import_report *report, const char *program) {
  const struct {
    uint64_t count;
    const char *what;
  } notes[] = {{report->degenerate, "triangles have no area and are left out"},
               {report->nonfinite, "triangles are not finite and are left out"},
               {report->turned_normals, "triangles have normals that point away from them, which are turned"},
               {report->mended_normals, "triangles have normals that cannot be used, which are computed"},
               {report->mended_uvs, "triangles have texture coordinates that cannot be used"}};
  if (report->missing_files)
    trax_message(program, TRAX_MESSAGE_NOTE, "%s cannot be read%s: materials go without", report->first_missing_file,
                 report->missing_files > 1 ? ", nor other files" : "");
  if (report->bad_images)
    trax_message(program, TRAX_MESSAGE_NOTE, "%s%s: materials go without", report->first_bad_image,
                 report->bad_images > 1 ? ", and others" : "");
  for (size_t i = 0; i < sizeof notes / sizeof *notes; i++)
    if (notes[i].count)
      trax_message(program, TRAX_MESSAGE_NOTE, "%llu of %llu %s", (unsigned long long)notes[i].count,
                   (unsigned long long)report->source_triangles, notes[i].what);
  if (report->other_primitives)
    trax_message(program, TRAX_MESSAGE_NOTE, "%llu points and lines are left out",
                 (unsigned long long)report->other_primitives);
  static const char *const unread[] = {"colours of vertices", "normal maps", "transforms of texture coordinates"};
  for (unsigned i = 0; i < sizeof unread / sizeof *unread; i++)
    if (report->unread >> i & 1)
      trax_message(program, TRAX_MESSAGE_NOTE, "%s are not read", unread[i]);
}
