/* The structure that image.c (headers, symbols) and lines.c (debug information) share. */
#ifndef TRAX_PROGRAM_IMAGE_INTERNAL_H
#define TRAX_PROGRAM_IMAGE_INTERNAL_H

#include <elfutils/libdw.h>
#include <libelf.h>

#include "program/dwarf_reader.h"
#include "program/image.h"

struct trax_image {
  char *path;
  uint8_t *bytes;
  size_t size;
  Elf *elf; /* over bytes */
  uint32_t entry;
  struct trax_load_segment *segments; /* by address */
  size_t segment_count;
  struct trax_symbol *symbols;
  size_t symbol_count;
  struct trax_name_range *names; /* in the order of addresses; symbols.c */
  size_t name_count;
  Dwarf *dwarf;               /* opened by the first look-up; NULL: none */
  bool dwarf_tried;           /* the first look-up has been made */
  struct trax_scopes *scopes; /* of dwarf, in lines.c; NULL: none */
};

/* Makes `names` of the symbols and segments. False: out of memory. */
bool trax_image_order_symbols(trax_image *image);
/* Opens the debug information at the first call. NULL: there is none. */
Dwarf *trax_image_dwarf(trax_image *image);
/* Finds the entry of the function, not inlined, that contains pc. */
bool trax_image_function(trax_image *image, uint32_t pc, Dwarf_Die *function);
void trax_image_forget_lines(trax_image *image);
/* Returns in *reader the bytes of the section with this name. False: there is none. */
bool trax_image_section(const trax_image *image, const char *wanted, trax_dwarf_reader *reader);

#endif
