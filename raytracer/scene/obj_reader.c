/* Wavefront OBJ with its material libraries. An error names its line.

   Read: v, vt, vn, f (absolute and relative indices, any polygon), usemtl, mtllib. Counted as other primitives: p, l.
   Statements about grouping, smoothing and free-form surfaces are skipped. */
#include "text.h"

enum { no_material = SCENE_NO_MATERIAL, absent = UINT32_MAX };

/* The face being read. */
struct corner_list {
  uint32_t *vertices, *uvs, *normals; /* absent: the corner has none */
  uint32_t count;
  size_t vertex_capacity, uv_capacity, normal_capacity;
};

/* vt or vn, as many numbers each as are used. */
struct value_list {
  float (*values)[3];
  uint32_t count;
  size_t capacity;
};

struct obj_reader {
  const char *path;
  unsigned line;
  trax_error *error;
  struct trax_mesh *mesh;
  size_t vertex_capacity, triangle_capacity, uv_capacity, normal_capacity;
  struct value_list uvs, normals;
  struct corner_list corners;
  struct scene_material_list materials;
  struct scene_textures textures;
  struct scene_polygon_work polygon_work;
  uint32_t material;         /* current */
  uint32_t default_material; /* no_material until one is needed */
  struct trax_import_report *report;
};

static trax_status fail_here(const struct obj_reader *reader, const char *reason, const char *what) {
  return trax_fail(reader->error, "%s:%u: %s%s%.100s%s", reader->path, reader->line, reason, what ? " '" : "",
                   what ? what : "", what ? "'" : "");
}

/* mtllib: one file; its name may hold spaces. */
static trax_status read_mtllib(struct obj_reader *reader, char *rest) {
  const char *name = remainder_of(rest);
  if (!*name)
    return fail_here(reader, "mtllib without a name", NULL);
  char *path = scene_referred_path(reader->path, name);
  if (!path)
    return scene_out_of_memory(reader->error, reader->path);
  trax_status result = scene_read_mtl(&reader->materials, &reader->textures, path, reader->error);
  free(path);
  return result;
}

static trax_status use_material(struct obj_reader *reader, char *rest) {
  const char *name = remainder_of(rest);
  reader->material = scene_find_material(reader->mesh, name);
  if (reader->material == (uint32_t)no_material)
    reader->material = scene_add_material(&reader->materials, name);
  return reader->material == (uint32_t)no_material ? scene_out_of_memory(reader->error, reader->path) : TRAX_OK;
}

/* --- geometry --- */

static trax_status read_vertex(struct obj_reader *reader, char *rest) {
  struct trax_mesh *mesh = reader->mesh;
  if (!scene_grow(&mesh->vertices, sizeof *mesh->vertices, mesh->vertex_count, &reader->vertex_capacity))
    return scene_out_of_memory(reader->error, reader->path);
  float *vertex = mesh->vertices[mesh->vertex_count];
  for (int axis = 0; axis < 3; axis++) {
    const char *word = next_word(&rest);
    if (!word)
      return fail_here(reader, "a vertex needs three coordinates", NULL);
    if (!parse_float(word, &vertex[axis]))
      return fail_here(reader, "a vertex's coordinate is not a number:", word);
  }
  /* One more number is a weight, three more are a colour. */
  if (next_word(&rest) && next_word(&rest) && next_word(&rest))
    reader->report->unread |= TRAX_UNREAD_COLOURS;
  mesh->vertex_count++;
  return TRAX_OK;
}

/* Reads vt, whose third number is ignored, or vn. */
static trax_status read_attribute(struct obj_reader *reader, char *rest, struct value_list *list, int needed,
                                  const char *what) {
  if (!scene_grow(&list->values, sizeof *list->values, list->count, &list->capacity))
    return scene_out_of_memory(reader->error, reader->path);
  float *values = list->values[list->count];
  values[0] = values[1] = values[2] = 0;
  for (int i = 0; i < 3; i++) {
    const char *word = next_word(&rest);
    if (!word && i >= needed)
      break;
    if (!word || !parse_float(word, &values[i]))
      return fail_here(reader, word ? "not a number:" : what, word);
  }
  list->count++;
  return TRAX_OK;
}

