/* isa-weak-model: the model with memory as weak as docs/isa.md, "Order", allows, but for increments, which do not wait.
   Stores wait in a queue of each thread for a random time, plain loads come from caches of the TMs that nothing keeps
   coherent. The suite must pass on it: it asks for nothing that is not promised. With TRAX_BREAK=NAME one of the rules
   is broken, and the suite must notice.

   The model's memory is wrapped (ld --wrap); functions.c checks every access before it is made. */
#include "model.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { THREADS = 64, QUEUE = 16, LINES = 32, LINE = 64, LONGEST_DELAY = 48 };

enum rule {
  NONE,
  STORE_ORDER,    /* stores of a thread are performed in any order */
  OWN_STORES,     /* a load does not see the thread's own stores that still wait */
  FINITE_TIME,    /* a store waits until the thread's next one */
  LWNT_FRESH,     /* lwnt comes from the cache */
  LWNT_OWN,       /* lwnt goes before the thread's earlier stores to the word */
  OWN_TM,         /* the TM's cache keeps its copy when a thread of the TM stores */
  OWN_COPY,       /* the TM's cache keeps its copy when swnt or ainc changes the word */
  ONE_ORDER,      /* a store is seen by threads of its TM before those of others see it */
  INCREMENT_LAST, /* an increment goes before the thread's earlier stores */
  INCREMENT_ONCE, /* an increment reads now and writes later */
  END,            /* what still waits at the end is lost */
  RULES
};
static const char *const names[RULES] = {"none",       "store-order",    "own-stores",     "finite-time",
                                         "lwnt-fresh", "lwnt-own",       "own-tm",         "own-copy",
                                         "one-order",  "increment-last", "increment-once", "end"};

struct waiting {
  uint32_t address, value, bytes;
  bool past_cache;
  uint64_t due; /* turn */
};
struct queue {
  struct waiting store[QUEUE];
  unsigned count;
};
struct line {
  bool present;
  uint32_t address;
  uint8_t bytes[LINE];
};

static struct queue queues[THREADS];
static struct line caches[THREADS][LINES]; /* by TM */
static struct {
  bool write, global_only;
} checked;                /* the access that is going to be made */
static bool incrementing; /* ainc has loaded, and is going to store */
static uint64_t random_state = 0x9E3779B97F4A7C15u;

enum model_fault_kind __real_model_check(const struct model_machine *, uint32_t, uint32_t, bool, bool);
enum model_fault_kind __wrap_model_check(const struct model_machine *, uint32_t, uint32_t, bool, bool);
uint32_t __wrap_model_load(struct model_machine *, struct model_thread *, uint32_t, uint32_t);
uint32_t __real_model_load(struct model_machine *, struct model_thread *, uint32_t, uint32_t);
void __wrap_model_store(struct model_machine *, struct model_thread *, uint32_t, uint32_t, uint32_t);
void __real_model_store(struct model_machine *, struct model_thread *, uint32_t, uint32_t, uint32_t);
enum model_end __wrap_model_run(struct model_machine *, uint64_t, struct model_error *);
enum model_end __real_model_run(struct model_machine *, uint64_t, struct model_error *);

static enum rule broken(void) {
  static int rule = -1;
  const char *name = getenv("TRAX_BREAK");
  for (int i = 0; rule < 0 && i < RULES; i++)
    if (!name || strcmp(name, names[i]) == 0)
      rule = name ? i : NONE;
  if (rule < 0) {
    fprintf(stderr, "isa-weak-model: TRAX_BREAK: no rule %s\n", name);
    exit(1);
  }
  return (enum rule)rule;
}

static uint32_t any(uint32_t below) { /* xorshift64* */
  random_state ^= random_state >> 12;
  random_state ^= random_state << 25;
  random_state ^= random_state >> 27;
  return (uint32_t)((random_state * 0x2545F4914F6CDD1Du) >> 33) % below;
}

static bool overlap(const struct waiting *store, uint32_t address, uint32_t bytes) {
  return store->address < address + bytes && address < store->address + store->bytes;
}

static void put(uint8_t *bytes, uint32_t value, uint32_t count) {
  for (uint32_t i = 0; i < count; i++)
    bytes[i] = (uint8_t)(value >> 8 * i);
}

static struct line *line_of(uint32_t tm, uint32_t address) {
  return &caches[tm][address / LINE % LINES];
}

/* The word in memory, and in the TM's cache if it is there. */
static void perform(struct model_machine *machine, const struct model_thread *thread, const struct waiting *store) {
  struct line *line = line_of(thread->tm, store->address);
  put(machine->memory + store->address, store->value, store->bytes);
  if (line->present && line->address == store->address / LINE * LINE && broken() != OWN_TM &&
      !(store->past_cache && broken() == OWN_COPY))
    put(line->bytes + store->address % LINE, store->value, store->bytes);
}

static void perform_and_remove(struct model_machine *machine, const struct model_thread *thread, unsigned index) {
  struct queue *queue = &queues[thread->number];
  perform(machine, thread, &queue->store[index]);
  queue->count--;
  memmove(&queue->store[index], &queue->store[index + 1], (queue->count - index) * sizeof *queue->store);
}

