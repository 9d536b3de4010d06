/* Stanford PLY, ASCII and binary of either byte order. Read here and not by assimp, whose PLY reader (5.2) crashes or
   never ends on damaged files; and so that an error names its place.

   Read: of "vertex" the coordinates x, y, z, the normal nx, ny, nz and the texture coordinates u, v or s, t; the
   polygons vertex_indices (or vertex_index) of "face" and the strips of "tristrips", in which -1 begins a new strip;
   the one texture that a comment names, as "comment TextureFile bunny.png". Everything else is skipped. */
#include "internal.h"

#include <stdlib.h>
#include <string.h>

enum format { ascii, little_endian, big_endian };

enum type { no_type, int8, uint8, int16, uint16, int32, uint32, float32, float64 };

static const unsigned char type_sizes[] = {0, 1, 1, 2, 2, 4, 4, 4, 8};

enum { max_elements = 32, max_properties = 256, max_name = 32 };

/* What a property is to us. */
enum role {
  skipped,
  coordinate_x,
  coordinate_y,
  coordinate_z,
  normal_x,
  normal_y,
  normal_z,
  texture_u,
  texture_v,
  indices
};

enum { per_vertex = texture_v - coordinate_x + 1 }; /* the roles that are numbers of a vertex */

static bool has_roles(unsigned roles, enum role first, enum role last) {
  for (enum role role = first; role <= last; role++)
    if (!(roles >> role & 1))
      return false;
  return true;
}

struct property {
  enum type list_count, type; /* list_count: no_type for a single value */
  enum role role;
};

struct element {
  char name[max_name];
  uint64_t count;
  unsigned first_property, property_count;
};

struct ply_reader {
  const char *path;
  trax_error *error;
  struct trax_mesh *mesh;
  const unsigned char *start, *at, *end; /* *end is 0 */
  enum format format;
  struct element elements[max_elements];
  unsigned element_count;
  struct property properties[max_properties];
  unsigned property_count;
  const struct element *current; /* being read, its number, for messages */
  uint64_t current_number;
  uint32_t vertex_count; /* as declared */
  unsigned roles;        /* 1 << role: there is one */
  float (*normals)[3];   /* of the vertices; NULL: there are none */
  float (*uvs)[2];
  char texture[256]; /* "": none */
  unsigned unread;   /* as the report has it */
  size_t triangle_capacity, normal_capacity, uv_capacity;
  uint32_t *list; /* the indices of one face or strip */
  size_t list_capacity;
  struct scene_polygon_work polygon_work;
};

/* FILE:LINE: in text, FILE: ELEMENT NUMBER: in binary data. */
static trax_status fail_here(const struct ply_reader *reader, const char *reason) {
  if (!reader->current || reader->format == ascii) {
    unsigned line = 1;
    for (const unsigned char *at = reader->start; at < reader->at && at < reader->end; at++)
      line += *at == '\n';
    return trax_fail(reader->error, "%s:%u: %s", reader->path, line, reason);
  }
  return trax_fail(reader->error, "%s: %s %llu: %s", reader->path, reader->current->name,
                   (unsigned long long)reader->current_number, reason);
}

/* --- header --- */

static bool is_space(unsigned char c) {
  return c == ' ' || (c >= '\t' && c <= '\r');
}

/* The next word of the header's current line; false at its end or if the word is too long to mean anything. */
static bool next_word(struct ply_reader *reader, char word[max_name]) {
  while (*reader->at == ' ' || *reader->at == '\t')
    reader->at++;
  size_t length = 0;
  for (; reader->at < reader->end && *reader->at && !is_space(*reader->at); reader->at++)
    if (length < max_name)
      word[length++] = (char)*reader->at;
  word[length < max_name ? length : max_name - 1] = 0;
  return length > 0;
}

/* Moves behind the end of the line; "\n", "\r\n" or, in old files, "\r". */
static bool end_line(struct ply_reader *reader) {
  while (reader->at < reader->end && *reader->at != '\n' && *reader->at != '\r')
    reader->at++;
  if (reader->at == reader->end)
    return false;
  if (*reader->at == '\r' && reader->at[1] == '\n')
    reader->at++;
  reader->at++;
  return true;
}

