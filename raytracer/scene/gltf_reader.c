/* glTF 2.0 files, as JSON or GLB: their JSON by jansson, their buffers, and the elements of accessors. Every index and
   offset is checked here before anything is read. */
#include "gltf.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_SHOWN = 60 };

/* --- JSON --- */

size_t gltf_count(const struct gltf *gltf, const char *array) {
  return json_array_size(json_object_get(gltf->root, array));
}

size_t gltf_index(const struct gltf *gltf, const char *array, const json_t *reference) {
  const double number = json_is_number(reference) ? json_number_value(reference) : -1;
  return number >= 0 && number < (double)gltf_count(gltf, array) && number == floor(number) ? (size_t)number : SIZE_MAX;
}

const json_t *gltf_item(const struct gltf *gltf, const char *array, const json_t *reference) {
  const size_t index = gltf_index(gltf, array, reference);
  return index == SIZE_MAX ? NULL : json_array_get(json_object_get(gltf->root, array), index);
}

double gltf_number(const json_t *object, const char *key, double otherwise) {
  const json_t *value = json_object_get(object, key);
  return json_is_number(value) && isfinite(json_number_value(value)) ? json_number_value(value) : otherwise;
}

bool gltf_numbers(double *numbers, size_t count, const json_t *object, const char *key) {
  const json_t *array = json_object_get(object, key);
  if (json_array_size(array) != count)
    return false;
  for (size_t i = 0; i < count; i++)
    if (!json_is_number(json_array_get(array, i)))
      return false;
  for (size_t i = 0; i < count; i++)
    numbers[i] = json_number_value(json_array_get(array, i));
  return true;
}

const char *gltf_text(const json_t *object, const char *key) {
  const char *text = json_string_value(json_object_get(object, key));
  return text ? text : "";
}

const json_t *gltf_extension(const json_t *object, const char *name) {
  return json_object_get(json_object_get(object, "extensions"), name);
}

/* A number of bytes or elements; UINT64_MAX: it is none. */
static uint64_t size_of(const json_t *object, const char *key, uint64_t otherwise) {
  const json_t *value = json_object_get(object, key);
  const double number = json_is_number(value) ? json_number_value(value) : -1;
  if (!value)
    return otherwise;
  return number >= 0 && number < 0x1p53 && number == floor(number) ? (uint64_t)number : UINT64_MAX;
}

/* --- bytes outside of the JSON --- */

void gltf_decode_name(char *name) {
  char *to = name;
  for (const char *from = name; *from; from++) {
    unsigned byte;
    if (from[0] == '%' && isxdigit((unsigned char)from[1]) && isxdigit((unsigned char)from[2]) &&
        sscanf(from + 1, "%2x", &byte) == 1 && byte > 0) {
      *to++ = (char)byte;
      from += 2;
    } else {
      *to++ = *from;
    }
  }
  *to = 0;
}

trax_status gltf_decode_data(struct scene_bytes *bytes, const struct gltf *gltf, const char *uri) {
  static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  static const char mark[] = ";base64,";
  const char *at = strstr(uri, mark);
  if (!at)
    return trax_fail(gltf->error, "%s: a data URI that is not base64: %.*s", gltf->path, MOST_SHOWN, uri);
  at += sizeof mark - 1;
  bytes->size = 0;
  if (!(bytes->data = malloc(strlen(at) / 4 * 3 + 3)))
    return scene_out_of_memory(gltf->error, gltf->path);
  uint32_t word = 0;
  for (unsigned bits = 0; *at && *at != '='; at++) {
    const char *digit = strchr(digits, *at);
    if (!digit) {
      free(bytes->data);
      bytes->data = NULL;
      return trax_fail(gltf->error, "%s: a data URI has a byte that is not base64", gltf->path);
    }
    word = word << 6 | (uint32_t)(digit - digits);
    bits += 6;
    if (bits >= 8)
      bytes->data[bytes->size++] = (unsigned char)(word >> (bits -= 8));
  }
  return TRAX_OK;
}

