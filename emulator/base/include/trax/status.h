/* The status that functions return, and the message of an error. */
#ifndef TRAX_STATUS_H
#define TRAX_STATUS_H

#ifdef __cplusplus
extern "C" {
#endif

typedef enum trax_status {
  TRAX_OK = 0,
  TRAX_ERROR,       /* bad input: the message names the place */
  TRAX_FAULT,       /* the guest caused a fault, which trax_machine_print_fault reports */
  TRAX_INTERRUPTED, /* options.interrupt became true; statistics are partial */
  TRAX_STUCK        /* max_cycles was reached, or the watchdog ended the run; statistics are partial */
} trax_status;

typedef struct trax_error {
  char message[1024];
} trax_error;

/* Formats the message into *error (which may be NULL) and returns TRAX_ERROR. If a message such as "%s: cannot be read"
   begins with an empty name, the name is written as two quotation marks. */
__attribute__((format(printf, 2, 3))) trax_status trax_fail(trax_error *error, const char *format, ...);

#ifdef __cplusplus
}
#endif
#endif
