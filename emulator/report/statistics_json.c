/* Statistics as JSON. */
#include <inttypes.h>
#include <jansson.h>
#include <math.h>
#include <string.h>

#include "program/program.h"
#include "report/statistics.h"
#include "trax/output.h"
#include "trax/version.h"

#define MEMBERS(X)                                                                                                     \
  X("trax_sim", "version of the emulator")                                                                             \
  X("program", "the executable, as it was named")                                                                      \
  X("status", "how the run ended: finished, fault, interrupted, limit (max-cycles reached), or stuck (the watchdog)")  \
  X("partial", "true if the program did not finish: the figures are those up to its last cycle")                       \
  X("exit_status", "of the program; 1 for a fault, 134 for an abort; null if it has not ended")                        \
  X("fault", "only after a fault: kind, address, pc, instruction, thread, tm, tp, cycle, symbol, file, line, message " \
             "of an abort")                                                                                            \
  X("sampled",                                                                                                         \
    "only of a sampled run: cycles_low and cycles_high, mrps_low and mrps_high, between which these lie with 95 % "    \
    "confidence; windows, detailed_cycles, detailed_instructions, detailed_slots: what was simulated; exact: the "     \
    "figures that are no estimates; slots, queues, predicted_cycles, fraction, error, unit, warm_up, seed")            \
  X("identity", "cause_sum, thread_cycles, and holds: whether they are equal, as they must be")                        \
  X("tms", "for each TM: tm, the figures that are counted in every TM, utilisations and hit rates of its own, and "    \
           "tps: for each TP "                                                                                         \
           "tp, thread, exit_status, causes")                                                                          \
  X("channels", "for each channel of the memory: channel, transfers, bytes, utilisation")                              \
  X("configuration", "every key of the machine's configuration")

void trax_stats_describe_members(FILE *out) {
#define MEMBER(NAME, MEANING) fprintf(out, "%-32s %s\n", NAME, MEANING);
  MEMBERS(MEMBER)
#undef MEMBER
}

/* `failed`: an allocation has failed, and the document is not written. */
struct document {
  json_t *root;
  bool failed;
};

static void put(struct document *document, json_t *object, const char *key, json_t *value) {
  if (json_object_set_new(object, key, value) != 0) /* fails also for a NULL value */
    document->failed = true;
}

/* Returns the member object of that name, which is created if it does not exist. */
static json_t *level(struct document *document, json_t *object, const char *key, size_t length) {
  char name[64];
  snprintf(name, sizeof name, "%.*s", (int)length, key);
  json_t *below = json_object_get(object, name);
  if (!below) {
    below = json_object();
    put(document, object, name, below);
  }
  return below;
}

static void put_figure(void *context, const struct trax_figure *figure) {
  struct document *document = context;
  json_t *object = document->root;
  const char *name = figure->name;
  for (const char *dot; (dot = strchr(name, '.')); name = dot + 1)
    object = level(document, object, name, (size_t)(dot - name));
  put(document, object, name, figure->whole ? json_integer((json_int_t)figure->count) : json_real(figure->value));
}

/* Paths need not be UTF-8: bytes above 127 are replaced by "?" if the text is not valid. */
static json_t *text_value(const char *text) {
  json_t *value = json_string(text);
  if (value)
    return value;
  char plain[1024];
  snprintf(plain, sizeof plain, "%.*s", (int)sizeof plain - 1, text);
  for (char *c = plain; *c; ++c)
    if ((unsigned char)*c >= 0x80)
      *c = '?';
  return json_string(plain);
}

static json_t *hexadecimal(uint32_t value) {
  char text[16];
  snprintf(text, sizeof text, "0x%08x", value);
  return json_string(text);
}

