#include "options.h"

#include "core/config_keys.h"

#include <ctype.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "trax/files.h"
#include "util.h"

enum option_id {
  OPTION_CONFIG,
  OPTION_SET,
  OPTION_BIND,
  OPTION_SCENE,
  OPTION_ALLOC,
  OPTION_DUMP,
  OPTION_SIGNATURE,
  OPTION_STATS,
  OPTION_REPORT,
  OPTION_PROFILE,
  OPTION_PROFILE_FOLDED,
  OPTION_ANNOTATE,
  OPTION_HEAT,
  OPTION_HEAT_LINES,
  OPTION_ITEMS,
  OPTION_ITEM_BUFFER,
  OPTION_LOCKSTEP,
  OPTION_SERIES,
  OPTION_SERIES_INTERVAL,
  OPTION_TRACE,
  OPTION_PERFETTO,
  OPTION_KONATA,
  OPTION_WINDOW,
  OPTION_WINDOW_TMS,
  OPTION_WINDOW_TPS,
  OPTION_MAX_CYCLES,
  OPTION_WATCHDOG,
  OPTION_PROGRESS_TOTAL,
  OPTION_ENGINE,
  OPTION_HOST_THREADS,
  OPTION_CHECK_ORDER,
  OPTION_POST_MORTEM,
  OPTION_GDB,
  OPTION_GDB_SYMBOLS,
  OPTION_CHECKPOINT,
  OPTION_CHECKPOINT_AT,
  OPTION_CHECKPOINT_EVERY,
  OPTION_RESUME,
  OPTION_QUIET,
  OPTION_PRINT_CONFIG,
  OPTION_HELP_CONFIG,
  OPTION_HELP_STATS,
  OPTION_VERSION,
  OPTION_HELP
};

