#include "steps.h"

#include "engine/run.h"
#include "trax/abi.h"

#include <stdio.h>
#include <string.h>

typedef struct stepper {
  struct trax_machine *machine;
  void (*step)(void *context, const unwind_state *state);
  void *context;
} stepper;

static void issued(void *context, const struct trax_issue *issue) {
  const stepper *stepper = context;
  const struct trax_thread thread = trax_run_thread(stepper->machine->run, 0); /* an observed run does not run ahead */
  unwind_state state = {.pc = issue->next_pc,
                        .registers = thread.reg,
                        .previous_pc = issue->pc,
                        .previous_word = issue->word,
                        .machine = stepper->machine};
  stepper->step(stepper->context, &state);
}

bool unwind_load(const unwind_state *state, uint32_t address, uint32_t *value) {
  const struct trax_machine *machine = state->machine;
  if (address % 4 != 0)
    return false;
  if (address >= TRAX_LOCAL_BASE)
    memcpy(value, trax_run_thread(machine->run, 0).local + (address - TRAX_LOCAL_BASE), 4);
  else if (address >= TRAX_NULL_END && address < machine->space.size)
    memcpy(value, machine->space.bytes + address, 4);
  else
    return false;
  return true;
}

bool unwind_run(const char *path, void (*step)(void *context, const unwind_state *state), void *context) {
  trax_error error;
  trax_config *config = trax_config_create();
  struct trax_machine *machine = config ? trax_machine_create(config, &error) : NULL;
  trax_config_destroy(config);
  bool ok = machine && trax_machine_load_elf(machine, path, &error) == TRAX_OK;
  if (ok) {
    stepper stepper = {machine, step, context};
    const trax_run_options options = {.max_cycles = 100000000, .engine = "fast"};
    struct trax_observer observer = {.context = &stepper, .issue = issued};
    machine->observer = &observer;
    ok = trax_machine_run(machine, &options, &error) == TRAX_OK;
    machine->observer = NULL;
  }
  if (!ok)
    fprintf(stderr, "unwind-test: error: %s\n", error.message);
  trax_machine_destroy(machine);
  return ok;
}
