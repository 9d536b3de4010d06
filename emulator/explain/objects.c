#include "explain/span.h"
#include "trax/grow.h"

#include <stdlib.h>
#include <string.h>

static int by_address(const void *a, const void *b) {
  const struct trax_object *x = a, *y = b;
  if (x->begin != y->begin)
    return x->begin < y->begin ? -1 : 1;
  if (x->end != y->end)
    return x->end > y->end ? -1 : 1;
  return strcmp(x->name, y->name);
}

static bool add(struct trax_objects *objects, const char *name, uint64_t begin, uint64_t end) {
  if (end <= begin)
    return true;
  if (!trax_grow((void **)&objects->objects, objects->count, &objects->capacity, sizeof *objects->objects))
    return false;
  objects->objects[objects->count++] = (struct trax_object){name, begin, end};
  return true;
}

/* The first of overlapping objects keeps the bytes. */
static void sort(struct trax_objects *objects) {
  size_t kept = 0;
  if (objects->count) /* qsort's array is not to be NULL */
    qsort(objects->objects, objects->count, sizeof *objects->objects, by_address);
  for (size_t i = 0; i < objects->count; i++)
    if (!kept || objects->objects[i].begin >= objects->objects[kept - 1].end)
      objects->objects[kept++] = objects->objects[i];
  objects->count = kept;
}

size_t trax_objects_at(const struct trax_objects *objects, uint32_t address) {
  size_t low = 0, high = objects->count - 1;
  while (low < high) { /* the first object that ends after the address */
    const size_t middle = (low + high) / 2;
    if (objects->objects[middle].end <= address)
      low = middle + 1;
    else
      high = middle;
  }
  return low < objects->count - 1 && objects->objects[low].begin <= address ? low : objects->count - 1;
}

static int by_number(const void *a, const void *b) {
  const uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
  return x < y ? -1 : x > y;
}

static size_t part_at(const struct trax_objects *objects, uint32_t address) {
  for (size_t i = 0; i < objects->options->part_count; i++)
    if (address - objects->options->parts[i].address < objects->options->parts[i].bytes)
      return objects->count + i;
  return trax_objects_at(objects, address);
}

static bool list_regions(struct trax_objects *objects) {
  const struct trax_explain_options *options = objects->options;
  uint64_t *bounds = malloc((2 * (objects->count + options->part_count) + 2) * sizeof *bounds);
  size_t count = 0;
  objects->regions = malloc((2 * (objects->count + options->part_count) + 2) * sizeof *objects->regions);
  if (!bounds || !objects->regions) {
    free(bounds);
    return false;
  }
  bounds[count++] = 0;
  bounds[count++] = (uint64_t)1 << 32;
  for (size_t i = 0; i + 1 < objects->count; i++) {
    bounds[count++] = objects->objects[i].begin;
    bounds[count++] = objects->objects[i].end;
  }
  for (size_t i = 0; i < options->part_count; i++) {
    bounds[count++] = options->parts[i].address;
    bounds[count++] = (uint64_t)options->parts[i].address + options->parts[i].bytes;
  }
  qsort(bounds, count, sizeof *bounds, by_number);
  for (size_t i = 0; i + 1 < count && bounds[i] >> 32 == 0; i++)
    if (bounds[i] < bounds[i + 1])
      objects->regions[objects->region_count++] = (struct trax_region){
          (uint32_t)bounds[i], (uint32_t)(bounds[i + 1] - 1), part_at(objects, (uint32_t)bounds[i])};
  free(bounds);
  return true;
}

trax_status trax_objects_list(struct trax_objects *objects, const struct trax_explain *explain, trax_error *error) {
  const struct trax_machine *machine = explain->machine;
  const struct trax_loaded *loaded = trax_loaded_of(machine);
  size_t symbol_count = 0;
  const struct trax_symbol *symbols = loaded ? trax_image_symbols(loaded->image, &symbol_count) : NULL;
  bool complete = true;
  objects->options = &explain->options;
  for (size_t i = 0; i < symbol_count; i++)
    if (!symbols[i].absolute && symbols[i].bytes &&
        (symbols[i].type == TRAX_SYMBOL_OBJECT || symbols[i].type == TRAX_SYMBOL_FUNCTION))
      complete &= add(objects, symbols[i].name, symbols[i].address, (uint64_t)symbols[i].address + symbols[i].bytes);
  for (size_t i = 0; loaded && i < loaded->buffer_count; i++)
    complete &= add(objects, loaded->buffers[i].symbol, loaded->buffers[i].address,
                    (uint64_t)loaded->buffers[i].address + loaded->buffers[i].bytes);
  if (loaded)
    complete &= add(objects, "(heap)", loaded->free_address, loaded->memory_end) &&
                add(objects, "(stacks)", loaded->memory_end, machine->space.size);
  complete &= add(objects, "(local memory)", TRAX_LOCAL_BASE, (uint64_t)1 << 32);
  sort(objects);
  complete &= add(objects, "(other)", 0, 1) && list_regions(objects);
  return complete ? TRAX_OK : trax_fail(error, "out of memory for the objects in memory");
}

void trax_objects_release(struct trax_objects *objects) {
  free(objects->objects);
  free(objects->regions);
}

const struct trax_region *trax_objects_region(const struct trax_objects *objects, uint32_t address) {
  size_t low = 0, high = objects->region_count - 1;
  while (low < high) { /* the first region that ends at the address or after it */
    const size_t middle = (low + high) / 2;
    if (objects->regions[middle].last < address)
      low = middle + 1;
    else
      high = middle;
  }
  return &objects->regions[low];
}

const char *trax_objects_name(const struct trax_objects *objects, size_t number) {
  return number < objects->count ? objects->objects[number].name
                                 : objects->options->parts[number - objects->count].name;
}

void trax_objects_put_name(FILE *out, const char *name) {
  fputc('"', out);
  for (; *name; name++) {
    if (*name == '"')
      fputc('"', out);
    fputc(*name, out);
  }
  fputc('"', out);
}
