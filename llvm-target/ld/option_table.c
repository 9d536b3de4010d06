/* The table of options, which parsing and --help use.

   It is not trax/options.h's: compilers and makefiles call this program as they call GNU ld, whose long names may have
   one dash, whose letters take joined values, whose options have aliases, and where an option's place among the inputs
   counts. */
#include "options.h"
#include "trax/names.h"

#include <ctype.h>
#include <stddef.h>
#include <string.h>

#define FLAG(member, value) OPT_FLAG, offsetof(ld_options, member), value
#define LIST(member) OPT_LIST, offsetof(ld_options, member), false
#define TEXT(member) OPT_TEXT, offsetof(ld_options, member), false
#define OTHER(id) id, 0, false

/* clang-format off */
static const ld_option option_table[] = {
    {"", NONE, OTHER(OPT_HEADING), NULL, "Files"},
    {"o", JOINED, TEXT(output), "FILE", "write the executable to FILE (default a.out)"},
    {"output", VALUE, TEXT(output), "FILE", NULL},
    {"L", JOINED, LIST(library_paths), "DIR", "search DIR for libraries"},
    {"library-path", VALUE, LIST(library_paths), "DIR", NULL},
    {"l", JOINED, OTHER(OPT_LIBRARY), "NAME", "link libNAME.a, or the file NAME if written -l:NAME"},
    {"library", VALUE, OTHER(OPT_LIBRARY), "NAME", NULL},
    {"whole-archive", NONE, FLAG(whole_archive, true), NULL, "take every member of the archives that follow"},
    {"no-whole-archive", NONE, FLAG(whole_archive, false), NULL, "take only needed members (default)"},
    {"", NONE, OTHER(OPT_HEADING), NULL, "Contents"},
    {"e", JOINED, TEXT(entry), "SYMBOL", "start at SYMBOL or at an address (default _start)"},
    {"entry", VALUE, TEXT(entry), "SYMBOL", NULL},
    {"u", JOINED, LIST(undefined), "SYMBOL", "take and keep the definition of SYMBOL"},
    {"undefined", VALUE, LIST(undefined), "SYMBOL", NULL},
    {"defsym", VALUE, OTHER(OPT_DEFSYM), "NAME=VALUE", "define NAME as a sum of numbers and at most one symbol"},
    {"wrap", VALUE, LIST(wrapped), "SYMBOL", "references to SYMBOL go to __wrap_SYMBOL, those to __real_SYMBOL to SYMBOL"},
    {"allow-multiple-definition", NONE, FLAG(allow_multiple_definition, true), NULL, "take the first of several definitions of a symbol"},
    {"gc-sections", NONE, FLAG(gc_sections, true), NULL, "drop sections that the program cannot reach"},
    {"no-gc-sections", NONE, FLAG(gc_sections, false), NULL, "keep all sections (default)"},
    {"print-gc-sections", NONE, FLAG(print_gc_sections, true), NULL, "print the dropped sections"},
    {"no-print-gc-sections", NONE, FLAG(print_gc_sections, false), NULL, NULL},
    {"", NONE, OTHER(OPT_HEADING), NULL, "Symbols and debug information"},
    {"s", NONE, FLAG(strip_all, true), NULL, "leave out symbols and debug information"},
    {"strip-all", NONE, FLAG(strip_all, true), NULL, NULL},
    {"S", NONE, FLAG(strip_debug, true), NULL, "leave out debug information"},
    {"strip-debug", NONE, FLAG(strip_debug, true), NULL, NULL},
    {"", NONE, OTHER(OPT_HEADING), NULL, "Layout"},
    {"Ttext", VALUE, OTHER(OPT_SECTION_ADDRESS), "ADDRESS", "put the image at ADDRESS (default 0x1000; a multiple of 64)"},
    {"Tdata", VALUE, OTHER(OPT_SECTION_ADDRESS), "ADDRESS", "put .data at ADDRESS, a multiple of 64, and later sections behind it"},
    {"Tbss", VALUE, OTHER(OPT_SECTION_ADDRESS), "ADDRESS", "put .bss at ADDRESS, likewise"},
    {"section-start", VALUE, OTHER(OPT_SECTION_START), "NAME=ADDRESS", "put the section NAME at ADDRESS, likewise"},
    {"symbol-ordering-file", VALUE, TEXT(ordering_path), "FILE", "put the sections of the symbols that FILE lists first, in its order"},
    {"", NONE, OTHER(OPT_HEADING), NULL, "Reports"},
    {"Map", VALUE, TEXT(map_path), "FILE", "write a map of the image to FILE, - for standard output"},
    {"M", NONE, OTHER(OPT_MAP_STDOUT), NULL, "print the map"},
    {"print-map", NONE, OTHER(OPT_MAP_STDOUT), NULL, NULL},
    {"print-memory-usage", NONE, FLAG(print_memory_usage, true), NULL, "print the sizes of text, data and local memory"},
    {"print-stack", NONE, FLAG(print_stack, true), NULL, "print the deepest path of calls, and the calls without a bound"},
    {"t", NONE, FLAG(trace, true), NULL, "print the files that are linked"},
    {"trace", NONE, FLAG(trace, true), NULL, NULL},
    {"verbose", NONE, FLAG(trace, true), NULL, NULL},
    {"demangle", NONE, FLAG(no_demangle, false), NULL, NULL},
    {"no-demangle", NONE, FLAG(no_demangle, true), NULL, "print names of C++ as they stand in the files"},
    {"error-limit", VALUE, OTHER(OPT_ERROR_LIMIT), "N", "show at most N errors (default 20; 0: all)"},
    {"fatal-warnings", NONE, FLAG(fatal_warnings, true), NULL, "warnings are errors"},
    {"no-fatal-warnings", NONE, FLAG(fatal_warnings, false), NULL, NULL},
    {"w", NONE, FLAG(no_warnings, true), NULL, "no warnings"},
    {"no-warnings", NONE, FLAG(no_warnings, true), NULL, NULL},
    {"", NONE, OTHER(OPT_HEADING), NULL, "Stack"},
    {"stack-check", VALUE, OTHER(OPT_STACK_CHECK), "MODE", "a stack too deep for its room: error (default), warn or none"},
    {"no-stack-check", NONE, OTHER(OPT_NO_STACK_CHECK), NULL, NULL},
    {"no-check-stack", NONE, OTHER(OPT_NO_STACK_CHECK), NULL, NULL},
    {"z", JOINED, OTHER(OPT_KEYWORD), "stack-size=N", "the stack's room is N bytes (default: what local memory has left)"},
    {"", NONE, OTHER(OPT_HEADING), NULL, "Other"},
    {"v", NONE, FLAG(version, true), NULL, "print the version, then link if there is something to link"},
    {"version", NONE, FLAG(version_only, true), NULL, "print the version"},
    {"V", NONE, FLAG(version, true), NULL, NULL},
    {"help", NONE, FLAG(help, true), NULL, "print this text"},
    /* Without effect here: archives are searched until nothing more is needed, everything is static. */
    {"start-group", NONE, OTHER(OPT_ACCEPTED), NULL, NULL},
    {"end-group", NONE, OTHER(OPT_ACCEPTED), NULL, NULL},
    {"(", NONE, OTHER(OPT_ACCEPTED), NULL, NULL},
    {")", NONE, OTHER(OPT_ACCEPTED), NULL, NULL},
    {"as-needed", NONE, OTHER(OPT_ACCEPTED), NULL, NULL},
    {"no-as-needed", NONE, OTHER(OPT_ACCEPTED), NULL, NULL},
    {"static", NONE, OTHER(OPT_ACCEPTED), NULL, NULL},
    {"Bstatic", NONE, OTHER(OPT_ACCEPTED), NULL, NULL},
    {"no-pie", NONE, OTHER(OPT_ACCEPTED), NULL, NULL},
    {"no-undefined", NONE, OTHER(OPT_ACCEPTED), NULL, NULL},
    {"allow-shlib-undefined", NONE, OTHER(OPT_ACCEPTED), NULL, NULL},
    {"no-allow-shlib-undefined", NONE, OTHER(OPT_ACCEPTED), NULL, NULL},
    {"nostdlib", NONE, OTHER(OPT_ACCEPTED), NULL, NULL},
    {"X", NONE, OTHER(OPT_ACCEPTED), NULL, NULL},
    {"discard-locals", NONE, OTHER(OPT_ACCEPTED), NULL, NULL},
    {"build-id", NONE, OTHER(OPT_ACCEPTED), NULL, NULL},
    {"color-diagnostics", NONE, OTHER(OPT_ACCEPTED), NULL, NULL},
    {"relax", NONE, OTHER(OPT_ACCEPTED), NULL, NULL},
    {"no-relax", NONE, OTHER(OPT_ACCEPTED), NULL, NULL},
    {"O", JOINED, OTHER(OPT_ACCEPTED), "LEVEL", NULL},
    /* Unsupported. */
    {"shared", NONE, OTHER(OPT_REJECTED), NULL, "the machine has no shared libraries"},
    {"Bdynamic", NONE, OTHER(OPT_REJECTED), NULL, "the machine has no shared libraries"},
    {"r", NONE, OTHER(OPT_REJECTED), NULL, "several objects become one file in an archive: llvm-ar rc libparts.a a.o b.o"},
    {"relocatable", NONE, OTHER(OPT_REJECTED), NULL, "several objects become one file in an archive: llvm-ar rc libparts.a a.o b.o"},
    {"pie", NONE, OTHER(OPT_REJECTED), NULL, "programs have fixed addresses"},
    {"q", NONE, OTHER(OPT_REJECTED), NULL, "executables keep no relocations"},
    {"emit-relocs", NONE, OTHER(OPT_REJECTED), NULL, "executables keep no relocations"},
    {"T", JOINED, OTHER(OPT_REJECTED), "SCRIPT", "linker scripts are not supported; the layout is that of docs/abi.md, -Ttext moves it"},
    {"script", VALUE, OTHER(OPT_REJECTED), "SCRIPT", "linker scripts are not supported; the layout is that of docs/abi.md, -Ttext moves it"},
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
