#define _POSIX_C_SOURCE 200809L /* open_memstream */
/* Profiles as text: tables by function and line, folded stacks. */
#include "explain/profile.h"
#include "explain/texts.h"
#include "report/statistics.h"
#include "trax/grow.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

/* A row of a table. */
struct row {
  const char *name;
  struct trax_profile_counts own;  /* of the instructions themselves */
  uint64_t own_cycles, all_cycles; /* all: with functions that are inlined or called */
};

struct tables {
  const struct trax_profile *profile;
  struct trax_profile_counts total;
  struct row *functions, *lines; /* [names + 1] */
  uint32_t *seen;                /* [names + 1]: the latest record with the name, as a function or a line, + 1 */
  size_t names;
};

static double percent(uint64_t part, uint64_t whole) {
  return whole ? 100 * (double)part / (double)whole : 0;
}

/* Adds the cycles to the frames of a place. A function counts once for each record, even if it is recursive. */
static void add_frames(struct tables *tables, uint32_t index, uint32_t stamp, uint64_t cycles) {
  const struct trax_place *place = trax_places_at(tables->profile->reader.explain->places, index);
  for (uint32_t i = 0; i < place->frame_count; i++) {
    const struct trax_frame_place *frame = &place->frames[i];
    if (tables->seen[frame->function] != stamp) {
      tables->seen[frame->function] = stamp;
      tables->functions[frame->function].all_cycles += cycles;
    }
    if (frame->line && tables->seen[frame->line] != stamp) {
      tables->seen[frame->line] = stamp;
      tables->lines[frame->line].all_cycles += cycles;
    }
  }
}

static void add_record(struct tables *tables, size_t number) {
  const struct trax_profile *profile = tables->profile;
  const struct trax_profile_record *record = &profile->records[number];
  const struct trax_frame_place *innermost = trax_places_at(profile->reader.explain->places, record->index)->frames;
  const uint64_t cycles = trax_profile_cycles(&record->counts);
  trax_profile_add(&tables->total, &record->counts);
  trax_profile_add(&tables->functions[innermost->function].own, &record->counts);
  trax_profile_add(&tables->lines[innermost->line].own, &record->counts);
  add_frames(tables, record->index, (uint32_t)number + 1, cycles);
  for (uint32_t context = record->context; context; context = profile->contexts[context].parent)
    add_frames(tables, profile->contexts[context].index, (uint32_t)number + 1, cycles);
}

static int by_own(const void *a, const void *b) { /* then by name, not its number, which other reports change */
  const struct row *x = a, *y = b;
  if (x->own_cycles != y->own_cycles)
    return x->own_cycles < y->own_cycles ? 1 : -1;
  if (x->all_cycles != y->all_cycles)
    return x->all_cycles < y->all_cycles ? 1 : -1;
  return strcmp(x->name, y->name);
}

static void print_head(FILE *out, const struct trax_profile_counts *total) {
  fprintf(out, "%15s %6s %6s %14s %7s", "thread-cycles", "own %", "all %", "instructions", "load-h%");
  for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++)
    if (total->cycles[cause])
      fprintf(out, " %6s", trax_cause_heads[cause]);
  fprintf(out, "\n");
}

static void print_counts(FILE *out, const struct trax_profile_counts *counts, uint64_t cycles, uint64_t all_cycles,
                         const struct trax_profile_counts *total) {
  const uint64_t total_cycles = trax_profile_cycles(total);
  fprintf(out, "%15" PRIu64 " %6.2f ", cycles, percent(cycles, total_cycles));
  if (all_cycles)
    fprintf(out, "%6.2f", percent(all_cycles, total_cycles));
  else
    fprintf(out, "%6s", "");
  fprintf(out, " %14" PRIu64 " ", counts->cycles[TRAX_CAUSE_ISSUED]);
  if (counts->loads)
    fprintf(out, "%7.2f", percent(counts->hits, counts->loads));
  else
    fprintf(out, "%7s", "");
  for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++)
    if (total->cycles[cause] && counts->cycles[cause])
      fprintf(out, " %6.2f", percent(counts->cycles[cause], cycles));
    else if (total->cycles[cause])
      fprintf(out, " %6s", "");
}

