/* The command line. */
#include "options.h"

#include <ctype.h>
#include <string.h>

static void add_defsym(ld_context *ctx, const char *text) {
  const char *equals = strchr(text, '=');
  if (!equals || equals == text || equals[1] == '\0') {
    ld_error(ctx, "--defsym=%s: expected NAME=VALUE", text);
    return;
  }
  ld_defsym defsym = {.name = ld_format(ctx, "%.*s", (int)(equals - text), text)};
  bool negative = false;
  for (const char *term = equals + 1;; term++) { /* numbers and at most one symbol, with signs between them */
    const char *spelled = ld_format(ctx, "%.*s", (int)strcspn(term, "+-"), term);
    uint32_t number = 0;
    if (isdigit((unsigned char)*spelled)) {
      if (!ld_parse_number(spelled, &number)) {
        ld_error(ctx, "--defsym=%s: '%s' is not a 32-bit number", text, spelled);
        return;
      }
    } else if (*spelled == '\0' || defsym.base || negative) {
      ld_error(ctx, "--defsym=%s: expected numbers and at most one symbol, added, after '='", text);
      return;
    } else {
      defsym.base = spelled;
    }
    defsym.offset += negative ? 0 - number : number;
    term += strlen(spelled);
    negative = *term == '-';
    if (*term == '\0')
      break;
  }
  ld_push(ctx, &ctx->options.defsyms, defsym);
}

/* The address of a segment; false after an error message. */
static bool parse_address(ld_context *ctx, const char *option, const char *value, uint32_t *address) {
  if (!ld_parse_number(value, address))
    ld_error(ctx, "%s=%s: not a 32-bit number", option, value);
  else if (*address < TRAX_NULL_END || *address >= TRAX_LOCAL_BASE || *address % LD_SEGMENT_ALIGNMENT)
    ld_error(ctx, "%s=%s: must be a multiple of %u in global memory, 0x%x or above", option, value,
             LD_SEGMENT_ALIGNMENT, TRAX_NULL_END);
  else
    return true;
  return false;
}

static void add_section_start(ld_context *ctx, const char *name, const char *option, const char *value) {
  ld_section_start start = {.name = name};
  if (!parse_address(ctx, option, value, &start.address))
    return;
  if (strcmp(name, ".text") == 0)
    ctx->options.text_start = start.address; /* where the whole image begins */
  else
    ld_push(ctx, &ctx->options.section_starts, start);
}

static void set_section_start(ld_context *ctx, const char *value) {
  const char *equals = strchr(value, '=');
  if (!equals || equals == value) {
    ld_error(ctx, "--section-start=%s: expected NAME=ADDRESS", value);
    return;
  }
  const char *name = ld_format(ctx, "%.*s", (int)(equals - value), value);
  add_section_start(ctx, name, ld_format(ctx, "--section-start=%s", name), equals + 1);
}

static void set_error_limit(ld_context *ctx, const char *value) {
  uint32_t limit;
  if (ld_parse_number(value, &limit))
    ctx->options.error_limit = limit;
  else
    ld_error(ctx, "--error-limit=%s: not a number", value);
}

static void set_stack_check(ld_context *ctx, const char *value) {
  static const char *const modes[] = {[LD_STACK_ERROR] = "error", [LD_STACK_WARN] = "warn", [LD_STACK_NONE] = "none"};
  for (size_t i = 0; i < sizeof modes / sizeof modes[0]; i++)
    if (strcmp(value, modes[i]) == 0) {
      ctx->options.stack_check = (ld_stack_check)i;
      return;
    }
  ld_error(ctx, "--stack-check=%s: must be error, warn or none", value);
}

/* -z: other linkers' keywords concern features that this machine lacks. */
static void set_keyword(ld_context *ctx, const char *value) {
  static const char stack_size[] = "stack-size=";
  if (!ld_starts_with(value, stack_size))
    ld_warning(ctx, "-z %s is ignored", value);
  else if (!ld_parse_number(value + strlen(stack_size), &ctx->options.stack_size) || !ctx->options.stack_size)
    ld_error(ctx, "-z %s: not a number of bytes", value);
}

static void apply(ld_context *ctx, const ld_option *option, const char *spelled, const char *value) {
  ld_options *options = &ctx->options;
  void *member = (char *)options + option->member;
  switch (option->id) {
  case OPT_ACCEPTED:
  case OPT_HEADING:
    break;
  case OPT_DEFSYM:
    add_defsym(ctx, value);
    break;
  case OPT_ERROR_LIMIT:
    set_error_limit(ctx, value);
    break;
  case OPT_FLAG:
    *(bool *)member = option->value;
    break;
  case OPT_KEYWORD:
    set_keyword(ctx, value);
    break;
  case OPT_LIBRARY: {
    ld_input input = {.name = value, .is_library = true, .whole_archive = options->whole_archive};
    ld_push(ctx, &options->inputs, input);
    break;
  }
  case OPT_LIST:
    ld_push(ctx, (ld_words *)member, value);
    break;
  case OPT_MAP_STDOUT:
    options->map_path = "-";
    break;
  case OPT_NO_STACK_CHECK:
    options->stack_check = LD_STACK_NONE;
    break;
  case OPT_REJECTED:
    ld_error(ctx, "%s: %s", spelled, option->help);
    break;
  case OPT_SECTION_ADDRESS:
    add_section_start(ctx, ld_format(ctx, ".%s", option->name + 1), ld_format(ctx, "-%s", option->name), value);
    break;
  case OPT_SECTION_START:
    set_section_start(ctx, value);
    break;
  case OPT_STACK_CHECK:
    set_stack_check(ctx, value);
    break;
  case OPT_TEXT:
    *(const char **)member = value;
    break;
  }
}

bool ld_parse_options(ld_context *ctx, int argc, char **argv) {
  ld_options *options = &ctx->options;
  options->output = "a.out";
  options->entry = "_start";
  options->text_start = TRAX_NULL_END;
  options->error_limit = 20;

  ld_words arguments = {0};
  for (int i = 0; i < argc; i++)
    ld_expand(ctx, &arguments, argv[i]);

  bool only_files = false;
  for (size_t i = 0; i < arguments.count; i++) {
    const char *argument = arguments.items[i];
    if (argument[0] == '\0') {
      ld_error(ctx, "the name of an input file is empty");
      continue;
    }
    if (only_files || argument[0] != '-' || argument[1] == '\0') {
      ld_input input = {.name = argument, .whole_archive = options->whole_archive};
      ld_push(ctx, &options->inputs, input);
      continue;
    }
    if (strcmp(argument, "--") == 0) {
      only_files = true;
      continue;
    }
    const char *value;
    const ld_option *option = ld_find_option(argument, &value);
    if (!option) {
      const char *nearest = ld_nearest_option(ctx, argument);
      if (nearest)
        ld_error(ctx, "unknown option '%s'; did you mean '%s'?", argument, nearest);
      else
        ld_error(ctx, "unknown option '%s'", argument);
      continue;
    }
    if (option->argument != NONE && !value) {
      if (i + 1 == arguments.count) {
        ld_error(ctx, "'%s' needs an argument: %s", argument, option->metavar);
        continue;
      }
      value = arguments.items[++i];
    }
    if (option->argument != NONE && *value == '\0') {
      ld_error(ctx, "'%s' has an empty argument", argument);
      continue;
    }
    apply(ctx, option, argument, value);
  }
  options->strip_debug |= options->strip_all;
  options->version |= options->version_only;
  if (options->inputs.count == 0 && !options->help && !options->version && ctx->error_count == 0)
    ld_error(ctx, "no input files");
  return ctx->error_count == 0;
}