/* Reads an index, from 1; a negative one counts back from the last so far. Moves *rest behind it. */
static trax_status read_index(const struct obj_reader *reader, const char *word, const char **rest, uint32_t count,
                              const char *kind, uint32_t *index) {
  char *end;
  long long number = strtoll(*rest, &end, 10);
  if (end == *rest || (*end && *end != '/') || number == 0)
    return trax_fail(reader->error, "%s:%u: not a %s index: '%.100s'", reader->path, reader->line, kind, word);
  long long from_zero = number > 0 ? number - 1 : count + number;
  if (from_zero < 0 || from_zero >= count)
    return trax_fail(reader->error, "%s:%u: %s index %.*s is out of range (%u so far)", reader->path, reader->line,
                     kind, (int)(end - *rest > 40 ? 40 : end - *rest), *rest, count);
  *rest = end;
  *index = (uint32_t)from_zero;
  return TRAX_OK;
}

/* Reads the optional index after a slash. An index is ignored if the file has no such attributes. */
static trax_status read_attribute_index(const struct obj_reader *reader, const char *word, const char **rest,
                                        uint32_t count, const char *kind, uint32_t *index) {
  if (**rest != '/')
    return TRAX_OK;
  ++*rest;
  if (**rest == '\0' || **rest == '/')
    return TRAX_OK;
  if (count)
    return read_index(reader, word, rest, count, kind, index);
  char *end;
  const long long number = strtoll(*rest, &end, 10);
  if (end == *rest || (*end && *end != '/') || number == 0)
    return trax_fail(reader->error, "%s:%u: not a %s index: '%.100s'", reader->path, reader->line, kind, word);
  *rest = end;
  return TRAX_OK;
}

/* "7", "7/1", "7//3" or "7/1/3". */
static trax_status read_corner(struct obj_reader *reader, const char *word) {
  struct corner_list *corners = &reader->corners;
  const uint32_t at = corners->count;
  if (!scene_grow(&corners->vertices, sizeof *corners->vertices, at, &corners->vertex_capacity) ||
      !scene_grow(&corners->uvs, sizeof *corners->uvs, at, &corners->uv_capacity) ||
      !scene_grow(&corners->normals, sizeof *corners->normals, at, &corners->normal_capacity))
    return scene_out_of_memory(reader->error, reader->path);
  corners->uvs[at] = corners->normals[at] = absent;
  const char *rest = word;
  trax_status result = read_index(reader, word, &rest, reader->mesh->vertex_count, "vertex", &corners->vertices[at]);
  if (result == TRAX_OK)
    result = read_attribute_index(reader, word, &rest, reader->uvs.count, "texture coordinate", &corners->uvs[at]);
  if (result == TRAX_OK)
    result = read_attribute_index(reader, word, &rest, reader->normals.count, "normal", &corners->normals[at]);
  if (result == TRAX_OK && *rest)
    return fail_here(reader, "not a vertex:", word);
  corners->count++;
  return result;
}

/* corners: numbers in the face. */
static trax_status add_triangle(struct obj_reader *reader, const uint32_t corners[3]) {
  struct trax_mesh *mesh = reader->mesh;
  const struct corner_list *face = &reader->corners;
  const uint32_t number = mesh->triangle_count;
  if (!scene_grow(&mesh->triangles, sizeof *mesh->triangles, number, &reader->triangle_capacity))
    return scene_out_of_memory(reader->error, reader->path);
  mesh->triangles[number] = (struct trax_mesh_triangle){.material = reader->material, .source_id = number};
  for (int i = 0; i < 3; i++) {
    const uint32_t vertex = face->vertices[corners[i]], uv = face->uvs[corners[i]], normal = face->normals[corners[i]];
    mesh->triangles[number].vertices[i] = vertex;
    if (uv != (uint32_t)absent) {
      if (!scene_reach(&mesh->uvs, sizeof *mesh->uvs, number + 1, &reader->uv_capacity))
        return scene_out_of_memory(reader->error, reader->path);
      memcpy(mesh->uvs[number][i], reader->uvs.values[uv], sizeof mesh->uvs[number][i]);
    }
    if (normal != (uint32_t)absent) {
      if (!scene_reach(&mesh->normals, sizeof *mesh->normals, number + 1, &reader->normal_capacity))
        return scene_out_of_memory(reader->error, reader->path);
      memcpy(mesh->normals[number][i], reader->normals.values[normal], sizeof mesh->normals[number][i]);
    }
  }
  mesh->triangle_count++;
  return TRAX_OK;
}

