/* The check of memory (docs/checking.md), private to its files. memory_check.c follows the run, memory_calls.c its
   calls and frames, memory_heap.c the heap. memory_values.c computes the shadow of each result: undefined bits, and the
   object of a pointer. memory_shadow.c keeps the shadow of each byte. memory_objects.c finds the object of an address,
   and memory_constants.c that of a constant. memory_report.c keeps and prints the findings. */
#ifndef TRAX_EXPLAIN_MEMORY_CHECK_H
#define TRAX_EXPLAIN_MEMORY_CHECK_H

#include "explain/places.h"
#include "explain/span.h"
#include "trax/map.h"

/* The value of a register or a word, with its shadow. */
struct trax_memory_value {
  uint32_t bits;
  uint32_t undefined; /* bits that depend on memory that was never written */
  uint32_t tag;       /* the object of a pointer, of trax_memory_check.objects; MEMORY_NO_TAG or MEMORY_MIXED */
  uint32_t from;      /* if bits are undefined: the address from which they were loaded */
};

/* MEMORY_MIXED: computed from pointers to several objects, so nothing is known. MEMORY_PRIVATE: a word outside of the
   heap by which the heap keeps account. Later tags are objects. */
enum { MEMORY_NO_TAG, MEMORY_MIXED, MEMORY_PRIVATE, MEMORY_FIRST_OBJECT };

enum trax_memory_object_kind {
  MEMORY_HALF,   /* no object: `begin` is the upper half of an address that is not complete yet */
  MEMORY_GLOBAL, /* of the program's symbols */
  MEMORY_LOCAL,  /* an automatic variable, of the debug information; what alloca has taken */
  MEMORY_BUFFER, /* of --bind and --alloc */
  MEMORY_BLOCK   /* of the heap */
};

/* The time, place and thread of an allocation, a release or an access. */
struct trax_memory_event {
  uint64_t cycle;
  uint32_t thread, pc, context; /* context: the call chain, of memory_check.contexts */
};

struct trax_memory_object {
  enum trax_memory_object_kind kind;
  uint32_t begin, end;         /* what a pointer to the object may access */
  const char *name;            /* of all but blocks */
  uint32_t own_begin, own_end; /* of these: the named object, without its neighbours */
  bool unnamed;                /* ends where its own memory does, once that is accessed */
  bool freed, reached;         /* of a block; reached: the search for leaks has found a pointer to it */
  struct trax_memory_event allocation, release;
};

enum { MEMORY_PAGE_SHIFT = 12, MEMORY_PAGE = 1 << MEMORY_PAGE_SHIFT };

/* The shadow of a page of global memory. Without one, all is defined, or the page is fresh: nothing was written to it
   since it became a part of a block. */
struct trax_memory_page {
  uint8_t undefined[MEMORY_PAGE];   /* bits */
  uint32_t tags[MEMORY_PAGE / 4];   /* of whole words */
  uint32_t blocks[MEMORY_PAGE / 4]; /* the block that had the word last; 0: none */
};

enum trax_memory_function {
  MEMORY_OTHER,
  MEMORY_MALLOC,
  MEMORY_CALLOC,
  MEMORY_REALLOC,
  MEMORY_ALIGNED,
  MEMORY_FREE,
  MEMORY_USABLE
};

struct trax_memory_call {
  uint32_t return_pc, stack_pointer;
  uint32_t context, low; /* of the caller */
};

enum { MEMORY_RECENT = 8, MEMORY_NO_FRAME = 1 };

