/* Whole files: transparent decompression. */
#include "internal.h"

#include <errno.h>
#include <fcntl.h>
#include <lzma.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

/* Nothing larger makes a scene that 32-bit offsets can address. */
static const size_t max_file_size = (size_t)4 << 30;

trax_status scene_fail(trax_error *error, const char *format, ...) {
  char message[sizeof error->message] = "";
  if (error) {
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
  }
  return trax_fail(error, "%s", message);
}

trax_status scene_out_of_memory(trax_error *error, const char *what) {
  return scene_fail(error, "%s: not enough memory", what);
}

/* Makes room for more bytes behind bytes->size; false if there is no memory. */
static bool reserve(struct scene_bytes *bytes, size_t *capacity, size_t more) {
  if (*capacity - bytes->size >= more)
    return true;
  size_t larger = *capacity ? *capacity * 2 : 1 << 16;
  while (larger - bytes->size < more)
    larger *= 2;
  unsigned char *data = realloc(bytes->data, larger);
  if (!data)
    return false;
  bytes->data = data;
  *capacity = larger;
  return true;
}

static trax_status read_plain(struct scene_bytes *bytes, const char *path, trax_error *error) {
  int descriptor = open(path, O_RDONLY | O_CLOEXEC);
  if (descriptor < 0)
    return scene_fail(error, "%s: cannot open: %s", path, strerror(errno));
  struct stat status;
  size_t expected = fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode) ? (size_t)status.st_size : 0;
  size_t capacity = 0;
  trax_status result = TRAX_OK;
  if (expected >= max_file_size)
    result = scene_fail(error, "%s: larger than %zu GiB", path, max_file_size >> 30);
  else if (!reserve(bytes, &capacity, expected + 1))
    result = scene_out_of_memory(error, path);
  while (result == TRAX_OK) {
    if (!reserve(bytes, &capacity, 1)) {
      result = scene_out_of_memory(error, path);
      break;
    }
    ssize_t got = read(descriptor, bytes->data + bytes->size, capacity - bytes->size);
    if (got == 0)
      break;
    if (got < 0) {
      if (errno != EINTR)
        result = scene_fail(error, "%s: cannot read: %s", path, strerror(errno));
      continue;
    }
    bytes->size += (size_t)got;
    if (bytes->size >= max_file_size)
      result = scene_fail(error, "%s: larger than %zu GiB", path, max_file_size >> 30);
  }
  close(descriptor);
  return result;
}

static const char *lzma_reason(lzma_ret code) {
  switch (code) {
  case LZMA_MEM_ERROR:
    return "not enough memory to unpack";
  case LZMA_BUF_ERROR:
  case LZMA_OK:
    return "the .xz data ends too early";
  case LZMA_FORMAT_ERROR:
    return "not .xz data";
  case LZMA_OPTIONS_ERROR:
    return ".xz data with unknown options";
  default:
    return "the .xz data is corrupt";
  }
}

static trax_status unpack_xz(struct scene_bytes *out, const struct scene_bytes *in, const char *path,
                             trax_error *error) {
  lzma_stream stream = LZMA_STREAM_INIT;
  if (lzma_stream_decoder(&stream, UINT64_MAX, LZMA_CONCATENATED) != LZMA_OK)
    return scene_out_of_memory(error, path);
  stream.next_in = in->data;
  stream.avail_in = in->size;
  size_t capacity = 0;
  trax_status result = TRAX_OK;
  for (lzma_ret code = LZMA_OK; code == LZMA_OK && result == TRAX_OK;) {
    if (out->size >= max_file_size)
      result = scene_fail(error, "%s: larger than %zu GiB when unpacked", path, max_file_size >> 30);
    else if (!reserve(out, &capacity, 1))
      result = scene_out_of_memory(error, path);
    else {
      stream.next_out = out->data + out->size;
      stream.avail_out = capacity - out->size;
      code = lzma_code(&stream, LZMA_FINISH);
      out->size = capacity - stream.avail_out;
      if (code != LZMA_OK && code != LZMA_STREAM_END)
        result = scene_fail(error, "%s: %s", path, lzma_reason(code));
    }
  }
  lzma_end(&stream);
  return result;
}

static trax_status unpack_gz(struct scene_bytes *out, const struct scene_bytes *in, const char *path,
                             trax_error *error) {
  enum { GZIP_WINDOW = 15 + 16 }; /* largest window, gzip header */
  z_stream stream = {0};
  if (inflateInit2(&stream, GZIP_WINDOW) != Z_OK)
    return scene_out_of_memory(error, path);
  size_t capacity = 0, consumed = 0;
  trax_status result = TRAX_OK;
  for (;;) {
    if (out->size >= max_file_size) {
      result = scene_fail(error, "%s: larger than %zu GiB when unpacked", path, max_file_size >> 30);
      break;
    }
    if (!reserve(out, &capacity, 1)) {
      result = scene_out_of_memory(error, path);
      break;
    }
    /* zlib counts in unsigned int */
    unsigned in_step = (unsigned)(in->size - consumed < 1u << 30 ? in->size - consumed : 1u << 30);
    unsigned out_step = (unsigned)(capacity - out->size < 1u << 30 ? capacity - out->size : 1u << 30);
    stream.next_in = in->data + consumed;
    stream.avail_in = in_step;
    stream.next_out = out->data + out->size;
    stream.avail_out = out_step;
    int code = inflate(&stream, Z_NO_FLUSH);
    consumed += in_step - stream.avail_in;
    out->size += out_step - stream.avail_out;
    if (code == Z_STREAM_END) {
      if (consumed == in->size)
        break;
      if (inflateReset(&stream) != Z_OK) { /* a further member follows */
        result = scene_fail(error, "%s: the .gz data is corrupt", path);
        break;
      }
    } else if (code == Z_BUF_ERROR || (code == Z_OK && consumed == in->size && stream.avail_out)) {
      result = scene_fail(error, "%s: the .gz data ends too early", path);
      break;
    } else if (code != Z_OK) {
      result = scene_fail(error, "%s: the .gz data is corrupt", path);
      break;
    }
  }
  inflateEnd(&stream);
  return result;
}

trax_status scene_load_file(struct scene_bytes *bytes, const char *path, trax_error *error) {
  static const unsigned char xz_magic[] = {0xFD, '7', 'z', 'X', 'Z', 0}, gz_magic[] = {0x1F, 0x8B, 8};
  *bytes = (struct scene_bytes){0};
  struct scene_bytes packed = {0};
  trax_status result = read_plain(&packed, path, error);
  if (result == TRAX_OK && packed.size >= sizeof xz_magic && !memcmp(packed.data, xz_magic, sizeof xz_magic))
    result = unpack_xz(bytes, &packed, path, error);
  else if (result == TRAX_OK && packed.size >= sizeof gz_magic && !memcmp(packed.data, gz_magic, sizeof gz_magic))
    result = unpack_gz(bytes, &packed, path, error);
  else if (result == TRAX_OK) {
    *bytes = packed;
    return TRAX_OK;
  }
  free(packed.data);
  if (result != TRAX_OK) {
    free(bytes->data);
    *bytes = (struct scene_bytes){0};
  }
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

trax_status scene_load_referred(struct scene_bytes *bytes, const char *path) {
  struct stat status;
  *bytes = (struct scene_bytes){0};
  if (stat(path, &status) != 0 || !S_ISREG(status.st_mode))
    return TRAX_ERROR;
  return scene_load_file(bytes, path, NULL);
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

trax_status scene_load_text(struct scene_bytes *bytes, const char *path, trax_error *error) {
  trax_status result = scene_load_file(bytes, path, error);
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
