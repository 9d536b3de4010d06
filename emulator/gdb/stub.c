/* The stub: when the run stops, what it reports, and how it continues. */
#include "gdb/stub.h"
#include "trax/isa.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

enum {
  MOST_PRETENDED = 8, /* limit of pretended steps (pretend_step) */
  POLL_MS = 100,      /* interval of polling for an interrupt of trax-sim while the run is stopped */
  LISTEN_CYCLES = 512 /* interval of polling the debugger while the run continues */
};

/* --- notifications while the run continues --- */

static void on_issue(void *context, const struct trax_issue *issue) {
  struct trax_gdb *gdb = context;
  const uint32_t thread = issue->tm * gdb->tps + issue->tp;
  struct trax_gdb_thread *state = &gdb->thread[thread];
  if (gdb->next_observer && gdb->next_observer->issue)
    gdb->next_observer->issue(gdb->next_observer->context, issue);
  if (gdb->phase != GDB_RUNNING)
    return;
  state->reported = state->skip_breaks != 0;
  if (state->stepping && gdb->pretence.catch_up)
    gdb->pretence.catch_up--;
  else if (state->stepping && issue->next_pc - gdb->range_begin >= gdb->range_end - gdb->range_begin)
    state->events |= TRAX_GDB_STEPPED;
  gdb->step_ended |= state->stepping && trax_text_at(&gdb->run->text, issue->pc)->resource == TRAX_RESOURCE_END;
  if (state->skip_breaks)
    state->skip_breaks--;
  else if (gdb->break_count && trax_gdb_breaks_at(gdb, issue->next_pc))
    state->events |= TRAX_GDB_AT_BREAK;
  if (gdb->watch_count)
    trax_gdb_note_access(gdb, thread, issue);
  gdb->eventful |= state->events != 0;
}

static void on_charge(void *context, uint32_t tm, uint32_t tp, trax_cause cause, unsigned rd, uint64_t since,
                      uint64_t cycles) {
  const struct trax_observer *before = ((const struct trax_gdb *)context)->next_observer;
  if (before && before->charge)
    before->charge(before->context, tm, tp, cause, rd, since, cycles);
}

static void on_arrival(void *context, const struct trax_arrival *arrival) {
  struct trax_gdb *gdb = context;
  if (gdb->next_observer && gdb->next_observer->arrival)
    gdb->next_observer->arrival(gdb->next_observer->context, arrival);
  if (gdb->atomic_count)
    trax_gdb_note_arrival(gdb, arrival->tm * gdb->tps + arrival->tp, arrival->rd);
}

/* --- stops --- */

/* Writes the packet of a stop to gdb->reason: signal, thread, reason, and the registers that GDB always needs. */
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
  gdb->pretence.steps = gdb->pretence.catch_up = 0;
  gdb->pretence.step_first = false;
  gdb->selected = gdb->continued = gdb->stopped = thread;
  gdb->thread[thread].reported = true;
  gdb->thread[thread].events &= (uint8_t)~event;
  describe_stop(gdb, thread, signal, event);
}

static void send_stop(struct trax_gdb *gdb) {
  trax_gdb_begin(&gdb->wire);
  trax_gdb_add(&gdb->wire, "%s", gdb->reason);
  trax_gdb_send(&gdb->wire);
}

/* Finds the first live thread with the event. */
static bool find_event(struct trax_gdb *gdb, unsigned event, uint32_t *thread) {
  for (*thread = 0; *thread < gdb->threads; ++*thread)
    if ((gdb->thread[*thread].events & event) && trax_gdb_is_alive(gdb, *thread))
      return true;
  return false;
}

/* Finds the first stepping thread. */
static bool find_stepping(const struct trax_gdb *gdb, uint32_t *thread) {
  for (*thread = 0; *thread < gdb->threads; ++*thread)
    if (gdb->thread[*thread].stepping)
      return true;
  return false;
}

static bool any_event(struct trax_gdb *gdb) {
  uint32_t thread;
  return gdb->over || find_event(gdb, ~0u, &thread);
}

/* GDB steps a thread over a breakpoint by resuming that thread alone, and accepts no stop of another thread meanwhile.
   If another thread has an event first, the stub pretends that the step has been made: it reports a stop at the pc
   after the step, although the instruction has not been issued. No cycle passes, and the other thread's event is
   reported when the run is resumed. If the next instruction has a breakpoint, too, this is repeated, at most
   MOST_PRETENDED times: after that the thread must really step first. */
