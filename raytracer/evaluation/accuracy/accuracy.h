/* Error against run time: one picture by each method and precision, with what it took and how wrong it is
   (trax-render --bench-accuracy).

   Three pictures tell the errors apart. R is what the device program renders, its channels taken before they are
   rounded to bytes. E is the same rays in binary64 (trax_render_exact). C is E with so many samples that it has
   converged. The numerical error is R - E, the sampling error E - C, the total R - C. */
#ifndef TRAX_RENDER_ACCURACY_H
#define TRAX_RENDER_ACCURACY_H

#include "metrics.h"
#include "render.h"

#include <stdbool.h>

/* --- what is measured --- */

/* rebuilt.c: a scene of the same triangles, built again: the same bytes, but for the source ids, if nodes are the same
   and vertices and triangles whole as they are. The source ids are the triangles' numbers in `scene`, of which one that
   stands in several leaves counts once. */
struct trax_rebuild_options {
  enum trax_node_layout nodes;
  bool split;           /* large triangles, with the default's room */
  unsigned vertex_bits; /* vertices are the nearest ones on a grid of 2^vertex_bits planes along each axis, the scene's
                           bounds being the outermost, as if they were stored in so many bits; 0: as they are */
};

trax_status trax_scene_rebuild(struct trax_scene *rebuilt, const struct trax_scene *scene,
                               const struct trax_rebuild_options *how, const volatile int *interrupt,
                               trax_error *error);
/* Does a triangle stand in several leaves? */
trax_status trax_scene_is_split(bool *split, const struct trax_scene *scene, trax_error *error);

enum trax_latency { TRAX_LATENCY_AS_CONFIGURED, TRAX_LATENCY_DIGITS, TRAX_LATENCY_NEWTON };

/* A row of the table. */
struct trax_variant {
  const char *group; /* what it varies: "default", "triangle", "math", "tree", "vertices", "unit", "samples" */
  char name[64];
  struct trax_method method;
  uint32_t samples;
  bool rebuilt;                     /* the scene is one of trax_scene_rebuild */
  struct trax_rebuild_options tree; /* which is like this in any case */
  unsigned bits;                    /* of the special unit; 0: as configured */
  enum trax_latency latency;
};

/* The default first, of the scene as it is. *variants is from malloc. */
trax_status trax_variants(struct trax_variant **variants, size_t *count, const struct trax_scene *scene,
                          trax_error *error);
unsigned trax_variant_latency(const struct trax_variant *variant); /* cycles; 0: as configured */

/* FIGURE(NAME, key, unit, meaning) */
#define TRAX_ACCURACY_FIGURES(FIGURE)                                                                                  \
  FIGURE(CYCLES, "cycles", "cycles", "of the run on the emulated chip")                                                \
  FIGURE(INSTRUCTIONS, "instructions", "instructions", "issued by all threads")                                        \
  FIGURE(SCENE, "scene_bytes", "bytes", "of the scene in the chip's memory")                                           \
  FIGURE(CODE, "code_bytes", "bytes", "of the program's code")                                                         \
  FIGURE(MEMORY, "memory_bytes", "bytes", "from and to off-chip memory")                                               \
  FIGURE(ENERGY, "energy", "J", "the chip's dynamic energy without off-chip memory (docs/statistics.md)")                \
  FIGURE(MRPS, "mrps", "million rays/s", "of simulated time")                                                          \
  FIGURE(HOST_SECONDS, "host_seconds", "s", "wall time of the simulation")                                             \
  FIGURE(RMSE, "numerical_rmse", "of 255", "R - E: root of the mean square over all channels")                         \
  FIGURE(LARGEST, "numerical_largest", "of 255", "R - E: largest difference of a channel")                             \
  FIGURE(FLIP, "numerical_flip", "0 to 1", "R against E: FLIP, mean")                                                  \
  FIGURE(WRONG, "wrong_pixels", "pixels", "with a sample that is missed, grown or other")                              \
  FIGURE(MISSED, "missed", "samples", "that should hit something and hit nothing")                                     \
  FIGURE(GROWN, "grown", "samples", "that should hit nothing and hit something")                                       \
  FIGURE(OTHER, "other", "samples", "that hit another triangle elsewhere")                                             \
  FIGURE(TIED, "tied", "samples", "that hit another triangle within the error bound of the right one; not wrong")      \
  FIGURE(SHADOW, "wrong_shadows", "samples", "with light for shadow or the reverse where the triangle is right")       \
  FIGURE(CHANGED, "recorded_differently", "pixels", "whose bytes the program that records gives another value")        \
  FIGURE(SAMPLING_RMSE, "sampling_rmse", "of 255", "E - C")                                                            \
  FIGURE(TOTAL_RMSE, "total_rmse", "of 255", "R - C")                                                                  \
  FIGURE(TOTAL_FLIP, "total_flip", "0 to 1", "R against C: FLIP, mean")

