/* A thread lists its passages. At the end of an item the list is dropped, unless the item's story is kept: then it is
   added up. So is the list of a long item before its passages go away (explain/passages.h). */
#include "explain/stories.h"
#include "explain/passages.h"
#include "explain/places.h"
#include "explain/ray_kinds.h"
#include "trax/grow.h"

#include <stdlib.h>
#include <string.h>

/* The sums of passages. */
struct draft {
  uint32_t (*code)[TRAX_CAUSE_COUNT]; /* [places] */
  uint32_t *touched;                  /* [places]: indices of code that is not 0 */
  size_t touched_count;
  struct trax_story_ray *rays;
  size_t ray_count, ray_capacity;
  uint64_t now; /* cycles since the item's begin */
  uint64_t interval;
  uint32_t time[TRAX_STORY_INTERVALS][TRAX_CAUSE_COUNT];
};

struct story_thread {
  const struct trax_passage **passages; /* [count] */
  size_t count, capacity;
  uint64_t round;      /* of the first of them */
  uint32_t before;     /* the instruction before the first of them */
  uint32_t latest;     /* the instruction that it issued last */
  struct draft *draft; /* of what is no longer in the list; NULL: nothing */
};

struct trax_stories {
  struct trax_explain *explain;
  struct story_thread *threads;
  uint64_t thread_count;
  struct draft *draft; /* for items whose passages are all in a list */
  struct trax_story *stories;
  size_t count, capacity, costliest;
};

static size_t places_of(const struct trax_stories *stories) {
  return (size_t)trax_places_count(stories->explain->places) + 2;
}

/* --- drafts --- */

static void drop_draft(struct draft *draft) {
  if (!draft)
    return;
  free(draft->code);
  free(draft->touched);
  free(draft->rays);
  free(draft);
}

static bool begin_ray(struct draft *draft, unsigned kind) {
  if (!trax_grow((void **)&draft->rays, draft->ray_count, &draft->ray_capacity, sizeof *draft->rays))
    return false;
  draft->rays[draft->ray_count++] = (struct trax_story_ray){.kind = (uint8_t)kind, .begin = draft->now};
  return true;
}

static bool clear(struct draft *draft) {
  for (size_t i = 0; i < draft->touched_count; i++)
    memset(draft->code[draft->touched[i]], 0, sizeof *draft->code);
  memset(draft->time, 0, sizeof draft->time);
  draft->touched_count = draft->ray_count = 0;
  draft->now = 0;
  draft->interval = TRAX_STORY_FIRST_INTERVAL;
  return begin_ray(draft, TRAX_NO_RAY);
}

static struct draft *new_draft(struct trax_stories *stories) {
  struct draft *draft = calloc(1, sizeof *draft);
  if (draft) {
    draft->code = calloc(places_of(stories), sizeof *draft->code);
    draft->touched = calloc(places_of(stories), sizeof *draft->touched);
  }
  if (draft && draft->code && draft->touched && clear(draft))
    return draft;
  drop_draft(draft);
  stories->explain->out_of_memory = true;
  return NULL;
}

static void join_pairs(struct draft *draft) {
  for (unsigned i = 0; i < TRAX_STORY_INTERVALS; i++)
    for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++) {
      const uint32_t cycles = draft->time[i][cause];
      draft->time[i][cause] = 0;
      draft->time[i / 2][cause] += cycles;
    }
  draft->interval *= 2;
}

static void pass_time(struct draft *draft, unsigned cause, uint64_t cycles) {
  while (cycles) {
    while (draft->now >= TRAX_STORY_INTERVALS * draft->interval)
      join_pairs(draft);
    const uint64_t left = draft->interval - draft->now % draft->interval, part = cycles < left ? cycles : left;
    draft->time[draft->now / draft->interval][cause] += (uint32_t)part;
    draft->now += part;
    cycles -= part;
  }
}

static void add_code(struct draft *draft, uint32_t index, unsigned cause, uint32_t cycles) {
  uint32_t *code = draft->code[index], sum = 0;
  for (unsigned i = 0; i < TRAX_CAUSE_COUNT; i++)
    sum |= code[i];
  if (!sum)
    draft->touched[draft->touched_count++] = index;
  code[cause] += cycles;
}

static void add_cycles(struct draft *draft, unsigned cause, uint32_t cycles) {
  draft->rays[draft->ray_count - 1].cycles[cause] += cycles;
  pass_time(draft, cause, cycles);
}

static void add_issued(struct draft *draft, uint32_t index, uint32_t count) {
  for (uint32_t i = 0; i < count; i++)
    add_code(draft, index + i, TRAX_CAUSE_ISSUED, 1);
  add_cycles(draft, TRAX_CAUSE_ISSUED, count);
}

