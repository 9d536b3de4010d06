/* GDB's packets and the replies to them: threads, registers, memory and breakpoints. An unknown packet gets an empty
   reply, a bad one E and an error number. resume.c has the packets that continue the run, queries.c those that ask for
   information. */
#include "gdb/commands.h"
#include "gdb/registers.h"

#include <string.h>

/* --- replies and arguments --- */

void trax_gdb_answer(struct trax_gdb *gdb, const char *text) {
  trax_gdb_begin(&gdb->wire);
  trax_gdb_add(&gdb->wire, "%s", text);
  trax_gdb_send(&gdb->wire);
}

void trax_gdb_refuse(struct trax_gdb *gdb, unsigned number) {
  trax_gdb_begin(&gdb->wire);
  trax_gdb_add(&gdb->wire, "E%02x", number);
  trax_gdb_send(&gdb->wire);
}

void trax_gdb_confirm(struct trax_gdb *gdb, bool done, unsigned number) {
  if (done)
    trax_gdb_answer(gdb, "OK");
  else
    trax_gdb_refuse(gdb, number);
}

bool trax_gdb_starts_with(const char **text, const char *prefix) {
  const size_t length = strlen(prefix);
  if (strncmp(*text, prefix, length) != 0)
    return false;
  *text += length;
  return true;
}

/* --- threads --- */

