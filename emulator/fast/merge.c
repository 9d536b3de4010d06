#include "fast/merge.h"

#include "fast/chip.h"
#include "fast/store_buffer.h"
#include "trax/grow.h"

#include <stdlib.h>
#include <string.h>

/* The writer of a word: a TM, or one of these. */
enum { BY_SEVERAL = TRAX_MAX_TMS, BY_CONTROLLER };

enum { SLOTS = 4096 };

struct trax_merge_undo {
  uint32_t address, word; /* word: as written in the current epoch; when this is over, as it was before */
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
  free(merge->increments);
  free(merge->undo);
}

static void give_up(struct trax_merge *merge) {
  __atomic_store_n(&merge->failed, true, __ATOMIC_RELAXED);
}

/* --- order --- */

/* Orders the entries of a quantum, the cycles from `begin` to `end`. False: out of memory. */
static bool order_all(struct trax_merge *merge, unsigned side, uint64_t begin, uint64_t end) {
  struct trax_merge_order *const order = &merge->order;
  order->begin = begin;
  order->word = 0;
  order->words = (end - begin + 63) / 64;
  if (!trax_grow_to((void **)&order->cycles, 65 * order->words, &order->capacity, sizeof *order->cycles))
    return false;
  order->tms = order->cycles + order->words;
  memset(order->cycles, 0, 65 * order->words * sizeof *order->cycles);
  for (uint32_t tm = 0; tm < merge->chip->tms; tm++) {
    const struct trax_store_buffer_side *buffer = &merge->buffers[tm].sides[side];
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

/* Returns the word of the write set, which a TM or the controller is about to write. NULL: out of memory. */
static struct trax_merge_undo *record_writer(struct trax_merge *merge, uint32_t address, uint32_t tm) {
  struct trax_merge_undo *undo = find_written(merge, address &= ~3u);
  if (undo) {
    if (undo->writer != tm)
      undo->writer = BY_SEVERAL;
    return undo;
  }
  if (!trax_grow((void **)&merge->undo, merge->undo_count, &merge->undo_capacity, sizeof *merge->undo))
    return NULL;
  uint32_t *const slot = slot_of(merge, address);
  undo = &merge->undo[merge->undo_count++];
  *undo = (struct trax_merge_undo){.address = address, .writer = tm, .next = *slot};
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

/* Records the issue of an atomic increment. */
static bool record_issue(struct trax_merge *merge, uint32_t address) {
  if (!trax_grow((void **)&merge->increments, merge->increment_count, &merge->increment_capacity,
                 sizeof *merge->increments))
    return false;
  merge->increments[merge->increment_count++] = address;
  return true;
}

/* Performs a store of a TM or holds its output. False: out of memory. */
static bool perform(struct trax_merge *merge, const struct trax_store_buffer_entry *write, uint32_t tm) {
  if (write->bytes == TRAX_PRINT)
    return hold_character(merge, write->value);
  if (write->bytes == TRAX_INCREMENT)
    return record_issue(merge, write->address);
  struct trax_merge_undo *const written = record_writer(merge, write->address, tm);
  if (written)
    memcpy((uint8_t *)&written->word + (write->address & 3), &write->value, write->bytes);
  return written;
}

/* Submits the requests of cycle t and performs its stores, up to which all are done. */
static bool take_cycle(struct trax_merge *merge, unsigned side, uint64_t t) {
  struct trax_merge_order *const order = &merge->order;
  order->cycles[order->word] &= order->cycles[order->word] - 1;
  for (uint64_t rest = order->tms[t - order->begin]; rest; rest &= rest - 1) {
    const uint32_t tm = trax_first(rest);
    struct trax_store_buffer_side *buffer = &merge->buffers[tm].sides[side];
    const struct trax_store_buffer_entry *entry = &buffer->entries[buffer->done],
                                         *end = buffer->entries + buffer->count;
    do
      if (entry->bytes == TRAX_REQUEST)
        trax_memory_submit(&merge->chip->memory, &merge->chip->tm[tm], entry->address);
      else if (!perform(merge, entry, tm))
        return false;
    while (++entry < end && entry->cycle == t);
    buffer->done = (size_t)(entry - buffer->entries);
  }
  return true;
}

/* An increment by the controller. */
static uint32_t increment(void *context, uint32_t address) {
  struct trax_merge *merge = context;
  struct trax_merge_undo *const written = record_writer(merge, address, BY_CONTROLLER);
  if (!written)
    give_up(merge);
  return written ? written->word++ : 0;
}

void trax_merge_quantum(struct trax_merge *merge, unsigned side, uint64_t t, uint64_t end) {
  struct trax_chip *chip = merge->chip;
  struct trax_memory *memory = &chip->memory;
  uint64_t next = trax_memory_has_waiting(memory) ? t : TRAX_NEVER, next_entry;
  memory->side = side;
  bool good = order_all(merge, side, t, end);
  while (good && (t = next < (next_entry = next_of(&merge->order)) ? next : next_entry) < end) {
    good = t != next_entry || take_cycle(merge, side, t);
    trax_memory_cycle(memory, chip->tm, t);
    next = trax_memory_next_cycle(memory, t);
  }
  if (!good)
    give_up(merge);
}

/* --- a TM --- */

void trax_merge_begin_tm(struct trax_merge *merge, struct trax_tm *tm) {
  tm->buffer = &merge->buffers[tm->number];
  trax_store_buffer_begin(tm->buffer);
  trax_fast_record_readers(tm);
}

void trax_merge_give(struct trax_merge *merge, struct trax_tm *tm, unsigned side) {
  tm->buffer = &merge->buffers[tm->number];
  trax_store_buffer_begin_quantum(tm->buffer, side);
  trax_tm_receive(tm, side);
}

void trax_merge_take(struct trax_merge *merge, struct trax_tm *tm) {
  if (tm->buffer->stop || tm->fault.kind)
    give_up(merge);
  tm->buffer = NULL;
}

void trax_merge_check(struct trax_merge *merge, struct trax_tm *tm) {
  struct trax_chip *const chip = merge->chip;
  const struct trax_store_buffer *const buffer = &merge->buffers[tm->number];
  const size_t count = merge->undo_count - merge->epoch_undo;
  for (unsigned side = 0; side < TRAX_SIDES; side++)
    trax_tm_receive(tm, side);
  for (size_t i = 0; count && i < buffer->read_count; i++) {
    const struct trax_merge_undo *written = find_written(merge, buffer->reads[i]);
    if (written && written->writer != tm->number) {
      trax_fast_share(&chip->blocks, buffer->reads[i]);
      give_up(merge);
    }
  }
  const size_t end = merge->epoch_undo + count * (tm->number + 1) / chip->tms;
  for (size_t i = merge->epoch_undo + count * tm->number / chip->tms; i < end; i++)
    if (merge->undo[i].writer != BY_CONTROLLER && trax_fast_is_loaded(&chip->blocks, merge->undo[i].address))
      give_up(merge);
}

/* --- an epoch --- */

void trax_merge_begin(struct trax_merge *merge) {
  struct trax_chip *chip = merge->chip;
  merge->failed = false;
  merge->increment_count = 0;
  chip->memory.increment = increment;
  chip->memory.context = merge;
}

/* The blocks of words whose increments were issued are SHARED from now on. False: a burst has loaded from one. */
static bool share_incremented(struct trax_merge *merge) {
  for (size_t i = 0; i < merge->increment_count; i++) {
    if (trax_fast_is_loaded(&merge->chip->blocks, merge->increments[i]))
      return false;
    trax_fast_set_written(&merge->chip->blocks, merge->increments[i], TRAX_BLOCK_SHARED);
  }
  return true;
}

/* The words of the write set take effect. */
static void write_all(struct trax_merge *merge) {
  struct trax_chip *const chip = merge->chip;
  for (; merge->epoch_undo < merge->undo_count; merge->epoch_undo++) {
    struct trax_merge_undo *const undo = &merge->undo[merge->epoch_undo];
    const uint32_t word = undo->word;
    memcpy(&undo->word, chip->machine->space.bytes + undo->address, sizeof word);
    memcpy(chip->machine->space.bytes + undo->address, &word, sizeof word);
    trax_fast_set_written(&chip->blocks, undo->address, TRAX_BLOCK_WRITTEN);
    *slot_of(merge, undo->address) = 0;
  }
}

/* Forgets the write set. */
static void forget_all(struct trax_merge *merge) {
  while (merge->undo_count > merge->epoch_undo)
    *slot_of(merge, merge->undo[--merge->undo_count].address) = 0;
}

bool trax_merge_end(struct trax_merge *merge) {
  struct trax_chip *chip = merge->chip;
  const bool goes_on = trax_chip_running(chip); /* the end of the run must be simulated cycle by cycle */
  const bool good = !merge->failed && goes_on && share_incremented(merge);
  if (good)
    write_all(merge);
  else
    forget_all(merge);
  chip->memory.increment = trax_fast_increment_outside;
  chip->memory.context = chip;
  chip->memory.side = 0;
  return good;
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
