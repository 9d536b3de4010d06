/* Spans, passages and readers. A span is what a thread did from the issue of one instruction to the issue of the next.
   Readers of spans are called for those of all threads in the order of the issues that end them, which does not depend
   on the engine. A passage is what a thread did for a stretch of instructions (machine/observer.h). Readers of passages
   are much faster, since the engine executes ahead for them. Only the passages of one thread are in order, and those
   that end with a trap, a call, a return, or a write of the stack pointer, which each are passages of their own. They
   come later than the engine goes on. One thread of the host at a time calls a reader, perhaps not the engine's, and
   others may call other readers meanwhile. */
#ifndef TRAX_EXPLAIN_SPAN_H
#define TRAX_EXPLAIN_SPAN_H

#include "engine/run.h"
#include "explain/objects.h"
#include "program/program.h"
#include "report/statistics.h"
#include "trax/explain.h"
#include "trax/output.h"

/* Consecutive cycles that were charged to one cause. */
struct trax_charge {
  trax_cause cause;
  uint8_t rd; /* the register that the thread waited for; 0: none */
  uint64_t since, cycles;
};

struct trax_span {
  uint32_t tm, tp, thread;
  uint32_t pc;          /* of the instruction that ends the span */
  uint32_t index;       /* its index in the places */
  uint32_t previous_pc; /* of the thread's last instruction, to which a branch bubble belongs; pc if there is none */
  uint64_t begin;       /* the first cycle of the span */
  const struct trax_charge *charges;
  size_t count;
  const struct trax_issue *issue; /* NULL: the run ended before the issue, or the thread has halted */
  trax_inst inst;                 /* the instruction; illegal if pc is no text */
};

struct trax_passage {
  uint32_t thread;
  uint32_t context; /* the thread's call chain, a number of the profile's; 0 without one */
  uint32_t next_pc; /* of the last instruction */
  uint32_t last;    /* its index */
  uint32_t result;  /* trax_stretch */
  trax_inst inst;   /* if it is the only one; else illegal */
  uint16_t count;   /* instructions; 0: at the end of the run, the charges since the thread's last instruction */
  uint16_t pieces, accessed_count;
  uint8_t kind;        /* of the ray that the thread works for, the passage's included (explain/ray_kinds.h) */
  bool stores, misses; /* trax_stretch */
  uint32_t charged_count;
  struct trax_piece *piece;             /* [pieces]; each index is one of the places */
  struct trax_charged *charged;         /* [charged_count]; those before an instruction come before its access */
  const struct trax_accessed *accessed; /* [accessed_count] */
  const uint8_t *refused;               /* trax_stretch.refused, followed by 8 bytes that may be read */
  const uint64_t *cycles; /* [TRAX_CAUSE_COUNT]: of the thread so far, with this passage; only if it is a trap, or
                             at the end of the run */
};

/* The index of an instruction of the passage. */
static inline uint32_t trax_passage_index(const struct trax_passage *passage, unsigned at) {
  const struct trax_piece *piece = passage->piece;
  for (; at >= piece->count; piece++)
    at -= piece->count;
  return piece->index + at;
}

enum { TRAX_OUTCOMES = 16 };

/* Counts of an instruction over many passages. */
struct trax_counts {
  uint32_t context, index;
  unsigned kind;
  uint64_t executed, fetch, others; /* fetch, others: its refusals (trax_stretch.refused) */
  const struct trax_region *region; /* of its accesses to global memory; NULL: it has none */
  uint64_t outcomes[TRAX_OUTCOMES]; /* such accesses by their outcome */
};

enum { TRAX_READER_FILES = 3 };

