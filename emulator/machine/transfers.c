#include "machine/transfers.h"

#include "trax/grow.h"

void trax_transfer_log_add(struct trax_transfer_log *log, const struct trax_transfer *transfer) {
  if (!log->holds)
    log->to->transfer(log->to->context, transfer);
  else if (trax_grow((void **)&log->held, log->count, &log->capacity, sizeof *log->held))
    log->held[log->count++] = *transfer;
  else
    log->to->lost = true;
}

void trax_transfer_log_release(struct trax_transfer_log *log) {
  for (size_t i = 0; i < log->count; i++)
    log->to->transfer(log->to->context, &log->held[i]);
  log->count = 0;
}

void trax_transfer_log_discard(struct trax_transfer_log *log) {
  log->count = 0;
}

void trax_transfer_log_destroy(struct trax_transfer_log *log) {
  free(log->held);
}