/* By id; argument is NULL for a switch. */
static const struct {
  const char *name, *argument, *meaning;
} table[] = {
    [OPTION_CONFIG] = {"config", "PRESET|FILE", "machine: a chip of the paper (4x32) or a file; default one TP"},
    [OPTION_SET] = {"set", "KEY=VALUE", "change one value of the machine (--help-config)"},
    [OPTION_BIND] = {"bind", "SYMBOL=FILE", "fill the program's buffer SYMBOL with a file"},
    [OPTION_SCENE] = {"scene", "FILE", "the same as --bind scene=FILE"},
    [OPTION_ALLOC] = {"alloc", "SYMBOL=BYTES", "fill the program's buffer SYMBOL with zeros"},
    [OPTION_DUMP] = {"dump", "SYMBOL=FILE", "write the buffer SYMBOL to a file after the run"},
    [OPTION_SIGNATURE] = {"signature", "FILE",
                          "the words from begin_signature to end_signature after the run, and its fault"},
    [OPTION_STATS] = {"stats", "FILE", "statistics as JSON; - is standard output"},
    [OPTION_REPORT] = {"report", "FILE", "statistics as text; - is standard output"},
    [OPTION_PROFILE] = {"profile", "FILE", "thread-cycles by function and by source line"},
    [OPTION_PROFILE_FOLDED] = {"profile-folded", "FILE", "thread-cycles by call stack, for flame graphs"},
    [OPTION_ANNOTATE] = {"annotate", "FILE", "thread-cycles by instruction"},
    [OPTION_HEAT] = {"heat", "FILE", "accesses to memory by object, as CSV"},
    [OPTION_HEAT_LINES] = {"heat-lines", "FILE", "accesses to global memory by 64 bytes, as CSV"},
    [OPTION_ITEMS] = {"items", "FILE", "what each item (pixel) cost, as CSV"},
    [OPTION_ITEM_BUFFER] = {"item-buffer", "SYMBOL", "the buffer of words that items store to, for their places"},
    [OPTION_LOCKSTEP] = {"lockstep", "FILE", "what the items would take on a SIMD machine, as CSV"},
    [OPTION_SERIES] = {"series", "FILE", "what was counted in every interval, as CSV"},
    [OPTION_SERIES_INTERVAL] = {"series-interval", "N", "cycles of an interval; default 10000"},
    [OPTION_TRACE] = {"trace", "FILE", "every instruction issued in the window, with values"},
    [OPTION_PERFETTO] = {"perfetto", "FILE", "the window as a time line, as JSON trace events"},
    [OPTION_KONATA] = {"konata", "FILE", "the window as a pipeline, for Konata"},
    [OPTION_WINDOW] = {"window", "BEGIN:END", "cycles of the window, BEGIN <= cycle < END; default all"},
    [OPTION_WINDOW_TMS] = {"window-tms", "LIST", "its TMs, as in 0,2-3; default all"},
    [OPTION_WINDOW_TPS] = {"window-tps", "LIST", "its TPs in each of these TMs; default all"},
    [OPTION_MAX_CYCLES] = {"max-cycles", "N", "stop after N simulated cycles, with exit status 124"},
    [OPTION_WATCHDOG] = {"watchdog", "N",
                         "the same when for N cycles no thread ends and no ray, item or output is seen"},
    [OPTION_PROGRESS_TOTAL] = {"progress-total", "N", "items the program will finish, for the time left"},
    [OPTION_ENGINE] = {"engine", "NAME", "fast (default), reference (the same, slower) or functional (no time)"},
    [OPTION_HOST_THREADS] = {"host-threads", "N",
                             "threads of the host for the fast engine; default one for each processor it may use"},
    [OPTION_CHECK_ORDER] = {"check-order", NULL,
                            "report the first load that may return an old value on such a machine"},
    [OPTION_POST_MORTEM] = {"post-mortem", "FILE", "where every thread was when the run ended, as text"},
    [OPTION_GDB] = {"gdb", "PORT", "wait for GDB on a port of the loopback interface; 0 is any free one"},
    [OPTION_GDB_SYMBOLS] = {"gdb-symbols", "FILE", "write PROGRAM as GDB reads it; end, unless there is --gdb"},
    [OPTION_CHECKPOINT] = {"checkpoint", "FILE", "write the run's state when it is stopped, and when the next two say"},
    [OPTION_CHECKPOINT_AT] = {"checkpoint-at", "N", "before cycle N"},
    [OPTION_CHECKPOINT_EVERY] = {"checkpoint-every", "N", "before each multiple of N cycles"},
    [OPTION_RESUME] = {"resume", "FILE",
                       "go on with the run of a checkpoint; the other options are to be as they were"},
    [OPTION_QUIET] = {"quiet", NULL, "no progress line"},
    [OPTION_PRINT_CONFIG] = {"print-config", NULL, "print the machine as a file for --config, and end"},
    [OPTION_HELP_CONFIG] = {"help-config", NULL, "describe every key of the configuration, and end"},
    [OPTION_HELP_STATS] = {"help-stats", NULL, "describe every statistic, and end"},
    [OPTION_VERSION] = {"version", NULL, "print the version, and end"},
    [OPTION_HELP] = {"help", NULL, "print this, and end"},
};
enum { OPTIONS = sizeof table / sizeof *table };

void trax_options_help(FILE *out) {
  fprintf(out, "usage: trax-sim [OPTION...] PROGRAM\n\n"
               "Runs an executable for the TRaX ray-tracing accelerator, cycle by cycle. The program's\n"
               "output is standard output, and its exit status is that of trax-sim.\n\n");
  for (unsigned i = 0; i < OPTIONS; ++i) {
    char option[64];
    snprintf(option, sizeof option, "--%s%s%s", table[i].name, table[i].argument ? " " : "",
             table[i].argument ? table[i].argument : "");
    fprintf(out, "  %-24s %s\n", option, table[i].meaning);
  }
  fprintf(
      out,
      "\nExit status: the program's; 1 for an error of use or a fault of the program, 134 if it aborts,\n"
      "124 if --max-cycles or --watchdog ends it, 130 if it is interrupted. Without --stats and --report nothing but\n"
      "the program's output is printed; faults and errors go to standard error.\n");
}

static const char *option_name(const void *context, size_t i) {
  (void)context;
  return table[i].name;
}

/* Options of earlier versions, with what to use instead. */
static const struct {
  const char *name, *instead;
} removed[] = {
    {"sample", "for estimates use trax-render --sampled, with --sample-fraction and the like"},
    {"bench-modes", "run with --engine fast and --engine functional; for estimates use trax-render --sampled"},
};

