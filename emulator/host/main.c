/* trax-sim: configure, load, run, report. */
#include <errno.h>
#include <inttypes.h>
#include <limits.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "gdb/gdb.h"
#include "host/options.h"
#include "host/page_picture.h"
#include "host/png.h"
#include "report/backtrace.h"
#include "report/watchdog.h"
#include "trax/compare.h"
#include "trax/message.h"
#include "trax/output.h"
#include "trax/reads.h"
#include "trax/run_progress.h"
#include "trax/signals.h"

enum { EXIT_ERROR = 1, EXIT_STUCK = 124, EXIT_SIGNAL = 128 };

static volatile sig_atomic_t reader_gone; /* the reader of standard output or of another pipe has closed it */

static void on_broken_pipe(int number) {
  trax_signal = number;
  reader_gone = 1;
}

/* The first signal ends the run, whose partial results are written; the second one ends the process. A broken pipe ends
   a run whose program writes to it, but the other files are still written. */
static void catch_signals(void) {
  trax_catch_signals();
  trax_catch_signal(SIGQUIT); /* ends the run and prints where every thread is */
  struct sigaction broken_pipe = {.sa_handler = on_broken_pipe};
  sigemptyset(&broken_pipe.sa_mask);
  sigaction(SIGPIPE, &broken_pipe, NULL);
}

static int complain(const trax_error *error) {
  fflush(stdout);
  const bool interrupted = trax_signal && !reader_gone;
  if (interrupted)
    fprintf(stderr, "trax-sim: %s\n", error->message);
  else
    trax_message("trax-sim", TRAX_MESSAGE_ERROR, "%s", error->message);
  return interrupted ? EXIT_SIGNAL + trax_signal : EXIT_ERROR;
}

static trax_status configure(trax_config *config, const struct trax_options *options, trax_error *error) {
  if (options->config && trax_config_load(config, options->config, error) != TRAX_OK)
    return TRAX_ERROR;
  if (options->manifest && !options->config && trax_manifest_configure(options->manifest, config, error) != TRAX_OK)
    return TRAX_ERROR;
  for (size_t i = 0; i < options->assignment_count; ++i) {
    const struct trax_assignment *set = &options->assignments[i];
    if (set->kind == TRAX_ASSIGN_SET && trax_config_set(config, set->name, set->value, error) != TRAX_OK)
      return TRAX_ERROR;
  }
  return trax_config_check(config, error);
}

/* The first argument is the program's name, wherever its file is. */
static trax_status set_arguments(trax_machine *machine, const struct trax_options *options, trax_error *error) {
  const char *slash = strrchr(options->program, '/');
  options->arguments[0] = (char *)(slash ? slash + 1 : options->program);
  return trax_machine_set_arguments(machine, (const char *const *)options->arguments, (size_t)options->argument_count,
                                    error);
}

static trax_status load(trax_machine *machine, const struct trax_options *options, trax_error *error) {
  trax_status status = options->manifest ? trax_manifest_load(options->manifest, machine, error)
                                         : trax_machine_load_elf(machine, options->program, error);
  for (size_t i = 0; i < options->assignment_count && status == TRAX_OK; ++i) {
    const struct trax_assignment *buffer = &options->assignments[i];
    if (buffer->kind == TRAX_ASSIGN_BIND)
      status = trax_machine_bind_file(machine, buffer->name, buffer->value, error);
    else if (buffer->kind == TRAX_ASSIGN_ALLOC)
      status = trax_machine_bind(machine, buffer->name, NULL, buffer->bytes, error);
  }
  for (size_t i = 0; i < options->assignment_count && status == TRAX_OK; ++i) {
    const struct trax_assignment *dump = &options->assignments[i];
    const uint8_t *bytes;
    uint32_t size;
    if (dump->kind != TRAX_ASSIGN_DUMP)
      continue;
    status = trax_machine_read_buffer(machine, dump->name, &bytes, &size, error);
    if (status == TRAX_OK && dump->width && size != (uint64_t)dump->width * dump->height * 4)
      status = trax_fail(error, "--dump %s: a picture of %ux%u has %llu bytes, and the buffer has %u", dump->name,
                         dump->width, dump->height, (unsigned long long)dump->width * dump->height * 4, size);
  }
  for (size_t i = 0; i < options->assignment_count && status == TRAX_OK; ++i)
    if (options->assignments[i].kind == TRAX_ASSIGN_DIR)
      status = trax_machine_allow(machine, options->assignments[i].name, options->assignments[i].value, error);
  if (status == TRAX_OK && options->arguments)
    status = set_arguments(machine, options, error);
  if (status == TRAX_OK && options->main_on_thread_0)
    status = trax_machine_main_on_thread_0(machine, error);
  if (status == TRAX_OK && options->signature)
    status = trax_machine_check_signature(machine, error);
  return status;
}

