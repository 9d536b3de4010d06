#include "fast/merge.h"

#include "fast/chip.h"
#include "fast/store_buffer.h"
#include "trax/grow.h"

#include <stdlib.h>
#include <string.h>

/* The writer of a word: a TM, or one of these. */
enum { BY_SEVERAL = TRAX_MAX_TMS, BY_CONTROLLER };

/* Of a writer: the controller incremented the word before the epoch, for a cycle of the epoch. */
#define EARLY ((uint32_t)1 << 16)

enum { SLOTS = 4096 };

struct trax_merge_undo {
  uint32_t address, word;
  uint32_t writer;
  uint32_t next; /* the number of the next one in its slot, + 1; 0: there is none */
};

bool trax_merge_create(struct trax_merge *merge, struct trax_chip *chip) {
  merge->chip = chip;
  merge->buffers = calloc(chip->tms, sizeof *merge->buffers);
  merge->slots = calloc(SLOTS, sizeof *merge->slots);
  return merge->buffers && merge->slots;
}

void trax_merge_destroy(struct trax_merge *merge) {
  for (uint32_t i = 0; merge->buffers && i < merge->chip->tms; i++)
    trax_store_buffer_destroy(&merge->buffers[i]);
  free(merge->buffers);
  free(merge->slots);
  free(merge->order.cycles);
  free(merge->printed);
  free(merge->undo);
}

void trax_merge_keep(struct trax_merge *merge) {
  if (merge->printed_count)
    trax_host_print(merge->chip->machine, merge->chip->tm->output, merge->printed, merge->printed_count);
  merge->printed_count = merge->undo_count = merge->epoch_undo = 0;
  trax_transfer_log_release(&merge->chip->transfers);
}

void trax_merge_roll_back(struct trax_merge *merge) {
  trax_transfer_log_discard(&merge->chip->transfers);
  merge->printed_count = 0;
  while (merge->undo_count) {
    const struct trax_merge_undo *undo = &merge->undo[--merge->undo_count];
    memcpy(merge->chip->machine->space.bytes + undo->address, &undo->word, sizeof undo->word);
  }
  merge->epoch_undo = 0;
}

/* --- order --- */

/* Orders the entries of the cycles from `begin` to `end`. False: out of memory. */
static bool order_all(struct trax_merge *merge, uint64_t begin, uint64_t end) {
  struct trax_merge_order *const order = &merge->order;
  order->begin = begin;
  order->word = 0;
  order->words = (end - begin + 63) / 64;
  if (!trax_grow_to((void **)&order->cycles, 65 * order->words, &order->capacity, sizeof *order->cycles))
    return false;
  order->tms = order->cycles + order->words;
  memset(order->cycles, 0, 65 * order->words * sizeof *order->cycles);
  for (uint32_t tm = 0; tm < merge->chip->tms; tm++) {
    const struct trax_store_buffer *buffer = &merge->buffers[tm];
    for (size_t i = 0; i < buffer->count; i++) {
      const uint64_t at = buffer->entries[i].cycle - begin;
      order->cycles[at / 64] |= (uint64_t)1 << at % 64;
      order->tms[at] |= (uint64_t)1 << tm;
    }
  }
  return true;
}

/* Returns the first cycle with entries that are not done; TRAX_NEVER: there is none. */
static inline uint64_t next_of(struct trax_merge_order *order) {
  for (; order->word < order->words; order->word++)
    if (order->cycles[order->word])
      return order->begin + 64 * order->word + trax_first(order->cycles[order->word]);
  return TRAX_NEVER;
}

/* --- writes --- */

static inline uint32_t *slot_of(const struct trax_merge *merge, uint32_t address) {
  return &merge->slots[(address >> 2) * 0x9E3779B1u / (UINT32_MAX / SLOTS + 1)];
}

/* Returns what is known of a word that was written in this epoch. NULL: it was not. */
static inline struct trax_merge_undo *find_written(const struct trax_merge *merge, uint32_t address) {
  struct trax_merge_undo *undo = NULL;
  for (uint32_t i = *slot_of(merge, address); i; i = undo->next)
    if ((undo = &merge->undo[i - 1])->address == address)
      return undo;
  return NULL;
}

/* Begins the write set of the next epoch. */
static void forget_writers(struct trax_merge *merge) {
  for (; merge->epoch_undo < merge->undo_count; merge->epoch_undo++)
    *slot_of(merge, merge->undo[merge->epoch_undo].address) = 0;
}

/* Records that a TM or the controller is about to write the word at `address`. NULL: out of memory. */
static const struct trax_merge_undo *record_writer(struct trax_merge *merge, uint32_t address, uint32_t tm) {
  const uint32_t early = merge->early ? EARLY : 0;
  struct trax_merge_undo *undo = find_written(merge, address &= ~3u);
  if (undo) {
    if ((undo->writer & ~EARLY) != tm)
      undo->writer = BY_SEVERAL | (undo->writer & EARLY);
    return undo;
  }
  if (!trax_grow((void **)&merge->undo, merge->undo_count, &merge->undo_capacity, sizeof *merge->undo))
    return NULL;
  uint32_t *const slot = slot_of(merge, address);
  undo = &merge->undo[merge->undo_count++];
  *undo = (struct trax_merge_undo){.address = address, .writer = tm | early, .next = *slot};
  memcpy(&undo->word, merge->chip->machine->space.bytes + address, sizeof undo->word);
  *slot = (uint32_t)merge->undo_count;
  return undo;
}

