/* Writes the manifest of a machine that is loaded and has not run. */
#include "trax/manifest.h"

#include <errno.h>
#include <jansson.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <xxhash.h>

#include "host/manifest.h"
#include "program/program.h"
#include "report/statistics.h"
#include "trax/output.h"

void trax_hash(char digits[TRAX_HASH_DIGITS + 1], const void *bytes, size_t size) {
  const XXH128_hash_t hash = XXH3_128bits(bytes, size);
  snprintf(digits, TRAX_HASH_DIGITS + 1, "%016llx%016llx", (unsigned long long)hash.high64,
           (unsigned long long)hash.low64);
}

/* Writes the file, and says so in the object. A member that there is no memory for is found in the end. */
static trax_status put_file(json_t *object, const char *folder, const char *name, const void *bytes, size_t size,
                            trax_error *error) {
  char path[4096], hash[TRAX_HASH_DIGITS + 1];
  if (snprintf(path, sizeof path, "%s/%s", folder, name) >= (int)sizeof path)
    return trax_fail(error, "%s: the path is too long", folder);
  trax_hash(hash, bytes, size);
  json_object_set_new(object, "file", json_string(name));
  json_object_set_new(object, "bytes", json_integer((json_int_t)size));
  json_object_set_new(object, "xxh128", json_string(hash));
  return trax_write_file(path, bytes, size, error);
}

static trax_status put_buffer(json_t *buffers, trax_machine *machine, const struct trax_bound_buffer *bound,
                              const char *folder, const struct trax_manifest_contents *contents, trax_error *error) {
  const struct trax_manifest_buffer *how = NULL;
  for (size_t i = 0; i < contents->buffer_count && !how; i++)
    if (strcmp(contents->buffers[i].symbol, bound->symbol) == 0)
      how = &contents->buffers[i];
  if (!how)
    return trax_fail(error, "%s: there is no file for the buffer %s", folder, bound->symbol);
  json_t *object = json_object();
  trax_status status = TRAX_OK;
  json_object_set_new(object, "symbol", json_string(bound->symbol));
  if (how->file)
    status = put_file(object, folder, how->file, machine->space.bytes + bound->address, bound->bytes, error);
  else if (how->bytes_per_thread && bound->bytes)
    json_object_set_new(object, "bytes_per_thread", json_integer(how->bytes_per_thread));
  else
    json_object_set_new(object, "bytes", json_integer(bound->bytes));
  if (how->output)
    json_object_set_new(object, "output", json_string(how->output));
  json_array_append_new(buffers, object);
  return status;
}

trax_status trax_manifest_write(trax_machine *machine, const char *folder,
                                const struct trax_manifest_contents *contents, trax_error *error) {
  const struct trax_loaded *loaded = trax_loaded_of(machine);
  if (mkdir(folder, 0777) != 0 && errno != EEXIST)
    return trax_fail(error, "%s: %s", folder, strerror(errno));
  const uint8_t *elf;
  size_t elf_bytes;
  if (trax_machine_read_program(machine, &elf, &elf_bytes, error) != TRAX_OK)
    return TRAX_ERROR;
  json_t *root = json_object(), *program = json_object(), *buffers = json_array();
  json_object_set_new(root, "trax_manifest", json_integer(TRAX_MANIFEST_FORMAT));
  json_object_set_new(root, "program", program);
  json_object_set_new(root, "buffers", buffers);
  trax_status status = put_file(program, folder, TRAX_MANIFEST_PROGRAM, elf, elf_bytes, error);
  for (size_t i = 0; i < loaded->buffer_count && status == TRAX_OK; i++)
    status = put_buffer(buffers, machine, &loaded->buffers[i], folder, contents, error);
  if (contents->items)
    json_object_set_new(root, "items", json_integer((json_int_t)contents->items));
  json_t *more = contents->more ? json_loads(contents->more, 0, NULL) : NULL;
  if (more)
    json_object_update(root, more);
  json_decref(more);
  json_object_set_new(root, "configuration", trax_config_json(&machine->config));
  char *text = status == TRAX_OK ? json_dumps(root, JSON_INDENT(2) | JSON_REAL_PRECISION(15)) : NULL;
  json_decref(root);
  if (status == TRAX_OK && !text)
    status = trax_fail(error, "%s: out of memory for the manifest", folder);
  char path[4096];
  if (status == TRAX_OK && snprintf(path, sizeof path, "%s/%s", folder, TRAX_MANIFEST_NAME) >= (int)sizeof path)
    status = trax_fail(error, "%s: the path is too long", folder);
  trax_output output;
  if (status == TRAX_OK)
    status = trax_output_open(&output, path, error);
  if (status == TRAX_OK) {
    fprintf(output.file, "%s\n", text);
    status = trax_output_commit(&output, error);
  }
  free(text);
  return status;
}
