#include "fast/ahead.h"

#include <stdlib.h>
#include <string.h>

enum { FIRST_CAPACITY = 64 };

void trax_ahead_destroy(struct trax_ahead *ahead) {
  free(ahead->writes);
  free(ahead->reads);
  free(ahead->requests);
  free(ahead->words);
}

void trax_ahead_begin(struct trax_ahead *ahead) {
  ahead->write_count = ahead->read_count = ahead->request_count = ahead->word_count = 0;
  ahead->round++;
  ahead->stop = false;
}

/* Makes room for one more. False if there is none: the stretch must be simulated otherwise. */
static bool grow(struct trax_ahead *ahead, void **array, size_t count, size_t *capacity, size_t size) {
  if (count < *capacity)
    return true;
  const size_t larger = *capacity ? 2 * *capacity : FIRST_CAPACITY;
  void *moved = realloc(*array, larger * size);
  if (!moved) {
    ahead->stop = true;
    return false;
  }
  *array = moved;
  *capacity = larger;
  return true;
}

static struct trax_ahead_word *find(const struct trax_ahead *ahead, uint32_t address) {
  const size_t mask = ahead->word_capacity - 1;
  size_t i = (address >> 2) * (size_t)0x9E3779B1u & mask;
  while (ahead->words[i].round == ahead->round && ahead->words[i].address != address)
    i = (i + 1) & mask;
  return &ahead->words[i];
}

/* At least half of the table stays empty. */
static bool grow_words(struct trax_ahead *ahead) {
  if (2 * ahead->word_count < ahead->word_capacity)
    return true;
  struct trax_ahead larger = {.round = ahead->round,
                              .word_capacity = ahead->word_capacity ? 2 * ahead->word_capacity : FIRST_CAPACITY};
  larger.words = calloc(larger.word_capacity, sizeof *larger.words);
  if (!larger.words) {
    ahead->stop = true;
    return false;
  }
  for (size_t i = 0; i < ahead->word_capacity; i++)
    if (ahead->words[i].round == ahead->round)
      *find(&larger, ahead->words[i].address) = ahead->words[i];
  free(ahead->words);
  ahead->words = larger.words;
  ahead->word_capacity = larger.word_capacity;
  return true;
}

static void note_write(struct trax_ahead *ahead, struct trax_ahead_write write) {
  if (grow(ahead, (void **)&ahead->writes, ahead->write_count, &ahead->write_capacity, sizeof *ahead->writes))
    ahead->writes[ahead->write_count++] = write;
}

uint32_t trax_ahead_load(struct trax_ahead *ahead, const struct trax_space *space, uint32_t address, unsigned bytes) {
  const uint32_t word_address = address & ~3u;
  uint32_t word, value = 0;
  if (grow(ahead, (void **)&ahead->reads, ahead->read_count, &ahead->read_capacity, sizeof *ahead->reads))
    ahead->reads[ahead->read_count++] = word_address;
  memcpy(&word, space->bytes + word_address, sizeof word);
  if (ahead->word_count) {
    const struct trax_ahead_word *own = find(ahead, word_address);
    if (own->round == ahead->round)
      word = (word & ~own->mask) | own->value;
  }
  memcpy(&value, (const uint8_t *)&word + (address & 3), bytes);
  return value;
}

void trax_ahead_store(struct trax_ahead *ahead, uint64_t t, uint32_t address, uint32_t value, unsigned bytes) {
  note_write(ahead, (struct trax_ahead_write){t, address, value, bytes});
  if (!grow_words(ahead))
    return;
  struct trax_ahead_word *own = find(ahead, address & ~3u);
  if (own->round != ahead->round) {
    *own = (struct trax_ahead_word){.round = ahead->round, .address = address & ~3u};
    ahead->word_count++;
  }
  const unsigned shift = 8 * (address & 3);
  const uint32_t mask = (bytes < 4 ? (1u << 8 * bytes) - 1 : ~0u) << shift;
  own->value = (own->value & ~mask) | (value << shift & mask);
  own->mask |= mask;
}

void trax_ahead_increment(struct trax_ahead *ahead, uint64_t t, uint32_t address) {
  note_write(ahead, (struct trax_ahead_write){.cycle = t, .address = address});
}

void trax_ahead_request(struct trax_ahead *ahead, uint64_t t) {
  if (grow(ahead, (void **)&ahead->requests, ahead->request_count, &ahead->request_capacity, sizeof *ahead->requests))
    ahead->requests[ahead->request_count++] = t;
}
