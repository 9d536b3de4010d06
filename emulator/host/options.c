#include "host/options.h"

#include "machine/config_keys.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "control/engines.h"
#include "program/program.h"
#include "trax/output.h"

enum { MOST_PIXELS = 16384 }; /* of a side of a picture */

/* --- values --- */

static trax_status append(struct trax_options *options, struct trax_assignment assignment, const char *name,
                          size_t length, const char *value, trax_error *error) {
  struct trax_assignment *grown =
      realloc(options->assignments, (options->assignment_count + 1) * sizeof *options->assignments);
  if (!grown)
    return trax_fail(error, "out of memory");
  options->assignments = grown;
  assignment.name = malloc(length + strlen(value) + 2);
  if (!assignment.name)
    return trax_fail(error, "out of memory");
  memcpy(assignment.name, name, length);
  assignment.name[length] = 0;
  assignment.value = strcpy(assignment.name + length + 1, value);
  options->assignments[options->assignment_count++] = assignment;
  return TRAX_OK;
}

static trax_status add_assignment(struct trax_options *options, const trax_option *option,
                                  struct trax_assignment assignment, const char *text, trax_error *error) {
  const char *equals = strchr(text, '=');
  if (!equals || equals == text || !equals[1])
    return trax_option_refuse(option, text, error, "is not of the form %s", option->argument);
  uint64_t bytes = 0;
  if (assignment.kind == TRAX_ASSIGN_ALLOC && trax_option_number(option, equals + 1, 0, UINT32_MAX, &bytes, error))
    return TRAX_ERROR;
  assignment.bytes = (uint32_t)bytes;
  return append(options, assignment, text, (size_t)(equals - text), equals + 1, error);
}

#define ASSIGNMENT_PARSER(function, what)                                                                              \
  static trax_status function(void *target, const trax_option *option, const char *value, trax_error *error) {         \
    return add_assignment(target, option, (struct trax_assignment){.kind = what}, value, error);                       \
  }
ASSIGNMENT_PARSER(parse_set, TRAX_ASSIGN_SET)
ASSIGNMENT_PARSER(parse_bind, TRAX_ASSIGN_BIND)
ASSIGNMENT_PARSER(parse_alloc, TRAX_ASSIGN_ALLOC)

/* SYMBOL=FILE, or SYMBOL=FILE.png:WIDTHxHEIGHT. */
static trax_status parse_dump(void *target, const trax_option *option, const char *value, trax_error *error) {
  struct trax_assignment dump = {.kind = TRAX_ASSIGN_DUMP};
  const char *colon = strrchr(value, ':'), *end = colon ? colon : value + strlen(value);
  unsigned across, down;
  char rest;
  if (end - value < 4 || strncasecmp(end - 4, ".png", 4) != 0)
    return colon && sscanf(colon, ":%ux%u%c", &across, &down, &rest) == 2
               ? trax_option_refuse(option, value, error,
                                    "has no writer for such pictures: a PNG is SYMBOL=FILE.png:WIDTHxHEIGHT")
               : add_assignment(target, option, dump, value, error);
  char *after = NULL;
  const unsigned long width = colon && isdigit((unsigned char)colon[1]) ? strtoul(colon + 1, &after, 10) : 0;
  const bool has_height = after && after[0] == 'x' && isdigit((unsigned char)after[1]);
  const unsigned long height = has_height ? strtoul(after + 1, &after, 10) : 0;
  if (width < 1 || width > MOST_PIXELS || height < 1 || height > MOST_PIXELS || *after)
    return trax_option_refuse(option, value, error, "has no size of the picture: a PNG is SYMBOL=FILE.png:WIDTHxHEIGHT");
  dump.width = (uint32_t)width;
  dump.height = (uint32_t)height;
  char *text = strndup(value, (size_t)(end - value));
  if (!text)
    return trax_fail(error, "out of memory");
  const trax_status status = add_assignment(target, option, dump, text, error);
  free(text);
  return status;
}

static trax_status parse_scene(void *target, const trax_option *option, const char *value, trax_error *error) {
  char *text = malloc(strlen(value) + sizeof "scene=");
  if (!text)
    return trax_fail(error, "out of memory");
  strcat(strcpy(text, "scene="), value);
  trax_status status = parse_bind(target, option, text, error);
  free(text);
  return status;
}

static trax_status parse_dir(void *target, const trax_option *option, const char *value, trax_error *error) {
  const char *colons = strstr(value, "::");
  const size_t length = colons ? (size_t)(colons - value) : strlen(value);
  if (length == 0 || (colons && !colons[2]))
    return trax_option_refuse(option, value, error, "is not of the form %s", option->argument);
  return append(target, (struct trax_assignment){.kind = TRAX_ASSIGN_DIR}, value, length, colons ? colons + 2 : value,
                error);
}