static trax_status find_option(const char *name, size_t length, enum option_id *id, trax_error *error) {
  for (unsigned i = 0; i < OPTIONS; ++i)
    if (strlen(table[i].name) == length && strncmp(table[i].name, name, length) == 0) {
      *id = (enum option_id)i;
      return TRAX_OK;
    }
  for (unsigned i = 0; i < sizeof removed / sizeof *removed; ++i)
    if (strlen(removed[i].name) == length && strncmp(removed[i].name, name, length) == 0)
      return trax_fail(error, "--%s has been removed; %s", removed[i].name, removed[i].instead);
  char mistyped[128];
  snprintf(mistyped, sizeof mistyped, "%.*s", (int)(length < 120 ? length : 120), name);
  const char *nearest = trax_nearest_name(mistyped, OPTIONS, option_name, NULL);
  return trax_fail(error, "unknown option --%s%s%s%s", mistyped, nearest ? "; did you mean --" : "",
                   nearest ? nearest : "", nearest ? "?" : "");
}

static trax_status parse_number(const char *option, const char *text, uint64_t least, uint64_t most, uint64_t *value,
                                trax_error *error) {
  char *end = NULL;
  errno = 0;
  if (isdigit((unsigned char)*text))
    *value = strtoull(text, &end, text[0] == '0' && (text[1] == 'x' || text[1] == 'X') ? 16 : 10);
  if (!end || *end || errno || *value < least || *value > most)
    return trax_fail(error, "--%s: \"%s\" is not a whole number from %llu to %llu", option, text,
                     (unsigned long long)least, (unsigned long long)most);
  return TRAX_OK;
}

static trax_status add_assignment(struct trax_options *options, enum option_id id, const char *text,
                                  trax_error *error) {
  const char *equals = strchr(text, '=');
  if (!equals || equals == text || !equals[1])
    return trax_fail(error, "--%s: \"%s\" is not of the form %s", table[id].name, text, table[id].argument);
  struct trax_assignment assignment = {.kind = id == OPTION_SET     ? TRAX_ASSIGN_SET
                                               : id == OPTION_ALLOC ? TRAX_ASSIGN_ALLOC
                                               : id == OPTION_DUMP  ? TRAX_ASSIGN_DUMP
                                                                    : TRAX_ASSIGN_BIND};
  if (id == OPTION_ALLOC) {
    uint64_t bytes;
    if (parse_number(table[id].name, equals + 1, 0, UINT32_MAX, &bytes, error) != TRAX_OK)
      return TRAX_ERROR;
    assignment.bytes = (uint32_t)bytes;
  }
  struct trax_assignment *grown =
      realloc(options->assignments, (options->assignment_count + 1) * sizeof *options->assignments);
  if (!grown)
    return trax_fail(error, "out of memory");
  options->assignments = grown;
  assignment.name = strdup(text);
  if (!assignment.name)
    return trax_fail(error, "out of memory");
  assignment.name[equals - text] = 0;
  assignment.value = assignment.name + (equals - text) + 1;
  options->assignments[options->assignment_count++] = assignment;
  return TRAX_OK;
}

static trax_status add_scene(struct trax_options *options, const char *path, trax_error *error) {
  char *text = malloc(strlen(path) + sizeof "scene=");
  if (!text)
    return trax_fail(error, "out of memory");
  strcat(strcpy(text, "scene="), path);
  trax_status status = add_assignment(options, OPTION_BIND, text, error);
  free(text);
  return status;
}

static trax_status set_once(enum option_id id, const char **member, const char *value, trax_error *error) {
  if (*member)
    return trax_fail(error, "--%s is given twice", table[id].name);
  if (!*value)
    return trax_fail(error, "--%s: %s is empty", table[id].name, table[id].argument);
  *member = value;
  return TRAX_OK;
}

static trax_status set_engine(struct trax_options *options, const char *value, trax_error *error) {
  if (strcmp(value, "reference") == 0)
    options->engine = TRAX_ENGINE_REFERENCE;
  else if (strcmp(value, "fast") == 0)
    options->engine = TRAX_ENGINE_FAST;
  else if (strcmp(value, "functional") == 0)
    options->engine = TRAX_ENGINE_FUNCTIONAL;
  else
    return trax_fail(error, "--engine: \"%s\" is none of fast, reference and functional%s", value,
                     strcmp(value, "sampled") == 0 ? "; for estimates use trax-render --sampled" : "");
  return TRAX_OK;
}

