/* A command's page for man(1), and its completion in bash, from its table of options. */
#include "trax/options.h"

#include <ctype.h>
#include <string.h>

#include "trax/version.h"

static bool is_listed(const trax_option *row) {
  return row->kind != TRAX_OPTION_HEADING && !row->instead;
}

/* --- the page --- */

/* Text as roff prints it: what it would take for requests, escapes and hyphens. */
static void put_roff(FILE *out, const char *text, size_t length) {
  for (size_t i = 0; i < length; i++) {
    const bool begins = i == 0 || text[i - 1] == '\n';
    if (begins && (text[i] == '.' || text[i] == '\''))
      fputs("\\&", out);
    if (text[i] == '-')
      fputs("\\-", out);
    else if (text[i] == '\\')
      fputs("\\e", out);
    else if (text[i] != ' ' || !begins) /* a line that begins with a blank would be broken there */
      fputc(text[i], out);
  }
}

static void put_text(FILE *out, const char *text) {
  put_roff(out, text, strlen(text));
  fputc('\n', out);
}

/* The first clause of the description, in one line, as apropos(1) shows it. */
static void put_summary(FILE *out, const char *description) {
  size_t length = strlen(description);
  for (const char *end = description; *end; end++)
    if ((*end == '.' || *end == ':') && (!end[1] || isspace((unsigned char)end[1]))) {
      length = (size_t)(end - description);
      break;
    }
  char line[256];
  length = length < sizeof line ? length : sizeof line;
  for (size_t i = 0; i < length; i++)
    line[i] = description[i] == '\n' ? ' ' : description[i];
  put_roff(out, line, length);
  fputc('\n', out);
}

static void put_option(FILE *out, const trax_option *row) {
  fputs(".TP\n", out);
  if (row->letter)
    fprintf(out, "\\fB\\-%c\\fR, ", row->letter);
  fputs("\\fB\\-\\-", out);
  put_roff(out, row->name, strlen(row->name));
  fputs("\\fR", out);
  if (row->argument) {
    fputs(*row->argument == '[' && row->argument[1] == '=' ? "\\fI" : " \\fI", out);
    put_roff(out, row->argument, strlen(row->argument));
    fputs("\\fR", out);
  }
  fputc('\n', out);
  put_text(out, row->meaning);
}

/* Each command, and below it what it does. */
static void put_examples(FILE *out, const char *examples) {
  fputs(".SH EXAMPLES\n", out);
  for (const char *line = examples; *line;) {
    const size_t length = strcspn(line, "\n"), command = strcspn(line, "#");
    const size_t end = command < length ? command : length;
    fputs(".TP\n\\fB", out);
    size_t shown = end;
    while (shown > 0 && line[shown - 1] == ' ')
      shown--;
    put_roff(out, line, shown);
    fputs("\\fR\n", out);
    if (end < length) {
      put_roff(out, line + end + 2, length - end - 2);
      fputc('\n', out);
    }
    line += length + (line[length] == '\n');
  }
}

void trax_command_man(const trax_command *command, FILE *out) {
  fputs(".TH ", out);
  for (const char *letter = command->name; *letter; letter++)
    *letter == '-' ? fputs("\\-", out) : fputc(toupper((unsigned char)*letter), out);
  fprintf(out, " 1 \"\" \"trax " TRAX_VERSION "\"\n.SH NAME\n");
  put_roff(out, command->name, strlen(command->name));
  fputs(" \\- ", out);
  put_summary(out, command->description);
  fputs(".SH SYNOPSIS\n", out);
  for (const char *line = command->synopsis; *line;) {
    const size_t length = strcspn(line, "\n");
    fputs(line == command->synopsis ? "\\fB" : ".br\n\\fB", out);
    put_roff(out, command->name, strlen(command->name));
    fputs("\\fR ", out);
    put_roff(out, line, length);
    fputc('\n', out);
    line += length + (line[length] == '\n');
  }
  fputs(".SH DESCRIPTION\n", out);
  put_text(out, command->description);
  fputs(".SH OPTIONS\n", out);
  for (const trax_option *row = command->rows; row->name; row++)
    if (row->kind == TRAX_OPTION_HEADING) {
      fputs(".SS ", out);
      put_text(out, row->meaning);
    } else if (is_listed(row)) {
      put_option(out, row);
    }
  if (command->examples)
    put_examples(out, command->examples);
  if (command->notes) {
    fputs(".SH NOTES\n", out);
    put_text(out, command->notes);
  }
  if (command->see_also) {
    fputs(".SH SEE ALSO\n", out);
    put_text(out, command->see_also);
  }
}

/* --- the script --- */

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
