/* Contents of a file: pages of bytes. A page that is not kept is a hole of zeros, so a file of 4 GiB takes the memory
   of what was written. Functions return 0 or an error number. */
#ifndef TRAX_CALLS_CONTENTS_H
#define TRAX_CALLS_CONTENTS_H

#include <stddef.h>
#include <stdint.h>
#include <xxhash.h>

enum { TRAX_CONTENTS_PAGE = 4096 };

/* Bytes of a file: more than a program can read into its memory. */
static const uint64_t trax_contents_most = (uint64_t)1 << 32;

struct trax_contents {
  uint8_t **pages; /* [page_count]; NULL: a hole. Bytes after the size are zeros */
  size_t page_count;
  uint64_t size;
};

/* EFBIG: more than there can be. */
int trax_contents_resize(struct trax_contents *contents, uint64_t size);
/* Writes at least one byte, all of them within trax_contents_most. ENOSPC: out of memory; nothing was written. */
int trax_contents_write(struct trax_contents *contents, uint64_t offset, const uint8_t *bytes, size_t count);
/* Reads bytes within the size. */
void trax_contents_read(const struct trax_contents *contents, uint64_t offset, uint8_t *bytes, size_t count);
void trax_contents_free(struct trax_contents *contents);
XXH128_hash_t trax_contents_digest(const struct trax_contents *contents);

/* Pages that hold bytes of the file, whether or not they are holes. */
size_t trax_contents_pages(const struct trax_contents *contents);

/* Reads the host's file into empty contents. */
int trax_contents_load(struct trax_contents *contents, int descriptor);
/* Writes them into an empty file of the host. Holes stay holes. */
int trax_contents_store(const struct trax_contents *contents, int descriptor);

#endif