/* The cycles before the issue of an instruction, after which those of `issued` others before it have not been added. */
static void add_before(struct draft *draft, uint32_t index, unsigned cause, uint32_t cycles, uint32_t *issued) {
  add_issued(draft, index - *issued, *issued);
  *issued = 0;
  add_code(draft, index, cause, cycles);
  add_cycles(draft, cause, cycles);
}

/* latest: the instruction before the passage. False: out of memory. */
static bool add_passage(const struct trax_stories *stories, struct draft *draft, const struct trax_passage *passage,
                        uint32_t latest) {
  const uint8_t *const refusals = trax_places_refusals(stories->explain->places);
  const struct trax_charged *charged = passage->charged, *const end = charged + passage->charged_count;
  const uint8_t *const refused = passage->refused;
  const unsigned kind = trax_counted_kind(passage); /* of the ray that begins with the passage */
  uint32_t at = 0;                                  /* the number of the instruction in the passage */
  for (const struct trax_piece *piece = passage->piece; piece < passage->piece + passage->pieces; piece++) {
    uint32_t issued = 0;
    for (uint32_t index = piece->index; index < piece->index + piece->count; latest = index++, at++, issued++) {
      for (; charged < end && charged->at == at; charged++) {
        if (charged->cause == TRAX_CAUSE_HALTED) /* a halted thread ends no item */
          continue;
        add_issued(draft, index - issued, issued);
        issued = 0;
        add_code(draft, charged->cause == TRAX_CAUSE_BRANCH ? latest : index, charged->cause, charged->cycles);
        add_cycles(draft, charged->cause, charged->cycles);
      }
      if (refused && trax_refused_fetch(refused[at]))
        add_before(draft, index, TRAX_CAUSE_ICACHE_BANK, trax_refused_fetch(refused[at]), &issued);
      if (refused && trax_refused_others(refused[at]))
        add_before(draft, index, refusals[index], trax_refused_others(refused[at]), &issued);
    }
    if (kind != TRAX_NO_RAY && !begin_ray(draft, kind)) /* a trap, which is a passage of its own */
      return false;
    add_issued(draft, piece->index + piece->count - issued, issued);
  }
  return true;
}

static void add_list(struct trax_stories *stories, struct story_thread *thread, struct draft *draft) {
  uint32_t latest = thread->before;
  for (size_t i = 0; i < thread->count; latest = thread->passages[i++]->last)
    if (!add_passage(stories, draft, thread->passages[i], latest))
      stories->explain->out_of_memory = true;
  thread->count = 0;
}

/* --- the list --- */

void trax_stories_forget(struct trax_stories *stories) {
  for (uint64_t i = 0; i < stories->thread_count; i++) {
    struct story_thread *thread = &stories->threads[i];
    if (!thread->count || stories->explain->round - thread->round < TRAX_PASSAGES_ROUNDS)
      continue;
    if (!thread->draft)
      thread->draft = new_draft(stories);
    if (thread->draft)
      add_list(stories, thread, thread->draft);
    thread->count = 0;
  }
}

void trax_stories_add(struct trax_stories *stories, const struct trax_passage *passage) {
  struct story_thread *thread = &stories->threads[passage->thread];
  if (!passage->count)
    return;
  if (!trax_grow((void **)&thread->passages, thread->count, &thread->capacity, sizeof *thread->passages)) {
    stories->explain->out_of_memory = true;
    return;
  }
  if (!thread->count) {
    thread->round = stories->explain->round;
    thread->before = thread->latest;
  }
  thread->passages[thread->count++] = passage;
  thread->latest = passage->last;
}

/* --- stories --- */

static bool is_chosen(const struct trax_stories *stories, uint32_t place) {
  const struct trax_explain_options *options = &stories->explain->options;
  for (unsigned i = 0; i < options->story_count; i++)
    if (options->story_places[i] == place)
      return true;
  return false;
}

static struct trax_story *cheapest(struct trax_stories *stories) {
  struct trax_story *found = NULL;
  for (size_t i = 0; i < stories->count; i++)
    if (!stories->stories[i].chosen && (!found || stories->stories[i].cycles <= found->cycles))
      found = &stories->stories[i]; /* of equals the latest, so that the first stay */
  return found;
}

static void release(struct trax_story *story) {
  free(story->code);
  free(story->rays);
}

static int by_index(const void *a, const void *b) {
  const struct trax_story_code *x = a, *y = b;
  return x->index < y->index ? -1 : x->index > y->index;
}