static enum type parse_type(const char *word) {
  static const struct {
    const char *name;
    enum type type;
  } names[] = {{"char", int8},     {"int8", int8},       {"uchar", uint8},    {"uint8", uint8},
               {"short", int16},   {"int16", int16},     {"ushort", uint16},  {"uint16", uint16},
               {"int", int32},     {"int32", int32},     {"uint", uint32},    {"uint32", uint32},
               {"float", float32}, {"float32", float32}, {"double", float64}, {"float64", float64}};
  for (size_t i = 0; i < sizeof names / sizeof names[0]; i++)
    if (!strcmp(word, names[i].name))
      return names[i].type;
  return no_type;
}

static trax_status read_format(struct ply_reader *reader) {
  char word[max_name];
  next_word(reader, word);
  if (!strcmp(word, "ascii"))
    reader->format = ascii;
  else if (!strcmp(word, "binary_little_endian"))
    reader->format = little_endian;
  else if (!strcmp(word, "binary_big_endian"))
    reader->format = big_endian;
  else
    return fail_here(reader, "the format is none of ascii, binary_little_endian, binary_big_endian");
  next_word(reader, word);
  return strcmp(word, "1.0") ? fail_here(reader, "the format's version is not 1.0") : TRAX_OK;
}

static trax_status read_element(struct ply_reader *reader) {
  if (reader->element_count == max_elements)
    return fail_here(reader, "too many elements");
  struct element *element = &reader->elements[reader->element_count];
  char count[max_name], *end;
  if (!next_word(reader, element->name) || !next_word(reader, count))
    return fail_here(reader, "an element needs a name and a count");
  element->count = strtoull(count, &end, 10);
  if (*end || count[0] < '0' || count[0] > '9')
    return fail_here(reader, "an element's count is not a number");
  if (element->count > UINT32_MAX)
    return fail_here(reader, "an element's count is too large");
  if (!strcmp(element->name, "vertex"))
    reader->vertex_count = (uint32_t)element->count;
  element->first_property = reader->property_count;
  element->property_count = 0;
  reader->element_count++;
  return TRAX_OK;
}

static enum role role_of(const char *element, const char *name, bool is_list) {
  static const struct {
    const char *name;
    enum role role;
  } of_vertex[] = {{"x", coordinate_x}, {"y", coordinate_y}, {"z", coordinate_z},      {"nx", normal_x},
                   {"ny", normal_y},    {"nz", normal_z},    {"u", texture_u},         {"v", texture_v},
                   {"s", texture_u},    {"t", texture_v},    {"texture_u", texture_u}, {"texture_v", texture_v}};
  for (size_t i = 0; !is_list && !strcmp(element, "vertex") && i < sizeof of_vertex / sizeof *of_vertex; i++)
    if (!strcmp(name, of_vertex[i].name))
      return of_vertex[i].role;
  if ((!strcmp(element, "face") || !strcmp(element, "tristrips")) && is_list &&
      (!strcmp(name, "vertex_indices") || !strcmp(name, "vertex_index")))
    return indices;
  return skipped;
}

static trax_status read_property(struct ply_reader *reader) {
  if (reader->element_count == 0)
    return fail_here(reader, "a property before any element");
  if (reader->property_count == max_properties)
    return fail_here(reader, "too many properties");
  struct element *element = &reader->elements[reader->element_count - 1];
  struct property *property = &reader->properties[reader->property_count];
  *property = (struct property){0};
  char word[max_name];
  next_word(reader, word);
  bool is_list = !strcmp(word, "list");
  if (is_list) {
    next_word(reader, word);
    property->list_count = parse_type(word);
    if (property->list_count == no_type || property->list_count >= float32)
      return fail_here(reader, "the type of a list's length is no integer type");
    next_word(reader, word);
  }
  property->type = parse_type(word);
  if (property->type == no_type)
    return fail_here(reader, "unknown type of a property");
  if (!next_word(reader, word))
    return fail_here(reader, "a property without a name");
  property->role = role_of(element->name, word, is_list);
  if (!strcmp(word, "red") || !strcmp(word, "diffuse_red"))
    reader->unread |= TRAX_UNREAD_COLOURS;
  if (property->role == indices && property->type >= float32)
    return fail_here(reader, "the type of vertex indices is no integer type");
  reader->property_count++;
  element->property_count++;
  return TRAX_OK;
}

