/* The packets that GDB sends, and their answers. An unknown one is answered by nothing, a bad one by E and a number. */
#include "gdb/registers.h"
#include "gdb/stub.h"

#include <stdlib.h>
#include <string.h>

enum { BAD_REQUEST = 22, BAD_ADDRESS = 14, NO_THREAD = 3, NO_MEMORY = 12 }; /* errno's numbers; GDB shows them */

static void answer(struct trax_gdb *gdb, const char *text) {
  trax_gdb_begin(&gdb->wire);
  trax_gdb_add(&gdb->wire, "%s", text);
  trax_gdb_send(&gdb->wire);
}

static void refuse(struct trax_gdb *gdb, unsigned number) {
  trax_gdb_begin(&gdb->wire);
  trax_gdb_add(&gdb->wire, "E%02x", number);
  trax_gdb_send(&gdb->wire);
}

static void confirm(struct trax_gdb *gdb, bool done, unsigned number) {
  if (done)
    answer(gdb, "OK");
  else
    refuse(gdb, number);
}

static bool starts_with(const char **text, const char *prefix) {
  const size_t length = strlen(prefix);
  if (strncmp(*text, prefix, length) != 0)
    return false;
  *text += length;
  return true;
}

/* --- threads --- */

enum { ANY_THREAD = 0, ALL_THREADS = -1 };

/* A thread's id is its number plus one. */
static bool read_thread(const struct trax_gdb *gdb, const char **text, int64_t *id) {
  uint64_t number;
  if (starts_with(text, "-1")) {
    *id = ALL_THREADS;
    return true;
  }
  if (!trax_gdb_read_number(text, &number) || number > gdb->threads)
    return false;
  *id = (int64_t)number;
  return true;
}

static bool is_thread(const struct trax_gdb *gdb, int64_t id) {
  return id > 0 && trax_gdb_is_alive(gdb, (uint32_t)id - 1);
}

static void select_thread(struct trax_gdb *gdb, const char *text) {
  int64_t id;
  const char what = *text++;
  if ((what != 'g' && what != 'c') || !read_thread(gdb, &text, &id) || *text) {
    refuse(gdb, BAD_REQUEST);
    return;
  }
  if (id > 0 && !is_thread(gdb, id)) {
    refuse(gdb, NO_THREAD);
    return;
  }
  if (id > 0)
    *(what == 'g' ? &gdb->selected : &gdb->continued) = (uint32_t)id - 1;
  answer(gdb, "OK");
}

static void tell_is_alive(struct trax_gdb *gdb, const char *text) {
  int64_t id;
  confirm(gdb, read_thread(gdb, &text, &id) && !*text && is_thread(gdb, id), NO_THREAD);
}

/* --- registers and memory --- */

static void read_registers(struct trax_gdb *gdb) {
  trax_gdb_begin(&gdb->wire);
  for (unsigned number = 0; number < TRAX_GDB_REGISTERS; number++) {
    const uint32_t value = trax_gdb_register(gdb, gdb->selected, number);
    trax_gdb_add_hex(&gdb->wire, &value, sizeof value);
  }
  trax_gdb_send(&gdb->wire);
}

/* Every register stands there twice: the one that differs from what is there is meant. */
static void write_registers(struct trax_gdb *gdb, const char *text) {
  uint32_t before[TRAX_GDB_REGISTERS], value[TRAX_GDB_REGISTERS];
  size_t size;
  bool done = trax_gdb_read_hex(text, value, sizeof value, &size) && size % sizeof *value == 0;
  for (unsigned number = 0; number < TRAX_GDB_REGISTERS; number++)
    before[number] = trax_gdb_register(gdb, gdb->selected, number);
  for (unsigned number = 0; done && number < size / sizeof *value; number++)
    if (value[number] != before[number])
      done = trax_gdb_set_register(gdb, gdb->selected, number, value[number]);
  confirm(gdb, done, BAD_REQUEST);
}

static void read_register(struct trax_gdb *gdb, const char *text) {
  uint64_t number;
  if (!trax_gdb_read_number(&text, &number) || *text || number >= TRAX_GDB_REGISTERS) {
    refuse(gdb, BAD_REQUEST);
    return;
  }
  const uint32_t value = trax_gdb_register(gdb, gdb->selected, (unsigned)number);
  trax_gdb_begin(&gdb->wire);
  trax_gdb_add_hex(&gdb->wire, &value, sizeof value);
  trax_gdb_send(&gdb->wire);
}