/* The thread's oldest stores until none is left that overlaps. */
static void perform_to(struct model_machine *machine, const struct model_thread *thread, uint32_t address,
                       uint32_t bytes) {
  const struct queue *queue = &queues[thread->number];
  for (unsigned left = queue->count; left-- > 0;)
    if (overlap(&queue->store[left], address, bytes)) {
      for (unsigned i = 0; i <= left; i++)
        perform_and_remove(machine, thread, 0);
      return;
    }
}

static void perform_all(struct model_machine *machine, const struct model_thread *thread) {
  while (queues[thread->number].count)
    perform_and_remove(machine, thread, 0);
}

static bool may_overtake(const struct queue *queue, unsigned index) {
  for (unsigned i = 0; i < index; i++)
    if (broken() != STORE_ORDER || overlap(&queue->store[i], queue->store[index].address, queue->store[index].bytes))
      return false;
  return true;
}

/* Of every thread, the stores whose time has come. */
static void pass_time(struct model_machine *machine) {
  for (uint32_t i = 0; i < machine->thread_count; i++) {
    struct queue *queue = &queues[i];
    const unsigned kept = broken() == FINITE_TIME;
    for (unsigned s = 0; s + kept < queue->count;)
      if (queue->store[s].due <= machine->turns && may_overtake(queue, s))
        perform_and_remove(machine, &machine->threads[i], s);
      else
        s++;
  }
}

enum model_fault_kind __wrap_model_check(const struct model_machine *machine, uint32_t address, uint32_t bytes,
                                         bool write, bool global_only) {
  checked.write = write;
  checked.global_only = global_only;
  return __real_model_check(machine, address, bytes, write, global_only);
}

/* Over what memory or a cache has lie the thread's own stores that wait. */
static uint32_t with_own(const uint8_t *bytes, const struct queue *queue, uint32_t address, uint32_t count) {
  uint32_t result = 0;
  for (uint32_t b = 0; b < count; b++) {
    uint32_t byte = bytes[b];
    for (unsigned i = 0; i < queue->count; i++)
      if (overlap(&queue->store[i], address + b, 1))
        byte = queue->store[i].value >> 8 * (address + b - queue->store[i].address) & 0xFF;
    result |= byte << 8 * b;
  }
  return result;
}

static const uint8_t *cached(struct model_machine *machine, const struct model_thread *thread, uint32_t address) {
  struct line *line = line_of(thread->tm, address);
  if (!line->present || line->address != address / LINE * LINE || any(64) == 0) {
    line->present = true;
    line->address = address / LINE * LINE;
    memcpy(line->bytes, machine->memory + line->address, LINE);
  }
  return line->bytes + address % LINE;
}

uint32_t __wrap_model_load(struct model_machine *machine, struct model_thread *thread, uint32_t address,
                           uint32_t bytes) {
  static const struct queue nothing;
  const struct queue *own = broken() == OWN_STORES ? &nothing : &queues[thread->number];
  if (address >= MODEL_LOCAL_BASE)
    return __real_model_load(machine, thread, address, bytes);
  pass_time(machine);
  if (checked.write) {
    incrementing = true;
    if (broken() != INCREMENT_LAST)
      perform_all(machine, thread);
    return with_own(machine->memory + address, own, address, bytes);
  }
  if (checked.global_only && broken() != LWNT_FRESH) {
    if (broken() == ONE_ORDER)
      for (uint32_t i = 0; i < machine->thread_count; i++)
        for (unsigned s = 0; s < queues[i].count; s++)
          if (i != thread->number && machine->threads[i].tm == thread->tm && queues[i].store[s].address == address)
            return queues[i].store[s].value;
    if (broken() != LWNT_OWN)
      perform_to(machine, thread, address, bytes);
    return with_own(machine->memory + address, broken() == LWNT_OWN ? &nothing : own, address, bytes);
  }
  return with_own(cached(machine, thread, address), own, address, bytes);
}

void __wrap_model_store(struct model_machine *machine, struct model_thread *thread, uint32_t address, uint32_t value,
                        uint32_t bytes) {
  struct queue *queue = &queues[thread->number];
  struct waiting store = {address, value, bytes, checked.global_only, machine->turns + any(LONGEST_DELAY)};
  if (address >= MODEL_LOCAL_BASE) {
    __real_model_store(machine, thread, address, value, bytes);
    return;
  }
  pass_time(machine);
  if (incrementing && broken() != INCREMENT_ONCE) {
    incrementing = false;
    perform(machine, thread, &store);
    return;
  }
  if (queue->count == QUEUE)
    perform_and_remove(machine, thread, 0);
  queue->store[queue->count++] = store;
}

enum model_end __wrap_model_run(struct model_machine *machine, uint64_t limit, struct model_error *error) {
  if (machine->thread_count > THREADS) {
    model_fail(error, "more than %d threads", THREADS);
    return MODEL_ERROR;
  }
  const enum model_end end = __real_model_run(machine, limit, error);
  for (uint32_t i = 0; i < machine->thread_count && broken() != END; i++)
    perform_all(machine, &machine->threads[i]);
  return end;
}
