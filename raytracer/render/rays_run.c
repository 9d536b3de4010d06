#include "rays_run.h"

#include "emulated.h"
#include "rays.h"

static void print_outputs(const struct options *options) {
  if (options->stats)
    printf("statistics  %s\n", options->stats);
  if (options->ray_results)
    printf("results     %s\n", options->ray_results);
  if (options->keep)
    printf("inputs      %s\n", options->keep);
}

static bool compare_rays(const struct trax_rays *rays, const struct trax_scene *scene) {
  uint32_t first;
  const uint32_t unequal = trax_rays_unequal(rays, scene, &first);
  printf("compared    %u of %u rays have the results of the file", rays->count - unequal, rays->count);
  if (unequal)
    printf("; ray %u is the first that has not", first + 1);
  putchar('\n');
  return unequal == 0;
}

static trax_status trace(const struct options *options, struct trax_rays *rays, struct trax_scene *scene,
                         trax_progress_line *progress, trax_error *error) {
  struct trax_frame frame = {0};
  struct trax_picture none = {0};
  unsigned lines;
  trax_status status = trax_rays_frame(&frame, scene, rays, error);
  if (status == TRAX_OK)
    status = emulated_cache_lines(&lines, options, error);
  if (status == TRAX_OK)
    status = trax_rays_order(rays, options->ray_order, scene, lines * TRAX_SCENE_ALIGNMENT, error);
  if (status == TRAX_OK)
    status = emulate(&none, &(struct job){options, &frame, progress, .rays = rays}, error);
  trax_frame_release(&frame);
  return status;
}

trax_status run_rays(const struct options *options, struct trax_scene *scene, trax_progress_line *progress,
                     bool *agrees, trax_error *error) {
  struct trax_rays rays;
  trax_status status = trax_rays_read(&rays, options->rays, error);
  if (status == TRAX_OK)
    status = trace(options, &rays, scene, progress, error);
  if (status == TRAX_OK && options->ray_results)
    status = trax_rays_write(&rays, scene, options->ray_results, error);
  if (status == TRAX_OK && !options->quiet)
    print_outputs(options);
  if (status == TRAX_OK && options->compare)
    *agrees = compare_rays(&rays, scene);
  trax_rays_release(&rays);
  return status;
}