static trax_status parse_main_on(void *target, const trax_option *option, const char *value, trax_error *error) {
  struct trax_options *options = target;
  options->main_on_thread_0 = strcmp(value, "0") == 0;
  return options->main_on_thread_0 || strcmp(value, "all") == 0
             ? TRAX_OK
             : trax_option_refuse(option, value, error, "is neither 0 nor all");
}

static trax_status parse_engine(void *target, const trax_option *option, const char *value, trax_error *error) {
  struct trax_options *options = target;
  trax_error reason;
  if (trax_engine_find(value, &options->engine, &reason) != TRAX_OK)
    return trax_option_refuse(option, value, error, "%s", reason.message);
  options->engine_is_named = true;
  return TRAX_OK;
}

static trax_status parse_window(void *target, const trax_option *option, const char *value, trax_error *error) {
  struct trax_explain_options *explain = &((struct trax_options *)target)->explain;
  const char *colon = strchr(value, ':');
  char begin[32];
  if (!colon || colon - value >= (int)sizeof begin)
    return trax_option_refuse(option, value, error, "is not of the form BEGIN:END");
  snprintf(begin, sizeof begin, "%.*s", (int)(colon - value), value);
  if (trax_option_number(option, begin, 0, UINT64_MAX / 2, &explain->window_begin, error) != TRAX_OK)
    return TRAX_ERROR;
  return trax_option_number(option, colon + 1, explain->window_begin + 1, UINT64_MAX / 2, &explain->window_end, error);
}

/* Parses a list of numbers from 0 to 63 and ranges, such as 0,2-3, to a mask. */
static trax_status parse_list(void *target, const trax_option *option, const char *value, trax_error *error) {
  uint64_t *mask = (uint64_t *)((char *)target + option->offset);
  *mask = 0;
  for (const char *text = value;; text++) {
    char *end = NULL;
    unsigned long first = isdigit((unsigned char)*text) ? strtoul(text, &end, 10) : 64, last = first;
    if (end && *end == '-' && isdigit((unsigned char)end[1]))
      last = strtoul(end + 1, &end, 10);
    if (!end || first > last || last > 63 || (*end && *end != ','))
      return trax_option_refuse(option, value, error, "is no list of numbers from 0 to 63 as in 0,2-3");
    for (; first <= last; first++)
      *mask |= (uint64_t)1 << first;
    if (!*end)
      return TRAX_OK;
    text = end;
  }
}

static trax_status parse_source_folder(void *target, const trax_option *option, const char *value, trax_error *error) {
  trax_error reason;
  return trax_explain_add_source_folder(&((struct trax_options *)target)->explain, value, &reason) == TRAX_OK
             ? TRAX_OK
             : trax_fail(error, "--%s: %s", option->name, reason.message);
}

static trax_status parse_gdb(void *target, const trax_option *option, const char *value, trax_error *error) {
  struct trax_options *options = target;
  options->gdb = true;
  return trax_option_number(option, value, 0, UINT16_MAX, &options->gdb_port, error);
}

/* --- what the completion offers --- */

static const char *const main_on_words[] = {"0", "all", NULL};

static void put_engines(FILE *out) {
  for (unsigned i = 0; trax_engine_name(i); i++)
    fprintf(out, "%s ", trax_engine_name(i));
}

/* --- the table --- */

#define FIELD(member) TRAX_OPTION_FIELD(struct trax_options, member)
#define ONCE(member) FIELD(member), .once = true
#define OUTPUT(member) ONCE(member), .file = TRAX_OPTION_OUTPUT
#define NUMBER(member, least_, most_) FIELD(member), .least = (least_), .most = (most_)
#define PARSED(function, member) .parse = (function), .offset = offsetof(struct trax_options, member)

