#include "fast/windows.h"

#include "fast/ahead.h"
#include "fast/chip.h"
#include "fast/fast.h"
#include "fast/pool.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

enum {
  LEAST_WINDOW = 16,       /* cycles; shorter ones are not worth it */
  MOST_AHEAD = 1024,       /* cycles for which the controller serves requests before a window */
  FIRST_KEEP = 64,         /* shortest windows after which another state is kept to which the run can go back; */
  RAREST_KEEP = 1024,      /* it doubles as long as it does not */
  MOST_UNDO = 1 << 18,     /* words written to global memory, after which a state is kept in any case */
  FIRST_PAUSE = 64,        /* cycles that are run one by one after a conflict, besides those that contain it */
  LONGEST_PAUSE = 1 << 20, /* it doubles with each conflict that follows soon */
  REGIONS_OF_A_TM = 32 + TRAX_SHARED_COUNT,
  REGIONS_OF_THE_MEMORY = 32,
};

/* Bytes that change during the run. */
struct region {
  void *bytes;
  size_t size;
};

/* What a word of global memory was before it was written. */
struct undo {
  uint32_t address, word;
};

/* Who wrote a word in the current window. */
enum { BY_SEVERAL = TRAX_MAX_TMS, BY_CONTROLLER };

struct writer {
  uint64_t round;
  uint32_t address;
  uint16_t tm; /* or BY_... */
  bool early;  /* incremented before the window, in which this was to happen */
};

struct trax_windows {
  struct trax_chip *chip;
  struct trax_pool *pool;
  uint32_t abreast;         /* TMs that one thread runs together */
  struct trax_ahead *ahead; /* [tms] */
  uint64_t length;          /* cycles of the shortest window: from a request to its completion */
  uint64_t end;             /* of the current one */
  bool early;               /* what the controller does now is to happen in the window's course */

  /* The state to which the run can go back. */
  bool kept;
  uint64_t kept_cycle;
  unsigned keep_every;    /* shortest windows */
  struct region *regions; /* [region_count] */
  size_t region_count, kept_size;
  uint8_t *kept_bytes; /* all regions, one behind the other */
  struct undo *undo;   /* [undo_count]: writes to global memory since then */
  size_t undo_count, undo_capacity;

  uint64_t cautious_from, cautious_until; /* the cycles between these are run one by one */
  uint64_t pause;

  struct writer *writers; /* [writer_capacity], a power of two; open addressing */
  size_t writer_count, writer_capacity;
  uint64_t round;
  bool failed;                       /* out of memory */
  size_t *next_write, *next_request; /* [tms]: of trax_ahead, those that have not been dealt with */
};

/* --- states --- */

static void add_region(struct trax_windows *windows, void *bytes, size_t size) {
  windows->regions[windows->region_count++] = (struct region){bytes, size};
  windows->kept_size += size;
}

static void add_memory_region(void *windows, void *bytes, size_t size) {
  add_region(windows, bytes, size);
}

static void add_tags(struct trax_windows *windows, const struct trax_cache_tags *tags) {
  const size_t sets = (size_t)tags->set_mask + 1;
  add_region(windows, tags->lines, sets * tags->ways * sizeof *tags->lines);
  add_region(windows, tags->next, sets * sizeof *tags->next);
}

