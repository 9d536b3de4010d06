/* The progress of an import: its phases as parts of one whole, so that the time left is that of all. */
#include "internal.h"

void scene_report(const struct trax_build_options *options, enum scene_phase phase, double fraction) {
  if (!options->progress)
    return;
  /* Their times, measured with the conference room, with splits, and with the dragon, without. */
  const double shares[] = {[SCENE_BUILD] = options->splits > 1 ? 6 : 1.5,
                           [SCENE_IMPROVE] = 3 * (double)options->passes,
                           [SCENE_LAY_OUT] = 0.5};
  double before = 0, all = 0;
  for (int i = 0; i <= SCENE_LAY_OUT; i++) {
    before += i < (int)phase ? shares[i] : 0;
    all += shares[i];
  }
  const double part = fraction < 0 ? 0 : fraction > 1 ? 1 : fraction;
  options->progress(options->progress_context, "BVH", (before + part * shares[phase]) / all);
}
