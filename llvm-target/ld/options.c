/* The command line: one table of options, from which parsing and --help both work; response files.

   It is not trax/options.h's: compilers and makefiles call this program as they call GNU ld, whose long names may have
   one dash, whose letters take joined values, whose options have aliases, and where an option's place among the inputs
   counts. */
#include "ld.h"
#include "trax/names.h"

#include <ctype.h>
#include <string.h>

typedef enum option_id {
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
  OPT_RELOCATABLE,
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
} option_id;

typedef enum argument {
  NONE,
  JOINED, /* -xARG or -x ARG */
  VALUE   /* --name=ARG or --name ARG */
} argument;

typedef struct option {
  const char *name; /* without dashes */
  argument argument;
  option_id id;
  const char *metavar;
  const char *help; /* NULL: an alias of the option before it, or one that is only accepted */
} option;

/* clang-format off */
static const option option_table[] = {
    {"", NONE, OPT_HEADING, NULL, "Files"},
    {"o", JOINED, OPT_OUTPUT, "FILE", "write the executable to FILE (default a.out)"},
    {"output", VALUE, OPT_OUTPUT, "FILE", NULL},
    {"L", JOINED, OPT_LIBRARY_PATH, "DIR", "search DIR for libraries"},
    {"library-path", VALUE, OPT_LIBRARY_PATH, "DIR", NULL},
    {"l", JOINED, OPT_LIBRARY, "NAME", "link libNAME.a, or the file NAME if written -l:NAME"},
    {"library", VALUE, OPT_LIBRARY, "NAME", NULL},
    {"whole-archive", NONE, OPT_WHOLE_ARCHIVE, NULL, "take every member of the archives that follow"},
    {"no-whole-archive", NONE, OPT_NO_WHOLE_ARCHIVE, NULL, "take only needed members (default)"},
    {"", NONE, OPT_HEADING, NULL, "What is linked"},
    {"e", JOINED, OPT_ENTRY, "SYMBOL", "start at SYMBOL or at an address (default _start)"},
    {"entry", VALUE, OPT_ENTRY, "SYMBOL", NULL},
    {"r", NONE, OPT_RELOCATABLE, NULL, "make one relocatable object instead of an executable"},
    {"relocatable", NONE, OPT_RELOCATABLE, NULL, NULL},
    {"u", JOINED, OPT_UNDEFINED, "SYMBOL", "take and keep the definition of SYMBOL"},
    {"undefined", VALUE, OPT_UNDEFINED, "SYMBOL", NULL},
    {"defsym", VALUE, OPT_DEFSYM, "NAME=VALUE", "define NAME as a sum of numbers and at most one symbol"},
    {"wrap", VALUE, OPT_WRAP, "SYMBOL", "references to SYMBOL go to __wrap_SYMBOL, those to __real_SYMBOL to SYMBOL"},
    {"allow-multiple-definition", NONE, OPT_ALLOW_MULTIPLE, NULL, "of several definitions of a symbol take the first"},
    {"gc-sections", NONE, OPT_GC, NULL, "drop sections that the program cannot reach"},
    {"no-gc-sections", NONE, OPT_NO_GC, NULL, "keep all sections (default)"},
    {"print-gc-sections", NONE, OPT_PRINT_GC, NULL, "print the dropped sections"},
    {"no-print-gc-sections", NONE, OPT_NO_PRINT_GC, NULL, NULL},
    {"", NONE, OPT_HEADING, NULL, "Symbols and debug information"},
    {"s", NONE, OPT_STRIP_ALL, NULL, "leave out symbols and debug information"},
    {"strip-all", NONE, OPT_STRIP_ALL, NULL, NULL},
    {"S", NONE, OPT_STRIP_DEBUG, NULL, "leave out debug information"},
    {"strip-debug", NONE, OPT_STRIP_DEBUG, NULL, NULL},
    {"", NONE, OPT_HEADING, NULL, "Layout"},
    {"Ttext", VALUE, OPT_SECTION_ADDRESS, "ADDRESS", "put the image at ADDRESS (default 0x1000; a multiple of 64)"},
    {"Tdata", VALUE, OPT_SECTION_ADDRESS, "ADDRESS", "put .data at ADDRESS, a multiple of 64, and what follows behind it"},
    {"Tbss", VALUE, OPT_SECTION_ADDRESS, "ADDRESS", "put .bss at ADDRESS, likewise"},
    {"section-start", VALUE, OPT_SECTION_START, "NAME=ADDRESS", "put the section NAME at ADDRESS, likewise"},
    {"symbol-ordering-file", VALUE, OPT_ORDERING, "FILE", "put the sections of the symbols that FILE lists first, in its order"},
    {"", NONE, OPT_HEADING, NULL, "What is reported"},
    {"Map", VALUE, OPT_MAP, "FILE", "write a map of the image to FILE, - for standard output"},
    {"M", NONE, OPT_MAP_STDOUT, NULL, "print the map"},
    {"print-map", NONE, OPT_MAP_STDOUT, NULL, NULL},
    {"print-memory-usage", NONE, OPT_PRINT_MEMORY, NULL, "print the sizes of text, data and local memory"},
    {"print-stack", NONE, OPT_PRINT_STACK, NULL, "print the deepest path of calls, and what has no bound"},
    {"t", NONE, OPT_TRACE, NULL, "print the files that are linked"},
    {"trace", NONE, OPT_TRACE, NULL, NULL},
    {"verbose", NONE, OPT_TRACE, NULL, NULL},
    {"demangle", NONE, OPT_DEMANGLE, NULL, NULL},
    {"no-demangle", NONE, OPT_NO_DEMANGLE, NULL, "print names of C++ as they stand in the files"},
    {"error-limit", VALUE, OPT_ERROR_LIMIT, "N", "show at most N errors (default 20; 0: all)"},
    {"fatal-warnings", NONE, OPT_FATAL_WARNINGS, NULL, "warnings are errors"},
    {"no-fatal-warnings", NONE, OPT_NO_FATAL_WARNINGS, NULL, NULL},
    {"w", NONE, OPT_NO_WARNINGS, NULL, "no warnings"},
    {"no-warnings", NONE, OPT_NO_WARNINGS, NULL, NULL},
    {"", NONE, OPT_HEADING, NULL, "Stack"},
    {"stack-check", VALUE, OPT_STACK_CHECK, "MODE", "a stack too deep for its room: error (default), warn or none"},
    {"no-stack-check", NONE, OPT_NO_STACK_CHECK, NULL, NULL},
    {"no-check-stack", NONE, OPT_NO_STACK_CHECK, NULL, NULL},
    {"z", JOINED, OPT_KEYWORD, "stack-size=N", "the stack's room is N bytes (default: what local memory has left)"},
    {"", NONE, OPT_HEADING, NULL, "Other"},
    {"v", NONE, OPT_V, NULL, "print the version, then link if there is something to link"},
    {"version", NONE, OPT_VERSION, NULL, "print the version"},
    {"V", NONE, OPT_V, NULL, NULL},
    {"help", NONE, OPT_HELP, NULL, "print this text"},
    /* Without effect here: archives are searched until nothing more is needed, everything is static. */
    {"start-group", NONE, OPT_ACCEPTED, NULL, NULL},
    {"end-group", NONE, OPT_ACCEPTED, NULL, NULL},
    {"(", NONE, OPT_ACCEPTED, NULL, NULL},
    {")", NONE, OPT_ACCEPTED, NULL, NULL},
    {"as-needed", NONE, OPT_ACCEPTED, NULL, NULL},
    {"no-as-needed", NONE, OPT_ACCEPTED, NULL, NULL},
    {"static", NONE, OPT_ACCEPTED, NULL, NULL},
    {"Bstatic", NONE, OPT_ACCEPTED, NULL, NULL},
    {"no-pie", NONE, OPT_ACCEPTED, NULL, NULL},
    {"no-undefined", NONE, OPT_ACCEPTED, NULL, NULL},
    {"allow-shlib-undefined", NONE, OPT_ACCEPTED, NULL, NULL},
    {"no-allow-shlib-undefined", NONE, OPT_ACCEPTED, NULL, NULL},
    {"nostdlib", NONE, OPT_ACCEPTED, NULL, NULL},
    {"X", NONE, OPT_ACCEPTED, NULL, NULL},
    {"discard-locals", NONE, OPT_ACCEPTED, NULL, NULL},
    {"build-id", NONE, OPT_ACCEPTED, NULL, NULL},
    {"color-diagnostics", NONE, OPT_ACCEPTED, NULL, NULL},
    {"relax", NONE, OPT_ACCEPTED, NULL, NULL},
    {"no-relax", NONE, OPT_ACCEPTED, NULL, NULL},
    {"O", JOINED, OPT_ACCEPTED, "LEVEL", NULL},
    /* What this linker does not do. */
    {"shared", NONE, OPT_REJECTED, NULL, "the machine has no shared libraries"},
    {"Bdynamic", NONE, OPT_REJECTED, NULL, "the machine has no shared libraries"},
    {"pie", NONE, OPT_REJECTED, NULL, "programs have fixed addresses"},
    {"q", NONE, OPT_REJECTED, NULL, "executables keep no relocations"},
    {"emit-relocs", NONE, OPT_REJECTED, NULL, "executables keep no relocations"},
    {"T", JOINED, OPT_REJECTED, "SCRIPT", "linker scripts are not supported; the layout is that of docs/abi.md, -Ttext moves it"},
    {"script", VALUE, OPT_REJECTED, "SCRIPT", "linker scripts are not supported; the layout is that of docs/abi.md, -Ttext moves it"},
};
/* clang-format on */
#define OPTION_COUNT (sizeof option_table / sizeof option_table[0])

