/* The symbol of each address, in a table that is made once. */
#include <stdlib.h>
#include <string.h>

#include "program/image_internal.h"
#include "trax/abi.h"

/* The symbol of the addresses from `begin` to the next range. */
struct trax_name_range {
  uint64_t begin;
  const struct trax_symbol *symbol; /* NULL: none */
};

/* A symbol with the end of the addresses that it may name. */
struct named {
  const struct trax_symbol *symbol;
  uint64_t end;
};

/* Orders symbols such that of those that contain an address the last one describes it best: the nearest start, then a
   function or object with a size rather than a label, then a global symbol rather than a local one, then the first in
   the file. */
static int by_address(const void *a, const void *b) {
  const struct trax_symbol *x = ((const struct named *)a)->symbol, *y = ((const struct named *)b)->symbol;
  if (x->address != y->address)
    return x->address < y->address ? -1 : 1;
  const bool sized_x = x->type != TRAX_SYMBOL_PLAIN && x->bytes, sized_y = y->type != TRAX_SYMBOL_PLAIN && y->bytes;
  if (sized_x != sized_y)
    return sized_x ? 1 : -1;
  if (x->global != y->global)
    return x->global ? 1 : -1;
  return x < y ? 1 : -1;
}

/* Compares an address with a segment, for bsearch. */
static int to_segment(const void *key, const void *element) {
  const uint32_t address = *(const uint32_t *)key;
  const struct trax_load_segment *segment = element;
  if (address < segment->address)
    return -1;
  return address - segment->address >= segment->memory_bytes;
}

/* Returns the end of the addresses that a symbol may name; its address: none. A label without a size covers the
   addresses after it in its segment. */
static uint64_t end_of(const trax_image *image, const struct trax_symbol *symbol) {
  const bool is_thread_local = symbol->type == TRAX_SYMBOL_THREAD_LOCAL;
  if (symbol->absolute || strncmp(symbol->name, ".L", 2) == 0 ||
      (is_thread_local && symbol->address < TRAX_LOCAL_BASE)) /* other linkers write an offset, not an address */
    return symbol->address;
  if (symbol->bytes || is_thread_local)
    return (uint64_t)symbol->address + symbol->bytes;
  const struct trax_load_segment *segment =
      bsearch(&symbol->address, image->segments, image->segment_count, sizeof *segment, to_segment);
  return segment ? (uint64_t)segment->address + segment->memory_bytes : symbol->address;
}

static void add_range(trax_image *image, uint64_t begin, const struct trax_symbol *symbol) {
  if (image->name_count && image->names[image->name_count - 1].begin == begin)
    image->name_count--;
  image->names[image->name_count++] = (struct trax_name_range){begin, symbol};
}

/* Closes the symbols that end before `limit`. *open of them contain the current address, the best one last. */
static void close_until(trax_image *image, const struct named *symbols, size_t *open, uint64_t limit) {
  while (*open && symbols[*open - 1].end <= limit) {
    const uint64_t end = symbols[--*open].end;
    while (*open && symbols[*open - 1].end <= end)
      --*open;
    add_range(image, end, *open ? symbols[*open - 1].symbol : NULL);
  }
}

bool trax_image_order_symbols(trax_image *image) {
  struct named *symbols = calloc(image->symbol_count + 1, sizeof *symbols);
  size_t count = 0, open = 0;
  image->names = calloc(2 * image->symbol_count + 1, sizeof *image->names);
  if (!symbols || !image->names) {
    free(symbols);
    return false;
  }
  for (size_t i = 0; i < image->symbol_count; i++) {
    const uint64_t end = end_of(image, &image->symbols[i]);
    if (end > image->symbols[i].address)
      symbols[count++] = (struct named){&image->symbols[i], end};
  }
  qsort(symbols, count, sizeof *symbols, by_address);
  for (size_t i = 0; i < count; i++) { /* symbols[0] to symbols[open - 1] become the stack of those that are open */
    const struct named next = symbols[i];
    close_until(image, symbols, &open, next.symbol->address);
    symbols[open++] = next;
    add_range(image, next.symbol->address, next.symbol);
  }
  close_until(image, symbols, &open, UINT64_MAX);
  free(symbols);
  return true;
}

const struct trax_symbol *trax_image_symbol_at(const trax_image *image, uint32_t address) {
  size_t low = 0, high = image->name_count;
  while (low < high) { /* the first range that begins behind the address */
    const size_t middle = (low + high) / 2;
    if (image->names[middle].begin <= address)
      low = middle + 1;
    else
      high = middle;
  }
  return low ? image->names[low - 1].symbol : NULL;
}
