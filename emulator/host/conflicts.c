/* The rules about several options of trax-sim. */
#include "host/options.h"

#include "control/engines.h"

#include <string.h>

static bool is_timed(const struct trax_engine *engine) {
  return engine->is_timed;
}

static bool observes(const struct trax_engine *engine) {
  return engine->is_observed;
}

static bool has_checkpoints(const struct trax_engine *engine) {
  return engine->visit != NULL;
}

static bool counts_rays(const struct trax_engine *engine) {
  return engine->counts_rays;
}

/* Checks that the engine can(); `what` begins the message, which lists the engines that can. */
static trax_status need(const struct trax_options *options, bool (*can)(const struct trax_engine *engine),
                        const char *what, trax_error *error) {
  char names[128];
  if (can(options->engine))
    return TRAX_OK;
  trax_engine_names(can, names, sizeof names);
  return trax_fail(error, "%s the engine %s, not %s", what, names, options->engine->name);
}

/* Checks the options of explanations. */
static trax_status check_explain(const struct trax_options *options, trax_error *error) {
  const struct trax_explain_options *explain = &options->explain;
  const bool windowed = explain->trace || explain->perfetto;
  if (trax_explain_wanted(explain) && need(options, observes, "a run is explained by", error) != TRAX_OK)
    return TRAX_ERROR;
  if (options->checkpoint.resume && trax_explain_wanted(explain))
    return trax_fail(error, "--resume: a run cannot be explained without its cycles before the checkpoint");
  if (explain->perfetto && !explain->window_end)
    return trax_fail(error, "--perfetto needs --window");
  if (!windowed && (explain->window_end || explain->window_tms || explain->window_tps))
    return trax_fail(error, "--window without --trace or --perfetto");
  if (explain->series_interval && !explain->series)
    return trax_fail(error, "--series-interval without --series");
  if (trax_explain_check_against(explain, error) != TRAX_OK)
    return TRAX_ERROR;
  if (explain->source_folder_count && !explain->explore)
    return trax_fail(error, "--source-folder without --explore");
  if (explain->item_buffer && !explain->items && !explain->explore)
    return trax_fail(error, "--item-buffer without --items or --explore");
  return TRAX_OK;
}

static trax_status check_engine(const struct trax_options *options, trax_error *error) {
  const struct trax_checkpoint_options *checkpoint = &options->checkpoint;
  if ((checkpoint->at || checkpoint->every) && !checkpoint->write)
    return trax_fail(error, "--checkpoint-at and --checkpoint-every need --checkpoint");
  if ((checkpoint->write || checkpoint->resume) &&
      need(options, has_checkpoints, "--checkpoint and --resume are for", error) != TRAX_OK)
    return TRAX_ERROR;
  if (options->watchdog && need(options, is_timed, "--watchdog needs", error) != TRAX_OK)
    return TRAX_ERROR;
  if (options->ray_cycles && need(options, counts_rays, "--ray-cycles needs", error) != TRAX_OK)
    return TRAX_ERROR;
  if (options->ray_cycles && checkpoint->resume)
    return trax_fail(error, "--resume: the cycles of rays before the checkpoint are not known");
  return options->gdb ? need(options, observes, "--gdb needs", error) : TRAX_OK;
}

trax_status trax_options_check_conflicts(const struct trax_options *options, trax_error *error) {
  return check_engine(options, error) == TRAX_OK ? check_explain(options, error) : TRAX_ERROR;
}

trax_status trax_options_choose_engine(struct trax_options *options, const struct trax_config *config,
                                       trax_error *error) {
  if (!options->engine_is_named)
    options->engine = trax_engine_for(config);
  return trax_engine_check(options->engine, config, error) == TRAX_OK ? trax_options_check_conflicts(options, error)
                                                                      : TRAX_ERROR;
}
