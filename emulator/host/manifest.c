/* Manifests: what trax-sim reads. Nothing in them is believed: every member is checked before anything is loaded. */
#define _GNU_SOURCE /* O_PATH */
#include "trax/manifest.h"

#include <errno.h>
#include <fcntl.h>
#include <jansson.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "host/manifest.h"
#include "machine/config.h"
#include "trax/beneath.h"
#include "trax/input.h"
#include "trax/names.h"

/* A file that the manifest names. */
struct file {
  char *path;       /* with the manifest's folder, for messages; NULL: there is none */
  const char *name; /* in the folder; into the document */
  uint32_t bytes;
  char hash[TRAX_HASH_DIGITS + 1];
};

struct buffer {
  const char *symbol; /* into the document */
  struct file file;   /* without a path: bytes of zeros */
  uint32_t bytes_per_thread;
  struct file output; /* path and name */
};

struct trax_manifest {
  char *path;
  int folder; /* a descriptor: its files lie beneath it, also through links */
  json_t *root;
  struct file program;
  struct buffer *buffers;
  size_t buffer_count;
  uint64_t items;
};

/* A member and how it is called in messages. */
struct place {
  const struct trax_manifest *manifest;
  json_t *value;
  char name[96]; /* "buffers[1].bytes" */
};

enum { FILE_LIMIT = 1 << 30 };

/* --- members --- */

static trax_status refuse(const struct place *place, trax_error *error, const char *reason) {
  return trax_fail(error, "%s: %s: %s", place->manifest->path, place->name, reason);
}

static const char *key_of(const void *context, size_t i) {
  return ((const char *const *)context)[i];
}

/* Checks that the value is an object with no keys but these. The list ends with NULL. */
static trax_status check_object(const struct place *place, const char *const *keys, trax_error *error) {
  if (!json_is_object(place->value))
    return refuse(place, error, "must be an object");
  const char *key;
  json_t *value;
  json_object_foreach(place->value, key, value) {
    size_t count = 0;
    while (keys[count] && strcmp(keys[count], key) != 0)
      count++;
    if (keys[count])
      continue;
    const char *nearest = trax_nearest_name(key, count, key_of, keys);
    return trax_fail(error, "%s: %s%sunknown key \"%.60s\"%s%s%s", place->manifest->path, place->name,
                     *place->name ? ": " : "", key, nearest ? "; did you mean " : "", nearest ? nearest : "",
                     nearest ? "?" : "");
  }
  return TRAX_OK;
}

static struct place member(const struct place *place, const char *key) {
  struct place below = {.manifest = place->manifest, .value = json_object_get(place->value, key)};
  snprintf(below.name, sizeof below.name, "%.60s%s%.30s", place->name, *place->name ? "." : "", key);
  return below;
}

static trax_status read_number(const struct place *place, json_int_t least, uint64_t most, uint64_t *number,
                               trax_error *error) {
  if (json_is_integer(place->value) && json_integer_value(place->value) >= least &&
      (uint64_t)json_integer_value(place->value) <= most) {
    *number = (uint64_t)json_integer_value(place->value);
    return TRAX_OK;
  }
  char reason[96];
  snprintf(reason, sizeof reason, "must be a whole number from %llu to %llu", (unsigned long long)least,
           (unsigned long long)most);
  return refuse(place, error, reason);
}

static trax_status read_text(const struct place *place, const char **text, trax_error *error) {
  *text = json_string_value(place->value);
  return *text && **text ? TRAX_OK : refuse(place, error, "must be a text that is not empty");
}

/* A path that stays in the manifest's folder, as text. */
static trax_status read_path(const struct place *place, struct file *file, trax_error *error) {
  const char *text;
  if (read_text(place, &text, error) != TRAX_OK)
    return TRAX_ERROR;
  bool leaves = *text == '/';
  for (const char *part = text; part; part = strchr(part, '/'), part = part ? part + 1 : NULL)
    leaves = leaves || strcmp(part, "..") == 0 || strncmp(part, "../", 3) == 0;
  if (leaves)
    return refuse(place, error, "must be a path within the manifest's folder");
  const char *own = place->manifest->path, *slash = strrchr(own, '/');
  const int folder = slash ? (int)(slash - own) + 1 : 0;
  const size_t size = (size_t)folder + strlen(text) + 1;
  file->name = text;
  file->path = malloc(size);
  if (!file->path)
    return trax_fail(error, "out of memory");
  snprintf(file->path, size, "%.*s%s", folder, own, text);
  return TRAX_OK;
}

