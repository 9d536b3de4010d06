/* Memory heat: accesses by object, and by 64 bytes of global memory. */
#include "explain/page.h"
#include "trax/grow.h"

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

struct object {
  const char *name;
  uint64_t begin, end;
  struct heat_counts counts;
};

struct heat {
  struct trax_reader reader;
  struct object *objects; /* by address, not overlapping */
  size_t object_count, object_capacity;
  struct object *parts;             /* of the page */
  struct heat_counts *pages[PAGES]; /* each [LINES_PER_PAGE], or NULL */
};

static int by_address(const void *a, const void *b) {
  const struct object *x = a, *y = b;
  if (x->begin != y->begin)
    return x->begin < y->begin ? -1 : 1;
  if (x->end != y->end)
    return x->end > y->end ? -1 : 1;
  return strcmp(x->name, y->name);
}

static void add_object(struct heat *heat, const char *name, uint64_t begin, uint64_t end) {
  if (end <= begin)
    return;
  if (trax_grow((void **)&heat->objects, heat->object_count, &heat->object_capacity, sizeof *heat->objects))
    heat->objects[heat->object_count++] = (struct object){.name = name, .begin = begin, .end = end};
  else
    heat->reader.explain->out_of_memory = true;
}

/* Lists symbols, bound buffers, heap and stacks. Of overlapping objects, the first keeps the bytes. */
static trax_status list_objects(struct heat *heat, trax_error *error) {
  const struct trax_machine *machine = heat->reader.explain->machine;
  const struct trax_loaded *loaded = trax_loaded_of(machine);
  size_t symbol_count = 0;
  const struct trax_symbol *symbols = loaded ? trax_image_symbols(loaded->image, &symbol_count) : NULL;
  for (size_t i = 0; i < symbol_count; i++)
    if (!symbols[i].absolute && symbols[i].bytes &&
        (symbols[i].type == TRAX_SYMBOL_OBJECT || symbols[i].type == TRAX_SYMBOL_FUNCTION))
      add_object(heat, symbols[i].name, symbols[i].address, (uint64_t)symbols[i].address + symbols[i].bytes);
  if (loaded) {
    for (size_t i = 0; i < loaded->buffer_count; i++)
      add_object(heat, loaded->buffers[i].symbol, loaded->buffers[i].address,
                 (uint64_t)loaded->buffers[i].address + loaded->buffers[i].bytes);
    add_object(heat, "(heap)", loaded->free_address, loaded->memory_end);
    add_object(heat, "(stacks)", loaded->memory_end, machine->space.size);
  }
  add_object(heat, "(local memory)", TRAX_LOCAL_BASE, (uint64_t)1 << 32);
  if (heat->object_count) /* qsort's array is not to be NULL */
    qsort(heat->objects, heat->object_count, sizeof *heat->objects, by_address);
  size_t kept = 0;
  for (size_t i = 0; i < heat->object_count; i++)
    if (!kept || heat->objects[i].begin >= heat->objects[kept - 1].end)
      heat->objects[kept++] = heat->objects[i];
  heat->object_count = kept;
  add_object(heat, "(other)", 0, 1); /* the last object counts for all other addresses */
  return heat->reader.explain->out_of_memory ? trax_fail(error, "out of memory for the objects of the heat") : TRAX_OK;
}

static trax_status list_parts(struct heat *heat, trax_error *error) {
  const struct trax_explain_options *options = &heat->reader.explain->options;
  heat->parts = trax_explain_array(options->part_count, sizeof *heat->parts, error);
  for (size_t i = 0; heat->parts && i < options->part_count; i++)
    heat->parts[i] = (struct object){.name = options->parts[i].name,
                                     .begin = options->parts[i].address,
                                     .end = (uint64_t)options->parts[i].address + options->parts[i].bytes};
  return heat->parts ? TRAX_OK : TRAX_ERROR;
}

static struct object *object_at(const struct heat *heat, uint32_t address) {
  size_t low = 0, high = heat->object_count - 1;
  while (low < high) { /* the first object that ends after the address */
    const size_t middle = (low + high) / 2;
    if (heat->objects[middle].end <= address)
      low = middle + 1;
    else
      high = middle;
  }
  return low < heat->object_count - 1 && heat->objects[low].begin <= address ? &heat->objects[low]
                                                                             : &heat->objects[heat->object_count - 1];
}

static struct heat_counts *line_at(struct heat *heat, uint32_t address) {
  struct heat_counts **page = &heat->pages[address >> PAGE_SHIFT];
  if (!*page && !(*page = calloc(LINES_PER_PAGE, sizeof **page))) {
    heat->reader.explain->out_of_memory = true;
    return NULL;
  }
  return &(*page)[address >> LINE_SHIFT & (LINES_PER_PAGE - 1)];
}

