/* ar archives, GNU (thin ones, too) and BSD format. Every member's own symbol table is read; the archive's index is not
   needed and not trusted, so an archive without one, or with a stale one, links all the same. (libelf's reader is not
   used: it runs past the end of a damaged index and shortens a truncated member silently.) */
#include "ld.h"

#include <ar.h>
#include <string.h>

#define THIN_MAGIC "!<thin>\n" /* as long as ARMAG: members are files beside the archive */

static bool is_thin(const uint8_t *bytes, size_t size) {
  return size >= SARMAG && memcmp(bytes, THIN_MAGIC, SARMAG) == 0;
}

bool ld_is_archive(const uint8_t *bytes, size_t size) {
  return is_thin(bytes, size) || (size >= SARMAG && memcmp(bytes, ARMAG, SARMAG) == 0);
}

/* A number in a space-padded field. */
static bool parse_field(const char *field, size_t width, uint64_t *value) {
  size_t i = 0;
  *value = 0;
  for (; i < width && field[i] >= '0' && field[i] <= '9'; i++)
    *value = *value * 10 + (uint64_t)(field[i] - '0');
  size_t digits = i;
  while (i < width && field[i] == ' ')
    i++;
  return digits > 0 && i == width;
}

typedef struct member {
  const char *name;     /* NULL for the index and the table of long names */
  const uint8_t *bytes; /* of a thin archive's member, still in its file */
  size_t size;
} member;

typedef struct reader {
  ld_context *ctx;
  const char *path;
  bool is_thin;
  const uint8_t *bytes;
  size_t size, position;
  const char *long_names; /* NULL until its member was read */
  size_t long_names_size;
} reader;

/* "/123": a name in the table of long names, where it ends with "/\n" or "\n". */
static const char *long_name(reader *reader, const char *field, size_t width) {
  uint64_t offset;
  if (!reader->long_names || !parse_field(field, width, &offset) || offset >= reader->long_names_size)
    return NULL;
  const char *start = reader->long_names + offset;
  const char *end = memchr(start, '\n', reader->long_names_size - (size_t)offset);
  if (!end)
    return NULL;
  if (end > start && end[-1] == '/')
    end--;
  return ld_format(reader->ctx, "%.*s", (int)(end - start), start);
}

static const char *short_name(reader *reader, const char *field, size_t width) {
  const char *slash = memchr(field, '/', width);
  size_t length = slash ? (size_t)(slash - field) : width;
  while (length > 0 && field[length - 1] == ' ')
    length--;
  return ld_format(reader->ctx, "%.*s", (int)length, field);
}

/* The next member; false at the end or after an error message. */
static bool next_member(reader *reader, member *member) {
  ld_context *ctx = reader->ctx;
  if (reader->position >= reader->size)
    return false;
  size_t start = reader->position, left = reader->size - start;
  const struct ar_hdr *header = (const struct ar_hdr *)(reader->bytes + start); /* of chars only: no alignment needed */
  if (left < sizeof *header) {
    ld_error(ctx, "%s: archive is truncated: %zu bytes are left for a member header at offset %zu", reader->path, left,
             start);
    return false;
  }
  uint64_t size;
  if (memcmp(header->ar_fmag, ARFMAG, 2) != 0 || !parse_field(header->ar_size, sizeof header->ar_size, &size)) {
    ld_error(ctx, "%s: damaged archive member header at offset %zu", reader->path, start);
    return false;
  }
  left -= sizeof *header;
  /* A thin archive holds the index and the table of long names only. */
  bool is_special = header->ar_name[0] == '/' && (header->ar_name[1] < '0' || header->ar_name[1] > '9');
  bool is_elsewhere = reader->is_thin && !is_special;
  if (size > left && !is_elsewhere) {
    ld_error(ctx, "%s: archive is truncated: the member at offset %zu has %llu bytes, %zu are left", reader->path,
             start, (unsigned long long)size, left);
    return false;
  }
  member->bytes = reader->bytes + start + sizeof *header;
  member->size = (size_t)size;
  member->name = NULL;
  reader->position = start + sizeof *header + (is_elsewhere ? 0 : (size_t)size + (size & 1));

  const char *field = header->ar_name;
  size_t width = sizeof header->ar_name;
  uint64_t length;
  if (memcmp(field, "//  ", 4) == 0) {
    reader->long_names = (const char *)member->bytes;
    reader->long_names_size = member->size;
    return true;
  }
  if (memcmp(field, "/ ", 2) == 0 || memcmp(field, "/SYM64/ ", 8) == 0 || memcmp(field, "__.SYMDEF", 9) == 0)
    return true;
  if (field[0] == '/') {
    member->name = long_name(reader, field + 1, width - 1);
  } else if (memcmp(field, "#1/", 3) == 0) { /* BSD: the name precedes the contents */
    if (parse_field(field + 3, width - 3, &length) && length <= member->size) {
      member->name = ld_format(ctx, "%.*s", (int)length, (const char *)member->bytes);
      member->bytes += length;
      member->size -= (size_t)length;
      if (ld_starts_with(member->name, "__.SYMDEF"))
        member->name = NULL;
      return true;
    }
  } else {
    member->name = short_name(reader, field, width);
  }
  if (!member->name) {
    ld_error(ctx, "%s: bad name of the archive member at offset %zu", reader->path, start);
    return false;
  }
  return true;
}

/* libelf requires an aligned image, but members are at even offsets. */
static const uint8_t *aligned(ld_context *ctx, const uint8_t *bytes, size_t size) {
  if ((uintptr_t)bytes % 8 == 0)
    return bytes;
  return memcpy(ld_alloc(ctx, size), bytes, size);
}

/* The contents of a thin archive's member, whose name is a path from the archive's directory. */
static bool read_thin_member(const reader *reader, member *member) {
  ld_context *ctx = reader->ctx;
  const char *slash = strrchr(reader->path, '/');
  int directory = slash && member->name[0] != '/' ? (int)(slash + 1 - reader->path) : 0;
  return ld_read_file(ctx, ld_format(ctx, "%.*s%s", directory, reader->path, member->name), &member->bytes,
                      &member->size);
}

void ld_archive_add(ld_context *ctx, const char *path, const uint8_t *bytes, size_t size, bool whole) {
  reader reader = {
      .ctx = ctx, .path = path, .is_thin = is_thin(bytes, size), .bytes = bytes, .size = size, .position = SARMAG};
  member member;
  while (next_member(&reader, &member)) {
    if (!member.name || (reader.is_thin && !read_thin_member(&reader, &member)))
      continue;
    const char *name = ld_format(ctx, "%s(%s)", path, member.name);
    const char *foreign = ld_foreign_format(member.bytes, member.size);
    if (foreign) {
      ld_warning(ctx, "%s: is %s; the member is ignored", name, foreign);
      continue;
    }
    ld_object *object = ld_object_open(ctx, name, aligned(ctx, member.bytes, member.size), member.size);
    if (!object)
      continue;
    if (whole) {
      object->taken = true;
      ld_push(ctx, &ctx->pending, object);
    } else {
      ld_symbols_add_lazy(ctx, object);
    }
  }
}
