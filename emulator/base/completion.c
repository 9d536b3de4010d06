/* A command's completion in bash, from its table of options. */
#include "trax/options.h"

#include <string.h>

static bool is_listed(const trax_option *row) {
  return row->kind != TRAX_OPTION_HEADING && !row->instead;
}

/* Does its value name a file? */
static bool takes_file(const trax_option *row) {
  static const char *const words[] = {"FILE", "DIR", "SCENE"};
  for (size_t i = 0; row->argument && i < sizeof words / sizeof *words; i++)
    if (strstr(row->argument, words[i]))
      return true;
  return row->file != TRAX_OPTION_NO_FILE;
}

static void put_pattern(FILE *out, const trax_option *row) {
  if (row->letter)
    fprintf(out, "-%c | ", row->letter);
  fprintf(out, "--%s", row->name);
}

/* The function that completes a program's words. */
static const char *function_of(const char *program, char function[64]) {
  snprintf(function, 64, "_%s", program);
  for (char *letter = function; *letter; letter++)
    *letter = *letter == '-' ? '_' : *letter;
  return function;
}

/* The command that offers files, each in a line: names may have blanks. A blank that was typed has a backslash. */
#define FILES "compgen -f -- \"${word//\\\\/}\""

/* Words, and files if the value may be one. Behind KEY of KEY=VALUE there is no blank. */
static void put_words(FILE *out, const trax_option *row) {
  const bool is_key = strncmp(row->argument, "KEY=", 4) == 0;
  fprintf(out, "mapfile -t COMPREPLY < <(compgen %s-W '", is_key ? "-S = " : "");
  for (size_t i = 0; row->choices && row->choices[i]; i++)
    fprintf(out, "%s%s", i ? " " : "", row->choices[i]);
  if (row->words)
    row->words(out);
  fputs("' -- \"$word\"", out);
  if (takes_file(row))
    fputs("; " FILES, out);
  fputs("); ", out);
  if (is_key)
    fputs("compopt -o nospace 2> /dev/null; ", out);
}

void trax_command_completion(const trax_command *command, FILE *out) {
  char function[64];
  fprintf(out, "# Completes the options of %s in bash.\n%s() {\n", command->name, function_of(command->name, function));
  fputs("  local word=${COMP_WORDS[COMP_CWORD]} option=${COMP_WORDS[COMP_CWORD - 1]}\n"
        "  if [[ $word == = ]]; then\n    word=\n"
        "  elif [[ $option == = ]]; then\n    option=${COMP_WORDS[COMP_CWORD - 2]}\n  fi\n"
        "  COMPREPLY=()\n",
        out);
  if (command->part)
    fprintf(out,
            "  if [[ ${COMP_WORDS[1]} == %s ]] && ((COMP_CWORD > 1)); then\n"
            "    declare -F %s > /dev/null || source \"${BASH_SOURCE[0]%%/*}/%s\"\n    %s\n    return\n  fi\n",
            command->part, function_of(command->part_of, function), command->part_of,
            function_of(command->part_of, function));
  fputs("  case $option in\n", out);
  for (const trax_option *row = command->rows; row->name; row++) {
    if (!is_listed(row) || !row->argument || strncmp(row->argument, "[=", 2) == 0)
      continue;
    fputs("    ", out);
    put_pattern(out, row);
    fputs(") ", out);
    if (row->choices || row->words)
      put_words(out, row);
    else if (takes_file(row))
      fputs("mapfile -t COMPREPLY < <(" FILES "); ", out);
    fputs("return ;;\n", out);
  }
  fputs("  esac\n  if [[ $word == -* ]]; then\n    mapfile -t COMPREPLY < <(compgen -W '", out);
  bool first = true;
  for (const trax_option *row = command->rows; row->name; row++)
    if (is_listed(row)) {
      fprintf(out, "%s--%s", first ? "" : " ", row->name);
      first = false;
    }
  fputs("' -- \"$word\")\n  else\n    mapfile -t COMPREPLY < <(" FILES, out);
  if (command->part)
    fprintf(out, "; compgen -W '%s' -- \"$word\"", command->part);
  fputs(")\n  fi\n}\n", out);
  fprintf(out, "complete -o filenames -F %s %s\n", function_of(command->name, function), command->name);
}
