/* Races (docs/checking.md, "Races"): accesses of two threads to the same bytes, at least one a store, of which neither
   happens before the other.

   The order is that of clocks.h. The compiler makes the same stores of atomic and of other ones, so two stores to a
   word that some thread has accessed past the cache or incremented are no race. A plain load after a store is, since it
   may return an old value, unless the word was accessed in a function of libatomic: before such a call the compiler may
   load the object plainly, as a guess. */
#include "explain/clocks.h"
#include "explain/places.h"
#include "explain/span.h"
#include "report/place.h"
#include "trax/grow.h"
#include "trax/map.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

enum { PAGE_SHIFT = 12, WORDS = 1 << (PAGE_SHIFT - 2), CELLS = 4, MOST_SITES = 1000 };

/* An access to a word; the latest ones of different threads or kinds are kept. clock 0: none. */
struct cell {
  uint32_t clock, pc;
  uint16_t thread;
  uint8_t mask; /* of its bytes */
  bool write;
};

struct word {
  struct cell cells[CELLS];
  struct trax_release *release;
  uint8_t next; /* the cell that is replaced next */
  enum { PLAIN, ATOMIC, IN_LIBATOMIC } atomic : 8;
};

struct thread {
  uint32_t increments[TRAX_NUM_REGISTERS]; /* addresses, by the register that gets the old value; 0: none */
  uint32_t return_pc;                      /* of the call of an atomic operation; 0: none */
};

struct site {
  struct cell first, second;
  uint32_t address;
  uint64_t cycle, count;
};

struct races {
  struct trax_reader reader;
  const trax_machine *machine;
  uint32_t tps;
  struct trax_clocks clocks;
  struct thread *thread; /* [thread] */
  struct word **pages;
  size_t page_count;
  struct site *sites;
  size_t site_count, site_capacity;
  struct trax_map site_of; /* by the two instructions */
};

static struct word *word_at(struct races *races, uint32_t address) {
  struct word **page = &races->pages[address >> PAGE_SHIFT];
  if (!*page && !(*page = calloc(WORDS, sizeof **page)))
    races->reader.explain->out_of_memory = true;
  return *page ? &(*page)[address / 4 % WORDS] : NULL;
}

/* Whether two accesses to the word, to the same bytes and not ordered, are a race. */
static bool is_race(const struct word *word, const struct cell *first, const struct cell *second) {
  if (word->atomic == PLAIN)
    return first->write || second->write;
  return word->atomic == ATOMIC && first->write && !second->write;
}

static void note(struct races *races, const struct cell *first, const struct cell *second,
                 const struct trax_issue *issue) {
  const uint64_t key = (uint64_t)first->pc << 32 | second->pc;
  const struct trax_map_entry *entry = trax_map_put(&races->site_of, sizeof *entry, key, (uint32_t)races->site_count);
  if (!entry || !trax_grow((void **)&races->sites, races->site_count, &races->site_capacity, sizeof *races->sites)) {
    races->reader.explain->out_of_memory = true;
    return;
  }
  struct site *site = &races->sites[entry->value];
  const bool is_new = entry->value == races->site_count;
  races->site_count += is_new;
  if (is_new || !is_race(word_at(races, site->address), &site->first, &site->second))
    *site = (struct site){*first, *second, issue->address, issue->cycle, is_new ? 0 : site->count};
  site->count++;
}

static void check(struct races *races, const struct trax_span *span, struct word *word, uint32_t bytes, bool write) {
  const struct cell own = {.clock = trax_clock_of(&races->clocks, span->thread),
                           .pc = span->pc,
                           .thread = (uint16_t)span->thread,
                           .mask = (uint8_t)(((1 << bytes) - 1) << span->issue->address % 4),
                           .write = write};
  struct cell *place = NULL; /* an empty one, or one whose races with later accesses are this access's, too */
  for (unsigned i = 0; i < CELLS; i++) {
    struct cell *it = &word->cells[i];
    const bool is_ordered = trax_clocks_know(&races->clocks, span->thread, it->thread, it->clock);
    if (!is_ordered && it->mask & own.mask && is_race(word, it, &own))
      note(races, it, &own, span->issue);
    if (!place && is_ordered && (write || !it->write) && !(it->mask & ~own.mask))
      place = it;
  }
  *(place ? place : &word->cells[word->next++ % CELLS]) = own;
}

/* Follows calls of the library's atomic operations, which copy wide objects under a lock. */
static void follow(struct races *races, const struct trax_span *span) {
  struct thread *thread = &races->thread[span->thread];
  struct trax_places *places = races->reader.explain->places;
  const uint32_t next = span->issue->next_pc;
  if (thread->return_pc == next)
    thread->return_pc = 0;
  if (thread->return_pc || !span->inst.rd)
    return;
  const struct trax_place *place = trax_places_at(places, trax_places_index(places, next));
  if (place->symbol && !place->offset && strncmp(place->symbol, "__atomic_", 9) == 0)
    thread->return_pc = span->pc + 4;
}

