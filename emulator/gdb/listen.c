#define _POSIX_C_SOURCE 200809L
#include "gdb/gdb.h"

#include "machine/machine.h"

#include <arpa/inet.h>
#include <errno.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

enum { POLL_MS = 100 }; /* interval of polling for an interrupt */

static trax_status fail(struct trax_gdb_port *port, unsigned number, const char *what, trax_error *error) {
  const int code = errno;
  trax_gdb_port_close(port);
  return trax_fail(error, "port %u of the loopback interface: %s: %s", number, what, strerror(code));
}

trax_status trax_gdb_listen(struct trax_gdb_port *port, unsigned number, trax_error *error) {
  struct sockaddr_in address = {
      .sin_family = AF_INET, .sin_port = htons((uint16_t)number), .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
  socklen_t size = sizeof address;
  const int yes = 1;
  *port = (struct trax_gdb_port){.connection = -1};
  port->listener = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (port->listener < 0)
    return fail(port, number, "no socket", error);
  setsockopt(port->listener, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  if (bind(port->listener, (struct sockaddr *)&address, sizeof address) != 0 || listen(port->listener, 1) != 0 ||
      getsockname(port->listener, (struct sockaddr *)&address, &size) != 0)
    return fail(port, number, "cannot be listened at", error);
  port->number = ntohs(address.sin_port);
  return TRAX_OK;
}

trax_status trax_gdb_accept(struct trax_gdb_port *port, const volatile int *interrupt, trax_error *error) {
  const int yes = 1;
  port->interrupt = interrupt;
  while (port->connection < 0) {
    struct pollfd wait = {.fd = port->listener, .events = POLLIN};
    if (interrupt && *interrupt) {
      trax_fail(error, "interrupted before a debugger came");
      return TRAX_INTERRUPTED;
    }
    if (poll(&wait, 1, POLL_MS) <= 0)
      continue;
    port->connection = accept(port->listener, NULL, NULL);
    if (port->connection < 0 && errno != EINTR && errno != ECONNABORTED)
      return fail(port, port->number, "no connection", error);
  }
  setsockopt(port->connection, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  close(port->listener);
  port->listener = -1;
  return TRAX_OK;
}

static int receive(void *context, uint8_t *bytes, size_t capacity, int milliseconds) {
  const struct trax_gdb_port *port = context;
  struct pollfd wait = {.fd = port->connection, .events = POLLIN};
  const int ready = poll(&wait, 1, milliseconds);
  if (ready <= 0)
    return ready < 0 && errno != EINTR ? -1 : 0;
  const ssize_t got = recv(port->connection, bytes, capacity, 0);
  return got > 0 ? (int)got : got < 0 && errno == EINTR ? 0 : -1;
}

static bool transmit(void *context, const void *bytes, size_t size) {
  const struct trax_gdb_port *port = context;
  const char *next = bytes;
  while (size) {
    const ssize_t sent = send(port->connection, next, size, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent < 0 && (errno == EINTR || errno == EAGAIN)) { /* the debugger does not read */
      struct pollfd wait = {.fd = port->connection, .events = POLLOUT};
      if (port->interrupt && *port->interrupt)
        return false;
      poll(&wait, 1, POLL_MS);
      continue;
    }
    if (sent <= 0)
      return false;
    next += sent;
    size -= (size_t)sent;
  }
  return true;
}

struct trax_gdb_link trax_gdb_port_link(struct trax_gdb_port *port) {
  return (struct trax_gdb_link){port, receive, transmit};
}

void trax_gdb_port_close(struct trax_gdb_port *port) {
  if (port->listener >= 0)
    close(port->listener);
  if (port->connection >= 0)
    close(port->connection);
  port->listener = port->connection = -1;
}
