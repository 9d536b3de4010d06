/* Packets that continue the run: c, C, s, S, and those that begin with v. */
#include "gdb/commands.h"
#include "gdb/registers.h"

#include <stdlib.h>
#include <string.h>

static void forget_steps(struct trax_gdb *gdb) {
  gdb->range_begin = gdb->range_end = 0;
  for (uint32_t thread = 0; thread < gdb->threads; thread++)
    gdb->thread[thread].stepping = false;
}

/* Packets c, C, s and S. A signal to deliver is ignored, since programs have no handlers. */
void trax_gdb_continue(struct trax_gdb *gdb, const char *text, bool step, bool with_signal) {
  uint64_t signal, pc;
  if (with_signal && !trax_gdb_read_number(&text, &signal)) {
    trax_gdb_refuse(gdb, TRAX_GDB_BAD_REQUEST);
    return;
  }
  if (with_signal)
    trax_gdb_read_char(&text, ';');
  if (*text && (!trax_gdb_read_number(&text, &pc) || *text || pc > UINT32_MAX ||
                !trax_gdb_set_register(gdb, gdb->continued, TRAX_GDB_PC, (uint32_t)pc))) {
    trax_gdb_refuse(gdb, TRAX_GDB_BAD_REQUEST);
    return;
  }
  forget_steps(gdb);
  gdb->thread[gdb->continued].stepping = step;
  trax_gdb_resume(gdb, false);
}

struct action {
  bool step;
  uint32_t begin, end; /* of a range */
  int64_t thread;
};

/* Reads an action of vCont: a letter, a signal or a range, and a thread. */
static bool read_action(const struct trax_gdb *gdb, const char **text, struct action *action) {
  uint64_t begin = 0, end = 0;
  const char what = **text;
  if (!what)
    return false;
  ++*text;
  if ((what == 'C' || what == 'S') && !trax_gdb_read_number(text, &begin))
    return false;
  begin = 0;
  if (what == 'r' && (!trax_gdb_read_number(text, &begin) || !trax_gdb_read_char(text, ',') ||
                      !trax_gdb_read_number(text, &end) || begin > UINT32_MAX || end > UINT32_MAX))
    return false;
  if (!strchr("cCsSr", what))
    return false;
  *action = (struct action){what != 'c' && what != 'C', (uint32_t)begin, (uint32_t)end, TRAX_GDB_ALL_THREADS};
  return !trax_gdb_read_char(text, ':') || trax_gdb_read_thread(gdb, text, &action->thread);
}

static void apply_action(struct trax_gdb *gdb, const struct action *action, bool *decided) {
  for (uint32_t thread = 0; thread < gdb->threads; thread++) {
    const bool meant =
        action->thread == TRAX_GDB_ALL_THREADS ||
        (action->thread == TRAX_GDB_ANY_THREAD ? gdb->continued == thread : action->thread == (int64_t)thread + 1);
    if (!meant || decided[thread])
      continue;
    decided[thread] = true; /* the first action for a thread counts */
    gdb->thread[thread].stepping = action->step;
  }
  if (action->step && action->end > action->begin) {
    gdb->range_begin = action->begin;
    gdb->range_end = action->end;
  }
}

/* In the protocol, threads without an action stay stopped. Here they continue, since all threads share the machine's
   cycles (docs/debugging.md). */
static void resume_threads(struct trax_gdb *gdb, const char *text) {
  struct action action;
  bool *decided = calloc(gdb->threads, sizeof *decided), correct = decided != NULL, named_only = true;
  forget_steps(gdb);
  while (correct && *text) {
    correct = trax_gdb_read_char(&text, ';') && read_action(gdb, &text, &action);
    if (correct) {
      apply_action(gdb, &action, decided);
      named_only &= action.thread != TRAX_GDB_ALL_THREADS;
    }
  }
  free(decided);
  if (correct) {
    trax_gdb_resume(gdb, named_only);
  } else {
    forget_steps(gdb);
    trax_gdb_refuse(gdb, TRAX_GDB_BAD_REQUEST);
  }
}

void trax_gdb_verbose(struct trax_gdb *gdb, const char *text) {
  if (strcmp(text, "Cont?") == 0) {
    trax_gdb_answer(gdb, "vCont;c;C;s;S;r");
  } else if (trax_gdb_starts_with(&text, "Cont")) {
    resume_threads(gdb, text);
  } else if (trax_gdb_starts_with(&text, "Kill;")) {
    gdb->phase = GDB_KILLED;
    trax_gdb_answer(gdb, "OK");
  } else {
    trax_gdb_answer(gdb, "");
  }
}
