/* How often each line was executed, as clang's -fprofile-sample-use reads it (LLVM's text format):

     FUNCTION:TOTAL:CALLS
      LINE.DISCRIMINATOR: COUNT
      LINE.DISCRIMINATOR: INLINED:TOTAL
       LINE: COUNT

   Lines are relative to the first one of their function. Of the instructions of a line in one place, the one that was
   executed most often counts. */
#include "explain/profile.h"
#include "program/program.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

/* A place in a function. */
struct site {
  uint32_t line;
  unsigned discriminator;
};

/* A line of a function, or a function that is inlined at it. */
struct node {
  struct node *next, *lines, *inlined; /* next: at the same level, in order */
  const char *name;                    /* of a function; NULL: a line */
  struct site site;
  uint64_t count; /* lines: executions; functions: calls */
};

struct tree {
  struct node *functions;
  bool out_of_memory;
};

static int compare(const struct node *node, struct site site, const char *name) {
  if (node->site.line != site.line)
    return node->site.line < site.line ? -1 : 1;
  if (node->site.discriminator != site.discriminator)
    return node->site.discriminator < site.discriminator ? -1 : 1;
  return name ? strcmp(node->name, name) : 0;
}

/* Finds a node in a list, which is in order, or adds it. */
static struct node *find(struct tree *tree, struct node **list, struct site site, const char *name) {
  while (*list && compare(*list, site, name) < 0)
    list = &(*list)->next;
  if (*list && compare(*list, site, name) == 0)
    return *list;
  struct node *node = calloc(1, sizeof *node);
  if (!node) {
    tree->out_of_memory = true;
    return NULL;
  }
  *node = (struct node){.next = *list, .name = name, .site = site};
  return *list = node;
}

static void release(struct node *list) {
  while (list) {
    struct node *next = list->next;
    release(list->lines);
    release(list->inlined);
    free(list);
    list = next;
  }
}

/* LLVM packs three numbers into a discriminator: what tells blocks of a line apart, how many copies the compiler made
   of the instruction, and which copy it is. A number has 1 bit (a one: 0), 7 or 14 bits. */
static unsigned part_of(unsigned discriminator) {
  if (discriminator & 1)
    return 0;
  discriminator >>= 1;
  return discriminator & 0x20 ? (discriminator >> 1 & 0xFE0) | (discriminator & 0x1F) : discriminator & 0x1F;
}

static unsigned copies_of(unsigned discriminator) {
  const unsigned rest = discriminator >> (discriminator & 1 ? 1 : discriminator & 0x40 ? 14 : 7);
  const unsigned copies = part_of(rest);
  return copies ? copies : 1;
}

static struct site site_of(const struct trax_source_line *line) {
  return (struct site){(uint32_t)(line->line - line->function_line) & 0xFFFF, part_of((unsigned)line->discriminator)};
}

static void add(struct tree *tree, const struct trax_source_line *lines, size_t count, uint64_t executions,
                bool is_entry) {
  if (count == 0 || lines[0].line == 0 || !lines[count - 1].linkage) /* line 0: of no line */
    return;
  struct node *function = find(tree, &tree->functions, (struct site){0, 0}, lines[count - 1].linkage);
  if (function && is_entry)
    function->count += executions;
  for (size_t i = count; function && --i > 0 && lines[i - 1].linkage;)
    function = find(tree, &function->inlined, site_of(&lines[i]), lines[i - 1].linkage);
  struct node *line = function ? find(tree, &function->lines, site_of(&lines[0]), NULL) : NULL;
  executions *= copies_of((unsigned)lines[0].discriminator);
  if (line && line->count < executions)
    line->count = executions;
}

static uint64_t total_of(const struct node *function) {
  uint64_t total = 0;
  for (const struct node *line = function->lines; line; line = line->next)
    total += line->count;
  for (const struct node *inlined = function->inlined; inlined; inlined = inlined->next)
    total += total_of(inlined);
  return total;
}

static void put_site(FILE *out, int depth, struct site site) {
  fprintf(out, "%*s%" PRIu32, depth, "", site.line);
  if (site.discriminator)
    fprintf(out, ".%u", site.discriminator);
  fputs(": ", out);
}

static void put_body(FILE *out, const struct node *function, int depth) {
  for (const struct node *line = function->lines; line; line = line->next) {
    put_site(out, depth, line->site);
    fprintf(out, "%" PRIu64 "\n", line->count);
  }
  for (const struct node *inlined = function->inlined; inlined; inlined = inlined->next) {
    put_site(out, depth, inlined->site);
    fprintf(out, "%s:%" PRIu64 "\n", inlined->name, total_of(inlined));
    put_body(out, inlined, depth + 1);
  }
}

trax_status trax_profile_write_sample(const struct trax_profile *profile, FILE *out, trax_error *error) {
  enum { MAX_FRAMES = 64 };
  const struct trax_host *host = trax_host_of(profile->explain->machine);
  struct trax_places *places = profile->explain->places;
  const uint32_t count = trax_places_count(places);
  uint64_t *executions = calloc((size_t)count + 2, sizeof *executions);
  struct tree tree = {.out_of_memory = !executions};
  for (size_t i = 0; executions && i < profile->record_count; i++)
    executions[profile->records[i].index] += profile->records[i].counts.cycles[TRAX_CAUSE_ISSUED];
  for (uint32_t i = 0; executions && host && i < count; i++)
    if (executions[i]) {
      struct trax_source_line lines[MAX_FRAMES];
      const struct trax_place *place = trax_places_at(places, i);
      const size_t frames = trax_image_lines(host->image, trax_places_pc(places, i), lines, MAX_FRAMES);
      add(&tree, lines, frames, executions[i], place->symbol && place->offset == 0);
    }
  free(executions);
  for (const struct node *function = tree.functions; !tree.out_of_memory && function; function = function->next) {
    fprintf(out, "%s:%" PRIu64 ":%" PRIu64 "\n", function->name, total_of(function), function->count);
    put_body(out, function, 1);
  }
  const bool empty = !tree.functions;
  release(tree.functions);
  if (tree.out_of_memory)
    return trax_fail(error, "out of memory for the profile");
  return empty ? trax_fail(error, "the program has no debug information: compile it with -g for a sample profile")
               : TRAX_OK;
}