void ld_print_help(FILE *out) {
  fputs("usage: trax-ld [options] file...\n"
        "Links relocatable objects and archives into an executable for the TP.\n",
        out);
  for (size_t i = 0; i < OPTION_COUNT; i++) {
    const option *option = &option_table[i];
    if (option->id == OPT_HEADING)
      fprintf(out, "\n%s:\n", option->help);
    if (!option->help || option->id == OPT_REJECTED || option->id == OPT_HEADING)
      continue;
    size_t length = strlen(option->name);
    char spelled[64];
    snprintf(spelled, sizeof spelled, "%s%s%s%s", length == 1 || isupper((unsigned char)option->name[0]) ? "-" : "--",
             option->name,
             option->argument == NONE     ? ""
             : option->argument == JOINED ? " "
                                          : "=",
             option->metavar ? option->metavar : "");
    fprintf(out, "  %-29s  %s\n", spelled, option->help);
  }
  fprintf(out, "  %-29s  %s\n", "@FILE", "read options from FILE");
}

/* The option that argument spells, with its value in *value where it is joined; NULL if none. */
static const option *find_option(const char *argument, const char **value) {
  const char *name = argument + (argument[1] == '-' ? 2 : 1);
  size_t length = strcspn(name, "=");
  *value = NULL;
  for (size_t i = 0; i < OPTION_COUNT; i++) {
    const option *option = &option_table[i];
    if (option->argument == JOINED || strlen(option->name) != length || strncmp(option->name, name, length) != 0)
      continue;
    if (name[length] == '=' && option->argument == NONE && option->id != OPT_ACCEPTED)
      continue;
    if (name[length] == '=')
      *value = name + length + 1;
    return option;
  }
  for (size_t i = 0; argument[1] != '-' && i < OPTION_COUNT; i++) {
    const option *option = &option_table[i];
    if (option->argument == JOINED && name[0] == option->name[0]) {
      if (name[1] != '\0')
        *value = name + 1;
      return option;
    }
  }
  return NULL;
}

