/* A debugged run: when it stops, what is said then, and how it goes on. */
#include "gdb/stub.h"
#include "trax/isa.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

enum {
  MOST_AHEAD = 8,     /* instructions that a thread is shown ahead of where it is */
  ATTENTION = 100,    /* milliseconds until an interrupt of the program is noticed while the run is stopped */
  LISTEN_CYCLES = 512 /* how often a running program's debugger is listened to */
};

/* --- what happens while it runs --- */

static void on_issue(void *context, const struct trax_issue *issue) {
  struct trax_gdb *gdb = context;
  const uint32_t thread = issue->tm * gdb->tps + issue->tp;
  struct trax_gdb_thread *state = &gdb->thread[thread];
  if (gdb->observed_before && gdb->observed_before->issue)
    gdb->observed_before->issue(gdb->observed_before->context, issue);
  if (gdb->phase != GDB_RUNNING)
    return;
  state->told = state->passed != 0;
  if (state->stepping && gdb->owed)
    gdb->owed--;
  else if (state->stepping && issue->next_pc - gdb->range_begin >= gdb->range_end - gdb->range_begin)
    state->events |= TRAX_GDB_STEPPED;
  if (state->passed)
    state->passed--;
  else if (gdb->break_count && trax_gdb_breaks_at(gdb, issue->next_pc))
    state->events |= TRAX_GDB_AT_BREAK;
  if (gdb->watch_count)
    trax_gdb_note_access(gdb, thread, issue);
  gdb->eventful |= state->events != 0;
}

static void on_charge(void *context, uint32_t tm, uint32_t tp, trax_cause cause, uint64_t since, uint64_t cycles) {
  const struct trax_observer *before = ((const struct trax_gdb *)context)->observed_before;
  if (before && before->charge)
    before->charge(before->context, tm, tp, cause, since, cycles);
}

static void on_arrival(void *context, const struct trax_arrival *arrival) {
  struct trax_gdb *gdb = context;
  if (gdb->observed_before && gdb->observed_before->arrival)
    gdb->observed_before->arrival(gdb->observed_before->context, arrival);
  if (gdb->atomic_count)
    trax_gdb_note_arrival(gdb, arrival->tm * gdb->tps + arrival->tp, arrival->rd);
}

/* --- stops --- */

/* Puts the packet of a stop into gdb->reason: signal, thread, why, and the registers that are always asked for. */
static void describe_stop(struct trax_gdb *gdb, uint32_t thread, enum trax_gdb_signal signal, unsigned event) {
  const struct trax_gdb_thread *state = &gdb->thread[thread];
  char why[32] = "";
  if (event == TRAX_GDB_AT_BREAK && gdb->knows_swbreak)
    strcpy(why, "swbreak:;");
  else if (event == TRAX_GDB_ACCESSED)
    snprintf(why, sizeof why, "%s:%08x;",
             state->access == '2'   ? "watch"
             : state->access == '3' ? "rwatch"
                                    : "awatch",
             state->accessed);
  size_t length = (size_t)snprintf(gdb->reason, sizeof gdb->reason, "T%02xthread:%x;%s", signal, thread + 1, why);
  static const unsigned shown[] = {1, 2, 32}; /* ra, sp, pc */
  for (size_t i = 0; i < sizeof shown / sizeof *shown; i++) {
    const uint32_t value = __builtin_bswap32(trax_gdb_register(gdb, thread, shown[i]));
    length += (size_t)snprintf(gdb->reason + length, sizeof gdb->reason - length, "%02x:%08x;", shown[i], value);
  }
}

static void stop(struct trax_gdb *gdb, uint32_t thread, enum trax_gdb_signal signal, unsigned event) {
  gdb->phase = GDB_STOPPED;
  gdb->ahead = gdb->owed = 0;
  gdb->insisting = false;
  gdb->selected = gdb->continued = gdb->stopped = thread;
  gdb->thread[thread].told = true;
  gdb->thread[thread].events &= (uint8_t)~event;
  describe_stop(gdb, thread, signal, event);
}

static void tell_stop(struct trax_gdb *gdb) {
  trax_gdb_begin(&gdb->wire);
  trax_gdb_add(&gdb->wire, "%s", gdb->reason);
  trax_gdb_send(&gdb->wire);
}

