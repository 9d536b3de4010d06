/* The cost of each pixel, as false colours and as numbers. */
#include "render.h"
#include "trax/explain.h"
#include "trax/output.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

/* Any other cost is a cause (trax_stats_cause); instructions are the cycles issued. */
enum { COST_ISSUED, COST_CYCLES = 1 << 16 };

trax_status trax_cost_find(const char *name, unsigned *what, trax_error *error) {
  if (strcmp(name, "cycles") == 0) {
    *what = COST_CYCLES;
    return TRAX_OK;
  }
  if (strcmp(name, "instructions") == 0) {
    *what = COST_ISSUED;
    return TRAX_OK;
  }
  for (*what = COST_ISSUED + 1; trax_stats_cause(*what + 1); ++*what) /* all but the last, which no pixel has */
    if (strcmp(name, trax_stats_cause(*what)) == 0)
      return TRAX_OK;
  return trax_fail(
      error, "--cost: '%s' is none of cycles, instructions, and causes as wait_memory (trax-sim --help-stats)", name);
}

trax_status trax_costs_init(struct trax_costs *costs, uint32_t width, uint32_t height, const char *name,
                            trax_error *error) {
  *costs = (struct trax_costs){.width = width, .height = height, .name = name};
  if (trax_cost_find(name, &costs->what, error) != TRAX_OK)
    return TRAX_ERROR;
  costs->values = calloc((size_t)width * height, sizeof *costs->values);
  return costs->values ? TRAX_OK : trax_fail(error, "out of memory for the cost of %u x %u pixels", width, height);
}

void trax_costs_release(struct trax_costs *costs) {
  free(costs->values);
  costs->values = NULL;
}

void trax_costs_add(void *context, const struct trax_item_cost *cost, bool last) {
  struct trax_costs *costs = context;
  uint64_t value = costs->what == COST_CYCLES ? cost->end - cost->begin : cost->cycles[costs->what];
  if (!last && cost->place < (uint64_t)costs->width * costs->height)
    costs->values[cost->place] += value;
  else
    costs->elsewhere += value;
}

/* --- in numbers --- */

static int ascending(const void *a, const void *b) {
  const uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
  return (x > y) - (x < y);
}

trax_status trax_costs_summarise(const struct trax_costs *costs, struct trax_cost_summary *summary, trax_error *error) {
  const size_t count = (size_t)costs->width * costs->height;
  uint64_t *sorted = malloc(count * sizeof *sorted);
  if (!sorted)
    return trax_fail(error, "out of memory for the cost of %zu pixels", count);
  memcpy(sorted, costs->values, count * sizeof *sorted);
  qsort(sorted, count, sizeof *sorted, ascending);
  *summary = (struct trax_cost_summary){.least = sorted[0],
                                        .median = sorted[count / 2],
                                        .most = sorted[count - 1],
                                        .white = sorted[count - 1 - count / 100]};
  for (size_t i = 0; i < count; i++)
    summary->sum += sorted[i];
  free(sorted);
  return TRAX_OK;
}

/* Rows of a PFM go from the bottom up; a negative scale means little endian. */
static void write_pfm(const struct trax_costs *costs, FILE *out) {
  fprintf(out, "Pf\n%u %u\n-1.0\n", costs->width, costs->height);
  for (uint32_t y = costs->height; y-- > 0;)
    for (uint32_t x = 0; x < costs->width; x++) {
      const float value = (float)costs->values[(size_t)y * costs->width + x];
      fwrite(&value, sizeof value, 1, out);
    }
}

static void write_csv(const struct trax_costs *costs, FILE *out) {
  fprintf(out, "x,y,%s\n", costs->name);
  for (uint32_t y = 0; y < costs->height; y++)
    for (uint32_t x = 0; x < costs->width; x++)
      fprintf(out, "%u,%u,%" PRIu64 "\n", x, y, costs->values[(size_t)y * costs->width + x]);
}

trax_status trax_costs_write(const struct trax_costs *costs, const char *path, trax_error *error) {
  const char *suffix = strrchr(path, '.');
  trax_output output;
  if (trax_output_open(&output, path, error) != TRAX_OK)
    return TRAX_ERROR;
  if (suffix && strcmp(suffix, ".pfm") == 0)
    write_pfm(costs, output.file);
  else
    write_csv(costs, output.file);
  return trax_output_commit(&output, error);
}

/* --- in colours --- */

/* The colours from 0 to the white of the summary, at equal distances. */
static const struct {
  const char *name;
  uint8_t rgb[3];
} colours[] = {{"black", {0, 0, 0}},       {"blue", {40, 40, 220}},    {"violet", {160, 30, 170}},
               {"orange", {240, 110, 20}}, {"yellow", {255, 230, 60}}, {"white", {255, 255, 255}}};
enum { STEPS = sizeof colours / sizeof *colours - 1 };

static uint32_t colour_of(uint64_t value, uint64_t white) {
  if (!white || value >= white)
    return value ? 0xFFFFFFFFu : 0xFF000000u;
  const uint64_t place = value * STEPS * 256 / white; /* step and 256ths of it */
  const uint64_t step = place / 256, part = place % 256;
  uint32_t pixel = 0xFF000000u;
  for (unsigned channel = 0; channel < 3; channel++) {
    const uint64_t from = colours[step].rgb[channel], to = colours[step + 1].rgb[channel];
    pixel |= (uint32_t)((from * (256 - part) + to * part) / 256) << 8 * channel;
  }
  return pixel;
}

static trax_status paint(const struct trax_costs *costs, const struct trax_cost_summary *summary,
                         struct trax_picture *picture, trax_error *error) {
  if (trax_picture_init(picture, costs->width, costs->height, error) != TRAX_OK)
    return TRAX_ERROR;
  for (size_t i = 0; i < (size_t)costs->width * costs->height; i++)
    picture->pixels[i] = colour_of(costs->values[i], summary->white);
  return TRAX_OK;
}

trax_status trax_costs_write_picture(const struct trax_costs *costs, const struct trax_cost_summary *summary,
                                     const char *path, trax_error *error) {
  struct trax_picture picture;
  if (paint(costs, summary, &picture, error) != TRAX_OK)
    return TRAX_ERROR;
  const trax_status status = trax_picture_write(&picture, path, error);
  trax_picture_release(&picture);
  return status;
}

void trax_costs_print(const struct trax_costs *costs, const struct trax_cost_summary *summary, FILE *out) {
  fprintf(out,
          "cost        %s of a pixel: %" PRIu64 " to %" PRIu64 ", median %" PRIu64 ", sum %" PRIu64 ", and %" PRIu64
          " for no pixel\n            ",
          costs->name, summary->least, summary->most, summary->median, summary->sum, costs->elsewhere);
  for (unsigned i = 0; i <= STEPS; i++)
    fprintf(out, "%s%s %" PRIu64, i ? ", " : "", colours[i].name, summary->white * i / STEPS);
  fprintf(out, " and more\n");
}
