#include "fast/memory/transfers.h"

#include "machine/config.h"
#include "trax/grow.h"

#include <stdlib.h>

static const uint8_t kinds[] = {[TRAX_REQUEST_INSTRUCTION_LINE] = TRAX_TRANSFER_INSTRUCTION_LINE,
                                [TRAX_REQUEST_DATA_LINE] = TRAX_TRANSFER_DATA_LINE,
                                [TRAX_REQUEST_LOAD] = TRAX_TRANSFER_LOAD,
                                [TRAX_REQUEST_WRITE] = TRAX_TRANSFER_WRITE,
                                [TRAX_REQUEST_ATOMIC] = TRAX_TRANSFER_ATOMIC};

void trax_transfer_log_add(struct trax_transfer_log *log, uint64_t cycle, unsigned channel, uint32_t tm,
                           const struct trax_request *request) {
  const bool is_l2 = tm == TRAX_MAX_TMS;
  const struct trax_transfer transfer = {.cycle = cycle,
                                         .address = request->address,
                                         .bytes = request->bytes,
                                         .tm = is_l2 ? TRAX_TRANSFER_NO_TM : (int16_t)tm,
                                         .kind = is_l2 ? TRAX_TRANSFER_L2_LINE : kinds[request->kind],
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