/* What a comment names as texture: the rest of the line. */
static void read_comment(struct ply_reader *reader) {
  char word[max_name];
  if (!next_word(reader, word) || strcmp(word, "TextureFile") != 0)
    return;
  while (*reader->at == ' ' || *reader->at == '\t')
    reader->at++;
  size_t length = 0;
  while (reader->at + length < reader->end && reader->at[length] && reader->at[length] != '\n' &&
         reader->at[length] != '\r')
    length++;
  while (length > 0 && is_space(reader->at[length - 1]))
    length--;
  if (length < sizeof reader->texture) {
    memcpy(reader->texture, reader->at, length);
    reader->texture[length] = 0;
  }
}

static trax_status read_header(struct ply_reader *reader) {
  char word[max_name];
  bool has_format = false;
  if (!next_word(reader, word) || strcmp(word, "ply") != 0)
    return trax_fail(reader->error, "%s: not a mesh: no PLY file begins in this way", reader->path);
  for (;;) {
    if (!end_line(reader))
      return fail_here(reader, "the file ends in its header");
    trax_status result = TRAX_OK;
    if (!next_word(reader, word) || !strcmp(word, "obj_info"))
      continue;
    if (!strcmp(word, "comment")) {
      read_comment(reader);
      continue;
    }
    if (!strcmp(word, "end_header"))
      break;
    if (!strcmp(word, "format")) {
      result = read_format(reader);
      has_format = true;
    } else if (!strcmp(word, "element"))
      result = read_element(reader);
    else if (!strcmp(word, "property"))
      result = read_property(reader);
    else
      result = fail_here(reader, "unknown keyword in the header");
    if (result != TRAX_OK)
      return result;
  }
  if (!has_format)
    return fail_here(reader, "the header has no format");
  end_line(reader);
  return TRAX_OK;
}

/* --- values --- */

/* In ASCII: to the next value; false at the end of the file. */
static bool to_value(struct ply_reader *reader) {
  while (is_space(*reader->at))
    reader->at++;
  return reader->at < reader->end;
}

static bool value_ends(const struct ply_reader *reader, const char *end) {
  return (const unsigned char *)end > reader->at &&
         (is_space((unsigned char)*end) || (const unsigned char *)end == reader->end);
}

/* The bytes of a binary value, least significant first; false if the file ends. */
static bool take_bytes(struct ply_reader *reader, enum type type, unsigned char bytes[8]) {
  size_t size = type_sizes[type];
  if ((size_t)(reader->end - reader->at) < size)
    return false;
  for (size_t i = 0; i < size; i++)
    bytes[i] = reader->at[reader->format == big_endian ? size - 1 - i : i];
  reader->at += size;
  return true;
}

static trax_status read_integer(struct ply_reader *reader, enum type type, int64_t *value) {
  if (reader->format == ascii) {
    if (!to_value(reader))
      return fail_here(reader, "the file ends too early");
    char *end;
    *value = strtoll((const char *)reader->at, &end, 10);
    if (!value_ends(reader, end))
      return fail_here(reader, "not an integer");
    reader->at = (const unsigned char *)end;
    return TRAX_OK;
  }
  unsigned char bytes[8] = {0};
  if (!take_bytes(reader, type, bytes))
    return fail_here(reader, "the file ends too early");
  uint32_t word = bytes[0];
  for (unsigned i = 1; i < type_sizes[type]; i++)
    word |= (uint32_t)bytes[i] << 8 * i;
  *value = type == int8 ? (int8_t)word : type == int16 ? (int16_t)word : type == int32 ? (int32_t)word : (int64_t)word;
  return TRAX_OK;
}

