/* Checks which of trax-render's options exclude or need each other. */
#include "options.h"

#include "trax/output.h"

#include <string.h>

/* The sampler's numbers have 16 bits (device/sampler.h). */
#define MOST_OCCLUSION_POINTS (1u << 16)

bool options_rendered(const struct options *options) {
  return options->output || options->prepare || options->keep || options->stats || options->ray_cycles ||
         options->compare || options->cost_picture || options->cost_values || trax_explain_wanted(&options->explain);
}

/* Options that need a picture, a view or shading; NULL: none was given. */
static const char *against_rays(const struct options *options) {
  const struct camera_options *camera = &options->camera;
  const struct trax_frame_options *frame = &options->frame;
  const struct {
    bool given;
    const char *name;
  } others[] = {{options->output, "--output"},
                {options->layers, "--layers"},
                {options->frames, "--frames"},
                {options->view, "--view"},
                {camera->eye.given || camera->look_at.given || camera->up.given || camera->light_count,
                 "--eye, --look-at, --up or --light"},
                {camera->fov > 0 || camera->orbit[0] != 0 || camera->orbit[1] != 0, "--fov or --orbit"},
                {options->write_view, "--write-view"},
                {frame->samples > 1 || frame->paths || frame->occlusion || frame->floats,
                 "--samples, --paths, --occlusion or --float"},
                {options->environment, "--environment"},
                {frame->ambient != TRAX_DEFAULT_AMBIENT || frame->background != TRAX_DEFAULT_BACKGROUND,
                 "--ambient or --background"},
                {options->build.smooth || frame->one_sided || !frame->shadows, "--smooth, --one-sided or --no-shadows"},
                {options->explain.explore, "--explore"},
                {options->pixels.count, "--pixel"},
                {options->ray_trace, "--ray-trace"},
                {options->cost_picture || options->cost_values, "--cost-picture or --cost-values"},
                {options->hits, "--hits"},
                {options->program, "--program"},
                {options->no_specialise, "--no-specialise"},
                {options->frame.mark_rays, "--mark-rays"},
                {options->sampled, "--sampled"},
                {options->engine > ENGINE_REFERENCE, "--engine native, embree or exact"}};
  for (size_t i = 0; i < sizeof others / sizeof *others; i++)
    if (others[i].given)
      return others[i].name;
  return NULL;
}

static trax_status check_environment(const struct options *options, trax_error *error) {
  if (!options->environment && (options->environment_strength != 1 || options->environment_turn != 0))
    return trax_fail(error, "--environment-strength and --environment-turn without --environment");
  if (options->environment && options->program)
    return trax_fail(error, "--environment is for trax-render's own program, not for --program");
  return TRAX_OK;
}

static trax_status check_rays(const struct options *options, trax_error *error) {
  const char *other = against_rays(options);
  if (!options->rays && (options->ray_results || options->ray_order != TRAX_RAYS_FOUND))
    return trax_fail(error, "%s without --rays", options->ray_results ? "--ray-results" : "--ray-order");
  if (options->rays && other)
    return trax_fail(error, "--rays traces the rays of a file on the emulator, so there is no picture: not with %s",
                     other);
  if (options->rays && options->prepare && (options->ray_results || options->compare))
    return trax_fail(error, "--prepare traces nothing, so there is nothing to write or compare");
  return TRAX_OK;
}