static bool pretend_step(struct trax_gdb *gdb) {
  uint32_t thread;
  if (!gdb->named_only || gdb->pretence.step_first || !find_stepping(gdb, &thread) || !trax_gdb_is_alive(gdb, thread) ||
      (gdb->thread[thread].events & TRAX_GDB_STEPPED) || !any_event(gdb))
    return false;
  const unsigned pretended = gdb->pretence.catch_up + 1;
  stop(gdb, thread, TRAX_GDB_SIGTRAP, 0);
  gdb->pretence.steps = pretended;
  gdb->pretence.pc = trax_gdb_pc_after(gdb, thread, pretended);
  if (gdb->thread[thread].skip_breaks < pretended)
    gdb->thread[thread].skip_breaks = (uint8_t)pretended;
  describe_stop(gdb, thread, TRAX_GDB_SIGTRAP, 0);
  send_stop(gdb);
  return true;
}

/* Reports one of the events of a cycle. The others are reported when the run is resumed. */
static void stop_for_event(struct trax_gdb *gdb) {
  static const unsigned order[] = {TRAX_GDB_STEPPED, TRAX_GDB_ACCESSED, TRAX_GDB_AT_BREAK};
  uint32_t thread;
  gdb->eventful = false;
  if (pretend_step(gdb) || (gdb->pretence.step_first && !find_event(gdb, TRAX_GDB_STEPPED, &thread)))
    return;
  for (size_t i = 0; i < sizeof order / sizeof *order; i++)
    if (find_event(gdb, order[i], &thread)) {
      const bool at_break = gdb->thread[thread].events & TRAX_GDB_AT_BREAK;
      const unsigned reported = order[i] == TRAX_GDB_STEPPED && at_break ? TRAX_GDB_AT_BREAK : order[i];
      stop(gdb, thread, TRAX_GDB_SIGTRAP, reported);
      gdb->thread[thread].events = 0;
      send_stop(gdb);
      return;
    }
}

/* Returns the thread for which an interrupt is reported: the stepping one, the selected one, or the first live one. */
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

/* Reports a stop of another thread if the last stepping one has ended: no other stop may follow. */
static void stop_for_end(struct trax_gdb *gdb) {
  const uint32_t other = some_thread(gdb);
  gdb->step_ended = false;
  if (!trax_gdb_is_alive(gdb, other) || gdb->thread[other].stepping)
    return;
  stop(gdb, other, TRAX_GDB_SIGTRAP, 0);
  send_stop(gdb);
}

/* --- resuming --- */

/* Drops the unreported events of a thread that are no longer true. */
static void review(struct trax_gdb *gdb, uint32_t thread) {
  struct trax_gdb_thread *state = &gdb->thread[thread];
  const bool accessed =
      (state->events & TRAX_GDB_ACCESSED) && trax_gdb_watched(gdb, thread, state->accessed, 1, true, true);
  const bool waits = !state->reported && !state->stepping && trax_gdb_is_alive(gdb, thread) &&
                     trax_gdb_breaks_at(gdb, trax_gdb_pc(gdb, thread));
  state->events = (uint8_t)((accessed ? TRAX_GDB_ACCESSED : 0) | (waits ? TRAX_GDB_AT_BREAK : 0));
  gdb->eventful |= state->events != 0;
}

void trax_gdb_resume(struct trax_gdb *gdb, bool named_only) {
  gdb->named_only = named_only;
  gdb->pretence.catch_up = named_only && gdb->thread[gdb->stopped].stepping ? gdb->pretence.steps : 0;
  gdb->pretence.step_first = gdb->pretence.catch_up >= MOST_PRETENDED;
  gdb->pretence.steps = 0;
  if (!named_only)
    trax_gdb_forget_breaks(gdb);
  gdb->phase = GDB_RUNNING;
  gdb->eventful = gdb->step_ended = false;
  for (uint32_t thread = 0; thread < gdb->threads && !gdb->over; thread++)
    review(gdb, thread);
  if (gdb->eventful)
    stop_for_event(gdb);
}

static void detach(struct trax_gdb *gdb) {
  gdb->phase = GDB_DETACHED;
  gdb->break_count = gdb->watch_count = 0;
}

/* Handles packets until the run is to continue. */
static void serve(struct trax_gdb *gdb) {
  while (gdb->phase == GDB_STOPPED) {
    if (gdb->interrupt && *gdb->interrupt)
      gdb->phase = GDB_INTERRUPTED;
    else
      switch (trax_gdb_receive(&gdb->wire, POLL_MS)) {
      case TRAX_GDB_ARRIVED:
        trax_gdb_command(gdb);
        break;
      case TRAX_GDB_CLOSED:
        detach(gdb);
        break;
      case TRAX_GDB_NOTHING:
      case TRAX_GDB_BREAK: /* the run has stopped already */
        break;
      }
  }
}

/* Handles packets while the run is stopped before cycle t. The machine's state must have been exported. */
static void serve_at(struct trax_gdb *gdb, uint64_t t) {
  gdb->changed = false;
  serve(gdb);
  if (gdb->changed && !gdb->over)
    trax_run_import(gdb->run, t);
}