static void add_core(struct trax_windows *windows, struct trax_tm *tm) {
  const size_t waiters = (size_t)tm->tps * TRAX_NUM_REGISTERS;
  add_region(windows, tm, sizeof *tm);
  add_region(windows, tm->tp, tm->tps * sizeof *tm->tp);
  add_region(windows, tm->icache, tm->icaches * sizeof *tm->icache);
  for (uint32_t i = 0; i < tm->icaches; i++) {
    add_tags(windows, &tm->icache[i].tags);
    add_region(windows, tm->icache[i].pending, tm->tps * sizeof *tm->icache[i].pending);
  }
  add_tags(windows, &tm->dcache.tags);
  add_region(windows, tm->dcache.mshr, tm->dcache.mshr_limit * sizeof *tm->dcache.mshr);
  add_region(windows, tm->dcache.next_waiter, waiters * sizeof *tm->dcache.next_waiter);
  add_region(windows, tm->queue.requests, tm->queue.depth * sizeof *tm->queue.requests);
  if (tm->queue.heap) {
    add_region(windows, tm->queue.heap, tm->queue.depth * sizeof *tm->queue.heap);
    add_region(windows, tm->queue.places, tm->queue.depth * sizeof *tm->queue.places);
  }
  for (unsigned i = 0; i < TRAX_SHARED_COUNT; i++)
    if (tm->unit[i].free_from)
      add_region(windows, tm->unit[i].free_from, trax_shared_unit_count(&tm->unit[i]) * sizeof *tm->unit[i].free_from);
  add_region(windows, tm->stats, sizeof *tm->stats);
  add_region(windows, tm->tp_stats, tm->tps * sizeof *tm->tp_stats);
  add_region(windows, tm->exit_statuses, tm->tps * sizeof *tm->exit_statuses);
}

static void add_fast(struct trax_windows *windows, struct trax_fast_tm *ftm) {
  const struct trax_tm *tm = ftm->tm;
  const size_t vectors = (size_t)tm->icaches * ftm->vectors * sizeof(trax_fast_lanes);
  add_region(windows, ftm, sizeof *ftm);
  add_region(windows, ftm->tp, tm->tps * sizeof *ftm->tp);
  add_region(windows, ftm->changes, (ftm->fast->program.inst_count + 1) * sizeof *ftm->changes);
  add_region(windows, ftm->resident, tm->icaches * sizeof *ftm->resident);
  add_region(windows, ftm->resident_lines, tm->icaches * sizeof *ftm->resident_lines);
  add_region(windows, ftm->behind, vectors);
}

static void keep_state(struct trax_windows *windows, uint64_t t) {
  uint8_t *to = windows->kept_bytes;
  for (size_t i = 0; i < windows->region_count; to += windows->regions[i++].size)
    memcpy(to, windows->regions[i].bytes, windows->regions[i].size);
  windows->kept = true;
  windows->kept_cycle = t;
  windows->undo_count = 0;
}

static void restore_state(struct trax_windows *windows) {
  const struct trax_chip *chip = windows->chip;
  const uint8_t *from = windows->kept_bytes;
  for (size_t i = 0; i < windows->region_count; from += windows->regions[i++].size)
    memcpy(windows->regions[i].bytes, from, windows->regions[i].size);
  while (windows->undo_count) {
    const struct undo *undo = &windows->undo[--windows->undo_count];
    memcpy(chip->machine->space.bytes + undo->address, &undo->word, sizeof undo->word);
  }
}

void trax_windows_forget(struct trax_windows *windows) {
  windows->kept = false;
}

/* --- the end of a window --- */

static bool grow(void **array, size_t count, size_t *capacity, size_t size) {
  if (count < *capacity)
    return true;
  const size_t larger = *capacity ? 2 * *capacity : 1024;
  void *moved = realloc(*array, larger * size);
  if (!moved)
    return false;
  *array = moved;
  *capacity = larger;
  return true;
}

static struct writer *find_writer(const struct trax_windows *windows, uint32_t address) {
  const size_t mask = windows->writer_capacity - 1;
  size_t i = (address >> 2) * (size_t)0x9E3779B1u & mask;
  while (windows->writers[i].round == windows->round && windows->writers[i].address != address)
    i = (i + 1) & mask;
  return &windows->writers[i];
}