/* A kind of reader. Its object begins with a struct trax_reader. Functions may be NULL. */
struct trax_reader_kind {
  size_t bytes; /* of the object, which is zero before open() */
  struct trax_reader_file {
    size_t path; /* of the options, by TRAX_EXPLAIN_PATH; 0: the text is for the page alone */
    /* Writes the text after the run. NULL: the file is open during the run, for the reader to write to. */
    trax_status (*put)(void *self, FILE *out, trax_error *error);
    const char *member; /* the member of the page that has the same text; NULL: none */
  } files[TRAX_READER_FILES];
  bool in_page;                                                  /* the page needs the reader */
  bool (*is_wanted)(const struct trax_explain_options *options); /* whether other options need it */
  trax_status (*open)(void *self, trax_error *error);
  void (*span)(void *self, const struct trax_span *span);
  /* Called for each passage before `passage`, in the order of the chip, by one thread of the host; sets the passage's
     context or kind. */
  void (*follow)(void *self, struct trax_passage *passage);
  void (*passage)(void *self, const struct trax_passage *passage);
  bool (*wants_passages)(const struct trax_explain_options *options); /* NULL: always */
  /* Called with the counts of all passages: those of an instruction, context and kind may come in several parts, each
     with another region. */
  void (*counts)(void *self, const struct trax_counts *counts);
  /* Called in the order of (cycle, TM), before the spans that end with issues of the same cycle and TM. */
  void (*arrival)(void *self, const struct trax_arrival *arrival);
  trax_status (*end)(void *self, trax_error *error); /* called after the last span, before the files are written */
  /* Writes further members of the page's data (explain/page.h). */
  trax_status (*put_members)(void *self, FILE *out, trax_error *error);
  void (*close)(void *self); /* also called if open() has failed */
};
#define TRAX_EXPLAIN_PATH(MEMBER) (offsetof(struct trax_explain_options, MEMBER) + 1)

struct trax_reader {
  const struct trax_reader_kind *kind;
  struct trax_explain *explain;
  FILE *out; /* the file that is written during the run; NULL: none */
  trax_output output;
};

/* The kinds of readers, in the order in which the page has their members. */
#define TRAX_READERS(X)                                                                                                \
  X(profile)                                                                                                           \
  X(trace)                                                                                                             \
  X(perfetto)                                                                                                          \
  X(heat)                                                                                                              \
  X(waits)                                                                                                             \
  X(items)                                                                                                             \
  X(ray_kinds)                                                                                                         \
  X(memory_check)                                                                                                      \
  X(races)                                                                                                             \
  X(series)                                                                                                            \
  X(page_series)                                                                                                       \
  X(memory_trace)                                                                                                      \
  X(page)

#define DECLARE(ID) extern const struct trax_reader_kind trax_##ID##_reader;
TRAX_READERS(DECLARE)
#undef DECLARE
#define COUNT(ID) +1
enum { TRAX_READER_KINDS = 0 TRAX_READERS(COUNT) };
#undef COUNT

/* A thread's cycles by cause at the begin of the run, and its cycles so far, if the engine tells of each issue. */
struct trax_open_thread {
  uint64_t begin_cycles[TRAX_CAUSE_COUNT], cycles[TRAX_CAUSE_COUNT];
};

struct trax_explain {
  trax_machine *machine;
  struct trax_explain_options options;
  struct trax_observer observer;
  struct trax_open_span *open_spans;     /* [threads]: since the latest issue of each */
  bool has_spans, has_passages;          /* readers take them */
  struct trax_open_thread *open_threads; /* [threads] */
  uint32_t *end_pcs;                     /* [threads]: where its passages go on */
  bool begun, by_issue;                  /* the run has begun; the engine tells of each issue and charge */
  uint64_t round;                        /* number of rounds in which passages were read (explain/passages.h) */
  uint32_t found;                        /* what is new in the passages that are read (explain/passages.h) */
  struct trax_passages *passages;
  struct trax_places *places;
  struct trax_objects objects;
  struct trax_reader *readers[TRAX_READER_KINDS];
  unsigned reader_count;
  struct trax_arrival *arrivals; /* those of which the readers have not been notified yet */
  size_t arrival_count, arrival_capacity;
  struct trax_explore_picture picture; /* of the page; width 0: none */
  struct trax_pixels *pixels;          /* for it; NULL: items store to no buffer that is known */
  struct trax_stories *stories;        /* of its pixels; NULL: none are kept */
  struct trax_pixel_rays *pixel_rays;  /* the same */
  bool out_of_memory;                  /* something was lost: no file is written */
};

/* Whether the window contains a part of the TP's cycles begin <= t < end. */
bool trax_window_has(const struct trax_explain_options *options, uint32_t tm, uint32_t tp, uint64_t begin,
                     uint64_t end);

/* Adds a structure of 64-bit counters to another one; subtracts it if sign is -1. */
static inline void trax_counters_add(void *sum, const void *terms, size_t bytes, int sign) {
  for (size_t i = 0; i < bytes / sizeof(uint64_t); i++)
    ((uint64_t *)sum)[i] += (uint64_t)sign * ((const uint64_t *)terms)[i];
}

/* Allocates an array of zeros. NULL, with *error set: out of memory. */
void *trax_explain_array(size_t count, size_t size, trax_error *error);

#endif