/* Waits for a debugger and runs the program under it. */
static trax_status debug(trax_machine *machine, trax_run_options *options, unsigned number, trax_error *error) {
  struct trax_gdb_port port;
  trax_status status = trax_gdb_listen(&port, number, error);
  if (status != TRAX_OK)
    return status;
  fprintf(stderr, "trax-sim: waiting for GDB: target remote localhost:%u\n", port.number);
  status = trax_gdb_accept(&port, options->interrupt, error);
  struct trax_gdb_link link = trax_gdb_port_link(&port);
  struct trax_gdb *gdb = status == TRAX_OK ? trax_gdb_create(machine, &link, options->interrupt, error) : NULL;
  if (gdb) {
    status = trax_machine_run(machine, options, error);
    if (trax_gdb_killed(gdb))
      trax_signal = SIGKILL; /* the debugger's command `kill` */
  } else if (status == TRAX_OK) {
    status = TRAX_ERROR;
  }
  trax_gdb_destroy(gdb);
  trax_gdb_port_close(&port);
  return status;
}

static trax_status run(trax_machine *machine, const struct trax_options *options, trax_error *error) {
  trax_progress_line line;
  trax_progress_line_begin(&line, "trax-sim", options->quiet);
  struct trax_run_progress progress = {.line = &line, .task = "running"};
  trax_run_options run_options = {.output = stdout,
                                  .input = stdin,
                                  .errors = stderr,
                                  .max_cycles = options->max_cycles,
                                  .total_items = options->total_items,
                                  .interrupt = &trax_signal,
                                  .engine = options->engine->name,
                                  .host_threads = options->host_threads,
                                  .ray_cycles = options->ray_cycles != NULL};
  if (line.terminal) {
    run_options.progress = trax_run_progress_show;
    run_options.progress_context = &progress;
    FILE *shared = isatty(STDOUT_FILENO) ? trax_progress_line_output(&line) : NULL;
    if (shared)
      run_options.output = shared;
  }
  struct trax_checkpoint *checkpoint = NULL;
  struct trax_watchdog *watchdog = NULL;
  trax_status status = trax_checkpoint_begin(&checkpoint, machine, &options->checkpoint, error);
  if (status == TRAX_OK && options->watchdog && !(watchdog = trax_watchdog_begin(machine, options->watchdog)))
    status = trax_fail(error, "out of memory");
  if (status == TRAX_OK)
    status = options->gdb ? debug(machine, &run_options, (unsigned)options->gdb_port, error)
                          : trax_machine_run(machine, &run_options, error);
  if (checkpoint && trax_checkpoint_end(checkpoint, status == TRAX_ERROR ? NULL : error) != TRAX_OK)
    status = TRAX_ERROR;
  if (run_options.output != stdout)
    fclose(run_options.output);
  trax_progress_line_clear(&line);
  if (watchdog)
    trax_watchdog_print(watchdog, stderr);
  trax_watchdog_end(watchdog);
  return status;
}

static trax_status write_report(const trax_machine *machine, const char *path, trax_error *error) {
  trax_output output;
  if (trax_output_open(&output, path, error) != TRAX_OK)
    return TRAX_ERROR;
  trax_stats_print(machine, output.file);
  return trax_output_commit(&output, error);
}

static trax_status write_post_mortem(const struct trax_post_mortem *post_mortem, const char *path, trax_error *error) {
  trax_output output;
  const char *text = post_mortem ? trax_post_mortem_text(post_mortem) : NULL;
  if (!text)
    return trax_fail(error, "%s: out of memory", path);
  if (trax_output_open(&output, path, error) != TRAX_OK)
    return TRAX_ERROR;
  fputs(text, output.file);
  return trax_output_commit(&output, error);
}