/* The first thread with the event that has not ended with it. */
static bool find_event(struct trax_gdb *gdb, unsigned event, uint32_t *thread) {
  for (*thread = 0; *thread < gdb->threads; ++*thread)
    if ((gdb->thread[*thread].events & event) && trax_gdb_is_alive(gdb, *thread))
      return true;
  return false;
}

/* The first stepping thread. */
static bool find_stepping(const struct trax_gdb *gdb, uint32_t *thread) {
  for (*thread = 0; *thread < gdb->threads; ++*thread)
    if (gdb->thread[*thread].stepping)
      return true;
  return false;
}

static bool somebody_stops(struct trax_gdb *gdb) {
  uint32_t thread;
  return gdb->over || find_event(gdb, ~0u, &thread);
}

/* GDB steps a thread over a breakpoint by naming that thread alone, and takes no other's stop meanwhile. If another one
   has to stop first, the step is told as done, at the pc it will lead to, although the instruction has not been issued:
   no cycle passes, and what stops the other is told when the run is resumed. The same again where the next instruction
   has a breakpoint too, but not for ever: the run must go on. */
static bool pretend_step(struct trax_gdb *gdb) {
  uint32_t thread;
  if (!gdb->named_only || gdb->insisting || !find_stepping(gdb, &thread) || !trax_gdb_is_alive(gdb, thread) ||
      (gdb->thread[thread].events & TRAX_GDB_STEPPED) || !somebody_stops(gdb))
    return false;
  const unsigned ahead = gdb->owed + 1;
  stop(gdb, thread, TRAX_GDB_SIGTRAP, 0);
  gdb->ahead = ahead;
  gdb->ahead_pc = trax_gdb_pc_after(gdb, thread, ahead);
  if (gdb->thread[thread].passed < ahead)
    gdb->thread[thread].passed = (uint8_t)ahead;
  describe_stop(gdb, thread, TRAX_GDB_SIGTRAP, 0);
  tell_stop(gdb);
  return true;
}

/* Of what has happened in one cycle, one thing is told; the rest when the run is resumed. */
static void stop_for_event(struct trax_gdb *gdb) {
  static const unsigned order[] = {TRAX_GDB_STEPPED, TRAX_GDB_ACCESSED, TRAX_GDB_AT_BREAK};
  uint32_t thread;
  gdb->eventful = false;
  if (pretend_step(gdb) || (gdb->insisting && !find_event(gdb, TRAX_GDB_STEPPED, &thread)))
    return;
  for (size_t i = 0; i < sizeof order / sizeof *order; i++)
    if (find_event(gdb, order[i], &thread)) {
      const bool at_break = gdb->thread[thread].events & TRAX_GDB_AT_BREAK;
      const unsigned told = order[i] == TRAX_GDB_STEPPED && at_break ? TRAX_GDB_AT_BREAK : order[i];
      stop(gdb, thread, TRAX_GDB_SIGTRAP, told);
      gdb->thread[thread].events = 0;
      tell_stop(gdb);
      return;
    }
}

/* --- going on --- */

/* What still holds of the events that have not been told. */
static void review(struct trax_gdb *gdb, uint32_t thread) {
  struct trax_gdb_thread *state = &gdb->thread[thread];
  const bool accessed =
      (state->events & TRAX_GDB_ACCESSED) && trax_gdb_watched(gdb, thread, state->accessed, 1, true, true);
  const bool waits = !state->told && !state->stepping && trax_gdb_is_alive(gdb, thread) &&
                     trax_gdb_breaks_at(gdb, trax_gdb_pc(gdb, thread));
  state->events = (uint8_t)((accessed ? TRAX_GDB_ACCESSED : 0) | (waits ? TRAX_GDB_AT_BREAK : 0));
  gdb->eventful |= state->events != 0;
}

void trax_gdb_resume(struct trax_gdb *gdb, bool named_only) {
  gdb->named_only = named_only;
  gdb->owed = named_only && gdb->thread[gdb->stopped].stepping ? gdb->ahead : 0;
  gdb->insisting = gdb->owed >= MOST_AHEAD;
  gdb->ahead = 0;
  if (!named_only)
    trax_gdb_forget_breaks(gdb);
  gdb->phase = GDB_RUNNING;
  gdb->eventful = false;
  for (uint32_t thread = 0; thread < gdb->threads && !gdb->over; thread++)
    review(gdb, thread);
  if (gdb->eventful)
    stop_for_event(gdb);
}

