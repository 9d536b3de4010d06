/* The end of a program without that of its streams and static objects. */
#include "../internal/machine.h"

#include <stdlib.h>

enum { MOST = 32 }; /* as many as C promises */

static void (*functions[MOST])(void);
static unsigned count;
static struct ticket_lock list_lock;

int at_quick_exit(void (*function)(void)) {
  lock(&list_lock);
  const int fits = count < MOST;
  if (fits)
    functions[count++] = function;
  unlock(&list_lock);
  return fits ? 0 : -1;
}

void quick_exit(int status) {
  while (count)
    functions[--count]();
  _Exit(status);
}
