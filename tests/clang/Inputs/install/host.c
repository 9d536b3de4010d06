/* Runs a program with the emulator as a library. */
#include <trax/emulator.h>

int main(int argc, char **argv) {
  trax_error error;
  trax_config *config = trax_config_create();
  trax_machine *machine = trax_machine_create(config, &error);
  trax_run_options options = {.output = stdout, .max_cycles = 10000000};
  double cycles = 0;
  if (argc != 2 || !machine || trax_machine_load_elf(machine, argv[1], &error) != TRAX_OK ||
      trax_machine_run(machine, &options, &error) != TRAX_OK || !trax_stats_get(machine, "cycles", &cycles)) {
    fprintf(stderr, "%s\n", error.message);
    return 1;
  }
  printf("status %d, cycles counted: %s\n", trax_machine_exit_status(machine), cycles > 100 ? "yes" : "no");
  int status = trax_machine_exit_status(machine);
  trax_machine_destroy(machine);
  trax_config_destroy(config);
  return status;
}
