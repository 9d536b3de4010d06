/* Memory functions: words where both addresses allow it, else bytes. Copies and fills take sixteen words at a time,
   then four, then one. The compiler does not unroll them further, since most calls are for a few words. */
#include <stdint.h>
#include <string.h>

#ifdef __clang__
#define AS_WRITTEN _Pragma("clang loop unroll(disable)")
#define WRITTEN_OUT _Pragma("clang loop unroll(full)")
#else
#define AS_WRITTEN
#define WRITTEN_OUT
#endif

typedef uint32_t __attribute__((may_alias)) word;

static inline int aligned(const void *p) {
  return ((uintptr_t)p & 3) == 0;
}
static inline int aligned_alike(const void *p, const void *q) {
  return (((uintptr_t)p ^ (uintptr_t)q) & 3) == 0;
}

static inline void copy_four(void *to, const void *from) {
  word *t = to;
  const word *f = from;
  word a = f[0], b = f[1], c = f[2], d = f[3];
  t[0] = a;
  t[1] = b;
  t[2] = c;
  t[3] = d;
}

static inline void fill_four(void *to, word pattern) {
  word *t = to;
  t[0] = t[1] = t[2] = t[3] = pattern;
}

void *memcpy(void *restrict to, const void *restrict from, size_t size) {
  unsigned char *t = to;
  const unsigned char *f = from;
  if (aligned_alike(t, f)) {
    while (size && !aligned(t)) {
      *t++ = *f++;
      size--;
    }
    AS_WRITTEN
    for (; size >= 64; size -= 64, t += 64, f += 64)
      WRITTEN_OUT
    for (unsigned i = 0; i < 64; i += 16)
      copy_four(t + i, f + i);
    AS_WRITTEN
    for (; size >= 16; size -= 16, t += 16, f += 16)
      copy_four(t, f);
    AS_WRITTEN
    for (; size >= 4; size -= 4, t += 4, f += 4)
      *(word *)t = *(const word *)f;
    AS_WRITTEN
    for (; size; size--)
      *t++ = *f++;
    return to;
  }
  while (size--)
    *t++ = *f++;
  return to;
}

void *memmove(void *to, const void *from, size_t size) {
  unsigned char *t = to;
  const unsigned char *f = from;
  if ((uintptr_t)t - (uintptr_t)f >= size) { /* forwards is safe: to is not within from */
    if (aligned_alike(t, f)) {
      while (size && !aligned(t)) {
        *t++ = *f++;
        size--;
      }
      for (; size >= 4; size -= 4, t += 4, f += 4)
        *(word *)t = *(const word *)f;
    }
    while (size--)
      *t++ = *f++;
    return to;
  }
  t += size;
  f += size;
  if (aligned_alike(t, f)) {
    while (size && !aligned(t)) {
      *--t = *--f;
      size--;
    }
    for (; size >= 4; size -= 4) {
      t -= 4;
      f -= 4;
      *(word *)t = *(const word *)f;
    }
  }
  while (size--)
    *--t = *--f;
  return to;
}

void *memset(void *to, int byte, size_t size) {
  unsigned char *t = to;
  while (size && !aligned(t)) {
    *t++ = (unsigned char)byte;
    size--;
  }
  word pattern = (unsigned char)byte * 0x01010101u;
  AS_WRITTEN
  for (; size >= 64; size -= 64, t += 64)
    WRITTEN_OUT
  for (unsigned i = 0; i < 64; i += 16)
    fill_four(t + i, pattern);
  AS_WRITTEN
  for (; size >= 16; size -= 16, t += 16)
    fill_four(t, pattern);
  AS_WRITTEN
  for (; size >= 4; size -= 4, t += 4)
    *(word *)t = pattern;
  AS_WRITTEN
  while (size--)
    *t++ = (unsigned char)byte;
  return to;
}

int memcmp(const void *a, const void *b, size_t size) {
  const unsigned char *p = a, *q = b;
  if (aligned(p) &&
      aligned(q)) /* skips equal words; the loop below compares the bytes of the first word that differs */
    for (; size >= 4 && *(const word *)p == *(const word *)q; size -= 4) {
      p += 4;
      q += 4;
    }
  for (; size; size--, p++, q++)
    if (*p != *q)
      return *p - *q;
  return 0;
}

void *memchr(const void *memory, int byte, size_t size) {
  for (const unsigned char *p = memory; size; size--, p++)
    if (*p == (unsigned char)byte)
      return (void *)(uintptr_t)p;
  return NULL;
}