static void detach(struct trax_gdb *gdb) {
  gdb->phase = GDB_DETACHED;
  gdb->break_count = gdb->watch_count = 0;
}

/* Answers the debugger until the run is to go on. */
static void serve(struct trax_gdb *gdb) {
  while (gdb->phase == GDB_STOPPED) {
    if (gdb->interrupt && *gdb->interrupt)
      gdb->phase = GDB_INTERRUPTED;
    else
      switch (trax_gdb_receive(&gdb->wire, ATTENTION)) {
      case TRAX_GDB_ARRIVED:
        trax_gdb_command(gdb);
        break;
      case TRAX_GDB_CLOSED:
        detach(gdb);
        break;
      case TRAX_GDB_NOTHING:
      case TRAX_GDB_BREAK: /* it has stopped */
        break;
      }
  }
}

/* The machine, while it is stopped, is exported. */
static void serve_at(struct trax_gdb *gdb, uint64_t t) {
  gdb->changed = false;
  serve(gdb);
  if (gdb->changed && !gdb->over)
    trax_run_import(gdb->run, t);
}

/* The thread that an interrupt is told of. */
static uint32_t some_thread(const struct trax_gdb *gdb) {
  uint32_t stepping;
  if (find_stepping(gdb, &stepping) && trax_gdb_is_alive(gdb, stepping))
    return stepping;
  if (trax_gdb_is_alive(gdb, gdb->selected))
    return gdb->selected;
  for (uint32_t thread = 0; thread < gdb->threads; thread++)
    if (trax_gdb_is_alive(gdb, thread))
      return thread;
  return 0;
}

/* The debugger of a running program may ask it to stop, and nothing else. */
static bool wants_stop(struct trax_gdb *gdb) {
  const enum trax_gdb_event event = trax_gdb_receive(&gdb->wire, 0);
  if (event == TRAX_GDB_CLOSED)
    detach(gdb);
  return event == TRAX_GDB_BREAK;
}

static bool is_attentive(const struct trax_gdb *gdb) {
  if (gdb->break_count || gdb->watch_count || gdb->atomic_count)
    return true;
  for (uint32_t thread = 0; thread < gdb->threads; thread++)
    if (gdb->thread[thread].stepping)
      return true;
  return false;
}

static void stop_if_due(struct trax_gdb *gdb, uint64_t t) {
  if (gdb->phase != GDB_RUNNING)
    return;
  bool interrupted = false;
  if (t >= gdb->listen_at) {
    gdb->listen_at = t + LISTEN_CYCLES;
    interrupted = wants_stop(gdb);
  }
  if (!gdb->eventful && !interrupted)
    return;
  trax_run_export(gdb->run);
  if (gdb->eventful) {
    stop_for_event(gdb);
  } else {
    stop(gdb, some_thread(gdb), TRAX_GDB_SIGINT, 0);
    tell_stop(gdb);
  }
  serve_at(gdb, t);
}

static trax_status look(struct trax_watch *watch, struct trax_run *run, uint64_t t) {
  struct trax_gdb *gdb = watch->context;
  gdb->run = run;
  gdb->cycle = t;
  if (!gdb->begun) {
    gdb->begun = true;
    trax_run_export(run);
    stop(gdb, 0, TRAX_GDB_SIGTRAP, 0); /* told when it is asked for */
    serve_at(gdb, t);
  } else {
    stop_if_due(gdb, t);
  }
  if (gdb->phase == GDB_KILLED || gdb->phase == GDB_INTERRUPTED)
    return TRAX_INTERRUPTED;
  watch->next = gdb->phase == GDB_DETACHED ? TRAX_NEVER : is_attentive(gdb) ? t + 1 : t + LISTEN_CYCLES;
  return TRAX_OK;
}

/* --- the end --- */