static bool hold_character(struct trax_merge *merge, uint32_t character) {
  if (!trax_grow((void **)&merge->printed, merge->printed_count, &merge->printed_capacity, 1))
    return false;
  merge->printed[merge->printed_count++] = (char)character;
  return true;
}

/* Performs a store of a TM or holds its output, or prepares the block of an atomic increment. False: the epoch must be
   given up, since a burst has loaded from the block, or the controller has incremented the word too early, or memory
   ran out. */
static bool perform(struct trax_merge *merge, const struct trax_store_buffer_entry *write, uint32_t tm) {
  struct trax_chip *chip = merge->chip;
  if (write->bytes == TRAX_PRINT)
    return hold_character(merge, write->value);
  if (trax_fast_is_loaded(&chip->blocks, write->address))
    return false;
  const bool increments = write->bytes == TRAX_INCREMENT;
  trax_fast_set_written(&chip->blocks, write->address, increments ? TRAX_BLOCK_SHARED : TRAX_BLOCK_WRITTEN);
  if (increments)
    return true;
  const struct trax_merge_undo *written = record_writer(merge, write->address, tm);
  if (!written || written->writer & EARLY)
    return false;
  memcpy(merge->chip->machine->space.bytes + write->address, &write->value, write->bytes);
  return true;
}

/* Submits the requests of cycle t and performs its stores, up to which all are done. */
static bool take_cycle(struct trax_merge *merge, uint64_t t) {
  struct trax_merge_order *const order = &merge->order;
  order->cycles[order->word] &= order->cycles[order->word] - 1;
  for (uint64_t rest = order->tms[t - order->begin]; rest; rest &= rest - 1) {
    const uint32_t tm = trax_first(rest);
    struct trax_store_buffer *buffer = &merge->buffers[tm];
    const struct trax_store_buffer_entry *entry = &buffer->entries[buffer->done],
                                         *end = buffer->entries + buffer->count;
    do
      if (entry->bytes == TRAX_REQUEST)
        trax_memory_submit(&merge->chip->memory, &merge->chip->tm[tm]);
      else if (!perform(merge, entry, tm))
        return false;
    while (++entry < end && entry->cycle == t);
    buffer->done = (size_t)(entry - buffer->entries);
  }
  return true;
}

/* Called before the controller increments a word. Before an epoch, bursts that have loaded the word roll back, since
   their issued steps may be executed again in the epoch. */
static void record_increment(void *context, uint32_t address) {
  struct trax_merge *merge = context;
  for (uint32_t i = 0; merge->early && i < merge->chip->tms; i++)
    trax_fast_roll_back_readers(&merge->chip->tm[i], address);
  merge->failed |= !record_writer(merge, address, BY_CONTROLLER);
}

/* Performs step 3 of the cycles from t to `end`, except for the transfers that trax_merge_begin has started. */
static bool run_controller(struct trax_merge *merge, uint64_t t, uint64_t end) {
  struct trax_chip *chip = merge->chip;
  struct trax_memory *memory = &chip->memory;
  uint64_t next = trax_memory_has_waiting(memory) ? t : TRAX_NEVER, next_entry;
  while ((t = next < (next_entry = next_of(&merge->order)) ? next : next_entry) < end) {
    if (t == next_entry && !take_cycle(merge, t))
      return false;
    trax_memory_cycle(memory, chip->tm, &chip->machine->space, t);
    next = trax_memory_next_cycle(memory, t);
  }
  return true;
}

/* Whether a TM has read a word that another TM or the controller wrote in this epoch. The blocks of such words are
   SHARED from then on. */
static bool has_conflict(const struct trax_merge *merge) {
  bool found = false;
  for (uint32_t i = 0; merge->epoch_undo < merge->undo_count && i < merge->chip->tms; i++) {
    const struct trax_store_buffer *buffer = &merge->buffers[i];
    for (size_t j = 0; j < buffer->read_count; j++) {
      const struct trax_merge_undo *written = find_written(merge, buffer->reads[j]);
      if (written && (written->writer & ~EARLY) != i) {
        trax_fast_set_written(&merge->chip->blocks, buffer->reads[j], TRAX_BLOCK_SHARED);
        found = true;
      }
    }
  }
  return found;
}

/* --- an epoch --- */

uint64_t trax_merge_begin(struct trax_merge *merge, uint64_t t, uint64_t until) {
  struct trax_chip *chip = merge->chip;
  merge->failed = false;
  chip->memory.before_increment = record_increment;
  chip->memory.context = merge;
  merge->early = true;
  const uint64_t served = trax_memory_serve_early(&chip->memory, chip->tm, chip->tms, &chip->machine->space, t, until);
  merge->early = false;
  return served;
}

void trax_merge_give(struct trax_merge *merge, struct trax_tm *tm) {
  tm->buffer = &merge->buffers[tm->number];
  trax_store_buffer_begin(tm->buffer);
}

void trax_merge_take(struct trax_merge *merge, struct trax_tm *tm) {
  if (tm->buffer->stop || tm->fault.kind)
    __atomic_store_n(&merge->failed, true, __ATOMIC_RELAXED);
  tm->buffer = NULL;
}

bool trax_merge_end(struct trax_merge *merge, uint64_t t, uint64_t end) {
  struct trax_chip *chip = merge->chip;
  const bool goes_on = trax_chip_running(chip); /* the end of the run must be simulated cycle by cycle */
  const bool good = !merge->failed && goes_on && order_all(merge, t, end) && run_controller(merge, t, end) &&
                    !merge->failed && !has_conflict(merge);
  forget_writers(merge);
  chip->memory.before_increment = trax_fast_increment_outside;
  chip->memory.context = chip;
  return good;
}
