#include "trax/status.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

trax_status trax_fail(trax_error *error, const char *format, ...) {
  if (error) {
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(error->message, sizeof error->message, format, arguments);
    va_end(arguments);
    if (error->message[0] == ':') { /* the message is about a file whose name is empty */
      memmove(error->message + 2, error->message, sizeof error->message - 2);
      memcpy(error->message, "\"\"", 2);
      error->message[sizeof error->message - 1] = '\0';
    }
  }
  return TRAX_ERROR;
}
