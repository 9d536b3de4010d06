#define _DEFAULT_SOURCE /* S_ISREG */
/* A profile for the page: the call stacks as in --profile-folded, each instruction with its places and counts, and the
   sources as far as they can be read. */
#include "explain/page.h"
#include "explain/profile.h"
#include "trax/input.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

static trax_status put_folded(const void *self, FILE *out, trax_error *error) {
  return trax_profile_write_folded(self, out, error);
}

/* [pc or null, text, symbol, offset, [[function, line], ... from the innermost], [cycles by cause], loads, hits] */
static void put_instruction(const struct trax_profile *profile, uint32_t index,
                            const struct trax_profile_counts *counts, FILE *out) {
  struct trax_places *places = profile->explain->places;
  const struct trax_place *place = trax_places_at(places, index);
  char text[128] = "";
  if (index < trax_places_count(places)) {
    const uint32_t pc = trax_places_pc(places, index);
    uint32_t word;
    memcpy(&word, profile->explain->machine->space.bytes + pc, sizeof word);
    trax_disassemble(word, pc, text, sizeof text);
    fprintf(out, "[%u, ", pc);
  } else {
    fputs("[null, ", out);
  }
  trax_page_quote(out, text, strlen(text));
  fputs(", ", out);
  trax_page_quote(out, place->symbol ? place->symbol : "", place->symbol ? strlen(place->symbol) : 0);
  fprintf(out, ", %u, [", place->offset);
  for (uint32_t i = 0; i < place->frame_count; i++)
    fprintf(out, "%s[%u, %u]", i ? ", " : "", place->frames[i].function, place->frames[i].line);
  fputs("], [", out);
  for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++)
    fprintf(out, "%s%" PRIu64, cause ? ", " : "", counts->cycles[cause]);
  fprintf(out, "], %" PRIu64 ", %" PRIu64 "],\n", counts->loads, counts->hits);
}

/* --- sources --- */

static bool is_new(char *const *paths, size_t count, const char *line, size_t length) {
  for (size_t i = 0; i < count; i++)
    if (strncmp(paths[i], line, length) == 0 && paths[i][length] == 0)
      return false;
  return true;
}

/* A file that is missing, too long or no file is left out. */
static void put_source(const char *path, FILE *out) {
  trax_error ignored;
  trax_input input;
  if (trax_input_open(&input, path, &ignored) != TRAX_OK)
    return;
  if (input.is_regular && input.expected <= TRAX_TEXT_LIMIT &&
      trax_input_read(&input, TRAX_TEXT_LIMIT, &ignored) == TRAX_OK) {
    trax_page_quote(out, path, strlen(path));
    fputs(": ", out);
    trax_page_quote(out, (const char *)input.bytes, input.size);
    fputs(",\n", out);
  }
  trax_input_close(&input);
}

static trax_status put_sources(struct trax_places *places, FILE *out, trax_error *error) {
  const uint32_t names = trax_places_names(places);
  char **paths = calloc(names + 1, sizeof *paths);
  size_t count = 0;
  bool complete = paths != NULL;
  fputs("\"sources\": {\n", out);
  for (uint32_t name = 1; complete && name <= names; name++) {
    const char *line = trax_places_name(places, name), *colon = strrchr(line, ':');
    if (!colon || line[0] == '(' || !colon[1] || strspn(colon + 1, "0123456789") != strlen(colon + 1) ||
        !is_new(paths, count, line, (size_t)(colon - line)))
      continue;
    paths[count] = malloc((size_t)(colon - line) + 1);
    complete = paths[count] != NULL;
    if (!complete)
      break;
    memcpy(paths[count], line, (size_t)(colon - line));
    paths[count][colon - line] = 0;
    put_source(paths[count++], out);
  }
  fputs("\"\": \"\"},\n", out);
  for (size_t i = 0; i < count; i++)
    free(paths[i]);
  free(paths);
  return complete ? TRAX_OK : trax_fail(error, "out of memory for the page's sources");
}

trax_status trax_profile_put_members(void *self, FILE *out, trax_error *error) {
  const struct trax_profile *profile = self;
  struct trax_places *places = profile->explain->places;
  const uint32_t count = trax_places_count(places) + 2;
  struct trax_profile_counts *counts = calloc(count, sizeof *counts);
  if (!counts || profile->out_of_memory) {
    free(counts);
    return trax_fail(error, "out of memory for the profile");
  }
  for (size_t i = 0; i < profile->record_count; i++)
    trax_profile_add(&counts[profile->records[i].index], &profile->records[i].counts);
  fputs("\"instructions\": [\n", out);
  for (uint32_t i = 0; i < count; i++)
    if (trax_profile_cycles(&counts[i]))
      put_instruction(profile, i, &counts[i], out);
  fputs("null],\n", out);
  free(counts);
  if (trax_page_text(out, "folded", put_folded, profile, error) != TRAX_OK)
    return TRAX_ERROR;
  fputs("\"names\": [\"\"", out); /* after all look-ups */
  for (uint32_t name = 1; name <= trax_places_names(places); name++) {
    fputs(",\n", out);
    trax_page_quote(out, trax_places_name(places, name), strlen(trax_places_name(places, name)));
  }
  fputs("],\n", out);
  return put_sources(places, out, error);
}
