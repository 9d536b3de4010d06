/* Numbers of a PLY file, ASCII or binary. */
#include "ply.h"

#include <stdlib.h>
#include <string.h>

/* In ASCII, moves to the next value; false at the end of the file. */
static bool to_value(struct ply_reader *reader) {
  while (ply_is_space(*reader->at))
    reader->at++;
  return reader->at < reader->end;
}

static bool value_ends(const struct ply_reader *reader, const char *end) {
  return (const unsigned char *)end > reader->at &&
         (ply_is_space((unsigned char)*end) || (const unsigned char *)end == reader->end);
}

/* The bytes of a binary value, least significant first; false if the file ends. */
static bool take_bytes(struct ply_reader *reader, enum type type, unsigned char bytes[8]) {
  size_t size = type_sizes[type];
  if ((size_t)(reader->end - reader->at) < size)
    return false;
  for (size_t i = 0; i < size; i++)
    bytes[i] = reader->at[reader->format == big_endian ? size - 1 - i : i];
  reader->at += size;
  return true;
}

trax_status scene_ply_integer(struct ply_reader *reader, enum type type, int64_t *value) {
  if (reader->format == ascii) {
    if (!to_value(reader))
      return scene_ply_fail(reader, "the file ends too early");
    char *end;
    *value = strtoll((const char *)reader->at, &end, 10);
    if (!value_ends(reader, end))
      return scene_ply_fail(reader, "not an integer");
    reader->at = (const unsigned char *)end;
    return TRAX_OK;
  }
  unsigned char bytes[8] = {0};
  if (!take_bytes(reader, type, bytes))
    return scene_ply_fail(reader, "the file ends too early");
  uint32_t word = bytes[0];
  for (unsigned i = 1; i < type_sizes[type]; i++)
    word |= (uint32_t)bytes[i] << 8 * i;
  *value = type == int8 ? (int8_t)word : type == int16 ? (int16_t)word : type == int32 ? (int32_t)word : (int64_t)word;
  return TRAX_OK;
}

trax_status scene_ply_real(struct ply_reader *reader, enum type type, float *value) {
  if (reader->format == ascii) {
    if (!to_value(reader))
      return scene_ply_fail(reader, "the file ends too early");
    char *end;
    *value = strtof((const char *)reader->at, &end);
    if (!value_ends(reader, end))
      return scene_ply_fail(reader, "not a number");
    reader->at = (const unsigned char *)end;
    return TRAX_OK;
  }
  if (type < float32) {
    int64_t integer;
    trax_status result = scene_ply_integer(reader, type, &integer);
    *value = (float)integer;
    return result;
  }
  unsigned char bytes[8] = {0};
  if (!take_bytes(reader, type, bytes))
    return scene_ply_fail(reader, "the file ends too early");
  if (type == float32)
    memcpy(value, bytes, sizeof *value);
  else {
    double wide;
    memcpy(&wide, bytes, sizeof wide);
    *value = (float)wide;
  }
  return TRAX_OK;
}

trax_status scene_ply_skip(struct ply_reader *reader, enum type type) {
  float ignored;
  return scene_ply_real(reader, type, &ignored);
}
