/* The state of host calls in a checkpoint:

     struct header
     files times: struct file_record, and of a file that is kept `pages` times its number in 4 bytes and a page
     names times: struct name_record, and the path
     descriptors times: struct descriptor_record, and the path of a folder

   A file is kept if the host does not have it. Another one is read again, and must be what it was. Input that has been
   read is read again, and must be what it was. */
#include "calls/internal.h"
#include "trax/grow.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

enum { PAGE = TRAX_CONTENTS_PAGE };

static const uint32_t no_file = UINT32_MAX;

struct header {
  uint64_t taken;     /* of standard input */
  uint64_t digest[2]; /* of that */
  uint32_t files, names, descriptors, zero;
};

struct file_record {
  uint64_t size, number;
  uint64_t digest[2]; /* of the contents, if it is not kept */
  uint32_t mode, pages;
  uint8_t kept, differs, writable, zero[5];
};

struct name_record {
  uint64_t digest[2];
  uint32_t file, was; /* index of a file_record, or no_file */
  uint32_t path;      /* bytes */
  uint8_t was_there, zero[3];
};

struct descriptor_record {
  uint64_t offset;
  uint32_t number, kind, file, flags; /* file: index of a file_record, or no_file */
  uint32_t same;                      /* the lowest descriptor of the same open file */
  uint32_t path;                      /* bytes */
};

/* --- saving --- */

struct writer {
  uint8_t *bytes;
  size_t size, capacity;
  bool failed;
};

static void put(struct writer *writer, const void *bytes, size_t size) {
  writer->failed = writer->failed || !trax_grow_to((void **)&writer->bytes, writer->size + size, &writer->capacity, 1);
  if (writer->failed || !size)
    return;
  memcpy(writer->bytes + writer->size, bytes, size);
  writer->size += size;
}

static uint32_t index_of(const struct trax_calls *calls, const struct trax_file *file) {
  uint32_t index = 0;
  for (const struct trax_file *it = calls->files; it != file; it = it->next)
    index++;
  return file ? index : no_file;
}

static void put_file(struct writer *writer, const struct trax_file *file) {
  const bool kept = file->differs || !file->names;
  const XXH128_hash_t digest = kept ? (XXH128_hash_t){0, 0} : trax_contents_digest(&file->contents);
  struct file_record record = {.size = file->contents.size,
                               .number = file->number,
                               .digest = {digest.low64, digest.high64},
                               .mode = file->mode,
                               .kept = kept,
                               .differs = file->differs,
                               .writable = file->writable};
  const size_t pages = kept ? trax_contents_pages(&file->contents) : 0;
  for (size_t i = 0; i < pages; i++)
    record.pages += file->contents.pages[i] != NULL;
  put(writer, &record, sizeof record);
  for (uint32_t i = 0; i < pages; i++) {
    if (!file->contents.pages[i])
      continue;
    put(writer, &i, sizeof i);
    put(writer, file->contents.pages[i], PAGE);
  }
}

static void put_name(struct writer *writer, const struct trax_calls *calls, const struct trax_name *name) {
  char *path = trax_place_path(&name->place);
  writer->failed |= !path;
  if (writer->failed) {
    free(path);
    return;
  }
  const struct name_record record = {.digest = {name->digest.low64, name->digest.high64},
                                     .file = index_of(calls, name->file),
                                     .was = index_of(calls, name->was),
                                     .path = (uint32_t)strlen(path),
                                     .was_there = name->was_there};
  put(writer, &record, sizeof record);
  put(writer, path, record.path);
  free(path);
}

static void put_descriptor(struct writer *writer, const struct trax_opened *opened, struct descriptor_record *record) {
  char *path = opened->folder ? trax_place_path(&(struct trax_place){.folder = opened->folder, .name = "."}) : NULL;
  writer->failed |= opened->folder && !path;
  record->path = path ? (uint32_t)strlen(path) : 0;
  put(writer, record, sizeof *record);
  put(writer, path, record->path);
  free(path);
}