static void add_span(void *self, const struct trax_span *span) {
  struct races *races = self;
  const trax_op_info *op = &trax_op_table[span->inst.op];
  races->reader.explain->out_of_memory |= races->clocks.out_of_memory;
  if (!span->issue || races->reader.explain->out_of_memory)
    return;
  if (span->inst.op == TRAX_OP_FENCE) {
    trax_clocks_fence(&races->clocks, span->thread, span->inst.imm);
    return;
  }
  if (span->inst.op == TRAX_OP_JAL || span->inst.op == TRAX_OP_JALR)
    follow(races, span);
  struct word *word =
      op->access_bytes && span->issue->address < TRAX_LOCAL_BASE ? word_at(races, span->issue->address) : NULL;
  if (!word)
    return;
  const bool write = op->flags & (TRAX_IS_STORE | TRAX_IS_ATOMIC), past_cache = op->flags & TRAX_IS_NONTEMPORAL;
  if (races->thread[span->thread].return_pc)
    word->atomic = IN_LIBATOMIC;
  else if (!word->atomic && (past_cache || op->flags & TRAX_IS_ATOMIC))
    word->atomic = ATOMIC;
  if (word->atomic != IN_LIBATOMIC && (write || !past_cache))
    check(races, span, word, op->access_bytes, write);
  if (op->flags & TRAX_IS_ATOMIC)
    races->thread[span->thread].increments[span->inst.rd] = span->issue->address;
  if (op->flags & TRAX_IS_ATOMIC || (write && op->access_bytes < 4))
    trax_clocks_add(&races->clocks, span->thread, &word->release);
  else if (write)
    trax_clocks_store(&races->clocks, span->thread, &word->release);
  else if (past_cache)
    trax_clocks_load(&races->clocks, span->thread, word->release);
}

static void add_arrival(void *self, const struct trax_arrival *arrival) {
  struct races *races = self;
  const uint32_t thread = arrival->tm * races->tps + arrival->tp;
  const uint32_t address = races->thread[thread].increments[arrival->rd];
  const struct word *word = address ? word_at(races, address) : NULL;
  if (word)
    trax_clocks_load(&races->clocks, thread, word->release);
}

/* --- the report --- */

static void print_access(const struct races *races, const char *label, const struct cell *cell, FILE *out) {
  fprintf(out, "  %-*s%s by thread %u (TM %u, TP %u)\n", TRAX_LABEL, label, cell->write ? "store" : "load",
          cell->thread, cell->thread / races->tps, cell->thread % races->tps);
  trax_print_place(trax_loaded_of(races->machine), "in", cell->pc, out);
}

static void print(const struct races *races, const struct site *site, FILE *out) {
  const struct trax_loaded *loaded = trax_loaded_of(races->machine);
  const struct trax_symbol *symbol = loaded ? trax_image_symbol_at(loaded->image, site->address) : NULL;
  fprintf(out, "trax-sim: race: nothing orders two accesses to the same word\n");
  fprintf(out, "  %-*s0x%08x", TRAX_LABEL, "word", site->address & ~3u);
  if (symbol) {
    fputs(" (", out);
    trax_print_symbol(symbol, site->address & ~3u, out);
    fputc(')', out);
  }
  fprintf(out, ", cycle %" PRIu64, site->cycle);
  if (site->count > 1)
    fprintf(out, "; %" PRIu64 " times", site->count);
  fputc('\n', out);
  print_access(races, "first", &site->first, out);
  print_access(races, "second", &site->second, out);
}

static trax_status end_races(void *self, trax_error *error) {
  struct races *races = self;
  size_t found = 0;
  fflush(stdout);
  for (size_t i = 0; i < races->site_count; i++)
    if (is_race(word_at(races, races->sites[i].address), &races->sites[i].first, &races->sites[i].second) &&
        ++found <= MOST_SITES)
      print(races, &races->sites[i], stderr);
  if (found > MOST_SITES)
    fprintf(stderr, "trax-sim: race: %zu further sites\n", found - MOST_SITES);
  return found ? trax_fail(error, "the program has %zu race%s (--check-races)", found, found == 1 ? "" : "s") : TRAX_OK;
}

static trax_status open_races(void *self, trax_error *error) {
  struct races *races = self;
  races->machine = races->reader.explain->machine;
  races->tps = races->machine->config.chip.tps_per_tm;
  races->page_count = (size_t)(races->machine->space.size >> PAGE_SHIFT);
  races->pages = trax_explain_array(races->page_count, sizeof *races->pages, error);
  races->thread = races->pages ? trax_explain_array(races->machine->stats.threads, sizeof *races->thread, error) : NULL;
  return races->thread ? trax_clocks_open(&races->clocks, (uint32_t)races->machine->stats.threads, error) : TRAX_ERROR;
}

static void close_races(void *self) {
  struct races *races = self;
  for (size_t i = 0; races->pages && i < races->page_count; i++) {
    for (size_t k = 0; races->pages[i] && k < WORDS; k++)
      trax_release_drop(&races->pages[i][k].release);
    free(races->pages[i]);
  }
  trax_clocks_close(&races->clocks);
  free(races->pages);
  free(races->thread);
  free(races->sites);
  trax_map_free(&races->site_of);
}

static bool is_wanted(const struct trax_explain_options *options) {
  return options->check_races;
}

const struct trax_reader_kind trax_races_reader = {.bytes = sizeof(struct races),
                                                   .is_wanted = is_wanted,
                                                   .open = open_races,
                                                   .span = add_span,
                                                   .arrival = add_arrival,
                                                   .end = end_races,
                                                   .close = close_races};
