#include "fast/epochs.h"

#include "fast/chip.h"
#include "fast/schedule.h"
#include "fast/state.h"
#include "fast/store_buffer.h"
#include "fast/time/variant.h"
#include "trax/grow.h"
#include "trax/pool.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

enum {
  LEAST_EPOCH = 16,             /* cycles; shorter epochs do not pay */
  MOST_EARLY = 1024,            /* limit of the cycles whose transfers are started before an epoch */
  FIRST_SNAPSHOT_INTERVAL = 64, /* in shortest epochs; doubles with each snapshot until a roll back */
  LONGEST_SNAPSHOT_INTERVAL = 1024,
  MOST_UNDO = 1 << 18,     /* words written to global memory after which a snapshot is taken in any case */
  FIRST_PAUSE = 64,        /* cycles simulated one by one after the epoch of a conflict; doubles with each */
  LONGEST_PAUSE = 1 << 20, /* conflict until a snapshot */
};

/* A word of global memory before it was written. */
struct undo {
  uint32_t address, word;
};

/* The write set of the current epoch: the writer of each word. */
enum { BY_SEVERAL = TRAX_MAX_TMS, BY_CONTROLLER };

/* Of a writer: the controller incremented the word before the epoch, for a cycle of the epoch. */
#define EARLY ((uint32_t)1 << 16)

struct trax_epochs {
  struct trax_chip *chip;
  struct trax_pool *pool;
  enum { RUN, SAVE, RESTORE } work;  /* of the pool's items: groups of TMs, or parts of the snapshot */
  uint32_t groups;                   /* number of items */
  uint32_t interleaved;              /* TMs that one thread runs together */
  struct trax_store_buffer *buffers; /* [tms] */
  uint64_t length;                   /* cycles of the shortest epoch: from a request to its completion */
  uint64_t end;                      /* of the current epoch */
  bool early;                        /* the controller now serves requests for cycles of the epoch to come */

  /* The snapshot. */
  bool has_snapshot;
  uint64_t snapshot_cycle;
  unsigned snapshot_interval;    /* in shortest epochs */
  struct trax_section *sections; /* [section_count] */
  size_t section_count, snapshot_size;
  size_t *places; /* [section_count]: of the sections in the snapshot */
  uint8_t *snapshot;
  struct undo *undo; /* [undo_count]: writes to global memory since the snapshot */
  size_t undo_count, undo_capacity;
  char *printed; /* [printed_count]: characters printed since the snapshot */
  size_t printed_count, printed_capacity;

  uint64_t cautious_from, cautious_until; /* these cycles are simulated one by one */
  uint64_t pause;

  struct trax_map writers;               /* by address: the number of a TM, or BY_..., with EARLY */
  bool failed;                           /* out of memory */
  size_t *next_write, *next_request;     /* [tms]: the next one of the TM's store buffer to be handled */
  struct trax_schedule writes, requests; /* the TMs with some left */
};

/* --- snapshots --- */

/* Whether a listed section contains this one, as a structure contains another. */
static bool is_listed(const struct trax_epochs *epochs, const struct trax_section *section) {
  const uintptr_t begin = (uintptr_t)section->bytes, end = begin + section->size * section->count;
  for (size_t i = epochs->section_count; i-- > 0;) {
    const struct trax_section *other = &epochs->sections[i];
    if ((uintptr_t)other->bytes <= begin && end <= (uintptr_t)other->bytes + other->size * other->count)
      return true;
  }
  return false;
}

static void record_section(void *context, const struct trax_section *section) {
  struct trax_epochs *epochs = context;
  if (epochs->sections) {
    if (section->count == 0 || is_listed(epochs, section))
      return; /* threads that copy parts of the list must not meet in the same bytes */
    epochs->sections[epochs->section_count] = *section;
    epochs->places[epochs->section_count] = epochs->snapshot_size;
  }
  epochs->section_count++;
  epochs->snapshot_size += section->size * section->count;
}