/* clang-format off */
static const trax_option rows[] = {
    TRAX_OPTION_GROUP("Machine"),
    {"config", .argument = "PRESET|FILE", ONCE(config), .words = trax_config_list_presets,
     .meaning = "machine: a chip of the paper (4x32) or a file; default one TP"},
    {"set", .argument = "KEY=VALUE", .parse = parse_set, .words = trax_config_list_keys,
     .meaning = "change one value of the machine (--help-config)"},
    {"print-config", FIELD(print_config), .meaning = "print the machine as a file for --config, and end"},
    {"help-config", .kind = TRAX_OPTION_SHOW, .show = trax_config_describe, .meaning = "describe every key of the configuration, and end"},
    TRAX_OPTION_GROUP("Buffers"),
    {"bind", .argument = "SYMBOL=FILE", .parse = parse_bind, .meaning = "fill the program's buffer SYMBOL with a file"},
    {"scene", .argument = "FILE", .parse = parse_scene, .meaning = "the same as --bind scene=FILE"},
    {"alloc", .argument = "SYMBOL=BYTES", .parse = parse_alloc,
     .meaning = "fill the program's buffer SYMBOL with zeros"},
    {"dump", .argument = "SYMBOL=FILE", .parse = parse_dump,
     .meaning = "write the buffer SYMBOL to a file after the run; FILE.png:WxH: as a picture, 4 bytes a pixel"},
    {"signature", .argument = "FILE", OUTPUT(signature),
     .meaning = "write the words from begin_signature to end_signature, and the fault, after the run"},
    TRAX_OPTION_GROUP("Program"),
    {"dir", .argument = "FOLDER[::NAME]", .parse = parse_dir,
     .meaning = "let the program read and write files in FOLDER, which it sees as NAME"},
    {"main-on", .argument = "THREADS", .parse = parse_main_on, .choices = main_on_words,
     .meaning = "threads that call main: 0, the first alone, or all (default)"},
    TRAX_OPTION_GROUP("Run"),
    {"engine", .argument = "NAME", .parse = parse_engine, .words = put_engines,
     .meaning = "fast (default), reference (the same, slower), functional (no time) or simt\n"
                "(warps; the default if simt.width is more than 1)"},
    {"host-threads", .argument = "N", NUMBER(host_threads, 1, TRAX_MAX_TMS),
     .meaning = "threads of the host for the fast engine; default one for each processor it may use"},
    {"max-cycles", .argument = "N", NUMBER(max_cycles, 1, UINT64_MAX),
     .meaning = "stop after N simulated cycles, with exit status 124"},
    {"watchdog", .argument = "N", NUMBER(watchdog, 1, UINT64_MAX / 2),
     .meaning = "also stop after N cycles without the end of a thread, a ray, an item or output"},
    {"progress-total", .argument = "N", NUMBER(total_items, 1, UINT64_MAX),
     .meaning = "number of items that the program will report, for the time left"},
    TRAX_OPTION_GROUP("Statistics"),
    {"stats", .argument = "FILE", OUTPUT(stats), .meaning = "statistics as JSON; - is standard output"},
    {"ray-cycles", .argument = "FILE", OUTPUT(ray_cycles),
     .meaning = "thread-cycles of the rays of each kind, as CSV; as fast as without"},
    {"report", .argument = "FILE", OUTPUT(report), .meaning = "statistics as text; - is standard output"},
    {"help-stats", .kind = TRAX_OPTION_SHOW, .show = trax_stats_describe, .meaning = "describe every statistic, and end"},
    TRAX_OPTION_GROUP("Explanations of a run"),
#define EXPLANATION(ID, NAME, VALUE, MEANING) {NAME, .argument = VALUE, OUTPUT(explain.ID), .meaning = MEANING},
    TRAX_EXPLAIN_FILES(EXPLANATION)
#undef EXPLANATION
    {"source-folder", .argument = "FOLDER", .parse = parse_source_folder,
     .meaning = "let the page contain the sources in FOLDER, too (repeatable)"},
    {"item-buffer", .argument = "SYMBOL", ONCE(explain.item_buffer),
     .meaning = "the buffer to which the items store their results, for their places"},
    {"series-interval", .argument = "N", NUMBER(explain.series_interval, 1, UINT64_MAX / 2),
     .meaning = "cycles of an interval; default 10000"},
    {"window", .argument = "BEGIN:END", .parse = parse_window,
     .meaning = "cycles of the window, BEGIN <= cycle < END; default all"},
    {"window-tms", .argument = "LIST", PARSED(parse_list, explain.window_tms),
     .meaning = "its TMs, as in 0,2-3; default all"},
    {"window-tps", .argument = "LIST", PARSED(parse_list, explain.window_tps),
     .meaning = "its TPs in each of these TMs; default all"},
    {"check-memory", FIELD(explain.check_memory),
     .meaning = "report accesses out of bounds or after free, uses of memory never written, and leaks"},
    {"check-races", FIELD(explain.check_races),
     .meaning = "report accesses of two threads to the same word that nothing orders"},
    {"post-mortem", .argument = "FILE", OUTPUT(post_mortem),
     .meaning = "call chains of all threads at the end of the run, as text"},
    TRAX_OPTION_GROUP("Debugger"),
    {"gdb", .argument = "PORT", .parse = parse_gdb,
     .meaning = "wait for GDB on a port of the loopback interface; 0 is any free one"},
    {"gdb-symbols", .argument = "FILE", OUTPUT(gdb_symbols),
     .meaning = "write a copy of PROGRAM that GDB can read, and end, unless --gdb is given"},
    TRAX_OPTION_GROUP("Checkpoints"),
    {"checkpoint", .argument = "FILE", OUTPUT(checkpoint.write),
     .meaning = "write the run's state when it is stopped, and as the next two options say"},
    {"checkpoint-at", .argument = "N", NUMBER(checkpoint.at, 1, UINT64_MAX), .meaning = "write it before cycle N"},
    {"checkpoint-every", .argument = "N", NUMBER(checkpoint.every, 1, UINT64_MAX),
     .meaning = "write it before each multiple of N cycles"},
    {"resume", .argument = "FILE", ONCE(checkpoint.resume), .file = TRAX_OPTION_INPUT,
     .meaning = "continue the run of a checkpoint; the other options must be the same"},
    TRAX_OPTION_GROUP("Other"),
    {"quiet", FIELD(quiet), .meaning = "neither progress line nor the line at the end"},
    TRAX_OPTION_HELP(0),
    TRAX_OPTION_VERSION,
    {"sample", .instead = "for estimates use trax-render --sampled, with --sample-fraction and the like"},
    {"annotate", .instead = "--explore FILE.html has every line of the program with its instructions"},
    {"lockstep", .instead = "--set simt.width=32 simulates a SIMD machine: simt.efficiency is its lanes in use"},
    {"lockstep-rays",
     .instead = "--set simt.width=32 simulates a SIMD machine: simt.efficiency is its lanes in use"},
    {"check-order", .instead = "--check-races reports these loads, and other races"},
    {"konata", .instead = "--perfetto FILE shows the cycles of the window, --trace FILE each of its instructions"},
    {"memory-trace-format", .instead = "--memory-trace FILE.csv is CSV, another FILE binary; for DRAMsim3 and Ramulator 2 "
                                       "convert it by memory_trace_for.py (docs/traces.md)"},
    {"bench-modes", .instead = "run with --engine fast and --engine functional; for estimates use trax-render --sampled"},
    {0}};
