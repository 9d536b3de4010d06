/* The loaded program of a machine: its image and the buffers bound to it. */
#ifndef TRAX_PROGRAM_PROGRAM_H
#define TRAX_PROGRAM_PROGRAM_H

#include "machine/machine.h"
#include "program/image.h"

/* Bytes before and behind each buffer that must not be accessed, so that a program's error is noticed. A multiple of
   the size of a way of most caches, so that buffers keep their sets. */
#define TRAX_BUFFER_GUARD 65536u

struct trax_bound_buffer {
  char *symbol;
  uint32_t address, bytes;
};

struct trax_loaded {
  trax_image *image;
  struct trax_bound_buffer *buffers;
  size_t buffer_count;
  uint64_t free_address; /* the end of image, buffers and their guards, a multiple of 64; at most memory_end */
  uint64_t guard_end;    /* the end of the latest guard */
  uint64_t memory_end;   /* the end of image, buffers and heap: the lower end of the lowest stack, or of memory */
  uint32_t stack_bytes;  /* size of each thread's stack in global memory; 0: stacks are in local memory */
};

/* docs/abi.md, "Registers" */
extern const char *const trax_register_names[TRAX_NUM_REGISTERS];

/* --- loader.c, for arguments.c --- */
/* Finds an object of at least `bytes` bytes in the program's data, which the emulator may fill. NULL, with *error set:
   there is none. */
const struct trax_symbol *trax_loaded_object(const struct trax_machine *machine, const char *name, uint32_t bytes,
                                             trax_error *error);
void trax_loaded_store_word(struct trax_machine *machine, uint32_t address, uint32_t value);
/* Takes memory after image and buffers, where the heap begins. Error: there is too little. */
trax_status trax_loaded_take(struct trax_machine *machine, uint32_t bytes, uint32_t *address, trax_error *error);

/* --- unbound.c --- */
/* Finds the first struct trax_buffer to which nothing is bound, from symbol number *from on, and moves *from past it.
   Returns its name; NULL if there is none. Without debug information it may be another variable of that size. */
const char *trax_loaded_unbound(const struct trax_machine *machine, size_t *from);

/* --- arguments.c --- */
/* The library's object for argc and argv, which programs have whose main uses them. */
#define TRAX_ARGUMENTS_SYMBOL "__trax_arguments"
/* Gives a main with parameters the program's name alone. */
trax_status trax_loaded_set_name(struct trax_machine *machine, trax_error *error);

/* NULL: no program is loaded. */
static inline struct trax_loaded *trax_loaded_of(const struct trax_machine *machine) {
  return machine->loaded;
}

#endif
