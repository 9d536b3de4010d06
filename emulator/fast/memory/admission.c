/* The requests that a channel of DRAM takes, and what follows when it has served one (docs/timing-memory.md, "DRAM").
   dram/dram.h chooses which one it serves. */
#include "fast/memory/memory.h"
#include "fast/tm/tm.h"

static enum trax_dram_queue queue_of(const struct trax_request *request) {
  return request->kind == TRAX_REQUEST_WRITE ? TRAX_DRAM_WRITE : TRAX_DRAM_READ;
}

/* Whether the channel can take the request from those that wait for it. */
static bool is_admitted(const struct trax_memory *memory, unsigned number, const struct trax_request *request) {
  return request->kind == TRAX_REQUEST_ATOMIC || trax_dram_has_place(memory->dram, number, queue_of(request));
}

/* Takes the next request that the channel can take. TRAX_NO_REQUEST: there is none. */
static trax_request_id take_admitted(struct trax_memory *memory, struct trax_tm *tms, unsigned number) {
  struct trax_waiting *waiting = &memory->channel[number].waiting;
  uint64_t admitted = waiting->tms;
  if (!trax_dram_has_place(memory->dram, number, TRAX_DRAM_READ) ||
      !trax_dram_has_place(memory->dram, number, TRAX_DRAM_WRITE))
    for (uint64_t rest = waiting->tms; rest; rest &= rest - 1) {
      const unsigned tm = (unsigned)__builtin_ctzll(rest);
      if (!is_admitted(memory, number, trax_memory_request(memory, tms, waiting->list[tm].first)))
        admitted &= ~((uint64_t)1 << tm);
    }
  if (!admitted)
    return TRAX_NO_REQUEST;
  const unsigned tm = trax_arbiter_peek(waiting->arbiter, admitted);
  trax_arbiter_to_back(&waiting->arbiter, tm);
  return trax_waiting_take(memory, tms, waiting, tm);
}

/* Brings requests to the DRAM as long as it has places, and performs atomic increments. */
static void admit(struct trax_memory *memory, struct trax_tm *tms, unsigned number, uint64_t t) {
  trax_request_id id;
  while ((id = take_admitted(memory, tms, number)) != TRAX_NO_REQUEST) {
    struct trax_request *request = trax_memory_request(memory, tms, id);
    if (request->kind == TRAX_REQUEST_ATOMIC) {
      trax_memory_finish(memory, tms, number, id,
                         trax_memory_increment(memory, number, request, t + 1) + memory->latency);
      continue;
    }
    trax_memory_notify(memory, number, id, request, t);
    trax_dram_bring(memory->dram, queue_of(request), id, request->address, request->bytes, t);
  }
}

void trax_memory_serve_dram(struct trax_memory *memory, struct trax_tm *tms, unsigned number, uint64_t t) {
  struct trax_dram_served served;
  admit(memory, tms, number, t);
  while (trax_dram_serve(memory->dram, number, t, &served)) {
    trax_memory_count(memory, number, trax_memory_request(memory, tms, served.id)->bytes);
    trax_memory_finish(memory, tms, number, served.id, served.over + memory->latency);
    admit(memory, tms, number, t);
  }
}
