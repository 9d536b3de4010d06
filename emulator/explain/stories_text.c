/* Stories as a member of the page, and as text. */
#include "explain/page.h"
#include "explain/places.h"
#include "explain/ray_kinds.h"
#include "explain/stories.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

static void put_cycles(FILE *out, const uint32_t *cycles) {
  for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++) {
    putc_unlocked(',', out);
    trax_page_decimal(out, cycles[cause]);
  }
  putc_unlocked(']', out);
}

/* The causes are in the order of the statistics. */
void trax_stories_put_member(struct trax_explain *explain, FILE *out) {
  size_t count = 0;
  const struct trax_story *story = explain->stories ? trax_stories_sorted(explain->stories, &count) : NULL;
  fputs("\"stories\": [\n", out);
  for (size_t i = 0; i < count; i++, story++) {
    fprintf(out,
            "{\"place\": %" PRIu32 ", \"thread\": %" PRIu32 ", \"begin\": %" PRIu64 ", \"cycles\": %" PRIu64
            ", \"interval\": %" PRIu64 ",\n\"code\": [",
            story->place, story->thread, story->begin, story->cycles, story->interval);
    for (size_t k = 0; k < story->code_count; k++) {
      fprintf(out, "%s[%" PRIu32, k ? ",\n" : "", trax_places_pc(explain->places, story->code[k].index));
      put_cycles(out, story->code[k].cycles);
    }
    fputs("],\n\"rays\": [", out);
    for (size_t k = 0; k < story->ray_count; k++) {
      fprintf(out, "%s[%u,%" PRIu64, k ? ",\n" : "", story->rays[k].kind, story->rays[k].begin);
      put_cycles(out, story->rays[k].cycles);
    }
    fputs("],\n\"time\": [", out);
    for (uint64_t k = 0; k * story->interval < story->cycles; k++) {
      fprintf(out, "%s[%" PRIu64, k ? ",\n" : "", k * story->interval);
      put_cycles(out, story->time[k]);
    }
    fputs("]},\n", out);
  }
  fputs("null],\n", out);
}

/* --- text --- */

enum { MOST_ROWS = 12, CAUSES_SHOWN = 3 };

/* The sum of a function's or a line's instructions. */
struct sum {
  uint32_t name; /* of trax_places */
  uint64_t total, cycles[TRAX_CAUSE_COUNT];
};

static uint64_t total_of(const uint32_t *cycles) {
  uint64_t sum = 0;
  for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++)
    sum += cycles[cause];
  return sum;
}

static double percent(uint64_t part, uint64_t whole) {
  return whole ? 100 * (double)part / (double)whole : 0;
}

/* The costliest causes, waits and issues alike, in per cent of their sum. */
static void put_causes(FILE *out, const uint64_t *cycles, uint64_t total) {
  bool shown[TRAX_CAUSE_COUNT] = {false};
  for (unsigned n = 0; n < CAUSES_SHOWN; n++) {
    unsigned most = TRAX_CAUSE_COUNT;
    for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++)
      if (!shown[cause] && cycles[cause] && (most == TRAX_CAUSE_COUNT || cycles[cause] > cycles[most]))
        most = cause;
    if (most == TRAX_CAUSE_COUNT)
      break;
    shown[most] = true;
    fprintf(out, "%s%s %.1f %%", n ? ", " : "", trax_cause_names[most], percent(cycles[most], total));
  }
  fputc('\n', out);
}

static void put_row(FILE *out, const char *name, int width, const uint64_t *cycles, uint64_t whole) {
  uint64_t total = 0;
  for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++)
    total += cycles[cause];
  fprintf(out, "  %-*s %9" PRIu64 " %5.1f %% %12" PRIu64 "  ", width, name, total, percent(total, whole),
          cycles[TRAX_CAUSE_ISSUED]);
  put_causes(out, cycles, total);
}

