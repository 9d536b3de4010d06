#define _POSIX_C_SOURCE 200809L /* open_memstream */
#include "report/backtrace.h"

#include <stdlib.h>
#include <string.h>

#include "program/program.h"
#include "trax/grow.h"

enum { INLINE_DEPTH = 16, DEPTH = 24 }; /* the most inlined functions of a place, and the most callers of a chain */

/* --- one thread --- */

static bool read_word(void *context, uint32_t address, uint32_t *word) {
  const struct trax_thread_memory *memory = context;
  if (address % 4)
    return false;
  if (address >= TRAX_LOCAL_BASE)
    memcpy(word, memory->local + (address - TRAX_LOCAL_BASE), sizeof *word);
  else if (trax_space_check(memory->space, address, sizeof *word, false) == TRAX_FAULT_NONE)
    memcpy(word, memory->space->bytes + address, sizeof *word);
  else
    return false;
  return true;
}

size_t trax_callers(const trax_image *image, struct trax_frame *frame, const struct trax_thread_memory *memory,
                    uint32_t *places, size_t capacity, enum trax_unwound *last) {
  size_t count = 0;
  *last = TRAX_UNWOUND;
  while (count < capacity && (*last = trax_image_unwind(image, frame, read_word, (void *)memory)) == TRAX_UNWOUND)
    places[count++] = trax_frame_place(frame);
  return count;
}

/* "function at file:line, inlined into caller at file:line" */
static void print_place(const struct trax_loaded *loaded, uint32_t pc, FILE *out) {
  const struct trax_symbol *symbol = loaded ? trax_image_symbol_at(loaded->image, pc) : NULL;
  struct trax_source_line lines[INLINE_DEPTH];
  const size_t count = loaded ? trax_image_lines(loaded->image, pc, lines, INLINE_DEPTH) : 0;
  if (count && lines[0].function)
    fprintf(out, "%s", lines[0].function);
  else if (symbol)
    fprintf(out, "%s", symbol->name);
  else
    fprintf(out, "0x%08x", pc);
  for (size_t i = 0; i < count; ++i) {
    if (i)
      fprintf(out, ", inlined into %s", lines[i].function ? lines[i].function : "its caller");
    fprintf(out, " at %s:%d", lines[i].file, lines[i].line);
  }
}

struct place {
  uint32_t pc;
  char *text;
};

struct places { /* each place is looked up once, since many threads are at few places */
  const struct trax_run *run;
  struct place *known;
  size_t count, capacity;
  bool exhausted; /* out of memory */
};

static const char *place_text(struct places *places, uint32_t pc) {
  for (size_t i = 0; i < places->count; ++i)
    if (places->known[i].pc == pc)
      return places->known[i].text;
  if (!trax_grow((void **)&places->known, places->count, &places->capacity, sizeof *places->known)) {
    places->exhausted = true;
    return "";
  }
  char *text = NULL;
  size_t size;
  FILE *out = open_memstream(&text, &size);
  if (out) {
    print_place(trax_loaded_of(places->run->machine), pc, out);
    fclose(out);
  }
  if (!text) {
    places->exhausted = true;
    return "";
  }
  places->known[places->count++] = (struct place){pc, text};
  return text;
}

static void forget_places(struct places *places) {
  for (size_t i = 0; i < places->count; ++i)
    free(places->known[i].text);
  free(places->known);
}

static void print_chain(struct places *places, uint32_t thread, FILE *out) {
  const struct trax_run *run = places->run;
  const struct trax_thread state = trax_run_thread(run, thread);
  const struct trax_loaded *loaded = trax_loaded_of(run->machine);
  struct trax_frame frame = {.pc = state.pc};
  const struct trax_thread_memory memory = {&run->machine->space, state.local};
  uint32_t callers[DEPTH];
  enum trax_unwound last = TRAX_OUTERMOST;
  memcpy(frame.registers, state.reg, sizeof frame.registers);
  const size_t count = loaded ? trax_callers(loaded->image, &frame, &memory, callers, DEPTH, &last) : 0;
  fprintf(out, "%s\n", place_text(places, state.pc));
  for (size_t i = 0; i < count; ++i)
    fprintf(out, "    called by %s\n", place_text(places, callers[i]));
  if (last == TRAX_UNWOUND)
    fprintf(out, "    called by ...\n");
}

