/* Memory, maps, files and diagnostics. */
#include "ld.h"

#include "trax/input.h"
#include "trax/message.h"
#include "trax/output.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

/* --- memory: chunks that are freed together --- */

/* 0 gives every allocation its own chunk of its own size, so that AddressSanitizer sees where each one ends. */
#ifndef LD_CHUNK_SIZE
#define LD_CHUNK_SIZE ((size_t)256 << 10)
#endif

struct ld_chunk {
  struct ld_chunk *next;
  size_t used, size;
  _Alignas(16) unsigned char bytes[];
};

void *ld_alloc(ld_context *ctx, size_t size) {
  size_t rounded = LD_CHUNK_SIZE ? (size + 15) & ~(size_t)15 : size;
  struct ld_chunk *chunk = ctx->chunks;
  if (!chunk || chunk->size - chunk->used < rounded) {
    size_t chunk_size = rounded > LD_CHUNK_SIZE / 4 ? rounded : LD_CHUNK_SIZE;
    struct ld_chunk *fresh = rounded < size ? NULL : calloc(1, sizeof *fresh + chunk_size);
    if (!fresh) {
      trax_message("trax-ld", TRAX_MESSAGE_ERROR, "out of memory (%zu bytes wanted)", size);
      longjmp(ctx->out_of_memory, 1);
    }
    fresh->size = chunk_size;
    if (chunk && chunk_size != LD_CHUNK_SIZE) { /* a large block's own chunk goes after the current one */
      fresh->next = chunk->next;
      chunk->next = fresh;
    } else {
      fresh->next = chunk;
      ctx->chunks = fresh;
    }
    chunk = fresh;
  }
  void *result = chunk->bytes + chunk->used;
  chunk->used += rounded;
  return result;
}

void *ld_alloc_array(ld_context *ctx, size_t count, size_t size) {
  return ld_alloc(ctx, count > SIZE_MAX / size ? SIZE_MAX : count * size);
}

void *ld_grow(ld_context *ctx, void *items, size_t count, size_t *capacity, size_t size) {
  *capacity = *capacity ? 2 * *capacity : 8;
  void *grown = ld_alloc_array(ctx, *capacity, size);
  if (count)
    memcpy(grown, items, count * size);
  return grown;
}

static char *vformat(ld_context *ctx, const char *format, va_list args) {
  va_list copy;
  va_copy(copy, args);
  int length = vsnprintf(NULL, 0, format, args);
  char *text = ld_alloc(ctx, (size_t)length + 1);
  vsnprintf(text, (size_t)length + 1, format, copy);
  va_end(copy);
  return text;
}

char *ld_format(ld_context *ctx, const char *format, ...) {
  va_list args;
  va_start(args, format);
  char *text = vformat(ctx, format, args);
  va_end(args);
  return text;
}

void ld_free_all(ld_context *ctx) {
  trax_files_release(&ctx->files);
  for (size_t i = 0; i < ctx->elves.count; i++)
    elf_end(ctx->elves.items[i]);
  while (ctx->chunks) {
    struct ld_chunk *next = ctx->chunks->next;
    free(ctx->chunks);
    ctx->chunks = next;
  }
}

/* --- maps: open addressing, linear probing, at most two thirds full --- */

static uint32_t hash_bytes(const void *key, size_t length) { /* FNV-1a */
  const uint8_t *bytes = key;
  uint32_t hash = 2166136261u;
  for (size_t i = 0; i < length; i++)
    hash = (hash ^ bytes[i]) * 16777619u;
  return hash;
}

static ld_map_entry *probe(const ld_map *map, const void *key, size_t length, uint32_t hash) {
  size_t mask = map->capacity - 1;
  for (size_t i = hash & mask;; i = (i + 1) & mask) {
    ld_map_entry *entry = &map->entries[i];
    if (!entry->key ||
        (entry->hash == hash && entry->length == length && (length == 0 || memcmp(entry->key, key, length) == 0)))
      return entry;
  }
}

