/* The command line of trax-sim. */
#ifndef TRAX_HOST_OPTIONS_H
#define TRAX_HOST_OPTIONS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "host/checkpoint.h"
#include "trax/emulator.h"
#include "trax/explain.h"
#include "trax/manifest.h"
#include "trax/options.h"

/* NAME=VALUE of --set, --bind, --alloc, --dump; folder and name of --dir. */
struct trax_assignment {
  char *name;
  const char *value;      /* in name's allocation, after its NUL */
  uint32_t bytes;         /* of --alloc */
  uint32_t width, height; /* of --dump: a picture of this size; 0: the bytes as they are */
  bool in_manifest;       /* a --dump that the manifest wants, to a file beneath its folder */
  enum { TRAX_ASSIGN_SET, TRAX_ASSIGN_BIND, TRAX_ASSIGN_ALLOC, TRAX_ASSIGN_DUMP, TRAX_ASSIGN_DIR } kind;
};

struct trax_options {
  trax_manifest *manifest; /* that was named instead of a program; NULL: none */
  const char *program, *config, *stats, *ray_cycles, *report, *post_mortem, *signature; /* NULL: not given */
  struct trax_assignment *assignments; /* in the order of the command line */
  size_t assignment_count;
  char **arguments; /* of the program, its name being the first; NULL: none are given */
  int argument_count;
  bool main_on_thread_0;
  uint64_t max_cycles, watchdog, total_items; /* 0: not given */
  struct trax_explain_options explain;
  const struct trax_engine *engine;
  bool engine_is_named;
  unsigned host_threads; /* 0: not given */
  bool gdb;
  uint64_t gdb_port;
  struct trax_checkpoint_options checkpoint;
  bool quiet;
  bool print_config;
};

trax_parsed trax_options_parse(struct trax_options *options, int count, char **arguments, trax_error *error);
/* Checks options that exclude or need each other, or that the engine cannot serve. */
trax_status trax_options_check_conflicts(const struct trax_options *options, trax_error *error);
/* Takes the machine's engine if none is named. Error: the named one cannot run the machine, or the machine's cannot
   serve another option. */
trax_status trax_options_choose_engine(struct trax_options *options, const struct trax_config *config,
                                       trax_error *error);
/* Checks that all outputs can be written. */
trax_status trax_options_check_outputs(const struct trax_options *options, trax_error *error);
/* Prints "; wrote a, b" for the files that a run with these options writes when it finishes. */
void trax_options_print_outputs(const struct trax_options *options, FILE *out);
void trax_options_free(struct trax_options *options);

#endif
