#define _POSIX_C_SOURCE 200809L /* open_memstream, strdup */
/* Profiles as text: tables by function and line, folded stacks. */
#include "explain/profile.h"
#include "report/statistics.h"

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
  const struct trax_place *place = trax_places_at(tables->profile->explain->places, index);
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
  const struct trax_frame_place *innermost = trax_places_at(profile->explain->places, record->index)->frames;
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
  const struct trax_places *places = tables->profile->explain->places;
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

/* Looks up all places, so that the number of names is final. */
static void look_up_all(const struct trax_profile *profile) {
  for (size_t i = 0; i < profile->record_count; i++)
    trax_places_at(profile->explain->places, profile->records[i].index);
  for (size_t i = 1; i < profile->context_count; i++)
    trax_places_at(profile->explain->places, profile->contexts[i].index);
}

trax_status trax_profile_write(const struct trax_profile *profile, FILE *out, trax_error *error) {
  struct trax_places *places = profile->explain->places;
  const trax_machine *machine = profile->explain->machine;
  const struct trax_host *host = trax_host_of(machine);
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
        host ? trax_image_path(host->image) : "a program", machine->config.chip.tms, machine->config.chip.tps_per_tm,
        machine->stats.cycles, machine->stats.threads * machine->stats.cycles, machine->stats.instructions);
    print_table(&tables, out, tables.functions, "Functions");
    print_table(&tables, out, tables.lines, "Lines");
  }
  free(tables.functions);
  free(tables.lines);
  free(tables.seen);
  return complete ? TRAX_OK : trax_fail(error, "out of memory for the profile");
}

/* --- folded stacks --- */

struct stack {
  char *text;
  uint64_t cycles;
};

static int by_text(const void *a, const void *b) {
  return strcmp(((const struct stack *)a)->text, ((const struct stack *)b)->text);
}

/* Writes a frame of the stack, without the characters that separate frames and stacks. */
static void put_frame(FILE *out, const char *name) {
  for (; *name; name++)
    fputc(*name == ';' || *name == '\n' ? ':' : *name, out);
  fputc(';', out);
}

/* Writes the calls, the outermost first. */
static void put_calls(const struct trax_profile *profile, uint32_t context, FILE *out) {
  struct trax_places *places = profile->explain->places;
  uint32_t path[1024], depth = 0; /* more than profile.c's MAX_DEPTH */
  for (; context && depth < sizeof path / sizeof *path; context = profile->contexts[context].parent)
    path[depth++] = profile->contexts[context].index;
  while (depth) {
    const struct trax_place *place = trax_places_at(places, path[--depth]);
    for (uint32_t i = place->frame_count; i--;)
      put_frame(out, trax_places_name(places, place->frames[i].function));
  }
}

static char *stack_text(const struct trax_profile *profile, const struct trax_profile_record *record) {
  struct trax_places *places = profile->explain->places;
  const struct trax_place *place = trax_places_at(places, record->index);
  char *text = NULL;
  size_t size;
  FILE *out = open_memstream(&text, &size);
  if (!out)
    return NULL;
  put_calls(profile, record->context, out);
  for (uint32_t i = place->frame_count; i--;)
    put_frame(out, trax_places_name(places, place->frames[i].function));
  if (place->frames->line) {
    const char *line = trax_places_name(places, place->frames->line), *slash = strrchr(line, '/');
    put_frame(out, slash ? slash + 1 : line);
  }
  if (fclose(out) != 0) {
    free(text);
    return NULL;
  }
  return text;
}

trax_status trax_profile_write_folded(const struct trax_profile *profile, FILE *out, trax_error *error) {
  struct stack *stacks = calloc(profile->record_count * TRAX_CAUSE_COUNT + 1, sizeof *stacks);
  size_t count = 0;
  bool complete = stacks != NULL;
  for (size_t i = 0; complete && i < profile->record_count; i++) {
    char *text = stack_text(profile, &profile->records[i]);
    complete = text != NULL;
    for (unsigned cause = 0; complete && cause < TRAX_CAUSE_COUNT; cause++)
      if (profile->records[i].counts.cycles[cause]) {
        const size_t size = strlen(text) + strlen(trax_cause_names[cause]) + 1;
        complete = (stacks[count].text = malloc(size)) != NULL;
        if (!complete)
          break;
        snprintf(stacks[count].text, size, "%s%s", text, trax_cause_names[cause]);
        stacks[count++].cycles = profile->records[i].counts.cycles[cause];
      }
    free(text);
  }
  if (complete) {
    qsort(stacks, count, sizeof *stacks, by_text);
    for (size_t i = 0; i < count;) { /* instructions of one line have the same text and are added up */
      uint64_t cycles = 0;
      size_t first = i;
      for (; i < count && strcmp(stacks[i].text, stacks[first].text) == 0; i++)
        cycles += stacks[i].cycles;
      fprintf(out, "%s %" PRIu64 "\n", stacks[first].text, cycles);
    }
  }
  for (size_t i = 0; i < count; i++)
    free(stacks[i].text);
  free(stacks);
  return complete ? TRAX_OK : trax_fail(error, "out of memory for the folded profile");
}