void trax_print_backtrace(const struct trax_run *run, uint32_t thread, FILE *out) {
  struct places places = {.run = run};
  print_chain(&places, thread, out);
  forget_places(&places);
}

/* --- all threads --- */

struct group {
  char *chain;
  uint32_t first, threads;
};

struct groups {
  struct places places;
  struct group *group; /* [count] of [threads] allocated */
  uint32_t *of;        /* [threads]: its group */
  uint32_t count, threads, ended;
};

enum { NO_GROUP = UINT32_MAX };

static void add_thread(struct groups *groups, uint32_t thread) {
  char *chain = NULL;
  size_t size;
  FILE *out = open_memstream(&chain, &size);
  groups->of[thread] = NO_GROUP;
  if (out) {
    print_chain(&groups->places, thread, out);
    fclose(out);
  }
  if (!chain) {
    groups->places.exhausted = true;
    return;
  }
  uint32_t i = 0;
  while (i < groups->count && strcmp(groups->group[i].chain, chain) != 0)
    ++i;
  groups->of[thread] = i;
  if (i < groups->count) {
    groups->group[i].threads++;
    free(chain);
  } else {
    groups->group[groups->count++] = (struct group){chain, thread, 1};
  }
}

static void print_numbers(const struct groups *groups, uint32_t group, FILE *out) {
  const char *separator = "";
  for (uint32_t thread = 0; thread < groups->threads; ++thread) {
    if (groups->of[thread] != group)
      continue;
    const uint32_t first = thread;
    while (thread + 1 < groups->threads && groups->of[thread + 1] == group)
      ++thread;
    fprintf(out, "%s%u", separator, first);
    if (thread > first)
      fprintf(out, "-%u", thread);
    separator = ", ";
  }
}

static void print_groups(struct groups *groups, FILE *out) {
  const uint32_t all = groups->threads;
  fprintf(out, "%u thread%s, %u ended\n", all, all == 1 ? "" : "s", groups->ended);
  for (uint32_t shown = 0; shown < groups->count; ++shown) {
    uint32_t most = 0;
    for (uint32_t i = 1; i < groups->count; ++i)
      if (groups->group[i].threads > groups->group[most].threads)
        most = i;
    struct group *group = &groups->group[most];
    fprintf(out, "%u thread%s in %s", group->threads, group->threads == 1 ? "" : "s", group->chain);
    fprintf(out, "    thread%s ", group->threads == 1 ? "" : "s");
    print_numbers(groups, most, out);
    fprintf(out, "\n");
    group->threads = 0; /* shown */
  }
  if (groups->places.exhausted)
    fprintf(out, "out of memory: this is not all\n");
}

void trax_print_threads(const struct trax_run *run, FILE *out) {
  struct groups groups = {.places.run = run, .threads = (uint32_t)run->machine->stats.threads};
  groups.group = calloc(groups.threads, sizeof *groups.group);
  groups.of = calloc(groups.threads, sizeof *groups.of);
  if (groups.group && groups.of) {
    for (uint32_t thread = 0; thread < groups.threads; ++thread)
      if (trax_run_thread(run, thread).ended) {
        groups.of[thread] = NO_GROUP;
        groups.ended++;
      } else {
        add_thread(&groups, thread);
      }
    print_groups(&groups, out);
  } else {
    fprintf(out, "out of memory\n");
  }
  for (uint32_t i = 0; i < groups.count; ++i)
    free(groups.group[i].chain);
  free(groups.group);
  free(groups.of);
  forget_places(&groups.places);
}