/* Counts the sections, and then lists them. */
static bool record_sections(struct trax_epochs *epochs) {
  trax_state_visit(epochs->chip, record_section, epochs);
  epochs->sections = calloc(epochs->section_count, sizeof *epochs->sections);
  epochs->places = calloc(epochs->section_count, sizeof *epochs->places);
  if (!epochs->sections || !epochs->places)
    return false;
  epochs->section_count = epochs->snapshot_size = 0;
  trax_state_visit(epochs->chip, record_section, epochs);
  return true;
}

/* Copies a part of the sections to the snapshot, or back. */
static void copy_sections(const struct trax_epochs *epochs, uint32_t part) {
  const size_t end = epochs->section_count * (part + 1) / epochs->groups;
  for (size_t i = epochs->section_count * part / epochs->groups; i < end; i++) {
    const struct trax_section *section = &epochs->sections[i];
    uint8_t *const copy = epochs->snapshot + epochs->places[i];
    if (epochs->work == SAVE)
      memcpy(copy, section->bytes, section->size * section->count);
    else
      memcpy(section->bytes, copy, section->size * section->count);
  }
}

static void run_pool(struct trax_epochs *epochs, unsigned work) {
  epochs->work = work;
  trax_pool_run(epochs->pool);
}

/* Writes what the program has printed, since the chip does not go back beyond it any more. */
static void print(struct trax_epochs *epochs) {
  if (epochs->printed_count)
    trax_host_print(epochs->chip->machine, epochs->chip->tm->output, epochs->printed, epochs->printed_count);
  epochs->printed_count = 0;
}

static void take_snapshot(struct trax_epochs *epochs, uint64_t t) {
  if (epochs->chip->translation) /* here alone: epochs that are run again have the same bursts */
    trax_translation_extend(epochs->chip->translation);
  run_pool(epochs, SAVE);
  print(epochs);
  epochs->has_snapshot = true;
  trax_transfer_log_release(&epochs->chip->transfers);
  epochs->chip->transfers.holds = true;
  epochs->snapshot_cycle = t;
  epochs->undo_count = 0;
}

static void roll_back(struct trax_epochs *epochs) {
  struct trax_chip *chip = epochs->chip;
  trax_transfer_log_discard(&chip->transfers);
  epochs->printed_count = 0;
  run_pool(epochs, RESTORE);
  while (epochs->undo_count) {
    const struct undo *undo = &epochs->undo[--epochs->undo_count];
    memcpy(chip->machine->space.bytes + undo->address, &undo->word, sizeof undo->word);
  }
}

void trax_epochs_commit(struct trax_epochs *epochs) {
  print(epochs);
  epochs->has_snapshot = false;
  trax_transfer_log_release(&epochs->chip->transfers);
  epochs->chip->transfers.holds = false;
}

/* --- the end of an epoch --- */

/* Records that a TM or the controller is about to write the word at `address`. NULL: out of memory. */
static const struct trax_map_entry *record_writer(struct trax_epochs *epochs, uint32_t address, uint32_t tm) {
  if (!trax_grow((void **)&epochs->undo, epochs->undo_count, &epochs->undo_capacity, sizeof *epochs->undo))
    return NULL;
  struct undo *undo = &epochs->undo[epochs->undo_count++];
  undo->address = address & ~3u;
  memcpy(&undo->word, epochs->chip->machine->space.bytes + undo->address, sizeof undo->word);
  struct trax_map_entry *writer =
      trax_map_put(&epochs->writers, sizeof *writer, undo->address, tm | (epochs->early ? EARLY : 0));
  if (writer && (writer->value & ~EARLY) != tm)
    writer->value = BY_SEVERAL | (writer->value & EARLY);
  return writer;
}

