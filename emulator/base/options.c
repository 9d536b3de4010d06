#include "trax/options.h"

#include "trax/names.h"
#include "trax/output.h"
#include "trax/version.h"

#include <ctype.h>
#include <errno.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

static bool has_letters(const trax_command *command) {
  for (const trax_option *row = command->rows; row->name; row++)
    if (row->letter)
      return true;
  return false;
}

static size_t row_count(const trax_command *command) {
  size_t count = 1; /* the last one, without a name */
  while (command->rows[count - 1].name)
    count++;
  return count;
}

static bool is_optional(const trax_option *option) {
  return option->argument && strncmp(option->argument, "[=", 2) == 0;
}

/* --- finding the option --- */

/* The name that a suggestion may propose. A removed option has "", which is near no mistyped name. */
static const char *row_name(const void *rows, size_t i) {
  const trax_option *row = (const trax_option *)rows + i;
  return row->instead ? "" : row->name;
}

static const trax_option *find_name(const trax_command *command, const char *text, size_t length, trax_error *error) {
  char candidates[600] = "";
  const trax_option *found = NULL;
  size_t count = 0, used = 0, matches = 0;
  for (const trax_option *row = command->rows; row->name; row++, count++) {
    if (length == 0 || strncmp(row->name, text, length) != 0)
      continue;
    if (row->name[length] == '\0' && row->instead) {
      trax_fail(error, "--%s has been removed; %s", row->name, row->instead);
      return NULL;
    }
    if (row->name[length] == '\0')
      return row;
    if (row->instead)
      continue;
    found = row;
    if (used < sizeof candidates)
      used += (size_t)snprintf(candidates + used, sizeof candidates - used, "%s--%s", matches ? ", " : "", row->name);
    matches++;
  }
  if (matches == 1)
    return found;
  char name[64];
  snprintf(name, sizeof name, "%.*s", (int)(length < sizeof name ? length : sizeof name - 1), text);
  const char *nearest = trax_nearest_name(name, count, row_name, command->rows);
  if (matches)
    trax_fail(error, "--%s is ambiguous: %s", name, candidates);
  else if (nearest && *nearest)
    trax_fail(error, "unknown option --%s; did you mean --%s?", name, nearest);
  else
    trax_fail(error, "unknown option --%s", name);
  return NULL;
}

static const trax_option *find_letter(const trax_command *command, const char *letters, trax_error *error) {
  for (const trax_option *row = command->rows; row->name; row++)
    if (row->letter == *letters)
      return row;
  if (has_letters(command))
    trax_fail(error, "unknown option -%c", *letters);
  else
    trax_fail(error, "unknown option -%s; options begin with two dashes", letters);
  return NULL;
}

/* --- reading its value --- */

trax_status trax_option_refuse(const trax_option *option, const char *value, trax_error *error, const char *format,
                               ...) {
  char reason[512];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(reason, sizeof reason, format, arguments);
  va_end(arguments);
  return trax_fail(error, "--%s: '%.300s' %s", option->name, value, reason);
}

trax_status trax_option_number(const trax_option *option, const char *text, uint64_t least, uint64_t most,
                               uint64_t *value, trax_error *error) {
  char *end = NULL;
  errno = 0;
  if (isdigit((unsigned char)*text))
    *value = strtoull(text, &end, text[0] == '0' && (text[1] == 'x' || text[1] == 'X') ? 16 : 10);
  if (!end || *end || errno || *value < least || *value > most)
    return trax_option_refuse(option, text, error, "is not a whole number from %llu to %llu", (unsigned long long)least,
                              (unsigned long long)most);
  return TRAX_OK;
}

static const char *choice_name(const void *choices, size_t i) {
  return ((const char *const *)choices)[i];
}

static trax_status set_choice(const trax_option *option, const char *value, unsigned *choice, trax_error *error) {
  char names[300] = "";
  size_t used = 0, count = 0;
  for (unsigned i = 0; option->choices[i]; i++, count++) {
    if (strcmp(option->choices[i], value) == 0) {
      *choice = i;
      return TRAX_OK;
    }
    const char *separator = i == 0 ? "" : option->choices[i + 1] ? ", " : " and ";
    if (used < sizeof names)
      used += (size_t)snprintf(names + used, sizeof names - used, "%s%s", separator, option->choices[i]);
  }
  const char *nearest = trax_nearest_name(value, count, choice_name, option->choices);
  return trax_option_refuse(option, value, error, "is none of %s%s%s%s", names, nearest ? "; did you mean " : "",
                            nearest ? nearest : "", nearest ? "?" : "");
}