static void put_fault(struct document *document, const trax_machine *machine) {
  const struct trax_fault *fault = trax_machine_fault(machine);
  json_t *object = json_object();
  put(document, document->root, "fault", object);
  put(document, object, "kind", json_string(trax_fault_text(fault->kind)));
  char message[1024];
  if (fault->kind == TRAX_FAULT_ABORT && trax_space_string(&machine->space, fault->address, message, sizeof message))
    put(document, object, "message", text_value(message));
  put(document, object, "address", hexadecimal(fault->address));
  put(document, object, "pc", hexadecimal(fault->pc));
  char instruction[128];
  trax_disassemble(fault->word, fault->pc, instruction, sizeof instruction);
  put(document, object, "instruction", json_string(instruction));
  put(document, object, "thread", json_integer(fault->thread));
  put(document, object, "tm", json_integer(fault->tm));
  put(document, object, "tp", json_integer(fault->tp));
  put(document, object, "cycle", json_integer((json_int_t)fault->cycle));
  const struct trax_loaded *loaded = trax_loaded_of(machine);
  if (!loaded)
    return;
  const struct trax_symbol *symbol = trax_image_symbol_at(loaded->image, fault->pc);
  if (symbol)
    put(document, object, "symbol", text_value(symbol->name));
  struct trax_source_line line;
  if (trax_image_lines(loaded->image, fault->pc, &line, 1)) {
    put(document, object, "file", text_value(line.file));
    put(document, object, "line", json_integer(line.line));
  }
}

/* null: an interval that begins at 0 cycles has no greatest rate. */
static json_t *mrps_at(const trax_machine *machine, double cycles) {
  return cycles > 0 ? json_real((double)machine->stats.total.rays * machine->config.chip.clock_mhz / cycles)
                    : json_null();
}

static void put_sampling(struct document *document, const trax_machine *machine) {
  const struct trax_sampling_stats *sampling = &machine->stats.sampling;
  const trax_slot_sampling *asked = &sampling->asked;
  json_t *object = json_object();
  put(document, document->root, "sampled", object);
  put(document, object, "cycles_low", json_real(sampling->low));
  put(document, object, "cycles_high", json_real(sampling->high));
  put(document, object, "mrps_low", mrps_at(machine, sampling->high));
  put(document, object, "mrps_high", mrps_at(machine, sampling->low));
  put(document, object, "windows", json_integer((json_int_t)sampling->windows));
  put(document, object, "detailed_cycles", json_integer((json_int_t)sampling->detailed_cycles));
  put(document, object, "detailed_instructions", json_integer((json_int_t)sampling->detailed_instructions));
  put(document, object, "slots", json_integer(asked->slots));
  put(document, object, "queues", json_integer(asked->queues));
  put(document, object, "detailed_slots", json_integer((json_int_t)sampling->detailed_slots));
  put(document, object, "predicted_cycles", sampling->predicted > 0 ? json_real(sampling->predicted) : json_null());
  put(document, object, "fraction", asked->error > 0 ? json_null() : json_real(asked->fraction));
  put(document, object, "error", asked->error > 0 ? json_real(asked->error) : json_null());
  put(document, object, "unit", json_integer(asked->unit));
  put(document, object, "warm_up", json_integer(asked->warm_up));
  put(document, object, "seed", json_integer((json_int_t)asked->seed));
  json_t *exact = json_array();
  put(document, object, "exact", exact);
  if (asked->rays)
    json_array_append_new(exact, json_string("rays"));
  if (asked->items)
    json_array_append_new(exact, json_string("items"));
}

static void put_identity(struct document *document, const trax_machine *machine) {
  uint64_t sum = 0;
  for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; ++cause)
    sum += machine->stats.total.cycles[cause];
  json_t *object = json_object();
  put(document, document->root, "identity", object);
  put(document, object, "cause_sum", json_integer((json_int_t)sum));
  put(document, object, "thread_cycles", json_integer((json_int_t)(machine->stats.threads * machine->stats.cycles)));
  put(document, object, "holds", json_boolean(trax_stats_identity(&machine->stats)));
}

/* The TPs' causes are 0 after a functional run, which charges no cycles. */
static json_t *tps_of(struct document *document, const trax_machine *machine, uint32_t tm) {
  const uint32_t count = machine->config.chip.tps_per_tm;
  json_t *tps = json_array();
  for (uint32_t i = 0; i < count; ++i) {
    const uint32_t thread = tm * count + i;
    json_t *tp = json_object(), *causes = json_object();
    put(document, tp, "tp", json_integer(i));
    put(document, tp, "thread", json_integer(thread));
    put(document, tp, "exit_status", json_integer(machine->exit_statuses[thread]));
    put(document, tp, "causes", causes);
    for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; ++cause)
      put(document, causes, trax_cause_names[cause], json_integer((json_int_t)machine->tp_stats[thread].cycles[cause]));
    if (json_array_append_new(tps, tp) != 0)
      document->failed = true;
  }
  return tps;
}

