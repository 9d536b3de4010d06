/* Renumbers registers in debug information, in place: the numbers 0 to 31 take one byte in every encoding, so nothing
   moves. */
#ifndef TRAX_GDB_DWARF_REGISTERS_H
#define TRAX_GDB_DWARF_REGISTERS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* [0..31]: the new number of register i. */
typedef const uint8_t *trax_register_map;

/* Each function returns false if the bytes are malformed; some of them may have been changed then. */
bool trax_dwarf_renumber_expression(uint8_t *bytes, size_t size, trax_register_map map);
bool trax_dwarf_renumber_frames(uint8_t *bytes, size_t size, trax_register_map map);    /* .debug_frame */
bool trax_dwarf_renumber_locations(uint8_t *bytes, size_t size, trax_register_map map); /* .debug_loc */
bool trax_dwarf_renumber_lists(uint8_t *bytes, size_t size, trax_register_map map);     /* .debug_loclists */

#endif