static bool hold_character(struct trax_epochs *epochs, uint32_t character) {
  if (!trax_grow((void **)&epochs->printed, epochs->printed_count, &epochs->printed_capacity, 1))
    return false;
  epochs->printed[epochs->printed_count++] = (char)character;
  return true;
}

/* Performs a store of a TM or holds its output, or prepares the block of an atomic increment. False: the epoch must be
   given up, since a burst has loaded from the block, or the controller has incremented the word too early, or memory
   ran out. */
static bool perform(struct trax_epochs *epochs, const struct trax_store_buffer_write *write, uint32_t tm) {
  struct trax_chip *chip = epochs->chip;
  if (write->bytes == TRAX_PRINT)
    return hold_character(epochs, write->value);
  if (trax_fast_is_loaded(&chip->blocks, write->address))
    return false;
  const bool increments = write->bytes == TRAX_INCREMENT;
  trax_fast_set_written(&chip->blocks, write->address, increments ? TRAX_BLOCK_SHARED : TRAX_BLOCK_WRITTEN);
  if (increments)
    return true;
  const struct trax_map_entry *writer = record_writer(epochs, write->address, tm);
  if (!writer || writer->value & EARLY)
    return false;
  memcpy(epochs->chip->machine->space.bytes + write->address, &write->value, write->bytes);
  return true;
}

/* Performs the stores of the cycles up to t, in the order of cycles and TMs. */
static bool write_up_to(struct trax_epochs *epochs, uint64_t t) {
  while (trax_schedule_next(&epochs->writes) <= t) {
    const uint32_t tm = trax_schedule_first(&epochs->writes);
    const struct trax_store_buffer *buffer = &epochs->buffers[tm];
    size_t *const write = &epochs->next_write[tm];
    if (!perform(epochs, &buffer->writes[*write], tm))
      return false;
    trax_schedule_go_on(&epochs->writes, ++*write < buffer->write_count ? buffer->writes[*write].cycle : TRAX_NEVER);
  }
  return true;
}

/* Submits the requests made up to cycle t. */
static void submit_requests(struct trax_epochs *epochs, uint64_t t) {
  while (trax_schedule_next(&epochs->requests) <= t) {
    const uint32_t tm = trax_schedule_first(&epochs->requests);
    const struct trax_store_buffer *buffer = &epochs->buffers[tm];
    size_t *const request = &epochs->next_request[tm];
    trax_memory_submit(&epochs->chip->memory, &epochs->chip->tm[tm]);
    trax_schedule_go_on(&epochs->requests,
                        ++*request < buffer->request_count ? buffer->requests[*request] : TRAX_NEVER);
  }
}

/* Schedules the first writes and requests of all TMs. */
static void schedule_all(struct trax_epochs *epochs) {
  epochs->writes.count = epochs->requests.count = 0;
  for (uint32_t i = 0; i < epochs->chip->tms; i++) {
    const struct trax_store_buffer *buffer = &epochs->buffers[i];
    epochs->next_write[i] = epochs->next_request[i] = 0;
    if (buffer->write_count)
      trax_schedule_add(&epochs->writes, buffer->writes[0].cycle, i);
    if (buffer->request_count)
      trax_schedule_add(&epochs->requests, buffer->requests[0], i);
  }
}

/* Called before the controller increments a word. Before an epoch, bursts that have loaded the word roll back, since
   their issued steps may be executed again in the epoch. */
static void record_increment(void *context, uint32_t address) {
  struct trax_epochs *epochs = context;
  for (uint32_t i = 0; epochs->early && i < epochs->chip->tms; i++)
    trax_fast_roll_back_readers(&epochs->chip->tm[i], address);
  epochs->failed |= !record_writer(epochs, address, BY_CONTROLLER);
}

