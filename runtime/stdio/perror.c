/* perror, apart from other output because it needs the messages. */
#include <errno.h>
#include <stdio.h>
#include <string.h>

void perror(const char *text) {
  const char *message = strerror(errno);
  if (text && *text)
    iprintf("%s: %s\n", text, message);
  else
    puts(message);
}