/* trax-eval makes the runs of a sequence, and checks the options that it passes on. */
static trax_status check_sequence(const struct options *options, trax_error *error) {
  const struct {
    bool given;
    const char *name;
  } others[] = {{options->engine != ENGINE_FAST || options->threads, "--engine or --threads"},
                {options->stats || options->ray_cycles || options->hits, "--stats, --ray-cycles or --hits"},
                {options->cost || options->cost_picture || options->cost_values, "--cost and its files"},
                {trax_explain_wanted(&options->explain), "--explore, --pixel or --memory-trace"},
                {options->program || options->source || options->no_specialise || options->choose_queues,
                 "--program, --source, --no-specialise or --queues"},
                {options->sampled, "--sampled"},
                {options->layers || options->frame.floats, "--layers or --float"},
                {options->write_view, "--write-view"},
                {options->ray_trace || options->compare, "--ray-trace or --compare"},
                {options->keep || options->cache, "--keep, --prepare or --cache"}};
  if (!options->frames)
    return trax_fail(error, "--at X:Y needs --frames N: the number of moments from X to Y");
  if (!options->output)
    return trax_fail(error, "--frames with --at X:Y needs -o FOLDER");
  for (size_t i = 0; i < sizeof others / sizeof *others; i++)
    if (others[i].given)
      return trax_fail(error, "--frames with --at X:Y writes picture and statistics of each frame: not with %s",
                       others[i].name);
  return TRAX_OK;
}