static void write_register(struct trax_gdb *gdb, const char *text) {
  uint64_t number;
  uint32_t value;
  size_t size;
  confirm(gdb,
          trax_gdb_read_number(&text, &number) && number < TRAX_GDB_REGISTERS && trax_gdb_read_char(&text, '=') &&
              trax_gdb_read_hex(text, &value, sizeof value, &size) && size == sizeof value &&
              trax_gdb_set_register(gdb, gdb->selected, (unsigned)number, value),
          BAD_REQUEST);
}

static bool read_range(const char **text, uint32_t *address, size_t *size) {
  uint64_t at, bytes;
  if (!trax_gdb_read_number(text, &at) || !trax_gdb_read_char(text, ',') || !trax_gdb_read_number(text, &bytes) ||
      at > UINT32_MAX || bytes > UINT32_MAX)
    return false;
  *address = (uint32_t)at;
  *size = (size_t)bytes;
  return true;
}

static void read_memory(struct trax_gdb *gdb, const char *text) {
  uint32_t address;
  size_t size;
  uint8_t *bytes;
  if (!read_range(&text, &address, &size) || *text) {
    refuse(gdb, BAD_REQUEST);
    return;
  }
  if (size > TRAX_GDB_PACKET / 2)
    size = TRAX_GDB_PACKET / 2;
  const size_t there = trax_gdb_memory(gdb, gdb->selected, address, size, &bytes);
  if (size && !there) {
    refuse(gdb, BAD_ADDRESS);
    return;
  }
  trax_gdb_begin(&gdb->wire);
  if (there)
    trax_gdb_add_hex(&gdb->wire, bytes, there);
  trax_gdb_send(&gdb->wire);
}

/* M: hexadecimal; X: binary. */
static void write_memory(struct trax_gdb *gdb, const char *text, bool binary) {
  static uint8_t decoded[TRAX_GDB_PACKET / 2];
  uint32_t address;
  size_t size, given;
  if (!read_range(&text, &address, &size) || !trax_gdb_read_char(&text, ':')) {
    refuse(gdb, BAD_REQUEST);
    return;
  }
  const void *bytes = binary ? (const void *)text : decoded;
  given = gdb->wire.length - (size_t)(text - gdb->wire.packet);
  if ((!binary && !trax_gdb_read_hex(text, decoded, sizeof decoded, &given)) || given != size)
    refuse(gdb, BAD_REQUEST);
  else
    confirm(gdb, trax_gdb_write_memory(gdb, gdb->selected, address, bytes, size), BAD_ADDRESS);
}

/* --- breakpoints --- */

static void change_breaks(struct trax_gdb *gdb, const char *text, bool insert) {
  uint32_t address;
  size_t bytes;
  const char type = *text++;
  if (type < '0' || type > '4') {
    answer(gdb, "");
    return;
  }
  confirm(gdb,
          trax_gdb_read_char(&text, ',') && read_range(&text, &address, &bytes) && !*text && !gdb->over &&
              (insert ? trax_gdb_insert : trax_gdb_remove)(gdb, type, address, (uint32_t)bytes),
          BAD_REQUEST);
}

/* --- going on --- */

static void forget_steps(struct trax_gdb *gdb) {
  gdb->range_begin = gdb->range_end = 0;
  for (uint32_t thread = 0; thread < gdb->threads; thread++)
    gdb->thread[thread].stepping = false;
}