static trax_status read_hash(const struct place *place, char hash[TRAX_HASH_DIGITS + 1], trax_error *error) {
  const char *text = json_string_value(place->value);
  if (!text || strlen(text) != TRAX_HASH_DIGITS || strspn(text, "0123456789abcdef") != TRAX_HASH_DIGITS)
    return refuse(place, error, "must be 32 hexadecimal digits, those of xxhsum -H2");
  memcpy(hash, text, TRAX_HASH_DIGITS + 1);
  return TRAX_OK;
}

/* Members file, bytes, xxh128. */
static trax_status read_file(const struct place *place, struct file *file, trax_error *error) {
  const struct place path = member(place, "file"), bytes = member(place, "bytes"), hash = member(place, "xxh128");
  uint64_t number = 0;
  if (read_path(&path, file, error) != TRAX_OK || read_number(&bytes, 0, UINT32_MAX, &number, error) != TRAX_OK)
    return TRAX_ERROR;
  file->bytes = (uint32_t)number;
  return read_hash(&hash, file->hash, error);
}

/* --- the document --- */

static trax_status read_buffer(const struct place *place, struct buffer *buffer, trax_error *error) {
  static const char *const keys[] = {"symbol", "file", "bytes", "xxh128", "bytes_per_thread", "output", NULL};
  if (check_object(place, keys, error) != TRAX_OK)
    return TRAX_ERROR;
  const struct place symbol = member(place, "symbol"), output = member(place, "output");
  const struct place zeros = member(place, "bytes"), per_thread = member(place, "bytes_per_thread");
  uint64_t number = 0;
  trax_status status = read_text(&symbol, &buffer->symbol, error);
  if (status == TRAX_OK && (json_object_get(place->value, "file") || json_object_get(place->value, "xxh128"))) {
    status = per_thread.value ? refuse(&per_thread, error, "is for a buffer without a file")
                              : read_file(place, &buffer->file, error);
  } else if (status == TRAX_OK && per_thread.value) {
    status = zeros.value ? refuse(&zeros, error, "is given by bytes_per_thread")
                         : read_number(&per_thread, 0, 1u << 24, &number, error);
    buffer->bytes_per_thread = (uint32_t)number;
  } else if (status == TRAX_OK) {
    status = read_number(&zeros, 0, UINT32_MAX, &number, error);
    buffer->file.bytes = (uint32_t)number;
  }
  return status == TRAX_OK && output.value ? read_path(&output, &buffer->output, error) : status;
}

static trax_status read_buffers(const struct place *place, struct trax_manifest *manifest, trax_error *error) {
  if (!json_is_array(place->value))
    return refuse(place, error, "must be a list");
  const size_t count = json_array_size(place->value);
  manifest->buffers = calloc(count + 1, sizeof *manifest->buffers);
  if (!manifest->buffers)
    return trax_fail(error, "out of memory");
  for (size_t i = 0; i < count; i++) {
    struct place buffer = {.manifest = manifest, .value = json_array_get(place->value, i)};
    snprintf(buffer.name, sizeof buffer.name, "%.60s[%zu]", place->name, i);
    manifest->buffer_count = i + 1;
    if (read_buffer(&buffer, &manifest->buffers[i], error) != TRAX_OK)
      return TRAX_ERROR;
  }
  return TRAX_OK;
}

static trax_status read_document(struct trax_manifest *manifest, trax_error *error) {
  static const char *const keys[] = {"trax_manifest", "program",  "buffers", "items",   "configuration",
                                     "code",          "features", "view",    "picture", NULL};
  static const char *const program_keys[] = {"file", "bytes", "xxh128", NULL};
  const struct place root = {.manifest = manifest, .value = manifest->root};
  const struct place version = member(&root, "trax_manifest"), items = member(&root, "items");
  const struct place program = member(&root, "program"), buffers = member(&root, "buffers");
  uint64_t format;
  if (!json_is_object(manifest->root))
    return trax_fail(error, "%s: must be an object", manifest->path);
  if (read_number(&version, TRAX_MANIFEST_FORMAT, TRAX_MANIFEST_FORMAT, &format, error) != TRAX_OK ||
      check_object(&root, keys, error) != TRAX_OK || check_object(&program, program_keys, error) != TRAX_OK ||
      read_file(&program, &manifest->program, error) != TRAX_OK || read_buffers(&buffers, manifest, error) != TRAX_OK ||
      (items.value && read_number(&items, 0, INT64_MAX, &manifest->items, error) != TRAX_OK))
    return TRAX_ERROR;
  trax_config *config = trax_config_create(); /* its values are checked now */
  const trax_status status =
      config ? trax_manifest_configure(manifest, config, error) : trax_fail(error, "out of memory");
  trax_config_destroy(config);
  return status;
}

bool trax_manifest_is(const char *path) {
  const size_t length = strlen(path), ending = strlen(".json");
  return length > ending && strcmp(path + length - ending, ".json") == 0;
}