/* Performs step 3 of all cycles of the epoch, except for the transfers that begin_epoch has started. */
static bool run_controller(struct trax_epochs *epochs, uint64_t t) {
  struct trax_chip *chip = epochs->chip;
  struct trax_memory *memory = &chip->memory;
  while (t < epochs->end) {
    submit_requests(epochs, t);
    if (!write_up_to(epochs, t))
      return false;
    trax_memory_cycle(memory, chip->tm, &chip->machine->space, t);
    const uint64_t next = trax_memory_next_cycle(memory, t), next_request = trax_schedule_next(&epochs->requests);
    t = next < next_request ? next : next_request;
  }
  return write_up_to(epochs, epochs->end);
}

/* Whether a TM has read a word that another TM or the controller wrote in this epoch. The blocks of such words are
   SHARED from then on. */
static bool has_conflict(const struct trax_epochs *epochs) {
  bool found = false;
  for (uint32_t i = 0; epochs->writers.count && i < epochs->chip->tms; i++) {
    const struct trax_store_buffer *buffer = &epochs->buffers[i];
    for (size_t j = 0; j < buffer->read_count; j++) {
      const struct trax_map_entry *writer = trax_map_find(&epochs->writers, sizeof *writer, buffer->reads[j]);
      if (writer && (writer->value & ~EARLY) != i) {
        trax_fast_set_written(&epochs->chip->blocks, buffer->reads[j], TRAX_BLOCK_SHARED);
        found = true;
      }
    }
  }
  return found;
}

static bool end_epoch(struct trax_epochs *epochs, uint64_t begin) {
  const struct trax_chip *chip = epochs->chip;
  for (uint32_t i = 0; i < chip->tms; i++)
    if (epochs->buffers[i].stop || chip->tm[i].fault.kind)
      return false;
  if (!trax_chip_running(chip))
    return false; /* the end of the run must be simulated cycle by cycle */
  schedule_all(epochs);
  return run_controller(epochs, begin) && !epochs->failed && !has_conflict(epochs);
}

/* --- epochs --- */

static void work(void *context, uint32_t group) {
  const struct trax_epochs *epochs = context;
  struct trax_chip *chip = epochs->chip;
  if (epochs->work != RUN) {
    copy_sections(epochs, group);
    return;
  }
  const uint32_t first = group * epochs->interleaved, left = chip->tms - first;
  chip->variant->run_epoch(chip, first, left < epochs->interleaved ? left : epochs->interleaved, epochs->end);
}

/* Begins an epoch. Starts the transfers that do not depend on the epoch's requests, and sets the end of the epoch to
   the first cycle in which a request of the epoch may complete. */
static void begin_epoch(struct trax_epochs *epochs, uint64_t t, uint64_t until) {
  const struct trax_chip *chip = epochs->chip;
  for (uint32_t i = 0; i < chip->tms; i++)
    if (chip->tm[i].next_cycle < t)
      chip->tm[i].next_cycle = t;
  trax_map_empty(&epochs->writers, sizeof(struct trax_map_entry));
  epochs->failed = false;
  epochs->early = true;
  const uint64_t served = trax_memory_serve_early(&epochs->chip->memory, chip->tm, chip->tms, &chip->machine->space, t,
                                                  until - t < MOST_EARLY ? until : t + MOST_EARLY);
  epochs->early = false;
  epochs->end = until - t < served - t + epochs->length ? until : served + epochs->length;
}

