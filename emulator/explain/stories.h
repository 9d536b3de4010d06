/* The stories of items (pixels): their rays, the instructions that their thread issued and those for which it waited,
   and their time line. They are kept for the items at chosen places and for the costliest. */
#ifndef TRAX_EXPLAIN_STORIES_H
#define TRAX_EXPLAIN_STORIES_H

#include "explain/span.h"

enum {
  TRAX_STORY_COSTLIEST = 24,    /* the items whose stories are kept without having been chosen */
  TRAX_STORY_INTERVALS = 96,    /* the most of a time line */
  TRAX_STORY_FIRST_INTERVAL = 8 /* their cycles at first */
};

struct trax_story_code {
  uint32_t index; /* of trax_places */
  uint32_t cycles[TRAX_CAUSE_COUNT];
};

/* The trap that counted a ray, and what followed up to the next one. */
struct trax_story_ray {
  uint8_t kind;   /* TRAX_NO_RAY: before the first */
  uint64_t begin; /* cycle */
  uint32_t cycles[TRAX_CAUSE_COUNT];
};

struct trax_story {
  uint32_t place, thread;
  uint64_t begin, cycles;
  bool chosen;
  struct trax_story_code *code; /* by index */
  size_t code_count;
  struct trax_story_ray *rays; /* [0] is before the first */
  size_t ray_count;
  uint64_t interval; /* cycles of each but the last */
  uint32_t time[TRAX_STORY_INTERVALS][TRAX_CAUSE_COUNT];
};

struct trax_stories;

struct trax_stories *trax_stories_create(struct trax_explain *explain); /* NULL: out of memory */
void trax_stories_destroy(struct trax_stories *stories);                /* which may be NULL */
/* Forgets the passages whose places the coming round will use. */
void trax_stories_forget(struct trax_stories *stories);
void trax_stories_add(struct trax_stories *stories, const struct trax_passage *passage);
void trax_stories_end(struct trax_stories *stories, const struct trax_item_cost *cost, bool last);
/* The stories, the chosen ones first, then by cost. Valid until one more is added. */
const struct trax_story *trax_stories_sorted(struct trax_stories *stories, size_t *count);
bool trax_stories_have(const struct trax_stories *stories, uint32_t place);

/* --- stories_text.c: as a member of the page, and as text --- */
void trax_stories_put_member(struct trax_explain *explain, FILE *out);
trax_status trax_stories_put(void *items, FILE *out, trax_error *error);

#endif
