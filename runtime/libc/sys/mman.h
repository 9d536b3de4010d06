/* Memory is not mapped. */
#ifndef TRAX_SYS_MMAN_H
#define TRAX_SYS_MMAN_H

#include <sys/types.h>
#include <trax/names.h>

#define PROT_NONE 0
#define PROT_READ 1
#define PROT_WRITE 2
#define PROT_EXEC 4
#define MAP_SHARED 1
#define MAP_PRIVATE 2
#define MAP_ANONYMOUS 32
#define MAP_ANON MAP_ANONYMOUS
#define MAP_FAILED ((void *)-1)

__TRAX_REFUSES(void *, mmap, (void *address, size_t size, int protection, int flags, int descriptor, off_t offset),
               MAP_FAILED, "read files into memory from malloc")
__TRAX_FAILS(int, munmap, (void *address, size_t size), -1)
__TRAX_FAILS(int, mprotect, (void *address, size_t size, int protection), -1)

#endif
