// RUN: %run_c %s %t
// Literals of all kinds of characters, and how their sizes come out.
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

typedef uint16_t char16;
typedef uint32_t char32;
static const wchar_t wide[] = L"a\u00E9\u20AC\U0001F600\x12345";
static const char16 utf16[] = u"a\u00E9\u20AC\U0001F600";
static const char32 utf32[] = U"a\u00E9\u20AC\U0001F600";
static const char utf8[] = u8"a\u00E9\u20AC\U0001F600";
static const char joined[] = "one\0"
                             "two\x41"
                             "\101"
                             "\e";
static const wchar_t mixed[] = L"x"
                               "y";

int main(void) {
  printf("%d %d %d %d %d %d\n", (int)sizeof wide, (int)sizeof utf16, (int)sizeof utf32, (int)sizeof utf8,
         (int)sizeof joined, (int)sizeof mixed);
  for (unsigned i = 0; i < sizeof wide / sizeof wide[0]; i++)
    printf("%x ", (unsigned)wide[i]);
  puts("");
  for (unsigned i = 0; i < sizeof utf16 / sizeof utf16[0]; i++)
    printf("%x ", utf16[i]);
  puts("");
  for (unsigned i = 0; i < sizeof utf32 / sizeof utf32[0]; i++)
    printf("%x ", (unsigned)utf32[i]);
  puts("");
  for (unsigned i = 0; i < sizeof utf8; i++)
    printf("%x ", (unsigned char)utf8[i]);
  puts("");
  printf("%x %x %x %x %d\n", (unsigned)L'\u20AC', u'\u20AC', (unsigned)U'\U0001F600', 'b', '\377');
  printf("%d %d %d\n", (int)sizeof L'a', (int)sizeof u'a', (int)sizeof U'a');
  printf("%s %s %d\n", joined, joined + 4, mixed[1] == L'y');
  printf("%s %s\n", __func__, __FUNCTION__);
  return 0;
}
