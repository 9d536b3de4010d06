/* Response files. */
#include "options.h"

#include <ctype.h>
#include <string.h>

#define MAX_RESPONSE_DEPTH 32
#define MAX_RESPONSE_FILES 1000 /* two mentions in each of 32 nested files would be 2^32 */

static void expand(ld_context *ctx, ld_words *words, const char *argument, unsigned depth);

/* The words of a response file: separated by white space; single and double quotes keep it, a backslash takes the next
   character as it is (not within single quotes). Words are built over the text that they come from. */
static void split_words(ld_context *ctx, ld_words *words, char *text, const char *path, unsigned depth) {
  char *from = text;
  for (;;) {
    while (isspace((unsigned char)*from))
      from++;
    if (*from == '\0')
      return;
    char *word = from, *to = from, quote = '\0';
    for (; *from != '\0' && (quote || !isspace((unsigned char)*from)); from++) {
      if (quote && *from == quote) {
        quote = '\0';
      } else if (!quote && (*from == '\'' || *from == '"')) {
        quote = *from;
      } else {
        if (*from == '\\' && quote != '\'' && from[1] != '\0')
          from++;
        *to++ = *from;
      }
    }
    bool last = *from == '\0';
    *to = '\0';
    if (quote) {
      ld_error(ctx, "%s: a %c quote is not closed", path, quote);
      return;
    }
    expand(ctx, words, word, depth + 1);
    if (last)
      return;
    from++;
  }
}

static void expand(ld_context *ctx, ld_words *words, const char *argument, unsigned depth) {
  if (argument[0] != '@' || argument[1] == '\0') {
    ld_push(ctx, words, argument);
    return;
  }
  const char *path = argument + 1;
  const uint8_t *bytes;
  size_t size;
  unsigned *files = &ctx->options.response_files;
  ld_push(ctx, &ctx->options.response_paths, path);
  if (*files > MAX_RESPONSE_FILES) /* an error that was reported */
    return;
  if (depth > MAX_RESPONSE_DEPTH) {
    ld_error(ctx, "%s: response files are nested more than %d deep", path, MAX_RESPONSE_DEPTH);
    *files = MAX_RESPONSE_FILES + 1;
  } else if (++*files > MAX_RESPONSE_FILES) {
    ld_error(ctx, "%s: more than %d response files", path, MAX_RESPONSE_FILES);
  } else if (ld_read_file(ctx, path, &bytes, &size)) {
    if (memchr(bytes, '\0', size))
      ld_error(ctx, "%s: is not text (a response file)", path);
    else
      split_words(ctx, words, (char *)bytes, path, depth);
  }
}

void ld_expand(ld_context *ctx, ld_words *words, const char *argument) {
  expand(ctx, words, argument, 0);
}
