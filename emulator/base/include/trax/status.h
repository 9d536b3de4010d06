/* What functions return, and why they failed. */
#ifndef TRAX_STATUS_H
#define TRAX_STATUS_H

#ifdef __cplusplus
extern "C" {
#endif

typedef enum trax_status {
  TRAX_OK = 0,
  TRAX_ERROR,       /* bad input: the message names the place */
  TRAX_FAULT,       /* the guest did what it must not; trax_machine_print_fault tells */
  TRAX_INTERRUPTED, /* options.interrupt became true; statistics are partial */
  TRAX_STUCK        /* the watchdog: max_cycles passed; statistics are partial */
} trax_status;

typedef struct trax_error {
  char message[1024];
} trax_error;

/* Puts the message into *error (which may be NULL) and returns TRAX_ERROR. A message that begins with an empty name, as
   in "%s: cannot be read", begins with "" instead. */
__attribute__((format(printf, 2, 3))) trax_status trax_fail(trax_error *error, const char *format, ...);

#ifdef __cplusplus
}
#endif
#endif