static trax_status read_real(struct ply_reader *reader, enum type type, float *value) {
  if (reader->format == ascii) {
    if (!to_value(reader))
      return fail_here(reader, "the file ends too early");
    char *end;
    *value = strtof((const char *)reader->at, &end);
    if (!value_ends(reader, end))
      return fail_here(reader, "not a number");
    reader->at = (const unsigned char *)end;
    return TRAX_OK;
  }
  if (type < float32) {
    int64_t integer;
    trax_status result = read_integer(reader, type, &integer);
    *value = (float)integer;
    return result;
  }
  unsigned char bytes[8] = {0};
  if (!take_bytes(reader, type, bytes))
    return fail_here(reader, "the file ends too early");
  if (type == float32)
    memcpy(value, bytes, sizeof *value);
  else {
    double wide;
    memcpy(&wide, bytes, sizeof wide);
    *value = (float)wide;
  }
  return TRAX_OK;
}

static trax_status skip_value(struct ply_reader *reader, enum type type) {
  float ignored;
  return read_real(reader, type, &ignored);
}

/* --- elements --- */

static trax_status add_triangle(struct ply_reader *reader, uint32_t a, uint32_t b, uint32_t c) {
  struct trax_mesh *mesh = reader->mesh;
  if (!scene_grow(&mesh->triangles, sizeof *mesh->triangles, mesh->triangle_count, &reader->triangle_capacity))
    return scene_out_of_memory(reader->error, reader->path);
  const uint32_t number = mesh->triangle_count, vertices[3] = {a, b, c};
  mesh->triangles[number] = (struct trax_mesh_triangle){.vertices = {a, b, c}, .source_id = number};
  if ((reader->normals && !scene_reach(&mesh->normals, sizeof *mesh->normals, number + 1, &reader->normal_capacity)) ||
      (reader->uvs && !scene_reach(&mesh->uvs, sizeof *mesh->uvs, number + 1, &reader->uv_capacity)))
    return scene_out_of_memory(reader->error, reader->path);
  for (int corner = 0; corner < 3; corner++) {
    if (reader->normals)
      memcpy(mesh->normals[number][corner], reader->normals[vertices[corner]], sizeof *reader->normals);
    if (reader->uvs)
      memcpy(mesh->uvs[number][corner], reader->uvs[vertices[corner]], sizeof *reader->uvs);
  }
  mesh->triangle_count++;
  return TRAX_OK;
}

static trax_status add_face(struct ply_reader *reader, uint32_t count) {
  if (count < 3)
    return fail_here(reader, "a face needs at least three vertices");
  const uint32_t *list = reader->list;
  if (count == 3)
    return add_triangle(reader, list[0], list[1], list[2]);
  const uint32_t(*triangles)[3];
  const char *problem = scene_cut_polygon(&reader->polygon_work, reader->mesh->vertices, list, count, &triangles);
  if (problem)
    return fail_here(reader, problem);
  trax_status result = TRAX_OK;
  for (uint32_t i = 0; i + 2 < count && result == TRAX_OK; i++)
    result = add_triangle(reader, list[triangles[i][0]], list[triangles[i][1]], list[triangles[i][2]]);
  return result;
}

enum { strip_break = UINT32_MAX };

/* Every vertex from the third on makes a triangle with the two before it, every second one turned. */
static trax_status add_strips(struct ply_reader *reader, uint32_t count) {
  trax_status result = TRAX_OK;
  uint32_t begin = 0;
  for (uint32_t i = 0; i < count && result == TRAX_OK; i++) {
    const uint32_t *last = &reader->list[i];
    if (*last == (uint32_t)strip_break)
      begin = i + 1;
    else if (i >= begin + 2)
      result = (i - begin) % 2 ? add_triangle(reader, last[-1], last[-2], last[0])
                               : add_triangle(reader, last[-2], last[-1], last[0]);
  }
  return result;
}