static XXH128_hash_t digest_of(const struct trax_stream_input *input) {
  return input->digest ? XXH3_128bits_digest(input->digest) : (XXH128_hash_t){0, 0};
}

bool trax_calls_save(const struct trax_machine *machine, uint8_t **bytes, size_t *size) {
  struct trax_calls *calls = trax_calls_of((struct trax_machine *)machine);
  struct writer writer = {0};
  *bytes = NULL;
  *size = 0;
  if (!calls || !calls->used)
    return calls != NULL;
  const XXH128_hash_t digest = digest_of(&calls->input);
  struct header header = {.taken = calls->input.taken, .digest = {digest.low64, digest.high64}};
  for (const struct trax_file *it = calls->files; it; it = it->next)
    header.files++;
  for (const struct trax_name *it = calls->names; it; it = it->next)
    header.names++;
  for (uint32_t i = 0; i < TRAX_MOST_DESCRIPTORS; i++)
    header.descriptors += calls->descriptors[i] != NULL;
  put(&writer, &header, sizeof header);
  for (const struct trax_file *it = calls->files; it; it = it->next)
    put_file(&writer, it);
  for (const struct trax_name *it = calls->names; it; it = it->next)
    put_name(&writer, calls, it);
  for (uint32_t i = 0; i < TRAX_MOST_DESCRIPTORS; i++) {
    const struct trax_opened *opened = calls->descriptors[i];
    struct descriptor_record record = {.number = i};
    if (!opened)
      continue;
    while (calls->descriptors[record.same] != opened)
      record.same++;
    record.offset = opened->offset;
    record.kind = opened->kind;
    record.file = index_of(calls, opened->file);
    record.flags = opened->flags;
    put_descriptor(&writer, opened, &record);
  }
  *bytes = writer.bytes;
  *size = writer.size;
  return !writer.failed;
}

/* --- restoring --- */

struct reader {
  const uint8_t *bytes;
  size_t left;
  bool failed;
};

static const uint8_t *take(struct reader *reader, uint64_t size) {
  const uint8_t *bytes = reader->bytes;
  reader->failed |= size > reader->left;
  if (reader->failed)
    return NULL;
  reader->bytes += size;
  reader->left -= size;
  return bytes;
}

static bool take_record(struct reader *reader, void *record, size_t size) {
  const uint8_t *bytes = take(reader, size);
  if (bytes)
    memcpy(record, bytes, size);
  return bytes != NULL;
}

static trax_status restore_input(struct trax_calls *calls, const struct header *header, trax_error *error) {
  uint8_t skipped[4096];
  while (calls->input.taken < header->taken) {
    const uint64_t left = header->taken - calls->input.taken;
    uint32_t got = 0;
    const int failure = trax_input_take(calls, skipped, left < sizeof skipped ? (uint32_t)left : sizeof skipped, &got);
    if (failure == EINTR)
      return trax_fail(error, "interrupted while reading the input again");
    if (failure || got == 0)
      return trax_fail(error, "standard input is shorter than that of the checkpoint's run: give the same again");
  }
  const XXH128_hash_t digest = digest_of(&calls->input);
  if (header->taken && (digest.low64 != header->digest[0] || digest.high64 != header->digest[1]))
    return trax_fail(error, "standard input is not that of the checkpoint's run: give the same again");
  return TRAX_OK;
}

/* A restoration in progress. */
struct restored {
  struct trax_calls *calls;
  struct reader reader;
  struct trax_file **files; /* [file_count], in the order of the checkpoint */
  uint32_t file_count;
  bool *is_there; /* [file_count]: its contents */
  XXH128_hash_t *digests;
};

