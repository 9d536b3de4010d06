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

struct trax_merge_undo {
  uint32_t address, word;
};

bool trax_merge_create(struct trax_merge *merge, struct trax_chip *chip) {
  merge->chip = chip;
  merge->buffers = calloc(chip->tms, sizeof *merge->buffers);
  return merge->buffers;
}

void trax_merge_destroy(struct trax_merge *merge) {
  for (uint32_t i = 0; merge->buffers && i < merge->chip->tms; i++)
    trax_store_buffer_destroy(&merge->buffers[i]);
  free(merge->buffers);
  trax_map_free(&merge->writers);
  free(merge->writes.cycles);
  free(merge->requests.cycles);
  free(merge->printed);
  free(merge->undo);
}

void trax_merge_keep(struct trax_merge *merge) {
  if (merge->printed_count)
    trax_host_print(merge->chip->machine, merge->chip->tm->output, merge->printed, merge->printed_count);
  merge->printed_count = merge->undo_count = 0;
  trax_transfer_log_release(&merge->chip->transfers);
}

void trax_merge_roll_back(struct trax_merge *merge) {
  trax_transfer_log_discard(&merge->chip->transfers);
  merge->printed_count = 0;
  while (merge->undo_count) {
    const struct trax_merge_undo *undo = &merge->undo[--merge->undo_count];
    memcpy(merge->chip->machine->space.bytes + undo->address, &undo->word, sizeof undo->word);
  }
}

/* --- order --- */

/* Finds the first cycle from `from` on with entries. */
static void find_next(struct trax_merge_order *order, uint64_t from) {
  const uint64_t at = from - order->begin;
  size_t word = at / 64;
  uint64_t cycles = word < order->words ? order->cycles[word] >> at % 64 << at % 64 : 0;
  while (!cycles && ++word < order->words)
    cycles = order->cycles[word];
  order->next = cycles ? order->begin + 64 * word + trax_first(cycles) : TRAX_NEVER;
}

/* Orders the writes or the requests of the cycles from `begin` to `end`. False: out of memory. */
static inline __attribute__((always_inline)) bool
order_all(struct trax_merge_order *order, bool requests, const struct trax_merge *merge, uint64_t begin, uint64_t end) {
  order->begin = begin;
  order->words = (end - begin + 63) / 64;
  if (!trax_grow_to((void **)&order->cycles, 65 * order->words, &order->capacity, sizeof *order->cycles))
    return false;
  order->tms = order->cycles + order->words;
  memset(order->cycles, 0, 65 * order->words * sizeof *order->cycles);
  memset(order->done, 0, sizeof order->done);
  for (uint32_t tm = 0; tm < merge->chip->tms; tm++) {
    const struct trax_store_buffer *buffer = &merge->buffers[tm];
    for (size_t i = 0; i < (requests ? buffer->request_count : buffer->write_count); i++) {
      const uint64_t at = (requests ? buffer->requests[i] : buffer->writes[i].cycle) - begin;
      order->cycles[at / 64] |= (uint64_t)1 << at % 64;
      order->tms[at] |= (uint64_t)1 << tm;
    }
  }
  find_next(order, begin);
  return true;
}

/* --- writes --- */

