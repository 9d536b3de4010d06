/* The machine of docs/isa.md, made from that page: each instruction's section gives its encoding, its operands and the
   statement that it executes; docs/abi.md gives special registers, traps and the address space. Nothing here comes from
   the description's generated tables or from the emulator, and binary32 arithmetic is that of tests/isa/oracle, so that
   the emulator can be compared with it. There is no time: threads take turns of one instruction.

   Functions that can fail return false, or NULL, with the reason in *error. */
#ifndef TRAX_ISA_MODEL_H
#define TRAX_ISA_MODEL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

struct model_error {
  char message[512];
};
__attribute__((format(printf, 2, 3))) bool model_fail(struct model_error *error, const char *format, ...);

/* --- the instructions: manual.c --- */

enum model_field { MODEL_FIELD_RD, MODEL_FIELD_RA, MODEL_FIELD_RB, MODEL_FIELD_IMM, MODEL_FIELDS };

struct model_instruction {
  char *mnemonic;
  unsigned line;        /* of its heading in the manual */
  uint32_t mask, match; /* the bits that are fixed, and their values */
  struct {
    unsigned low, width; /* in bits; width 0: the instruction lacks the field */
  } field[MODEL_FIELDS];
  bool imm_signed;
  uint32_t imm_scale;            /* IMM is the field's value times this */
  uint32_t imm_first, imm_limit; /* values of the field below and from there on are illegal; a limit of 0: none */
  struct model_node *semantics;
};

struct model_isa {
  struct model_instruction *instructions;
  size_t count;
};

/* From the manual's text; name is what messages call it. Of the sections headed `### MNEMONIC`, those with a line
   "Semantics: `STATEMENT`" are instructions. They also have a diagram, the bits of each box in one line and the boxes
   below it, and, where a box is called imm or offset, a line "IMM is bits H..L, sign|zero extended[, times N].[ Values
   of N and above are illegal.[ Values below N are illegal.]]" */
struct model_isa *model_isa_parse(const char *name, const char *text, struct model_error *error);
struct model_isa *model_isa_read(const char *path, struct model_error *error);
void model_isa_free(struct model_isa *isa);
/* NULL: the word is illegal. */
const struct model_instruction *model_decode(const struct model_isa *isa, uint32_t word);
/* Register numbers, and IMM's value; 0 for fields that the instruction lacks. */
void model_operands(const struct model_instruction *instruction, uint32_t word, uint32_t operand[MODEL_FIELDS]);

/* --- the machine: machine.c, memory.c --- */

#define MODEL_NULL_END 0x1000u
#define MODEL_LOCAL_BASE 0xFFFFFE00u
#define MODEL_LOCAL_BYTES 512u
#define MODEL_REGISTERS 32

/* Kinds of faults and their words in a signature, in the order in which they are looked for. */
#define MODEL_FAULTS(X)                                                                                                \
  X(NONE, "none")                                                                                                      \
  X(MISALIGNED_PC, "misaligned-pc")                                                                                    \
  X(FETCH, "fetch")                                                                                                    \
  X(ILLEGAL, "illegal")                                                                                                \
  X(NULL, "null")                                                                                                      \
  X(STACK, "stack")                                                                                                    \
  X(UNMAPPED, "unmapped")                                                                                              \
  X(MISALIGNED, "misaligned")                                                                                          \
  X(LOCAL, "local")                                                                                                    \
  X(READ_ONLY, "readonly")                                                                                             \
  X(ABORT, "abort")

enum model_fault_kind {
#define MODEL_FAULT_KIND(ID, WORD) MODEL_FAULT_##ID,
  MODEL_FAULTS(MODEL_FAULT_KIND)
#undef MODEL_FAULT_KIND
};

struct model_fault {
  enum model_fault_kind kind;
  uint32_t pc, address, thread;
};

struct model_thread {
  uint32_t registers[MODEL_REGISTERS], pc;
  uint8_t local[MODEL_LOCAL_BYTES];
  uint32_t number, tm, tp;
  bool ended;
  uint32_t status; /* of one that has ended */
};

enum { MODEL_READ = 1, MODEL_WRITE = 2, MODEL_EXECUTE = 4 };

struct model_segment {
  uint32_t address, bytes;
  unsigned permissions;
};

struct model_machine {
  const struct model_isa *isa;
  uint32_t tms, tps;
  unsigned precision; /* of the FPDIV/iSQRT unit in bits of the significand; 24: correctly rounded */
  FILE *output;       /* of the traps; NULL discards it */
  uint8_t *memory;    /* memory[address] up to size */
  uint64_t size;      /* end of global memory */
  struct model_segment *segments;
  size_t segment_count;
  uint32_t stack_bytes; /* of each thread's stack at the end of memory; 0: stacks are in local memory */
  struct model_thread *threads;
  uint32_t thread_count;
  uint64_t turns, instructions;
  struct model_fault fault;
};

/* tms TMs of tps threads each, all registers zero. size: end of global memory, a multiple of 4096. */
struct model_machine *model_create(const struct model_isa *isa, uint32_t tms, uint32_t tps, uint64_t size,
                                   struct model_error *error);
void model_destroy(struct model_machine *machine);
/* A segment at a multiple of 64, zeroed; *host are its bytes. Its permissions hold to the next multiple of 64. */
bool model_map(struct model_machine *machine, uint32_t address, uint32_t bytes, unsigned permissions, uint8_t **host,
               struct model_error *error);
void model_set_entry(struct model_machine *machine, uint32_t pc);

enum model_end {
  MODEL_ENDED,   /* every thread */
  MODEL_FAULTED, /* machine->fault tells */
  MODEL_LIMIT,   /* the limit of instructions was reached */
  MODEL_ERROR    /* the manual's semantics have no defined result here; *error tells */
};
/* limit: instructions of all threads; 0: none. */
enum model_end model_run(struct model_machine *machine, uint64_t limit, struct model_error *error);
/* One instruction of a thread that has not ended. False: *error tells. */
bool model_step(struct model_machine *machine, struct model_thread *thread, struct model_error *error);
/* The status of the lowest-numbered thread whose status is not 0, else 0. */
uint32_t model_status(const struct model_machine *machine);
const char *model_fault_word(enum model_fault_kind kind);

enum model_access { MODEL_LOAD, MODEL_STORE, MODEL_INCREMENT };
/* MODEL_FAULT_NONE if the thread may access 1, 2 or 4 bytes there. */
enum model_fault_kind model_check(const struct model_machine *machine, uint32_t address, uint32_t bytes,
                                  enum model_access access);
/* The words that were checked, little endian. */
uint32_t model_load(struct model_machine *machine, struct model_thread *thread, uint32_t address, uint32_t bytes,
                    bool past_cache);
void model_store(struct model_machine *machine, struct model_thread *thread, uint32_t address, uint32_t value,
                 uint32_t bytes, bool past_cache);
uint32_t model_increment(struct model_machine *machine, struct model_thread *thread, uint32_t address);

enum model_fence { MODEL_FENCE_R = 1, MODEL_FENCE_W, MODEL_FENCE_RW };
void model_fence(struct model_machine *machine, struct model_thread *thread, enum model_fence kind);

/* --- programs: image.c --- */

struct model_image {
  uint32_t begin_signature, end_signature; /* both 0 if the image has none */
};
/* Maps an executable's segments, stores the words that the loader fills (docs/abi.md, "Buffers") and sets the entry. */
bool model_load_image(struct model_machine *machine, const char *path, struct model_image *image,
                      struct model_error *error);

#endif
