/* Memory heat: accesses by object, and by 64 bytes of global memory. */
#include "explain/objects.h"
#include "explain/page.h"
#include "explain/places.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

enum {
  LINE_SHIFT = 6,
  PAGE_SHIFT = 16,
  PAGES = 1 << (32 - PAGE_SHIFT),
  LINES_PER_PAGE = 1 << (PAGE_SHIFT - LINE_SHIFT)
};

struct heat_counts {
  uint64_t loads, stores, atomics;
  uint64_t load_bytes, store_bytes;
  uint64_t hits, misses, merged; /* of loads through the data cache */
  uint64_t combined;             /* of stores */
};

struct heat {
  struct trax_reader reader;
  const struct trax_objects *objects;
  struct heat_counts *counts;       /* of each object */
  struct heat_counts *parts;        /* of each part */
  struct heat_counts *pages[PAGES]; /* each [LINES_PER_PAGE], or NULL */
  struct heat_counts *regions;      /* of each region */
};

static struct heat_counts *line_at(struct heat *heat, uint32_t address) {
  struct heat_counts **page = &heat->pages[address >> PAGE_SHIFT];
  if (!*page && !(*page = calloc(LINES_PER_PAGE, sizeof **page))) {
    heat->reader.explain->out_of_memory = true;
    return NULL;
  }
  return &(*page)[address >> LINE_SHIFT & (LINES_PER_PAGE - 1)];
}

/* `times`: the number of accesses. */
static void count(struct heat_counts *counts, const trax_op_info *op, unsigned outcome, uint64_t times) {
  if (op->flags & TRAX_IS_ATOMIC) {
    counts->atomics += times;
  } else if (op->flags & TRAX_IS_STORE) {
    counts->stores += times;
    counts->store_bytes += op->access_bytes * times;
    counts->combined += outcome & TRAX_OUTCOME_COMBINED ? times : 0;
  } else {
    counts->loads += times;
    counts->load_bytes += op->access_bytes * times;
    counts->hits += outcome & TRAX_OUTCOME_HIT ? times : 0;
    counts->misses += outcome & TRAX_OUTCOME_MISS ? times : 0;
    counts->merged += outcome & TRAX_OUTCOME_MERGED ? times : 0;
  }
}

/* Executions without an access to global memory accessed local memory. */
static void add_counts(void *self, const struct trax_counts *counts) {
  struct heat *heat = self;
  const trax_op_info *op = &trax_op_table[trax_places_inst(heat->reader.explain->places, counts->index)->op];
  struct heat_counts *local = &heat->counts[trax_objects_at(heat->objects, TRAX_LOCAL_BASE)];
  if (!op->access_bytes)
    return;
  count(local, op, 0, counts->executed);
  for (unsigned outcome = 0; counts->region && outcome < TRAX_OUTCOMES; outcome++)
    if (counts->outcomes[outcome]) {
      count(&heat->regions[counts->region - heat->objects->regions], op, outcome, counts->outcomes[outcome]);
      count(local, op, 0, -counts->outcomes[outcome]);
    }
}

static void add_passage(void *self, const struct trax_passage *passage) {
  struct heat *heat = self;
  for (size_t i = 0; i < passage->accessed_count; i++) {
    const struct trax_accessed *accessed = &passage->accessed[i];
    const uint32_t index = trax_passage_index(passage, accessed->at);
    struct heat_counts *line = line_at(heat, accessed->address);
    if (line)
      count(line, &trax_op_table[trax_places_inst(heat->reader.explain->places, index)->op], accessed->outcome, 1);
  }
}

static bool has_lines(const struct trax_explain_options *options) {
  return options->heat_lines != NULL;
}

static void add_regions(struct heat *heat) {
  const struct trax_explain_options *options = &heat->reader.explain->options;
  for (size_t i = 0; i < heat->objects->region_count; i++) {
    const uint32_t begin = heat->objects->regions[i].begin;
    for (size_t k = 0; k < options->part_count; k++)
      if (begin - options->parts[k].address < options->parts[k].bytes)
        trax_counters_add(&heat->parts[k], &heat->regions[i], sizeof *heat->parts, 1);
    trax_counters_add(&heat->counts[trax_objects_at(heat->objects, begin)], &heat->regions[i], sizeof *heat->counts, 1);
  }
}