static trax_status write_dump(trax_machine *machine, const struct trax_options *options,
                              const struct trax_assignment *dump, trax_error *error) {
  const uint8_t *bytes;
  uint32_t size;
  if (trax_machine_read_buffer(machine, dump->name, &bytes, &size, error) != TRAX_OK)
    return TRAX_ERROR;
  if (dump->in_manifest)
    return trax_manifest_put_output(options->manifest, dump->name, bytes, size, error);
  if (dump->width)
    return trax_png_write(dump->value, bytes, dump->width, dump->height, error);
  return trax_write_file(dump->value, bytes, size, error);
}

/* Writes all outputs; after a failure the others are still written, and the first failure is reported. Buffers are only
   written if the program finished, and a signature also after a fault. */
static trax_status write_outputs(trax_machine *machine, const struct trax_options *options, trax_status run,
                                 trax_error *error) {
  const bool finished = run == TRAX_OK;
  trax_status result = TRAX_OK;
  trax_error reason;
  if (trax_output_flush(&reason) != TRAX_OK && !reader_gone)
    result = trax_fail(error, "%s", reason.message);
  if (options->stats && trax_stats_write_json(machine, options->stats, &reason) != TRAX_OK && result == TRAX_OK)
    result = trax_fail(error, "%s", reason.message);
  if (options->ray_cycles && finished && trax_ray_cycles_write(machine, options->ray_cycles, &reason) != TRAX_OK &&
      result == TRAX_OK)
    result = trax_fail(error, "%s", reason.message);
  if (options->report && write_report(machine, options->report, &reason) != TRAX_OK && result == TRAX_OK)
    result = trax_fail(error, "%s", reason.message);
  if (options->signature && (finished || run == TRAX_FAULT) &&
      trax_machine_write_signature(machine, options->signature, &reason) != TRAX_OK && result == TRAX_OK)
    result = trax_fail(error, "%s", reason.message);
  for (size_t i = 0; finished && i < options->assignment_count; ++i) {
    const struct trax_assignment *dump = &options->assignments[i];
    if (dump->kind == TRAX_ASSIGN_DUMP && write_dump(machine, options, dump, &reason) != TRAX_OK && result == TRAX_OK)
      result = trax_fail(error, "%s", reason.message);
  }
  return result;
}

static trax_status end_explanation(struct trax_page_picture *picture, trax_machine *machine,
                                   struct trax_explain *explain, trax_error *error) {
  trax_status status = explain ? trax_page_picture_give(picture, machine, explain, error) : TRAX_OK;
  if (status == TRAX_OK)
    status = trax_explain_end(explain, error);
  else
    trax_explain_discard(explain);
  trax_page_picture_release(picture);
  return status;
}

static void note(const char *text) {
  trax_message("trax-sim", TRAX_MESSAGE_NOTE, "%s", text);
}

/* Prints the run's cycles, its time and the files that it wrote, in a line on a terminal. */
static void print_summary(const trax_machine *machine, const struct trax_options *options) {
  const struct trax_stats *stats = &machine->stats;
  if (options->quiet || !isatty(STDERR_FILENO))
    return;
  if (options->engine->is_timed)
    fprintf(stderr, "trax-sim: %" PRIu64 " cycles, %.4g ms", stats->cycles,
            (double)stats->cycles / machine->config.chip.clock_mhz / 1e3);
  else
    fprintf(stderr, "trax-sim: %" PRIu64 " instructions", stats->instructions);
  trax_options_print_outputs(options, stderr);
  fputc('\n', stderr);
}

