/* perror, apart from other output because it needs the messages. */
#include <errno.h>
#include <stdio.h>
#include <string.h>

void perror(const char *text) {
  const char *message = strerror(errno);
  if (text && *text)
    fiprintf(stderr, "%s: %s\n", text, message);
  else
    fiprintf(stderr, "%s\n", message);
}
