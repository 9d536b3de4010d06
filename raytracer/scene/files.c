/* Whole files: transparent decompression. */
#include "internal.h"
#include "trax/input.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>

#define READ_AT_ONCE ((size_t)64 << 20)

trax_status scene_out_of_memory(trax_error *error, const char *what) {
  return trax_fail(error, "%s: not enough memory", what);
}

bool trax_parse_size(const char *text, size_t *bytes) {
  static const char units[] = "KMG";
  char *end;
  errno = 0;
  const unsigned long long number = strtoull(text, &end, 10);
  const char *unit = *end ? strchr(units, *end) : NULL;
  const unsigned shift = unit ? 10 * (unsigned)(unit - units + 1) : 0;
  if (*text < '0' || *text > '9' || errno || *end != (unit ? *unit : '\0') || (unit && end[1]) || number == 0 ||
      number > (4ull << 30) >> shift)
    return false;
  *bytes = (size_t)number << shift;
  return true;
}

/* --- the list of what is read --- */

static int list;

void trax_scene_list_files(int descriptor) {
  list = descriptor;
}

/* input: NULL if the file cannot be read. Names are escaped as xxhsum escapes them. */
static trax_status list_file(const char *path, const trax_input *input, trax_error *error) {
  char digits[33] = "-";
  if (!list)
    return TRAX_OK;
  if (input) {
    const XXH128_hash_t hash = XXH3_128bits(input->bytes, input->size);
    snprintf(digits, sizeof digits, "%016" PRIx64 "%016" PRIx64, (uint64_t)hash.high64, (uint64_t)hash.low64);
  }
  bool written = dprintf(list, "%s%s  ", strpbrk(path, "\\\n") ? "\\" : "", digits) > 0;
  for (const char *at = path; *at && written;) {
    const size_t plain = strcspn(at, "\\\n");
    written = dprintf(list, "%.*s%s", (int)plain, at, at[plain] == '\n' ? "\\n" : at[plain] ? "\\\\" : "") > 0;
    at += plain + (at[plain] != '\0');
  }
  return written && dprintf(list, "\n") > 0 ? TRAX_OK : trax_fail(error, "the list of files: %s", strerror(errno));
}

static uint64_t bytes_read;

uint64_t scene_bytes_read(void) {
  return bytes_read;
}

trax_status scene_load_file(struct scene_bytes *bytes, const char *path, struct scene_limits limits,
                            trax_error *error) {
  *bytes = (struct scene_bytes){0};
  trax_input input;
  trax_status result = trax_input_open(&input, path, error);
  /* The size of a pipe's or a device's data is unknown, as that of packed data. */
  const size_t limit = input.is_regular || limits.plain < limits.unpacked ? limits.plain : limits.unpacked;
  /* A signal ends the reading between two steps: a regular file is read without waiting. */
  for (size_t wanted = 0; result == TRAX_OK && input.size == wanted && wanted <= limit && input.expected <= limit;) {
    wanted = limit - wanted < READ_AT_ONCE ? limit + 1 : wanted + READ_AT_ONCE;
    result = trax_input_read(&input, wanted, error);
  }
  if (result == TRAX_OK)
    result = list_file(path, &input, error);
  else
    list_file(path, NULL, NULL);
  if (result == TRAX_OK && (input.size > limit || input.expected > limit))
    result = trax_fail(error, "%s: more than %zu bytes", path, limit);
  if (result == TRAX_OK) {
    *bytes = (struct scene_bytes){input.bytes, input.size};
    input.bytes = NULL;
    result = scene_unpack(bytes, limits.unpacked, path, error);
  }
  trax_input_close(&input);
  bytes_read += bytes->size;
  return result;
}

char *scene_referred_path(const char *referrer, const char *name) {
  const char *slash = strrchr(referrer, '/');
  const size_t folder = slash ? (size_t)(slash - referrer) + 1 : 0;
  char *path = malloc(folder + strlen(name) + 1);
  if (!path)
    return NULL;
  memcpy(path, referrer, folder);
  char *rest = strcpy(path + folder, name);
  for (char *at = rest; *at; at++)
    if (*at == '\\')
      *at = '/';
  const bool drive = ((rest[0] | 32) >= 'a' && (rest[0] | 32) <= 'z') && rest[1] == ':';
  if (rest[0] == '/' || drive || !strncmp(rest, "file:", 5)) {
    const char *last = strrchr(rest, '/');
    last = last ? last + 1 : rest + 2;
    memmove(rest, last, strlen(last) + 1);
  }
  while (!strncmp(rest, "./", 2))
    memmove(rest, rest + 2, strlen(rest + 2) + 1);
  return path;
}

trax_status scene_load_referred(struct scene_bytes *bytes, const char *path, struct scene_limits limits) {
  struct stat status;
  *bytes = (struct scene_bytes){0};
  if (stat(path, &status) != 0 || !S_ISREG(status.st_mode)) {
    list_file(path, NULL, NULL);
    return TRAX_ERROR;
  }
  return scene_load_file(bytes, path, limits, NULL);
}

trax_status scene_terminate(struct scene_bytes *bytes) {
  unsigned char *terminated = realloc(bytes->data, bytes->size + 1);
  if (!terminated) {
    free(bytes->data);
    *bytes = (struct scene_bytes){0};
    return TRAX_ERROR;
  }
  terminated[bytes->size] = 0;
  bytes->data = terminated;
  return TRAX_OK;
}

trax_status scene_load_text(struct scene_bytes *bytes, const char *path, struct scene_limits limits,
                            trax_error *error) {
  trax_status result = scene_load_file(bytes, path, limits, error);
  return result == TRAX_OK && scene_terminate(bytes) != TRAX_OK ? scene_out_of_memory(error, path) : result;
}

bool scene_grow(void *array, size_t record_size, uint32_t count, size_t *capacity) {
  if (count < *capacity)
    return true;
  if (count == UINT32_MAX)
    return false;
  size_t larger = *capacity ? *capacity * 2 : 1024;
  void **pointer = array;
  void *moved = realloc(*pointer, larger * record_size);
  if (!moved)
    return false;
  *pointer = moved;
  *capacity = larger;
  return true;
}

bool scene_has_extension(const char *name, const char *extension) {
  size_t length = strlen(name), tail = strlen(extension);
  return length > tail && !strcasecmp(name + length - tail, extension);
}

char *scene_unpacked_name(const char *path) {
  char *name = strdup(path);
  size_t length = strlen(path);
  if (name && length > 3 && (!strcmp(path + length - 3, ".xz") || !strcmp(path + length - 3, ".gz")))
    name[length - 3] = 0;
  return name;
}
