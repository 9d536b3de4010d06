/* isa-weak-model: the model with memory as weak as docs/isa.md, "Order", allows. Loads and increments have their effect
   at any time until their result is needed, stores of each thread wait in a queue for a random time, plain loads come
   from caches of the TMs that nothing keeps coherent, and threads run at changing speeds. The suite must pass on it: it
   asks for nothing that is not promised. With TRAX_BREAK=NAME one of the rules is broken, and the suite must notice.
   TRAX_SEED=N gives another random order.

   The model's memory, its instructions and its run are wrapped (ld --wrap). */
#include "semantics.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { THREADS = 256, QUEUE = 16, PENDING = 8, LINES = 64, LINE = 64, LONGEST_DELAY = 48 };

#define RULES_OF_ORDER(X)                                                                                              \
  X(NONE, "none")                                                                                                      \
  X(STORE_WORD, "store-word")           /* stores of a thread to one word are performed in any order */                \
  X(OWN_STORES, "own-stores")           /* a load does not see the thread's own stores that still wait */              \
  X(LATER_STORE, "later-store")         /* a load may see the thread's own later store */                              \
  X(FINITE_TIME, "finite-time")         /* a store waits until the thread's next one */                                \
  X(LWNT_FRESH, "lwnt-fresh")           /* lwnt comes from the cache */                                                \
  X(LWNT_OWN, "lwnt-own")               /* lwnt goes before the thread's earlier stores to the word */                 \
  X(LWNT_WORD, "lwnt-word")             /* lwnt of one word go in any order */                                         \
  X(OWN_TM, "own-tm")                   /* the TM's cache keeps its copy when a thread of the TM stores */             \
  X(OWN_COPY, "own-copy")               /* the TM's cache keeps its copy when swnt or ainc changes the word */         \
  X(ONE_ORDER, "one-order")             /* a store is seen by threads of its TM before those of others see it */       \
  X(INCREMENT_LAST, "increment-last")   /* an increment goes before the thread's earlier stores to the word */         \
  X(INCREMENT_ONCE, "increment-once")   /* an increment reads now and writes later */                                  \
  X(FENCE, "fence")                     /* fences do nothing */                                                        \
  X(R_WAITS, "fence-r-waits")           /* fence r does not wait for loads and increments */                           \
  X(R_DROPS, "fence-r-drops")           /* fence r keeps the TM's cache */                                             \
  X(R_FILLS, "fence-r-fills")           /* fence r keeps one line */                                                   \
  X(W_LOADS, "fence-w-loads")           /* fence w does not wait for loads */                                          \
  X(W_STORES, "fence-w-stores")         /* fence w does not wait for stores */                                         \
  X(W_INCREMENTS, "fence-w-increments") /* fence w does not wait for increments without a result */                    \
  X(RW_R, "fence-rw-r")                 /* fence rw is fence w */                                                      \
  X(RW_W, "fence-rw-w")                 /* fence rw is fence r */                                                      \
  X(END, "end")                         /* accesses that still wait at the end are lost */

enum rule {
#define RULE(ID, NAME) ID,
  RULES_OF_ORDER(RULE)
#undef RULE
      RULES
};
static const char *const names[RULES] = {
#define RULE(ID, NAME) NAME,
    RULES_OF_ORDER(RULE)
#undef RULE
};

struct waiting {
  uint32_t address, value, bytes;
  bool past_cache;
  uint64_t due; /* turn */
};
/* A load or increment that has been executed and not performed. */
struct pending {
  const struct model_instruction *instruction;
  uint32_t operand[MODEL_FIELDS], base; /* the base register's value then */
  uint32_t word, pc;
  uint64_t due;
};
struct queue {
  struct waiting store[QUEUE];
  unsigned count;
  struct pending load[PENDING];
  unsigned loads;
  unsigned speed; /* of 8: how often the thread has its turn */
};
struct line {
  uint64_t filled; /* 1 + how often the cache had been emptied; 0: never */
  uint32_t address;
  uint8_t bytes[LINE];
};

static struct queue queues[THREADS];
static struct line caches[THREADS][LINES]; /* by TM */
static uint64_t drops[THREADS];            /* how often each was emptied */
static uint64_t random_state;

void __real_model_execute(struct model_execution *, const struct model_node *);
void __wrap_model_execute(struct model_execution *, const struct model_node *);
uint32_t __wrap_model_load(struct model_machine *, struct model_thread *, uint32_t, uint32_t, bool);
uint32_t __real_model_load(struct model_machine *, struct model_thread *, uint32_t, uint32_t, bool);
void __wrap_model_store(struct model_machine *, struct model_thread *, uint32_t, uint32_t, uint32_t, bool);
void __real_model_store(struct model_machine *, struct model_thread *, uint32_t, uint32_t, uint32_t, bool);
uint32_t __wrap_model_increment(struct model_machine *, struct model_thread *, uint32_t);
void __wrap_model_fence(struct model_machine *, struct model_thread *, enum model_fence);
enum model_end __wrap_model_run(struct model_machine *, uint64_t, struct model_error *);

