#include "bench_modes.h"

#include "core/machine.h"
#include "statistics.h"
#include "util.h"

#include <inttypes.h>
#include <jansson.h>
#include <time.h>

/* The first is the truth. Periods in instructions of each thread. */
static const struct mode {
  const char *name;
  trax_engine engine;
  uint64_t period;
} modes[] = {{"fast", TRAX_ENGINE_FAST, 0},
             {"sampled densely", TRAX_ENGINE_SAMPLED, 2000},
             {"sampled", TRAX_ENGINE_SAMPLED, 8000},
             {"sampled thinly", TRAX_ENGINE_SAMPLED, 32000},
             {"functional", TRAX_ENGINE_FUNCTIONAL, 0}};
enum { MODES = sizeof modes / sizeof *modes };

struct result {
  struct trax_stats stats;
  double seconds;         /* of the host's processor, for the run without loading */
  double speed_up, error; /* error: relative to the truth */
  bool covered;           /* the truth lies in the interval */
};

static trax_status run_mode(struct result *result, const struct mode *mode, const trax_config *config,
                            const struct trax_options *options,
                            trax_status (*load)(trax_machine *, const struct trax_options *, trax_error *),
                            const volatile int *interrupt, trax_error *error) {
  trax_machine *machine = trax_machine_create(config, error);
  if (!machine)
    return TRAX_ERROR;
  trax_run_options run = {
      .engine = mode->engine, .interrupt = interrupt, .sampling = options->sampling, .host_threads = 1};
  if (!run.sampling.period)
    run.sampling.period = mode->period * machine->stats.threads;
  trax_status status = load(machine, options, error);
  if (status == TRAX_OK) {
    const clock_t begun = clock(); /* of the processor: the host may have other things to do */
    status = trax_machine_run(machine, &run, error);
    result->seconds = (double)(clock() - begun) / CLOCKS_PER_SEC;
    if (status != TRAX_OK && status != TRAX_ERROR) {
      const trax_error reason = *error;
      status = trax_fail(error, "%s: the run does not finish: %.900s", mode->name, reason.message);
    }
  }
  result->stats = machine->stats;
  trax_machine_destroy(machine);
  return status;
}

static void print_row(FILE *out, const struct mode *mode, const struct result *result) {
  const struct trax_sampling_stats *sampling = &result->stats.sampling;
  fprintf(out, "%-16s %9.3f %9.2f", mode->name, result->seconds, result->speed_up);
  if (mode->engine == TRAX_ENGINE_FUNCTIONAL)
    fprintf(out, " %14s", "-");
  else
    fprintf(out, " %14" PRIu64, result->stats.cycles);
  if (sampling->is_sampled && sampling->has_interval)
    fprintf(out, " %8.2f %14.0f %14.0f  %-5s %8" PRIu64 " %9.1f", 100 * result->error, sampling->low, sampling->high,
            result->covered ? "yes" : "no", sampling->windows,
            100 * (double)sampling->detailed_instructions / (double)result->stats.instructions);
  else if (sampling->is_sampled)
    fprintf(out, " %8.2f %14s %14s  %-5s %8" PRIu64, 100 * result->error, "-", "-", "-", sampling->windows);
  fprintf(out, "\n");
}

static json_t *as_json(const struct mode *mode, const struct result *result) {
  const struct trax_sampling_stats *sampling = &result->stats.sampling;
  json_t *row = json_pack("{s: s, s: f, s: f, s: I}", "mode", mode->name, "host_seconds", result->seconds, "speed_up",
                          result->speed_up, "instructions", (json_int_t)result->stats.instructions);
  if (mode->engine != TRAX_ENGINE_FUNCTIONAL)
    json_object_set_new(row, "cycles", json_integer((json_int_t)result->stats.cycles));
  if (sampling->is_sampled) {
    json_object_set_new(row, "error", json_real(result->error));
    json_object_set_new(row, "period", json_integer((json_int_t)sampling->asked.period));
    json_object_set_new(row, "windows", json_integer((json_int_t)sampling->windows));
    json_object_set_new(row, "detailed_instructions", json_integer((json_int_t)sampling->detailed_instructions));
    json_object_set_new(row, "cycles_low", sampling->has_interval ? json_real(sampling->low) : json_null());
    json_object_set_new(row, "cycles_high", sampling->has_interval ? json_real(sampling->high) : json_null());
    json_object_set_new(row, "covered", sampling->has_interval ? json_boolean(result->covered) : json_null());
  }
  return row;
}

static trax_status write_json(const struct result *results, const char *path, trax_error *error) {
  json_t *rows = json_array();
  for (unsigned i = 0; i < MODES; i++)
    json_array_append_new(rows, as_json(&modes[i], &results[i]));
  trax_output output;
  trax_status status = trax_output_open(&output, path, error);
  if (status == TRAX_OK) {
    json_dumpf(rows, output.file, JSON_INDENT(2) | JSON_REAL_PRECISION(15)); /* a failure shows again at the end */
    fputc('\n', output.file);
    status = trax_output_commit(&output, error);
  }
  json_decref(rows);
  return status;
}

trax_status trax_bench_modes(const trax_config *config, const struct trax_options *options,
                             trax_status (*load)(trax_machine *machine, const struct trax_options *options,
                                                 trax_error *error),
                             const volatile int *interrupt, FILE *out, trax_error *error) {
  struct result results[MODES] = {0};
  fprintf(out, "%-16s %9s %9s %14s %8s %14s %14s  %-5s %8s %9s\n", "mode", "host s", "speed-up", "cycles", "error %",
          "from", "to (95 %)", "truth", "windows", "detail %");
  for (unsigned i = 0; i < MODES; i++) {
    struct result *result = &results[i];
    if (run_mode(result, &modes[i], config, options, load, interrupt, error) != TRAX_OK)
      return TRAX_ERROR;
    const struct trax_stats *truth = &results[0].stats, *stats = &result->stats;
    result->speed_up = results[0].seconds / result->seconds;
    result->error = (double)stats->cycles / (double)truth->cycles - 1;
    result->covered = stats->sampling.low <= (double)truth->cycles && (double)truth->cycles <= stats->sampling.high;
    print_row(out, &modes[i], result);
    fflush(out);
  }
  return options->stats ? write_json(results, options->stats, error) : TRAX_OK;
}
