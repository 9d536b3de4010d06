/* Translated programs: sequences of a program's instructions as code of the host, made of templates (templates.c) when
   they have been executed often. A sequence begins where a jump has led and ends at a jump that always jumps. The
   interpreter executes what is not translated, and the slow instructions: those that access memory past a cache or
   atomically, traps, fences, halt, special registers, faults. */
#ifndef TRAX_TRANSLATE_TRANSLATE_H
#define TRAX_TRANSLATE_TRANSLATE_H

#include "machine/text.h"
#include "translate/burst.h"

struct trax_translation;

/* The end of a run of translated code. */
enum trax_translated_end {
  TRAX_TRANSLATED_JUMPED, /* after a taken jump: to a place that is not translated, or at the end of the instructions */
  TRAX_TRANSLATED_SLOW    /* before an instruction that the interpreter must execute */
};

/* A thread as translated code executes it. */
struct trax_translated_thread {
  uint32_t *reg; /* [TRAX_NUM_REGISTERS] */
  uint8_t *local;
  uint32_t tm, pc;
  int64_t left; /* instructions; the run ends with the first taken jump after which it is not positive */
};

/* A burst as translated code executes it. */
struct trax_translated_burst {
  uint32_t *reg; /* [TRAX_NUM_REGISTERS] */
  uint8_t *local;
  int64_t *deltas; /* [instruction + 1]: as in trax_translation_collect */
  struct trax_burst *burst;
  uint32_t tm;
  uint32_t input_bytes; /* of trax_space.input: those that are not written */
  /* out: the instruction after the burst; TRAX_NO_INDEX: after a jump to pc, which the caller must find and count. */
  uint32_t index, pc;
};
#define TRAX_NO_INDEX UINT32_MAX

/* An instruction's index is its number in the program: those of the segments one after the other, each with one that is
   no text behind it. at_once: sequences are translated after they were interpreted once, for tests; of bursts, the
   first call of trax_translation_extend translates all. bursts: the code is for bursts; else NULL. Returns NULL if the
   host cannot: that costs speed and nothing else. */
struct trax_translation *trax_translation_create(const struct trax_text *text, const struct trax_space *space,
                                                 unsigned precision, uint32_t tms, bool at_once,
                                                 const struct trax_burst_facts *bursts);
void trax_translation_destroy(struct trax_translation *translation);

/* Whether the sequence that begins with an instruction is translated. If not, it is about to be interpreted, which is
   counted. Several threads of the host may call this at the same time. */
bool trax_translation_has(struct trax_translation *translation, size_t index);
/* Translates the sequences that were interpreted often. No thread of the host may execute translated code. */
void trax_translation_extend(struct trax_translation *translation);
/* Runs the thread from `index` on, which is translated and at thread->pc. */
enum trax_translated_end trax_translation_run(struct trax_translation *translation, size_t index,
                                              struct trax_translated_thread *thread);
/* Executes a burst from `index` on, which is translated. Returns the number of its steps; 0: the interpreter must
   execute the instruction. */
unsigned trax_translation_burst(struct trax_translation *translation, size_t index, struct trax_translated_burst *run);
/* Adds the instructions that the TM's threads have executed since the latest call to deltas: the sum of [0] to [i]
   counts instruction i. */
void trax_translation_collect(struct trax_translation *translation, uint32_t tm, int64_t *deltas);

#endif
