/* Runs a program by the library with an input that is no file of the host:

     library_input PROGRAM SCRIPT memory|cookie|read */
#define _GNU_SOURCE
#include <stdlib.h>
#include <string.h>
#include <trax/emulator.h>
#include <unistd.h>

static ssize_t read_cookie(void *cookie, char *bytes, size_t count) {
  return read(*(int *)cookie, bytes, count < 7 ? count : 7);
}

int main(int count, char *words[]) {
  static char text[1 << 16];
  trax_error error;
  FILE *script = count == 4 ? fopen(words[2], "r+") : NULL, *input = script;
  if (!script)
    return 2;
  alarm(60);
  if (strcmp(words[3], "memory") == 0)
    input = fmemopen(text, fread(text, 1, sizeof text, script), "r");
  int descriptor = fileno(script);
  if (strcmp(words[3], "cookie") == 0)
    input = fopencookie(&descriptor, "r", (cookie_io_functions_t){.read = read_cookie});
  if (strcmp(words[3], "read") == 0 && !fgets(text, sizeof text, input)) /* the program gets what follows the line */
    return 2;
  trax_config *config = trax_config_create();
  trax_machine *machine = config ? trax_machine_create(config, &error) : NULL;
  const trax_run_options options = {.output = stdout, .input = input, .engine = "functional"};
  if (!machine || trax_machine_allow(machine, ".", ".", &error) || trax_machine_load_elf(machine, words[1], &error) ||
      trax_machine_run(machine, &options, &error)) {
    fprintf(stderr, "%s\n", machine ? error.message : "out of memory");
    return 1;
  }
  trax_machine_destroy(machine);
  trax_config_destroy(config);
  return 0;
}