static enum trax_gdb_signal fault_signal(trax_fault_kind kind) {
  switch (kind) {
  case TRAX_FAULT_ABORT:
    return TRAX_GDB_SIGABRT;
  case TRAX_FAULT_ILLEGAL:
    return TRAX_GDB_SIGILL;
  case TRAX_FAULT_MISALIGNED:
  case TRAX_FAULT_MISALIGNED_PC:
    return TRAX_GDB_SIGBUS;
  default:
    return TRAX_GDB_SIGSEGV;
  }
}

static void tell_end(struct trax_gdb *gdb, char how, unsigned number) {
  trax_gdb_begin(&gdb->wire);
  trax_gdb_add(&gdb->wire, "%c%02x", how, number);
  trax_gdb_send(&gdb->wire);
}

/* A fault can be looked at before it ends the run. */
static void end_by_fault(struct trax_gdb *gdb, struct trax_run *run, uint64_t t) {
  const struct trax_fault *fault = &gdb->machine->fault;
  const enum trax_gdb_signal signal = fault_signal(fault->kind);
  trax_run_export(run);
  if (gdb->phase == GDB_RUNNING && !gdb->thread[fault->thread].stepping && pretend_step(gdb))
    serve_at(gdb, t);
  if (gdb->phase != GDB_RUNNING)
    return;
  stop(gdb, fault->thread, signal, 0);
  tell_stop(gdb);
  serve_at(gdb, t);
  if (gdb->phase == GDB_RUNNING)
    tell_end(gdb, 'X', signal);
}

static void end(struct trax_watch *watch, struct trax_run *run, trax_status status, uint64_t t) {
  struct trax_gdb *gdb = watch->context;
  gdb->over = true;
  gdb->cycle = t;
  if (gdb->phase == GDB_DETACHED || gdb->phase == GDB_KILLED)
    return;
  switch (status) {
  case TRAX_OK:
    tell_end(gdb, 'W', (unsigned)trax_machine_exit_status(gdb->machine) & 0xFF);
    break;
  case TRAX_FAULT:
    end_by_fault(gdb, run, t);
    break;
  case TRAX_STUCK:
    tell_end(gdb, 'X', TRAX_GDB_SIGXCPU);
    break;
  case TRAX_INTERRUPTED:
  case TRAX_ERROR:
    tell_end(gdb, 'X', TRAX_GDB_SIGINT);
    break;
  }
}

/* --- */

struct trax_gdb *trax_gdb_create(trax_machine *machine, const struct trax_gdb_link *link, const volatile int *interrupt,
                                 trax_error *error) {
  struct trax_gdb *gdb = calloc(1, sizeof *gdb);
  const uint32_t threads = machine->config.chip.tms * machine->config.chip.tps_per_tm;
  if (gdb) {
    gdb->thread = calloc(threads, sizeof *gdb->thread);
    gdb->atomics = calloc((size_t)threads * TRAX_NUM_REGISTERS, sizeof *gdb->atomics);
  }
  if (!gdb || !gdb->thread || !gdb->atomics) {
    trax_gdb_destroy(gdb);
    trax_fail(error, "out of memory for a debugger of %u threads", threads);
    return NULL;
  }
  gdb->machine = machine;
  gdb->wire.link = *link;
  gdb->interrupt = interrupt;
  gdb->threads = threads;
  gdb->tps = machine->config.chip.tps_per_tm;
  gdb->observed_before = machine->observer;
  gdb->observer = (struct trax_observer){gdb, on_issue, on_charge, on_arrival};
  machine->observer = &gdb->observer;
  gdb->watch = (struct trax_watch){.look = look, .end = end, .context = gdb};
  trax_machine_watch(machine, &gdb->watch);
  return gdb;
}

static void leave(struct trax_gdb *gdb) {
  trax_machine_unwatch(gdb->machine, &gdb->watch);
  if (gdb->machine->observer == &gdb->observer)
    gdb->machine->observer = gdb->observed_before;
}

void trax_gdb_destroy(struct trax_gdb *gdb) {
  if (!gdb)
    return;
  if (gdb->machine)
    leave(gdb);
  free(gdb->thread);
  free(gdb->atomics);
  free(gdb);
}

bool trax_gdb_killed(const struct trax_gdb *gdb) {
  return gdb->phase == GDB_KILLED;
}
