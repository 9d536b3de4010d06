#include "fast/memory/transfers.h"

#include "machine/config.h"
#include "trax/grow.h"

#include <stdlib.h>

_Static_assert((int)TRAX_REQUEST_DATA_LINE == (int)TRAX_TRANSFER_DATA_LINE &&
                   (int)TRAX_REQUEST_ATOMIC == (int)TRAX_TRANSFER_ATOMIC,
               "requests have the numbers of their transfers");

void trax_transfer_log_add(struct trax_transfer_log *log, uint64_t cycle, unsigned channel, uint32_t tm,
                           const struct trax_request *request) {
  const bool is_l2 = tm == TRAX_MAX_TMS;
  const struct trax_transfer transfer = {.cycle = cycle,
                                         .address = request->address,
                                         .bytes = request->bytes,
                                         .tm = is_l2 ? TRAX_TRANSFER_NO_TM : (int16_t)tm,
                                         .kind = is_l2 ? TRAX_TRANSFER_L2_LINE : request->kind,
                                         .channel = (uint8_t)channel};
  if (!log->holds)
    log->to->transfer(log->to->context, &transfer);
  else if (trax_grow((void **)&log->held, log->count, &log->capacity, sizeof *log->held))
    log->held[log->count++] = transfer;
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