static void print_table(const struct tables *tables, FILE *out, struct row *rows, const char *title) {
  const struct trax_places *places = tables->profile->reader.explain->places;
  const uint64_t total_cycles = trax_profile_cycles(&tables->total);
  for (size_t i = 0; i <= tables->names; i++) {
    rows[i].name = i ? trax_places_name(places, (uint32_t)i) : "(no line)";
    rows[i].own_cycles = trax_profile_cycles(&rows[i].own);
  }
  qsort(rows, tables->names + 1, sizeof *rows, by_own);
  fprintf(out, "\n%s\n", title);
  print_head(out, &tables->total);
  for (size_t i = 0; i <= tables->names; i++) {
    const struct row *row = &rows[i];
    if (!row->own_cycles && !row->all_cycles)
      continue;
    print_counts(out, &row->own, row->own_cycles, row->all_cycles, &tables->total);
    fprintf(out, "  %s\n", row->name);
  }
  print_counts(out, &tables->total, total_cycles, total_cycles, &tables->total);
  fprintf(out, "  total\n");
}

/* Looks up all places, so that the number of names is final; in the order in which the page does. */
static void look_up_all(const struct trax_profile *profile) {
  struct trax_places *places = profile->reader.explain->places;
  for (uint32_t i = 0; i < trax_places_count(places) + 2; i++)
    if (profile->latest_of[i].record)
      trax_places_at(places, i);
}

trax_status trax_profile_put(void *self, FILE *out, trax_error *error) {
  const struct trax_profile *profile = self;
  struct trax_places *places = profile->reader.explain->places;
  const trax_machine *machine = profile->reader.explain->machine;
  const struct trax_loaded *loaded = trax_loaded_of(machine);
  look_up_all(profile);
  struct tables tables = {.profile = profile, .names = trax_places_names(places)};
  tables.functions = calloc(tables.names + 1, sizeof *tables.functions);
  tables.lines = calloc(tables.names + 1, sizeof *tables.lines);
  tables.seen = calloc(tables.names + 1, sizeof *tables.seen);
  const bool complete = tables.functions && tables.lines && tables.seen;
  if (complete) {
    for (size_t i = 0; i < profile->record_count; i++)
      add_record(&tables, i);
    fprintf(
        out,
        "profile of %s on %ux%u: %" PRIu64 " cycles, %" PRIu64 " thread-cycles, %" PRIu64 " instructions\n\n"
        "A thread's cycle belongs to the instruction that it issues or that is kept from issuing; a branch bubble\n"
        "to the branch. own: of the function or line itself; all: of what it calls, too, and of what is inlined\n"
        "into it. load-h%%: loads through the data cache that hit. Causes are per cent of the row's own cycles; -c\n"
        "is a conflict at the shared unit. What never occurs has no column.\n",
        loaded ? trax_image_path(loaded->image) : "a program", machine->config.chip.tms,
        machine->config.chip.tps_per_tm, machine->stats.cycles, machine->stats.threads * machine->stats.cycles,
        machine->stats.instructions);
    print_table(&tables, out, tables.functions, "Functions");
    print_table(&tables, out, tables.lines, "Lines");
  }
  free(tables.functions);
  free(tables.lines);
  free(tables.seen);
  return complete ? TRAX_OK : trax_fail(error, "out of memory for the profile");
}

/* --- folded stacks --- */

/* Stacks with equal texts are one: contexts and instructions may differ in their addresses alone. */
struct folded {
  const struct trax_profile *profile;
  struct trax_texts texts;  /* of calls, and of what an instruction adds to them */
  uint32_t *calls;          /* [contexts]: the text of its calls, the outermost first; of context 0 "" */
  uint32_t *places;         /* [places]: the instruction's functions and line; 0: not needed yet */
  struct trax_map stack_of; /* (calls, place) */
  struct folded_stack *stacks;
  size_t count, capacity;
};

struct folded_stack {
  uint32_t calls, place;
  uint64_t cycles[TRAX_CAUSE_COUNT];
};

struct line {
  char *text;
  uint64_t cycles;
};

static int by_text(const void *a, const void *b) {
  return strcmp(((const struct line *)a)->text, ((const struct line *)b)->text);
}

/* Writes a frame of the stack, without the characters that separate frames and stacks. */
static void put_frame(FILE *out, const char *name) {
  for (; *name; name++)
    fputc(*name == ';' || *name == '\n' ? ':' : *name, out);
  fputc(';', out);
}

