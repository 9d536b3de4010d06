/* A machine for the runtime: output to memory, ends of the program to a jump. */
#include "host.h"

char host_output[4096];
size_t host_output_size;
jmp_buf host_abort_target;
const char *host_abort_message;

void rt_host_put_char(int c) {
  if (host_output_size < sizeof host_output - 1)
    host_output[host_output_size++] = (char)c;
  host_output[host_output_size] = 0;
}

unsigned long long host_cycles;
unsigned long long rt_host_cycles(void) {
  return host_cycles;
}

void rt_host_put_string(const char *s) {
  while (*s)
    rt_host_put_char(*s++);
}

void rt_host_abort(const char *message) {
  host_abort_message = message;
  longjmp(host_abort_target, 1);
}

void rt_host_exit(int status) {
  longjmp(host_abort_target, status + 2);
}
