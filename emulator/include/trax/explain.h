/* Explanations of a run besides its statistics: a page, profiles, traces, time lines, memory heat, costs of items,
   series (docs/explaining.md). They are deterministic and the same with both timed engines.

     struct trax_explain *explain;
     trax_explain_begin(&explain, machine, &options, &error);   after loading and binding, before the run
     trax_machine_run(machine, ...);
     trax_explain_end(explain, &error);                         also after a run that did not finish */
#ifndef TRAX_EXPLAIN_H
#define TRAX_EXPLAIN_H

#include "trax/emulator.h"

#ifdef __cplusplus
extern "C" {
#endif

#pragma GCC visibility push(default) /* of the shared library */

struct trax_explain;

/* The files that explain a run: member of the options, option of trax-sim, value, meaning. */
#define TRAX_EXPLAIN_FILES(X)                                                                                          \
  X(explore, "explore", "FILE.html", "one page that explains the whole run, for a browser")                            \
  X(profile, "profile", "FILE", "thread-cycles by function and by source line")                                        \
  X(folded, "profile-folded", "FILE", "thread-cycles by call stack, for flame graphs")                                 \
  X(sample, "profile-sample", "FILE", "executions by source line, for clang -fprofile-sample-use")                     \
  X(heat, "heat", "FILE", "accesses to memory by object, as CSV")                                                      \
  X(heat_lines, "heat-lines", "FILE", "accesses to global memory by 64 bytes, as CSV")                                 \
  X(waits, "waits", "FILE", "waits by the load waited for, its object and the waiting instruction, as CSV")            \
  X(items, "items", "FILE", "cost of each item (pixel), as CSV")                                                       \
  X(ray_kinds, "ray-kinds", "FILE", "cost of the rays of each kind, as CSV")                                           \
  X(series, "series", "FILE", "counts of each interval of cycles, as CSV")                                             \
  X(memory_trace, "memory-trace", "FILE", "every transfer from and to off-chip memory; CSV for FILE.csv, else binary") \
  X(trace, "trace", "FILE", "every instruction issued in the window, with values")                                     \
  X(perfetto, "perfetto", "FILE", "the window as a time line, as JSON trace events")

enum { TRAX_EXPLAIN_MAX_SOURCE_FOLDERS = 16 };

struct trax_explain_options {
  /* Files to write; NULL: not wanted. "-" is standard output. */
#define MEMBER(ID, ...) const char *ID;
  TRAX_EXPLAIN_FILES(MEMBER)
#undef MEMBER
  bool check_memory; /* report errors of memory to standard error (docs/checking.md) */
  bool check_races;  /* report accesses of two threads that nothing orders to standard error */

  uint64_t series_interval; /* cycles; 0: TRAX_SERIES_INTERVAL */
  /* The window of trace and perfetto: cycles begin <= t < end (0: to the run's end), of the TMs and of the TPs
     in them whose bits are set (0: all). */
  uint64_t window_begin, window_end;
  uint64_t window_tms, window_tps;
  /* An item's place is the address of its last store to this buffer, as an offset in units of item_bytes. */
  const char *item_buffer; /* NULL: none */
  uint32_t item_bytes;
  /* The places of items whose stories are kept, besides those of the costliest, which the page has; and the file that
     tells them as text. NULL: none. */
  const uint32_t *story_places;
  unsigned story_count;
  const char *story;
  /* The statistics or the page of another run: the page also has the differences to it (trax/compare.h). NULL: none. */
  const char *against;
  /* The page's title (NULL: the program's name), and the parts of buffers that its tables list as objects. */
  const char *title;
  const struct trax_explore_part *parts;
  size_t part_count;
  /* Folders whose files may be copied into the page, besides those that docs/explaining.md names.
     trax_explain_add_source_folder adds them. */
  const char *source_folders[TRAX_EXPLAIN_MAX_SOURCE_FOLDERS];
  unsigned source_folder_count;
  void (*note)(const char *text); /* receives a sentence about the sources in the page; NULL: nobody */
};

struct trax_explore_part {
  const char *name;
  uint32_t address, bytes;
};

enum { TRAX_SERIES_INTERVAL = 10000 };

/* Error: it is no folder, or one too many. The text must stay valid until the end of the explanation. */
trax_status trax_explain_add_source_folder(struct trax_explain_options *options, const char *folder, trax_error *error);
/* Whether the options want any explanation. */
bool trax_explain_wanted(const struct trax_explain_options *options);

/* Checks the page and the file of --explore-against, rather than after the run. */
trax_status trax_explain_check_against(const struct trax_explain_options *options, trax_error *error);

/* Copies the options, but not the objects to which they point. *explain is NULL on an error or if nothing is wanted. */
trax_status trax_explain_begin(struct trax_explain **explain, trax_machine *machine,
                               const struct trax_explain_options *options, trax_error *error);
/* Writes the files and releases explain, which may be NULL. */
trax_status trax_explain_end(struct trax_explain *explain, trax_error *error);
/* Releases explain, which may be NULL, without writing files. */
void trax_explain_discard(struct trax_explain *explain);

/* The cost of an item (docs/isa.md, "trap": items): all that its thread was charged since its previous items trap. */
struct trax_item_cost {
  uint32_t thread;
  uint32_t place;      /* TRAX_NO_PLACE: it stored nothing to the buffer */
  uint64_t begin, end; /* cycles */
  uint64_t instructions;
  const uint64_t *cycles; /* by cause, in the order of trax_stats_cause */
  const uint64_t *rays;   /* by kind, in the order of trax/ray_kinds.h */
};
#define TRAX_NO_PLACE UINT32_MAX

/* To be called before the run: `item` will be called for every item when it ends. At the end of the run it is called
   once for each thread with `last` set and place TRAX_NO_PLACE, for the charges after the thread's last item. During
   the run another thread of the host may call it. */
void trax_explain_items(struct trax_explain *explain,
                        void (*item)(void *context, const struct trax_item_cost *cost, bool last), void *context);

/* A ray of a pixel, as the caller knows it. */
struct trax_explore_ray {
  uint32_t place;            /* the pixel's number */
  uint32_t nodes, triangles; /* that it visited */
  uint32_t material;         /* of what it hit; TRAX_NO_MATERIAL: it hit nothing, or something that is not known */
  uint32_t instance;         /* that it hit, if the picture has some; else or with TRAX_NO_INSTANCE: none */
  uint8_t kind, hit;         /* kind: as in trax/ray_kinds.h */
};
#define TRAX_NO_MATERIAL UINT32_MAX
#define TRAX_NO_INSTANCE UINT32_MAX

/* The picture of the page: item_buffer has its pixels, row by row. */
struct trax_explore_picture {
  uint32_t width, height;
  const uint32_t *pixels; /* R, G, B, A in the bytes from the lowest */
  /* Further counts of the caller for each pixel; `values` is NULL after the last. */
  struct trax_explore_counts {
    const char *name, *unit, *meaning;
    const uint32_t *values;
  } counts[4];
  /* The rays, by place, and those of one place in the order in which the program counts them. NULL: not known. */
  const struct trax_explore_ray *rays;
  size_t ray_count;
  bool counted_apart; /* the program counts each ray where it begins */
  bool has_instances;
  const char *const *materials; /* names without quotation marks */
  uint32_t material_count;
};

/* After the run: whether the rays of the pixel are wanted. If there are many rays, only those of stories are. */
bool trax_explain_has_rays(const struct trax_explain *explain, uint32_t place);
/* To be called before trax_explain_end. The objects to which `picture` points must stay valid until then. Without this
   call the page has no picture. */
void trax_explain_picture(struct trax_explain *explain, const struct trax_explore_picture *picture);

#pragma GCC visibility pop

#ifdef __cplusplus
}
#endif
#endif