static void count(struct heat_counts *counts, unsigned flags, unsigned bytes, unsigned outcome) {
  if (flags & TRAX_IS_ATOMIC) {
    counts->atomics++;
  } else if (flags & TRAX_IS_STORE) {
    counts->stores++;
    counts->store_bytes += bytes;
    counts->combined += (outcome & TRAX_OUTCOME_COMBINED) != 0;
  } else {
    counts->loads++;
    counts->load_bytes += bytes;
    counts->hits += (outcome & TRAX_OUTCOME_HIT) != 0;
    counts->misses += (outcome & TRAX_OUTCOME_MISS) != 0;
    counts->merged += (outcome & TRAX_OUTCOME_MERGED) != 0;
  }
}

static void add_span(void *self, const struct trax_span *span) {
  struct heat *heat = self;
  const trax_op_info *op = &trax_op_table[span->inst.op];
  if (!span->issue || !op->access_bytes)
    return;
  const uint32_t address = span->issue->address;
  for (size_t i = 0; i < heat->reader.explain->options.part_count; i++)
    if (address >= heat->parts[i].begin && address < heat->parts[i].end)
      count(&heat->parts[i].counts, op->flags, op->access_bytes, span->issue->outcome);
  count(&object_at(heat, address)->counts, op->flags, op->access_bytes, span->issue->outcome);
  struct heat_counts *line =
      heat->reader.explain->options.heat_lines && address < TRAX_LOCAL_BASE ? line_at(heat, address) : NULL;
  if (line)
    count(line, op->flags, op->access_bytes, span->issue->outcome);
}

static void put_counts(FILE *out, const struct heat_counts *counts) {
  fprintf(out,
          "%" PRIu64 ",%" PRIu64 ",%" PRIu64 ",%" PRIu64 ",%" PRIu64 ",%" PRIu64 ",%" PRIu64 ",%" PRIu64 ",%" PRIu64,
          counts->loads, counts->stores, counts->atomics, counts->load_bytes, counts->store_bytes, counts->hits,
          counts->misses, counts->merged, counts->combined);
}

/* Writes a name as CSV (RFC 4180). */
static void put_name(FILE *out, const char *name) {
  fputc('"', out);
  for (; *name; name++) {
    if (*name == '"')
      fputc('"', out);
    fputc(*name, out);
  }
  fputc('"', out);
}

#define COLUMNS "loads,stores,atomics,load_bytes,store_bytes,hits,misses,merged,combined"

static void put_table(const struct object *objects, size_t count, FILE *out) {
  fprintf(out, "object,address,bytes," COLUMNS "\n");
  for (size_t i = 0; i < count; i++) {
    const struct object *object = &objects[i];
    if (!object->counts.loads && !object->counts.stores && !object->counts.atomics)
      continue;
    put_name(out, object->name);
    fprintf(out, ",0x%08" PRIx64 ",%" PRIu64 ",", object->begin, object->end - object->begin);
    put_counts(out, &object->counts);
    fputc('\n', out);
  }
}

static trax_status put_objects(void *self, FILE *out, trax_error *error) {
  const struct heat *heat = self;
  (void)error;
  put_table(heat->objects, heat->object_count, out);
  return TRAX_OK;
}

static trax_status put_parts(void *self, FILE *out, trax_error *error) {
  const struct heat *heat = self;
  (void)error;
  put_table(heat->parts, heat->reader.explain->options.part_count, out);
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
      const struct object *object = object_at(heat, address); /* the object of the line's first byte */
      fprintf(out, "0x%08x,", address);
      put_name(out, object->name);
      fprintf(out, ",%" PRIu64 ",",
              object == &heat->objects[heat->object_count - 1] ? address : address - object->begin);
      put_counts(out, counts);
      fputc('\n', out);
    }
  return TRAX_OK;
}

static trax_status open_heat(void *self, trax_error *error) {
  return list_objects(self, error) == TRAX_OK ? list_parts(self, error) : TRAX_ERROR;
}

static void close_heat(void *self) {
  struct heat *heat = self;
  for (uint32_t page = 0; page < PAGES; page++)
    free(heat->pages[page]);
  free(heat->objects);
  free(heat->parts);
}

const struct trax_reader_kind trax_heat_reader = {
    .bytes = sizeof(struct heat),
    .files = {{.path = TRAX_EXPLAIN_PATH(heat), .put = put_objects, .member = "heat"},
              {.path = TRAX_EXPLAIN_PATH(heat_lines), .put = put_lines},
              {.put = put_parts, .member = "parts"}},
    .in_page = true,
    .open = open_heat,
    .span = add_span,
    .close = close_heat};
