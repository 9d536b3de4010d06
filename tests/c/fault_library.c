// RUN: %run_c %s %t --turns -O0,-O2 --fault "null page" --fault string/memory.c: --fault fault_library.c:9
// A fault within the library: the report names its source, and the line of the call.
#include <string.h>

static char *volatile nothing;
static volatile size_t size = 100;

int main(void) {
  memset(nothing, 1, size);
  size = 0;
  return 0;
}