static trax_status set_value(const trax_option *option, void *target, const char *value, trax_error *error) {
  void *field = (char *)target + option->offset;
  uint64_t number;
  switch (option->kind) {
  case TRAX_OPTION_SWITCH:
    *(bool *)field = !option->off;
    return TRAX_OK;
  case TRAX_OPTION_TEXT:
    if (option->once && *(const char **)field)
      return trax_fail(error, "--%s is given twice", option->name);
    *(const char **)field = value;
    return TRAX_OK;
  case TRAX_OPTION_UNSIGNED:
    if (option->choices)
      return set_choice(option, value, field, error);
    if (trax_option_number(option, value, option->least, option->most, &number, error) != TRAX_OK)
      return TRAX_ERROR;
    *(unsigned *)field = (unsigned)number;
    return TRAX_OK;
  case TRAX_OPTION_UNSIGNED64:
    return trax_option_number(option, value, option->least, option->most, field, error);
  default:
    return option->parse(target, option, value, error);
  }
}

/* --- the command line --- */

struct parser {
  const trax_command *command;
  void *target;
  int count, next; /* next: the index of the next argument */
  char **arguments;
  bool *given;  /* for each row */
  bool listing; /* --help-words */
};

/* value: the text joined to the option ("=VALUE", "-oVALUE"), or NULL; spelled: the option's name in messages. */
static trax_parsed apply(struct parser *parser, const trax_option *option, const char *value, const char *spelled,
                         trax_error *error) {
  const trax_command *command = parser->command;
  if (value && !option->argument) {
    trax_fail(error, "--%s takes no value", option->name);
    return TRAX_PARSED_WRONG;
  }
  if (!value && option->argument && !is_optional(option)) {
    if (parser->next == parser->count) {
      trax_fail(error, "%s needs %s", spelled, option->argument);
      return TRAX_PARSED_WRONG;
    }
    value = parser->arguments[parser->next++];
  }
  if (value && !*value) {
    trax_fail(error, "--%s: the value is empty", option->name);
    return TRAX_PARSED_WRONG;
  }
  parser->given[option - command->rows] = true;
  if (parser->listing)
    printf("--%s%s%s%c", option->name, value ? "=" : "", value ? value : "", 0);
  switch (option->kind) {
  case TRAX_OPTION_SHOW:
    option->show(stdout);
    return TRAX_PARSED_DONE;
  case TRAX_OPTION_SHOW_HELP:
    trax_command_help(command, stdout);
    return TRAX_PARSED_DONE;
  case TRAX_OPTION_SHOW_VERSION:
    printf("%s " TRAX_VERSION "\n", command->name);
    return TRAX_PARSED_DONE;
  default:
    return set_value(option, parser->target, value, error) == TRAX_OK ? TRAX_PARSED_RUN : TRAX_PARSED_WRONG;
  }
}

/* Prints a line for each option that was given before, for programs that pass options on. */
static void show_given(const struct parser *parser, FILE *out) {
  fprintf(out, "options of %s:\n", parser->command->name);
  for (const trax_option *row = parser->command->rows; row->name; row++)
    if (parser->given[row - parser->command->rows])
      fprintf(out, "--%s%s\n", row->name,
              row->file == TRAX_OPTION_OUTPUT || row->file == TRAX_OPTION_WRITTEN ? " writes"
              : row->file == TRAX_OPTION_INPUT                                    ? " reads"
                                                                                  : "");
}

/* The options that every command has. They are not in the tables, since only packagers and programs use them. */
static bool show_page(const struct parser *parser, const char *name) {
  if (strcmp(name, "help-completion") == 0)
    trax_command_completion(parser->command, stdout);
  else if (strcmp(name, "help-given") == 0)
    show_given(parser, stdout);
  else
    return false;
  return true;
}

static trax_parsed parse_name(struct parser *parser, const char *text, trax_error *error) {
  if (show_page(parser, text))
    return TRAX_PARSED_DONE;
  const char *equals = strchr(text, '=');
  const size_t length = equals ? (size_t)(equals - text) : strlen(text);
  const trax_option *option = find_name(parser->command, text, length, error);
  char spelled[64];
  if (!option)
    return TRAX_PARSED_WRONG;
  snprintf(spelled, sizeof spelled, "--%.60s", option->name);
  return apply(parser, option, equals ? equals + 1 : NULL, spelled, error);
}

/* One-letter switches may be joined, and the last of them may take a value. */
static trax_parsed parse_letters(struct parser *parser, const char *text, trax_error *error) {
  for (; *text; text++) {
    const trax_option *option = find_letter(parser->command, text, error);
    if (!option)
      return TRAX_PARSED_WRONG;
    const bool joined = option->argument && text[1];
    const trax_parsed parsed = apply(parser, option, joined ? text + 1 : NULL, (char[]){'-', *text, '\0'}, error);
    if (parsed != TRAX_PARSED_RUN || joined)
      return parsed;
  }
  return TRAX_PARSED_RUN;
}

