#define _POSIX_C_SOURCE 200809L /* open_memstream */
#include "report/backtrace.h"

#include <signal.h>
#include <stdlib.h>

struct trax_post_mortem {
  trax_machine *machine;
  struct trax_watch watch;
  const volatile int *interrupt;
  bool always;
  char *text;
};

static trax_status disable(struct trax_watch *watch, struct trax_run *run, uint64_t t) {
  (void)run;
  (void)t;
  watch->next = TRAX_NEVER; /* only the end of the run matters */
  return TRAX_OK;
}

static void end(struct trax_watch *watch, struct trax_run *run, trax_status status, uint64_t t) {
  struct trax_post_mortem *post_mortem = watch->context;
  size_t size;
  (void)t;
  if (!post_mortem->always &&
      !(status == TRAX_INTERRUPTED && post_mortem->interrupt && *post_mortem->interrupt == SIGQUIT))
    return;
  FILE *out = open_memstream(&post_mortem->text, &size);
  if (!out)
    return;
  trax_run_export(run);
  trax_print_threads(run, out);
  fclose(out);
}

struct trax_post_mortem *trax_post_mortem_create(trax_machine *machine, const volatile int *interrupt, bool always,
                                                 trax_error *error) {
  struct trax_post_mortem *post_mortem = calloc(1, sizeof *post_mortem);
  if (!post_mortem) {
    trax_fail(error, "out of memory");
    return NULL;
  }
  post_mortem->interrupt = interrupt;
  post_mortem->always = always;
  post_mortem->machine = machine;
  post_mortem->watch = (struct trax_watch){.inspect = disable, .end = end, .context = post_mortem};
  trax_machine_watch(machine, &post_mortem->watch);
  return post_mortem;
}

const char *trax_post_mortem_text(const struct trax_post_mortem *post_mortem) {
  return post_mortem->text;
}

void trax_post_mortem_destroy(struct trax_post_mortem *post_mortem) {
  if (!post_mortem)
    return;
  trax_machine_unwatch(post_mortem->machine, &post_mortem->watch);
  free(post_mortem->text);
  free(post_mortem);
}
