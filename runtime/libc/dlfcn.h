/* Nothing is linked at run time. */
#ifndef TRAX_DLFCN_H
#define TRAX_DLFCN_H

#include <trax/names.h>

#define RTLD_LAZY 1
#define RTLD_NOW 2
#define RTLD_GLOBAL 256
#define RTLD_LOCAL 0

__TRAX_REFUSES(void *, dlopen, (const char *path, int flags), 0, "nothing is linked at run time")
__TRAX_FAILS(void *, dlsym, (void *library, const char *name), 0)
__TRAX_FAILS(int, dlclose, (void *library), -1)
__attribute__((__unused__)) static __inline char *dlerror(void) {
  return (char *)"nothing is linked at run time";
}

#endif