/* Opens the manifest's folder. */
static trax_status open_folder(struct trax_manifest *manifest, trax_error *error) {
  const char *slash = strrchr(manifest->path, '/');
  char *folder = slash ? strndup(manifest->path, (size_t)(slash - manifest->path + 1)) : strdup(".");
  if (folder)
    manifest->folder = open(folder, O_PATH | O_DIRECTORY | O_CLOEXEC);
  const int code = folder ? errno : ENOMEM;
  free(folder);
  return manifest->folder >= 0 ? TRAX_OK : trax_fail(error, "%s: its folder: %s", manifest->path, strerror(code));
}

trax_manifest *trax_manifest_read(const char *path, trax_error *error) {
  uint8_t *bytes;
  size_t size;
  if (trax_read_file(path, TRAX_TEXT_LIMIT, &bytes, &size, error) != TRAX_OK)
    return NULL;
  json_error_t reason;
  struct trax_manifest *manifest = calloc(1, sizeof *manifest);
  trax_status status = TRAX_OK;
  if (manifest)
    manifest->folder = -1;
  if (!manifest || !(manifest->path = strdup(path)))
    status = trax_fail(error, "out of memory");
  else if (open_folder(manifest, error) != TRAX_OK)
    status = TRAX_ERROR;
  else if (!(manifest->root = json_loadb((const char *)bytes, size, JSON_REJECT_DUPLICATES, &reason)))
    status = trax_fail(error, "%s:%d: %s", path, reason.line > 0 ? reason.line : 1, reason.text);
  else
    status = read_document(manifest, error);
  free(bytes);
  if (status == TRAX_OK)
    return manifest;
  trax_manifest_release(manifest);
  return NULL;
}

void trax_manifest_release(trax_manifest *manifest) {
  if (!manifest)
    return;
  for (size_t i = 0; i < manifest->buffer_count; i++) {
    free(manifest->buffers[i].file.path);
    free(manifest->buffers[i].output.path);
  }
  free(manifest->buffers);
  free(manifest->program.path);
  json_decref(manifest->root);
  if (manifest->folder >= 0)
    close(manifest->folder);
  free(manifest->path);
  free(manifest);
}

/* --- what it says --- */

const char *trax_manifest_program(const trax_manifest *manifest) {
  return manifest->program.path;
}

uint64_t trax_manifest_items(const trax_manifest *manifest) {
  return manifest->items;
}

void trax_manifest_inputs(const trax_manifest *manifest, trax_files *files) {
  trax_files_input(files, NULL, manifest->path);
  trax_files_input(files, NULL, manifest->program.path);
  for (size_t i = 0; i < manifest->buffer_count; i++)
    trax_files_input(files, NULL, manifest->buffers[i].file.path);
}

bool trax_manifest_output(const trax_manifest *manifest, size_t i, const char **symbol, const char **path) {
  for (size_t buffer = 0; buffer < manifest->buffer_count; buffer++)
    if (manifest->buffers[buffer].output.path && i-- == 0) {
      *symbol = manifest->buffers[buffer].symbol;
      *path = manifest->buffers[buffer].output.path;
      return true;
    }
  return false;
}

static const struct file *output_of(const trax_manifest *manifest, const char *symbol) {
  size_t i = 0;
  while (!manifest->buffers[i].output.path || strcmp(manifest->buffers[i].symbol, symbol) != 0)
    i++;
  return &manifest->buffers[i].output;
}

trax_status trax_manifest_check_output(const trax_manifest *manifest, const char *symbol, trax_error *error) {
  const struct file *output = output_of(manifest, symbol);
  return trax_beneath_check(manifest->folder, output->name, output->path, error);
}

trax_status trax_manifest_put_output(const trax_manifest *manifest, const char *symbol, const void *bytes, size_t size,
                                     trax_error *error) {
  const struct file *output = output_of(manifest, symbol);
  return trax_beneath_write(manifest->folder, output->name, output->path, bytes, size, error);
}

bool trax_manifest_picture(const trax_manifest *manifest, const char **symbol, uint32_t *width, uint32_t *height,
                           bool *is_float) {
  enum { MOST_PIXELS = 16384 }; /* of a side */
  const json_t *picture = json_object_get(manifest->root, "picture");
  const char *layout = json_string_value(json_object_get(picture, "layout"));
  const json_int_t across = json_integer_value(json_object_get(picture, "width")),
                   down = json_integer_value(json_object_get(picture, "height"));
  *symbol = json_string_value(json_object_get(picture, "buffer"));
  if (!*symbol || !layout || across < 1 || across > MOST_PIXELS || down < 1 || down > MOST_PIXELS)
    return false;
  *width = (uint32_t)across;
  *height = (uint32_t)down;
  *is_float = strcmp(layout, "rgb float32") == 0;
  return *is_float || strcmp(layout, "rgba uint8") == 0;
}