static void widen(uint64_t *to, const uint32_t *cycles) {
  for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++)
    to[cause] = cycles[cause];
}

/* The caller's rays of a pixel. */
static const struct trax_explore_ray *rays_at(const struct trax_explore_picture *picture, uint32_t place,
                                              size_t *count) {
  size_t first = 0;
  while (first < picture->ray_count && picture->rays[first].place != place)
    first++;
  for (*count = 0; first + *count < picture->ray_count && picture->rays[first + *count].place == place;)
    ++*count;
  return picture->rays + first;
}

static void put_known(const struct trax_explain *explain, const struct trax_explore_ray *ray, FILE *out) {
  const char *hit = ray->material != TRAX_NO_MATERIAL ? explain->picture.materials[ray->material]
                    : ray->hit                        ? "yes"
                                                      : "no";
  fprintf(out, "  %-14s %-20s ", trax_ray_kind_names[ray->kind], hit);
  if (explain->picture.has_instances && ray->instance != TRAX_NO_INSTANCE)
    fprintf(out, "%8" PRIu32 " ", ray->instance);
  else if (explain->picture.has_instances)
    fprintf(out, "%8s ", "-");
  fprintf(out, "%7" PRIu32 " %9" PRIu32, ray->nodes, ray->triangles);
}

static void put_rays(const struct trax_explain *explain, const struct trax_story *story, FILE *out) {
  uint64_t cycles[TRAX_CAUSE_COUNT];
  size_t count;
  const struct trax_explore_ray *rays = rays_at(&explain->picture, story->place, &count);
  if (!count) /* of another program, or none */
    return;
  const bool apart = explain->picture.counted_apart && count + 1 == story->ray_count;
  const bool instances = explain->picture.has_instances;
  fprintf(out, "\n%-16s %-20s %s%7s %9s", "Rays", "hit", instances ? "instance " : "", "nodes", "triangles");
  fprintf(out, apart ? " %11s %7s %12s  causes\n" : "\n", "cycles", "share", "instructions");
  for (size_t i = 0; i < count + apart; i++) {
    if (apart && i == 0)
      fprintf(out, "  %-*s", instances ? 62 : 53, "before the first");
    else
      put_known(explain, &rays[i - apart], out);
    if (!apart) {
      fputc('\n', out);
      continue;
    }
    widen(cycles, story->rays[i].cycles);
    put_row(out, "", 0, cycles, story->cycles);
  }
  if (!apart)
    fputs("The program counts a pixel's rays together, so that their cycles are not known apart: see --mark-rays.\n",
          out);
}

static int by_total(const void *a, const void *b) {
  const struct sum *x = a, *y = b;
  if (x->total != y->total)
    return x->total > y->total ? -1 : 1;
  return x->name < y->name ? -1 : x->name > y->name;
}

static trax_status put_sums(struct trax_explain *explain, const struct trax_story *story, bool lines, FILE *out,
                            trax_error *error) {
  struct sum *sums = trax_explain_array(story->code_count, sizeof *sums, error);
  size_t count = 0;
  if (!sums)
    return TRAX_ERROR;
  for (size_t i = 0; i < story->code_count; i++) {
    const struct trax_frame_place *frame = trax_places_at(explain->places, story->code[i].index)->frames;
    const uint32_t name = lines ? frame->line : frame->function;
    size_t at = 0;
    while (at < count && sums[at].name != name)
      at++;
    count += at == count;
    sums[at].name = name;
    sums[at].total += total_of(story->code[i].cycles);
    for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++)
      sums[at].cycles[cause] += story->code[i].cycles[cause];
  }
  if (count)
    qsort(sums, count, sizeof *sums, by_total);
  fprintf(out, "\n%-30s %13s %7s %12s  causes\n", lines ? "Lines" : "Functions", "cycles", "share", "instructions");
  for (size_t i = 0; i < count && i < MOST_ROWS; i++) {
    const char *name = trax_places_name(explain->places, sums[i].name), *slash = lines ? strrchr(name, '/') : NULL;
    put_row(out, slash ? slash + 1 : *name ? name : "(no line is known)", 32, sums[i].cycles, story->cycles);
  }
  if (count > MOST_ROWS)
    fprintf(out, "  and %zu more\n", count - MOST_ROWS);
  free(sums);
  return TRAX_OK;
}