static enum rule broken(void) {
  static int rule = -1;
  if (rule >= 0)
    return (enum rule)rule;
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

/* --- caches and stores --- */

static struct line *line_of(uint32_t tm, uint32_t address) {
  return &caches[tm][address / LINE % LINES];
}

static bool is_present(uint32_t tm, const struct line *line, uint32_t address) {
  return line->filled == drops[tm] + 1 && line->address == address / LINE * LINE;
}

static void update_cache(const struct model_thread *thread, const struct waiting *store) {
  struct line *line = line_of(thread->tm, store->address);
  if (is_present(thread->tm, line, store->address) && broken() != OWN_TM &&
      !(store->past_cache && broken() == OWN_COPY))
    put(line->bytes + store->address % LINE, store->value, store->bytes);
}

/* The word in memory, and in the TM's cache if it is there. */
static void perform(struct model_machine *machine, const struct model_thread *thread, const struct waiting *store) {
  put(machine->memory + store->address, store->value, store->bytes);
  update_cache(thread, store);
}

static void perform_and_remove(struct model_machine *machine, const struct model_thread *thread, unsigned index) {
  struct queue *queue = &queues[thread->number];
  perform(machine, thread, &queue->store[index]);
  queue->count--;
  memmove(&queue->store[index], &queue->store[index + 1], (queue->count - index) * sizeof *queue->store);
}

/* Stores to one word go in their order, others in any. */
static bool may_overtake(const struct queue *queue, unsigned index) {
  for (unsigned i = 0; i < index && broken() != STORE_WORD; i++)
    if (queue->store[i].address / 4 == queue->store[index].address / 4)
      return false;
  return true;
}

/* The thread's stores to a word, the oldest first. */
static void perform_word(struct model_machine *machine, const struct model_thread *thread, uint32_t word) {
  const struct queue *queue = &queues[thread->number];
  for (unsigned i = 0; i < queue->count;)
    if (queue->store[i].address / 4 == word)
      perform_and_remove(machine, thread, i);
    else
      i++;
}

static void perform_stores(struct model_machine *machine, const struct model_thread *thread) {
  while (queues[thread->number].count)
    perform_and_remove(machine, thread, 0);
}

/* The thread's own waiting stores hide the contents of memory or of a cache. */
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
  if (!is_present(thread->tm, line, address) || any(64) == 0) {
    line->filled = drops[thread->tm] + 1;
    line->address = address / LINE * LINE;
    memcpy(line->bytes, machine->memory + line->address, LINE);
  }
  return line->bytes + address % LINE;
}

/* Loads a word past the cache, after the thread's own stores to it were performed. */
static uint32_t load_past(struct model_machine *machine, const struct model_thread *thread, uint32_t address) {
  if (broken() == LWNT_FRESH)
    return with_own(cached(machine, thread, address), &queues[thread->number], address, 4);
  if (broken() == ONE_ORDER)
    for (uint32_t i = 0; i < machine->thread_count; i++)
      for (unsigned s = 0; s < queues[i].count; s++)
        if (i != thread->number && machine->threads[i].tm == thread->tm && queues[i].store[s].address == address)
          return queues[i].store[s].value;
  if (broken() != LWNT_OWN && broken() != OWN_STORES)
    perform_word(machine, thread, address / 4);
  return __real_model_load(machine, NULL, address, 4, true);
}

uint32_t __wrap_model_load(struct model_machine *machine, struct model_thread *thread, uint32_t address, uint32_t bytes,
                           bool past_cache) {
  static const struct queue nothing;
  if (address >= MODEL_LOCAL_BASE)
    return __real_model_load(machine, thread, address, bytes, past_cache);
  if (past_cache)
    return load_past(machine, thread, address);
  return with_own(cached(machine, thread, address), broken() == OWN_STORES ? &nothing : &queues[thread->number],
                  address, bytes);
}

void __wrap_model_store(struct model_machine *machine, struct model_thread *thread, uint32_t address, uint32_t value,
                        uint32_t bytes, bool past_cache) {
  struct queue *queue = &queues[thread->number];
  const struct waiting store = {address, value, bytes, past_cache, machine->turns + any(LONGEST_DELAY)};
  if (address >= MODEL_LOCAL_BASE) {
    __real_model_store(machine, thread, address, value, bytes, past_cache);
    return;
  }
  if (queue->count == QUEUE)
    perform_and_remove(machine, thread, 0);
  queue->store[queue->count++] = store;
  if (!past_cache && any(2))
    update_cache(thread, &store); /* threads of the TM may see it before it is performed */
}