static trax_status set_window(struct trax_options *options, const char *value, trax_error *error) {
  struct trax_explain_options *explain = &options->explain;
  const char *colon = strchr(value, ':');
  char begin[32];
  if (!colon || colon - value >= (int)sizeof begin)
    return trax_fail(error, "--window: \"%s\" is not of the form BEGIN:END", value);
  snprintf(begin, sizeof begin, "%.*s", (int)(colon - value), value);
  if (parse_number("window", begin, 0, UINT64_MAX / 2, &explain->window_begin, error) != TRAX_OK)
    return TRAX_ERROR;
  return parse_number("window", colon + 1, explain->window_begin + 1, UINT64_MAX / 2, &explain->window_end, error);
}

/* Numbers from 0 to 63 and ranges of them: 0,2-3. */
static trax_status set_mask(enum option_id id, uint64_t *mask, const char *value, trax_error *error) {
  *mask = 0;
  for (const char *text = value;; text++) {
    char *end = NULL;
    unsigned long first = isdigit((unsigned char)*text) ? strtoul(text, &end, 10) : 64, last = first;
    if (end && *end == '-' && isdigit((unsigned char)end[1]))
      last = strtoul(end + 1, &end, 10);
    if (!end || first > last || last > 63 || (*end && *end != ','))
      return trax_fail(error, "--%s: \"%s\" is no list of numbers from 0 to 63 as in 0,2-3", table[id].name, value);
    for (; first <= last; first++)
      *mask |= (uint64_t)1 << first;
    if (!*end)
      return TRAX_OK;
    text = end;
  }
}

static trax_status apply(struct trax_options *options, enum option_id id, const char *value, trax_error *error) {
  uint64_t number;
  switch (id) {
  case OPTION_CONFIG:
    return set_once(id, &options->config, value, error);
  case OPTION_SIGNATURE:
    return set_once(id, &options->signature, value, error);
  case OPTION_STATS:
    return set_once(id, &options->stats, value, error);
  case OPTION_REPORT:
    return set_once(id, &options->report, value, error);
  case OPTION_PROFILE:
    return set_once(id, &options->explain.profile, value, error);
  case OPTION_PROFILE_FOLDED:
    return set_once(id, &options->explain.folded, value, error);
  case OPTION_ANNOTATE:
    return set_once(id, &options->explain.annotate, value, error);
  case OPTION_HEAT:
    return set_once(id, &options->explain.heat, value, error);
  case OPTION_HEAT_LINES:
    return set_once(id, &options->explain.heat_lines, value, error);
  case OPTION_ITEMS:
    return set_once(id, &options->explain.items, value, error);
  case OPTION_ITEM_BUFFER:
    return set_once(id, &options->explain.item_buffer, value, error);
  case OPTION_LOCKSTEP:
    return set_once(id, &options->explain.lockstep, value, error);
  case OPTION_SERIES:
    return set_once(id, &options->explain.series, value, error);
  case OPTION_SERIES_INTERVAL:
    return parse_number(table[id].name, value, 1, UINT64_MAX / 2, &options->explain.series_interval, error);
  case OPTION_TRACE:
    return set_once(id, &options->explain.trace, value, error);
  case OPTION_PERFETTO:
    return set_once(id, &options->explain.perfetto, value, error);
  case OPTION_KONATA:
    return set_once(id, &options->explain.konata, value, error);
  case OPTION_WINDOW:
    return set_window(options, value, error);
  case OPTION_WINDOW_TMS:
    return set_mask(id, &options->explain.window_tms, value, error);
  case OPTION_WINDOW_TPS:
    return set_mask(id, &options->explain.window_tps, value, error);
  case OPTION_SET:
  case OPTION_BIND:
  case OPTION_ALLOC:
  case OPTION_DUMP:
    return add_assignment(options, id, value, error);
  case OPTION_SCENE:
    return add_scene(options, value, error);
  case OPTION_MAX_CYCLES:
    return parse_number(table[id].name, value, 1, UINT64_MAX, &options->max_cycles, error);
  case OPTION_WATCHDOG:
    return parse_number(table[id].name, value, 1, UINT64_MAX / 2, &options->watchdog, error);
  case OPTION_PROGRESS_TOTAL:
    return parse_number(table[id].name, value, 1, UINT64_MAX, &options->total_items, error);
  case OPTION_ENGINE:
    return set_engine(options, value, error);
  case OPTION_HOST_THREADS:
    if (parse_number(table[id].name, value, 1, TRAX_MAX_TMS, &number, error))
      return TRAX_ERROR;
    options->host_threads = (unsigned)number;
    break;
  case OPTION_CHECK_ORDER:
    options->explain.check_order = true;
    break;
  case OPTION_POST_MORTEM:
    return set_once(id, &options->post_mortem, value, error);
  case OPTION_GDB:
    options->gdb = true;
    return parse_number(table[id].name, value, 0, UINT16_MAX, &options->gdb_port, error);
  case OPTION_GDB_SYMBOLS:
    return set_once(id, &options->gdb_symbols, value, error);
  case OPTION_CHECKPOINT:
    return set_once(id, &options->checkpoint.write, value, error);
  case OPTION_CHECKPOINT_AT:
    return parse_number(table[id].name, value, 1, UINT64_MAX, &options->checkpoint.at, error);
  case OPTION_CHECKPOINT_EVERY:
    return parse_number(table[id].name, value, 1, UINT64_MAX, &options->checkpoint.every, error);
  case OPTION_RESUME:
    return set_once(id, &options->checkpoint.resume, value, error);
  case OPTION_QUIET:
    options->quiet = true;
    break;
  case OPTION_PRINT_CONFIG:
    options->print_config = true;
    break;
  case OPTION_HELP_CONFIG:
    options->show = TRAX_SHOW_CONFIG_KEYS;
    break;
  case OPTION_HELP_STATS:
    options->show = TRAX_SHOW_STATS;
    break;
  case OPTION_VERSION:
    options->show = TRAX_SHOW_VERSION;
    break;
  case OPTION_HELP:
    options->show = TRAX_SHOW_HELP;
    break;
  }
  return TRAX_OK;
}