/* clang-format on */

static const trax_command command = {
    .name = "trax-sim",
    .synopsis = "[OPTION...] PROGRAM [ARGUMENT...]\n[OPTION...] MANIFEST.json\ncompare [OPTION...] A B",
    .description = "Runs an executable for the TRaX ray-tracing accelerator, cycle by cycle. The program's\n"
                   "output is standard output, and its exit status is that of trax-sim. Words after\n"
                   "PROGRAM are for its main, or options if main has no parameters. A manifest\n"
                   "names program, buffers and machine (docs/manifest.md); options are added to it.\n"
                   "trax-sim compare shows what differs between two runs (trax-sim compare --help).",
    .rows = rows,
    .notes = "Exit status: the program's; 1 for an error of use or a fault of the program, 134 if it aborts,\n"
             "124 if --max-cycles or --watchdog ends it, 130 if it is interrupted. Without --stats and --report "
             "nothing but\n"
             "the program's output is printed; faults, errors and which sources a page contains go to standard error.\n"
             "On a terminal a line at the end says what the run took and wrote.",
    .examples = "trax-sim hello                                    # one TP runs a program\n"
                "trax-sim hello --config 4x32 --explore run.html   # a page that explains a run on 128 TPs\n"
                "trax-sim hello --set dcache.bytes=32768 --stats b.json\n"
                "trax-sim compare a.json b.json                    # what differs between two runs\n"
                "trax-sim hello --gdb 1234                         # waits for gdb-multiarch",
    .see_also = "trax-clang(1), trax-render(1), trax-eval(1), gdb-multiarch(1); docs/trax-sim.md, docs/explaining.md",
    .part = "compare",
    .part_of = "trax-eval",
    .column = 27};

/* --- rules about several options --- */

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

trax_status trax_options_choose_engine(struct trax_options *options, const struct trax_config *config,
                                       trax_error *error) {
  if (!options->engine_is_named)
    options->engine = trax_engine_for(config);
  return trax_engine_check(options->engine, config, error) == TRAX_OK && check_engine(options, error) == TRAX_OK
             ? check_explain(options, error)
             : TRAX_ERROR;
}

