/* Small programs, by name. */
#ifndef TRAX_TESTS_PROGRAMS_H
#define TRAX_TESTS_PROGRAMS_H

#include "elf_writer.h"

/*   hello   prints "hello" and a newline
     exit3   ends with status 3
     null    its third instruction loads from the null page; has lines and the symbol `outer`
     abort   aborts with the message "out of luck"
     spin    never ends; counts items
     idle    never ends, and nobody sees what it does
     items   finishes 1000 items
     copy    copies the buffer `input` to the buffer `output`, words; also has __trax_heap and __trax_heap_end
     mix     every thread 50 times: every kind of unit, memory and atomics; counts a ray each time
     lines   loads from the lines A, B, C, D, B, A, E, C, D of 64 bytes, each when the one before has come
     print   prints "." for ever
     signature  stores two words, of which end_signature follows the second, and a third, and loads from address 4 */
extern const char *const program_names[]; /* NULL-terminated */

/* The file of a program; of an unknown name its bytes are NULL. */
struct elf_file program_file(const char *name);

/* Addresses in the data of the program `copy`. */
enum { COPY_INPUT = DATA, COPY_OUTPUT = DATA + 8, COPY_HEAP = DATA + 16, COPY_HEAP_END = DATA + 20 };

#endif
