/* The command line of a program. Each option is one row of a table, from which parsing, --help, suggestions for
   mistyped names, and the list of files that a run reads and writes follow.

     static const trax_option rows[] = {
         {"output", 'o', .argument = "FILE", .meaning = "the picture", TRAX_OPTION_FIELD(struct my, path)},
         TRAX_OPTION_HELP('h'),
         {0}};
     static const trax_command command = {.name = "my-program", .synopsis = "[options] MESH", .rows = rows};

   The table does not say which options exclude or need each other. The program checks such rules after parsing, with
   messages that give the reason. */
#ifndef TRAX_OPTIONS_H
#define TRAX_OPTIONS_H

#include "trax/files.h"
#include "trax/status.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* The type of a value, and of the member that receives it. */
typedef enum trax_option_kind {
  TRAX_OPTION_PARSED,   /* parse() stores it */
  TRAX_OPTION_SWITCH,   /* a bool, which becomes true, or false if the row says `off` */
  TRAX_OPTION_TEXT,     /* a const char *, into the command line */
  TRAX_OPTION_UNSIGNED, /* an unsigned number from least to most, or, if there are choices, the index of one */
  TRAX_OPTION_UNSIGNED64,
  TRAX_OPTION_HEADING, /* no option: its meaning is the heading of the following options */
  TRAX_OPTION_SHOW,    /* prints, and ends the program: this one by show() */
  TRAX_OPTION_SHOW_HELP,
  TRAX_OPTION_SHOW_VERSION
} trax_option_kind;

typedef struct trax_option trax_option;
struct trax_option {
  const char *name; /* without dashes */
  char letter;      /* 0: none */
  bool off, once;   /* once: giving it twice is an error; else the last one counts */
  /* NULL: the option takes no value; "[=VALUE]": it takes one only after '='. */
  const char *argument;
  const char *meaning; /* lines after the first are indented as the first one is */
  trax_option_kind kind;
  size_t offset; /* in the structure that is filled in */
  uint64_t least, most;
  const char *const *choices; /* ended by NULL; if there is a parse(), only offered by the completion */
  void (*words)(FILE *out);   /* prints what the completion offers, with blanks or newlines between */
  /* value is not empty; it is NULL if it is optional and was not given. */
  trax_status (*parse)(void *target, const trax_option *option, const char *value, trax_error *error);
  void (*show)(FILE *out);
  const char *instead; /* of a removed option: what to use instead. --help does not list such a row. */
  /* Whether the value is a path. WRITTEN: of an output, or a folder of some, that the program checks itself. */
  enum { TRAX_OPTION_NO_FILE, TRAX_OPTION_INPUT, TRAX_OPTION_OUTPUT, TRAX_OPTION_WRITTEN } file;
  const char *endings; /* of an output: the endings with a writer, as for trax_output_name_check */
};

/* The member that a value is stored to; the option's kind follows from the member's type. */
#define TRAX_OPTION_FIELD(type, member)                                                                                \
  .offset = offsetof(type, member), .kind = _Generic(((type *)0)->member,                                              \
                                        bool: TRAX_OPTION_SWITCH,                                                      \
                                        const char *: TRAX_OPTION_TEXT,                                                \
                                        unsigned: TRAX_OPTION_UNSIGNED,                                                \
                                        uint64_t: TRAX_OPTION_UNSIGNED64)

/* Begins a group of options in --help. */
#define TRAX_OPTION_GROUP(title) {.name = "", .meaning = title, .kind = TRAX_OPTION_HEADING}

#define TRAX_OPTION_HELP(key)                                                                                          \
  {.name = "help", .letter = key, .meaning = "print this, and end", .kind = TRAX_OPTION_SHOW_HELP}
#define TRAX_OPTION_VERSION                                                                                            \
  {.name = "version", .meaning = "print the version, and end", .kind = TRAX_OPTION_SHOW_VERSION},                      \
      {.name = "help-man", .instead = "the pages are in share/man, and man NAME shows one"}

typedef struct trax_command {
  const char *name;
  const char *synopsis;       /* the text after the program's name, a line for each way to call it */
  const char *description;    /* lines below the synopsis */
  const trax_option *rows;    /* ended by a row without a name */
  const char *notes;          /* lines at the end; may be NULL */
  const char *examples;       /* "COMMAND  # MEANING", a line each; may be NULL */
  const char *part, *part_of; /* a first word, such as compare, that the program part_of takes and completes */
  unsigned column;            /* the column of the meanings in --help */
} trax_command;

typedef enum trax_parsed {
  TRAX_PARSED_RUN,
  TRAX_PARSED_DONE, /* an option such as --help was carried out */
  TRAX_PARSED_WRONG
} trax_parsed;

/* Fills in *target from arguments[1] and on. The arguments that are not options are moved to arguments[0] to
   arguments[*count - 1], in their order, followed by NULL. Names may be abbreviated as long as they are unambiguous;
   "--" ends the options. */
trax_parsed trax_command_parse(const trax_command *command, void *target, int *count, char **arguments,
                               trax_error *error);
/* The same up to the first argument that is not an option; what follows it is not read. */
trax_parsed trax_command_parse_to_operand(const trax_command *command, void *target, int *count, char **arguments,
                                          trax_error *error);
void trax_command_help(const trax_command *command, FILE *out);
/* Every command has the options --help-completion, too, which prints a script that completes its options in bash, and
   --help-given, which prints the options before it, one a line, by their whole names, with " reads" or " writes" if the
   value is a file. After --help-words as the first one, the options are printed in their order as --NAME=VALUE, then
   "--" and the operands, each ended by a null byte. */
void trax_command_completion(const trax_command *command, FILE *out);

/* Adds the files that the options name to the list. */
void trax_command_files(const trax_command *command, const void *target, trax_files *files);
/* Checks that all outputs can be written and have valid endings. */
trax_status trax_command_check_outputs(const trax_command *command, const void *target, trax_error *error);

/* Rejects a value: "--NAME: 'VALUE' is ...". */
__attribute__((format(printf, 4, 5))) trax_status trax_option_refuse(const trax_option *option, const char *value,
                                                                     trax_error *error, const char *format, ...);
/* Parses a whole number from least to most, decimal or with 0x. */
trax_status trax_option_number(const trax_option *option, const char *text, uint64_t least, uint64_t most,
                               uint64_t *value, trax_error *error);

#endif