static trax_parsed parse(const trax_command *command, void *target, int *count, char **arguments, bool to_operand,
                         trax_error *error) {
  bool given[row_count(command)];
  memset(given, 0, sizeof given);
  struct parser parser = {
      .command = command, .target = target, .count = *count, .next = 1, .arguments = arguments, .given = given};
  parser.listing = *count > 1 && strcmp(arguments[1], "--help-words") == 0;
  parser.next += parser.listing;
  int rest = 0;
  for (bool only_names = false; parser.next < parser.count;) {
    char *text = arguments[parser.next++];
    trax_parsed parsed = TRAX_PARSED_RUN;
    if (only_names || text[0] != '-' || text[1] == '\0') {
      arguments[rest++] = text;
      while (to_operand && parser.next < parser.count)
        arguments[rest++] = arguments[parser.next++];
    } else if (strcmp(text, "--") == 0)
      only_names = true;
    else
      parsed = text[1] == '-' ? parse_name(&parser, text + 2, error) : parse_letters(&parser, text + 1, error);
    if (parsed != TRAX_PARSED_RUN)
      return parsed;
  }
  arguments[rest] = NULL;
  *count = rest;
  if (!parser.listing)
    return TRAX_PARSED_RUN;
  printf("--%c", 0);
  for (int i = 0; i < rest; i++)
    printf("%s%c", arguments[i], 0);
  return TRAX_PARSED_DONE;
}

trax_parsed trax_command_parse(const trax_command *command, void *target, int *count, char **arguments,
                               trax_error *error) {
  return parse(command, target, count, arguments, false, error);
}

trax_parsed trax_command_parse_to_operand(const trax_command *command, void *target, int *count, char **arguments,
                                          trax_error *error) {
  return parse(command, target, count, arguments, true, error);
}

/* --- help and files --- */

static void print_lines(FILE *out, const char *text, unsigned indent) {
  for (bool first = true; *text; first = false) {
    const int length = (int)strcspn(text, "\n");
    fprintf(out, "%*s%.*s\n", first ? 0 : (int)indent, "", length, text);
    text += length + (text[length] == '\n');
  }
}

void trax_command_help(const trax_command *command, FILE *out) {
  fprintf(out, "usage: %s ", command->name);
  for (const char *line = command->synopsis; *line;) { /* each line begins with the program's name */
    const int length = (int)strcspn(line, "\n");
    fprintf(out, "%.*s\n", length, line);
    line += length + (line[length] == '\n');
    if (*line)
      fprintf(out, "%*s%s ", (int)sizeof "usage:", "", command->name);
  }
  fputs("\n", out);
  print_lines(out, command->description, 0);
  fputs("\n", out);
  const bool letters = has_letters(command);
  for (const trax_option *row = command->rows; row->name; row++) {
    if (row->kind == TRAX_OPTION_HEADING)
      fprintf(out, "%s%s:\n", row == command->rows ? "" : "\n", row->meaning);
    if (row->kind == TRAX_OPTION_HEADING || row->instead)
      continue;
    char letter[] = {'-', row->letter, ',', ' ', '\0'};
    const char *between = !row->argument || is_optional(row) ? "" : " ";
    const int length = fprintf(out, "  %s--%s%s%s",
                               row->letter ? letter
                               : letters   ? "    "
                                           : "",
                               row->name, between, row->argument ? row->argument : "");
    fprintf(out, "%*s", length < (int)command->column ? (int)command->column - length : 2, "");
    print_lines(out, row->meaning, command->column);
  }
  if (command->examples) {
    fputs("\nExamples:\n  ", out);
    print_lines(out, command->examples, 2);
  }
  if (command->notes) {
    fputs("\n", out);
    print_lines(out, command->notes, 0);
  }
}

static const char *path_of(const trax_option *row, const void *target) {
  return row->file == TRAX_OPTION_NO_FILE ? NULL : *(const char *const *)((const char *)target + row->offset);
}

void trax_command_files(const trax_command *command, const void *target, trax_files *files) {
  for (const trax_option *row = command->rows; row->name; row++) {
    if (row->file == TRAX_OPTION_INPUT) {
      trax_files_input(files, NULL, path_of(row, target));
    } else if (row->file == TRAX_OPTION_OUTPUT && path_of(row, target)) {
      char name[64];
      snprintf(name, sizeof name, "--%.60s", row->name);
      trax_files_output(files, name, path_of(row, target));
    }
  }
}

trax_status trax_command_check_outputs(const trax_command *command, const void *target, trax_error *error) {
  for (const trax_option *row = command->rows; row->name; row++) {
    const char *path = row->file == TRAX_OPTION_OUTPUT ? path_of(row, target) : NULL;
    if (!path)
      continue;
    if ((row->endings && trax_output_name_check(path, row->endings, error) != TRAX_OK) ||
        trax_output_check(path, error) != TRAX_OK)
      return TRAX_ERROR;
  }
  return TRAX_OK;
}
