#include "gdb/wire.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum { ESCAPE = '}', ESCAPE_BIT = 0x20, INTERRUPT = 0x03 };

static int digit_value(char c) {
  if (c >= '0' && c <= '9')
    return c - '0';
  if (c >= 'a' && c <= 'f')
    return c - 'a' + 10;
  if (c >= 'A' && c <= 'F')
    return c - 'A' + 10;
  return -1;
}

static void transmit(struct trax_gdb_wire *wire, const void *bytes, size_t size) {
  if (!wire->closed && !wire->link.send(wire->link.context, bytes, size))
    wire->closed = true;
}

/* --- receiving --- */

static void begin_packet(struct trax_gdb_wire *wire) {
  wire->state = WIRE_DATA;
  wire->escaped = wire->too_long = false;
  wire->sum = 0;
  wire->length = 0;
}

static void take_data(struct trax_gdb_wire *wire, uint8_t byte) {
  if (byte == '$') { /* the end of the packet before was lost */
    begin_packet(wire);
    return;
  }
  if (byte == '#') {
    wire->state = WIRE_CHECK_HIGH;
    return;
  }
  wire->sum = (uint8_t)(wire->sum + byte);
  if (byte == ESCAPE && !wire->escaped) {
    wire->escaped = true;
    return;
  }
  if (wire->length < TRAX_GDB_PACKET)
    wire->packet[wire->length++] = (char)(wire->escaped ? byte ^ ESCAPE_BIT : byte);
  else
    wire->too_long = true;
  wire->escaped = false;
}

/* True if a packet is complete. */
static bool take_checksum(struct trax_gdb_wire *wire, uint8_t byte) {
  const int digit = digit_value((char)byte);
  if (wire->state == WIRE_CHECK_HIGH) {
    wire->announced = (uint8_t)(digit < 0 ? 0 : digit * 16);
    wire->state = digit < 0 ? WIRE_IDLE : WIRE_CHECK_LOW;
    return false;
  }
  wire->state = WIRE_IDLE;
  const bool right = digit >= 0 && wire->sum == wire->announced + digit;
  if (!wire->no_acknowledgement)
    transmit(wire, right ? "+" : "-", 1);
  wire->packet[wire->length] = 0;
  if (right && wire->too_long) { /* the debugger would wait for a reply, or send the packet for ever */
    trax_gdb_begin(wire);
    trax_gdb_add(wire, "E%02x", TRAX_GDB_TOO_LONG);
    trax_gdb_send(wire);
  }
  return right && !wire->too_long;
}

static enum trax_gdb_event take(struct trax_gdb_wire *wire, uint8_t byte) {
  switch (wire->state) {
  case WIRE_IDLE:
    if (byte == '$')
      begin_packet(wire);
    else if (byte == INTERRUPT)
      return TRAX_GDB_BREAK;
    else if (byte == '-' && !wire->no_acknowledgement)
      transmit(wire, wire->sent, wire->sent_length);
    return TRAX_GDB_NOTHING;
  case WIRE_DATA:
    take_data(wire, byte);
    return TRAX_GDB_NOTHING;
  case WIRE_CHECK_HIGH:
  case WIRE_CHECK_LOW:
    return take_checksum(wire, byte) ? TRAX_GDB_ARRIVED : TRAX_GDB_NOTHING;
  }
  return TRAX_GDB_NOTHING;
}

enum trax_gdb_event trax_gdb_receive(struct trax_gdb_wire *wire, int milliseconds) {
  while (true) {
    while (wire->begin < wire->end) {
      const enum trax_gdb_event event = take(wire, wire->received[wire->begin++]);
      if (event)
        return event;
    }
    if (wire->closed)
      return TRAX_GDB_CLOSED;
    const int got = wire->link.receive(wire->link.context, wire->received, sizeof wire->received, milliseconds);
    if (got < 0)
      wire->closed = true;
    if (got == 0)
      return TRAX_GDB_NOTHING;
    wire->begin = 0;
    wire->end = got > 0 ? (size_t)got : 0;
  }
}

/* --- sending --- */

void trax_gdb_begin(struct trax_gdb_wire *wire) {
  wire->reply_length = 0;
}

void trax_gdb_add(struct trax_gdb_wire *wire, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  const size_t room = sizeof wire->reply - wire->reply_length;
  const int added = vsnprintf(wire->reply + wire->reply_length, room, format, arguments);
  va_end(arguments);
  if (added > 0)
    wire->reply_length += (size_t)added < room ? (size_t)added : room - 1;
}

void trax_gdb_add_hex(struct trax_gdb_wire *wire, const void *bytes, size_t size) {
  for (size_t i = 0; i < size; i++)
    trax_gdb_add(wire, "%02x", ((const uint8_t *)bytes)[i]);
}

void trax_gdb_add_bytes(struct trax_gdb_wire *wire, const void *bytes, size_t size) {
  const size_t room = TRAX_GDB_PACKET - wire->reply_length;
  const size_t added = size < room ? size : room;
  memcpy(wire->reply + wire->reply_length, bytes, added);
  wire->reply_length += added;
}

void trax_gdb_send(struct trax_gdb_wire *wire) {
  static const char digits[] = "0123456789abcdef";
  uint8_t sum = 0;
  size_t size = 0;
  wire->sent[size++] = '$';
  for (size_t i = 0; i < wire->reply_length; i++) {
    const char c = wire->reply[i];
    if (c == '$' || c == '#' || c == ESCAPE || c == '*') {
      wire->sent[size++] = ESCAPE;
      wire->sent[size++] = (char)(c ^ ESCAPE_BIT);
    } else {
      wire->sent[size++] = c;
    }
  }
  for (size_t i = 1; i < size; i++)
    sum = (uint8_t)(sum + (uint8_t)wire->sent[i]);
  wire->sent[size++] = '#';
  wire->sent[size++] = digits[sum >> 4];
  wire->sent[size++] = digits[sum & 15];
  wire->sent_length = size;
  transmit(wire, wire->sent, size);
}

/* --- reading --- */

bool trax_gdb_read_number(const char **text, uint64_t *value) {
  unsigned digits = 0;
  *value = 0;
  for (; digit_value(**text) >= 0; ++*text) {
    if (++digits > 16)
      return false;
    *value = *value << 4 | (unsigned)digit_value(**text);
  }
  return digits > 0;
}

bool trax_gdb_read_char(const char **text, char expected) {
  if (**text != expected || !expected)
    return false;
  ++*text;
  return true;
}

bool trax_gdb_read_hex(const char *text, void *bytes, size_t capacity, size_t *size) {
  for (*size = 0; text[0]; text += 2) {
    if (*size == capacity || digit_value(text[0]) < 0 || digit_value(text[1]) < 0)
      return false;
    ((uint8_t *)bytes)[(*size)++] = (uint8_t)(digit_value(text[0]) * 16 + digit_value(text[1]));
  }
  return true;
}
