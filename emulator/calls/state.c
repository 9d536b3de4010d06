/* The state of host calls in a checkpoint:

     struct header
     files times: struct file_record, path, and the contents if the host's file has others
     descriptors times: struct descriptor_record

   A file that the program has not changed is not kept but read again, and must be what it was. Input that has been read
   is read again, and must be what it was. */
#include "calls/internal.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

struct header {
  uint64_t taken;     /* of standard input */
  uint64_t digest[2]; /* of that */
  uint32_t files, descriptors;
  uint32_t closed; /* mask of standard input, output and errors */
  uint32_t zero;
};

struct file_record {
  uint64_t size;
  uint64_t read[2]; /* digest */
  uint32_t path;    /* bytes */
  uint8_t was_there, exists, changed, zero;
};

struct descriptor_record {
  uint64_t offset;
  uint32_t number, file, flags, zero; /* file: the how manyeth */
};

/* --- saving --- */

struct writer {
  uint8_t *bytes;
  size_t size, capacity;
  bool failed;
};

static void put(struct writer *writer, const void *bytes, size_t size) {
  if (!writer->failed && writer->size + size > writer->capacity) {
    const size_t larger = 2 * (writer->size + size);
    uint8_t *grown = realloc(writer->bytes, larger);
    writer->failed = !grown;
    if (grown) {
      writer->bytes = grown;
      writer->capacity = larger;
    }
  }
  if (writer->failed || !size)
    return;
  memcpy(writer->bytes + writer->size, bytes, size);
  writer->size += size;
}

static uint32_t index_of(const struct trax_calls *calls, const struct trax_file *file) {
  uint32_t index = 0;
  for (const struct trax_file *it = calls->files; it != file; it = it->next)
    index++;
  return index;
}

static void put_files(struct writer *writer, const struct trax_calls *calls) {
  for (const struct trax_file *file = calls->files; file; file = file->next) {
    const struct file_record record = {.size = file->size,
                                       .read = {file->read.low64, file->read.high64},
                                       .path = (uint32_t)strlen(file->path),
                                       .was_there = file->was_there,
                                       .exists = file->exists,
                                       .changed = file->changed};
    put(writer, &record, sizeof record);
    put(writer, file->path, record.path);
    if (file->changed)
      put(writer, file->bytes, file->size);
  }
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
  for (const struct trax_file *file = calls->files; file; file = file->next)
    header.files++;
  for (uint32_t i = 0; i < TRAX_MOST_DESCRIPTORS; i++)
    header.descriptors += calls->descriptors[i].file != NULL;
  for (uint32_t i = 0; i < TRAX_FIRST_DESCRIPTOR; i++)
    header.closed |= (uint32_t)calls->closed[i] << i;
  put(&writer, &header, sizeof header);
  put_files(&writer, calls);
  for (uint32_t i = 0; i < TRAX_MOST_DESCRIPTORS; i++) {
    const struct trax_descriptor *descriptor = &calls->descriptors[i];
    if (!descriptor->file)
      continue;
    const struct descriptor_record record = {descriptor->offset, i, index_of(calls, descriptor->file),
                                             descriptor->flags, 0};
    put(&writer, &record, sizeof record);
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

static trax_status restore_file(struct trax_calls *calls, struct reader *reader, trax_error *error) {
  struct file_record record;
  if (!take_record(reader, &record, sizeof record))
    return TRAX_OK; /* the caller reports it */
  const char *text = (const char *)take(reader, record.path);
  char *path = text ? strndup(text, record.path) : NULL;
  struct trax_place place;
  struct trax_file *file = NULL;
  const uint8_t *contents = record.changed ? take(reader, record.size) : NULL;
  if (reader->failed || !path) {
    free(path);
    return TRAX_OK;
  }
  int failure = trax_place_find(calls, path, true, &place);
  if (!failure) {
    failure = trax_file_load(calls, &place, path, record.changed || !record.was_there, &file);
    trax_place_release(&place);
  }
  trax_status status = TRAX_OK;
  if (failure) {
    status = trax_fail(error, "%s: the program's file cannot be opened again: %s", path, strerror(failure));
  } else if (!record.changed && (file->read.low64 != record.read[0] || file->read.high64 != record.read[1])) {
    status = trax_fail(error, "%s: the program's file has changed since the checkpoint", path);
  } else {
    file->exists = record.exists;
    file->changed = record.changed;
    if (record.changed && !(failure = trax_file_resize(file, record.size)) && record.size)
      memcpy(file->bytes, contents, record.size);
    if (failure)
      status = trax_fail(error, "%s: out of memory", path);
  }
  free(path);
  return status;
}

trax_status trax_calls_restore(struct trax_machine *machine, const uint8_t *bytes, size_t size, trax_error *error) {
  struct trax_calls *calls = trax_calls_of(machine);
  struct reader reader = {bytes, size, false};
  struct header header;
  if (!calls)
    return trax_fail(error, "out of memory");
  if (!size)
    return TRAX_OK;
  calls->used = true;
  if (!take_record(&reader, &header, sizeof header))
    return trax_fail(error, "its state of files is damaged");
  trax_status status = restore_input(calls, &header, error);
  for (uint32_t i = 0; i < header.files && !reader.failed && status == TRAX_OK; i++)
    status = restore_file(calls, &reader, error);
  for (uint32_t i = 0; i < TRAX_FIRST_DESCRIPTOR; i++)
    calls->closed[i] = header.closed >> i & 1;
  for (uint32_t i = 0; i < header.descriptors && !reader.failed && status == TRAX_OK; i++) {
    struct descriptor_record record;
    if (!take_record(&reader, &record, sizeof record))
      break;
    struct trax_file *file = calls->files; /* loading puts a file before the others */
    for (uint32_t left = header.files; file && left > record.file + (uint64_t)1; left--)
      file = file->next;
    reader.failed |= !file || record.file >= header.files || record.number < TRAX_FIRST_DESCRIPTOR ||
                     record.number >= TRAX_MOST_DESCRIPTORS;
    if (reader.failed)
      break;
    calls->descriptors[record.number] =
        (struct trax_descriptor){.file = file, .offset = record.offset, .flags = record.flags};
    file->opens++;
  }
  if (status == TRAX_OK && (reader.failed || reader.left))
    return trax_fail(error, "its state of files is damaged");
  return status;
}