static void put_time(const struct trax_story *story, FILE *out) {
  enum { ROWS = 16 };
  const uint64_t intervals = (story->cycles + story->interval - 1) / story->interval,
                 together = (intervals + ROWS - 1) / ROWS;
  fprintf(out, "\n%-44s %7s %12s  causes\n", "From cycle", "", "instructions");
  for (uint64_t i = 0; i < intervals; i += together) {
    char name[32];
    uint64_t cycles[TRAX_CAUSE_COUNT] = {0};
    for (uint64_t k = i; k < i + together && k < intervals; k++)
      for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++)
        cycles[cause] += story->time[k][cause];
    snprintf(name, sizeof name, "%" PRIu64, story->begin + i * story->interval);
    put_row(out, name, 32, cycles, story->cycles);
  }
}

static trax_status put_story(struct trax_explain *explain, const struct trax_story *story, FILE *out,
                             trax_error *error) {
  const uint32_t width = explain->picture.width ? explain->picture.width : 1,
                 tps = explain->machine->config.chip.tps_per_tm;
  uint64_t all[TRAX_CAUSE_COUNT] = {0};
  for (size_t i = 0; i < story->code_count; i++)
    for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++)
      all[cause] += story->code[i].cycles[cause];
  fprintf(out,
          "Pixel (%" PRIu32 ", %" PRIu32 "): %" PRIu64 " cycles, %" PRIu64 " instructions\n"
          "Thread %" PRIu32 " (TM %" PRIu32 ", TP %" PRIu32 "), cycles %" PRIu64 " to %" PRIu64 " of %" PRIu64 "\n",
          story->place % width, story->place / width, story->cycles, all[TRAX_CAUSE_ISSUED], story->thread,
          story->thread / tps, story->thread % tps, story->begin, story->begin + story->cycles,
          explain->machine->stats.cycles);
  put_rays(explain, story, out);
  fprintf(out, "\n%-30s %13s %7s\n", "Causes", "cycles", "share");
  for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++)
    if (all[cause])
      fprintf(out, "  %-32s %9" PRIu64 " %5.1f %%  %s\n", trax_cause_names[cause], all[cause],
              percent(all[cause], story->cycles), trax_cause_meanings[cause]);
  trax_status status = put_sums(explain, story, false, out, error);
  if (status == TRAX_OK)
    status = put_sums(explain, story, true, out, error);
  put_time(story, out);
  return status;
}

trax_status trax_stories_put(void *items, FILE *out, trax_error *error) {
  struct trax_explain *explain = ((struct trax_reader *)items)->explain;
  const struct trax_explain_options *options = &explain->options;
  const uint32_t width = explain->picture.width ? explain->picture.width : 1;
  size_t count;
  if (!explain->stories)
    return trax_fail(error, "the program has too many instructions for the stories of pixels");
  const struct trax_story *stories = trax_stories_sorted(explain->stories, &count);
  trax_status status = TRAX_OK;
  for (unsigned i = 0; i < options->story_count && status == TRAX_OK; i++) {
    bool found = false;
    fputs(i ? "\n" : "", out);
    for (size_t k = 0; k < count && status == TRAX_OK; k++)
      if (stories[k].place == options->story_places[i]) {
        status = put_story(explain, &stories[k], out, error);
        found = true;
      }
    if (!found)
      fprintf(out, "Pixel (%" PRIu32 ", %" PRIu32 "): the run ended before it\n", options->story_places[i] % width,
              options->story_places[i] / width);
  }
  return status;
}