static trax_status read_indices(struct ply_reader *reader, const struct property *property, int64_t count) {
  bool strips = !strcmp(reader->current->name, "tristrips");
  trax_status result = TRAX_OK;
  for (int64_t i = 0; i < count && result == TRAX_OK; i++) {
    int64_t index;
    result = read_integer(reader, property->type, &index);
    if (result != TRAX_OK)
      break;
    if (!scene_grow(&reader->list, sizeof *reader->list, (uint32_t)i, &reader->list_capacity))
      return scene_out_of_memory(reader->error, reader->path);
    if (strips && index == -1)
      index = strip_break;
    else if (index < 0 || index >= reader->vertex_count) {
      char reason[128];
      snprintf(reason, sizeof reason, "vertex index %lld is out of range (%u vertices)", (long long)index,
               reader->vertex_count);
      return fail_here(reader, reason);
    }
    reader->list[i] = (uint32_t)index;
  }
  if (result != TRAX_OK)
    return result;
  if (reader->mesh->vertex_count != reader->vertex_count)
    return fail_here(reader, "faces before the vertices are not supported");
  return strips ? add_strips(reader, (uint32_t)count) : add_face(reader, (uint32_t)count);
}

static trax_status read_list(struct ply_reader *reader, const struct property *property) {
  int64_t count;
  trax_status result = read_integer(reader, property->list_count, &count);
  if (result != TRAX_OK)
    return result;
  /* Every value takes a byte at least: nothing is allocated for a count that the file cannot hold. */
  if (count < 0 || count > reader->end - reader->at)
    return fail_here(reader, count < 0 ? "a list's length is negative" : "a list is longer than the file");
  if (property->role == indices)
    return read_indices(reader, property, count);
  for (int64_t i = 0; i < count && result == TRAX_OK; i++)
    result = skip_value(reader, property->type);
  return result;
}

static trax_status read_record(struct ply_reader *reader, const struct element *element) {
  float values[per_vertex] = {0}; /* by role, from coordinate_x */
  trax_status result = TRAX_OK;
  for (unsigned i = 0; i < element->property_count && result == TRAX_OK; i++) {
    const struct property *property = &reader->properties[element->first_property + i];
    if (property->list_count)
      result = read_list(reader, property);
    else if (property->role >= coordinate_x && property->role <= texture_v)
      result = read_real(reader, property->type, &values[property->role - coordinate_x]);
    else
      result = skip_value(reader, property->type);
  }
  if (result != TRAX_OK)
    return result;
  if (!strcmp(element->name, "vertex")) {
    const uint32_t number = reader->mesh->vertex_count++;
    memcpy(reader->mesh->vertices[number], values, sizeof *reader->mesh->vertices);
    if (reader->normals)
      memcpy(reader->normals[number], &values[normal_x - coordinate_x], sizeof *reader->normals);
    if (reader->uvs)
      memcpy(reader->uvs[number], &values[texture_u - coordinate_x], sizeof *reader->uvs);
  }
  if (reader->format == ascii) {
    while (*reader->at == ' ' || *reader->at == '\t')
      reader->at++;
    if (reader->at < reader->end && *reader->at != '\n' && *reader->at != '\r')
      return fail_here(reader, "more values than the header says");
  }
  return TRAX_OK;
}

/* The header's promises, before anything is allocated for them. */
static trax_status check_elements(struct ply_reader *reader) {
  unsigned vertices = 0, roles = 0;
  for (unsigned e = 0; e < reader->element_count; e++) {
    const struct element *element = &reader->elements[e];
    uint64_t least = 0; /* bytes of a record */
    for (unsigned i = 0; i < element->property_count; i++) {
      const struct property *property = &reader->properties[element->first_property + i];
      least += reader->format == ascii ? 1 : type_sizes[property->list_count ? property->list_count : property->type];
      roles |= 1u << property->role;
    }
    vertices += !strcmp(element->name, "vertex");
    if (element->count * least > (uint64_t)(reader->end - reader->at))
      return trax_fail(reader->error, "%s: cut off: too short for the %llu records of '%s' that its header tells of",
                       reader->path, (unsigned long long)element->count, element->name);
  }
  if (vertices > 1)
    return trax_fail(reader->error, "%s: more than one element 'vertex'", reader->path);
  reader->roles = roles;
  if (vertices == 0 || !has_roles(roles, coordinate_x, coordinate_z))
    return trax_fail(reader->error, "%s: no vertices with x, y and z", reader->path);
  if (!(roles & 1u << indices))
    return trax_fail(reader->error, "%s: no faces: neither 'face' nor 'tristrips' has vertex indices", reader->path);
  return TRAX_OK;
}

