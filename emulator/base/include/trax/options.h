/* The command line of a program. Each of its options stands once, as a row of a table: parsing, --help, mistyped names
   and the list of the files that a run reads and writes follow from it.

     static const trax_option rows[] = {
         {.name = "output", .letter = 'o', .argument = "FILE", .meaning = "the picture", TRAX_OPTION_FIELD(struct my,
   path)}, TRAX_OPTION_HELP('h'), {0}}; static const trax_command command = {.name = "my-program", .synopsis =
   "[options] MESH", .rows = rows};

   Which options exclude or need each other is not in the table: such rules are about several at once, and their
   messages tell the reason. The program checks them when everything is parsed. */
#ifndef TRAX_OPTIONS_H
#define TRAX_OPTIONS_H

#include "trax/files.h"
#include "trax/status.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* What a value is and where it goes. */
typedef enum trax_option_kind {
  TRAX_OPTION_PARSED,   /* parse() knows */
  TRAX_OPTION_SWITCH,   /* a bool, which becomes true, or false if the row says `off` */
  TRAX_OPTION_TEXT,     /* a const char *, into the command line */
  TRAX_OPTION_UNSIGNED, /* an unsigned number from least to most, or, if there are choices, the index of one */
  TRAX_OPTION_UNSIGNED64,
  TRAX_OPTION_SHOW, /* prints, and ends the program: this one by show() */
  TRAX_OPTION_SHOW_HELP,
  TRAX_OPTION_SHOW_VERSION
} trax_option_kind;

typedef struct trax_option trax_option;
struct trax_option {
  const char *name; /* without dashes */
  char letter;      /* 0: none */
  bool off, once;   /* once: a second time is an error; else the last one counts */
  /* NULL: takes no value; "[=VALUE]": takes one only behind '='. */
  const char *argument;
  const char *meaning; /* lines after the first are indented as the first one is */
  trax_option_kind kind;
  size_t offset; /* in the structure that is filled in */
  uint64_t least, most;
  const char *const *choices; /* ended by NULL */
  /* value: not empty; NULL if it is optional and was not given. */
  trax_status (*parse)(void *target, const trax_option *option, const char *value, trax_error *error);
  void (*show)(FILE *out);
  const char *instead; /* of an option that there was: what to use now. Such a row is not listed. */
  /* Of a path. */
  enum { TRAX_OPTION_NO_FILE, TRAX_OPTION_INPUT, TRAX_OPTION_OUTPUT } file;
  const char *endings; /* of an output that has a writer for each: as of trax_output_name_check */
};

/* Where a value goes; its kind is that of the member. */
#define TRAX_OPTION_FIELD(type, member)                                                                                \
  .offset = offsetof(type, member),                                                                                    \
  .kind = _Generic(((type *)0)->member,                                                                                \
      bool: TRAX_OPTION_SWITCH,                                                                                        \
      const char *: TRAX_OPTION_TEXT,                                                                                  \
      unsigned: TRAX_OPTION_UNSIGNED,                                                                                  \
      uint64_t: TRAX_OPTION_UNSIGNED64)

#define TRAX_OPTION_HELP(key)                                                                                          \
  { .name = "help", .letter = key, .meaning = "print this, and end", .kind = TRAX_OPTION_SHOW_HELP }
#define TRAX_OPTION_VERSION                                                                                            \
  { .name = "version", .meaning = "print the version, and end", .kind = TRAX_OPTION_SHOW_VERSION }

typedef struct trax_command {
  const char *name;
  const char *synopsis;    /* what stands behind the name, a line for each way to call it */
  const char *description; /* lines, below it */
  const trax_option *rows; /* ended by one without a name */
  const char *notes;       /* lines, in the end; may be NULL */
  unsigned column;         /* of the meanings, in --help */
} trax_command;

typedef enum trax_parsed {
  TRAX_PARSED_RUN,
  TRAX_PARSED_DONE, /* --help or the like: it was printed */
  TRAX_PARSED_WRONG
} trax_parsed;

/* Fills in *target from arguments[1] and on. What is no option is left in arguments[0] to arguments[*count - 1], in its
   order and before a NULL. Names may be cut short while they are clear; "--" ends the options. */
trax_parsed trax_command_parse(const trax_command *command, void *target, int *count, char **arguments,
                               trax_error *error);
void trax_command_help(const trax_command *command, FILE *out);

/* Adds what the rows say to files. */
void trax_command_files(const trax_command *command, const void *target, trax_files *files);
/* Whether all outputs can be written, and have the endings that they may have. */
trax_status trax_command_check_outputs(const trax_command *command, const void *target, trax_error *error);

/* "--NAME: 'VALUE' is ...": what a parser says of a value that it does not take. */
__attribute__((format(printf, 4, 5))) trax_status trax_option_refuse(const trax_option *option, const char *value,
                                                                     trax_error *error, const char *format, ...);
/* A whole number from least to most, decimal or with 0x. */
trax_status trax_option_number(const trax_option *option, const char *text, uint64_t least, uint64_t most,
                               uint64_t *value, trax_error *error);

#endif
