/* Packets of the remote serial protocol over a stream of bytes: $data#checksum, acknowledged by + or -. */
#ifndef TRAX_GDB_WIRE_H
#define TRAX_GDB_WIRE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The connection to the debugger. */
struct trax_gdb_link {
  void *context;
  /* Waits at most `milliseconds` for bytes. Returns the number of bytes received, 0 if there are none, -1 if the other
     side has closed the connection. */
  int (*receive)(void *context, uint8_t *bytes, size_t capacity, int milliseconds);
  bool (*send)(void *context, const void *bytes, size_t size); /* returns false if the other side has closed it */
};

enum { TRAX_GDB_PACKET = 0x4000 }; /* limit of a packet's bytes, in both directions */
enum { TRAX_GDB_TOO_LONG = 90 };   /* the error number of the reply to a longer one: EMSGSIZE */

enum trax_gdb_event { TRAX_GDB_NOTHING, TRAX_GDB_ARRIVED, TRAX_GDB_BREAK, TRAX_GDB_CLOSED };

struct trax_gdb_wire {
  struct trax_gdb_link link;
  bool no_acknowledgement; /* neither side sends + or - any more */
  bool closed;

  uint8_t received[4096];
  size_t begin, end; /* of the received bytes that have not been parsed */

  enum { WIRE_IDLE, WIRE_DATA, WIRE_CHECK_HIGH, WIRE_CHECK_LOW } state;
  bool escaped, too_long;
  uint8_t sum, announced;
  char packet[TRAX_GDB_PACKET + 1]; /* the received packet, unescaped, ended by a NUL */
  size_t length;

  char reply[TRAX_GDB_PACKET + 1];
  size_t reply_length;
  char sent[2 * TRAX_GDB_PACKET + 8]; /* the latest packet as sent, for a retransmission */
  size_t sent_length;
};

/* Waits at most `milliseconds` for a packet, which is then in wire->packet, or an interrupt. */
enum trax_gdb_event trax_gdb_receive(struct trax_gdb_wire *wire, int milliseconds);

/* Begins a reply, adds to it, and sends it. A reply that is too long is cut: callers limit data of variable length. */
void trax_gdb_begin(struct trax_gdb_wire *wire);
__attribute__((format(printf, 2, 3))) void trax_gdb_add(struct trax_gdb_wire *wire, const char *format, ...);
void trax_gdb_add_hex(struct trax_gdb_wire *wire, const void *bytes, size_t size);
void trax_gdb_add_bytes(struct trax_gdb_wire *wire, const void *bytes, size_t size); /* binary: escaped when sent */
void trax_gdb_send(struct trax_gdb_wire *wire);

/* --- parsing a packet: each function moves *text past what it reads, and returns false if that is not there --- */

bool trax_gdb_read_number(const char **text, uint64_t *value); /* hexadecimal, at most 16 digits */
bool trax_gdb_read_char(const char **text, char expected);
/* An even number of hexadecimal digits up to the text's end, as bytes. */
bool trax_gdb_read_hex(const char *text, void *bytes, size_t capacity, size_t *size);

#endif