struct trax_memory_thread {
  struct trax_memory_value reg[TRAX_NUM_REGISTERS];
  uint8_t local[TRAX_LOCAL_SIZE], local_undefined[TRAX_LOCAL_SIZE]; /* local memory as the checker knows it */
  uint32_t local_tags[TRAX_LOCAL_SIZE / 4];
  uint32_t low; /* the lower end of the current frame, or MEMORY_NO_FRAME: unknown */
  uint32_t context;
  struct trax_memory_call *calls;
  size_t depth, capacity;
  /* The call of a function of the heap that the thread is in; MEMORY_OTHER: none. */
  enum trax_memory_function function;
  uint32_t return_pc, stack_pointer;
  struct trax_memory_value arguments[2];
  uint32_t block; /* that it frees; 0: none */
  struct trax_memory_event event;
  struct {
    uint32_t address, value;
  } recent[MEMORY_RECENT]; /* stores of words, for the number of a host call */
  unsigned stores;
  struct trax_memory_read {
    uint32_t block, address, bytes;
  } read; /* the latest host call that reads, whose result the thread has not loaded yet; bytes 0: none */
};

#define MEMORY_FINDINGS(X)                                                                                             \
  X(OUTSIDE, "an access outside of its object")                                                                        \
  X(NOWHERE, "an access to memory that belongs to no object")                                                          \
  X(FREED, "an access to a freed block")                                                                               \
  X(FRAME, "an access below the stack's frame")                                                                        \
  X(BRANCH, "a branch depends on memory that was never written")                                                       \
  X(ADDRESS, "an address depends on memory that was never written")                                                    \
  X(OUTPUT, "output depends on memory that was never written")                                                         \
  X(DOUBLE_FREE, "a block is freed twice")                                                                             \
  X(INVALID_FREE, "what is freed is not the beginning of a block")                                                     \
  X(LEAK, "a block is lost: no pointer to it is left, and it was not freed")
#define ID(NAME, TEXT) MEMORY_##NAME,
enum trax_memory_finding { MEMORY_NOTHING, MEMORY_FINDINGS(ID) };
#undef ID

struct trax_memory_site {
  enum trax_memory_finding finding;
  struct trax_memory_event event; /* the first */
  uint32_t address, bytes;
  bool write;
  uint32_t object;       /* 0: unknown */
  uint64_t count, total; /* of leaks: blocks, bytes */
};

struct trax_memory_symbol {
  uint32_t begin, end;
  const char *name;
};

struct trax_memory_frame { /* a function, by the address of its first instruction */
  struct trax_map_entry entry;
  int32_t bytes; /* of its frame; -1: unknown */
  enum trax_memory_function function;
};

struct trax_memory_check {
  struct trax_reader reader;
  const trax_machine *machine;
  struct trax_loaded *loaded;
  uint32_t tps;
  struct trax_memory_thread *threads;
  struct trax_memory_page **pages;
  uint32_t *fresh; /* [page_count]: the block of a fresh page; 0: it is not fresh */
  size_t page_count;
  struct trax_memory_object *objects; /* by tag */
  size_t object_count, object_capacity;
  struct trax_map object_of;          /* of constants: the key says which */
  struct trax_memory_symbol *symbols; /* of objects in global memory, in the order of addresses */
  size_t symbol_count;
  uint8_t *padding; /* a bit for each byte from image_begin to image_end that belongs to no object */
  uint32_t image_begin, image_end, heap_begin, heap_end, thread_local_end;
  struct trax_map functions;    /* struct trax_memory_frame by address */
  struct trax_map variables_of; /* by a function's address: in `variables` */
  struct trax_memory_variables {
    struct trax_frame_variable *items;
    size_t count;
    unsigned base; /* the register from which their offsets count */
  } *variables;
  size_t variables_count, variables_capacity;
  struct trax_memory_context {
    uint32_t parent, pc;
  } *contexts;
  size_t context_count, context_capacity;
  struct trax_map context_of;
  struct trax_memory_site *sites;
  size_t site_count, site_capacity;
  struct trax_map site_of;
};

/* --- memory_values.c --- */
/* The result, with its shadow, of an instruction that accesses no memory. */
struct trax_memory_value trax_memory_result(struct trax_memory_check *check, const struct trax_memory_thread *thread,
                                            const struct trax_span *span);
/* Whether undefined bits decide a conditional branch. */
bool trax_memory_branch_is_undefined(const struct trax_memory_thread *thread, trax_inst inst);

