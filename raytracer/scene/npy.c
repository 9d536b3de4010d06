#include "npy.h"

#include "trax/output.h"

#include <ctype.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

/* The header is a Python dictionary of the keys descr, fortran_order and shape. */
struct header {
  const char *at, *end, *begin;
  const char *path;
  size_t before; /* bytes of the file before it */
  bool fortran;
};

static trax_status wrong(const struct header *header, const char *expected, trax_error *error) {
  return trax_fail(error, "%s: byte %zu: the header of an array (.npy) has %s here", header->path,
                   header->before + (size_t)(header->at - header->begin), expected);
}

static void skip_space(struct header *header) {
  while (header->at < header->end && (*header->at == ' ' || *header->at == '\n'))
    header->at++;
}

/* Takes the character and space around it. */
static bool take(struct header *header, char character) {
  skip_space(header);
  if (header->at == header->end || *header->at != character)
    return false;
  header->at++;
  skip_space(header);
  return true;
}

static bool take_word(struct header *header, const char *word) {
  const size_t length = strlen(word);
  if ((size_t)(header->end - header->at) < length || memcmp(header->at, word, length) != 0)
    return false;
  header->at += length;
  return true;
}

/* A string of at most 15 characters. */
static bool take_string(struct header *header, char text[16]) {
  const char quote = header->at < header->end ? *header->at : 0;
  if (quote != '\'' && quote != '"')
    return false;
  const char *begin = header->at + 1, *end = memchr(begin, quote, (size_t)(header->end - begin));
  if (!end || end - begin > 15)
    return false;
  memcpy(text, begin, (size_t)(end - begin));
  text[end - begin] = 0;
  header->at = end + 1;
  return true;
}

static trax_status take_type(struct scene_npy *npy, struct header *header, enum scene_npy_kind kind,
                             trax_error *error) {
  char type[16] = {0};
  if (!take_string(header, type))
    return wrong(header, "the type of the elements, as '<i4',", error);
  npy->is_float = strcmp(type, "<f4") == 0;
  npy->is_signed = type[1] == 'i';
  npy->item = type[0] && type[1] ? (unsigned)(type[2] - '0') : 0;
  const bool is_integer =
      type[0] == '<' && (type[1] == 'i' || type[1] == 'u') && (npy->item == 4 || npy->item == 8) && !type[3];
  if (kind == SCENE_NPY_FLOATS ? npy->is_float : is_integer)
    return TRAX_OK;
  return trax_fail(error, "%s: the elements are '%s', not %s", npy->path, type,
                   kind == SCENE_NPY_FLOATS ? "'<f4' (numpy: .astype('<f4'))" : "'<i4', '<u4', '<i8' or '<u8'");
}

static trax_status take_shape(struct scene_npy *npy, struct header *header, trax_error *error) {
  npy->dimensions = 0;
  npy->count = 1;
  if (!take(header, '('))
    return wrong(header, "the shape, as (12, 3),", error);
  while (!take(header, ')')) {
    uint64_t size = 0;
    const char *first = header->at;
    for (; header->at < header->end && isdigit((unsigned char)*header->at) && header->at - first < 18; header->at++)
      size = 10 * size + (uint64_t)(*header->at - '0');
    if (header->at == first)
      return wrong(header, "a length of the shape", error);
    if (npy->dimensions == SCENE_NPY_DIMENSIONS)
      return trax_fail(error, "%s: the array has more than %d dimensions", npy->path, SCENE_NPY_DIMENSIONS);
    npy->shape[npy->dimensions++] = size;
    if (size && npy->count > UINT64_MAX / 16 / size)
      return trax_fail(error, "%s: an array of more than 2^60 elements", npy->path);
    npy->count *= size;
    if (!take(header, ',') && (header->at == header->end || *header->at != ')'))
      return wrong(header, "a comma or the end of the shape", error);
  }
  return TRAX_OK;
}

static trax_status take_order(struct header *header, trax_error *error) {
  header->fortran = take_word(header, "True");
  return header->fortran || take_word(header, "False") ? TRAX_OK : wrong(header, "True or False", error);
}

static trax_status read_dictionary(struct scene_npy *npy, struct header *header, enum scene_npy_kind kind,
                                   trax_error *error) {
  bool has[3] = {false};
  if (!take(header, '{'))
    return wrong(header, "a dictionary", error);
  while (!take(header, '}')) {
    char key[16];
    if (!take_string(header, key))
      return wrong(header, "a key", error);
    const int which = strcmp(key, "descr") == 0           ? 0
                      : strcmp(key, "fortran_order") == 0 ? 1
                      : strcmp(key, "shape") == 0         ? 2
                                                          : -1;
    if (which < 0 || has[which])
      return trax_fail(error, "%s: the header of an array has no key '%s', or it has it once", npy->path, key);
    has[which] = true;
    if (!take(header, ':'))
      return wrong(header, "a colon", error);
    const trax_status status = which == 0   ? take_type(npy, header, kind, error)
                               : which == 1 ? take_order(header, error)
                                            : take_shape(npy, header, error);
    if (status != TRAX_OK)
      return status;
    if (!take(header, ',') && (header->at == header->end || *header->at != '}'))
      return wrong(header, "a comma or the end of the dictionary", error);
  }
  if (!has[0] || !has[1] || !has[2])
    return trax_fail(error, "%s: the header of the array lacks descr, fortran_order or shape", npy->path);
  if (header->at != header->end)
    return wrong(header, "nothing more", error);
  if (header->fortran && npy->dimensions > 1)
    return trax_fail(error, "%s: the array is in Fortran's order (numpy: .copy(order='C'))", npy->path);
  return TRAX_OK;
}