static bool grow_writers(struct trax_windows *windows) {
  if (2 * windows->writer_count < windows->writer_capacity)
    return true;
  struct trax_windows larger = {.round = windows->round, .writer_capacity = 2 * windows->writer_capacity};
  larger.writers = calloc(larger.writer_capacity, sizeof *larger.writers);
  if (!larger.writers)
    return false;
  for (size_t i = 0; i < windows->writer_capacity; i++)
    if (windows->writers[i].round == windows->round)
      *find_writer(&larger, windows->writers[i].address) = windows->writers[i];
  free(windows->writers);
  windows->writers = larger.writers;
  windows->writer_capacity = larger.writer_capacity;
  return true;
}

/* The word at `address` is about to be written by a TM or the controller. NULL: out of memory. */
static const struct writer *note_writer(struct trax_windows *windows, uint32_t address, uint32_t tm) {
  if (!grow((void **)&windows->undo, windows->undo_count, &windows->undo_capacity, sizeof *windows->undo) ||
      !grow_writers(windows))
    return NULL;
  struct undo *undo = &windows->undo[windows->undo_count++];
  undo->address = address & ~3u;
  memcpy(&undo->word, windows->chip->machine->space.bytes + undo->address, sizeof undo->word);
  struct writer *writer = find_writer(windows, undo->address);
  if (writer->round != windows->round) {
    *writer = (struct writer){windows->round, undo->address, (uint16_t)tm, windows->early};
    windows->writer_count++;
  } else if (writer->tm != tm) {
    writer->tm = BY_SEVERAL;
  }
  return writer;
}

/* False: what was loaded before it is written must be loaded again, or what was incremented before, incremented. */
static bool perform(struct trax_windows *windows, const struct trax_ahead_write *write, uint32_t tm) {
  struct trax_fast *fast = windows->chip->fast;
  if (trax_fast_is_loaded(&fast->blocks, write->address))
    return false;
  trax_fast_set_written(&fast->blocks, write->address);
  if (!write->bytes)
    return true;
  const struct writer *writer = note_writer(windows, write->address, tm);
  if (!writer || writer->early)
    return false;
  memcpy(windows->chip->machine->space.bytes + write->address, &write->value, write->bytes);
  return true;
}

/* The stores of the cycles up to t, in the order of cycles and TMs. *next receives the cycle of the next one. */
static bool write_up_to(struct trax_windows *windows, uint64_t t, uint64_t *next) {
  while (true) {
    uint32_t first = 0;
    uint64_t cycle = TRAX_NEVER;
    for (uint32_t i = windows->chip->tms; i-- > 0;) {
      const struct trax_ahead *ahead = &windows->ahead[i];
      if (windows->next_write[i] < ahead->write_count && ahead->writes[windows->next_write[i]].cycle <= cycle) {
        cycle = ahead->writes[windows->next_write[i]].cycle;
        first = i;
      }
    }
    *next = cycle;
    if (cycle > t)
      return true;
    if (!perform(windows, &windows->ahead[first].writes[windows->next_write[first]++], first))
      return false;
  }
}

/* The controller learns of the requests made up to cycle t. Returns the cycle of the next one. */
static uint64_t show_requests(struct trax_windows *windows, uint64_t t) {
  struct trax_chip *chip = windows->chip;
  uint64_t next = TRAX_NEVER;
  for (uint32_t i = 0; i < chip->tms; i++) {
    const struct trax_ahead *ahead = &windows->ahead[i];
    size_t *request = &windows->next_request[i];
    for (; *request < ahead->request_count && ahead->requests[*request] <= t; ++*request)
      trax_memory_show(&chip->memory, &chip->tm[i]);
    if (*request < ahead->request_count && ahead->requests[*request] < next)
      next = ahead->requests[*request];
  }
  return next;
}

/* The controller is about to increment a word. */
static void note_increment(void *context, uint32_t address) {
  struct trax_windows *windows = context;
  windows->failed |= !note_writer(windows, address, BY_CONTROLLER);
}