static trax_status load_file(struct scene_bytes *bytes, struct gltf *gltf, const char *uri) {
  char *name = strdup(uri), *path = NULL;
  if (name) {
    gltf_decode_name(name);
    path = scene_referred_path(gltf->path, name);
  }
  trax_status result = path ? trax_files_check_input(gltf->options->files, path, gltf->error)
                            : scene_out_of_memory(gltf->error, gltf->path);
  if (result == TRAX_OK && scene_load_referred(bytes, path, scene_limits_of(gltf->options->unpack_limit)) != TRAX_OK)
    result = trax_fail(gltf->error, "%s: its buffer %s cannot be read", gltf->path, path);
  free(path);
  free(name);
  return result;
}

static trax_status find_buffer(struct scene_bytes *bytes, struct gltf *gltf, const json_t *reference) {
  const size_t number = gltf_index(gltf, "buffers", reference);
  if (number == SIZE_MAX)
    return trax_fail(gltf->error, "%s: a buffer view has a buffer that is not there", gltf->path);
  const char *uri = json_string_value(json_object_get(gltf_item(gltf, "buffers", reference), "uri"));
  struct gltf_bytes *buffer = &gltf->buffers[number];
  trax_status result = TRAX_OK;
  if (!buffer->bytes.data && !uri) {
    buffer->bytes = gltf->body;
    if (number > 0 || !gltf->body.data)
      result = trax_fail(gltf->error, "%s: buffer %zu has no data", gltf->path, number);
  } else if (!buffer->bytes.data) {
    result =
        !strncmp(uri, "data:", 5) ? gltf_decode_data(&buffer->bytes, gltf, uri) : load_file(&buffer->bytes, gltf, uri);
    buffer->owned = true;
    if (result == TRAX_OK)
      gltf->bytes_read += buffer->bytes.size;
  }
  *bytes = buffer->bytes;
  return result;
}

trax_status gltf_find_view(struct scene_bytes *bytes, struct gltf *gltf, const json_t *reference) {
  const json_t *view = gltf_item(gltf, "bufferViews", reference);
  if (!view)
    return trax_fail(gltf->error, "%s: an accessor or image has a buffer view that is not there", gltf->path);
  if (find_buffer(bytes, gltf, json_object_get(view, "buffer")) != TRAX_OK)
    return TRAX_ERROR;
  const uint64_t offset = size_of(view, "byteOffset", 0), length = size_of(view, "byteLength", UINT64_MAX);
  if (offset > bytes->size || length > bytes->size - offset)
    return trax_fail(gltf->error, "%s: buffer view %zu is beyond its buffer of %zu bytes", gltf->path,
                     gltf_index(gltf, "bufferViews", reference), bytes->size);
  *bytes = (struct scene_bytes){bytes->data + offset, length};
  return TRAX_OK;
}

/* --- accessors --- */

enum { BYTE = 5120, UNSIGNED_BYTE, SHORT, UNSIGNED_SHORT, UNSIGNED_INT = 5125, FLOAT };

static size_t bytes_of(int type) {
  return type == BYTE || type == UNSIGNED_BYTE     ? 1
         : type == SHORT || type == UNSIGNED_SHORT ? 2
         : type == UNSIGNED_INT || type == FLOAT   ? 4
                                                   : 0;
}

static unsigned components_of(const char *type) {
  static const char *const types[] = {"SCALAR", "VEC2", "VEC3", "VEC4"};
  if (!strcmp(type, "MAT4"))
    return 16;
  for (unsigned i = 0; i < sizeof types / sizeof *types; i++)
    if (!strcmp(type, types[i]))
      return i + 1;
  return 0;
}

