/* The environment, which is empty at the start. The linker takes this file for programs that change it. */
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char *nothing[1];
char **environ = nothing;
static char **own; /* the array from malloc, if environ is that */

/* Texts of setenv. They stay: a program may have their addresses from getenv. */
static struct kept {
  struct kept *next;
  char text[];
} *kept;

static char **find(const char *name, size_t length) {
  for (char **it = environ; it && *it; it++)
    if (strncmp(*it, name, length) == 0 && (*it)[length] == '=')
      return it;
  return NULL;
}

char *__trax_find_variable(const char *name);
char *__trax_find_variable(const char *name) {
  const size_t length = strlen(name);
  char **found = find(name, length);
  return found ? *found + length + 1 : NULL;
}

/* Puts a text "name=value" into the environment. */
static int enter_text(char *text, size_t length) {
  char **found = find(text, length);
  if (found) {
    *found = text;
    return 0;
  }
  size_t count = 0;
  while (environ && environ[count])
    count++;
  char **larger = realloc(environ == own ? own : NULL, (count + 2) * sizeof *larger);
  if (!larger)
    return -1;
  if (environ != own && count)
    memcpy(larger, environ, count * sizeof *larger);
  larger[count] = text;
  larger[count + 1] = NULL;
  environ = own = larger;
  return 0;
}

static int is_name(const char *name) {
  if (name && *name && !strchr(name, '='))
    return 1;
  errno = EINVAL;
  return 0;
}

int setenv(const char *name, const char *value, int overwrite) {
  if (!is_name(name))
    return -1;
  const size_t length = strlen(name), size = strlen(value) + 1;
  if (!overwrite && find(name, length))
    return 0;
  struct kept *made = malloc(sizeof *made + length + 1 + size);
  if (!made)
    return -1;
  made->next = kept;
  kept = made;
  char *text = made->text;
  memcpy(text, name, length);
  text[length] = '=';
  memcpy(text + length + 1, value, size);
  return enter_text(text, length);
}

int unsetenv(const char *name) {
  if (!is_name(name))
    return -1;
  for (char **it; (it = find(name, strlen(name))) != NULL;)
    do
      it[0] = it[1];
    while (*it++);
  return 0;
}

int putenv(char *text) {
  const char *end = strchr(text, '=');
  return end ? enter_text(text, (size_t)(end - text)) : unsetenv(text);
}

int clearenv(void) {
  environ = nothing;
  return 0;
}