bool trax_epochs_advance(struct trax_epochs *epochs, uint64_t *t, uint64_t until) {
  struct trax_chip *chip = epochs->chip;
  assert(until > *t);
  if (*t < epochs->cautious_from && epochs->cautious_from < until)
    until = epochs->cautious_from;
  const bool cautious = *t >= epochs->cautious_from && *t < epochs->cautious_until;
  if (cautious || until - *t < LEAST_EPOCH) {
    chip->short_epochs += !cautious;
    trax_epochs_commit(epochs); /* writes outside epochs are not recorded, and so cannot be undone */
    return false;
  }
  if (!epochs->has_snapshot) {
    epochs->snapshot_interval = FIRST_SNAPSHOT_INTERVAL;
    take_snapshot(epochs, *t);
  } else if (*t - epochs->snapshot_cycle >= epochs->snapshot_interval * epochs->length ||
             epochs->undo_count >= MOST_UNDO) {
    if (epochs->snapshot_interval < LONGEST_SNAPSHOT_INTERVAL)
      epochs->snapshot_interval *= 2;
    epochs->pause = FIRST_PAUSE;
    take_snapshot(epochs, *t);
  }
  void (*const increment_outside)(void *, uint32_t) = chip->memory.before_increment;
  chip->memory.before_increment = record_increment;
  chip->memory.context = epochs;
  begin_epoch(epochs, *t, until);
  for (uint32_t i = 0; i < chip->tms; i++) {
    trax_store_buffer_begin(&epochs->buffers[i]);
    chip->tm[i].buffer = &epochs->buffers[i];
  }
  run_pool(epochs, RUN);
  for (uint32_t i = 0; i < chip->tms; i++)
    chip->tm[i].buffer = NULL;
  const bool ended = end_epoch(epochs, *t);
  chip->memory.before_increment = increment_outside;
  chip->memory.context = chip;
  if (ended) {
    *t = epochs->end;
    return true;
  }
  roll_back(epochs);
  chip->conflicts++;
  epochs->cautious_from = *t; /* the epochs up to this one will give the same results again */
  epochs->cautious_until = epochs->end + epochs->pause;
  if (epochs->pause < LONGEST_PAUSE)
    epochs->pause *= 2;
  *t = epochs->snapshot_cycle;
  return true;
}

trax_status trax_epochs_create(struct trax_chip *chip, unsigned threads, trax_error *error) {
  const uint64_t length = trax_memory_least_latency(&chip->machine->config);
  if (!threads)
    threads = trax_host_processors();
  if (threads > chip->tms)
    threads = chip->tms;
  if (chip->tms < 2 || length < LEAST_EPOCH || chip->machine->observer)
    return TRAX_OK;
  struct trax_epochs *epochs = chip->epochs = calloc(1, sizeof *epochs);
  if (!epochs)
    return trax_fail(error, "out of memory");
  epochs->chip = chip;
  epochs->length = length;
  epochs->pause = FIRST_PAUSE;
  epochs->buffers = calloc(chip->tms, sizeof *epochs->buffers);
  epochs->next_write = calloc(chip->tms, sizeof *epochs->next_write);
  epochs->next_request = calloc(chip->tms, sizeof *epochs->next_request);
  if (!epochs->buffers || !record_sections(epochs) || !epochs->next_write || !epochs->next_request)
    return trax_fail(error, "out of memory");
  epochs->snapshot = malloc(epochs->snapshot_size);
  if (!epochs->snapshot)
    return trax_fail(error, "out of memory");
  epochs->interleaved = chip->tms / threads < TRAX_FAST_INTERLEAVED ? chip->tms / threads : TRAX_FAST_INTERLEAVED;
  epochs->groups = (chip->tms + epochs->interleaved - 1) / epochs->interleaved;
  epochs->pool = trax_pool_create(threads, epochs->groups, work, epochs, error);
  return epochs->pool ? TRAX_OK : TRAX_ERROR;
}

void trax_epochs_destroy(struct trax_epochs *epochs) {
  if (!epochs)
    return;
  trax_pool_destroy(epochs->pool);
  for (uint32_t i = 0; epochs->buffers && i < epochs->chip->tms; i++)
    trax_store_buffer_destroy(&epochs->buffers[i]);
  free(epochs->buffers);
  free(epochs->sections);
  free(epochs->places);
  free(epochs->snapshot);
  free(epochs->undo);
  free(epochs->printed);
  trax_map_free(&epochs->writers);
  free(epochs->next_write);
  free(epochs->next_request);
  free(epochs);
}