static trax_status parse(struct scene_npy *npy, enum scene_npy_kind kind, trax_error *error) {
  const unsigned char *bytes = npy->bytes.data;
  const size_t size = npy->bytes.size;
  if (size < 10 || memcmp(bytes, "\x93NUMPY", 6) != 0)
    return trax_fail(error, "%s: it is no array in numpy's format (.npy)", npy->path);
  if (bytes[6] < 1 || bytes[6] > 3)
    return trax_fail(error, "%s: version %u of numpy's format is not known, only 1 to 3", npy->path, bytes[6]);
  const size_t before = bytes[6] == 1 ? 10 : 12;
  size_t length = (size_t)bytes[8] | (size_t)bytes[9] << 8;
  if (before == 12 && size >= 12)
    length |= (size_t)bytes[10] << 16 | (size_t)bytes[11] << 24;
  if (size < before || length > size - before)
    return trax_fail(error, "%s: the file ends within the header of the array", npy->path);
  const char *text = (const char *)bytes + before;
  struct header header = {.at = text, .end = text + length, .begin = text, .path = npy->path, .before = before};
  if (read_dictionary(npy, &header, kind, error) != TRAX_OK)
    return TRAX_ERROR;
  npy->data = bytes + before + length;
  const size_t has = size - before - length;
  if (has != npy->count * npy->item)
    return trax_fail(error,
                     "%s: the array has %" PRIu64 " elements of %u bytes by its shape, but the file has %zu bytes",
                     npy->path, npy->count, npy->item, has);
  return TRAX_OK;
}

trax_status scene_npy_read(struct scene_npy *npy, const char *path, enum scene_npy_kind kind, trax_error *error) {
  *npy = (struct scene_npy){.path = path};
  trax_status result = scene_load_file(&npy->bytes, path, scene_limits_of(0), error);
  if (result == TRAX_OK)
    result = parse(npy, kind, error);
  if (result != TRAX_OK)
    scene_npy_release(npy);
  return result;
}

void scene_npy_release(struct scene_npy *npy) {
  free(npy->bytes.data);
  *npy = (struct scene_npy){0};
}

static uint64_t word(const struct scene_npy *npy, uint64_t index) {
  uint64_t value = 0;
  for (unsigned i = 0; i < npy->item; i++)
    value |= (uint64_t)npy->data[index * npy->item + i] << 8 * i;
  return value;
}

uint64_t scene_npy_integer(const struct scene_npy *npy, uint64_t index, uint64_t limit) {
  const uint64_t value = word(npy, index);
  const bool is_negative = npy->is_signed && value >> (8 * npy->item - 1);
  return is_negative || value > limit ? limit : value;
}

float scene_npy_float(const struct scene_npy *npy, uint64_t index) {
  const uint32_t bits = (uint32_t)word(npy, index);
  float value;
  memcpy(&value, &bits, sizeof value);
  return value;
}

void scene_npy_print(const struct scene_npy *npy, uint64_t index, char text[24]) {
  const uint64_t value = word(npy, index);
  if (npy->is_float)
    snprintf(text, 24, "%g", (double)scene_npy_float(npy, index));
  else if (npy->is_signed)
    snprintf(text, 24, "%" PRId64, npy->item == 4 ? (int64_t)(int32_t)value : (int64_t)value);
  else
    snprintf(text, 24, "%" PRIu64, value);
}

static size_t make_header(char text[128], const uint64_t *shape, unsigned dimensions) {
  memset(text, ' ', 128);
  memcpy(text, "\x93NUMPY\1\0\x76\0", 10);
  int used = snprintf(text + 10, 118, "{'descr': '<f4', 'fortran_order': False, 'shape': (");
  for (unsigned i = 0; i < dimensions; i++)
    used += snprintf(text + 10 + used, (size_t)(118 - used), "%" PRIu64 ", ", shape[i]);
  used += snprintf(text + 10 + used, (size_t)(118 - used), "), }");
  text[10 + used] = ' ';
  text[127] = '\n';
  return 128;
}

trax_status trax_mesh_write_triangles(const struct trax_mesh *mesh, const char *path, trax_error *error) {
  trax_output output;
  char header[128];
  if (mesh->instance_count)
    return trax_fail(error, "%s: triangles of instances have several places (--flatten)", path);
  if (trax_output_open(&output, path, error) != TRAX_OK)
    return TRAX_ERROR;
  fwrite(header, 1, make_header(header, (const uint64_t[]){mesh->triangle_count, 3, 3}, 3), output.file);
  for (uint32_t i = 0; i < mesh->triangle_count; i++)
    for (int corner = 0; corner < 3; corner++)
      fwrite(mesh->vertices[mesh->triangles[i].vertices[corner]], sizeof(float), 3, output.file);
  return trax_output_commit(&output, error);
}
