/* UTF-8. The state of an incomplete character has the number of missing bytes in its upper 4 bits, the number of all
   its bytes in the next 4, and the bits so far in the others. */
#include <errno.h>
#include <stdlib.h>
#include <wchar.h>

static mbstate_t shared;

int mbsinit(const mbstate_t *state) {
  return !state || state->__state == 0;
}

static size_t fail(mbstate_t *state) {
  state->__state = 0;
  errno = EILSEQ;
  return (size_t)-1;
}

size_t mbrtowc(wchar_t *restrict c, const char *restrict bytes, size_t count, mbstate_t *restrict state) {
  static const unsigned least[] = {0, 0, 0x80, 0x800, 0x10000};
  if (!state)
    state = &shared;
  if (!bytes)
    return mbrtowc(NULL, "", 1, state);
  unsigned to_come = state->__state >> 28, length = state->__state >> 24 & 15, bits = state->__state & 0xFFFFFF;
  for (size_t used = 0; used < count;) {
    unsigned byte = (unsigned char)bytes[used++];
    if (to_come) {
      if ((byte & 0xC0) != 0x80)
        return fail(state);
      bits = bits << 6 | (byte & 0x3F);
      to_come--;
    } else if (byte < 0x80) {
      length = 1;
      bits = byte;
    } else if (byte >= 0xC2 && byte < 0xF5) {
      length = byte < 0xE0 ? 2 : byte < 0xF0 ? 3 : 4;
      to_come = length - 1;
      bits = byte & (0x7Fu >> length);
    } else {
      return fail(state);
    }
    if (!to_come) {
      if (bits < least[length] || bits > 0x10FFFF || bits - 0xD800 < 0x800)
        return fail(state);
      state->__state = 0;
      if (c)
        *c = (wchar_t)bits;
      return bits ? used : 0;
    }
  }
  state->__state = to_come << 28 | length << 24 | bits;
  return (size_t)-2;
}

size_t mbrlen(const char *restrict bytes, size_t count, mbstate_t *restrict state) {
  static mbstate_t own;
  return mbrtowc(NULL, bytes, count, state ? state : &own);
}

size_t wcrtomb(char *restrict bytes, wchar_t c, mbstate_t *restrict state) {
  unsigned code = (unsigned)c;
  if (!state)
    state = &shared;
  if (!bytes)
    return 1;
  if (code < 0x80) {
    *bytes = (char)code;
    return 1;
  }
  if (code > 0x10FFFF || code - 0xD800 < 0x800)
    return fail(state);
  size_t size = code < 0x800 ? 2 : code < 0x10000 ? 3 : 4;
  for (size_t i = size - 1; i > 0; i--, code >>= 6)
    bytes[i] = (char)(0x80 | (code & 0x3F));
  bytes[0] = (char)(0xF00 >> size | code);
  return size;
}

size_t mbsrtowcs(wchar_t *restrict to, const char **restrict from, size_t count, mbstate_t *restrict state) {
  const char *at = *from;
  size_t done = 0;
  for (; !to || done < count; done++) {
    wchar_t c;
    size_t used = mbrtowc(&c, at, 4, state);
    if (used > 4) {
      *from = to ? at : *from;
      return (size_t)-1;
    }
    if (to)
      to[done] = c;
    at += used;
    if (c == 0) {
      *from = to ? NULL : *from;
      return done;
    }
  }
  *from = at;
  return done;
}

size_t wcsrtombs(char *restrict to, const wchar_t **restrict from, size_t count, mbstate_t *restrict state) {
  const wchar_t *at = *from;
  size_t done = 0;
  for (;; at++) {
    char bytes[4];
    size_t size = wcrtomb(bytes, *at, state);
    if (size > 4)
      return (size_t)-1;
    if (to && done + size > count)
      break;
    for (size_t i = 0; to && i < size; i++)
      to[done + i] = bytes[i];
    if (*at == 0) {
      *from = to ? NULL : *from;
      return done;
    }
    done += size;
  }
  *from = at;
  return done;
}

wint_t btowc(int c) {
  return c >= 0 && c < 0x80 ? (wint_t)c : WEOF;
}

int wctob(wint_t c) {
  return (unsigned)c < 0x80 ? (int)c : -1;
}

int mbtowc(wchar_t *restrict c, const char *restrict bytes, size_t count) {
  mbstate_t state = {0};
  if (!bytes)
    return 0;
  size_t used = mbrtowc(c, bytes, count, &state);
  return used > 4 ? -1 : (int)used;
}

int mblen(const char *bytes, size_t count) {
  return mbtowc(NULL, bytes, count);
}

int wctomb(char *bytes, wchar_t c) {
  mbstate_t state = {0};
  return bytes ? (int)wcrtomb(bytes, c, &state) : 0;
}

size_t mbstowcs(wchar_t *restrict to, const char *restrict from, size_t count) {
  mbstate_t state = {0};
  const char *at = from;
  return mbsrtowcs(to, &at, count, &state);
}

size_t wcstombs(char *restrict to, const wchar_t *restrict from, size_t count) {
  mbstate_t state = {0};
  const wchar_t *at = from;
  return wcsrtombs(to, &at, count, &state);
}