static trax_status parse_option(struct trax_options *options, char **arguments, int count, int *i, trax_error *error) {
  const char *text = arguments[*i] + 2;
  const char *equals = strchr(text, '=');
  enum option_id id = OPTION_HELP;
  if (find_option(text, equals ? (size_t)(equals - text) : strlen(text), &id, error) != TRAX_OK)
    return TRAX_ERROR;
  if (!table[id].argument)
    return equals ? trax_fail(error, "--%s takes no value", table[id].name) : apply(options, id, NULL, error);
  if (equals)
    return apply(options, id, equals + 1, error);
  if (*i + 1 >= count)
    return trax_fail(error, "--%s needs %s", table[id].name, table[id].argument);
  return apply(options, id, arguments[++*i], error);
}

/* What explains a run, and what it needs. */
static trax_status check_explain(const struct trax_options *options, trax_error *error) {
  const struct trax_explain_options *explain = &options->explain;
  const bool windowed = explain->trace || explain->perfetto || explain->konata;
  const bool exact = options->engine == TRAX_ENGINE_FAST || options->engine == TRAX_ENGINE_REFERENCE;
  if (!exact && trax_explain_wanted(explain))
    return trax_fail(error, "only the engines fast and reference know every cycle: there is nothing to explain");
  if (options->checkpoint.resume && trax_explain_wanted(explain))
    return trax_fail(error, "--resume: what was before the checkpoint is not known, and the run cannot be explained");
  if ((explain->perfetto || explain->konata) && !explain->window_end)
    return trax_fail(error, "--%s needs --window", explain->perfetto ? "perfetto" : "konata");
  if (!windowed && (explain->window_end || explain->window_tms || explain->window_tps))
    return trax_fail(error, "--window without --trace, --perfetto or --konata");
  if (explain->series_interval && !explain->series)
    return trax_fail(error, "--series-interval without --series");
  if (explain->item_buffer && !explain->items)
    return trax_fail(error, "--item-buffer without --items");
  return TRAX_OK;
}

static bool is_preset(const char *name) {
  for (const char *const *preset = trax_config_presets(); *preset; preset++)
    if (strcmp(*preset, name) == 0)
      return true;
  return false;
}