uint32_t __wrap_model_increment(struct model_machine *machine, struct model_thread *thread, uint32_t address) {
  if (broken() != INCREMENT_LAST)
    perform_word(machine, thread, address / 4);
  const uint32_t value = __real_model_load(machine, thread, address, 4, true);
  const struct waiting store = {address, value + 1, 4, true, 0};
  if (broken() == INCREMENT_ONCE)
    __wrap_model_store(machine, thread, address, value + 1, 4, true);
  else
    perform(machine, thread, &store);
  return value;
}

/* --- loads and increments that wait --- */

/* The bytes that a load or increment accesses; 0: it is another instruction. */
static uint32_t loaded_bytes(const struct model_instruction *instruction) {
  static const struct {
    const char *mnemonic;
    uint32_t bytes;
  } loads[] = {{"lw", 4}, {"lwnt", 4}, {"ainc", 4}, {"lb", 1}, {"lbu", 1}, {"lh", 2}, {"lhu", 2}};
  for (size_t i = 0; i < sizeof loads / sizeof *loads; i++)
    if (strcmp(instruction->mnemonic, loads[i].mnemonic) == 0)
      return loads[i].bytes;
  return 0;
}

static bool is_store(const struct model_instruction *instruction) {
  const char *name = instruction->mnemonic;
  return strcmp(name, "sw") == 0 || strcmp(name, "swnt") == 0 || strcmp(name, "sb") == 0 || strcmp(name, "sh") == 0;
}

static bool is_increment(const struct model_instruction *instruction) {
  return instruction->mnemonic[0] == 'a' && strcmp(instruction->mnemonic, "ainc") == 0;
}

/* Executes a waiting access, with its base register as it was. */
static void complete(struct model_machine *machine, struct model_thread *thread, unsigned index) {
  struct queue *queue = &queues[thread->number];
  struct pending load = queue->load[index];
  queue->loads--;
  memmove(&queue->load[index], &queue->load[index + 1], (queue->loads - index) * sizeof *queue->load);
  const uint32_t base = load.operand[MODEL_FIELD_RA], before = thread->registers[base], pc = thread->pc;
  struct model_execution execution = {.machine = machine, .thread = thread, .instruction = load.instruction};
  memcpy(execution.operand, load.operand, sizeof execution.operand);
  thread->registers[base] = load.base;
  thread->pc = load.pc;
  __real_model_execute(&execution, load.instruction->semantics);
  thread->pc = pc;
  if (base != load.operand[MODEL_FIELD_RD])
    thread->registers[base] = before;
  thread->registers[0] = 0;
}

enum { ANY_WORD = 1 }; /* no address of a word */

/* Those of one word, or all; increments and loads that have a result, or not. */
static void complete_some(struct model_machine *machine, struct model_thread *thread, uint32_t word, bool loads,
                          bool increments) {
  const struct queue *queue = &queues[thread->number];
  for (unsigned i = 0; i < queue->loads;) {
    const struct pending *load = &queue->load[i];
    if ((word == ANY_WORD || load->word == word) && (is_increment(load->instruction) ? increments : loads))
      complete(machine, thread, i);
    else
      i++;
  }
}

static void complete_registers(struct model_machine *machine, struct model_thread *thread,
                               const struct model_execution *execution) {
  const struct queue *queue = &queues[thread->number];
  for (unsigned i = 0; i < queue->loads;) {
    const uint32_t rd = queue->load[i].operand[MODEL_FIELD_RD];
    bool needed = false;
    for (unsigned field = MODEL_FIELD_RD; field <= MODEL_FIELD_RB; field++)
      needed |= rd && execution->instruction->field[field].width && execution->operand[field] == rd;
    if (needed)
      complete(machine, thread, i);
    else
      i++;
  }
}

/* Puts a load of global memory that cannot fault aside, sometimes. */
static bool put_aside(struct model_execution *execution, uint32_t address, uint32_t bytes) {
  struct model_thread *thread = execution->thread;
  struct queue *queue = &queues[thread->number];
  const bool increments = is_increment(execution->instruction);
  if (queue->loads == PENDING || (!execution->operand[MODEL_FIELD_RD] && !increments) || any(3) == 0 ||
      model_check(execution->machine, address, bytes, increments ? MODEL_INCREMENT : MODEL_LOAD))
    return false;
  struct pending load = {.instruction = execution->instruction,
                         .base = thread->registers[execution->operand[MODEL_FIELD_RA]],
                         .word = address / 4 * 4,
                         .pc = thread->pc,
                         .due = execution->machine->turns + any(LONGEST_DELAY)};
  memcpy(load.operand, execution->operand, sizeof load.operand);
  queue->load[queue->loads++] = load;
  return true;
}