/* Returns the number of a text: `before`, the functions of a place and, with_line, its line; 0: out of memory. */
static uint32_t text_of(struct folded *folded, const char *before, uint32_t index, bool with_line) {
  struct trax_places *places = folded->profile->reader.explain->places;
  const struct trax_place *place = trax_places_at(places, index);
  char *text = NULL;
  size_t size;
  FILE *out = open_memstream(&text, &size);
  if (!out)
    return 0;
  fputs(before, out);
  for (uint32_t i = place->frame_count; i--;)
    put_frame(out, trax_places_name(places, place->frames[i].function));
  if (with_line && place->frames->line) {
    const char *line = trax_places_name(places, place->frames->line), *slash = strrchr(line, '/');
    put_frame(out, slash ? slash + 1 : line);
  }
  const uint32_t number = fclose(out) == 0 ? trax_texts_number(&folded->texts, text) : 0;
  free(text);
  return number;
}

static bool add_stack(struct folded *folded, const struct trax_profile_record *record) {
  uint32_t *place = &folded->places[record->index];
  if (!*place && !(*place = text_of(folded, "", record->index, true)))
    return false;
  const uint32_t calls = folded->calls[record->context];
  const struct trax_map_entry *entry =
      trax_map_put(&folded->stack_of, sizeof *entry, (uint64_t)calls << 32 | *place, (uint32_t)folded->count);
  if (!entry || !trax_grow((void **)&folded->stacks, folded->count, &folded->capacity, sizeof *folded->stacks))
    return false;
  const uint32_t number = entry->value;
  if (number == folded->count)
    folded->stacks[folded->count++] = (struct folded_stack){.calls = calls, .place = *place};
  for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++)
    folded->stacks[number].cycles[cause] += record->counts.cycles[cause];
  return true;
}

static bool fold(struct folded *folded) {
  const struct trax_profile *profile = folded->profile;
  folded->calls = calloc(profile->context_count, sizeof *folded->calls);
  folded->places = calloc((size_t)trax_places_count(profile->reader.explain->places) + 2, sizeof *folded->places);
  bool complete = folded->calls && folded->places;
  for (size_t i = 1; complete && i < profile->context_count; i++) { /* a parent precedes its contexts */
    const struct trax_profile_context *context = &profile->contexts[i];
    const char *calls = trax_texts_at(&folded->texts, folded->calls[context->parent]);
    complete = (folded->calls[i] = text_of(folded, calls, context->index, false)) != 0;
  }
  for (size_t i = 0; complete && i < profile->record_count; i++)
    complete = add_stack(folded, &profile->records[i]);
  return complete;
}

static void put_lines(struct line *lines, size_t count, FILE *out) {
  qsort(lines, count, sizeof *lines, by_text);
  for (size_t i = 0; i < count;) { /* a function may be called in one stack and inlined in another */
    const char *text = lines[i].text;
    uint64_t cycles = 0;
    for (; i < count && strcmp(lines[i].text, text) == 0; i++)
      cycles += lines[i].cycles;
    fprintf(out, "%s %" PRIu64 "\n", text, cycles);
  }
}

trax_status trax_profile_put_folded(void *self, FILE *out, trax_error *error) {
  const struct trax_profile *profile = self;
  struct folded folded = {.profile = profile};
  bool complete = fold(&folded);
  size_t count = 0;
  struct line *lines = complete ? calloc(folded.count * TRAX_CAUSE_COUNT + 1, sizeof *lines) : NULL;
  complete = lines != NULL;
  for (size_t i = 0; complete && i < folded.count; i++)
    for (unsigned cause = 0; complete && cause < TRAX_CAUSE_COUNT; cause++)
      if (folded.stacks[i].cycles[cause]) {
        const char *calls = trax_texts_at(&folded.texts, folded.stacks[i].calls);
        const char *place = trax_texts_at(&folded.texts, folded.stacks[i].place);
        const size_t size = strlen(calls) + strlen(place) + strlen(trax_cause_names[cause]) + 1;
        if ((complete = (lines[count].text = malloc(size)) != NULL)) {
          snprintf(lines[count].text, size, "%s%s%s", calls, place, trax_cause_names[cause]);
          lines[count++].cycles = folded.stacks[i].cycles[cause];
        }
      }
  if (complete)
    put_lines(lines, count, out);
  for (size_t i = 0; i < count; i++)
    free(lines[i].text);
  free(lines);
  free(folded.calls);
  free(folded.places);
  free(folded.stacks);
  trax_map_free(&folded.stack_of);
  trax_texts_free(&folded.texts);
  return complete ? TRAX_OK : trax_fail(error, "out of memory for the folded profile");
}
