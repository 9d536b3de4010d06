/* How wrong a picture of the device program is (trax-render --error).

   Three pictures tell the errors apart. R is what the device program renders, its channels taken before they are
   rounded to bytes. E is the same rays in binary64 (trax_render_exact). C is E with so many samples that it has
   converged. The numerical error is R - E, the sampling error E - C, the total R - C. */
#ifndef TRAX_RENDER_PICTURE_ERROR_H
#define TRAX_RENDER_PICTURE_ERROR_H

#include "metrics.h"
#include "render.h"

/* FIGURE(NAME, key, meaning) */
#define TRAX_ERROR_FIGURES(FIGURE)                                                                                     \
  FIGURE(RMSE, "numerical_rmse", "R - E, of 255: root of the mean square over all channels")                           \
  FIGURE(LARGEST, "numerical_largest", "R - E, of 255: largest difference of a channel")                               \
  FIGURE(FLIP, "numerical_flip", "R against E: FLIP, mean, 0 to 1")                                                    \
  FIGURE(WRONG, "wrong_pixels", "pixels with a sample that is missed, grown or other")                                 \
  FIGURE(MISSED, "missed", "samples that should hit something and hit nothing")                                        \
  FIGURE(GROWN, "grown", "samples that should hit nothing and hit something")                                          \
  FIGURE(OTHER, "other", "samples that hit another triangle elsewhere")                                                \
  FIGURE(TIED, "tied", "samples that hit another triangle within the error bound of the right one; not wrong")         \
  FIGURE(SHADOW, "wrong_shadows", "samples with light for shadow or the reverse where the triangle is right")          \
  FIGURE(CHANGED, "recorded_differently", "pixels whose bytes the program that records gives another value")           \
  FIGURE(SAMPLING_RMSE, "sampling_rmse", "E - C, of 255")                                                              \
  FIGURE(TOTAL_RMSE, "total_rmse", "R - C, of 255")                                                                    \
  FIGURE(TOTAL_FLIP, "total_flip", "R against C: FLIP, mean, 0 to 1")

enum trax_error_figure {
#define FIGURE(NAME, key, meaning) TRAX_ERROR_##NAME,
  TRAX_ERROR_FIGURES(FIGURE)
#undef FIGURE
      TRAX_ERROR_FIGURE_COUNT
};

struct trax_error_run {
  struct trax_specialise_options specialise;
  const trax_config *config;                                    /* the chip: the precision of its special unit counts */
  const struct trax_exact *exact;                               /* E, with what its rays met; of the frame's samples */
  const struct trax_exact *converged;                           /* C */
  unsigned host_threads;                                        /* 0: one for each processor */
  void (*progress)(void *context, const trax_progress *status); /* of either run; may be NULL */
  void *progress_context;
};

/* Runs the frame's program and the one that records, both without time. */
trax_status trax_error_measure(double figures[TRAX_ERROR_FIGURE_COUNT], const struct trax_frame *frame,
                               const struct trax_error_run *run, trax_error *error);

/* C of a frame, and how far it differs from a picture of a quarter of its samples. */
struct trax_converged {
  struct trax_exact picture;
  double rough_rmse; /* of 255 */
};

/* frame: of TRAX_CONVERGED_SAMPLES; rough: of TRAX_ROUGH_SAMPLES, else the same. folder: where the picture is kept
   under a name of all that decides it, for the next run, whatever the tree of the scene; NULL: nowhere. */
#define TRAX_CONVERGED_SAMPLES 1024u
#define TRAX_ROUGH_SAMPLES 256u
trax_status trax_converge(struct trax_converged *converged, const struct trax_frame *frame,
                          const struct trax_frame *rough, const char *folder, struct trax_render_run *run,
                          trax_error *error);

#endif