void __wrap_model_execute(struct model_execution *execution, const struct model_node *statement) {
  struct model_machine *machine = execution->machine;
  struct model_thread *thread = execution->thread;
  if (queues[thread->number].loads)
    complete_registers(machine, thread, execution);
  const uint32_t bytes = loaded_bytes(execution->instruction);
  const uint32_t address = thread->registers[execution->operand[MODEL_FIELD_RA]] + execution->operand[MODEL_FIELD_IMM];
  if (address < MODEL_LOCAL_BASE && (bytes || is_store(execution->instruction))) {
    if (broken() != (bytes ? LWNT_WORD : LATER_STORE))
      complete_some(machine, thread, address / 4 * 4, true, false);
    if (bytes && put_aside(execution, address, bytes))
      return;
  }
  __real_model_execute(execution, statement);
  if (thread->ended)
    complete_some(machine, thread, ANY_WORD, true, true);
}

/* --- fences --- */

static void acquire(struct model_machine *machine, struct model_thread *thread) {
  if (broken() != R_WAITS)
    complete_some(machine, thread, ANY_WORD, true, true);
  if (broken() == R_DROPS)
    return;
  drops[thread->tm]++;
  if (broken() == R_FILLS)
    caches[thread->tm][0].filled++;
}

static void release(struct model_machine *machine, struct model_thread *thread) {
  complete_some(machine, thread, ANY_WORD, broken() != W_LOADS, broken() != W_INCREMENTS);
  if (broken() != W_STORES)
    perform_stores(machine, thread);
}

void __wrap_model_fence(struct model_machine *machine, struct model_thread *thread, enum model_fence kind) {
  if (broken() == FENCE)
    return;
  if (kind == MODEL_FENCE_W || (kind == MODEL_FENCE_RW && broken() != RW_W))
    release(machine, thread);
  if (kind == MODEL_FENCE_R || (kind == MODEL_FENCE_RW && broken() != RW_R))
    acquire(machine, thread);
}

/* --- the run --- */

/* Performs a thread's loads and stores that are due. */
static void pass_time(struct model_machine *machine, struct model_thread *thread) {
  const struct queue *queue = &queues[thread->number];
  const unsigned kept = broken() == FINITE_TIME;
  for (unsigned i = 0; i < queue->loads;)
    if (queue->load[i].due <= machine->turns)
      complete(machine, thread, i);
    else
      i++;
  for (unsigned s = 0; s + kept < queue->count;)
    if (queue->store[s].due <= machine->turns && may_overtake(queue, s))
      perform_and_remove(machine, thread, s);
    else
      s++;
}

/* A turn of all threads; each has its speed for a while. */
static enum model_end take_turn(struct model_machine *machine, uint64_t limit, bool *running,
                                struct model_error *error) {
  *running = false;
  for (uint32_t i = 0; i < machine->thread_count; i++) {
    struct model_thread *thread = &machine->threads[i];
    struct queue *queue = &queues[i];
    if (queue->loads || queue->count)
      pass_time(machine, thread);
    if (thread->ended)
      continue;
    *running = true;
    if (machine->turns % 64 == 0)
      queue->speed = 1 + any(8);
    if (any(8) >= queue->speed)
      continue;
    if (limit && machine->instructions == limit)
      return MODEL_LIMIT;
    if (!model_step(machine, thread, error))
      return MODEL_ERROR;
  }
  return machine->fault.kind ? MODEL_FAULTED : MODEL_ENDED;
}

enum model_end __wrap_model_run(struct model_machine *machine, uint64_t limit, struct model_error *error) {
  const char *seed = getenv("TRAX_SEED");
  random_state = 0x9E3779B97F4A7C15u * (seed ? strtoull(seed, NULL, 10) + 1 : 1);
  if (machine->thread_count > THREADS) {
    model_fail(error, "more than %d threads", THREADS);
    return MODEL_ERROR;
  }
  enum model_end end = MODEL_ENDED;
  for (bool running = true; running && end == MODEL_ENDED; machine->turns++)
    end = take_turn(machine, limit, &running, error);
  for (uint32_t i = 0; i < machine->thread_count && broken() != END; i++)
    perform_stores(machine, &machine->threads[i]);
  return end;
}
