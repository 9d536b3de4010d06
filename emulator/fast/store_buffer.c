#include "fast/store_buffer.h"

#include <stdlib.h>
#include <string.h>

enum { FIRST_CAPACITY = 64 };

void trax_store_buffer_destroy(struct trax_store_buffer *buffer) {
  free(buffer->writes);
  free(buffer->reads);
  free(buffer->requests);
  free(buffer->words);
}

void trax_store_buffer_begin(struct trax_store_buffer *buffer) {
  buffer->write_count = buffer->read_count = buffer->request_count = buffer->word_count = 0;
  buffer->generation++;
  buffer->stop = false;
}

/* Makes room for one more element. False: out of memory; the epoch is then given up. */
static bool grow(struct trax_store_buffer *buffer, void **array, size_t count, size_t *capacity, size_t size) {
  if (count < *capacity)
    return true;
  const size_t larger = *capacity ? 2 * *capacity : FIRST_CAPACITY;
  void *moved = realloc(*array, larger * size);
  if (!moved) {
    buffer->stop = true;
    return false;
  }
  *array = moved;
  *capacity = larger;
  return true;
}

static struct trax_store_buffer_word *find(const struct trax_store_buffer *buffer, uint32_t address) {
  const size_t mask = buffer->word_capacity - 1;
  size_t i = (address >> 2) * (size_t)0x9E3779B1u & mask;
  while (buffer->words[i].generation == buffer->generation && buffer->words[i].address != address)
    i = (i + 1) & mask;
  return &buffer->words[i];
}

/* Grows the table before it is more than half full. */
static bool grow_words(struct trax_store_buffer *buffer) {
  if (2 * buffer->word_count < buffer->word_capacity)
    return true;
  struct trax_store_buffer larger = {.generation = buffer->generation,
                                     .word_capacity =
                                         buffer->word_capacity ? 2 * buffer->word_capacity : FIRST_CAPACITY};
  larger.words = calloc(larger.word_capacity, sizeof *larger.words);
  if (!larger.words) {
    buffer->stop = true;
    return false;
  }
  for (size_t i = 0; i < buffer->word_capacity; i++)
    if (buffer->words[i].generation == buffer->generation)
      *find(&larger, buffer->words[i].address) = buffer->words[i];
  free(buffer->words);
  buffer->words = larger.words;
  buffer->word_capacity = larger.word_capacity;
  return true;
}

static void record_write(struct trax_store_buffer *buffer, struct trax_store_buffer_write write) {
  if (grow(buffer, (void **)&buffer->writes, buffer->write_count, &buffer->write_capacity, sizeof *buffer->writes))
    buffer->writes[buffer->write_count++] = write;
}

uint32_t trax_store_buffer_load(struct trax_store_buffer *buffer, const struct trax_space *space, uint32_t address,
                                unsigned bytes) {
  const uint32_t word_address = address & ~3u;
  uint32_t word, value = 0;
  if (grow(buffer, (void **)&buffer->reads, buffer->read_count, &buffer->read_capacity, sizeof *buffer->reads))
    buffer->reads[buffer->read_count++] = word_address;
  memcpy(&word, space->bytes + word_address, sizeof word);
  if (buffer->word_count) {
    const struct trax_store_buffer_word *own = find(buffer, word_address);
    if (own->generation == buffer->generation)
      word = (word & ~own->mask) | own->value;
  }
  memcpy(&value, (const uint8_t *)&word + (address & 3), bytes);
  return value;
}

void trax_store_buffer_store(struct trax_store_buffer *buffer, uint64_t t, uint32_t address, uint32_t value,
                             unsigned bytes) {
  record_write(buffer, (struct trax_store_buffer_write){t, address, value, bytes});
  if (!grow_words(buffer))
    return;
  struct trax_store_buffer_word *own = find(buffer, address & ~3u);
  if (own->generation != buffer->generation) {
    *own = (struct trax_store_buffer_word){.generation = buffer->generation, .address = address & ~3u};
    buffer->word_count++;
  }
  const unsigned shift = 8 * (address & 3);
  const uint32_t mask = (bytes < 4 ? (1u << 8 * bytes) - 1 : ~0u) << shift;
  own->value = (own->value & ~mask) | (value << shift & mask);
  own->mask |= mask;
}

void trax_store_buffer_increment(struct trax_store_buffer *buffer, uint64_t t, uint32_t address) {
  record_write(buffer, (struct trax_store_buffer_write){.cycle = t, .address = address});
}

void trax_store_buffer_request(struct trax_store_buffer *buffer, uint64_t t) {
  if (grow(buffer, (void **)&buffer->requests, buffer->request_count, &buffer->request_capacity,
           sizeof *buffer->requests))
    buffer->requests[buffer->request_count++] = t;
}
