/* Breakpoints and watchpoints. */
#include "gdb/stub.h"
#include "trax/isa.h"

#include <string.h>

/* --- breakpoints --- */

/* Returns the place of the first breakpoint that is not below an address. */
static uint32_t place_of(const struct trax_gdb *gdb, uint32_t address) {
  uint32_t low = 0, high = gdb->break_count;
  while (low < high) {
    const uint32_t middle = (low + high) / 2;
    if (gdb->breaks[middle].address < address)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

static struct trax_gdb_break *find_break(struct trax_gdb *gdb, uint32_t address) {
  const uint32_t place = place_of(gdb, address);
  return place < gdb->break_count && gdb->breaks[place].address == address ? &gdb->breaks[place] : NULL;
}

/* Breakpoints are possible in text, and in local memory, to which GDB makes functions return that it calls itself. */
static bool can_break(const struct trax_gdb *gdb, uint32_t address) {
  return address >= TRAX_LOCAL_BASE || trax_text_at(&gdb->run->text, address)->resource != TRAX_RESOURCE_NO_TEXT;
}

static bool insert_break(struct trax_gdb *gdb, uint32_t address) {
  struct trax_gdb_break *found = find_break(gdb, address);
  if (!found && (gdb->break_count == TRAX_GDB_BREAKS || !can_break(gdb, address)))
    return false;
  if (!found) {
    found = &gdb->breaks[place_of(gdb, address)];
    memmove(found + 1, found, (size_t)(&gdb->breaks[gdb->break_count++] - found) * sizeof *found);
  }
  *found = (struct trax_gdb_break){.address = address};
  return true;
}

void trax_gdb_forget_breaks(struct trax_gdb *gdb) {
  uint32_t kept = 0;
  for (uint32_t i = 0; i < gdb->break_count; i++)
    if (!gdb->breaks[i].removed)
      gdb->breaks[kept++] = gdb->breaks[i];
  gdb->break_count = kept;
  kept = 0;
  for (uint32_t i = 0; i < gdb->watch_count; i++)
    if (!gdb->watches[i].removed)
      gdb->watches[kept++] = gdb->watches[i];
  gdb->watch_count = kept;
}

bool trax_gdb_breaks_at(const struct trax_gdb *gdb, uint32_t pc) {
  const uint32_t place = place_of(gdb, pc);
  return place < gdb->break_count && gdb->breaks[place].address == pc &&
         (!gdb->breaks[place].removed || gdb->named_only);
}

/* --- watchpoints --- */

static struct trax_gdb_watch *find_watch(struct trax_gdb *gdb, char type, uint32_t address, uint32_t bytes,
                                         bool removed) {
  for (uint32_t i = 0; i < gdb->watch_count; i++) {
    struct trax_gdb_watch *watch = &gdb->watches[i];
    if (watch->type == type && watch->address == address && watch->bytes == bytes && watch->removed == removed)
      return watch;
  }
  return NULL;
}

static bool insert_watch(struct trax_gdb *gdb, char type, uint32_t address, uint32_t bytes) {
  struct trax_gdb_watch *again = find_watch(gdb, type, address, bytes, true);
  uint32_t free = 0;
  if (again) {
    again->removed = false;
    return true;
  }
  while (gdb->watch_count == TRAX_GDB_WATCHES && free < TRAX_GDB_WATCHES && !gdb->watches[free].removed)
    free++;
  if (free == TRAX_GDB_WATCHES || bytes == 0)
    return false;
  gdb->watches[gdb->watch_count == TRAX_GDB_WATCHES ? free : gdb->watch_count++] =
      (struct trax_gdb_watch){type, address, bytes, gdb->selected, false};
  return true;
}

static bool remove_watch(struct trax_gdb *gdb, char type, uint32_t address, uint32_t bytes) {
  struct trax_gdb_watch *found = find_watch(gdb, type, address, bytes, false);
  if (found)
    found->removed = true;
  return true; /* the protocol allows removing a watchpoint twice */
}

const struct trax_gdb_watch *trax_gdb_watched(const struct trax_gdb *gdb, uint32_t thread, uint32_t address,
                                              uint32_t bytes, bool reads, bool writes) {
  for (uint32_t i = 0; i < gdb->watch_count; i++) {
    const struct trax_gdb_watch *watch = &gdb->watches[i];
    const bool wanted = watch->type == '2' ? writes : watch->type == '3' ? reads : true;
    if (wanted && !watch->removed && (uint64_t)address + bytes > watch->address &&
        (uint64_t)watch->address + watch->bytes > address && (address < TRAX_LOCAL_BASE || watch->thread == thread))
      return watch;
  }
  return NULL;
}

static void add_event(struct trax_gdb *gdb, uint32_t thread, uint32_t address, uint32_t bytes, bool reads,
                      bool writes) {
  const struct trax_gdb_watch *watch = trax_gdb_watched(gdb, thread, address, bytes, reads, writes);
  struct trax_gdb_thread *state = &gdb->thread[thread];
  if (!watch)
    return;
  state->events |= TRAX_GDB_ACCESSED;
  state->access = watch->type;
  state->accessed = address > watch->address ? address : watch->address;
  gdb->eventful = true;
}

static uint32_t word_at(const struct trax_gdb *gdb, uint32_t address) {
  uint32_t word;
  memcpy(&word, gdb->machine->space.bytes + address, sizeof word); /* the access has been checked */
  return word;
}

void trax_gdb_note_access(struct trax_gdb *gdb, uint32_t thread, const struct trax_issue *issue) {
  const trax_op_info *info = &trax_op_table[trax_decode(issue->word).op];
  if (!info->access_bytes)
    return;
  if (info->flags & TRAX_IS_ATOMIC) { /* the access happens later; see trax_gdb_note_arrival */
    if (gdb->atomic_count < gdb->threads * TRAX_NUM_REGISTERS &&
        trax_gdb_watched(gdb, thread, issue->address, 4, true, true))
      gdb->atomics[gdb->atomic_count++] =
          (struct trax_gdb_atomic){thread, trax_decode(issue->word).rd, issue->address, word_at(gdb, issue->address)};
    return;
  }
  const bool writes = (info->flags & TRAX_IS_STORE) != 0;
  add_event(gdb, thread, issue->address, info->access_bytes, !writes, writes);
}

void trax_gdb_note_arrival(struct trax_gdb *gdb, uint32_t thread, uint32_t rd) {
  for (uint32_t i = 0; i < gdb->atomic_count; i++)
    if (gdb->atomics[i].thread == thread && gdb->atomics[i].rd == rd) {
      add_event(gdb, thread, gdb->atomics[i].address, 4, true, true);
      gdb->atomics[i] = gdb->atomics[--gdb->atomic_count];
      return;
    }
}

void trax_gdb_note_changes(struct trax_gdb *gdb) {
  for (uint32_t i = gdb->atomic_count; i--;) {
    const struct trax_gdb_atomic atomic = gdb->atomics[i];
    if (atomic.rd || word_at(gdb, atomic.address) == atomic.before)
      continue;
    add_event(gdb, atomic.thread, atomic.address, 4, true, true);
    gdb->atomics[i] = gdb->atomics[--gdb->atomic_count];
  }
}

/* --- packets --- */

bool trax_gdb_insert(struct trax_gdb *gdb, char type, uint32_t address, uint32_t bytes) {
  if (type == '0' || type == '1')
    return insert_break(gdb, address);
  return type >= '2' && type <= '4' && insert_watch(gdb, type, address, bytes);
}

bool trax_gdb_remove(struct trax_gdb *gdb, char type, uint32_t address, uint32_t bytes) {
  struct trax_gdb_break *found;
  if (type != '0' && type != '1')
    return type >= '2' && type <= '4' && remove_watch(gdb, type, address, bytes);
  if ((found = find_break(gdb, address)))
    found->removed = true;
  return true;
}
