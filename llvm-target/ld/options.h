/* Private to the command line: its table of options, and its words. */
#ifndef LD_OPTIONS_H
#define LD_OPTIONS_H

#include "ld.h"

typedef enum ld_option_id {
  OPT_ACCEPTED, /* without effect */
  OPT_ALLOW_MULTIPLE,
  OPT_DEFSYM,
  OPT_ENTRY,
  OPT_ERROR_LIMIT,
  OPT_DEMANGLE,
  OPT_NO_DEMANGLE,
  OPT_FATAL_WARNINGS,
  OPT_GC,
  OPT_HEADING, /* no option: its help stands above those that follow */
  OPT_HELP,
  OPT_KEYWORD,
  OPT_LIBRARY,
  OPT_LIBRARY_PATH,
  OPT_MAP,
  OPT_MAP_STDOUT,
  OPT_NO_FATAL_WARNINGS,
  OPT_NO_GC,
  OPT_NO_PRINT_GC,
  OPT_NO_WARNINGS,
  OPT_NO_WHOLE_ARCHIVE,
  OPT_ORDERING,
  OPT_OUTPUT,
  OPT_PRINT_GC,
  OPT_PRINT_MEMORY,
  OPT_PRINT_STACK,
  OPT_REJECTED,
  OPT_SECTION_ADDRESS,
  OPT_SECTION_START,
  OPT_NO_STACK_CHECK,
  OPT_STACK_CHECK,
  OPT_STRIP_ALL,
  OPT_STRIP_DEBUG,
  OPT_TRACE,
  OPT_UNDEFINED,
  OPT_V,
  OPT_VERSION,
  OPT_WHOLE_ARCHIVE,
  OPT_WRAP
} ld_option_id;

typedef enum ld_argument {
  NONE,
  JOINED, /* -xARG or -x ARG */
  VALUE   /* --name=ARG or --name ARG */
} ld_argument;

typedef struct ld_option {
  const char *name; /* without dashes */
  ld_argument argument;
  ld_option_id id;
  const char *metavar;
  const char *help; /* NULL: an alias of the option before it, or one that is only accepted */
} ld_option;

/* The option that argument spells, with its value in *value where it is joined; NULL if none. */
const ld_option *ld_find_option(const char *argument, const char **value);

/* The spelling of the option that a mistyped one probably means; NULL if none is similar. */
const char *ld_nearest_option(ld_context *ctx, const char *argument);

typedef LD_VECTOR(const char *) ld_words;

/* Adds argument, or, if it is @FILE, the words of that response file. */
void ld_expand(ld_context *ctx, ld_words *words, const char *argument);

#endif
