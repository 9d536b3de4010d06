#include "calls/internal.h"

#include "machine/machine.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static void destroy(void *context) {
  struct trax_calls *calls = context;
  while (calls->files)
    trax_file_forget(calls, calls->files);
  for (size_t i = 0; i < calls->folder_count; i++) {
    close(calls->folders[i].descriptor);
    free(calls->folders[i].host);
    free(calls->folders[i].name);
  }
  free(calls->folders);
  free(calls->input.bytes);
  if (calls->input.digest)
    XXH3_freeState(calls->input.digest);
  free(calls);
}

struct trax_calls *trax_calls_of(struct trax_machine *machine) {
  if (machine->calls.context)
    return machine->calls.context;
  struct trax_calls *calls = calloc(1, sizeof *calls);
  if (!calls)
    return NULL;
  calls->machine = machine;
  machine->calls.serve = trax_calls_serve;
  machine->calls.context = calls;
  machine->calls.destroy = destroy;
  return calls;
}

trax_status trax_calls_begin(struct trax_machine *machine, const struct trax_calls_streams *streams,
                             trax_error *error) {
  struct trax_calls *calls = trax_calls_of(machine);
  if (!calls)
    return trax_fail(error, "out of memory");
  calls->streams = *streams;
  return TRAX_OK;
}

static trax_status commit(struct trax_calls *calls, bool open_ones, trax_error *error) {
  trax_status status = TRAX_OK;
  for (struct trax_file *file = calls->files, *next; file; file = next) {
    next = file->next;
    if (file->opens && file->exists && !open_ones)
      continue;
    const int failure = trax_file_commit(file);
    if (failure && status == TRAX_OK)
      status = trax_fail(error, "%s: the program's file cannot be written: %s", file->path, strerror(failure));
    if (!file->opens)
      trax_file_forget(calls, file);
  }
  return status;
}

trax_status trax_calls_commit(struct trax_machine *machine, trax_error *error) {
  return machine->calls.context ? commit(machine->calls.context, false, error) : TRAX_OK;
}

trax_status trax_calls_end(struct trax_machine *machine, bool completed, trax_error *error) {
  struct trax_calls *calls = machine->calls.context;
  if (!calls || (calls->deferred && !completed)) /* the latest checkpoint's files are those that there are */
    return TRAX_OK;
  return commit(calls, completed, error);
}

void trax_calls_defer(struct trax_machine *machine) {
  struct trax_calls *calls = trax_calls_of(machine);
  if (calls)
    calls->deferred = true;
}

trax_status trax_machine_allow(trax_machine *machine, const char *folder, const char *name, trax_error *error) {
  return machine->has_run ? trax_fail(error, "the program has run already")
                          : trax_calls_allow(machine, folder, name, error);
}
