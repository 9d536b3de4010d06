/* The header of a PLY file. */
#include "ply.h"

#include <stdlib.h>
#include <string.h>

trax_status scene_ply_fail(const struct ply_reader *reader, const char *reason) {
  if (!reader->current || reader->format == ascii) {
    unsigned line = 1;
    for (const unsigned char *at = reader->start; at < reader->at && at < reader->end; at++)
      line += *at == '\n';
    return trax_fail(reader->error, "%s:%u: %s", reader->path, line, reason);
  }
  return trax_fail(reader->error, "%s: %s %llu: %s", reader->path, reader->current->name,
                   (unsigned long long)reader->current_number, reason);
}

/* The next word of the header's current line; false at its end. A word longer than any that is known is cut off. */
static bool next_word(struct ply_reader *reader, char word[max_name]) {
  while (*reader->at == ' ' || *reader->at == '\t')
    reader->at++;
  size_t length = 0;
  for (; reader->at < reader->end && *reader->at && !ply_is_space(*reader->at); reader->at++)
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
    return scene_ply_fail(reader, "the format is none of ascii, binary_little_endian, binary_big_endian");
  next_word(reader, word);
  return strcmp(word, "1.0") ? scene_ply_fail(reader, "the format's version is not 1.0") : TRAX_OK;
}

static trax_status read_element(struct ply_reader *reader) {
  if (reader->element_count == max_elements)
    return scene_ply_fail(reader, "too many elements");
  struct element *element = &reader->elements[reader->element_count];
  char count[max_name], *end;
  if (!next_word(reader, element->name) || !next_word(reader, count))
    return scene_ply_fail(reader, "an element needs a name and a count");
  element->count = strtoull(count, &end, 10);
  if (*end || count[0] < '0' || count[0] > '9')
    return scene_ply_fail(reader, "an element's count is not a number");
  if (element->count > UINT32_MAX)
    return scene_ply_fail(reader, "an element's count is too large");
  element->is_vertex = !strcmp(element->name, "vertex");
  element->is_strips = !strcmp(element->name, "tristrips");
  if (element->is_vertex)
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
    return scene_ply_fail(reader, "a property before any element");
  if (reader->property_count == max_properties)
    return scene_ply_fail(reader, "too many properties");
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
      return scene_ply_fail(reader, "the type of a list's length is no integer type");
    next_word(reader, word);
  }
  property->type = parse_type(word);
  if (property->type == no_type)
    return scene_ply_fail(reader, "unknown type of a property");
  if (!next_word(reader, word))
    return scene_ply_fail(reader, "a property without a name");
  property->role = role_of(element->name, word, is_list);
  for (unsigned i = 0; i < element->property_count; i++) /* of two lists of indices, the first is used */
    if (property->role == indices && reader->properties[element->first_property + i].role == indices)
      property->role = skipped;
  if (!strcmp(word, "red") || !strcmp(word, "diffuse_red"))
    reader->unread |= TRAX_UNREAD_COLOURS;
  if (property->role == indices && property->type >= float32)
    return scene_ply_fail(reader, "the type of vertex indices is no integer type");
  reader->property_count++;
  element->property_count++;
  return TRAX_OK;
}

/* The name of a texture in a comment: the rest of the line. */
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
  while (length > 0 && ply_is_space(reader->at[length - 1]))
    length--;
  if (length < sizeof reader->texture) {
    memcpy(reader->texture, reader->at, length);
    reader->texture[length] = 0;
  }
}

/* Checks the header's counts before memory is allocated for them. */
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
    vertices += element->is_vertex;
    if (element->count * least > (uint64_t)(reader->end - reader->at))
      return trax_fail(reader->error, "%s: cut off: too short for the %llu records of '%s' that its header tells of",
                       reader->path, (unsigned long long)element->count, element->name);
  }
  if (vertices > 1)
    return trax_fail(reader->error, "%s: more than one element 'vertex'", reader->path);
  reader->roles = roles;
  if (vertices == 0 || !ply_has_roles(roles, coordinate_x, coordinate_z))
    return trax_fail(reader->error, "%s: no vertices with x, y and z", reader->path);
  if (!(roles & 1u << indices))
    return trax_fail(reader->error, "%s: no faces: neither 'face' nor 'tristrips' has vertex indices", reader->path);
  return TRAX_OK;
}

trax_status scene_ply_header(struct ply_reader *reader) {
  char word[max_name];
  bool has_format = false;
  if (!next_word(reader, word) || strcmp(word, "ply") != 0)
    return trax_fail(reader->error, "%s: not a mesh: no PLY file begins in this way", reader->path);
  for (;;) {
    if (!end_line(reader))
      return scene_ply_fail(reader, "the file ends in its header");
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
      result = scene_ply_fail(reader, "unknown keyword in the header");
    if (result != TRAX_OK)
      return result;
  }
  if (!has_format)
    return scene_ply_fail(reader, "the header has no format");
  end_line(reader);
  return check_elements(reader);
}
