/* Names of C++ in messages, as the programmer wrote them. The demangler is that of the C++ library. */
#include "ld.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

/* <cxxabi.h>. The result is malloc'ed; null unless the whole of name is a mangled name. */
char *__cxa_demangle(const char *name, char *buffer, size_t *length, int *status);

static size_t name_length(const char *text) {
  size_t length = 0;
  while (isalnum((unsigned char)text[length]) || (text[length] && strchr("_.$", text[length])))
    length++;
  return length;
}

const char *ld_demangle(ld_context *ctx, const char *text) {
  if (ctx->options.no_demangle)
    return text;
  for (const char *at = text; *at;) {
    const size_t length = name_length(at);
    char *plain = NULL;
    if (strncmp(at, "_Z", 2) == 0)
      plain = __cxa_demangle(ld_format(ctx, "%.*s", (int)length, at), NULL, NULL, NULL);
    if (!plain) {
      at += length ? length : 1;
      continue;
    }
    const size_t end = (size_t)(at - text) + strlen(plain);
    text = ld_format(ctx, "%.*s%s%s", (int)(at - text), text, plain, at + length);
    at = text + end;
    free(plain);
  }
  return text;
}
