#include "compare.h"

#include "figures.h"
#include "hits.h"
#include "ray_trace.h"
#include "steps.h"
#include "trax/output.h"
#include "trax/signals.h"

#include <stdio.h>

trax_status run_on_host(struct trax_picture *picture, const struct job *job, enum engine engine, trax_error *error) {
  static const char *const names[] = {
      [ENGINE_NATIVE] = "native twin", [ENGINE_EMBREE] = "Embree", [ENGINE_EXACT] = "exact picture"};
  const struct options *options = job->options;
  struct step step = {.line = job->progress, .name = names[engine]};
  struct trax_render_run run = {.progress = show_step,
                                .progress_context = &step,
                                .interrupt = &trax_signal,
                                .layers = options->layers,
                                .exactly = engine == ENGINE_EXACT};
  double begun = trax_seconds();
  trax_status status = engine == ENGINE_NATIVE ? trax_render_twin(picture, job->frame, options->threads, &run, error)
                                               : trax_render_embree(picture, job->frame, &run, error);
  trax_progress_line_clear(job->progress);
  if (status == TRAX_OK && !options->quiet)
    printf("rays        %llu in %.3f s on this computer\n", (unsigned long long)run.rays, trax_seconds() - begun);
  return status;
}

enum finder { BY_TWIN, BY_EMBREE, WITHOUT_ERROR };

/* Finds the hits of the rays from the eye. */
static trax_status find_hits(struct trax_hits *hits, const struct job *job, enum finder finder, trax_error *error) {
  static const char *const names[] = {"hits", "Embree's hits", "exact hits"};
  struct step step = {.line = job->progress, .name = names[finder]};
  struct trax_render_run run = {.progress = show_step, .progress_context = &step, .interrupt = &trax_signal};
  trax_status status = finder == BY_TWIN     ? trax_hits_native(hits, job->frame, job->options->threads, &run, error)
                       : finder == BY_EMBREE ? trax_hits_embree(hits, job->frame, &run, error)
                                             : trax_hits_exact(hits, job->frame, &run, error);
  trax_progress_line_clear(job->progress);
  return status;
}

/* Compares the device program's hits with exact ones. *embree: how many are the same as Embree's. */
static trax_status judge_hits(struct trax_hits_difference *difference, uint64_t *embree, const struct job *job,
                              trax_error *error) {
  struct trax_hits hits[3] = {{0}};
  trax_status status = TRAX_OK;
  for (int finder = BY_TWIN; finder <= WITHOUT_ERROR && status == TRAX_OK; finder++)
    status = find_hits(&hits[finder], job, finder, error);
  if (status == TRAX_OK) {
    trax_hits_judge(difference, &hits[BY_TWIN], &hits[WITHOUT_ERROR], job->frame);
    *embree = trax_hits_same(&hits[BY_TWIN], &hits[BY_EMBREE], job->frame);
  }
  for (int finder = BY_TWIN; finder <= WITHOUT_ERROR; finder++)
    trax_hits_release(&hits[finder]);
  return status;
}

static trax_status compare_hits(const struct job *job, bool *agrees, trax_error *error) {
  struct trax_hits_difference difference;
  uint64_t embree;
  const trax_status status = judge_hits(&difference, &embree, job, error);
  if (status != TRAX_OK)
    return status;
  const uint64_t beyond = difference.holes + difference.wrong;
  printf("hits        %llu of %llu pixels hit the nearest triangle, %llu another within the error bound, %llu beyond "
         "it, of which %llu are holes",
         (unsigned long long)difference.same, (unsigned long long)difference.pixels,
         (unsigned long long)difference.tied, (unsigned long long)beyond, (unsigned long long)difference.holes);
  if (beyond)
    printf(": (%u, %u)", difference.x, difference.y);
  printf("\n            %llu pixels hit the triangle that Embree hits\n", (unsigned long long)embree);
  *agrees = *agrees && beyond == 0;
  return TRAX_OK;
}

trax_status measure_hits(const struct job *job, trax_error *error) {
  struct trax_hits_difference difference;
  uint64_t embree;
  const trax_status status = judge_hits(&difference, &embree, job, error);
  if (status != TRAX_OK)
    return status;
  const struct figure figures[] = {
      {"pixels", (double)difference.pixels}, {"nearest", (double)difference.same},
      {"tied", (double)difference.tied},     {"beyond", (double)(difference.holes + difference.wrong)},
      {"holes", (double)difference.holes},   {"embree", (double)embree}};
  trax_output output;
  if (trax_output_open(&output, job->options->hits, error) != TRAX_OK)
    return TRAX_ERROR;
  figures_print(output.file, figures, sizeof figures / sizeof *figures);
  return trax_output_commit(&output, error); /* which finds earlier failures to write */
}

trax_status compare(const struct trax_picture *picture, const struct job *job, bool *agrees, trax_error *error) {
  struct trax_picture other = {0};
  struct trax_difference difference;
  struct options options = *job->options;
  const struct job quietly = {.options = &options, .frame = job->frame, .progress = job->progress};
  options.quiet = true;
  options.layers = false;
  trax_status status = run_on_host(&other, &quietly, ENGINE_EMBREE, error);
  if (status != TRAX_OK)
    return status;
  trax_picture_compare(&difference, picture, &other, 2);
  const double light = trax_picture_light(picture), other_light = trax_picture_light(&other);
  trax_picture_release(&other);
  printf("Embree      %.4f %% of the pixels within 2/255, largest difference %u at (%u, %u)\n",
         trax_difference_percent(&difference), difference.largest, difference.x, difference.y);
  const double percent = trax_difference_floats_percent(&difference);
  if (difference.floats)
    printf("            %.4f %% of the floats within 2/255 of their brightness, largest difference %.3g/255\n", percent,
           difference.most);
  *agrees = percent >= 99.9;
  if (job->frame->params->features & TRAX_FEATURE_BIT(PATHS)) { /* one path in thousands takes another direction */
    const double deviation = 100 * (other_light > 0 ? light / other_light - 1 : light > 0);
    printf("            light of the whole picture %+.4f %%\n", deviation);
    *agrees = percent >= 99 && deviation > -0.2 && deviation < 0.2;
  }

  status = run_on_host(&other, &quietly, ENGINE_NATIVE, error);
  if (status != TRAX_OK)
    return status;
  trax_picture_compare(&difference, picture, &other, 0);
  trax_picture_release(&other);
  if (difference.unequal == 0)
    printf("twin        identical in every bit\n");
  else
    printf("twin        %llu pixels differ, by %u at (%u, %u) and less elsewhere\n",
           (unsigned long long)difference.unequal, difference.largest, difference.x, difference.y);
  *agrees = *agrees && difference.unequal == 0;
  return compare_hits(job, agrees, error);
}

trax_status trace_rays(const struct job *job, int scaled, const struct trax_picture *picture, trax_error *error) {
  struct step step = {.line = job->progress, .name = "trace of the rays"};
  struct trax_render_run run = {.progress = show_step, .progress_context = &step, .interrupt = &trax_signal};
  const trax_status status = trax_ray_trace_write(job->options->ray_trace, job->frame, scaled, picture, &run, error);
  trax_progress_line_clear(job->progress);
  return status;
}