static trax_status end_heat(void *self, trax_error *error) {
  (void)error;
  add_regions(self);
  return TRAX_OK;
}

static void put_counts(FILE *out, const struct heat_counts *counts) {
  fprintf(out,
          "%" PRIu64 ",%" PRIu64 ",%" PRIu64 ",%" PRIu64 ",%" PRIu64 ",%" PRIu64 ",%" PRIu64 ",%" PRIu64 ",%" PRIu64,
          counts->loads, counts->stores, counts->atomics, counts->load_bytes, counts->store_bytes, counts->hits,
          counts->misses, counts->merged, counts->combined);
}

#define COLUMNS "loads,stores,atomics,load_bytes,store_bytes,hits,misses,merged,combined"

static void put_head(FILE *out) {
  fprintf(out, "object,address,bytes," COLUMNS "\n");
}

static void put_row(FILE *out, const char *name, uint64_t begin, uint64_t bytes, const struct heat_counts *counts) {
  if (!counts->loads && !counts->stores && !counts->atomics)
    return;
  trax_objects_put_name(out, name);
  fprintf(out, ",0x%08" PRIx64 ",%" PRIu64 ",", begin, bytes);
  put_counts(out, counts);
  fputc('\n', out);
}

static trax_status put_objects(void *self, FILE *out, trax_error *error) {
  const struct heat *heat = self;
  (void)error;
  put_head(out);
  for (size_t i = 0; i < heat->objects->count; i++) {
    const struct trax_object *object = &heat->objects->objects[i];
    put_row(out, object->name, object->begin, object->end - object->begin, &heat->counts[i]);
  }
  return TRAX_OK;
}

static trax_status put_parts(void *self, FILE *out, trax_error *error) {
  const struct heat *heat = self;
  const struct trax_explain_options *options = &heat->reader.explain->options;
  (void)error;
  put_head(out);
  for (size_t i = 0; i < options->part_count; i++)
    put_row(out, options->parts[i].name, options->parts[i].address, options->parts[i].bytes, &heat->parts[i]);
  return TRAX_OK;
}

static trax_status put_lines(void *self, FILE *out, trax_error *error) {
  const struct heat *heat = self;
  (void)error;
  fprintf(out, "address,object,offset," COLUMNS "\n");
  for (uint32_t page = 0; page < PAGES; page++)
    for (uint32_t i = 0; heat->pages[page] && i < LINES_PER_PAGE; i++) {
      const struct heat_counts *counts = &heat->pages[page][i];
      if (!counts->loads && !counts->stores && !counts->atomics)
        continue;
      const uint32_t address = page << PAGE_SHIFT | i << LINE_SHIFT;
      /* The object of the line's first byte. That of all other addresses begins at 0. */
      const struct trax_object *object = &heat->objects->objects[trax_objects_at(heat->objects, address)];
      fprintf(out, "0x%08x,", address);
      trax_objects_put_name(out, object->name);
      fprintf(out, ",%" PRIu64 ",", address - object->begin);
      put_counts(out, counts);
      fputc('\n', out);
    }
  return TRAX_OK;
}

static trax_status open_heat(void *self, trax_error *error) {
  struct heat *heat = self;
  heat->objects = &heat->reader.explain->objects;
  heat->counts = trax_explain_array(heat->objects->count, sizeof *heat->counts, error);
  heat->parts = trax_explain_array(heat->reader.explain->options.part_count, sizeof *heat->parts, error);
  heat->regions = trax_explain_array(heat->objects->region_count, sizeof *heat->regions, error);
  return heat->counts && heat->parts && heat->regions ? TRAX_OK : TRAX_ERROR;
}

static void close_heat(void *self) {
  struct heat *heat = self;
  for (uint32_t page = 0; page < PAGES; page++)
    free(heat->pages[page]);
  free(heat->counts);
  free(heat->parts);
  free(heat->regions);
}

const struct trax_reader_kind trax_heat_reader = {
    .bytes = sizeof(struct heat),
    .files = {{.path = TRAX_EXPLAIN_PATH(heat), .put = put_objects, .member = "heat"},
              {.path = TRAX_EXPLAIN_PATH(heat_lines), .put = put_lines},
              {.put = put_parts, .member = "parts"}},
    .in_page = true,
    .open = open_heat,
    .passage = add_passage,
    .wants_passages = has_lines,
    .counts = add_counts,
    .end = end_heat,
    .close = close_heat};
