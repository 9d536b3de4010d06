/* Call chains, by .debug_frame. libdw's unwinder does not work for machines without a back end in libdw. */
#ifndef TRAX_PROGRAM_UNWIND_H
#define TRAX_PROGRAM_UNWIND_H

#include "program/image.h"
#include "trax/abi.h"

struct trax_frame {
  uint32_t pc; /* the next instruction of the innermost frame, the return address of other frames */
  bool is_caller;
  uint32_t registers[TRAX_NUM_REGISTERS];
};

/* Returns the address of the instruction that a frame executes. A caller executes its call. */
static inline uint32_t trax_frame_place(const struct trax_frame *frame) {
  return frame->is_caller ? frame->pc - 4 : frame->pc;
}

enum trax_unwound {
  TRAX_UNWOUND,      /* *frame is the caller's */
  TRAX_OUTERMOST,    /* the frame has no caller */
  TRAX_NO_FRAME_INFO /* unknown: no or damaged information, or a stack outside memory */
};

/* Replaces *frame by its caller's. read reads a word at an address of the frame's thread, and returns false if there is
   none. */
enum trax_unwound trax_image_unwind(const trax_image *image, struct trax_frame *frame,
                                    bool (*read)(void *context, uint32_t address, uint32_t *word), void *context);

#endif