/* Checks that no output is an input and that no file is written twice. */
static trax_status check_files(const struct trax_options *options, trax_error *error) {
  trax_files files = {0};
  if (options->manifest)
    trax_manifest_inputs(options->manifest, &files);
  else
    trax_files_input(&files, NULL, options->program);
  if (options->config && !trax_config_is_preset(options->config))
    trax_files_input(&files, NULL, options->config);
  trax_command_files(&command, options, &files);
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

trax_status trax_options_check_outputs(const struct trax_options *options, trax_error *error) {
  trax_status status = trax_command_check_outputs(&command, options, error);
  for (size_t i = 0; i < options->assignment_count && status == TRAX_OK; i++)
    if (options->assignments[i].kind == TRAX_ASSIGN_DUMP)
      status = options->assignments[i].in_manifest
                   ? trax_manifest_check_output(options->manifest, options->assignments[i].name, error)
                   : trax_output_check(options->assignments[i].value, error);
  return status;
}

/* Reads a manifest that is given instead of a program. Options of the command line take precedence over it. */
static trax_status take_manifest(struct trax_options *options, trax_error *error) {
  if (!options->program || !trax_manifest_is(options->program))
    return TRAX_OK;
  options->manifest = trax_manifest_read(options->program, error);
  if (!options->manifest)
    return TRAX_ERROR;
  options->program = trax_manifest_program(options->manifest);
  if (!options->total_items)
    options->total_items = trax_manifest_items(options->manifest);
  const size_t given = options->assignment_count;
  const char *symbol, *path;
  for (size_t i = 0; trax_manifest_output(options->manifest, i, &symbol, &path); i++) {
    size_t other = 0;
    while (other < given && (options->assignments[other].kind != TRAX_ASSIGN_DUMP ||
                             strcmp(options->assignments[other].name, symbol) != 0))
      other++;
    if (other == given && append(options, (struct trax_assignment){.kind = TRAX_ASSIGN_DUMP, .in_manifest = true},
                                 symbol, strlen(symbol), path, error) != TRAX_OK)
      return TRAX_ERROR;
  }
  return TRAX_OK;
}

/* Whether what follows the program is for its main. A file that cannot be read is reported when it is loaded. */
static bool takes_arguments(const char *program) {
  trax_error ignored;
  trax_image *image = trax_manifest_is(program) ? NULL : trax_image_open(program, &ignored);
  const bool takes = image && trax_image_symbol(image, TRAX_ARGUMENTS_SYMBOL);
  if (image)
    trax_image_close(image);
  return takes;
}

trax_parsed trax_options_parse(struct trax_options *options, int count, char **arguments, trax_error *error) {
  *options = (struct trax_options){0};
  trax_engine_find(NULL, &options->engine, error);
  trax_parsed parsed = trax_command_parse_to_operand(&command, options, &count, arguments, error);
  options->program = parsed == TRAX_PARSED_RUN && count > 0 ? arguments[0] : NULL;
  if (count > 1 && options->program && takes_arguments(options->program)) {
    options->arguments = arguments;
    options->argument_count = count;
  } else if (options->program) {
    parsed = trax_command_parse(&command, options, &count, arguments, error);
  }
  if (parsed != TRAX_PARSED_RUN)
    return parsed;
  if (options->program && !options->arguments && count > 0)
    trax_fail(error, "'%s' follows %s, whose main has no parameters: it takes no arguments", arguments[0],
              options->program);
  else if (!options->program && !options->print_config)
    trax_fail(error, "no program is given");
  else if (take_manifest(options, error) == TRAX_OK && check_engine(options, error) == TRAX_OK &&
           check_explain(options, error) == TRAX_OK && check_files(options, error) == TRAX_OK)
    return TRAX_PARSED_RUN;
  return TRAX_PARSED_WRONG;
}

static void print_output(const char *path, bool *any, FILE *out) {
  if (path && strcmp(path, "-") != 0) {
    fprintf(out, "%s%s", *any ? ", " : "; wrote ", path);
    *any = true;
  }
}

void trax_options_print_outputs(const struct trax_options *options, FILE *out) {
  bool any = false;
  for (const trax_option *row = rows; row->name; row++)
    if (row->file == TRAX_OPTION_OUTPUT && row->offset != offsetof(struct trax_options, checkpoint.write))
      print_output(*(const char *const *)((const char *)options + row->offset), &any, out);
  for (size_t i = 0; i < options->assignment_count; ++i)
    if (options->assignments[i].kind == TRAX_ASSIGN_DUMP)
      print_output(options->assignments[i].value, &any, out);
}

void trax_options_free(struct trax_options *options) {
  for (size_t i = 0; i < options->assignment_count; ++i)
    free(options->assignments[i].name);
  free(options->assignments);
  trax_manifest_release(options->manifest);
  *options = (struct trax_options){0};
}