/* Records that a TM or the controller is about to write the word at `address`. NULL: out of memory. */
static const struct trax_map_entry *record_writer(struct trax_merge *merge, uint32_t address, uint32_t tm) {
  if (!trax_grow((void **)&merge->undo, merge->undo_count, &merge->undo_capacity, sizeof *merge->undo))
    return NULL;
  struct trax_merge_undo *undo = &merge->undo[merge->undo_count++];
  undo->address = address & ~3u;
  memcpy(&undo->word, merge->chip->machine->space.bytes + undo->address, sizeof undo->word);
  struct trax_map_entry *writer =
      trax_map_put(&merge->writers, sizeof *writer, undo->address, tm | (merge->early ? EARLY : 0));
  if (writer && (writer->value & ~EARLY) != tm)
    writer->value = BY_SEVERAL | (writer->value & EARLY);
  return writer;
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
static bool perform(struct trax_merge *merge, const struct trax_store_buffer_write *write, uint32_t tm) {
  struct trax_chip *chip = merge->chip;
  if (write->bytes == TRAX_PRINT)
    return hold_character(merge, write->value);
  if (trax_fast_is_loaded(&chip->blocks, write->address))
    return false;
  const bool increments = write->bytes == TRAX_INCREMENT;
  trax_fast_set_written(&chip->blocks, write->address, increments ? TRAX_BLOCK_SHARED : TRAX_BLOCK_WRITTEN);
  if (increments)
    return true;
  const struct trax_map_entry *writer = record_writer(merge, write->address, tm);
  if (!writer || writer->value & EARLY)
    return false;
  memcpy(merge->chip->machine->space.bytes + write->address, &write->value, write->bytes);
  return true;
}

/* Performs the stores of the cycles up to t. */
static bool write_up_to(struct trax_merge *merge, uint64_t t) {
  struct trax_merge_order *const order = &merge->writes;
  for (; order->next <= t; find_next(order, order->next + 1))
    for (uint64_t rest = order->tms[order->next - order->begin]; rest; rest &= rest - 1) {
      const uint32_t tm = trax_first(rest);
      const struct trax_store_buffer *buffer = &merge->buffers[tm];
      for (size_t *i = &order->done[tm]; *i < buffer->write_count && buffer->writes[*i].cycle == order->next; ++*i)
        if (!perform(merge, &buffer->writes[*i], tm))
          return false;
    }
  return true;
}

/* Submits the requests made up to cycle t. */
static void submit_up_to(struct trax_merge *merge, uint64_t t) {
  struct trax_merge_order *const order = &merge->requests;
  for (; order->next <= t; find_next(order, order->next + 1))
    for (uint64_t rest = order->tms[order->next - order->begin]; rest; rest &= rest - 1) {
      const uint32_t tm = trax_first(rest);
      const struct trax_store_buffer *buffer = &merge->buffers[tm];
      for (size_t *i = &order->done[tm]; *i < buffer->request_count && buffer->requests[*i] == order->next; ++*i)
        trax_memory_submit(&merge->chip->memory, &merge->chip->tm[tm]);
    }
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
  while (t < end) {
    submit_up_to(merge, t);
    if (!write_up_to(merge, t))
      return false;
    trax_memory_cycle(memory, chip->tm, &chip->machine->space, t);
    const uint64_t next = trax_memory_next_cycle(memory, t), next_request = merge->requests.next;
    t = next < next_request ? next : next_request;
  }
  return write_up_to(merge, end);
}

/* Whether a TM has read a word that another TM or the controller wrote in this epoch. The blocks of such words are
   SHARED from then on. */
static bool has_conflict(const struct trax_merge *merge) {
  bool found = false;
  for (uint32_t i = 0; merge->writers.count && i < merge->chip->tms; i++) {
    const struct trax_store_buffer *buffer = &merge->buffers[i];
    for (size_t j = 0; j < buffer->read_count; j++) {
      const struct trax_map_entry *writer = trax_map_find(&merge->writers, sizeof *writer, buffer->reads[j]);
      if (writer && (writer->value & ~EARLY) != i) {
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
  trax_map_empty(&merge->writers, sizeof(struct trax_map_entry));
  merge->failed = false;
  chip->memory.before_increment = record_increment;
  chip->memory.context = merge;
  merge->early = true;
  const uint64_t served = trax_memory_serve_early(&chip->memory, chip->tm, chip->tms, &chip->machine->space, t, until);
  merge->early = false;
  for (uint32_t i = 0; i < chip->tms; i++) {
    trax_store_buffer_begin(&merge->buffers[i]);
    chip->tm[i].buffer = &merge->buffers[i];
  }
  return served;
}

/* Whether the TMs have done all that they had to, and only what a store buffer can hold. */
static bool is_complete(const struct trax_merge *merge) {
  const struct trax_chip *chip = merge->chip;
  for (uint32_t i = 0; i < chip->tms; i++)
    if (merge->buffers[i].stop || chip->tm[i].fault.kind)
      return false;
  return trax_chip_running(chip); /* the end of the run must be simulated cycle by cycle */
}

bool trax_merge_end(struct trax_merge *merge, uint64_t t, uint64_t end) {
  struct trax_chip *chip = merge->chip;
  for (uint32_t i = 0; i < chip->tms; i++)
    chip->tm[i].buffer = NULL;
  const bool good = is_complete(merge) && order_all(&merge->writes, false, merge, t, end) &&
                    order_all(&merge->requests, true, merge, t, end) && run_controller(merge, t, end) &&
                    !merge->failed && !has_conflict(merge);
  chip->memory.before_increment = trax_fast_increment_outside;
  chip->memory.context = chip;
  return good;
}
