/* One table of options, from which parsing and --help both work.

   It is not trax/options.h's: compilers and makefiles call this program as they call GNU ld, whose long names may have
   one dash, whose letters take joined values, whose options have aliases, and where an option's place among the inputs
   counts. */
#include "options.h"
#include "trax/names.h"

#include <ctype.h>
#include <string.h>

/* clang-format off */
static const ld_option option_table[] = {
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
    /* Unsupported. */
    {"shared", NONE, OPT_REJECTED, NULL, "the machine has no shared libraries"},
    {"Bdynamic", NONE, OPT_REJECTED, NULL, "the machine has no shared libraries"},
    {"r", NONE, OPT_REJECTED, NULL, "several objects become one file in an archive: llvm-ar rc libparts.a a.o b.o"},
    {"relocatable", NONE, OPT_REJECTED, NULL, "several objects become one file in an archive: llvm-ar rc libparts.a a.o b.o"},
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
        "Links objects and archives into an executable for the TP.\n",
        out);
  for (size_t i = 0; i < OPTION_COUNT; i++) {
    const ld_option *option = &option_table[i];
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

const ld_option *ld_find_option(const char *argument, const char **value) {
  const char *name = argument + (argument[1] == '-' ? 2 : 1);
  size_t length = strcspn(name, "=");
  *value = NULL;
  for (size_t i = 0; i < OPTION_COUNT; i++) {
    const ld_option *option = &option_table[i];
    if (option->argument == JOINED || strlen(option->name) != length || strncmp(option->name, name, length) != 0)
      continue;
    if (name[length] == '=' && option->argument == NONE && option->id != OPT_ACCEPTED)
      continue;
    if (name[length] == '=')
      *value = name + length + 1;
    return option;
  }
  for (size_t i = 0; argument[1] != '-' && i < OPTION_COUNT; i++) {
    const ld_option *option = &option_table[i];
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

const char *ld_nearest_option(ld_context *ctx, const char *argument) {
  const char *name = argument + (argument[1] == '-' ? 2 : 1);
  const char *mistyped = ld_format(ctx, "%.*s", (int)strcspn(name, "="), name);
  const char *nearest = trax_nearest_name(mistyped, OPTION_COUNT, option_name, NULL);
  return nearest && nearest[1] ? ld_format(ctx, "%s%s", isupper((unsigned char)*nearest) ? "-" : "--", nearest) : NULL;
}
