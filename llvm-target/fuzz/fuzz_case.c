#include "fuzz_case.h"

#include <ar.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- reading and writing --- */

static uint8_t *copy_bytes(const uint8_t *bytes, size_t size) {
  uint8_t *copy = malloc(size ? size : 1);
  if (!copy)
    abort();
  if (size)
    memcpy(copy, bytes, size);
  return copy;
}

/* The line that starts at *bytes, without its end. Advances *bytes and *size past it. Cuts longer lines to capacity. */
static void take_line(const uint8_t **bytes, size_t *size, char *line, size_t capacity) {
  const uint8_t *end = *size ? memchr(*bytes, '\n', *size) : NULL;
  size_t length = end ? (size_t)(end - *bytes) : *size, kept = 0;
  for (size_t i = 0; i < length && kept < capacity; i++)
    if ((*bytes)[i] != '\0')
      line[kept++] = (char)(*bytes)[i];
  line[kept] = '\0';
  *bytes += end ? length + 1 : length;
  *size -= end ? length + 1 : length;
}

void fuzz_case_read(fuzz_case *result, const uint8_t *bytes, size_t size) {
  memset(result, 0, sizeof *result);
  take_line(&bytes, &size, result->options, FUZZ_MAX_OPTIONS);
  while (size > 0 && result->file_count < FUZZ_MAX_FILES) {
    char head[FUZZ_MAX_NAME + 24];
    take_line(&bytes, &size, head, sizeof head - 1);
    char *space = strchr(head, ' ');
    size_t length = space ? (size_t)strtoul(space + 1, NULL, 10) : size;
    if (space)
      *space = '\0';
    fuzz_file *file = &result->files[result->file_count++];
    snprintf(file->name, sizeof file->name, "%.*s", FUZZ_MAX_NAME, head[0] ? head : "a.o");
    file->size = length < size ? length : size;
    file->bytes = copy_bytes(bytes, file->size);
    bytes += file->size;
    size -= file->size;
  }
}

size_t fuzz_case_write(const fuzz_case *fuzz_case, uint8_t *bytes, size_t capacity) {
  char head[FUZZ_MAX_OPTIONS + 40];
  size_t size = (size_t)snprintf(head, sizeof head, "%s\n", fuzz_case->options);
  size = size < capacity ? size : capacity;
  memcpy(bytes, head, size);
  for (size_t i = 0; i < fuzz_case->file_count; i++) {
    const fuzz_file *file = &fuzz_case->files[i];
    size_t length = (size_t)snprintf(head, sizeof head, "%s %zu\n", file->name, file->size);
    if (capacity - size < length)
      break;
    memcpy(bytes + size, head, length);
    size += length;
    length = file->size < capacity - size ? file->size : capacity - size;
    memcpy(bytes + size, file->bytes, length);
    size += length;
  }
  return size;
}

void fuzz_case_free(fuzz_case *fuzz_case) {
  for (size_t i = 0; i < fuzz_case->file_count; i++)
    free(fuzz_case->files[i].bytes);
}

const fuzz_file *fuzz_case_find(const fuzz_case *fuzz_case, const char *name) {
  for (size_t i = 0; i < fuzz_case->file_count; i++)
    if (strcmp(fuzz_case->files[i].name, name) == 0)
      return &fuzz_case->files[i];
  return NULL;
}

size_t fuzz_case_words(char *options, char **words, size_t limit) {
  size_t count = 0;
  for (char *word = strtok(options, " "); word && count < limit; word = strtok(NULL, " "))
    words[count++] = word;
  return count;
}

/* --- mutation --- */

static void mutate_options(fuzz_case *fuzz_case, const char *words, fuzz_random *random) {
  char copy[FUZZ_MAX_OPTIONS + 1], *parts[128];
  memcpy(copy, fuzz_case->options, sizeof copy);
  size_t count = fuzz_case_words(copy, parts, 127);
  char added[128];
  switch (fuzz_below(random, 4)) {
  case 0:
  case 1: { /* adds a known word: the one around a random place of the list */
    const char *word = words + fuzz_below(random, (uint32_t)strlen(words));
    while (word > words && word[-1] != ' ')
      word--;
    size_t length = strcspn(word, " "), before = strcspn(word, " %");
    if (before < length && fuzz_case->file_count)
      snprintf(added, sizeof added, "%.*s%s", (int)before, word,
               fuzz_case->files[fuzz_below(random, (uint32_t)fuzz_case->file_count)].name);
    else
      snprintf(added, sizeof added, "%.*s", (int)length, word);
    size_t place = fuzz_below(random, (uint32_t)count + 1);
    memmove(parts + place + 1, parts + place, (count - place) * sizeof *parts);
    parts[place] = added;
    count++;
    break;
  }
  case 2: /* removes a word */
    if (count > 1) {
      size_t place = fuzz_below(random, (uint32_t)count);
      memmove(parts + place, parts + place + 1, (count - place - 1) * sizeof *parts);
      count--;
    }
    break;
  default: { /* changes bytes */
    size_t length = LLVMFuzzerMutate((uint8_t *)fuzz_case->options, strlen(fuzz_case->options), FUZZ_MAX_OPTIONS);
    fuzz_case->options[length] = '\0';
    for (char *c = fuzz_case->options; *c; c++)
      if (*c == '\n')
        *c = ' ';
    return;
  }
  }
  size_t length = 0;
  for (size_t i = 0; i < count && length < FUZZ_MAX_OPTIONS; i++)
    length +=
        (size_t)snprintf(fuzz_case->options + length, FUZZ_MAX_OPTIONS + 1 - length, "%s%s", i ? " " : "", parts[i]);
}