uintptr_t *ld_map_at(ld_context *ctx, ld_map *map, const void *key, size_t length) {
  if (3 * (map->count + 1) > 2 * map->capacity) {
    ld_map grown = {.capacity = map->capacity ? 2 * map->capacity : 64};
    grown.entries = ld_alloc_array(ctx, grown.capacity, sizeof *grown.entries);
    for (size_t i = 0; i < map->capacity; i++) {
      const ld_map_entry *old = &map->entries[i];
      if (old->key)
        *probe(&grown, old->key, old->length, old->hash) = *old;
    }
    grown.count = map->count;
    *map = grown;
  }
  uint32_t hash = hash_bytes(key, length);
  ld_map_entry *entry = probe(map, key, length, hash);
  if (!entry->key) {
    *entry = (ld_map_entry){.key = key, .length = (uint32_t)length, .hash = hash};
    map->count++;
  }
  return &entry->value;
}

uintptr_t ld_map_find(const ld_map *map, const void *key, size_t length) {
  return map->capacity ? probe(map, key, length, hash_bytes(key, length))->value : 0;
}

/* --- diagnostics --- */

static void print_message(ld_context *ctx, trax_message_kind kind, const char *format, va_list args) {
  trax_message("trax-ld", kind, "%s", ld_demangle(ctx, vformat(ctx, format, args)));
}

void ld_error(ld_context *ctx, const char *format, ...) {
  ctx->error_count++;
  if (ctx->options.error_limit && ctx->error_count > ctx->options.error_limit)
    return;
  va_list args;
  va_start(args, format);
  print_message(ctx, TRAX_MESSAGE_ERROR, format, args);
  va_end(args);
}

void ld_warning(ld_context *ctx, const char *format, ...) {
  if (ctx->options.no_warnings)
    return;
  ctx->warning_count++;
  va_list args;
  va_start(args, format);
  print_message(ctx, TRAX_MESSAGE_WARNING, format, args);
  va_end(args);
}

void ld_report_suppressed(const ld_context *ctx) {
  unsigned limit = ctx->options.error_limit;
  if (limit && ctx->error_count > limit)
    fprintf(stderr, "trax-ld: %u more error%s not shown (--error-limit=0 shows all)\n", ctx->error_count - limit,
            ctx->error_count - limit == 1 ? "" : "s");
}

/* --- files --- */

bool ld_read_file(ld_context *ctx, const char *path, const uint8_t **bytes, size_t *size) {
  trax_input input;
  trax_error error;
  trax_status status = trax_input_open(&input, path, &error);
  if (status == TRAX_OK && !input.is_regular)
    status = trax_fail(&error, "%s: is not a regular file", path);
  if (status == TRAX_OK && input.expected > UINT32_MAX)
    status = trax_fail(&error, "%s: is larger than 4 GB", path);
  if (status == TRAX_OK)
    status = trax_input_read(&input, input.expected, &error);
  if (status == TRAX_OK) {
    uint8_t *kept = ld_alloc(ctx, input.size + 1); /* NUL-terminated, for response files */
    memcpy(kept, input.bytes, input.size);
    *bytes = kept;
    *size = input.size;
  } else {
    ld_error(ctx, "%s", error.message);
  }
  trax_input_close(&input);
  return status == TRAX_OK;
}

bool ld_write_file(ld_context *ctx, const char *path, const void *bytes, size_t size, bool executable) {
  trax_error error;
  const trax_status status = trax_write_whole(path, bytes, size, executable, &error);
  if (status != TRAX_OK)
    ld_error(ctx, "%s", error.message);
  return status == TRAX_OK;
}

/* --- text --- */

bool ld_starts_with(const char *text, const char *prefix) {
  return strncmp(text, prefix, strlen(prefix)) == 0;
}

bool ld_parse_number(const char *text, uint32_t *value) {
  if (*text < '0' || *text > '9')
    return false;
  char *end;
  errno = 0;
  unsigned long long number = strtoull(text, &end, 0);
  if (*end != '\0' || errno != 0 || number > UINT32_MAX)
    return false;
  *value = (uint32_t)number;
  return true;
}