static const char *option_name(const void *context, size_t i) {
  (void)context;
  return option_table[i].name;
}

/* What a mistyped option probably means, as it is spelled; NULL if none is near. */
static const char *nearest_option(ld_context *ctx, const char *argument) {
  const char *name = argument + (argument[1] == '-' ? 2 : 1);
  const char *mistyped = ld_format(ctx, "%.*s", (int)strcspn(name, "="), name);
  const char *nearest = trax_nearest_name(mistyped, OPTION_COUNT, option_name, NULL);
  return nearest && nearest[1] ? ld_format(ctx, "%s%s", isupper((unsigned char)*nearest) ? "-" : "--", nearest) : NULL;
}

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

/* -z: other linkers' keywords are about what this machine does not have. */
static void set_keyword(ld_context *ctx, const char *value) {
  static const char stack_size[] = "stack-size=";
  if (!ld_starts_with(value, stack_size))
    ld_warning(ctx, "-z %s is ignored", value);
  else if (!ld_parse_number(value + strlen(stack_size), &ctx->options.stack_size) || !ctx->options.stack_size)
    ld_error(ctx, "-z %s: not a number of bytes", value);
}

static void apply(ld_context *ctx, const option *option, const char *spelled, const char *value, bool *whole_archive) {
  ld_options *options = &ctx->options;
  switch (option->id) {
  case OPT_ACCEPTED:
  case OPT_HEADING:
    break;
  case OPT_DEFSYM:
    add_defsym(ctx, value);
    break;
  case OPT_ENTRY:
    options->entry = value;
    break;
  case OPT_DEMANGLE:
  case OPT_NO_DEMANGLE:
    options->no_demangle = option->id == OPT_NO_DEMANGLE;
    break;
  case OPT_ERROR_LIMIT:
    set_error_limit(ctx, value);
    break;
  case OPT_FATAL_WARNINGS:
  case OPT_NO_FATAL_WARNINGS:
    options->fatal_warnings = option->id == OPT_FATAL_WARNINGS;
    break;
  case OPT_GC:
  case OPT_NO_GC:
    options->gc_sections = option->id == OPT_GC;
    break;
  case OPT_HELP:
    options->help = true;
    break;
  case OPT_KEYWORD:
    set_keyword(ctx, value);
    break;
  case OPT_LIBRARY: {
    ld_input input = {.name = value, .is_library = true, .whole_archive = *whole_archive};
    ld_push(ctx, &options->inputs, input);
    break;
  }
  case OPT_LIBRARY_PATH:
    ld_push(ctx, &options->library_paths, value);
    break;
  case OPT_MAP:
    options->map_path = value;
    break;
  case OPT_MAP_STDOUT:
    options->map_path = "-";
    break;
  case OPT_NO_WARNINGS:
    options->no_warnings = true;
    break;
  case OPT_ORDERING:
    options->ordering_path = value;
    break;
  case OPT_OUTPUT:
    options->output = value;
    break;
  case OPT_PRINT_GC:
  case OPT_NO_PRINT_GC:
    options->print_gc_sections = option->id == OPT_PRINT_GC;
    break;
  case OPT_ALLOW_MULTIPLE:
    options->allow_multiple_definition = true;
    break;
  case OPT_PRINT_MEMORY:
    options->print_memory_usage = true;
    break;
  case OPT_PRINT_STACK:
    options->print_stack = true;
    break;
  case OPT_NO_STACK_CHECK:
    options->stack_check = LD_STACK_NONE;
    break;
  case OPT_STACK_CHECK:
    set_stack_check(ctx, value);
    break;
  case OPT_SECTION_ADDRESS:
    add_section_start(ctx, ld_format(ctx, ".%s", option->name + 1), ld_format(ctx, "-%s", option->name), value);
    break;
  case OPT_SECTION_START:
    set_section_start(ctx, value);
    break;
  case OPT_RELOCATABLE:
    options->relocatable = true;
    break;
  case OPT_REJECTED:
    ld_error(ctx, "%s: %s", spelled, option->help);
    break;
  case OPT_STRIP_ALL:
    options->strip_all = options->strip_debug = true;
    break;
  case OPT_STRIP_DEBUG:
    options->strip_debug = true;
    break;
  case OPT_TRACE:
    options->trace = true;
    break;
  case OPT_UNDEFINED:
    ld_push(ctx, &options->undefined, value);
    break;
  case OPT_V:
    options->version = true;
    break;
  case OPT_VERSION:
    options->version = options->version_only = true;
    break;
  case OPT_WHOLE_ARCHIVE:
  case OPT_NO_WHOLE_ARCHIVE:
    *whole_archive = option->id == OPT_WHOLE_ARCHIVE;
    break;
  case OPT_WRAP:
    ld_push(ctx, &options->wrapped, value);
    break;
  }
}

