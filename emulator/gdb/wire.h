/* Packets of the remote serial protocol over a stream of bytes: $data#checksum, answered by + or -. */
#ifndef TRAX_GDB_WIRE_H
#define TRAX_GDB_WIRE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* How bytes go to and from the debugger. */
struct trax_gdb_link {
  void *context;
  /* Waits at most so many milliseconds for bytes. Returns how many were received, 0 if none, -1 if the other side has
     closed. */
  int (*receive)(void *context, uint8_t *bytes, size_t capacity, int milliseconds);
  bool (*send)(void *context, const void *bytes, size_t size); /* false: the other side has closed */
};

enum { TRAX_GDB_PACKET = 0x4000 }; /* most bytes of a packet, in both directions */

enum trax_gdb_event { TRAX_GDB_NOTHING, TRAX_GDB_ARRIVED, TRAX_GDB_BREAK, TRAX_GDB_CLOSED };

struct trax_gdb_wire {
  struct trax_gdb_link link;
  bool no_acknowledgement; /* neither side sends + or - any more */
  bool closed;

  uint8_t received[4096];
  size_t begin, end; /* of what has not been looked at */

  enum { WIRE_IDLE, WIRE_DATA, WIRE_CHECK_HIGH, WIRE_CHECK_LOW } state;
  bool escaped, too_long;
  uint8_t sum, announced;
  char packet[TRAX_GDB_PACKET + 1]; /* what has arrived, unescaped, with a NUL behind it */
  size_t length;

  char reply[TRAX_GDB_PACKET + 1];
  size_t reply_length;
  char sent[2 * TRAX_GDB_PACKET + 8]; /* the last packet as it was sent, for when it is asked for again */
  size_t sent_length;
};

/* Waits at most so many milliseconds for a packet (in wire->packet) or a request to stop. */
enum trax_gdb_event trax_gdb_receive(struct trax_gdb_wire *wire, int milliseconds);

/* A reply is put together and sent. What does not fit is cut: callers see to it that nothing of variable length is
   longer than the packet that asked for it allows. */
void trax_gdb_begin(struct trax_gdb_wire *wire);
__attribute__((format(printf, 2, 3))) void trax_gdb_add(struct trax_gdb_wire *wire, const char *format, ...);
void trax_gdb_add_hex(struct trax_gdb_wire *wire, const void *bytes, size_t size);
void trax_gdb_add_bytes(struct trax_gdb_wire *wire, const void *bytes, size_t size); /* binary: escaped when sent */
void trax_gdb_send(struct trax_gdb_wire *wire);

/* --- reading a packet; each moves *text behind what it has read and returns false if that is not there --- */

bool trax_gdb_read_number(const char **text, uint64_t *value); /* hexadecimal, at most 16 digits */
bool trax_gdb_read_char(const char **text, char expected);
/* An even number of hexadecimal digits up to the text's end, as bytes. */
bool trax_gdb_read_hex(const char *text, void *bytes, size_t capacity, size_t *size);

#endif