/* Step 3 of all cycles of the window, but for what has been done before it. */
static bool run_controller(struct trax_windows *windows, uint64_t t) {
  struct trax_chip *chip = windows->chip;
  struct trax_memory *memory = &chip->memory;
  uint64_t next_request = 0, next_write = 0;
  while (t < windows->end) {
    if (next_request <= t)
      next_request = show_requests(windows, t);
    if (next_write <= t && !write_up_to(windows, t, &next_write))
      return false;
    trax_memory_cycle(memory, chip->tm, &chip->machine->space, t);
    const uint64_t next = trax_memory_next_cycle(memory, t);
    t = next < next_request ? next : next_request;
  }
  return write_up_to(windows, windows->end, &next_write);
}

/* Whether a TM has read what somebody else wrote in this window. */
static bool has_read_too_early(const struct trax_windows *windows) {
  for (uint32_t i = 0; windows->writer_count && i < windows->chip->tms; i++) {
    const struct trax_ahead *ahead = &windows->ahead[i];
    for (size_t j = 0; j < ahead->read_count; j++) {
      const struct writer *writer = find_writer(windows, ahead->reads[j]);
      if (writer->round == windows->round && writer->tm != i)
        return true;
    }
  }
  return false;
}

static bool end_window(struct trax_windows *windows, uint64_t begin) {
  const struct trax_chip *chip = windows->chip;
  for (uint32_t i = 0; i < chip->tms; i++)
    if (windows->ahead[i].stop || chip->tm[i].fault.kind)
      return false;
  if (!trax_chip_running(chip))
    return false; /* the run's end is found cycle by cycle */
  memset(windows->next_write, 0, chip->tms * sizeof *windows->next_write);
  memset(windows->next_request, 0, chip->tms * sizeof *windows->next_request);
  return run_controller(windows, begin) && !windows->failed && !has_read_too_early(windows);
}

/* --- windows --- */

static void run_tms(void *context, uint32_t group) {
  const struct trax_windows *windows = context;
  const struct trax_chip *chip = windows->chip;
  const uint32_t first = group * windows->abreast, left = chip->tms - first;
  chip->variant->run_ahead(chip->fast, first, left < windows->abreast ? left : windows->abreast, windows->end);
}

/* Begins a window: whatever waits for memory and is served in the same cycles whatever the TMs request in them is
   served now, and the window ends when what is requested in it might come back. */
static void begin_window(struct trax_windows *windows, uint64_t t, uint64_t until) {
  const struct trax_chip *chip = windows->chip;
  for (uint32_t i = 0; i < chip->tms; i++)
    if (chip->tm[i].next_cycle < t)
      chip->tm[i].next_cycle = t;
  windows->round++;
  windows->writer_count = 0;
  windows->failed = false;
  windows->early = true;
  const uint64_t ahead = trax_memory_run_ahead(&windows->chip->memory, chip->tm, chip->tms, &chip->machine->space, t,
                                               until - t < MOST_AHEAD ? until : t + MOST_AHEAD);
  windows->early = false;
  windows->end = until - t < ahead - t + windows->length ? until : ahead + windows->length;
}