static bool copy(struct trax_story *story, const struct draft *draft) {
  story->code = calloc(draft->touched_count + 1, sizeof *story->code);
  story->rays = calloc(draft->ray_count, sizeof *story->rays);
  if (!story->code || !story->rays) {
    release(story);
    return false;
  }
  for (size_t i = 0; i < draft->touched_count; i++) {
    story->code[i].index = draft->touched[i];
    memcpy(story->code[i].cycles, draft->code[draft->touched[i]], sizeof story->code[i].cycles);
  }
  qsort(story->code, draft->touched_count, sizeof *story->code, by_index);
  memcpy(story->rays, draft->rays, draft->ray_count * sizeof *story->rays);
  for (size_t i = 0; i < draft->ray_count; i++)
    story->rays[i].begin += story->begin;
  memcpy(story->time, draft->time, sizeof story->time);
  story->interval = draft->interval;
  story->code_count = draft->touched_count;
  story->ray_count = draft->ray_count;
  return true;
}

/* Keeps the story of an item, in the place of the cheapest one if there are too many. */
static void keep(struct trax_stories *stories, struct trax_story story, const struct draft *draft) {
  struct trax_story *kept = !story.chosen && stories->costliest == TRAX_STORY_COSTLIEST ? cheapest(stories) : NULL;
  bool complete = copy(&story, draft);
  if (complete && kept) {
    release(kept);
    memmove(kept, kept + 1, (size_t)(stories->stories + stories->count - kept - 1) * sizeof *kept);
    stories->stories[stories->count - 1] = story;
  } else if (complete &&
             trax_grow((void **)&stories->stories, stories->count, &stories->capacity, sizeof *stories->stories)) {
    stories->costliest += !story.chosen;
    stories->stories[stories->count++] = story;
  } else {
    if (complete)
      release(&story);
    stories->explain->out_of_memory = true;
  }
}

void trax_stories_end(struct trax_stories *stories, const struct trax_item_cost *cost, bool last) {
  struct story_thread *thread = &stories->threads[cost->thread];
  struct trax_story story = {.place = cost->place,
                             .thread = cost->thread,
                             .begin = cost->begin,
                             .cycles = cost->end - cost->begin,
                             .chosen = is_chosen(stories, cost->place)};
  struct draft *draft = thread->draft ? thread->draft : stories->draft;
  const struct trax_story *least = cheapest(stories);
  const bool wanted = !last && cost->place != TRAX_NO_PLACE &&
                      (story.chosen || stories->costliest < TRAX_STORY_COSTLIEST || story.cycles > least->cycles);
  if (wanted && draft) {
    add_list(stories, thread, draft);
    keep(stories, story, draft);
  }
  if (draft && (wanted || thread->draft) && !clear(draft))
    stories->explain->out_of_memory = true;
  thread->count = 0;
}

static int by_cost(const void *a, const void *b) {
  const struct trax_story *x = a, *y = b;
  if (x->chosen != y->chosen)
    return x->chosen ? -1 : 1;
  if (x->cycles != y->cycles)
    return x->cycles > y->cycles ? -1 : 1;
  return x->begin < y->begin ? -1 : x->begin > y->begin ? 1 : (int)x->thread - (int)y->thread;
}

const struct trax_story *trax_stories_sorted(struct trax_stories *stories, size_t *count) {
  if (stories->count)
    qsort(stories->stories, stories->count, sizeof *stories->stories, by_cost);
  *count = stories->count;
  return stories->stories;
}

bool trax_stories_have(const struct trax_stories *stories, uint32_t place) {
  for (size_t i = 0; i < stories->count; i++)
    if (stories->stories[i].place == place)
      return true;
  return false;
}

struct trax_stories *trax_stories_create(struct trax_explain *explain) {
  struct trax_stories *stories = calloc(1, sizeof *stories);
  if (!stories)
    return NULL;
  stories->explain = explain;
  stories->thread_count = explain->machine->stats.threads;
  stories->threads = calloc(stories->thread_count, sizeof *stories->threads);
  if (stories->threads && (stories->draft = new_draft(stories)))
    return stories;
  trax_stories_destroy(stories);
  return NULL;
}

void trax_stories_destroy(struct trax_stories *stories) {
  if (!stories)
    return;
  for (uint64_t i = 0; stories->threads && i < stories->thread_count; i++) {
    free(stories->threads[i].passages);
    drop_draft(stories->threads[i].draft);
  }
  for (size_t i = 0; i < stories->count; i++)
    release(&stories->stories[i]);
  free(stories->threads);
  drop_draft(stories->draft);
  free(stories->stories);
  free(stories);
}
