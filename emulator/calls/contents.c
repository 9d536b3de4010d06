#define _GNU_SOURCE             /* SEEK_DATA */
#define XXH_STATIC_LINKING_ONLY /* XXH3_state_t */
#include "calls/contents.h"

#include <errno.h>
#include <limits.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <sys/uio.h>
#include <unistd.h>

enum { PAGE = TRAX_CONTENTS_PAGE };

static size_t least(uint64_t a, uint64_t b) {
  return (size_t)(a < b ? a : b);
}

static uint64_t pages_of(uint64_t size) {
  return (size + PAGE - 1) / PAGE;
}

size_t trax_contents_pages(const struct trax_contents *contents) {
  return least(pages_of(contents->size), contents->page_count);
}

void trax_contents_free(struct trax_contents *contents) {
  for (size_t i = 0; i < contents->page_count; i++)
    free(contents->pages[i]);
  free(contents->pages);
  *contents = (struct trax_contents){0};
}

int trax_contents_resize(struct trax_contents *contents, uint64_t size) {
  if (size > trax_contents_most)
    return EFBIG;
  for (size_t i = (size_t)pages_of(size); i < trax_contents_pages(contents); i++) {
    free(contents->pages[i]);
    contents->pages[i] = NULL;
  }
  uint8_t *last = size < contents->size && size / PAGE < contents->page_count ? contents->pages[size / PAGE] : NULL;
  if (last)
    memset(last + size % PAGE, 0, PAGE - size % PAGE);
  contents->size = size;
  return 0;
}

/* Lengthens the list of pages. The host provides memory from calloc when it is first written, so large holes take
   none. */
static bool reserve(struct trax_contents *contents, size_t count) {
  if (count <= contents->page_count)
    return true;
  const size_t longer = count + count / 2;
  uint8_t **pages = calloc(longer, sizeof *pages);
  if (!pages)
    return false;
  for (size_t i = 0; i < contents->page_count; i++)
    if (contents->pages[i])
      pages[i] = contents->pages[i];
  free(contents->pages);
  contents->pages = pages;
  contents->page_count = longer;
  return true;
}

int trax_contents_write(struct trax_contents *contents, uint64_t offset, const uint8_t *bytes, size_t count) {
  const uint64_t end = offset + count;
  if (!reserve(contents, (size_t)pages_of(end)))
    return ENOSPC;
  for (uint64_t i = offset / PAGE; i < pages_of(end); i++)
    if (!contents->pages[i] && !(contents->pages[i] = calloc(1, PAGE)))
      return ENOSPC;
  for (uint64_t at = offset; at < end;) {
    const size_t part = least(PAGE - at % PAGE, end - at);
    memcpy(contents->pages[at / PAGE] + at % PAGE, bytes, part);
    bytes += part;
    at += part;
  }
  if (end > contents->size)
    contents->size = end;
  return 0;
}

void trax_contents_read(const struct trax_contents *contents, uint64_t offset, uint8_t *bytes, size_t count) {
  for (const uint64_t end = offset + count; offset < end;) {
    const size_t part = least(PAGE - offset % PAGE, end - offset);
    const uint8_t *page = offset / PAGE < contents->page_count ? contents->pages[offset / PAGE] : NULL;
    if (page)
      memcpy(bytes, page + offset % PAGE, part);
    else
      memset(bytes, 0, part);
    bytes += part;
    offset += part;
  }
}

/* Pages of zeros count as holes: a host need not keep holes. */
XXH128_hash_t trax_contents_digest(const struct trax_contents *contents) {
  static const uint8_t zeros[PAGE];
  XXH3_state_t state;
  XXH3_128bits_reset(&state);
  XXH3_128bits_update(&state, &contents->size, sizeof contents->size);
  for (uint64_t i = 0; i < trax_contents_pages(contents); i++) {
    if (!contents->pages[i] || memcmp(contents->pages[i], zeros, PAGE) == 0)
      continue;
    XXH3_128bits_update(&state, &i, sizeof i);
    XXH3_128bits_update(&state, contents->pages[i], PAGE);
  }
  return XXH3_128bits_digest(&state);
}

/* --- the host's files --- */

/* Reads the bytes of [begin, end). Sets the size to what there is, if that is less. */
static int load_part(struct trax_contents *contents, int descriptor, uint64_t begin, uint64_t end) {
  uint8_t bytes[16 * PAGE];
  int failure = 0;
  while (!failure && begin < end) {
    const ssize_t got = pread(descriptor, bytes, least(sizeof bytes, end - begin), (off_t)begin);
    if (got == 0)
      return trax_contents_resize(contents, begin < contents->size ? begin : contents->size);
    if (got > 0)
      failure = trax_contents_write(contents, begin, bytes, (size_t)got);
    else if (errno != EINTR)
      failure = errno;
    begin += got > 0 ? (uint64_t)got : 0;
  }
  return failure;
}

int trax_contents_load(struct trax_contents *contents, int descriptor) {
  struct stat status;
  if (fstat(descriptor, &status) != 0)
    return errno;
  int failure = trax_contents_resize(contents, (uint64_t)status.st_size);
  for (off_t at = 0; !failure && at < (off_t)contents->size;) {
    off_t begin = lseek(descriptor, at, SEEK_DATA), end = begin < 0 ? -1 : lseek(descriptor, begin, SEEK_HOLE);
    if (begin < 0 && errno == ENXIO) /* zeros up to the end */
      break;
    if (end < 0) { /* a file system that does not know */
      begin = at;
      end = (off_t)contents->size;
    }
    at = end < (off_t)contents->size ? end : (off_t)contents->size;
    failure = load_part(contents, descriptor, (uint64_t)begin, (uint64_t)at);
  }
  return failure;
}

static int store_parts(int descriptor, struct iovec *parts, int count, off_t at) {
  while (count) {
    ssize_t put = pwritev(descriptor, parts, count, at);
    if (put < 0 && errno != EINTR)
      return errno;
    at += put > 0 ? put : 0;
    for (; put > 0 && count && (size_t)put >= parts->iov_len; count--)
      put -= (ssize_t)parts++->iov_len;
    if (put > 0) {
      parts->iov_base = (uint8_t *)parts->iov_base + put;
      parts->iov_len -= (size_t)put;
    }
  }
  return 0;
}

int trax_contents_store(const struct trax_contents *contents, int descriptor) {
  int failure = 0;
  for (size_t i = 0, end = trax_contents_pages(contents); !failure && i < end;) {
    struct iovec parts[64];
    const size_t first = i;
    int count = 0;
    for (; count < 64 && i < end && contents->pages[i]; i++)
      parts[count++] = (struct iovec){contents->pages[i], least(PAGE, contents->size - (uint64_t)i * PAGE)};
    failure = store_parts(descriptor, parts, count, (off_t)first * PAGE);
    i += count == 0;
  }
  return failure || ftruncate(descriptor, (off_t)contents->size) == 0 ? failure : errno;
}
