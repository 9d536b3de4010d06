#include "fast/merge.h"

#include "fast/chip.h"
#include "fast/store_buffer.h"

/* The bits of the bytes of a line's first block. */
#define BLOCK_BITS ((1u << TRAX_BLOCK) - 1)

/* The writer of a word: a TM, or one of these. */
enum { BY_SEVERAL = TRAX_MAX_TMS, BY_CONTROLLER };

struct trax_merge_undo {
  uint32_t address;
  uint8_t bytes[TRAX_OVERLAY_BYTES];
};

bool trax_merge_create(struct trax_merge *merge, struct trax_chip *chip) {
  merge->chip = chip;
  merge->buffers = calloc(chip->tms, sizeof *merge->buffers);
  return merge->buffers;
}

void trax_merge_destroy(struct trax_merge *merge) {
  for (uint32_t i = 0; merge->buffers && i < merge->chip->tms; i++) {
    trax_overlay_destroy(&merge->buffers[i].written);
    for (unsigned side = 0; side < TRAX_SIDES; side++)
      free(merge->buffers[i].sides[side].entries);
  }
  free(merge->buffers);
  trax_overlay_destroy(&merge->written);
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

/* Notes who writes some bytes of a line of the write set. */
static void note_writer(struct trax_overlay_line *line, uint32_t bits, uint32_t writer) {
  if (!line->written) /* who wrote the other words does not matter */
    memset(line->writer, (int)writer, sizeof line->writer);
  for (unsigned word = 0; line->written && bits; word++, bits >>= 4)
    if (bits & 15)
      line->writer[word] =
          (uint8_t)(line->written >> 4 * word & 15 && line->writer[word] != writer ? BY_SEVERAL : writer);
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
  struct trax_overlay_line *const line = trax_overlay_put(&merge->written, write->address / TRAX_OVERLAY_BYTES);
  if (!line)
    return false;
  note_writer(line, trax_overlay_bits(write->address, write->bytes), tm);
  trax_overlay_store(line, write->address, write->value, write->bytes);
  return true;
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
  struct trax_overlay_line *const line = trax_overlay_put(&merge->written, address / TRAX_OVERLAY_BYTES);
  if (!line) {
    give_up(merge);
    return 0;
  }
  const uint32_t word = trax_overlay_load(line, merge->chip->machine->space.bytes, address, sizeof word);
  note_writer(line, trax_overlay_bits(address, sizeof word), BY_CONTROLLER);
  trax_overlay_store(line, address, word + 1, sizeof word);
  return word;
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
  tm->buffer->stop = false;
  trax_overlay_empty(&tm->buffer->written);
  trax_fast_record_readers(tm);
}

void trax_merge_give(struct trax_merge *merge, struct trax_tm *tm, unsigned side) {
  tm->buffer = &merge->buffers[tm->number];
  tm->buffer->side = &tm->buffer->sides[side];
  tm->buffer->side->count = tm->buffer->side->done = 0;
  trax_tm_receive(tm, side);
}

void trax_merge_take(struct trax_merge *merge, struct trax_tm *tm) {
  if (tm->buffer->stop || tm->fault.kind)
    give_up(merge);
  tm->buffer = NULL;
}

/* Makes the blocks with these bytes of a line SHARED, so that the next epoch has no such conflict. */
static void give_up_line(struct trax_merge *merge, uint32_t number, uint32_t bits) {
  for (; bits; bits &= bits - 1)
    trax_fast_share(&merge->chip->blocks, number * TRAX_OVERLAY_BYTES + trax_first(bits));
  give_up(merge);
}

/* Whether it matters if bytes of the write set were written before or after a TM's. */
static bool is_ordered(const struct trax_overlay_line *line, const struct trax_overlay_line *own, uint32_t bits) {
  for (; bits; bits &= bits - 1)
    if (line->bytes[trax_first(bits)] != own->bytes[trax_first(bits)] ||
        line->writer[trax_first(bits) / 4] == BY_CONTROLLER)
      return true;
  return false;
}

/* Adds a line of a TM's stores to the write set, but for those to SHARED blocks, which are there. */
static void unite(struct trax_merge *merge, const struct trax_overlay_line *own, uint32_t tm) {
  uint32_t bits = own->written;
  for (uint32_t at = 0; at < TRAX_OVERLAY_BYTES; at += TRAX_BLOCK)
    if (trax_fast_is_shared(&merge->chip->blocks, own->number * TRAX_OVERLAY_BYTES + at))
      bits &= ~(BLOCK_BITS << at);
  struct trax_overlay_line *const line = bits ? trax_overlay_put(&merge->written, own->number) : NULL;
  if (!line || is_ordered(line, own, line->written & bits)) {
    if (bits)
      give_up_line(merge, own->number, line ? line->written & bits : 0);
    return;
  }
  note_writer(line, bits, tm);
  trax_overlay_copy(line->bytes, own->bytes, bits);
  line->written |= bits;
}

void trax_merge_unite(struct trax_merge *merge) {
  for (uint32_t tm = 0; tm < merge->chip->tms; tm++)
    for (size_t i = 0; i < merge->buffers[tm].written.count && !merge->failed; i++)
      unite(merge, &merge->buffers[tm].written.lines[i], tm);
}

/* Returns those of the bytes of a line that others than a TM have written, word by word. */
static uint32_t written_by_others(const struct trax_overlay_line *line, uint32_t bits, uint32_t tm) {
  bits &= line->written;
  for (unsigned word = 0; word < TRAX_OVERLAY_BYTES / 4; word++)
    if (line->writer[word] == tm)
      bits &= ~(15u << 4 * word);
  return bits;
}

void trax_merge_check(struct trax_merge *merge, struct trax_tm *tm) {
  struct trax_chip *const chip = merge->chip;
  const struct trax_overlay *const own = &merge->buffers[tm->number].written;
  struct trax_overlay *const all = &merge->written;
  for (unsigned side = 0; side < TRAX_SIDES; side++)
    trax_tm_receive(tm, side);
  for (size_t i = 0; all->count && i < own->count; i++) {
    const struct trax_overlay_line *line = own->lines[i].read ? trax_overlay_find(all, own->lines[i].number) : NULL;
    const uint32_t bits = line ? written_by_others(line, own->lines[i].read, tm->number) : 0;
    if (bits)
      give_up_line(merge, line->number, bits);
  }
  const size_t end = all->count * (tm->number + 1) / chip->tms;
  for (size_t i = all->count * tm->number / chip->tms; i < end; i++)
    for (uint32_t at = 0; at < TRAX_OVERLAY_BYTES; at += TRAX_BLOCK)
      if (all->lines[i].written >> at & BLOCK_BITS &&
          trax_fast_is_loaded(&chip->blocks, all->lines[i].number * TRAX_OVERLAY_BYTES + at))
        give_up(merge);
}

/* --- an epoch --- */

void trax_merge_begin(struct trax_merge *merge) {
  struct trax_chip *chip = merge->chip;
  merge->failed = false;
  merge->increment_count = 0;
  trax_overlay_empty(&merge->written);
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

/* The write set takes effect. False: out of memory. */
static bool write_all(struct trax_merge *merge) {
  struct trax_chip *const chip = merge->chip;
  const struct trax_overlay *const written = &merge->written;
  if (!trax_grow_to((void **)&merge->undo, merge->undo_count + written->count, &merge->undo_capacity,
                    sizeof *merge->undo))
    return false;
  for (size_t i = 0; i < written->count; i++) {
    const struct trax_overlay_line *const line = &written->lines[i];
    struct trax_merge_undo *const undo = &merge->undo[merge->undo_count++];
    uint8_t *const bytes = chip->machine->space.bytes + (undo->address = line->number * TRAX_OVERLAY_BYTES);
    memcpy(undo->bytes, bytes, sizeof undo->bytes);
    trax_overlay_copy(bytes, line->bytes, line->written);
    for (uint32_t at = 0; at < TRAX_OVERLAY_BYTES; at += TRAX_BLOCK)
      if (line->written >> at & BLOCK_BITS)
        trax_fast_set_written(&chip->blocks, undo->address + at, TRAX_BLOCK_WRITTEN);
  }
  return true;
}

bool trax_merge_end(struct trax_merge *merge) {
  struct trax_chip *chip = merge->chip;
  const bool goes_on = trax_chip_running(chip); /* the end of the run must be simulated cycle by cycle */
  const bool good = !merge->failed && goes_on && share_incremented(merge) && write_all(merge);
  chip->memory.increment = trax_fast_increment_outside;
  chip->memory.context = chip;
  chip->memory.side = 0;
  return good;
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
    memcpy(merge->chip->machine->space.bytes + undo->address, undo->bytes, sizeof undo->bytes);
  }
}