/* No output may be what the run reads, and none is written twice. */
static trax_status check_files(const struct trax_options *options, trax_error *error) {
  const struct trax_explain_options *explain = &options->explain;
  const struct {
    enum option_id id;
    const char *path;
  } outputs[] = {{OPTION_SIGNATURE, options->signature},
                 {OPTION_STATS, options->stats},
                 {OPTION_REPORT, options->report},
                 {OPTION_PROFILE, explain->profile},
                 {OPTION_PROFILE_FOLDED, explain->folded},
                 {OPTION_ANNOTATE, explain->annotate},
                 {OPTION_HEAT, explain->heat},
                 {OPTION_HEAT_LINES, explain->heat_lines},
                 {OPTION_ITEMS, explain->items},
                 {OPTION_LOCKSTEP, explain->lockstep},
                 {OPTION_SERIES, explain->series},
                 {OPTION_TRACE, explain->trace},
                 {OPTION_PERFETTO, explain->perfetto},
                 {OPTION_KONATA, explain->konata},
                 {OPTION_POST_MORTEM, options->post_mortem},
                 {OPTION_GDB_SYMBOLS, options->gdb_symbols},
                 {OPTION_CHECKPOINT, options->checkpoint.write}};
  trax_files files = {0};
  char name[40];
  trax_files_input(&files, NULL, options->program);
  if (options->config && !is_preset(options->config))
    trax_files_input(&files, NULL, options->config);
  trax_files_input(&files, NULL, options->checkpoint.resume);
  for (size_t i = 0; i < sizeof outputs / sizeof *outputs; i++) {
    snprintf(name, sizeof name, "--%s", table[outputs[i].id].name);
    trax_files_output(&files, name, outputs[i].path);
  }
  for (size_t i = 0; i < options->assignment_count; i++) {
    const struct trax_assignment *assignment = &options->assignments[i];
    if (assignment->kind == TRAX_ASSIGN_BIND)
      trax_files_input(&files, NULL, assignment->value);
    else if (assignment->kind == TRAX_ASSIGN_DUMP)
      trax_files_output(&files, "--dump", assignment->value);
  }
  trax_status status = trax_files_check(&files, error);
  trax_files_release(&files);
  return status;
}

trax_status trax_options_parse(struct trax_options *options, int count, char **arguments, trax_error *error) {
  *options = (struct trax_options){0};
  bool only_names = false;
  for (int i = 1; i < count; ++i) {
    const char *argument = arguments[i];
    if (!only_names && strcmp(argument, "--") == 0) {
      only_names = true;
    } else if (!only_names && strncmp(argument, "--", 2) == 0) {
      if (parse_option(options, arguments, count, &i, error) != TRAX_OK)
        return TRAX_ERROR;
    } else if (!only_names && argument[0] == '-' && argument[1]) {
      return trax_fail(error, "unknown option %s; options begin with two dashes", argument);
    } else if (options->program) {
      return trax_fail(error, "two programs, %s and %s: a program takes no arguments", options->program, argument);
    } else {
      options->program = argument;
    }
  }
  const struct trax_checkpoint_options *checkpoint = &options->checkpoint;
  if ((checkpoint->at || checkpoint->every) && !checkpoint->write)
    return trax_fail(error, "--checkpoint-at and --checkpoint-every need --checkpoint");
  if ((checkpoint->write || checkpoint->resume) && options->engine != TRAX_ENGINE_FAST)
    return trax_fail(error, "--checkpoint and --resume are for the fast engine");
  if (options->watchdog && options->engine == TRAX_ENGINE_FUNCTIONAL)
    return trax_fail(error, "--watchdog needs an engine with cycles, not functional");
  if (!options->program && !options->print_config && options->show == TRAX_SHOW_NOTHING)
    return trax_fail(error, "no program is given");
  if (options->post_mortem && options->engine != TRAX_ENGINE_FAST && options->engine != TRAX_ENGINE_FUNCTIONAL)
    return trax_fail(error, "--post-mortem needs the fast or the functional engine");
  if (options->gdb && options->engine != TRAX_ENGINE_FAST)
    return trax_fail(error, "--gdb debugs in the fast engine, not in the one that --engine names");
  return check_explain(options, error) == TRAX_OK ? check_files(options, error) : TRAX_ERROR;
}

void trax_options_free(struct trax_options *options) {
  for (size_t i = 0; i < options->assignment_count; ++i)
    free(options->assignments[i].name);
  free(options->assignments);
  *options = (struct trax_options){0};
}
