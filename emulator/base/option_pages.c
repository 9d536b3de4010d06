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
  if (command->notes) {
    fputs(".SH NOTES\n", out);
    put_text(out, command->notes);
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

void trax_command_completion(const trax_command *command, FILE *out) {
  char function[64];
  snprintf(function, sizeof function, "_%s", command->name);
  for (char *letter = function; *letter; letter++)
    *letter = *letter == '-' ? '_' : *letter;
  fprintf(out, "# Completes the options of %s in bash.\n%s() {\n", command->name, function);
  fputs("  local word=${COMP_WORDS[COMP_CWORD]} option=${COMP_WORDS[COMP_CWORD - 1]}\n"
        "  if [[ $word == = ]]; then\n    word=\n"
        "  elif [[ $option == = ]]; then\n    option=${COMP_WORDS[COMP_CWORD - 2]}\n  fi\n"
        "  COMPREPLY=()\n  case $option in\n",
        out);
  for (const trax_option *row = command->rows; row->name; row++) {
    if (!is_listed(row) || !row->argument || strncmp(row->argument, "[=", 2) == 0)
      continue;
    fputs("    ", out);
    put_pattern(out, row);
    fputs(") ", out);
    if (row->choices) {
      fputs("COMPREPLY=($(compgen -W '", out);
      for (size_t i = 0; row->choices[i]; i++)
        fprintf(out, "%s%s", i ? " " : "", row->choices[i]);
      fputs("' -- \"$word\")); ", out);
    } else if (takes_file(row)) {
      fputs("COMPREPLY=($(compgen -f -- \"$word\")); ", out);
    }
    fputs("return ;;\n", out);
  }
  fputs("  esac\n  if [[ $word == -* ]]; then\n    COMPREPLY=($(compgen -W '", out);
  bool first = true;
  for (const trax_option *row = command->rows; row->name; row++)
    if (is_listed(row)) {
      fprintf(out, "%s--%s", first ? "" : " ", row->name);
      first = false;
    }
  fputs("' -- \"$word\"))\n  else\n    COMPREPLY=($(compgen -f -- \"$word\"))\n  fi\n}\n", out);
  fprintf(out, "complete -o filenames -F %s %s\n", function, command->name);
}
