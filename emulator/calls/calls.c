#include "calls/internal.h"

#include "machine/machine.h"

#include <stdlib.h>
#include <string.h>

static void destroy(void *context) {
  struct trax_calls *calls = context;
  trax_descriptors_forget(calls);
  for (struct trax_name *it = calls->names, *next; it; it = next) {
    next = it->next;
    trax_folder_release(calls, it->place.folder);
    free(it);
  }
  for (struct trax_file *it = calls->files, *next; it; it = next) {
    next = it->next;
    trax_contents_free(&it->contents);
    free(it);
  }
  while (calls->folders) /* only the allowed ones are left */
    trax_folder_release(calls, calls->folders);
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
  trax_descriptors_begin(calls);
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
  if (streams->input && fileno(streams->input) >= 0)
    fflush(streams->input); /* its descriptor is then where the stream is, if it can be */
  return TRAX_OK;
}

static trax_status commit(struct trax_calls *calls, bool open_ones, trax_error *error) {
  char *path;
  const int failure = trax_commit_all(calls, open_ones, &path);
  if (failure)
    trax_fail(error, "%s: the program's file cannot be written: %s", path ? path : "", strerror(failure));
  free(path);
  return failure ? TRAX_ERROR : TRAX_OK;
}

bool trax_calls_pending(const struct trax_machine *machine) {
  const struct trax_calls *calls = machine->calls.context;
  for (const struct trax_name *it = calls ? calls->names : NULL; it; it = it->next)
    if (!it->file || it->file->differs)
      return true;
  return false;
}

trax_status trax_calls_commit(struct trax_machine *machine, trax_error *error) {
  return machine->calls.context ? commit(machine->calls.context, false, error) : TRAX_OK;
}

trax_status trax_calls_end(struct trax_machine *machine, bool completed, trax_error *error) {
  return machine->calls.context && completed ? commit(machine->calls.context, true, error) : TRAX_OK;
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
