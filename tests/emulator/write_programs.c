/* emulator-programs DIRECTORY: writes the programs of programs.h there as NAME.elf, for cli_test.sh. */
#include <stdio.h>
#include <stdlib.h>

#include "programs.h"

int main(int count, char **arguments) {
  if (count != 2) {
    fprintf(stderr, "usage: emulator-programs DIRECTORY\n");
    return 1;
  }
  for (const char *const *name = program_names; *name; ++name) {
    char path[4096];
    snprintf(path, sizeof path, "%s/%s.elf", arguments[1], *name);
    struct elf_file file = program_file(*name);
    elf_save(path, &file);
    free(file.bytes);
  }
  return 0;
}
