/* Renumbering registers in debug information, in place: every register of 0 to 31 is one byte wherever it is named, so
   nothing moves. */
#ifndef TRAX_GDB_DWARF_REGISTERS_H
#define TRAX_GDB_DWARF_REGISTERS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* [0..31]: what register i is to be called. */
typedef const uint8_t *trax_register_map;

/* Each returns false if the bytes are not what they should be; some may have been changed then. */
bool trax_dwarf_renumber_expression(uint8_t *bytes, size_t size, trax_register_map map);
bool trax_dwarf_renumber_frames(uint8_t *bytes, size_t size, trax_register_map map);    /* .debug_frame */
bool trax_dwarf_renumber_locations(uint8_t *bytes, size_t size, trax_register_map map); /* .debug_loc */
bool trax_dwarf_renumber_lists(uint8_t *bytes, size_t size, trax_register_map map);     /* .debug_loclists */

#endif
