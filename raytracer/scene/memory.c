/* The memory of an importer's process: in proportion to what it has read, whatever the file makes of itself. */
#include "internal.h"

#include <stdio.h>
#include <sys/resource.h>
#include <unistd.h>

enum { FREE_MEMORY = 1 << 30, MEMORY_PER_BYTE = 1024 };

static struct {
  bool limited;
  rlim_t allowed, most; /* bytes of data */
} memory;

/* Pages of data and stack, from the kernel's table. */
static rlim_t used_now(void) {
  unsigned long long pages = 0;
  FILE *table = fopen("/proc/self/statm", "r");
  if (!table || fscanf(table, "%*u %*u %*u %*u %*u %llu", &pages) != 1)
    pages = 0;
  if (table)
    fclose(table);
  return pages * (rlim_t)sysconf(_SC_PAGESIZE);
}

static void set_limit(rlim_t bytes) {
  if (memory.limited)
    setrlimit(RLIMIT_DATA, &(struct rlimit){bytes < memory.most ? bytes : memory.most, memory.most});
}

void scene_limit_memory(void) {
  struct rlimit before;
  const rlim_t used = used_now();
  if (used == 0 || getrlimit(RLIMIT_DATA, &before) != 0)
    return;
  memory.limited = true;
  memory.most = before.rlim_max;
  memory.allowed = used + FREE_MEMORY;
  set_limit(memory.allowed);
}

void scene_reading(void) {
  set_limit(memory.most);
}

void scene_has_read(size_t bytes) {
  memory.allowed += (rlim_t)bytes < (memory.most - memory.allowed) / MEMORY_PER_BYTE ? (rlim_t)bytes * MEMORY_PER_BYTE
                                                                                     : memory.most - memory.allowed;
  set_limit(memory.allowed);
}
