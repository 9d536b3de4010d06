/* Characters of UTF-16 and UTF-32 from UTF-8 and back. A state that waits for the second half of a pair has bit 27 set,
   which mbrtowc never sets, and the character of the pair, or its first half, in the lower bits. */
#include <errno.h>
#include <uchar.h>
#include <wchar.h>

enum { HALF = 1 << 27, ERRONEOUS = -1, STORED = -3 };

size_t mbrtoc32(char32_t *restrict c, const char *restrict bytes, size_t count, mbstate_t *restrict state) {
  static mbstate_t own;
  wchar_t wide = 0;
  size_t used = mbrtowc(&wide, bytes, count, state ? state : &own);
  if (c && bytes && used <= 4)
    *c = (char32_t)wide;
  return used;
}

size_t c32rtomb(char *restrict bytes, char32_t c, mbstate_t *restrict state) {
  return wcrtomb(bytes, (wchar_t)c, state);
}

size_t mbrtoc16(char16_t *restrict c, const char *restrict bytes, size_t count, mbstate_t *restrict state) {
  static mbstate_t own;
  if (!state)
    state = &own;
  char32_t whole = 0;
  if (state->__state & HALF) {
    if (c && bytes)
      *c = (char16_t)(0xDC00 | (state->__state & 0x3FF));
    state->__state = 0;
    return (size_t)STORED;
  }
  size_t used = mbrtoc32(&whole, bytes, count, state);
  if (used > 4 || !bytes)
    return used;
  if (whole > 0xFFFF) {
    state->__state = HALF | (whole & 0x3FF);
    whole = 0xD7C0 + (whole >> 10);
  }
  if (c)
    *c = (char16_t)whole;
  return used;
}

size_t c16rtomb(char *restrict bytes, char16_t c, mbstate_t *restrict state) {
  static mbstate_t own;
  if (!state)
    state = &own;
  const unsigned first = state->__state;
  state->__state = 0;
  if (!bytes)
    return 1;
  if (!first && c >= 0xD800 && c < 0xDC00) {
    state->__state = HALF | c;
    return 0;
  }
  if (first && (c < 0xDC00 || c > 0xDFFF)) {
    errno = EILSEQ;
    return (size_t)ERRONEOUS;
  }
  return c32rtomb(bytes, first ? 0x10000 + ((first & 0x3FF) << 10) + (c & 0x3FFu) : c, NULL);
}