/* --- memory_calls.c --- */
trax_status trax_memory_calls_open(struct trax_memory_check *check, trax_error *error);
struct trax_memory_event trax_memory_event_of(const struct trax_memory_check *check, const struct trax_span *span);
void trax_memory_call(struct trax_memory_check *check, const struct trax_span *span);
/* Follows a jump that writes no register: a return, a longjmp or a tail call. */
void trax_memory_jump(struct trax_memory_check *check, const struct trax_span *span);
/* Called after an instruction that has changed the stack pointer, which was `before`. */
void trax_memory_move_stack(struct trax_memory_check *check, const struct trax_span *span, uint32_t before);

/* --- memory_objects.c --- */
trax_status trax_memory_objects_open(struct trax_memory_check *check, trax_error *error);
void trax_memory_objects_close(struct trax_memory_check *check);
uint32_t trax_memory_object_add(struct trax_memory_check *check, const struct trax_memory_object *object);
/* Checks an access by a pointer with a tag; imm: of the instruction. *object: the object that it misses, or 0. */
enum trax_memory_finding trax_memory_check_access(struct trax_memory_check *check, uint32_t thread, uint32_t tag,
                                                  int32_t imm, uint32_t address, uint32_t bytes, uint32_t *object);
/* The lower end of the memory of a thread's stack, and its upper end, which may be 0. */
void trax_memory_stack_of(const struct trax_memory_check *check, uint32_t thread, uint32_t *begin, uint32_t *end);

/* --- memory_constants.c --- */
/* The tag of an upper half; of a constant address; of a constant distance from a register in a frame. */
uint32_t trax_memory_tag_of_half(struct trax_memory_check *check, uint32_t half);
uint32_t trax_memory_tag_of_address(struct trax_memory_check *check, uint32_t address);
uint32_t trax_memory_tag_of_frame(struct trax_memory_check *check, uint32_t pc, unsigned base, int32_t offset,
                                  uint32_t address);

/* --- memory_shadow.c --- */
/* The latest block at an address; 0: none. */
uint32_t trax_memory_block_at(const struct trax_memory_check *check, uint32_t address);
/* [begin, end) becomes a block, of which the bytes from `undefined` on are undefined. */
void trax_memory_set_block(struct trax_memory_check *check, uint32_t block, uint32_t begin, uint32_t undefined,
                           uint32_t end);
/* The tag of a word. */
uint32_t trax_memory_tag_at(const struct trax_memory_check *check, uint32_t thread, uint32_t address);
struct trax_memory_page *trax_memory_page_of(struct trax_memory_check *check,
                                             uint32_t address); /* NULL: out of memory */
/* The bytes from an address on become undefined, or defined. */
void trax_memory_define(struct trax_memory_check *check, uint32_t thread, uint32_t address, uint32_t bytes,
                        bool undefined);
/* The undefined bits of a byte. */
uint8_t trax_memory_undefined_byte(const struct trax_memory_check *check, uint32_t thread, uint32_t address);
/* A byte of the program's memory as the thread sees it; false: there is none. */
bool trax_memory_byte(const struct trax_memory_check *check, uint32_t thread, uint32_t address, uint8_t *byte);
bool trax_memory_word(const struct trax_memory_check *check, uint32_t thread, uint32_t address, uint32_t *word);

/* --- memory_heap.c --- */
void trax_memory_heap_enter(struct trax_memory_check *check, uint32_t thread, enum trax_memory_function function,
                            const struct trax_memory_event *event);
void trax_memory_heap_leave(struct trax_memory_check *check, uint32_t thread);
trax_status trax_memory_find_leaks(struct trax_memory_check *check, trax_error *error);

/* --- memory_report.c --- */
void trax_memory_note(struct trax_memory_check *check, enum trax_memory_finding finding,
                      const struct trax_memory_event *event, uint32_t address, uint32_t bytes, bool write,
                      uint32_t object);
void trax_memory_print(const struct trax_memory_check *check, FILE *out);

#endif