bool trax_windows_advance(struct trax_windows *windows, uint64_t *t, uint64_t until) {
  struct trax_chip *chip = windows->chip;
  assert(until > *t);
  if (*t < windows->cautious_from && windows->cautious_from < until)
    until = windows->cautious_from;
  const bool cautious = *t >= windows->cautious_from && *t < windows->cautious_until;
  if (cautious || until - *t < LEAST_WINDOW) {
    chip->machine->fast_path.short_windows += !cautious;
    windows->kept = false; /* what is written in that cycle is not noted */
    return false;
  }
  if (!windows->kept) {
    windows->keep_every = FIRST_KEEP;
    keep_state(windows, *t);
  } else if (*t - windows->kept_cycle >= windows->keep_every * windows->length || windows->undo_count >= MOST_UNDO) {
    if (windows->keep_every < RAREST_KEEP)
      windows->keep_every *= 2;
    windows->pause = FIRST_PAUSE;
    keep_state(windows, *t);
  }
  chip->memory.before_increment = note_increment;
  chip->memory.context = windows;
  begin_window(windows, *t, until);
  for (uint32_t i = 0; i < chip->tms; i++) {
    trax_ahead_begin(&windows->ahead[i]);
    chip->tm[i].ahead = &windows->ahead[i];
  }
  trax_pool_run(windows->pool);
  for (uint32_t i = 0; i < chip->tms; i++)
    chip->tm[i].ahead = NULL;
  const bool ended = end_window(windows, *t);
  chip->memory.before_increment = NULL;
  if (ended) {
    *t = windows->end;
    return true;
  }
  restore_state(windows);
  chip->machine->fast_path.conflicts++;
  windows->cautious_from = *t; /* the windows up to this one are the same again */
  windows->cautious_until = windows->end + windows->pause;
  if (windows->pause < LONGEST_PAUSE)
    windows->pause *= 2;
  *t = windows->kept_cycle;
  return true;
}

trax_status trax_windows_create(struct trax_chip *chip, unsigned threads, trax_error *error) {
  const uint64_t length = trax_memory_least_latency(&chip->machine->config);
  if (!threads)
    threads = trax_host_processors();
  if (threads > chip->tms)
    threads = chip->tms;
  chip->machine->fast_path.no_windows = length < LEAST_WINDOW;
  if (chip->tms < 2 || length < LEAST_WINDOW || chip->machine->observer)
    return TRAX_OK;
  struct trax_windows *windows = chip->windows = calloc(1, sizeof *windows);
  if (!windows)
    return trax_fail(error, "out of memory");
  windows->chip = chip;
  windows->length = length;
  windows->pause = FIRST_PAUSE;
  windows->writer_capacity = 1024;
  windows->ahead = calloc(chip->tms, sizeof *windows->ahead);
  windows->regions = calloc((size_t)chip->tms * (REGIONS_OF_A_TM + 3 * TRAX_MAX_TPS_PER_TM) + REGIONS_OF_THE_MEMORY,
                            sizeof *windows->regions);
  windows->writers = calloc(windows->writer_capacity, sizeof *windows->writers);
  windows->next_write = calloc(chip->tms, sizeof *windows->next_write);
  windows->next_request = calloc(chip->tms, sizeof *windows->next_request);
  if (!windows->ahead || !windows->regions || !windows->writers || !windows->next_write || !windows->next_request)
    return trax_fail(error, "out of memory");
  add_region(windows, &chip->memory, sizeof chip->memory);
  trax_memory_visit_state(&chip->memory, add_memory_region, windows);
  for (uint32_t i = 0; i < chip->tms; i++) {
    add_core(windows, &chip->tm[i]);
    add_fast(windows, &chip->fast->tm[i]);
  }
  windows->kept_bytes = malloc(windows->kept_size);
  if (!windows->kept_bytes)
    return trax_fail(error, "out of memory");
  windows->abreast = chip->tms / threads < TRAX_FAST_ABREAST ? chip->tms / threads : TRAX_FAST_ABREAST;
  const uint32_t groups = (chip->tms + windows->abreast - 1) / windows->abreast;
  windows->pool = trax_pool_create(threads, groups, run_tms, windows, error);
  return windows->pool ? TRAX_OK : TRAX_ERROR;
}

void trax_windows_destroy(struct trax_windows *windows) {
  if (!windows)
    return;
  trax_pool_destroy(windows->pool);
  for (uint32_t i = 0; windows->ahead && i < windows->chip->tms; i++)
    trax_ahead_destroy(&windows->ahead[i]);
  free(windows->ahead);
  free(windows->regions);
  free(windows->kept_bytes);
  free(windows->undo);
  free(windows->writers);
  free(windows->next_write);
  free(windows->next_request);
  free(windows);
}
