/* Wavefront OBJ with its material libraries. Read here and not by assimp, whose OBJ reader (5.2) silently leaves out a
   vertex such as "v .5 0 0" and counts the following ones wrongly; and so that an error names its line.

   Read: v, f (absolute and relative indices, any polygon), usemtl, mtllib; of a library newmtl and Kd with three
   numbers. Counted as other primitives: p, l. What concerns texture, normals, grouping, smoothing and free-form
   surfaces is skipped. A line may be continued by a final backslash. */
#include "internal.h"

#include <stdlib.h>
#include <string.h>

enum { no_material = UINT32_MAX };

struct corner_list {
  uint32_t *vertices;
  uint32_t count, capacity;
};

struct obj_reader {
  const char *path;
  unsigned line;
  trax_error *error;
  struct trax_mesh *mesh;
  size_t vertex_capacity, triangle_capacity, material_capacity;
  struct corner_list corners; /* of the face being read */
  struct scene_polygon_work polygon_work;
  uint32_t material;         /* current */
  uint32_t default_material; /* no_material until one is needed */
  struct trax_import_report *report;
};

/* --- text --- */

static bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

static char *skip_blanks(char *at) {
  while (is_blank(*at))
    at++;
  return at;
}

/* Cuts the next word off *rest; NULL at the end of the line or at a comment. */
static char *next_word(char **rest) {
  char *word = skip_blanks(*rest);
  if (!*word || *word == '#')
    return NULL;
  char *end = word;
  while (*end && !is_blank(*end))
    end++;
  if (*end)
    *end++ = 0;
  *rest = end;
  return word;
}

/* What is left of the line without blanks around it: a name, which may hold spaces and '#'. */
static char *remainder_of(char *rest) {
  rest = skip_blanks(rest);
  size_t length = strlen(rest);
  while (length > 0 && is_blank(rest[length - 1]))
    rest[--length] = 0;
  return rest;
}

/* Takes a logical line from *text, NUL-terminated in place, and returns how many physical ones it took; 0 at the end.
 */
static unsigned next_line(char **text, char **line) {
  char *from = *text, *to = *text;
  if (!*from)
    return 0;
  *line = to;
  unsigned lines = 1;
  for (; *from && *from != '\n'; from++) {
    if (*from == '\\' && (from[1] == '\n' || (from[1] == '\r' && from[2] == '\n'))) {
      from += from[1] == '\r' ? 2 : 1;
      *to++ = ' ';
      lines++;
      continue;
    }
    *to++ = *from;
  }
  *text = *from ? from + 1 : from;
  *to = 0;
  return lines;
}

static trax_status fail_here(const struct obj_reader *reader, const char *reason, const char *what) {
  return scene_fail(reader->error, "%s:%u: %s%s%.100s%s", reader->path, reader->line, reason, what ? " '" : "",
                    what ? what : "", what ? "'" : "");
}

static bool parse_float(const char *word, float *value) {
  char *end;
  *value = strtof(word, &end);
  return end != word && !*end;
}

/* A text file holds no NUL; releases the bytes on failure. */
static trax_status check_text(struct scene_bytes *file, const char *path, trax_error *error) {
  if (!memchr(file->data, 0, file->size))
    return TRAX_OK;
  free(file->data);
  return scene_fail(error, "%s: not a mesh: binary data where text should be", path);
}

/* --- materials --- */

static uint32_t find_material(const struct obj_reader *reader, const char *name) {
  char cut[sizeof reader->mesh->materials->name] = {0};
  memcpy(cut, name, strnlen(name, sizeof cut - 1));
  for (uint32_t i = 0; i < reader->mesh->material_count; i++)
    if (!strcmp(reader->mesh->materials[i].name, cut))
      return i;
  return no_material;
}

static uint32_t add_material(struct obj_reader *reader, const char *name) {
  struct trax_mesh *mesh = reader->mesh;
  if (!scene_grow(&mesh->materials, sizeof *mesh->materials, mesh->material_count, &reader->material_capacity))
    return no_material;
  struct trax_mesh_material *material = &mesh->materials[mesh->material_count];
  *material = (struct trax_mesh_material){.surface = trax_default_material};
  memcpy(material->name, name, strnlen(name, sizeof material->name - 1));
  return mesh->material_count++;
}

static trax_status read_kd(struct obj_reader *library, char *rest) {
  char *words[3];
  for (int i = 0; i < 3; i++)
    words[i] = next_word(&rest);
  if (library->material == (uint32_t)no_material)
    return fail_here(library, "Kd before any newmtl", NULL);
  if (!words[0])
    return fail_here(library, "Kd without a colour", NULL);
  if (!strcmp(words[0], "spectral") || !strcmp(words[0], "xyz"))
    return TRAX_OK; /* stays grey */
  float *diffuse = library->mesh->materials[library->material].surface.diffuse;
  for (int i = 0; i < 3; i++) {
    const char *word = words[i] ? words[i] : words[0]; /* one number stands for three */
    float value;
    if (!parse_float(word, &value))
      return fail_here(library, "Kd: not a number:", word);
    diffuse[i] = scene_clamp_colour(value);
  }
  return TRAX_OK;
}