/* c, C, s, S: a signal that is to be delivered goes nowhere, since programs have no handlers. */
static void go_on(struct trax_gdb *gdb, const char *text, bool step, bool with_signal) {
  uint64_t signal, pc;
  if (with_signal && !trax_gdb_read_number(&text, &signal)) {
    refuse(gdb, BAD_REQUEST);
    return;
  }
  if (with_signal)
    trax_gdb_read_char(&text, ';');
  if (*text && (!trax_gdb_read_number(&text, &pc) || *text || pc > UINT32_MAX ||
                !trax_gdb_set_register(gdb, gdb->continued, TRAX_GDB_PC, (uint32_t)pc))) {
    refuse(gdb, BAD_REQUEST);
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

/* One of vCont's: a letter, a signal or a range, a thread. */
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
  *action = (struct action){what != 'c' && what != 'C', (uint32_t)begin, (uint32_t)end, ALL_THREADS};
  return !trax_gdb_read_char(text, ':') || read_thread(gdb, text, &action->thread);
}

static void apply_action(struct trax_gdb *gdb, const struct action *action, bool *decided) {
  for (uint32_t thread = 0; thread < gdb->threads; thread++) {
    const bool meant =
        action->thread == ALL_THREADS ||
        (action->thread == ANY_THREAD ? gdb->continued == thread : action->thread == (int64_t)thread + 1);
    if (!meant || decided[thread])
      continue;
    decided[thread] = true; /* the first that fits holds */
    gdb->thread[thread].stepping = action->step;
  }
  if (action->step && action->end > action->begin) {
    gdb->range_begin = action->begin;
    gdb->range_end = action->end;
  }
}

/* Threads that are not named would stay where they are; here they go on all the same, since their cycles are those of
   the others (docs/debugging.md). */
static void resume_threads(struct trax_gdb *gdb, const char *text) {
  struct action action;
  bool *decided = calloc(gdb->threads, sizeof *decided), correct = decided != NULL, named_only = true;
  forget_steps(gdb);
  while (correct && *text) {
    correct = trax_gdb_read_char(&text, ';') && read_action(gdb, &text, &action);
    if (correct) {
      apply_action(gdb, &action, decided);
      named_only &= action.thread != ALL_THREADS;
    }
  }
  free(decided);
  if (correct) {
    trax_gdb_resume(gdb, named_only);
  } else {
    forget_steps(gdb);
    refuse(gdb, BAD_REQUEST);
  }
}

static void verbose(struct trax_gdb *gdb, const char *text) {
  if (strcmp(text, "Cont?") == 0) {
    answer(gdb, "vCont;c;C;s;S;r");
  } else if (starts_with(&text, "Cont")) {
    resume_threads(gdb, text);
  } else if (starts_with(&text, "Kill;")) {
    gdb->phase = GDB_KILLED;
    answer(gdb, "OK");
  } else {
    answer(gdb, "");
  }
}

/* --- questions --- */

static void tell_features(struct trax_gdb *gdb, const char *text) {
  gdb->knows_swbreak = strstr(text, "swbreak+") != NULL;
  trax_gdb_begin(&gdb->wire);
  trax_gdb_add(&gdb->wire,
               "PacketSize=%x;QStartNoAckMode+;qXfer:features:read+;qXfer:threads:read+;vContSupported+;swbreak+",
               TRAX_GDB_PACKET);
  trax_gdb_send(&gdb->wire);
}

static void tell_threads(struct trax_gdb *gdb, uint32_t first) {
  trax_gdb_begin(&gdb->wire);
  uint32_t thread = first;
  const char *separator = "m";
  for (; thread < gdb->threads && gdb->wire.reply_length < TRAX_GDB_PACKET - 16; thread++)
    if (trax_gdb_is_alive(gdb, thread)) {
      trax_gdb_add(&gdb->wire, "%s%x", separator, thread + 1);
      separator = ",";
    }
  if (!gdb->wire.reply_length)
    trax_gdb_add(&gdb->wire, "l");
  gdb->listed = thread;
  trax_gdb_send(&gdb->wire);
}

static void tell_thread_name(struct trax_gdb *gdb, const char *text) {
  int64_t id;
  char name[32];
  if (!read_thread(gdb, &text, &id) || id <= 0) {
    refuse(gdb, NO_THREAD);
    return;
  }
  trax_gdb_thread_name(gdb, (uint32_t)id - 1, name, sizeof name);
  trax_gdb_begin(&gdb->wire);
  trax_gdb_add_hex(&gdb->wire, name, strlen(name));
  trax_gdb_send(&gdb->wire);
}

/* The part of a document that is asked for; l before the last, m before others. */
static void tell_part(struct trax_gdb *gdb, const char *text, char *document) {
  uint32_t offset;
  size_t size;
  if (!document || !read_range(&text, &offset, &size) || *text) {
    refuse(gdb, document ? BAD_REQUEST : NO_MEMORY);
  } else {
    const size_t whole = strlen(document), begin = offset < whole ? offset : whole;
    if (size > TRAX_GDB_PACKET / 2) /* every byte may need an escape */
      size = TRAX_GDB_PACKET / 2;
    const bool last = size >= whole - begin;
    trax_gdb_begin(&gdb->wire);
    trax_gdb_add(&gdb->wire, last ? "l" : "m");
    trax_gdb_add_bytes(&gdb->wire, document + begin, last ? whole - begin : size);
    trax_gdb_send(&gdb->wire);
  }
  free(document);
}

static void monitor(struct trax_gdb *gdb, const char *text) {
  char command[256];
  size_t size;
  if (!trax_gdb_read_hex(text, command, sizeof command - 1, &size)) {
    refuse(gdb, BAD_REQUEST);
    return;
  }
  command[size] = 0;
  confirm(gdb, trax_gdb_monitor(gdb, command), BAD_REQUEST);
}

static void query(struct trax_gdb *gdb, const char *text) {
  if (starts_with(&text, "Supported")) {
    tell_features(gdb, text);
  } else if (starts_with(&text, "Xfer:features:read:target.xml:")) {
    tell_part(gdb, text, trax_gdb_target_description());
  } else if (starts_with(&text, "Xfer:threads:read::")) {
    tell_part(gdb, text, trax_gdb_thread_list(gdb));
  } else if (strcmp(text, "fThreadInfo") == 0) {
    tell_threads(gdb, 0);
  } else if (strcmp(text, "sThreadInfo") == 0) {
    tell_threads(gdb, gdb->listed);
  } else if (starts_with(&text, "ThreadExtraInfo,")) {
    tell_thread_name(gdb, text);
  } else if (strcmp(text, "C") == 0) {
    trax_gdb_begin(&gdb->wire);
    trax_gdb_add(&gdb->wire, "QC%x", gdb->selected + 1);
    trax_gdb_send(&gdb->wire);
  } else if (strcmp(text, "Attached") == 0) { /* leaving the debugger ends the run, unless it detaches */
    answer(gdb, "0");
  } else if (starts_with(&text, "Rcmd,")) {
    monitor(gdb, text);
  } else if (starts_with(&text, "Symbol:")) { /* none is wanted */
    answer(gdb, "OK");
  } else {
    answer(gdb, "");
  }
}

static void set(struct trax_gdb *gdb, const char *text) {
  const bool no_acknowledgement = strcmp(text, "StartNoAckMode") == 0;
  answer(gdb, no_acknowledgement ? "OK" : "");
  gdb->wire.no_acknowledgement |= no_acknowledgement;
}

void trax_gdb_command(struct trax_gdb *gdb) {
  const char *text = gdb->wire.packet;
  switch (*text++) {
  case '?':
    answer(gdb, gdb->reason);
    break;
  case 'g':
    read_registers(gdb);
    break;
  case 'G':
    write_registers(gdb, text);
    break;
  case 'p':
    read_register(gdb, text);
    break;
  case 'P':
    write_register(gdb, text);
    break;
  case 'm':
    read_memory(gdb, text);
    break;
  case 'M':
    write_memory(gdb, text, false);
    break;
  case 'X':
    write_memory(gdb, text, true);
    break;
  case 'H':
    select_thread(gdb, text);
    break;
  case 'T':
    tell_is_alive(gdb, text);
    break;
  case 'Z':
    change_breaks(gdb, text, true);
    break;
  case 'z':
    change_breaks(gdb, text, false);
    break;
  case 'c':
    go_on(gdb, text, false, false);
    break;
  case 'C':
    go_on(gdb, text, false, true);
    break;
  case 's':
    go_on(gdb, text, true, false);
    break;
  case 'S':
    go_on(gdb, text, true, true);
    break;
  case 'v':
    verbose(gdb, text);
    break;
  case 'q':
    query(gdb, text);
    break;
  case 'Q':
    set(gdb, text);
    break;
  case 'D':
    answer(gdb, "OK");
    gdb->phase = GDB_DETACHED;
    gdb->break_count = gdb->watch_count = 0;
    break;
  case 'k':
    gdb->phase = GDB_KILLED;
    break;
  default:
    answer(gdb, "");
    break;
  }
}
