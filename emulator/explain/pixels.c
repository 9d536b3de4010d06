/* The cost of each item, by its place, for the picture of the page. */
#include "explain/page.h"
#include "explain/ray_kinds.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

enum { THREAD, BEGIN, MORE, CAUSES, RAYS = CAUSES + TRAX_CAUSE_COUNT, COLUMNS = RAYS + TRAX_RAY_KIND_COUNT };

struct trax_pixels {
  size_t places;
  uint64_t *columns;                    /* [COLUMNS][places]; thread: its number + 1, and 0 where no item was */
  uint64_t elsewhere[TRAX_CAUSE_COUNT]; /* thread-cycles after a thread's last item, and of items without a place */
  bool any[COLUMNS];                    /* whether the column has another number than 0 */
};

struct trax_pixels *trax_pixels_create(size_t places) {
  struct trax_pixels *pixels = calloc(1, sizeof *pixels);
  if (!pixels)
    return NULL;
  pixels->places = places;
  pixels->columns = calloc(places * COLUMNS + 1, sizeof *pixels->columns); /* unused columns take no memory */
  if (pixels->columns)
    return pixels;
  free(pixels);
  return NULL;
}

void trax_pixels_destroy(struct trax_pixels *pixels) {
  if (pixels)
    free(pixels->columns);
  free(pixels);
}

static uint64_t *at(struct trax_pixels *pixels, unsigned column, size_t place) {
  return &pixels->columns[column * pixels->places + place];
}

static void add(struct trax_pixels *pixels, unsigned column, size_t place, uint64_t count) {
  if (!count)
    return;
  *at(pixels, column, place) += count;
  pixels->any[column] = true;
}

void trax_pixels_add(struct trax_pixels *pixels, const struct trax_item_cost *cost, bool last) {
  if (last || cost->place >= pixels->places) {
    for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++)
      pixels->elsewhere[cause] += cost->cycles[cause];
    return;
  }
  add(pixels, MORE, cost->place, *at(pixels, THREAD, cost->place) != 0);
  *at(pixels, THREAD, cost->place) = cost->thread + 1;
  *at(pixels, BEGIN, cost->place) = cost->begin;
  pixels->any[THREAD] = pixels->any[BEGIN] = true;
  for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++)
    add(pixels, CAUSES + cause, cost->place, cost->cycles[cause]);
  for (unsigned kind = 0; kind < TRAX_RAY_KIND_COUNT; kind++)
    add(pixels, RAYS + kind, cost->place, cost->rays[kind]);
}

/* --- writing --- */

static void put_name(FILE *members, const char *group, const char *name, const char *unit, const char *meaning) {
  const char *const texts[] = {group, name, unit, meaning};
  for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
    fputs(i ? ", " : "[", members);
    trax_page_quote(members, texts[i], strlen(texts[i]));
  }
  fputs("],\n", members);
}

static void put_name_of(FILE *members, unsigned column) {
  static const char *const kind_meanings[] = {
#define MEANING(X, ID, NAME, NUMBER, MEANING) [NUMBER] = MEANING,
      TRAX_RAY_KINDS(MEANING, )
#undef MEANING
  };
  if (column == THREAD)
    put_name(members, "", "thread", "", "the thread's number + 1; 0: no item ended here");
  else if (column == BEGIN)
    put_name(members, "", "begin", "cycle", "the end of the thread's item before");
  else if (column == MORE)
    put_name(members, "", "more", "items", "items that ended here before; thread and begin are those of the last");
  else if (column < RAYS)
    put_name(members, "causes", trax_cause_names[column - CAUSES], "thread-cycles",
             trax_cause_meanings[column - CAUSES]);
  else
    put_name(members, "rays", trax_ray_kind_names[column - RAYS], "rays", kind_meanings[column - RAYS]);
}

/* Each channel as the differences from the pixel before, which repeat more. */
static void put_channel(FILE *columns, const struct trax_explore_picture *picture, size_t places, unsigned shift) {
  uint32_t before = 0;
  for (size_t i = 0; i < places; i++) {
    const uint32_t value = picture->pixels[i] >> shift & 255;
    trax_page_number(columns, (value - before) & 255);
    before = value;
  }
}

trax_status trax_pixels_put(struct trax_explain *explain, FILE *members, FILE *columns, trax_error *error) {
  const struct trax_pixels *pixels = explain->pixels;
  const struct trax_explore_picture *picture = &explain->picture;
  static const char *const channels[] = {"red", "green", "blue"};
  if (!pixels || !picture->width)
    return TRAX_OK;
  if ((uint64_t)picture->width * picture->height != pixels->places)
    return trax_fail(error, "the page's picture of %ux%u has another number of pixels than its buffer, %zu",
                     picture->width, picture->height, pixels->places);
  fprintf(members, "\"picture\": {\"width\": %u, \"height\": %u,\n\"columns\": [", picture->width, picture->height);
  for (unsigned column = 0; column < COLUMNS; column++) {
    if (!pixels->any[column])
      continue;
    put_name_of(members, column);
    for (size_t i = 0; i < pixels->places; i++)
      trax_page_number(columns, pixels->columns[column * pixels->places + i]);
  }
  for (const struct trax_explore_counts *counts = picture->counts; counts->values; counts++) {
    put_name(members, "counts", counts->name, counts->unit, counts->meaning);
    for (size_t i = 0; i < pixels->places; i++)
      trax_page_number(columns, counts->values[i]);
  }
  for (unsigned channel = 0; channel < 3; channel++) {
    put_name(members, "picture", channels[channel], "", "modulo 256, less the pixel before");
    put_channel(columns, picture, pixels->places, 8 * channel);
  }
  fputs("null],\n", members);
  if (!pixels->any[MORE] && trax_pixel_rays_put(explain, pixels->places, members, columns, error) != TRAX_OK)
    return TRAX_ERROR;
  fputs("\"elsewhere\": {", members);
  for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++)
    fprintf(members, "%s\"%s\": %" PRIu64, cause ? ", " : "", trax_cause_names[cause], pixels->elsewhere[cause]);
  fputs("}},\n", members);
  return TRAX_OK;
}