static trax_status read_elements(struct ply_reader *reader) {
  for (unsigned e = 0; e < reader->element_count; e++) {
    const struct element *element = &reader->elements[e];
    if (element->property_count == 0)
      continue;
    reader->current = element;
    for (reader->current_number = 0; reader->current_number < element->count; reader->current_number++) {
      trax_status result = read_record(reader, element);
      if (result != TRAX_OK)
        return result;
    }
  }
  return TRAX_OK;
}

/* The vertices' arrays, the one material and its texture. */
static trax_status prepare(struct ply_reader *reader, const struct trax_import_options *options,
                           struct trax_import_report *report) {
  struct trax_mesh *mesh = reader->mesh;
  const size_t count = (size_t)reader->vertex_count + 1;
  const bool normals = has_roles(reader->roles, normal_x, normal_z),
             uvs = has_roles(reader->roles, texture_u, texture_v);
  mesh->vertices = malloc(count * sizeof *mesh->vertices);
  mesh->materials = calloc(1, sizeof *mesh->materials);
  if (normals)
    reader->normals = malloc(count * sizeof *reader->normals);
  if (uvs)
    reader->uvs = malloc(count * sizeof *reader->uvs);
  if (!mesh->vertices || !mesh->materials || (normals && !reader->normals) || (uvs && !reader->uvs))
    return scene_out_of_memory(reader->error, reader->path);
  mesh->materials[0].surface = trax_default_material;
  mesh->material_count = 1;
  if (!uvs || !reader->texture[0])
    return TRAX_OK;
  struct scene_textures textures = {.mesh = mesh, .options = options, .report = report};
  const struct scene_texture wanted = {.base = reader->texture}, *texture;
  trax_status result = scene_find_texture(&textures, &wanted, reader->path, &texture, reader->error);
  if (result == TRAX_OK && texture->good) {
    mesh->materials[0].surface.texture = texture->number;
    for (int channel = 0; channel < 3; channel++)
      mesh->materials[0].surface.diffuse[channel] = 1;
  }
  scene_textures_release(&textures);
  return result;
}

trax_status scene_read_ply(struct trax_mesh *mesh, const char *path, const struct trax_import_options *options,
                           struct trax_import_report *report, trax_error *error) {
  *mesh = (struct trax_mesh){0};
  struct scene_bytes file;
  trax_status result = scene_load_text(&file, path, scene_limits_of(options->unpack_limit), error);
  if (result != TRAX_OK)
    return result;
  struct ply_reader *reader = calloc(1, sizeof *reader);
  if (!reader) {
    free(file.data);
    return scene_out_of_memory(error, path);
  }
  reader->path = path;
  reader->error = error;
  reader->mesh = mesh;
  reader->start = reader->at = file.data;
  reader->end = file.data + file.size;
  result = read_header(reader);
  if (result == TRAX_OK)
    result = check_elements(reader);
  if (result == TRAX_OK)
    result = prepare(reader, options, report);
  if (result == TRAX_OK)
    result = read_elements(reader);
  report->source_triangles += mesh->triangle_count;
  report->unread |= reader->unread;
  free(reader->list);
  free(reader->normals);
  free(reader->uvs);
  scene_polygon_work_release(&reader->polygon_work);
  free(reader);
  free(file.data);
  if (result != TRAX_OK)
    trax_mesh_release(mesh);
  return result;
}