static int restore_file(struct restored *restored, uint32_t index) {
  struct reader *reader = &restored->reader;
  struct file_record record = {0};
  struct trax_file *file = calloc(1, sizeof *file);
  if (!file)
    return ENOMEM;
  take_record(reader, &record, sizeof record);
  file->next = restored->calls->files;
  restored->calls->files = restored->files[index] = file;
  file->number = record.number;
  file->mode = record.mode;
  file->differs = record.differs;
  file->writable = record.writable;
  restored->digests[index] = file->read = (XXH128_hash_t){record.digest[0], record.digest[1]};
  restored->is_there[index] = record.kept;
  int failure = trax_contents_resize(&file->contents, record.kept ? record.size : 0);
  for (uint32_t i = 0; !failure && !reader->failed && i < record.pages; i++) {
    uint32_t number = UINT32_MAX;
    take_record(reader, &number, sizeof number);
    const uint8_t *page = take(reader, PAGE);
    const uint64_t at = (uint64_t)number * PAGE, left = record.size - at;
    reader->failed |= at >= record.size || !record.kept;
    if (!reader->failed)
      failure = trax_contents_write(&file->contents, at, page, left < PAGE ? left : PAGE);
  }
  return failure;
}

/* Reads a file that is not kept. */
static trax_status read_again(struct restored *restored, const struct trax_place *place, const char *path,
                              uint32_t index, trax_error *error) {
  struct trax_file *file = restored->files[index];
  struct stat status;
  const int failure = trax_host_read(restored->calls, place, &file->contents, &status);
  if (failure)
    return trax_fail(error, "%s: the program's file cannot be opened again: %s", path, strerror(failure));
  if (!XXH128_isEqual(trax_contents_digest(&file->contents), restored->digests[index]))
    return trax_fail(error, "%s: the program's file has changed since the checkpoint", path);
  file->device = status.st_dev;
  file->inode = status.st_ino;
  file->changed = status.st_ctim;
  restored->is_there[index] = true;
  return TRAX_OK;
}

/* The run may have ended before or after it committed what the checkpoint has: then the host has the file. */
static void look_for_committed(struct restored *restored, struct trax_name *name) {
  struct trax_contents contents = {0};
  struct stat status;
  if (trax_host_read(restored->calls, &name->place, &contents, &status) == 0) {
    const XXH128_hash_t digest = trax_contents_digest(&contents);
    if (XXH128_isEqual(digest, trax_contents_digest(&name->file->contents))) {
      name->was_there = true;
      name->digest = digest;
      name->was = name->file;
    }
  }
  trax_contents_free(&contents);
}

static trax_status restore_name(struct restored *restored, trax_error *error) {
  struct name_record record = {0};
  struct trax_place place;
  take_record(&restored->reader, &record, sizeof record);
  const char *text = (const char *)take(&restored->reader, record.path);
  restored->reader.failed |= (record.file != no_file && record.file >= restored->file_count) ||
                             (record.was != no_file && record.was >= restored->file_count);
  char *path = restored->reader.failed ? NULL : strndup(text, record.path);
  if (!path)
    return restored->reader.failed ? TRAX_OK : trax_fail(error, "out of memory"); /* the caller reports it */
  int failure = trax_place_find(restored->calls, path, TRAX_FOLLOW_NONE, &place);
  if (!failure && place.last != TRAX_LAST_NAME)
    failure = EISDIR;
  struct trax_file *file = record.file == no_file ? NULL : restored->files[record.file];
  struct trax_name *name = failure ? NULL : trax_name_set(restored->calls, &place, file);
  trax_status status = TRAX_OK;
  if (!name) {
    status = trax_fail(error, "%s: the program's file cannot be opened again: %s", path,
                       strerror(failure ? failure : ENOMEM));
  } else {
    name->was_there = record.was_there;
    name->digest = (XXH128_hash_t){record.digest[0], record.digest[1]};
    name->was = record.was == no_file ? NULL : restored->files[record.was];
    if (file && restored->is_there[record.file])
      look_for_committed(restored, name);
    else if (file)
      status = read_again(restored, &place, path, record.file, error);
  }
  trax_place_release(restored->calls, &place);
  free(path);
  return status;
}

/* Finds a folder that was open. */
static trax_status restore_folder(struct restored *restored, uint32_t length, struct trax_place *place,
                                  trax_error *error) {
  const char *text = (const char *)take(&restored->reader, length);
  char *path = text ? strndup(text, length) : NULL;
  if (!path)
    return trax_fail(error, text ? "out of memory" : "its state of files is damaged");
  int failure = trax_place_find(restored->calls, path, TRAX_FOLLOW_NONE, place);
  if (!failure)
    failure = trax_place_enter(restored->calls, place);
  if (failure) {
    trax_fail(error, "%s: the program's folder cannot be opened again: %s", path, strerror(failure));
    trax_place_release(restored->calls, place);
  }
  free(path);
  return failure ? TRAX_ERROR : TRAX_OK;
}