/* --- response files --- */

typedef LD_VECTOR(const char *) argument_list;
#define MAX_RESPONSE_DEPTH 32
#define MAX_RESPONSE_FILES 1000 /* two mentions in each of 32 nested files would be 2^32 */

static void expand(ld_context *ctx, argument_list *arguments, const char *argument, unsigned depth);

/* The words of a response file: separated by white space; single and double quotes keep it, a backslash takes the next
   character as it is (not within single quotes). Words are built over the text that they come from. */
static void split_words(ld_context *ctx, argument_list *arguments, char *text, const char *path, unsigned depth) {
  char *from = text;
  for (;;) {
    while (isspace((unsigned char)*from))
      from++;
    if (*from == '\0')
      return;
    char *word = from, *to = from, quote = '\0';
    bool closed = true;
    for (; *from != '\0' && (quote || !isspace((unsigned char)*from)); from++) {
      if (quote && *from == quote) {
        quote = '\0';
      } else if (!quote && (*from == '\'' || *from == '"')) {
        quote = *from;
      } else {
        if (*from == '\\' && quote != '\'' && from[1] != '\0')
          from++;
        *to++ = *from;
      }
    }
    closed = quote == '\0';
    bool last = *from == '\0';
    *to = '\0';
    if (!closed) {
      ld_error(ctx, "%s: a %c quote is not closed", path, quote);
      return;
    }
    expand(ctx, arguments, word, depth + 1);
    if (last)
      return;
    from++;
  }
}