enum trax_accuracy_figure {
#define FIGURE(NAME, key, unit, meaning) TRAX_ACCURACY_##NAME,
  TRAX_ACCURACY_FIGURES(FIGURE)
#undef FIGURE
      TRAX_ACCURACY_FIGURE_COUNT
};

struct trax_accuracy_row {
  struct trax_variant variant;
  double figures[TRAX_ACCURACY_FIGURE_COUNT];
  bool numerical_front; /* one sample a pixel, and no other such row takes no more cycles for no more numerical error */
  bool total_front;     /* the same of all rows and the total error */
};

/* Marks the rows on the fronts. Of rows that are alike in cycles and error the first is on it. */
void trax_accuracy_fronts(struct trax_accuracy_row *rows, size_t count);

/* --- measuring --- */

struct trax_accuracy_run {
  struct trax_specialise_options specialise;
  const trax_config *config;          /* the chip; bits and latency are the variant's */
  const struct trax_scene *original;  /* what the next two are of */
  const struct trax_exact *exact;     /* E, with what its rays met: for as many samples as the frame has */
  const struct trax_exact *converged; /* C */
  unsigned host_threads;              /* 0: one for each processor */
  void (*progress)(void *context, double fraction); /* of this variant; may be NULL */
  void *progress_context;
};

/* What decides the figures of the run, apart from the programs of this host: 32 hexadecimal digits. */
trax_status trax_accuracy_key(char key[33], const struct trax_variant *variant, const struct trax_frame *frame,
                              const struct trax_accuracy_run *run, trax_error *error);

/* The variant's picture is rendered once on the cycle-exact emulator, and once without time by the program that
   records. The frame has the variant's samples, method and scene. */
trax_status trax_accuracy_measure(struct trax_accuracy_row *row, const struct trax_variant *variant,
                                  const struct trax_frame *frame, const struct trax_accuracy_run *run,
                                  trax_error *error);

/* --- reports: accuracy_report.c --- */

struct trax_accuracy_report {
  const struct trax_accuracy_row *rows;
  size_t count;
  const char *scene, *view, *chip; /* names for the heading */
  uint32_t width, height;
  uint32_t converged_samples, rough_samples;
  double rough_rmse; /* between C and a picture of rough_samples, of 255 */
};

/* A row's figures as a file that trax_accuracy_read_row reads back. */
trax_status trax_accuracy_write_row(const struct trax_accuracy_row *row, const char *path, trax_error *error);
/* False if there is no such file, or one that is damaged. */
bool trax_accuracy_read_row(struct trax_accuracy_row *row, const char *path);

void trax_accuracy_print(const struct trax_accuracy_report *report, FILE *out); /* Markdown */
trax_status trax_accuracy_write_csv(const struct trax_accuracy_report *report, const char *path, trax_error *error);
trax_status trax_accuracy_write_json(const struct trax_accuracy_report *report, const char *path, trax_error *error);
/* DIR/accuracy.svg by DIR/accuracy.gnuplot, a script of its own. *drawn is false if there is no gnuplot. */
trax_status trax_accuracy_draw(const struct trax_accuracy_report *report, const char *directory, bool *drawn,
                               trax_error *error);

#endif
