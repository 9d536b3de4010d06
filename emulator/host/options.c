#include "host/options.h"

#include "host/option_values.h"
#include "machine/config_keys.h"

#include <stdlib.h>
#include <string.h>

#include "control/engines.h"
#include "program/program.h"
#include "trax/output.h"

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
    {"set", .argument = "KEY=VALUE", .parse = trax_parse_set, .words = trax_config_list_keys,
     .meaning = "change one value of the machine (--help-config)"},
    {"print-config", FIELD(print_config), .meaning = "print the machine as a file for --config, and end"},
    {"help-config", .kind = TRAX_OPTION_SHOW, .show = trax_config_describe, .meaning = "describe every key of the configuration, and end"},
    TRAX_OPTION_GROUP("Buffers"),
    {"bind", .argument = "SYMBOL=FILE", .parse = trax_parse_bind, .meaning = "fill the program's buffer SYMBOL with a file"},
    {"scene", .argument = "FILE", .parse = trax_parse_scene, .meaning = "the same as --bind scene=FILE"},
    {"alloc", .argument = "SYMBOL=BYTES", .parse = trax_parse_alloc,
     .meaning = "fill the program's buffer SYMBOL with zeros"},
    {"dump", .argument = "SYMBOL=FILE", .parse = trax_parse_dump,
     .meaning = "write the buffer SYMBOL to a file after the run; FILE.png:WxH: as a picture, 4 bytes a pixel"},
    {"signature", .argument = "FILE", OUTPUT(signature),
     .meaning = "write the words from begin_signature to end_signature, and the fault, after the run"},
    TRAX_OPTION_GROUP("Program"),
    {"dir", .argument = "FOLDER[::NAME]", .parse = trax_parse_dir,
     .meaning = "let the program read and write files in FOLDER, which it sees as NAME"},
    {"main-on", .argument = "THREADS", .parse = trax_parse_main_on, .choices = main_on_words,
     .meaning = "threads that call main: 0, the first alone, or all (default)"},
    TRAX_OPTION_GROUP("Run"),
    {"engine", .argument = "NAME", .parse = trax_parse_engine, .words = put_engines,
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
    {"explore-against", .argument = "FILE", ONCE(explain.against), .file = TRAX_OPTION_INPUT,
     .meaning = "let the page also show the differences to the run of FILE, from --stats or --explore"},
    {"source-folder", .argument = "FOLDER", .parse = trax_parse_source_folder,
     .meaning = "let the page contain the sources in FOLDER, too (repeatable)"},
    {"item-buffer", .argument = "SYMBOL", ONCE(explain.item_buffer),
     .meaning = "the buffer to which the items store their results, for their places"},
    {"series-interval", .argument = "N", NUMBER(explain.series_interval, 1, UINT64_MAX / 2),
     .meaning = "cycles of an interval; default 10000"},
    {"window", .argument = "BEGIN:END", .parse = trax_parse_window,
     .meaning = "cycles of the window, BEGIN <= cycle < END; default all"},
    {"window-tms", .argument = "LIST", PARSED(trax_parse_list, explain.window_tms),
     .meaning = "its TMs, as in 0,2-3; default all"},
    {"window-tps", .argument = "LIST", PARSED(trax_parse_list, explain.window_tps),
     .meaning = "its TPs in each of these TMs; default all"},
    {"check-memory", FIELD(explain.check_memory),
     .meaning = "report accesses out of bounds or after free, uses of memory never written, and leaks"},
    {"check-races", FIELD(explain.check_races),
     .meaning = "report accesses of two threads to the same word that nothing orders"},
    {"post-mortem", .argument = "FILE", OUTPUT(post_mortem),
     .meaning = "call chains of all threads at the end of the run, as text"},
    TRAX_OPTION_GROUP("Debugger"),
    {"gdb", .argument = "PORT", .parse = trax_parse_gdb,
     .meaning = "wait for GDB on a port of the loopback interface; 0 is any free one"},
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
    {"gdb-symbols", .instead = "gdb-multiarch reads the program itself"},
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
    .part = "compare",
    .part_of = "trax-eval",
    .column = 27};

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
    if (other == given &&
        trax_options_append(options, (struct trax_assignment){.kind = TRAX_ASSIGN_DUMP, .in_manifest = true}, symbol,
                            strlen(symbol), path, error) != TRAX_OK)
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

/* Reports the error: the program is no image, or its main does not take the argument. */
static void refuse_argument(const char *program, const char *argument, trax_error *error) {
  trax_image *image = NULL;
  if (!trax_manifest_is(program) && !(image = trax_image_open(program, error)))
    return;
  trax_fail(error, "'%s' follows %s, whose main has no parameters: it takes no arguments", argument, program);
  if (image)
    trax_image_close(image);
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
    refuse_argument(options->program, arguments[0], error);
  else if (!options->program && !options->print_config)
    trax_fail(error, "no program is given");
  else if (take_manifest(options, error) == TRAX_OK && trax_options_check_conflicts(options, error) == TRAX_OK &&
           check_files(options, error) == TRAX_OK)
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