static void put_tms(struct document *document, const trax_machine *machine) {
  json_t *tms = json_array();
  put(document, document->root, "tms", tms);
  for (uint32_t i = 0; i < machine->config.chip.tms; ++i) {
    struct document tm = {json_object(), false};
    put(&tm, tm.root, "tm", json_integer(i));
    trax_figures_visit(&machine->stats, &machine->tm_stats[i], &machine->config, put_figure, &tm);
    put(&tm, tm.root, "tps", tps_of(&tm, machine, i));
    if (json_array_append_new(tms, tm.root) != 0 || tm.failed)
      document->failed = true;
  }
}

static void put_channels(struct document *document, const trax_machine *machine) {
  json_t *channels = json_array();
  put(document, document->root, "channels", channels);
  for (uint32_t i = 0; i < machine->config.memory.channels; ++i) {
    const struct trax_channel_stats *stats = &machine->stats.memory.channel[i];
    struct document channel = {json_object(), false};
    put(&channel, channel.root, "channel", json_integer(i));
    put(&channel, channel.root, "transfers", json_integer((json_int_t)stats->transfers));
    put(&channel, channel.root, "bytes", json_integer((json_int_t)stats->bytes));
    put(&channel, channel.root, "utilisation", json_real(trax_stats_channel_utilisation(machine, i)));
    if (json_array_append_new(channels, channel.root) != 0 || channel.failed)
      document->failed = true;
  }
}

json_t *trax_config_json(const struct trax_config *config) {
  json_t *configuration = json_object();
  struct document all = {configuration, false}, *document = &all;
  for (size_t i = 0; i < trax_config_key_count; ++i) {
    const struct trax_config_key *key = &trax_config_keys[i];
    double value = trax_config_value(config, key);
    char word[TRAX_CONFIG_WORD];
    json_t *component = level(document, configuration, key->component, strlen(key->component));
    put(document, component, key->key,
        key->kind == TRAX_KIND_FLAG   ? json_boolean(value != 0)
        : key->kind == TRAX_KIND_REAL ? json_real(value)
        : trax_config_has_words(key)  ? json_string(trax_config_value_word(key, value, word))
                                      : json_integer((json_int_t)value));
  }
  if (!all.failed)
    return configuration;
  json_decref(configuration);
  return NULL;
}

trax_status trax_stats_put_json(const trax_machine *machine, bool host, FILE *out, trax_error *error) {
  if (!machine->has_run)
    return trax_fail(error, "no statistics: the machine has not run");
  struct document document = {json_object(), false};
  json_t *root = document.root;
  const struct trax_loaded *loaded = trax_loaded_of(machine);
  put(&document, root, "trax_sim", json_string(TRAX_VERSION));
  put(&document, root, "program", text_value(loaded ? trax_image_path(loaded->image) : ""));
  put(&document, root, "status", json_string(trax_ending_name(machine)));
  put(&document, root, "partial", json_boolean(machine->status != TRAX_OK));
  put(&document, root, "exit_status",
      machine->status == TRAX_OK || machine->status == TRAX_FAULT ? json_integer(trax_machine_exit_status(machine))
                                                                  : json_null());
  if (machine->status == TRAX_FAULT)
    put_fault(&document, machine);
  trax_figures_visit(&machine->stats, NULL, &machine->config, put_figure, &document);
  if (!host) {
    json_object_del(root, "host_seconds");
    json_object_del(root, "instructions_per_host_second");
  }
  if (machine->stats.sampling.is_sampled)
    put_sampling(&document, machine);
  put_identity(&document, machine);
  put_tms(&document, machine);
  put_channels(&document, machine);
  put(&document, root, "configuration", trax_config_json(&machine->config));
  bool written = !document.failed && json_dumpf(root, out, JSON_INDENT(2) | JSON_REAL_PRECISION(15)) == 0;
  json_decref(root);
  if (document.failed)
    return trax_fail(error, "out of memory for the statistics");
  if (!written || fputc('\n', out) == EOF)
    return trax_fail(error, "the statistics cannot be written");
  return TRAX_OK;
}

trax_status trax_stats_write_json(const trax_machine *machine, const char *path, trax_error *error) {
  trax_output output;
  if (trax_output_open(&output, path, error) != TRAX_OK)
    return TRAX_ERROR;
  /* trax_output_commit reports a failed write with its reason. */
  trax_error reason;
  if (trax_stats_put_json(machine, true, output.file, &reason) != TRAX_OK && !ferror(output.file)) {
    trax_output_discard(&output);
    return trax_fail(error, "%s: %s", path, reason.message);
  }
  return trax_output_commit(&output, error);
}
