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
  struct trax_objects objects;
  struct heat_counts *counts;       /* of each object */
  struct heat_counts *parts;        /* of each part */
  struct heat_counts *pages[PAGES]; /* each [LINES_PER_PAGE], or NULL */
  uint64_t *executed, *global;      /* [places]: executions of the instruction; those that accessed global memory */
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
    counts->combined += (outcome & TRAX_OUTCOME_COMBINED) != 0;
  } else {
    counts->loads += times;
    counts->load_bytes += op->access_bytes * times;
    counts->hits += (outcome & TRAX_OUTCOME_HIT) != 0;
    counts->misses += (outcome & TRAX_OUTCOME_MISS) != 0;
    counts->merged += (outcome & TRAX_OUTCOME_MERGED) != 0;
  }
}

static void add_access(struct heat *heat, const struct trax_accessed *accessed) {
  const struct trax_explain_options *options = &heat->reader.explain->options;
  const trax_op_info *op = &trax_op_table[trax_places_inst(heat->reader.explain->places, accessed->index)->op];
  const uint32_t address = accessed->address;
  heat->global[accessed->index]++;
  for (size_t i = 0; i < options->part_count; i++)
    if (address - options->parts[i].address < options->parts[i].bytes)
      count(&heat->parts[i], op, accessed->outcome, 1);
  count(&heat->counts[trax_objects_at(&heat->objects, address)], op, accessed->outcome, 1);
  struct heat_counts *line = options->heat_lines ? line_at(heat, address) : NULL;
  if (line)
    count(line, op, accessed->outcome, 1);
}

static void add_passage(void *self, const struct trax_passage *passage) {
  struct heat *heat = self;
  for (size_t i = 0; i < passage->pieces; i++)
    trax_add_executed(heat->executed, &passage->piece[i]);
  for (size_t i = 0; i < passage->accessed_count; i++)
    add_access(heat, &passage->accessed[i]);
}

/* Accesses that were not to global memory were to local memory. */
static trax_status add_local(void *self, trax_error *error) {
  struct heat *heat = self;
  struct trax_places *places = heat->reader.explain->places;
  struct heat_counts *local = &heat->counts[trax_objects_at(&heat->objects, TRAX_LOCAL_BASE)];
  (void)error;
  for (uint32_t i = 0; i < trax_places_count(places); i++)
    if (trax_op_table[trax_places_inst(places, i)->op].access_bytes)
      count(local, &trax_op_table[trax_places_inst(places, i)->op], 0, heat->executed[i] - heat->global[i]);
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
  for (size_t i = 0; i < heat->objects.count; i++) {
    const struct trax_object *object = &heat->objects.objects[i];
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
      const struct trax_object *object = &heat->objects.objects[trax_objects_at(&heat->objects, address)];
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
  if (trax_objects_list(&heat->objects, heat->reader.explain, error) != TRAX_OK)
    return TRAX_ERROR;
  heat->counts = trax_explain_array(heat->objects.count, sizeof *heat->counts, error);
  heat->parts = trax_explain_array(heat->reader.explain->options.part_count, sizeof *heat->parts, error);
  heat->executed = trax_explain_array(trax_places_count(heat->reader.explain->places) + 2, sizeof(uint64_t), error);
  heat->global = trax_explain_array(trax_places_count(heat->reader.explain->places) + 2, sizeof(uint64_t), error);
  return heat->counts && heat->parts && heat->executed && heat->global ? TRAX_OK : TRAX_ERROR;
}

static void close_heat(void *self) {
  struct heat *heat = self;
  for (uint32_t page = 0; page < PAGES; page++)
    free(heat->pages[page]);
  trax_objects_release(&heat->objects);
  free(heat->counts);
  free(heat->parts);
  free(heat->executed);
  free(heat->global);
}

const struct trax_reader_kind trax_heat_reader = {
    .bytes = sizeof(struct heat),
    .files = {{.path = TRAX_EXPLAIN_PATH(heat), .put = put_objects, .member = "heat"},
              {.path = TRAX_EXPLAIN_PATH(heat_lines), .put = put_lines},
              {.put = put_parts, .member = "parts"}},
    .in_page = true,
    .open = open_heat,
    .passage = add_passage,
    .end = add_local,
    .close = close_heat};
