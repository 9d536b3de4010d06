/* Memory functions: words where both addresses allow it, four at a time in copies, else bytes. */
#include <stdint.h>
#include <string.h>

typedef uint32_t __attribute__((may_alias)) word;

static inline int aligned(const void *p) {
  return ((uintptr_t)p & 3) == 0;
}
static inline int aligned_alike(const void *p, const void *q) {
  return (((uintptr_t)p ^ (uintptr_t)q) & 3) == 0;
}

void *memcpy(void *restrict to, const void *restrict from, size_t size) {
  unsigned char *t = to;
  const unsigned char *f = from;
  if (aligned_alike(t, f)) {
    while (size && !aligned(t)) {
      *t++ = *f++;
      size--;
    }
    for (; size >= 16; size -= 16, t += 16, f += 16) {
      word a = ((const word *)f)[0], b = ((const word *)f)[1], c = ((const word *)f)[2], d = ((const word *)f)[3];
      ((word *)t)[0] = a;
      ((word *)t)[1] = b;
      ((word *)t)[2] = c;
      ((word *)t)[3] = d;
    }
    for (; size >= 4; size -= 4, t += 4, f += 4)
      *(word *)t = *(const word *)f;
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
  for (; size >= 16; size -= 16, t += 16) {
    ((word *)t)[0] = pattern;
    ((word *)t)[1] = pattern;
    ((word *)t)[2] = pattern;
    ((word *)t)[3] = pattern;
  }
  for (; size >= 4; size -= 4, t += 4)
    *(word *)t = pattern;
  while (size--)
    *t++ = (unsigned char)byte;
  return to;
}

int memcmp(const void *a, const void *b, size_t size) {
  const unsigned char *p = a, *q = b;
  if (aligned(p) && aligned(q)) /* equal words first; the bytes of the first that differs decide below */
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
