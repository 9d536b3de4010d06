/* Numbers of a PLY file, ASCII or binary. */
#include "ply.h"

#include <stdlib.h>
#include <string.h>

/* Moves to the next value of an ASCII file; false at its end. */
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
static inline bool take_bytes(struct ply_reader *reader, enum type type, unsigned char bytes[8]) {
  const size_t size = type_sizes[type];
  if ((size_t)(reader->end - reader->at) < size)
    return false;
  if (reader->format == little_endian && size == 4) { /* most values */
    memcpy(bytes, reader->at, 4);
    reader->at += 4;
    return true;
  }
  for (size_t i = 0; i < size; i++)
    bytes[i] = reader->at[reader->format == big_endian ? size - 1 - i : i];
  reader->at += size;
  return true;
}

/* --- numbers as most files have them; all others are left to the C library --- */

enum { MOST_DIGITS = 18, MOST_POWER = 22 }; /* 10^22 is a binary64 number */

/* Appends digits to a number. Returns the first character behind them; NULL: there are too many. */
static const unsigned char *take_digits(const unsigned char *at, uint64_t *number, unsigned *count) {
  for (; *at >= '0' && *at <= '9'; at++) {
    if (++*count > MOST_DIGITS)
      return NULL;
    *number = 10 * *number + (uint64_t)(*at - '0');
  }
  return at;
}

/* Returns the first character behind an integer; NULL: it is none of these. */
static const unsigned char *take_integer(const unsigned char *at, int64_t *value) {
  const bool negative = *at == '-';
  uint64_t number = 0;
  unsigned count = 0;
  at = take_digits(at + negative, &number, &count);
  *value = negative ? -(int64_t)number : (int64_t)number;
  return count ? at : NULL;
}

/* Reads a fraction likewise. Digits and power of ten are binary64 numbers, so their product or quotient is rounded
   once. It is rounded to binary32 as the decimal number would be, unless it is halfway between two of these. It is 0 or
   between 1e-22 and 1e38, where binary32 has all of its bits. */
static const unsigned char *take_real(const unsigned char *at, float *value) {
  static const double powers[MOST_POWER + 1] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                                1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
  const bool negative = *at == '-';
  uint64_t number = 0, bits;
  int64_t power = 0;
  unsigned count = 0;
  at = take_digits(at + negative, &number, &count);
  if (at && *at == '.') {
    const unsigned whole = count;
    at = take_digits(at + 1, &number, &count);
    power = (int64_t)whole - (int64_t)count;
  }
  if (!at || count == 0 || number > (uint64_t)1 << 53)
    return NULL;
  if ((*at | 32) == 'e') {
    int64_t exponent;
    at = take_integer(at + 1 + (at[1] == '+' && at[2] != '-'), &exponent);
    if (!at || exponent > 2 * MOST_POWER || exponent < -2 * MOST_POWER)
      return NULL;
    power += exponent;
  }
  if (power > MOST_POWER || power < -MOST_POWER)
    return NULL;
  const double real = power < 0 ? (double)number / powers[-power] : (double)number * powers[power];
  memcpy(&bits, &real, sizeof bits);
  if ((bits & 0x1FFFFFFF) == 0x10000000) /* the bits that binary32 has no room for */
    return NULL;
  *value = negative ? -(float)real : (float)real;
  return at;
}

trax_status scene_ply_integer(struct ply_reader *reader, enum type type, int64_t *value) {
  if (reader->format == ascii) {
    if (!to_value(reader))
      return scene_ply_fail(reader, "the file ends too early");
    const unsigned char *short_end = take_integer(reader->at, value);
    if (short_end && (ply_is_space(*short_end) || short_end == reader->end)) {
      reader->at = short_end;
      return TRAX_OK;
    }
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
    const unsigned char *short_end = take_real(reader->at, value);
    if (short_end && (ply_is_space(*short_end) || short_end == reader->end)) {
      reader->at = short_end;
      return TRAX_OK;
    }
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
