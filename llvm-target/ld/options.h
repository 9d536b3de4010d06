/* Private to the command line: its table of options, and its words. */
#ifndef LD_OPTIONS_H
#define LD_OPTIONS_H

#include "ld.h"

typedef enum ld_option_id {
  OPT_ACCEPTED, /* without effect */
  OPT_DEFSYM,
  OPT_ERROR_LIMIT,
  OPT_FLAG,    /* sets a bool of ld_options to .value */
  OPT_HEADING, /* no option: its help stands above those that follow */
  OPT_KEYWORD,
  OPT_LIBRARY,
  OPT_LIST, /* appends to an ld_words of ld_options */
  OPT_MAP_STDOUT,
  OPT_NO_STACK_CHECK,
  OPT_REJECTED,
  OPT_SECTION_ADDRESS,
  OPT_SECTION_START,
  OPT_STACK_CHECK,
  OPT_TEXT /* sets a const char * of ld_options */
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
  size_t member; /* its offset in ld_options */
  bool value;
  const char *metavar;
  const char *help; /* NULL: an alias of the option before it, or one that is only accepted */
} ld_option;

/* The option that argument spells, with its value in *value where it is joined; NULL if none. */
const ld_option *ld_find_option(const char *argument, const char **value);

/* The spelling of the option that a mistyped one probably means; NULL if none is similar. */
const char *ld_nearest_option(ld_context *ctx, const char *argument);

/* Adds argument, or, if it is @FILE, the words of that response file. */
void ld_expand(ld_context *ctx, ld_words *words, const char *argument);

#endif