trax_status gltf_find_accessor(struct gltf_accessor *accessor, struct gltf *gltf, const json_t *reference) {
  const json_t *item = gltf_item(gltf, "accessors", reference);
  const size_t number = gltf_index(gltf, "accessors", reference);
  if (!item)
    return trax_fail(gltf->error, "%s: a mesh has an accessor that is not there", gltf->path);
  const uint64_t count = size_of(item, "count", UINT64_MAX), offset = size_of(item, "byteOffset", 0);
  *accessor = (struct gltf_accessor){.components = components_of(gltf_text(item, "type")),
                                     .type = (int)gltf_number(item, "componentType", 0),
                                     .normalised = json_is_true(json_object_get(item, "normalized"))};
  const size_t element = accessor->components * bytes_of(accessor->type);
  if (element == 0 || count > UINT32_MAX)
    return trax_fail(gltf->error, "%s: accessor %zu has a type or a count that is not read", gltf->path, number);
  if (json_object_get(item, "sparse") || !json_object_get(item, "bufferView"))
    return trax_fail(gltf->error, "%s: accessor %zu is %s, which is not read", gltf->path, number,
                     json_object_get(item, "sparse") ? "sparse" : "without data");
  struct scene_bytes view;
  if (gltf_find_view(&view, gltf, json_object_get(item, "bufferView")) != TRAX_OK)
    return TRAX_ERROR;
  const uint64_t stride =
      size_of(gltf_item(gltf, "bufferViews", json_object_get(item, "bufferView")), "byteStride", element);
  if (stride == 0 || stride > 255 || offset > view.size ||
      (count && (element > view.size - offset || (count - 1) > (view.size - offset - element) / stride)))
    return trax_fail(gltf->error, "%s: accessor %zu is beyond its buffer view of %zu bytes", gltf->path, number,
                     view.size);
  accessor->data = view.data + offset;
  accessor->count = (uint32_t)count;
  accessor->stride = stride;
  return TRAX_OK;
}

static uint32_t word_at(const unsigned char *bytes, size_t size) {
  uint32_t word = 0;
  for (size_t i = 0; i < size; i++)
    word |= (uint32_t)bytes[i] << 8 * i;
  return word;
}

void gltf_read(float *values, unsigned count, const struct gltf_accessor *accessor, uint32_t element) {
  const size_t size = bytes_of(accessor->type);
  for (unsigned i = 0; i < count; i++) {
    const uint32_t word = word_at(accessor->data + element * accessor->stride + i * size, size);
    const bool is_signed = accessor->type == BYTE || accessor->type == SHORT;
    const int32_t integer = size == 1 ? (int8_t)word : (int16_t)word;
    if (accessor->type == FLOAT) {
      memcpy(&values[i], &word, sizeof word);
      continue;
    }
    values[i] = is_signed ? (float)integer : (float)word;
    if (accessor->normalised)
      values[i] = fmaxf((float)((double)values[i] / (double)(UINT32_MAX >> (32 - 8 * size + is_signed))), -1);
  }
}

uint32_t gltf_read_index(const struct gltf_accessor *accessor, uint32_t element) {
  return word_at(accessor->data + element * accessor->stride, bytes_of(accessor->type));
}

/* --- the file --- */

/* Extensions that only add what may be left out, or that are read. */
static bool is_known(const char *extension) {
  static const char *const known[] = {"KHR_texture_transform", "KHR_lights_punctual", "KHR_mesh_quantization"};
  for (size_t i = 0; i < sizeof known / sizeof *known; i++)
    if (!strcmp(extension, known[i]))
      return true;
  return !strncmp(extension, "KHR_materials_", 14);
}

static trax_status check_header(const struct gltf *gltf) {
  const char *version = gltf_text(json_object_get(gltf->root, "asset"), "version");
  if (strncmp(version, "2.", 2) != 0)
    return trax_fail(gltf->error, "%s: glTF of version %.*s; only 2.0 is read", gltf->path, MOST_SHOWN,
                     *version ? version : "(none)");
  const json_t *required = json_object_get(gltf->root, "extensionsRequired");
  for (size_t i = 0; i < json_array_size(required); i++) {
    const char *name = json_string_value(json_array_get(required, i));
    if (!name || !is_known(name))
      return trax_fail(gltf->error, "%s: it requires the extension %.*s, which is not read", gltf->path, MOST_SHOWN,
                       name ? name : "(no name)");
  }
  return TRAX_OK;
}