static trax_status restore_descriptor(struct restored *restored, trax_error *error) {
  struct trax_calls *calls = restored->calls;
  struct descriptor_record record = {0};
  struct trax_place place = {0};
  if (!take_record(&restored->reader, &record, sizeof record))
    return TRAX_OK;
  const bool is_file = record.kind == TRAX_OPENED_FILE;
  restored->reader.failed |=
      record.kind > TRAX_OPENED_FOLDER || (record.kind == TRAX_OPENED_FOLDER) != !!record.path ||
      record.offset > INT64_MAX || (is_file ? record.file >= restored->file_count : record.file != no_file) ||
      record.number >= TRAX_MOST_DESCRIPTORS || record.same > record.number || calls->descriptors[record.number] ||
      (record.same < record.number && !calls->descriptors[record.same]);
  if (restored->reader.failed)
    return TRAX_OK;
  if (record.path && restore_folder(restored, record.path, &place, error) != TRAX_OK)
    return TRAX_ERROR;
  if (record.same < record.number)
    trax_descriptor_share(calls, record.number, calls->descriptors[record.same]);
  else
    trax_descriptor_open(calls, record.number,
                         &(struct trax_opened){.kind = record.kind,
                                               .flags = record.flags,
                                               .file = is_file ? restored->files[record.file] : NULL,
                                               .folder = place.folder,
                                               .offset = record.offset});
  trax_place_release(restored->calls, &place);
  return TRAX_OK;
}

static trax_status restore_all(struct restored *restored, const struct header *header, trax_error *error) {
  trax_status status = TRAX_OK;
  for (uint32_t i = 0; i < header->files && !restored->reader.failed && status == TRAX_OK; i++) {
    const int failure = restore_file(restored, i);
    if (failure)
      status = trax_fail(error, "its files: %s", strerror(failure));
    restored->file_count++;
  }
  for (uint32_t i = 0; i < header->names && !restored->reader.failed && status == TRAX_OK; i++)
    status = restore_name(restored, error);
  for (uint32_t i = 0; i < header->descriptors && !restored->reader.failed && status == TRAX_OK; i++)
    status = restore_descriptor(restored, error);
  for (uint32_t i = 0; i < header->files && !restored->reader.failed && status == TRAX_OK; i++)
    restored->reader.failed |= !restored->is_there[i];
  if (status == TRAX_OK && (restored->reader.failed || restored->reader.left))
    return trax_fail(error, "its state of files is damaged");
  return status;
}

trax_status trax_calls_restore(struct trax_machine *machine, const uint8_t *bytes, size_t size, trax_error *error) {
  struct restored restored = {.calls = trax_calls_of(machine), .reader = {bytes, size, false}};
  struct trax_calls *calls = restored.calls;
  struct header header;
  if (!calls)
    return trax_fail(error, "out of memory");
  if (!size)
    return TRAX_OK;
  calls->used = true;
  if (!take_record(&restored.reader, &header, sizeof header) ||
      header.files > restored.reader.left / sizeof(struct file_record))
    return trax_fail(error, "its state of files is damaged");
  trax_status status = restore_input(calls, &header, error);
  trax_descriptors_forget(calls);
  restored.files = calloc(header.files + (size_t)1, sizeof *restored.files);
  restored.is_there = calloc(header.files + (size_t)1, sizeof *restored.is_there);
  restored.digests = calloc(header.files + (size_t)1, sizeof *restored.digests);
  if (!restored.files || !restored.is_there || !restored.digests)
    status = trax_fail(error, "out of memory");
  if (status == TRAX_OK)
    status = restore_all(&restored, &header, error);
  free(restored.files);
  free(restored.is_there);
  free(restored.digests);
  return status;
}