trax_status options_check(const struct options *options, trax_error *error) {
  if (options->mesh_count == 0)
    return trax_fail(error, "no mesh given; trax-render --help shows how");
  if (check_rays(options, error) != TRAX_OK || check_environment(options, error) != TRAX_OK)
    return TRAX_ERROR;
  if (options->sequence)
    return check_sequence(options, error);
  if (options->frames)
    return trax_fail(error, "--frames is for a sequence, --at X:Y; --orbit makes each picture of a turntable");
  if (options->no_refit)
    return trax_fail(error, "--no-refit is for --frames with --at X:Y");
  if (options->prepare &&
      (options->output || options->stats || options->ray_cycles || options->compare || options->hits ||
       options->ray_trace || options->cost_picture || options->cost_values || trax_explain_wanted(&options->explain)))
    return trax_fail(error, "--prepare renders nothing, so there is nothing to write, explain or compare");
  if (!options_rendered(options) && !(options->rays || options->hits || options->ray_trace || options->write_view)) {
    for (size_t i = 0; i < options->mesh_count; i++) /* a missing mesh is reported first */
      if (trax_mesh_check(options->meshes[i], error) != TRAX_OK)
        return TRAX_ERROR;
    return trax_fail(error,
                     "no picture given: -o PICTURE.png, or another output (--explore, --stats, --cost-picture, ...)");
  }
  if (options->import.animation && !options->import.moves)
    return trax_fail(error, "--animation without --at");
  if (options->hits && options->sampled)
    return trax_fail(error, "--hits needs the whole picture: not with --sampled");
  if (options->layers && !(options->output && trax_output_has_ending(options->output, "exr")))
    return trax_fail(error, "--layers needs -o FILE.exr");
  if (options->layers && options->engine <= ENGINE_REFERENCE &&
      (options->program || options->no_specialise || options->sampled || options->stats || options->ray_cycles ||
       options->keep || options->compare || options->cost_picture || options->cost_values ||
       trax_explain_wanted(&options->explain)))
    return trax_fail(error,
                     "--layers needs a program that records and therefore has no run time to report: it excludes "
                     "--program, --no-specialise, --stats, --compare, --sampled and what explains a run");
  const trax_slot_sampling *sampling = &options->sampling;
  if (!options->sampled &&
      (sampling->fraction > 0 || sampling->error > 0 || sampling->seed || sampling->unit || sampling->warm_up))
    return trax_fail(error, "--sample-fraction, --sample-error and the like are for --sampled");
  if (sampling->fraction > 0 && sampling->error > 0)
    return trax_fail(error, "--sample-fraction and --sample-error: one follows from the other");
  if (options->sampled && options->engine != ENGINE_FAST)
    return trax_fail(error, "--sampled needs engine fast");
  if (options->sampled && (options->compare || options->prepare || options->cost_picture || options->cost_values ||
                           options->ray_trace || trax_explain_wanted(&options->explain)))
    return trax_fail(error, "--sampled leaves out most of the run: there is nothing to compare, explain or prepare");
  if (options->sampled && options->source && options->output)
    return trax_fail(error, "--sampled -o: the picture is the native twin's, which does not run another --source");
  if (options->engine > ENGINE_REFERENCE) {
    if (options->ray_cycles)
      return trax_fail(error, "--ray-cycles needs the emulator: the other engines simulate no time");
    if (options->stats)
      return trax_fail(error, "--stats needs the emulator: the other engines have no machine to tell about");
    if (options->pixels.count)
      return trax_fail(error, "--pixel needs the emulator: the other engines simulate no time");
    if (options->cost_picture || options->cost_values || trax_explain_wanted(&options->explain))
      return trax_fail(error, "--explore, --memory-trace, --cost-picture and --cost-values need the emulator");
    if (options->keep || options->program || options->config || options->setting_count)
      return trax_fail(error, "--config, --set, --program, --keep and --prepare need the emulator");
    if (options->choose_queues)
      return trax_fail(error, "--queues needs the emulator: other engines have no TMs");
    if (options->cache || options->source || options->no_specialise)
      return trax_fail(error, "--cache, --source and --no-specialise need the emulator");
    if (options->frame.mark_rays)
      return trax_fail(error, "--mark-rays needs the emulator: it is about the program that is compiled for it");
  }
  if (options->choose_queues && (options->no_specialise || options->program))
    return trax_fail(error, "--queues needs a program compiled for the picture; %s asks for another",
                     options->program ? "--program" : "--no-specialise");
  if (options->frame.mark_rays && (options->no_specialise || options->program))
    return trax_fail(error, "--mark-rays needs a program compiled for the picture; %s asks for another",
                     options->program ? "--program" : "--no-specialise");
  if (options->no_specialise && (options->cache || options->source))
    return trax_fail(error, "--cache and --source are about the specialised program; --no-specialise asks for none");
  if (options->program && (options->cache || options->source))
    return trax_fail(error, "--cache and --source are about the specialised program; --program asks for another");
  if (options->cost && !options->cost_picture && !options->cost_values)
    return trax_fail(error, "--cost without --cost-picture or --cost-values");
  for (unsigned i = 0; i < options->pixels.count; i++)
    if (options->pixels.at[i][0] >= options->frame.width || options->pixels.at[i][1] >= options->frame.height)
      return trax_fail(error, "--pixel %u,%u: the picture has %u x %u pixels, from 0,0", options->pixels.at[i][0],
                       options->pixels.at[i][1], options->frame.width, options->frame.height);
  if (trax_explain_check_against(&options->explain, error) != TRAX_OK)
    return TRAX_ERROR;
  if (options->explain.source_folder_count && !options->explain.explore)
    return trax_fail(error, "--source-folder without --explore");
  if (options->ray_trace && options->engine >= ENGINE_EMBREE)
    return trax_fail(error, "--ray-trace: the rays are the device program's, which Embree does not run");
  if (options->ray_trace && (options->program || options->source))
    return trax_fail(error, "--ray-trace: the rays are the native twin's; with %s the program is another one",
                     options->program ? "--program" : "--source");
  if (options->frame.seed && !options->frame.paths && !options->frame.occlusion)
    return trax_fail(error, "--seed is for --paths and --occlusion: nothing else is random");
  if (options->frame.occlusion && options->frame.paths)
    return trax_fail(error, "--occlusion is for the ambient light, which --paths does not have");
  if (options->frame.occlusion && !options->frame.shadows)
    return trax_fail(error, "--occlusion needs shadows, which --no-shadows leaves out");
  if (options->frame.occlusion * options->frame.samples > MOST_OCCLUSION_POINTS)
    return trax_fail(error, "--occlusion %u with --samples %u: there are %u points for a pixel at most",
                     options->frame.occlusion, options->frame.samples, MOST_OCCLUSION_POINTS);
  if (options->frame.occlusion_reach > 0 && !options->frame.occlusion)
    return trax_fail(error, "--occlusion-reach without --occlusion");
  if (options->threads && options->engine != ENGINE_NATIVE && options->engine != ENGINE_FAST)
    return trax_fail(error, "--threads is for engines fast and native");
  return TRAX_OK;
}