/* A thread's id is its number + 1. */
bool trax_gdb_read_thread(const struct trax_gdb *gdb, const char **text, int64_t *id) {
  uint64_t number;
  if (trax_gdb_starts_with(text, "-1")) {
    *id = TRAX_GDB_ALL_THREADS;
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
  if ((what != 'g' && what != 'c') || !trax_gdb_read_thread(gdb, &text, &id) || *text) {
    trax_gdb_refuse(gdb, TRAX_GDB_BAD_REQUEST);
    return;
  }
  if (id > 0 && !is_thread(gdb, id)) {
    trax_gdb_refuse(gdb, TRAX_GDB_NO_THREAD);
    return;
  }
  if (id > 0)
    *(what == 'g' ? &gdb->selected : &gdb->continued) = (uint32_t)id - 1;
  trax_gdb_answer(gdb, "OK");
}

static void reply_is_alive(struct trax_gdb *gdb, const char *text) {
  int64_t id;
  trax_gdb_confirm(gdb, trax_gdb_read_thread(gdb, &text, &id) && !*text && is_thread(gdb, id), TRAX_GDB_NO_THREAD);
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

/* Every register is in the packet twice (registers.h). The copy that differs from the current value is written. */
static void write_registers(struct trax_gdb *gdb, const char *text) {
  uint32_t before[TRAX_GDB_REGISTERS], value[TRAX_GDB_REGISTERS];
  size_t size;
  bool done = trax_gdb_read_hex(text, value, sizeof value, &size) && size % sizeof *value == 0;
  for (unsigned number = 0; number < TRAX_GDB_REGISTERS; number++)
    before[number] = trax_gdb_register(gdb, gdb->selected, number);
  for (unsigned number = 0; done && number < size / sizeof *value; number++)
    if (value[number] != before[number])
      done = trax_gdb_set_register(gdb, gdb->selected, number, value[number]);
  trax_gdb_confirm(gdb, done, TRAX_GDB_BAD_REQUEST);
}

static void read_register(struct trax_gdb *gdb, const char *text) {
  uint64_t number;
  if (!trax_gdb_read_number(&text, &number) || *text || number >= TRAX_GDB_REGISTERS) {
    trax_gdb_refuse(gdb, TRAX_GDB_BAD_REQUEST);
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
  trax_gdb_confirm(gdb,
                   trax_gdb_read_number(&text, &number) && number < TRAX_GDB_REGISTERS &&
                       trax_gdb_read_char(&text, '=') && trax_gdb_read_hex(text, &value, sizeof value, &size) &&
                       size == sizeof value && trax_gdb_set_register(gdb, gdb->selected, (unsigned)number, value),
                   TRAX_GDB_BAD_REQUEST);
}

bool trax_gdb_read_range(const char **text, uint32_t *address, size_t *size) {
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
  if (!trax_gdb_read_range(&text, &address, &size) || *text) {
    trax_gdb_refuse(gdb, TRAX_GDB_BAD_REQUEST);
    return;
  }
  if (size > TRAX_GDB_PACKET / 2)
    size = TRAX_GDB_PACKET / 2;
  const size_t there = trax_gdb_memory(gdb, gdb->selected, address, size, &bytes);
  if (size && !there) {
    trax_gdb_refuse(gdb, TRAX_GDB_BAD_ADDRESS);
    return;
  }
  trax_gdb_begin(&gdb->wire);
  if (there)
    trax_gdb_add_hex(&gdb->wire, bytes, there);
  trax_gdb_send(&gdb->wire);
}

/* Packet M has hexadecimal digits, packet X binary bytes. */
static void write_memory(struct trax_gdb *gdb, const char *text, bool binary) {
  static uint8_t decoded[TRAX_GDB_PACKET / 2];
  uint32_t address;
  size_t size, given;
  if (!trax_gdb_read_range(&text, &address, &size) || !trax_gdb_read_char(&text, ':')) {
    trax_gdb_refuse(gdb, TRAX_GDB_BAD_REQUEST);
    return;
  }
  const void *bytes = binary ? (const void *)text : decoded;
  given = gdb->wire.length - (size_t)(text - gdb->wire.packet);
  if ((!binary && !trax_gdb_read_hex(text, decoded, sizeof decoded, &given)) || given != size)
    trax_gdb_refuse(gdb, TRAX_GDB_BAD_REQUEST);
  else
    trax_gdb_confirm(gdb, trax_gdb_write_memory(gdb, gdb->selected, address, bytes, size), TRAX_GDB_BAD_ADDRESS);
}

/* --- breakpoints --- */

static void change_breaks(struct trax_gdb *gdb, const char *text, bool insert) {
  uint32_t address;
  size_t bytes;
  const char type = *text++;
  if (type < '0' || type > '4') {
    trax_gdb_answer(gdb, "");
    return;
  }
  trax_gdb_confirm(gdb,
                   trax_gdb_read_char(&text, ',') && trax_gdb_read_range(&text, &address, &bytes) && !*text &&
                       !gdb->over && (insert ? trax_gdb_insert : trax_gdb_remove)(gdb, type, address, (uint32_t)bytes),
                   TRAX_GDB_BAD_REQUEST);
}

/* --- all packets --- */

void trax_gdb_command(struct trax_gdb *gdb) {
  const char *text = gdb->wire.packet;
  switch (*text++) {
  case '?':
    trax_gdb_answer(gdb, gdb->reason);
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
    reply_is_alive(gdb, text);
    break;
  case 'Z':
    change_breaks(gdb, text, true);
    break;
  case 'z':
    change_breaks(gdb, text, false);
    break;
  case 'c':
    trax_gdb_continue(gdb, text, false, false);
    break;
  case 'C':
    trax_gdb_continue(gdb, text, false, true);
    break;
  case 's':
    trax_gdb_continue(gdb, text, true, false);
    break;
  case 'S':
    trax_gdb_continue(gdb, text, true, true);
    break;
  case 'v':
    trax_gdb_verbose(gdb, text);
    break;
  case 'q':
    trax_gdb_query(gdb, text);
    break;
  case 'Q':
    trax_gdb_set(gdb, text);
    break;
  case 'D':
    trax_gdb_answer(gdb, "OK");
    gdb->phase = GDB_DETACHED;
    gdb->break_count = gdb->watch_count = 0;
    break;
  case 'k':
    gdb->phase = GDB_KILLED;
    break;
  default:
    trax_gdb_answer(gdb, "");
    break;
  }
}
