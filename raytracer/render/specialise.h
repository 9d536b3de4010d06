/* Private to specialise.c, program_key.c and program_compile.c. */
#ifndef TRAX_RENDER_SPECIALISE_H
#define TRAX_RENDER_SPECIALISE_H

#include "program_cache.h"
#include "render.h"

enum { PAPERS_CACHE = 4096 }; /* bytes: its instruction cache */

#define OWN_FLAGS "flags.txt" /* in the folder of --source */

/* The compiler's options that depend neither on the picture nor on the attempt. */
struct flags {
  const char *words[32];
  size_t count;
  char own[1024]; /* those of the source */
};

/* The inputs that all compilation attempts share. */
struct recipe {
  const char *root, *source;
  const char *main; /* the file in it that is compiled */
  bool own;         /* the source is the installation's */
  const struct cache_work *work;
  const struct flags *flags;
  const volatile int *interrupt;
};

/* key receives the hash of all inputs, as 32 digits. */
trax_status trax_program_key(char key[33], const char *root, const char *source, const char *constants,
                             const struct flags *flags, uint32_t icache_bytes, trax_error *error);
/* Compiles in the first of the ways whose stack suffices. A program larger than the instruction cache is compiled for
   less code, unless it traces paths and is larger in any case. */
trax_status trax_program_compile(const struct recipe *recipe, const struct trax_frame *frame, uint32_t icache_bytes,
                                 trax_error *error);

#endif