/* Makes a value's text, as trax_config_set takes it. */
static trax_status value_text(const struct place *place, char text[TRAX_CONFIG_WORD], trax_error *error) {
  if (json_is_string(place->value)) {
    const char *word = json_string_value(place->value);
    if (json_string_length(place->value) >= TRAX_CONFIG_WORD)
      return refuse(place, error, "is longer than any value");
    strcpy(text, word);
  } else if (json_is_boolean(place->value)) {
    strcpy(text, json_is_true(place->value) ? "true" : "false");
  } else if (json_is_integer(place->value)) {
    snprintf(text, TRAX_CONFIG_WORD, "%" JSON_INTEGER_FORMAT, json_integer_value(place->value));
  } else if (json_is_real(place->value)) {
    snprintf(text, TRAX_CONFIG_WORD, "%.17g", json_real_value(place->value));
  } else {
    return refuse(place, error, "must be a number, true, false or a word");
  }
  return TRAX_OK;
}

trax_status trax_manifest_configure(const trax_manifest *manifest, trax_config *config, trax_error *error) {
  const struct place root = {.manifest = manifest, .value = manifest->root};
  const struct place configuration = member(&root, "configuration");
  const char *component_name, *key;
  json_t *component, *value;
  if (configuration.value && !json_is_object(configuration.value))
    return refuse(&configuration, error, "must be an object");
  json_object_foreach(configuration.value, component_name, component) {
    const struct place in = member(&configuration, component_name);
    if (!json_is_object(component))
      return refuse(&in, error, "must be an object");
    json_object_foreach(component, key, value) {
      const struct place at = member(&in, key);
      char text[TRAX_CONFIG_WORD], name[96];
      trax_error reason;
      snprintf(name, sizeof name, "%.40s.%.40s", component_name, key);
      if (value_text(&at, text, error) != TRAX_OK)
        return TRAX_ERROR;
      if (trax_config_set(config, name, text, &reason) != TRAX_OK)
        return refuse(&at, error, reason.message);
    }
  }
  trax_error reason;
  return trax_config_check(config, &reason) == TRAX_OK ? TRAX_OK : refuse(&configuration, error, reason.message);
}

/* --- its files --- */

/* *bytes are from malloc, and NULL on an error. */
static trax_status check_file(const struct trax_manifest *manifest, const struct file *file, uint8_t **bytes,
                              trax_error *error) {
  size_t size;
  trax_input input;
  *bytes = NULL;
  const trax_status opened = trax_input_open_beneath(&input, manifest->folder, file->name, file->path, error);
  if (trax_input_read_all(&input, opened, FILE_LIMIT, bytes, &size, error) != TRAX_OK)
    return TRAX_ERROR;
  char hash[TRAX_HASH_DIGITS + 1];
  trax_hash(hash, *bytes, size);
  trax_status status = TRAX_OK;
  if (size != file->bytes)
    status = trax_fail(error, "%s: %zu bytes, but %s says %u", file->path, size, manifest->path, file->bytes);
  else if (strcmp(hash, file->hash) != 0)
    status = trax_fail(error, "%s: its bytes are not those of %s: their hash is %s, not %s", file->path, manifest->path,
                       hash, file->hash);
  if (status != TRAX_OK) {
    free(*bytes);
    *bytes = NULL;
  }
  return status;
}

trax_status trax_manifest_load(const trax_manifest *manifest, trax_machine *machine, trax_error *error) {
  uint8_t *bytes;
  trax_status status = check_file(manifest, &manifest->program, &bytes, error);
  if (status != TRAX_OK)
    return status;
  status = trax_machine_load_bytes(machine, manifest->program.path, bytes, manifest->program.bytes, error);
  free(bytes);
  const trax_config *config = trax_machine_config(machine);
  const double threads = trax_config_get(config, "chip.tms") * trax_config_get(config, "chip.tps_per_tm");
  for (size_t i = 0; i < manifest->buffer_count && status == TRAX_OK; i++) {
    const struct buffer *buffer = &manifest->buffers[i];
    trax_error reason;
    bytes = NULL;
    if (buffer->file.path)
      status = check_file(manifest, &buffer->file, &bytes, error);
    const double size = buffer->bytes_per_thread ? buffer->bytes_per_thread * threads : buffer->file.bytes;
    if (status == TRAX_OK && size > UINT32_MAX)
      status =
          trax_fail(error, "%s: buffers[%zu]: %.0f bytes exceed the machine's address space", manifest->path, i, size);
    else if (status == TRAX_OK && trax_machine_bind(machine, buffer->symbol, bytes, (uint32_t)size, &reason) != TRAX_OK)
      status = trax_fail(error, "%s: buffers[%zu]: %s", manifest->path, i, reason.message);
    free(bytes);
  }
  return status;
}