static int simulate(const trax_config *config, const struct trax_options *options) {
  trax_error error, write_error;
  catch_signals();
  if (trax_options_check_outputs(options, &error) != TRAX_OK)
    return complain(&error);
  trax_machine *machine = trax_machine_create(config, &error);
  if (!machine)
    return complain(&error);
  struct trax_explain *explain = NULL;
  trax_status status = load(machine, options, &error);
  struct trax_explain_options wanted = options->explain;
  wanted.note = options->quiet ? NULL : note;
  struct trax_page_picture picture = {0};
  if (status == TRAX_OK)
    status = trax_page_picture_find(&picture, &wanted, options, machine, &error);
  if (status == TRAX_OK)
    status = trax_explain_begin(&explain, machine, &wanted, &error);
  if (status != TRAX_OK) {
    trax_machine_destroy(machine);
    return complain(&error);
  }
  /* If this is NULL, write_post_mortem reports it. */
  struct trax_post_mortem *post_mortem =
      trax_post_mortem_create(machine, &trax_signal, options->post_mortem != NULL, &error);
  status = run(machine, options, &error);
  int result = trax_machine_exit_status(machine) & 0xFF;
  switch (status) {
  case TRAX_OK:
    break;
  case TRAX_FAULT:
    fflush(stdout);
    fprintf(stderr, "trax-sim: ");
    trax_machine_print_fault(machine, stderr);
    break;
  case TRAX_INTERRUPTED:
  case TRAX_STUCK:
    fflush(stdout);
    fprintf(stderr, "trax-sim: %s%s\n", error.message, machine->has_run ? "; the statistics are partial" : "");
    if (trax_signal == SIGQUIT && post_mortem && trax_post_mortem_text(post_mortem))
      fputs(trax_post_mortem_text(post_mortem), stderr);
    result = status == TRAX_STUCK ? EXIT_STUCK : EXIT_SIGNAL + trax_signal;
    break;
  case TRAX_ERROR:
    result = complain(&error);
    break;
  }
  bool written = true;
  if (status == TRAX_ERROR || !machine->has_run)
    trax_explain_discard(explain);
  else
    written = end_explanation(&picture, machine, explain, &write_error) == TRAX_OK;
  if (!written)
    result = complain(&write_error);
  if (status != TRAX_ERROR && machine->has_run && options->post_mortem &&
      write_post_mortem(post_mortem, options->post_mortem, &write_error) != TRAX_OK) {
    written = false;
    result = complain(&write_error);
  }
  if (status != TRAX_ERROR && machine->has_run && write_outputs(machine, options, status, &write_error) != TRAX_OK)
    result = complain(&write_error);
  else if (status == TRAX_OK && written)
    print_summary(machine, options);
  trax_post_mortem_destroy(post_mortem);
  trax_machine_destroy(machine);
  return result == EXIT_SUCCESS && reader_gone ? EXIT_SIGNAL + SIGPIPE : result;
}

static int flush_standard_output(int result) {
  trax_error error;
  if (trax_output_flush(&error) == TRAX_OK)
    return result;
  return reader_gone ? EXIT_SIGNAL + SIGPIPE : complain(&error);
}

int main(int count, char **arguments) {
  trax_error error;
  struct trax_options options;
  if (count > 1 && strcmp(arguments[1], "compare") == 0) {
    trax_become_eval(arguments, &error);
    trax_message("trax-sim", TRAX_MESSAGE_ERROR, "compare: %s", error.message);
    return EXIT_ERROR;
  }
  trax_reads_begin();
  const trax_parsed parsed = trax_options_parse(&options, count, arguments, &error);
  if (parsed == TRAX_PARSED_WRONG) {
    trax_message("trax-sim", TRAX_MESSAGE_ERROR, "%s (--help lists the options)", error.message);
    trax_options_free(&options);
    return EXIT_ERROR;
  }
  int result = EXIT_ERROR;
  trax_config *config = trax_config_create();
  if (parsed == TRAX_PARSED_DONE) {
    result = flush_standard_output(EXIT_SUCCESS);
  } else if (!config) {
    trax_message("trax-sim", TRAX_MESSAGE_ERROR, "out of memory");
  } else if (configure(config, &options, &error) != TRAX_OK) {
    complain(&error);
  } else if (options.print_config) {
    trax_config_print(config, stdout);
    result = flush_standard_output(EXIT_SUCCESS);
  } else if (trax_options_choose_engine(&options, config, &error) != TRAX_OK) {
    complain(&error);
  } else {
    result = simulate(config, &options);
  }
  trax_config_destroy(config);
  trax_options_free(&options);
  if (trax_signal && trax_signal != SIGKILL && trax_signal != SIGPIPE && result == EXIT_SIGNAL + trax_signal)
    trax_end_by_signal();
  return result;
}
