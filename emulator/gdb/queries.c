/* Packets q and Q: features, threads, documents, the command `monitor`. */
#include "gdb/commands.h"

#include <stdlib.h>
#include <string.h>

static void reply_features(struct trax_gdb *gdb, const char *text) {
  gdb->knows_swbreak = strstr(text, "swbreak+") != NULL;
  trax_gdb_begin(&gdb->wire);
  trax_gdb_add(&gdb->wire,
               "PacketSize=%x;QStartNoAckMode+;qXfer:features:read+;qXfer:threads:read+;vContSupported+;swbreak+",
               TRAX_GDB_PACKET);
  trax_gdb_send(&gdb->wire);
}

static void reply_threads(struct trax_gdb *gdb, uint32_t first) {
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

static void reply_thread_name(struct trax_gdb *gdb, const char *text) {
  int64_t id;
  char name[32];
  if (!trax_gdb_read_thread(gdb, &text, &id) || id <= 0) {
    trax_gdb_refuse(gdb, TRAX_GDB_NO_THREAD);
    return;
  }
  trax_gdb_thread_name(gdb, (uint32_t)id - 1, name, sizeof name);
  trax_gdb_begin(&gdb->wire);
  trax_gdb_add_hex(&gdb->wire, name, strlen(name));
  trax_gdb_send(&gdb->wire);
}

/* Replies the requested part of a document, which is freed. The last part begins with l, others with m. */
static void reply_part(struct trax_gdb *gdb, const char *text, char *document) {
  uint32_t offset;
  size_t size;
  if (!document || !trax_gdb_read_range(&text, &offset, &size) || *text) {
    trax_gdb_refuse(gdb, document ? TRAX_GDB_BAD_REQUEST : TRAX_GDB_NO_MEMORY);
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
    trax_gdb_refuse(gdb, TRAX_GDB_BAD_REQUEST);
    return;
  }
  command[size] = 0;
  trax_gdb_confirm(gdb, trax_gdb_monitor(gdb, command), TRAX_GDB_BAD_REQUEST);
}

void trax_gdb_query(struct trax_gdb *gdb, const char *text) {
  if (trax_gdb_starts_with(&text, "Supported")) {
    reply_features(gdb, text);
  } else if (trax_gdb_starts_with(&text, "Xfer:features:read:target.xml:")) {
    reply_part(gdb, text, trax_gdb_target_description());
  } else if (trax_gdb_starts_with(&text, "Xfer:threads:read::")) {
    reply_part(gdb, text, trax_gdb_thread_list(gdb));
  } else if (strcmp(text, "fThreadInfo") == 0) {
    reply_threads(gdb, 0);
  } else if (strcmp(text, "sThreadInfo") == 0) {
    reply_threads(gdb, gdb->listed);
  } else if (trax_gdb_starts_with(&text, "ThreadExtraInfo,")) {
    reply_thread_name(gdb, text);
  } else if (strcmp(text, "C") == 0) {
    trax_gdb_begin(&gdb->wire);
    trax_gdb_add(&gdb->wire, "QC%x", gdb->selected + 1);
    trax_gdb_send(&gdb->wire);
  } else if (strcmp(text, "Attached") == 0) { /* 0: GDB kills the program when it quits */
    trax_gdb_answer(gdb, "0");
  } else if (trax_gdb_starts_with(&text, "Rcmd,")) {
    monitor(gdb, text);
  } else if (trax_gdb_starts_with(&text, "Symbol:")) { /* the stub needs no symbols */
    trax_gdb_answer(gdb, "OK");
  } else {
    trax_gdb_answer(gdb, "");
  }
}

void trax_gdb_set(struct trax_gdb *gdb, const char *text) {
  const bool no_acknowledgement = strcmp(text, "StartNoAckMode") == 0;
  trax_gdb_answer(gdb, no_acknowledgement ? "OK" : "");
  gdb->wire.no_acknowledgement |= no_acknowledgement;
}