/* Mutates one member in place, without changing its size, or the archive as plain bytes. */
static size_t mutate_archive(uint8_t *bytes, size_t size, size_t capacity, fuzz_random *random) {
  uint8_t *members[16];
  size_t sizes[16], count = 0;
  for (size_t at = SARMAG; count < 16 && size >= at && size - at > sizeof(struct ar_hdr);) {
    struct ar_hdr header;
    memcpy(&header, bytes + at, sizeof header);
    char text[sizeof header.ar_size + 1] = {0};
    memcpy(text, header.ar_size, sizeof header.ar_size);
    size_t length = (size_t)strtoul(text, NULL, 10);
    at += sizeof header;
    if (length > size - at)
      break;
    members[count] = bytes + at;
    sizes[count++] = length;
    at += length + (length & 1);
  }
  if (count == 0 || fuzz_below(random, 4) == 0)
    return LLVMFuzzerMutate(bytes, size, capacity);
  size_t chosen = fuzz_below(random, (uint32_t)count);
  fuzz_mutate_elf(members[chosen], sizes[chosen], sizes[chosen], random);
  return size;
}

static void mutate_file(fuzz_file *file, size_t capacity, fuzz_random *random) {
  size_t room = file->size + capacity;
  uint8_t *bytes = realloc(file->bytes, room ? room : 1);
  if (!bytes)
    abort();
  file->bytes = bytes;
  if (file->size >= SARMAG && memcmp(bytes, ARMAG, SARMAG) == 0)
    file->size = mutate_archive(bytes, file->size, room, random);
  else
    file->size = fuzz_mutate_elf(bytes, file->size, room, random);
}

/* An archive of one member, so that archives arise from objects. */
static void wrap_in_archive(fuzz_file *file) {
  char head[SARMAG + sizeof(struct ar_hdr) + 1];
  size_t length = (size_t)snprintf(head, sizeof head, ARMAG "%-16s%-12d%-6d%-6d%-8o%-10zu" ARFMAG, "m.o/", 0, 0, 0,
                                   0644u, file->size);
  uint8_t *bytes = malloc(length + file->size + 1);
  if (!bytes)
    abort();
  memcpy(bytes, head, length);
  memcpy(bytes + length, file->bytes, file->size);
  free(file->bytes);
  file->bytes = bytes;
  file->size += length;
  if (file->size & 1)
    bytes[file->size++] = '\n';
}

static void mutate_files(fuzz_case *fuzz_case, fuzz_random *random) {
  size_t chosen = fuzz_below(random, (uint32_t)fuzz_case->file_count);
  fuzz_file *file = &fuzz_case->files[chosen];
  switch (fuzz_below(random, 4)) {
  case 0: /* copies a file */
    if (fuzz_case->file_count < FUZZ_MAX_FILES) {
      fuzz_file *copy = &fuzz_case->files[fuzz_case->file_count++];
      *copy = *file;
      copy->bytes = copy_bytes(file->bytes, file->size);
      copy->name[0] = (char)('a' + fuzz_below(random, 4));
    }
    break;
  case 1: /* removes it */
    if (fuzz_case->file_count > 1) {
      free(file->bytes);
      *file = fuzz_case->files[--fuzz_case->file_count];
    }
    break;
  case 2:
    wrap_in_archive(file);
    break;
  default: { /* renames it */
    static const char *const names[] = {"a.o", "b.o", "c.o", "libc.a", "liba.a", "response"};
    snprintf(file->name, sizeof file->name, "%s", names[fuzz_below(random, sizeof names / sizeof *names)]);
    break;
  }
  }
}

size_t fuzz_case_mutate(uint8_t *bytes, size_t size, size_t capacity, unsigned seed, const char *words) {
  fuzz_random random = {seed};
  fuzz_case fuzz_case;
  fuzz_case_read(&fuzz_case, bytes, size);
  for (uint32_t rounds = 1 + fuzz_below(&random, 4); rounds > 0; rounds--) {
    uint32_t kind = fuzz_below(&random, 16);
    if (kind < 2 || fuzz_case.file_count == 0)
      mutate_options(&fuzz_case, words, &random);
    else if (kind == 2)
      mutate_files(&fuzz_case, &random);
    else
      mutate_file(&fuzz_case.files[fuzz_below(&random, (uint32_t)fuzz_case.file_count)],
                  capacity > size ? capacity - size : 0, &random);
  }
  size = fuzz_case_write(&fuzz_case, bytes, capacity);
  fuzz_case_free(&fuzz_case);
  return size;
}
