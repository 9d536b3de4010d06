/* .xz and .gz: unpacked up to a limit, in memory of that order. */
#include "internal.h"
#include "trax/signals.h"

#include <lzma.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

/* The window of `xz -9` and liblzma's own memory: small files may ask for more than they unpack to. */
#define XZ_WINDOW ((size_t)72 << 20)

static trax_status too_large(size_t limit, const char *path, trax_error *error) {
  return trax_fail(error, "%s: unpacks to more than %zu bytes (--unpack-limit)", path, limit);
}

/* Makes room for another byte, at most one beyond the limit. */
static bool reserve(struct scene_bytes *bytes, size_t *capacity, size_t limit) {
  if (*capacity > bytes->size)
    return true;
  size_t larger = *capacity ? *capacity * 2 : 1 << 16;
  larger = larger <= limit ? larger : limit + 1;
  unsigned char *data = realloc(bytes->data, larger);
  if (!data)
    return false;
  bytes->data = data;
  *capacity = larger;
  return true;
}

static const char *lzma_reason(lzma_ret code) {
  switch (code) {
  case LZMA_MEM_ERROR:
    return "not enough memory to unpack";
  case LZMA_MEMLIMIT_ERROR:
    return "the .xz data asks for more memory than it may unpack to (--unpack-limit)";
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

static trax_status unpack_xz(struct scene_bytes *out, const struct scene_bytes *in, size_t limit, const char *path,
                             trax_error *error) {
  lzma_stream stream = LZMA_STREAM_INIT;
  if (lzma_stream_decoder(&stream, limit + XZ_WINDOW, LZMA_CONCATENATED) != LZMA_OK)
    return scene_out_of_memory(error, path);
  stream.next_in = in->data;
  stream.avail_in = in->size;
  size_t capacity = 0;
  trax_status result = TRAX_OK;
  for (lzma_ret code = LZMA_OK; code == LZMA_OK && result == TRAX_OK;) {
    if (out->size > limit)
      result = too_large(limit, path, error);
    else if (trax_signal)
      result = TRAX_INTERRUPTED;
    else if (!reserve(out, &capacity, limit))
      result = scene_out_of_memory(error, path);
    else {
      stream.next_out = out->data + out->size;
      stream.avail_out = capacity - out->size;
      code = lzma_code(&stream, LZMA_FINISH);
      out->size = capacity - stream.avail_out;
      if (code != LZMA_OK && code != LZMA_STREAM_END)
        result = trax_fail(error, "%s: %s", path, lzma_reason(code));
    }
  }
  lzma_end(&stream);
  return result;
}

static trax_status unpack_gz(struct scene_bytes *out, const struct scene_bytes *in, size_t limit, const char *path,
                             trax_error *error) {
  enum { GZIP_WINDOW = 15 + 16 }; /* largest window, gzip header */
  z_stream stream = {0};
  if (inflateInit2(&stream, GZIP_WINDOW) != Z_OK)
    return scene_out_of_memory(error, path);
  size_t capacity = 0, consumed = 0;
  trax_status result = TRAX_OK;
  for (;;) {
    if (out->size > limit) {
      result = too_large(limit, path, error);
      break;
    }
    if (trax_signal) {
      result = TRAX_INTERRUPTED;
      break;
    }
    if (!reserve(out, &capacity, limit)) {
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
        result = trax_fail(error, "%s: the .gz data is corrupt", path);
        break;
      }
    } else if (code == Z_BUF_ERROR || (code == Z_OK && consumed == in->size && stream.avail_out)) {
      result = trax_fail(error, "%s: the .gz data ends too early", path);
      break;
    } else if (code != Z_OK) {
      result = trax_fail(error, "%s: the .gz data is corrupt", path);
      break;
    }
  }
  inflateEnd(&stream);
  return result;
}

trax_status scene_unpack(struct scene_bytes *bytes, size_t limit, const char *path, trax_error *error) {
  static const unsigned char xz_magic[] = {0xFD, '7', 'z', 'X', 'Z', 0}, gz_magic[] = {0x1F, 0x8B, 8};
  const struct scene_bytes packed = *bytes;
  const bool xz = packed.size >= sizeof xz_magic && !memcmp(packed.data, xz_magic, sizeof xz_magic);
  const bool gz = packed.size >= sizeof gz_magic && !memcmp(packed.data, gz_magic, sizeof gz_magic);
  if (!xz && !gz)
    return TRAX_OK;
  *bytes = (struct scene_bytes){0};
  const trax_status result = (xz ? unpack_xz : unpack_gz)(bytes, &packed, limit, path, error);
  free(packed.data);
  if (result != TRAX_OK) {
    free(bytes->data);
    *bytes = (struct scene_bytes){0};
  }
  return result;
}