/* Finds the chunks of a GLB: each has its length, its kind and its bytes. */
static trax_status find_chunks(struct scene_bytes *text, struct gltf *gltf, struct scene_bytes file) {
  enum { HEADER = 12, CHUNK_HEADER = 8, JSON = 0x4E4F534A, BIN = 0x004E4942 };
  *text = file;
  if (file.size < 4 || memcmp(file.data, "glTF", 4) != 0)
    return TRAX_OK;
  if (file.size >= HEADER && word_at(file.data + 4, 4) != 2)
    return trax_fail(gltf->error, "%s: GLB of version %u; only 2 is read", gltf->path, word_at(file.data + 4, 4));
  for (size_t at = HEADER, number = 0; number < 2 && at < file.size; number++) {
    const size_t left = file.size - at;
    const size_t length = left < CHUNK_HEADER ? SIZE_MAX : word_at(file.data + at, 4);
    if (left < CHUNK_HEADER || length > left - CHUNK_HEADER)
      return trax_fail(gltf->error, "%s: not a mesh that can be read: cut off", gltf->path);
    if (word_at(file.data + at + 4, 4) == (number == 0 ? JSON : BIN))
      *(number == 0 ? text : &gltf->body) = (struct scene_bytes){file.data + at + CHUNK_HEADER, length};
    at += CHUNK_HEADER + length;
  }
  return text->data == file.data ? trax_fail(gltf->error, "%s: not a mesh that can be read: no JSON", gltf->path)
                                 : TRAX_OK;
}

static trax_status load_json(struct gltf *gltf, struct scene_bytes file) {
  json_error_t reason;
  struct scene_bytes text;
  if (find_chunks(&text, gltf, file) != TRAX_OK)
    return TRAX_ERROR;
  while (text.size > 0 && text.data[text.size - 1] == 0)
    text.size--; /* of padding */
  gltf->root = json_loadb((const char *)text.data, text.size, 0, &reason);
  if (!gltf->root)
    return trax_fail(gltf->error, "%s: not a mesh that can be read: line %d: %s", gltf->path, reason.line, reason.text);
  if (check_header(gltf) != TRAX_OK)
    return TRAX_ERROR;
  gltf->buffers = calloc(gltf_count(gltf, "buffers") + 1, sizeof *gltf->buffers);
  gltf->images = calloc(gltf_count(gltf, "images") + 1, sizeof *gltf->images);
  return gltf->buffers && gltf->images ? TRAX_OK : scene_out_of_memory(gltf->error, gltf->path);
}

static void release_bytes(struct gltf_bytes *array, size_t count) {
  for (size_t i = 0; array && i < count; i++)
    if (array[i].owned)
      free(array[i].bytes.data);
  free(array);
}

trax_status scene_read_gltf(struct trax_mesh *mesh, const char *path, const struct trax_import_options *options,
                            struct trax_import_report *report, trax_error *error) {
  *mesh = (struct trax_mesh){0};
  char *name = scene_unpacked_name(path);
  if (!name)
    return scene_out_of_memory(error, path);
  struct gltf gltf = {.path = name,
                      .options = options,
                      .report = report,
                      .error = error,
                      .mesh = mesh,
                      .textures = {.mesh = mesh, .options = options, .report = report}};
  struct scene_bytes file;
  trax_status result = scene_load_file(&file, path, scene_limits_of(options->unpack_limit), error);
  gltf.bytes_read = file.size;
  if (result == TRAX_OK && file.size == 0)
    result = trax_fail(error, "%s: the file is empty", path);
  if (result == TRAX_OK)
    result = load_json(&gltf, file);
  if (result == TRAX_OK)
    result = gltf_copy_materials(&gltf);
  if (result == TRAX_OK)
    result = gltf_copy_nodes(&gltf);
  scene_textures_release(&gltf.textures);
  release_bytes(gltf.buffers, gltf_count(&gltf, "buffers"));
  release_bytes(gltf.images, gltf_count(&gltf, "images"));
  json_decref(gltf.root);
  free(gltf.uvs);
  free(file.data);
  free(name);
  if (result != TRAX_OK)
    trax_mesh_release(mesh);
  return result;
}
