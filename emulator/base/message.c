#define _GNU_SOURCE /* vasprintf */
#include "trax/message.h"

#include "trax/progress.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* The colours are clang's. */
static const struct {
  const char *word, *colour;
} kinds[] = {[TRAX_MESSAGE_ERROR] = {"error: ", "\033[1;31m"},
             [TRAX_MESSAGE_WARNING] = {"warning: ", "\033[1;35m"},
             [TRAX_MESSAGE_NOTE] = {"note: ", "\033[1;36m"}};

bool trax_has_colours(int descriptor) {
  const char *refused = getenv("NO_COLOR"), *terminal = getenv("TERM");
  return !(refused && *refused) && terminal && strcmp(terminal, "dumb") != 0 && isatty(descriptor);
}

static bool is_repeated(const char *note) {
  static char **printed; /* as long as the process runs */
  static size_t count;
  for (size_t i = 0; i < count; i++)
    if (strcmp(printed[i], note) == 0)
      return true;
  char **more = realloc(printed, (count + 1) * sizeof *printed);
  if (more) {
    printed = more;
    printed[count] = strdup(note);
    count += printed[count] != NULL;
  }
  return false;
}

void trax_message(const char *program, trax_message_kind kind, const char *format, ...) {
  char *text = NULL;
  va_list arguments;
  va_start(arguments, format);
  const int length = vasprintf(&text, format, arguments);
  va_end(arguments);
  const char *shown = length < 0 ? "out of memory" : text;
  if (kind != TRAX_MESSAGE_NOTE || !is_repeated(shown)) {
    const bool colours = trax_has_colours(STDERR_FILENO);
    trax_progress_clear_drawn();
    fprintf(stderr, "%s: %s%s%s%s\n", program, colours ? kinds[kind].colour : "", kinds[kind].word,
            colours ? "\033[0m" : "", shown);
  }
  if (length >= 0)
    free(text);
}