static trax_status read_face(struct obj_reader *reader, char *rest) {
  struct corner_list *corners = &reader->corners;
  corners->count = 0;
  for (const char *word; (word = next_word(&rest));) {
    trax_status result = read_corner(reader, word);
    if (result != TRAX_OK)
      return result;
  }
  if (corners->count < 3)
    return fail_here(reader, "a face needs at least three vertices", NULL);
  if (reader->material == (uint32_t)no_material) {
    if (reader->default_material == (uint32_t)no_material)
      reader->default_material = scene_add_material(&reader->materials, "");
    reader->material = reader->default_material;
    if (reader->material == (uint32_t)no_material)
      return scene_out_of_memory(reader->error, reader->path);
  }
  static const uint32_t in_order[3] = {0, 1, 2};
  if (corners->count == 3)
    return add_triangle(reader, in_order);
  const uint32_t(*triangles)[3];
  const char *problem =
      scene_cut_polygon(&reader->polygon_work, reader->mesh->vertices, corners->vertices, corners->count, &triangles);
  if (problem)
    return fail_here(reader, problem, NULL);
  for (uint32_t i = 0; i + 2 < corners->count; i++) {
    trax_status result = add_triangle(reader, triangles[i]);
    if (result != TRAX_OK)
      return result;
  }
  return TRAX_OK;
}

static trax_status read_statement(struct obj_reader *reader, char *line) {
  const char *keyword = next_word(&line);
  if (!keyword)
    return TRAX_OK;
  if (!strcmp(keyword, "v"))
    return read_vertex(reader, line);
  if (!strcmp(keyword, "vt"))
    return read_attribute(reader, line, &reader->uvs, 1, "a texture coordinate needs a number");
  if (!strcmp(keyword, "vn"))
    return read_attribute(reader, line, &reader->normals, 3, "a normal needs three numbers");
  if (!strcmp(keyword, "f") || !strcmp(keyword, "fo")) /* fo: an older name */
    return read_face(reader, line);
  if (!strcmp(keyword, "usemtl"))
    return use_material(reader, line);
  if (!strcmp(keyword, "mtllib"))
    return read_mtllib(reader, line);
  if (!strcmp(keyword, "l") || !strcmp(keyword, "p"))
    reader->report->other_primitives++;
  return TRAX_OK;
}

/* Attributes reach to the last triangle. */
static bool finish_attributes(struct obj_reader *reader) {
  struct trax_mesh *mesh = reader->mesh;
  return (!mesh->uvs || scene_reach(&mesh->uvs, sizeof *mesh->uvs, mesh->triangle_count, &reader->uv_capacity)) &&
         (!mesh->normals ||
          scene_reach(&mesh->normals, sizeof *mesh->normals, mesh->triangle_count, &reader->normal_capacity));
}

trax_status scene_read_obj(struct trax_mesh *mesh, const char *path, const struct trax_import_options *options,
                           struct trax_import_report *report, trax_error *error) {
  *mesh = (struct trax_mesh){0};
  struct scene_bytes file;
  trax_status result = scene_load_text(&file, path, scene_limits_of(options->unpack_limit), error);
  if (result == TRAX_OK)
    result = check_text(&file, path, error);
  if (result != TRAX_OK)
    return result;
  struct obj_reader reader = {.path = path,
                              .line = 1,
                              .error = error,
                              .mesh = mesh,
                              .material = no_material,
                              .default_material = no_material,
                              .report = report,
                              .materials = {.mesh = mesh},
                              .polygon_work = {.interrupt = options->interrupt},
                              .textures = {.mesh = mesh, .options = options, .report = report}};
  char *text = (char *)file.data, *line;
  for (unsigned lines; result == TRAX_OK && (lines = next_line(&text, &line)) > 0; reader.line += lines)
    result = scene_is_interrupted(options->interrupt) ? TRAX_INTERRUPTED : read_statement(&reader, line);
  if (result == TRAX_OK && mesh->vertex_count == 0)
    result = trax_fail(error, "%s: not a mesh: no vertices in what should be an OBJ file", path);
  if (result == TRAX_OK && mesh->material_count == 0 &&
      scene_add_material(&reader.materials, "") == (uint32_t)no_material)
    result = scene_out_of_memory(error, path);
  if (result == TRAX_OK && !finish_attributes(&reader))
    result = scene_out_of_memory(error, path);
  report->source_triangles += mesh->triangle_count;
  free(file.data);
  free(reader.uvs.values);
  free(reader.normals.values);
  free(reader.corners.vertices);
  free(reader.corners.uvs);
  free(reader.corners.normals);
  scene_textures_release(&reader.textures);
  scene_polygon_work_release(&reader.polygon_work);
  if (result != TRAX_OK)
    trax_mesh_release(mesh);
  return result;
}
