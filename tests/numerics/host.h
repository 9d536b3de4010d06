/* The machine of a runtime that is compiled for the host (runtime/internal/machine.h). */
#ifndef TRAX_TEST_HOST_H
#define TRAX_TEST_HOST_H

#include <setjmp.h>
#include <stddef.h>

extern char host_output[4096]; /* what the runtime printed, as a string */
extern size_t host_output_size;
extern jmp_buf host_abort_target; /* where an abort or an exit goes */
extern const char *host_abort_message;

/* Declares the runtime's function with the type of the host's. */
#define RUNTIME_FUNCTION(name) __typeof__(name) rt_##name;

void rt_host_put_char(int c);
extern unsigned long long host_cycles; /* what the cycle counter shows */
unsigned long long rt_host_cycles(void);
void rt_host_put_string(const char *s);
__attribute__((noreturn)) void rt_host_abort(const char *message);
__attribute__((noreturn)) void rt_host_exit(int status);

#endif
