/* A profile for the page: the call stacks as in --profile-folded, each instruction with its places and counts, and the
   sources. */
#include "explain/page.h"
#include "explain/profile.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

/* [pc or null, text, symbol, offset, [[function, line], ... from the innermost], [cycles by cause], loads, hits] */
static void put_instruction(const struct trax_profile *profile, uint32_t index,
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
  for (uint32_t i = 0; i < place->frame_count; i++)
    fprintf(out, "%s[%u, %u]", i ? ", " : "", place->frames[i].function, place->frames[i].line);
  fputs("], [", out);
  for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++)
    fprintf(out, "%s%" PRIu64, cause ? ", " : "", counts->cycles[cause]);
  fprintf(out, "], %" PRIu64 ", %" PRIu64 "],\n", counts->loads, counts->hits);
}

trax_status trax_profile_put_members(void *self, FILE *out, trax_error *error) {
  const struct trax_profile *profile = self;
  struct trax_places *places = profile->reader.explain->places;
  const uint32_t count = trax_places_count(places) + 2;
  struct trax_profile_counts *counts = trax_explain_array(count, sizeof *counts, error);
  if (!counts)
    return TRAX_ERROR;
  for (size_t i = 0; i < profile->record_count; i++)
    trax_profile_add(&counts[profile->records[i].index], &profile->records[i].counts);
  fputs("\"instructions\": [\n", out);
  for (uint32_t i = 0; i < count; i++)
    if (trax_profile_cycles(&counts[i]))
      put_instruction(profile, i, &counts[i], out);
  fputs("null],\n", out);
  free(counts);
  if (trax_page_text(out, "folded", trax_profile_put_folded, self, error) != TRAX_OK)
    return TRAX_ERROR;
  fputs("\"names\": [\"\"", out); /* after all look-ups */
  for (uint32_t name = 1; name <= trax_places_names(places); name++) {
    fputs(",\n", out);
    trax_page_quote(out, trax_places_name(places, name), strlen(trax_places_name(places, name)));
  }
  fputs("],\n", out);
  return trax_sources_put(profile->reader.explain, out, error);
}
