/* Whole files, packed or not, and memory in proportion to them. */
#ifndef TRAX_SCENE_FILES_H
#define TRAX_SCENE_FILES_H

#include "trax/input.h"
#include "trax/scene.h"

/* --- files.c --- */

struct scene_bytes {
  unsigned char *data; /* released with free; aligned for any type */
  size_t size;
};

/* The most bytes of a plain file, and of one that is unpacked or comes from a pipe or a device. */
struct scene_limits {
  size_t plain, unpacked;
};

/* The limits of meshes, scenes and images. Nothing beyond 4 GiB makes a scene that 32-bit offsets can address. */
static inline struct scene_limits scene_limits_of(size_t unpack_limit) {
  return (struct scene_limits){(size_t)4 << 30, unpack_limit ? unpack_limit : TRAX_DEFAULT_UNPACK_LIMIT};
}

/* The limits of files that people write. */
#define SCENE_TEXT_LIMITS ((struct scene_limits){TRAX_TEXT_LIMIT, TRAX_TEXT_LIMIT})

/* Reads a whole file, unpacking it if it begins as an .xz or .gz file does. */
trax_status scene_load_file(struct scene_bytes *bytes, const char *path, struct scene_limits limits, trax_error *error);

/* extension with its dot; upper and lower case are the same. */
bool scene_has_extension(const char *name, const char *extension);

/* The same as scene_load_file, with a NUL behind the last byte that size does not count. */
trax_status scene_load_text(struct scene_bytes *bytes, const char *path, struct scene_limits limits, trax_error *error);

/* Puts a NUL behind the last byte, which size does not count. When out of memory the bytes are released. */
trax_status scene_terminate(struct scene_bytes *bytes);

/* Makes room for a record behind count others: array is the address of a pointer that realloc may change. False when
   out of memory. */
bool scene_grow(void *array, size_t record_size, uint32_t count, size_t *capacity);

/* The path of a file that `referrer` calls `name`, to be freed; NULL when out of memory. Relative names are
   relative to the referrer's folder, with either slash. Absolute names usually come from another computer: their last
   part is looked up in the referrer's folder. */
char *scene_referred_path(const char *referrer, const char *name);

/* Reads such a file. Devices and pipes, which may never end, are refused. */
trax_status scene_load_referred(struct scene_bytes *bytes, const char *path, struct scene_limits limits);

/* The limit of memory of a mesh whose files have `bytes` bytes. Readers refuse files that ask for more. */
static inline uint64_t scene_memory_for(uint64_t bytes) {
  return ((uint64_t)1 << 30) + 1024 * bytes;
}

/* The bytes of all files that were read so far. */
uint64_t scene_bytes_read(void);

/* A copy of path without a final .xz or .gz, so that it ends as the unpacked file would; NULL when out of memory. */
char *scene_unpacked_name(const char *path);

/* --- unpack.c --- */

/* Replaces the bytes of a packed file by the unpacked ones; others stay. Nothing is left after an error. */
trax_status scene_unpack(struct scene_bytes *bytes, size_t limit, const char *path, trax_error *error);

#endif
