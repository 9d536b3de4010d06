/* A profile for the page: the call stacks as in --profile-folded, each instruction with its places and counts, and the
   sources. */
#include "explain/page.h"
#include "explain/profile.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

/* The numbers of names in the page, by first use: other files beside it look names up in an order of their own. */
struct numbers {
  uint32_t *of_name, *name; /* [names + 1] */
  uint32_t count;
};

static uint32_t number_of(struct numbers *numbers, uint32_t name) {
  if (name && !numbers->of_name[name]) {
    numbers->of_name[name] = ++numbers->count;
    numbers->name[numbers->count] = name;
  }
  return numbers->of_name[name];
}

/* [pc or null, text, symbol, offset, [[function, line], ... from the innermost], [cycles by cause], loads, hits] */
static void put_instruction(const struct trax_profile *profile, struct numbers *numbers, uint32_t index,
                            const struct trax_profile_counts *counts, FILE *out) {
  struct trax_places *places = profile->reader.explain->places;
  const struct trax_place *place = trax_places_at(places, index);
  char text[128] = "";
  if (index < trax_places_count(places)) {
    const uint32_t pc = trax_places_pc(places, index);
    uint32_t word;
    memcpy(&word, profile->reader.explain->machine->space.bytes + pc, sizeof word);
    trax_disassemble(word, pc, text, sizeof text);
    fprintf(out, "[%u, ", pc);
  } else {
    fputs("[null, ", out);
  }
  trax_page_quote(out, text, strlen(text));
  fputs(", ", out);
  trax_page_quote(out, place->symbol ? place->symbol : "", place->symbol ? strlen(place->symbol) : 0);
  fprintf(out, ", %u, [", place->offset);
  for (uint32_t i = 0; i < place->frame_count; i++) {
    const uint32_t function = number_of(numbers, place->frames[i].function);
    fprintf(out, "%s[%u, %u]", i ? ", " : "", function, number_of(numbers, place->frames[i].line));
  }
  fputs("], [", out);
  for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++)
    fprintf(out, "%s%" PRIu64, cause ? ", " : "", counts->cycles[cause]);
  fprintf(out, "], %" PRIu64 ", %" PRIu64 "],\n", counts->loads, counts->hits);
}

static trax_status put_members(struct trax_profile *profile, struct numbers *numbers,
                               const struct trax_profile_counts *counts, FILE *out, trax_error *error) {
  const struct trax_places *places = profile->reader.explain->places;
  fputs("\"instructions\": [\n", out);
  for (uint32_t i = 0; i < trax_places_count(places) + 2; i++)
    if (trax_profile_cycles(&counts[i]))
      put_instruction(profile, numbers, i, &counts[i], out);
  fputs("null],\n", out);
  if (trax_page_text(out, "folded", trax_profile_put_folded, profile, error) != TRAX_OK)
    return TRAX_ERROR;
  fputs("\"names\": [\"\"", out);
  for (uint32_t i = 1; i <= numbers->count; i++) {
    const char *name = trax_places_name(places, numbers->name[i]);
    fputs(",\n", out);
    trax_page_quote(out, name, strlen(name));
  }
  fputs("],\n", out);
  return trax_sources_put(profile->reader.explain, numbers->name + 1, numbers->count, out, error);
}

trax_status trax_profile_put_members(void *self, FILE *out, trax_error *error) {
  struct trax_profile *profile = self;
  struct trax_places *places = profile->reader.explain->places;
  const uint32_t count = trax_places_count(places) + 2;
  struct trax_profile_counts *counts = trax_explain_array(count, sizeof *counts, error);
  if (!counts)
    return TRAX_ERROR;
  for (size_t i = 0; i < profile->record_count; i++)
    trax_profile_add(&counts[profile->records[i].index], &profile->records[i].counts);
  for (uint32_t i = 0; i < count; i++) /* so that the number of names is final */
    if (trax_profile_cycles(&counts[i]))
      trax_places_at(places, i);
  const size_t names = (size_t)trax_places_names(places) + 1;
  struct numbers numbers = {trax_explain_array(names, sizeof *numbers.of_name, error),
                            trax_explain_array(names, sizeof *numbers.name, error), 0};
  const trax_status status =
      numbers.of_name && numbers.name ? put_members(profile, &numbers, counts, out, error) : TRAX_ERROR;
  free(numbers.of_name);
  free(numbers.name);
  free(counts);
  return status;
}
