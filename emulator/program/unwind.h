/* Call chains, by .debug_frame. libdw's own unwinder refuses machines that it has no back end for. */
#ifndef TRAX_PROGRAM_UNWIND_H
#define TRAX_PROGRAM_UNWIND_H

#include "program/image.h"
#include "trax/abi.h"

struct trax_frame {
  uint32_t pc; /* of the innermost the next instruction, of others the one to return to */
  bool is_caller;
  uint32_t registers[TRAX_NUM_REGISTERS];
};

/* The instruction that a frame is at: of a caller, its call. */
static inline uint32_t trax_frame_place(const struct trax_frame *frame) {
  return frame->is_caller ? frame->pc - 4 : frame->pc;
}

enum trax_unwound {
  TRAX_UNWOUND,      /* *frame is the caller's */
  TRAX_OUTERMOST,    /* the frame has no caller */
  TRAX_NO_FRAME_INFO /* nobody knows: no information, damaged information, or a stack that is not there */
};

/* read gives the word at an address of the frame's thread, or returns false. */
enum trax_unwound trax_image_unwind(const trax_image *image, struct trax_frame *frame,
                                    bool (*read)(void *context, uint32_t address, uint32_t *word), void *context);

#endif