static void expand(ld_context *ctx, argument_list *arguments, const char *argument, unsigned depth) {
  if (argument[0] != '@' || argument[1] == '\0') {
    ld_push(ctx, arguments, argument);
    return;
  }
  const char *path = argument + 1;
  const uint8_t *bytes;
  size_t size;
  unsigned *files = &ctx->options.response_files;
  ld_push(ctx, &ctx->options.response_paths, path);
  if (*files > MAX_RESPONSE_FILES) /* an error that was reported */
    return;
  if (depth > MAX_RESPONSE_DEPTH) {
    ld_error(ctx, "%s: response files are nested more than %d deep", path, MAX_RESPONSE_DEPTH);
    *files = MAX_RESPONSE_FILES + 1;
  } else if (++*files > MAX_RESPONSE_FILES) {
    ld_error(ctx, "%s: more than %d response files", path, MAX_RESPONSE_FILES);
  } else if (ld_read_file(ctx, path, &bytes, &size)) {
    if (memchr(bytes, '\0', size))
      ld_error(ctx, "%s: is not text (a response file)", path);
    else
      split_words(ctx, arguments, (char *)bytes, path, depth);
  }
}

/* What -r has no use for: it keeps everything, and has no addresses. */
static void check_relocatable(ld_context *ctx) {
  const ld_options *options = &ctx->options;
  const char *other = options->gc_sections          ? "--gc-sections"
                      : options->strip_all          ? "--strip-all"
                      : options->print_stack        ? "--print-stack"
                      : options->print_memory_usage ? "--print-memory-usage"
                                                    : NULL;
  if (options->relocatable && other)
    ld_error(ctx, "-r and %s cannot be combined", other);
}

bool ld_parse_options(ld_context *ctx, int argc, char **argv) {
  ld_options *options = &ctx->options;
  options->output = "a.out";
  options->entry = "_start";
  options->text_start = TRAX_NULL_END;
  options->error_limit = 20;

  argument_list arguments = {0};
  for (int i = 0; i < argc; i++)
    expand(ctx, &arguments, argv[i], 0);

  bool whole_archive = false, only_files = false;
  for (size_t i = 0; i < arguments.count; i++) {
    const char *argument = arguments.items[i];
    if (argument[0] == '\0') {
      ld_error(ctx, "the name of an input file is empty");
      continue;
    }
    if (only_files || argument[0] != '-' || argument[1] == '\0') {
      ld_input input = {.name = argument, .whole_archive = whole_archive};
      ld_push(ctx, &options->inputs, input);
      continue;
    }
    if (strcmp(argument, "--") == 0) {
      only_files = true;
      continue;
    }
    const char *value;
    const option *option = find_option(argument, &value);
    if (!option) {
      const char *nearest = nearest_option(ctx, argument);
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
    apply(ctx, option, argument, value, &whole_archive);
  }
  check_relocatable(ctx);
  if (options->inputs.count == 0 && !options->help && !options->version && ctx->error_count == 0)
    ld_error(ctx, "no input files");
  return ctx->error_count == 0;
}
