/* Private to the translator: the translation of a program, and the functions of its files. */
#ifndef TRAX_TRANSLATE_INTERNAL_H
#define TRAX_TRANSLATE_INTERNAL_H

#include "translate/burst.h"
#include "translate/state.h"
#include "translate/template.h"
#include "translate/translate.h"

enum {
  TRAX_SEQUENCE = 1024,         /* most instructions of a sequence */
  TRAX_SEQUENCE_CODE = 1 << 20, /* most bytes of its code */
  TRAX_MORE_CODE = 1024,        /* most bytes of an instruction besides its template: moves and exits */
  TRAX_STUBS = TRAX_MOST_STUBS * (TRAX_SEQUENCE + 1), /* most of its exits and cold parts */
  TRAX_EXITS = 1 << 16,                               /* most exits of all sequences */
  TRAX_CODE = 32 << 20                                /* most bytes of all code */
};

/* The index that `enter` returns: of the next instruction, or ANYWHERE (trax_translated.pc has it); IS_SLOW is added.
 */
#define TRAX_ANYWHERE 0x7FFFFFFFu
#define TRAX_IS_SLOW 0x80000000u

/* A place of a value: a register of the host, trax_translated.reg[number], or none, if it is 0. */
enum trax_place_kind { TRAX_ZERO, TRAX_IN_MEMORY, TRAX_INT, TRAX_FLOAT };
struct trax_place {
  enum trax_place_kind kind;
  unsigned number;
};

/* The latest result of the sequence: the thread's register, or 0, and whether it still is in xmm0, or in ecx. */
struct trax_result {
  unsigned n;
  bool is_float;
};

/* The code behind the hot parts of a sequence: exits, and the cold parts of templates. */
struct trax_stub {
  enum trax_hole_kind kind;             /* JUMPS, SLOW or COLD */
  uint8_t *place;                       /* that leads to it; COLD: where the hot part begins */
  const uint8_t *end;                   /* COLD: where it ends */
  const struct trax_template *template; /* COLD */
  size_t index;                         /* of the instruction */
};

struct trax_translation {
  const struct trax_space *space;
  const struct trax_burst_facts *bursts; /* NULL: the code is no bursts' */
  unsigned precision;
  uint32_t tms;
  struct trax_translated **state; /* [tms] */

  size_t count;                        /* of instructions */
  const struct trax_decoded **decoded; /* [count] */
  uint32_t *pc;                        /* [count] */
  uint32_t *heat;                      /* [count]: how often its sequence was interpreted */
  uint32_t *hot;                       /* [count], of which hot_count are to be translated */
  size_t hot_count;
  uint64_t interpreted; /* sequences */
  uint32_t hot_after;   /* so many times */
  uint64_t first;       /* the first translation is after so many sequences */
  bool has_frame, ends; /* the first translation is done; no further one follows */
  bool is_broken;       /* the code cannot be executed */

  struct trax_place place[TRAX_NUM_REGISTERS + 1]; /* of the thread's registers, in all sequences */
  struct trax_exit {
    uint32_t begin, end; /* the instructions that were executed when it is taken */
  } exits[TRAX_EXITS];
  unsigned exit_count;
  struct trax_stub stubs[TRAX_STUBS]; /* of the sequence that is translated */
  unsigned stub_count;
  struct trax_result last;
  size_t begin; /* of the sequence */

  /* One mapping: the entries, the pool of constants, the code. */
  uint8_t *mapping;
  size_t mapping_bytes;
  const uint8_t **entry; /* [count]: the code of the sequence that begins there, or `leave` */
  uint16_t *step;        /* [count + TRAX_PIECE]: a copy of trax_burst_facts.step, near the code */
  uint16_t *number;      /* [count + TRAX_PIECE]: 0, 1 and so on */
  const uint8_t *pool;
  uint8_t *code, *at;           /* the next byte */
  const uint8_t *enter, *leave; /* called by C; returns to C */
};

/* --- emit.c: code of x86-64 --- */
void trax_emit(struct trax_translation *t, const void *bytes, size_t count);
void trax_emit_byte(struct trax_translation *t, unsigned byte);
void trax_emit_word(struct trax_translation *t, uint32_t word);
/* The distance of `to` from the end of these four bytes. */
void trax_emit_distance(struct trax_translation *t, const void *to);
void trax_set_distance(uint8_t *place, const uint8_t *to);
/* `to` is not TRAX_ZERO, and not both are in memory. */
void trax_emit_move(struct trax_translation *t, struct trax_place to, struct trax_place from);
/* Gives places to the thread's registers: of the host's that templates keep, those of a kind in the order of weight. */
void trax_set_places(struct trax_translation *t, uint64_t weight[TRAX_NUM_REGISTERS + 1][2]);
/* Writes `enter` and `leave`. */
void trax_emit_frame(struct trax_translation *t);

/* --- instruction.c: an instruction as its template --- */
/* Whether the interpreter must execute it in every case. */
bool trax_is_always_slow(const struct trax_decoded *inst);
/* Whether it can lead to the next instruction. */
bool trax_goes_on(const struct trax_decoded *inst);
/* Returns the bytes of its largest template. */
size_t trax_most_code(const struct trax_translation *t, const struct trax_decoded *inst);
void trax_emit_template(struct trax_translation *t, const struct trax_template *template, size_t index);
void trax_emit_cold(struct trax_translation *t, struct trax_stub stub);
void trax_emit_instruction(struct trax_translation *t, size_t index);
/* Adds `count` to the weight of the registers that an instruction uses, as an integer [0] and as a float [1]. */
void trax_add_weight(const struct trax_decoded *inst, uint64_t count, uint64_t weight[TRAX_NUM_REGISTERS + 1][2]);

/* --- burst.c: the records of bursts --- */
/* Records the `count` instructions from `begin` on as steps, or leaves if the burst has no place for them. Returns the
   beginning of this code. */
const uint8_t *trax_emit_record(struct trax_translation *t, size_t begin, size_t count);
/* Records the jump behind the instruction end - 1, to `target` or, if that is NULL, to the first segment's byte ecx. */
void trax_emit_taken(struct trax_translation *t, size_t end, const size_t *target);

/* --- translate.c --- */
/* Requests the translation of the sequence that begins with an instruction. */
void trax_translation_add(struct trax_translation *t, size_t index);

/* --- sequence.c --- */
/* Translates the sequence that begins at `begin`. */
void trax_translate(struct trax_translation *t, size_t begin);

#endif