static trax_status read_library(struct obj_reader *reader, const char *path) {
  struct scene_bytes file;
  if (scene_load_text(&file, path, NULL) != TRAX_OK) {
    if (reader->report->missing_files++ == 0)
      snprintf(reader->report->first_missing_file, sizeof reader->report->first_missing_file, "%s", path);
    return TRAX_OK;
  }
  trax_status result = check_text(&file, path, reader->error);
  if (result != TRAX_OK)
    return result;
  struct obj_reader library = *reader;
  library.path = path;
  library.line = 1;
  library.material = no_material;
  char *text = (char *)file.data, *line;
  for (unsigned lines; result == TRAX_OK && (lines = next_line(&text, &line)) > 0; library.line += lines) {
    const char *keyword = next_word(&line);
    if (!keyword)
      continue;
    if (!strcmp(keyword, "newmtl")) {
      const char *name = remainder_of(line);
      library.material = find_material(&library, name);
      if (library.material == (uint32_t)no_material)
        library.material = add_material(&library, name);
      if (library.material == (uint32_t)no_material)
        result = scene_out_of_memory(reader->error, path);
    } else if (!strcmp(keyword, "Kd"))
      result = read_kd(&library, line);
  }
  free(file.data);
  reader->material_capacity = library.material_capacity;
  return result;
}

/* mtllib: one file, relative to the OBJ file; its name may hold spaces. */
static trax_status read_mtllib(struct obj_reader *reader, char *rest) {
  const char *slash = strrchr(reader->path, '/');
  int directory = slash ? (int)(slash - reader->path) + 1 : 0;
  const char *name = remainder_of(rest);
  while (!strncmp(name, "./", 2))
    name += 2;
  if (!*name)
    return fail_here(reader, "mtllib without a name", NULL);
  size_t length = (size_t)directory + strlen(name) + 1;
  char *path = malloc(length);
  if (!path)
    return scene_out_of_memory(reader->error, reader->path);
  snprintf(path, length, "%.*s%s", name[0] == '/' ? 0 : directory, reader->path, name);
  trax_status result = read_library(reader, path);
  free(path);
  return result;
}

static trax_status use_material(struct obj_reader *reader, char *rest) {
  const char *name = remainder_of(rest);
  reader->material = find_material(reader, name);
  if (reader->material == (uint32_t)no_material)
    reader->material = add_material(reader, name);
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
  mesh->vertex_count++;
  return TRAX_OK;
}

/* "7", "7/1", "7//3" or "7/1/3", from 1; negative counts back from the last vertex so far. */
static trax_status read_corner(struct obj_reader *reader, const char *word, uint32_t *vertex) {
  char *end;
  long long index = strtoll(word, &end, 10);
  if (end == word || (*end && *end != '/') || index == 0)
    return fail_here(reader, "not a vertex index:", word);
  uint32_t count = reader->mesh->vertex_count;
  long long from_zero = index > 0 ? index - 1 : count + index;
  if (from_zero < 0 || from_zero >= count)
    return scene_fail(reader->error, "%s:%u: vertex index %.40s is out of range (%u vertices so far)", reader->path,
                      reader->line, word, count);
  *vertex = (uint32_t)from_zero;
  return TRAX_OK;
}

static trax_status add_triangle(struct obj_reader *reader, const uint32_t vertices[3]) {
  struct trax_mesh *mesh = reader->mesh;
  if (!scene_grow(&mesh->triangles, sizeof *mesh->triangles, mesh->triangle_count, &reader->triangle_capacity))
    return scene_out_of_memory(reader->error, reader->path);
  mesh->triangles[mesh->triangle_count] =
      (struct trax_mesh_triangle){.vertices = {vertices[0], vertices[1], vertices[2]},
                                  .material = reader->material,
                                  .source_id = mesh->triangle_count};
  mesh->triangle_count++;
  return TRAX_OK;
}

static trax_status read_face(struct obj_reader *reader, char *rest) {
  struct corner_list *corners = &reader->corners;
  corners->count = 0;
  for (const char *word; (word = next_word(&rest));) {
    size_t capacity = corners->capacity;
    if (!scene_grow(&corners->vertices, sizeof *corners->vertices, corners->count, &capacity))
      return scene_out_of_memory(reader->error, reader->path);
    corners->capacity = (uint32_t)capacity;
    trax_status result = read_corner(reader, word, &corners->vertices[corners->count]);
    if (result != TRAX_OK)
      return result;
    corners->count++;
  }
  if (corners->count < 3)
    return fail_here(reader, "a face needs at least three vertices", NULL);
  if (reader->material == (uint32_t)no_material) {
    if (reader->default_material == (uint32_t)no_material)
      reader->default_material = add_material(reader, "");
    reader->material = reader->default_material;
    if (reader->material == (uint32_t)no_material)
      return scene_out_of_memory(reader->error, reader->path);
  }
  if (corners->count == 3)
    return add_triangle(reader, corners->vertices);
  const uint32_t(*triangles)[3];
  if (!scene_cut_polygon(&reader->polygon_work, reader->mesh->vertices, corners->vertices, corners->count, &triangles))
    return scene_out_of_memory(reader->error, reader->path);
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

trax_status scene_read_obj(struct trax_mesh *mesh, const char *path, struct trax_import_report *report,
                           trax_error *error) {
  *mesh = (struct trax_mesh){0};
  struct scene_bytes file;
  trax_status result = scene_load_text(&file, path, error);
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
                              .report = report};
  char *text = (char *)file.data, *line;
  for (unsigned lines; result == TRAX_OK && (lines = next_line(&text, &line)) > 0; reader.line += lines)
    result = read_statement(&reader, line);
  if (result == TRAX_OK && mesh->vertex_count == 0)
    result = scene_fail(error, "%s: not a mesh: no vertices in what should be an OBJ file", path);
  if (result == TRAX_OK && mesh->material_count == 0 && add_material(&reader, "") == (uint32_t)no_material)
    result = scene_out_of_memory(error, path);
  report->source_triangles += mesh->triangle_count;
  free(file.data);
  free(reader.corners.vertices);
  scene_polygon_work_release(&reader.polygon_work);
  if (result != TRAX_OK)
    trax_mesh_release(mesh);
  return result;
}
