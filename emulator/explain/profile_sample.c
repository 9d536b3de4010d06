/* How often each line was executed, as clang's -fprofile-sample-use reads it (LLVM's text format):

     FUNCTION:TOTAL:CALLS
      LINE.DISCRIMINATOR: COUNT
      LINE.DISCRIMINATOR: INLINED:TOTAL
       LINE: COUNT

   Lines are relative to the first one of their function. A line's count is the largest count
   of its instructions. */
#include "explain/profile.h"
#include "program/program.h"
#include "trax/grow.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

/* A place in a function. */
struct site {
  uint32_t line;
  unsigned discriminator;
};

struct node_list {
  struct node **nodes; /* in order */
  size_t count, capacity;
};

/* A line of a function, or a function that is inlined at it. */
struct node {
  struct node_list lines, inlined;
  const char *name; /* of a function; NULL: a line */
  struct site site;
  uint64_t count; /* lines: executions; functions: calls */
};

struct tree {
  struct node_list functions;
  bool out_of_memory;
};

static int compare(const struct node *node, struct site site, const char *name) {
  if (node->site.line != site.line)
    return node->site.line < site.line ? -1 : 1;
  if (node->site.discriminator != site.discriminator)
    return node->site.discriminator < site.discriminator ? -1 : 1;
  return name ? strcmp(node->name, name) : 0;
}

/* Finds a node in a list, or adds it. */
static struct node *find(struct tree *tree, struct node_list *list, struct site site, const char *name) {
  size_t low = 0, high = list->count;
  while (low < high) { /* the first node that is not before it */
    const size_t middle = (low + high) / 2;
    const int order = compare(list->nodes[middle], site, name);
    if (order == 0)
      return list->nodes[middle];
    if (order < 0)
      low = middle + 1;
    else
      high = middle;
  }
  struct node *node = calloc(1, sizeof *node);
  if (!node || !trax_grow((void **)&list->nodes, list->count, &list->capacity, sizeof(struct node *))) {
    free(node);
    tree->out_of_memory = true;
    return NULL;
  }
  *node = (struct node){.name = name, .site = site};
  memmove(&list->nodes[low + 1], &list->nodes[low], (list->count++ - low) * sizeof(struct node *));
  return list->nodes[low] = node;
}

static void release(struct node_list *list) {
  for (size_t i = 0; i < list->count; i++) {
    release(&list->nodes[i]->lines);
    release(&list->nodes[i]->inlined);
    free(list->nodes[i]);
  }
  free(list->nodes);
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
  for (size_t i = 0; i < function->lines.count; i++)
    total += function->lines.nodes[i]->count;
  for (size_t i = 0; i < function->inlined.count; i++)
    total += total_of(function->inlined.nodes[i]);
  return total;
}

static void put_site(FILE *out, int depth, struct site site) {
  fprintf(out, "%*s%" PRIu32, depth, "", site.line);
  if (site.discriminator)
    fprintf(out, ".%u", site.discriminator);
  fputs(": ", out);
}

static void put_body(FILE *out, const struct node *function, int depth) {
  for (size_t i = 0; i < function->lines.count; i++) {
    put_site(out, depth, function->lines.nodes[i]->site);
    fprintf(out, "%" PRIu64 "\n", function->lines.nodes[i]->count);
  }
  for (size_t i = 0; i < function->inlined.count; i++) {
    const struct node *inlined = function->inlined.nodes[i];
    put_site(out, depth, inlined->site);
    fprintf(out, "%s:%" PRIu64 "\n", inlined->name, total_of(inlined));
    put_body(out, inlined, depth + 1);
  }
}

trax_status trax_profile_put_sample(void *self, FILE *out, trax_error *error) {
  const struct trax_profile *profile = self;
  enum { MAX_FRAMES = 64 };
  const struct trax_loaded *loaded = trax_loaded_of(profile->reader.explain->machine);
  struct trax_places *places = profile->reader.explain->places;
  const uint32_t count = trax_places_count(places);
  uint64_t *executions = calloc((size_t)count + 2, sizeof *executions);
  struct tree tree = {.out_of_memory = !executions};
  for (size_t i = 0; executions && i < profile->record_count; i++)
    executions[profile->records[i].index] += profile->records[i].counts.cycles[TRAX_CAUSE_ISSUED];
  for (uint32_t i = 0; executions && loaded && i < count; i++)
    if (executions[i]) {
      struct trax_source_line lines[MAX_FRAMES];
      const struct trax_place *place = trax_places_at(places, i);
      const size_t frames = trax_image_lines(loaded->image, trax_places_pc(places, i), lines, MAX_FRAMES);
      add(&tree, lines, frames, executions[i], place->symbol && place->offset == 0);
    }
  free(executions);
  for (size_t i = 0; !tree.out_of_memory && i < tree.functions.count; i++) {
    const struct node *function = tree.functions.nodes[i];
    fprintf(out, "%s:%" PRIu64 ":%" PRIu64 "\n", function->name, total_of(function), function->count);
    put_body(out, function, 1);
  }
  const bool empty = tree.functions.count == 0;
  release(&tree.functions);
  if (tree.out_of_memory)
    return trax_fail(error, "out of memory for the profile");
  return empty ? trax_fail(error, "the program has no debug information: compile it with -g for a sample profile")
               : TRAX_OK;
}