/* Whether the debugger interrupts the running program, which is all that it may do. */
static bool wants_stop(struct trax_gdb *gdb) {
  const enum trax_gdb_event event = trax_gdb_receive(&gdb->wire, 0);
  if (event == TRAX_GDB_CLOSED)
    detach(gdb);
  return event == TRAX_GDB_BREAK;
}

static bool needs_every_cycle(const struct trax_gdb *gdb) {
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
  if (gdb->atomic_count)
    trax_gdb_note_changes(gdb);
  if (!gdb->eventful && !interrupted && !gdb->step_ended)
    return;
  trax_run_export(gdb->run);
  if (gdb->eventful) {
    stop_for_event(gdb);
  } else if (gdb->step_ended) {
    stop_for_end(gdb);
  } else {
    stop(gdb, some_thread(gdb), TRAX_GDB_SIGINT, 0);
    send_stop(gdb);
  }
  serve_at(gdb, t);
}

static trax_status inspect(struct trax_watch *watch, struct trax_run *run, uint64_t t) {
  struct trax_gdb *gdb = watch->context;
  gdb->run = run;
  gdb->cycle = t;
  if (!gdb->begun) {
    gdb->begun = true;
    trax_run_export(run);
    stop(gdb, 0, TRAX_GDB_SIGTRAP, 0); /* GDB asks for the first stop by the packet `?` */
    serve_at(gdb, t);
  } else {
    stop_if_due(gdb, t);
  }
  if (gdb->phase == GDB_KILLED || gdb->phase == GDB_INTERRUPTED)
    return TRAX_INTERRUPTED;
  watch->next = gdb->phase == GDB_DETACHED ? TRAX_NEVER : needs_every_cycle(gdb) ? t + 1 : t + LISTEN_CYCLES;
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

static void send_end(struct trax_gdb *gdb, char how, unsigned number) {
  trax_gdb_begin(&gdb->wire);
  trax_gdb_add(&gdb->wire, "%c%02x", how, number);
  trax_gdb_send(&gdb->wire);
}

/* Stops at a fault, so that the user can inspect the machine before the run ends. */
static void end_by_fault(struct trax_gdb *gdb, struct trax_run *run, uint64_t t) {
  const struct trax_fault *fault = &gdb->machine->fault;
  const enum trax_gdb_signal signal = fault_signal(fault->kind);
  trax_run_export(run);
  if (gdb->phase == GDB_RUNNING && !gdb->thread[fault->thread].stepping && pretend_step(gdb))
    serve_at(gdb, t);
  if (gdb->phase != GDB_RUNNING)
    return;
  stop(gdb, fault->thread, signal, 0);
  send_stop(gdb);
  serve_at(gdb, t);
  if (gdb->phase == GDB_RUNNING)
    send_end(gdb, 'X', signal);
}

static void end(struct trax_watch *watch, struct trax_run *run, trax_status status, uint64_t t) {
  struct trax_gdb *gdb = watch->context;
  gdb->over = true;
  gdb->cycle = t;
  if (gdb->phase == GDB_DETACHED || gdb->phase == GDB_KILLED)
    return;
  switch (status) {
  case TRAX_OK:
    send_end(gdb, 'W', (unsigned)trax_machine_exit_status(gdb->machine) & 0xFF);
    break;
  case TRAX_FAULT:
    end_by_fault(gdb, run, t);
    break;
  case TRAX_STUCK:
    send_end(gdb, 'X', TRAX_GDB_SIGXCPU);
    break;
  case TRAX_INTERRUPTED:
  case TRAX_ERROR:
    send_end(gdb, 'X', TRAX_GDB_SIGINT);
    break;
  }
}

/* --- creation and destruction --- */

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
  gdb->next_observer = machine->observer;
  gdb->observer = (struct trax_observer){.context = gdb, .issue = on_issue, .charge = on_charge, .arrival = on_arrival};
  machine->observer = &gdb->observer;
  gdb->watch = (struct trax_watch){.inspect = inspect, .end = end, .context = gdb};
  trax_machine_watch(machine, &gdb->watch);
  return gdb;
}

static void unregister(struct trax_gdb *gdb) {
  trax_machine_unwatch(gdb->machine, &gdb->watch);
  if (gdb->machine->observer == &gdb->observer)
    gdb->machine->observer = gdb->next_observer;
}

void trax_gdb_destroy(struct trax_gdb *gdb) {
  if (!gdb)
    return;
  if (gdb->machine)
    unregister(gdb);
  free(gdb->thread);
  free(gdb->atomics);
  free(gdb);
}

bool trax_gdb_killed(const struct trax_gdb *gdb) {
  return gdb->phase == GDB_KILLED;
}
