#include "report/statistics.h"

#include <ctype.h>
#include <inttypes.h>
#include <math.h>
#include <string.h>

#include "engine/run.h"
#include "machine/timing.h"
#include "program/program.h"
#include "report/energy.h"

const char *const trax_cause_names[TRAX_CAUSE_COUNT] = {
#define NAME(ID, NAME, ...) NAME,
    TRAX_CAUSES(NAME)
#undef NAME
};

const char *const trax_cause_meanings[TRAX_CAUSE_COUNT] = {
#define MEANING(ID, NAME, HEAD, MEANING) MEANING,
    TRAX_CAUSES(MEANING)
#undef MEANING
};

/* Whether values of the unit are counts, which are whole numbers. */
static bool is_count(const char *unit) {
  return !strchr(unit, '/') && strcmp(unit, "s") != 0 && strcmp(unit, "J") != 0 && strcmp(unit, "W") != 0 &&
         strcmp(unit, "fraction") != 0 && strcmp(unit, "per cent") != 0 && strncmp(unit, "mm2", 3) != 0;
}

struct visitor {
  void (*visit)(void *context, const struct trax_figure *figure);
  void *context;
};

static void emit(const struct visitor *visitor, enum trax_figure_group group, const char *prefix, const char *name,
                 const char *unit, const char *meaning, long double value) {
  /* 0/0 and x/0 are reported as 0. They are judged as doubles: a host may lack the range of long double (valgrind). */
  const double rounded = (double)value;
  struct trax_figure figure = {.unit = unit,
                               .meaning = meaning,
                               .group = group,
                               .whole = is_count(unit),
                               .value = isfinite(rounded) ? rounded : 0};
  if (figure.whole && isfinite(rounded) && value > 0)
    figure.count = (uint64_t)value;
  snprintf(figure.name, sizeof figure.name, "%s%s", prefix, name);
  visitor->visit(visitor->context, &figure);
}

/* Makes the last part of a name: "fcvt.w.s" becomes fcvt_w_s, and "FP_ADD" fp_add. */
static const char *as_key(const char *name, char *key, size_t size) {
  size_t i = 0;
  for (; name[i] && i + 1 < size; ++i)
    key[i] = name[i] == '.' ? '_' : (char)tolower((unsigned char)name[i]);
  key[i] = 0;
  return key;
}

static void visit_run(const struct visitor *visitor, const struct trax_stats *S, const struct trax_config *C) {
#define FIGURE(ID, NAME, UNIT, MEANING, EXPRESSION)                                                                    \
  emit(visitor, TRAX_GROUP_RUN, "", NAME, UNIT, MEANING, (long double)(EXPRESSION));
  TRAX_FIGURES(FIGURE)
#undef FIGURE
}

/* The shares that concern one TM, computed as if the chip had only this TM. */
static void visit_tm_shares(const struct visitor *visitor, const struct trax_stats *stats,
                            const struct trax_tm_stats *tm, const struct trax_config *config) {
  struct trax_stats only = {.cycles = stats->cycles,
                            .threads = config->chip.tps_per_tm,
                            .instructions = tm->cycles[TRAX_CAUSE_ISSUED],
                            .total = *tm};
  struct trax_config single = *config;
  single.chip.tms = 1;
  const struct trax_stats *S = &only;
  const struct trax_config *C = &single;
#define FIGURE(ID, NAME, UNIT, MEANING, EXPRESSION)                                                                    \
  if (strcmp(UNIT, "fraction") == 0 && strncmp(NAME, "memory.", 7) != 0 && strncmp(NAME, "l2.", 3) != 0)               \
    emit(visitor, TRAX_GROUP_RUN, "", NAME, UNIT, MEANING, (long double)(EXPRESSION));
  TRAX_FIGURES(FIGURE)
#undef FIGURE
}

static void visit_instructions(const struct visitor *visitor, const struct trax_tm_stats *tm) {
  static const char *const unit_meaning[TRAX_UNIT_COUNT] = {
#define TRAX_UNIT(NAME, DESCRIPTION, LATENCY) [TRAX_UNIT_##NAME] = DESCRIPTION,
#include "trax/units.inc"
#undef TRAX_UNIT
  };
  uint64_t by_unit[TRAX_UNIT_COUNT] = {0};
  for (unsigned op = 1; op < TRAX_OP_COUNT; ++op) /* 0 is the illegal instruction, which is never issued */
    by_unit[trax_op_table[op].unit] += tm->instructions[op];
  char key[48];
  for (unsigned unit = 0; unit < TRAX_UNIT_COUNT; ++unit)
    emit(visitor, TRAX_GROUP_UNIT, "instructions_by_unit.", as_key(trax_unit_names[unit], key, sizeof key),
         "instructions", unit_meaning[unit], (long double)by_unit[unit]);
  for (unsigned op = 1; op < TRAX_OP_COUNT; ++op)
    emit(visitor, TRAX_GROUP_OPERATION, "instructions_by_operation.",
         as_key(trax_op_table[op].mnemonic, key, sizeof key), "instructions", trax_op_table[op].mnemonic,
         (long double)tm->instructions[op]);
}

static void visit_memory(const struct visitor *visitor, const struct trax_memory_stats *memory, bool dram) {
#define COUNTER(ID, NAME, UNIT, MEANING)                                                                               \
  emit(visitor, TRAX_GROUP_MEMORY, "", NAME, UNIT, MEANING, (long double)memory->ID);
  TRAX_MEMORY_COUNTERS(COUNTER)
#undef COUNTER
#define COUNTER(ID, NAME, UNIT, MEANING)                                                                               \
  emit(visitor, TRAX_GROUP_MEMORY, "", NAME, UNIT, MEANING, (long double)memory->dram.ID);
  if (dram) {
    TRAX_DRAM_COUNTERS(COUNTER)
  }
#undef COUNTER
}

void trax_figures_visit(const struct trax_stats *stats, const struct trax_tm_stats *tm,
                        const struct trax_config *config,
                        void (*visit)(void *context, const struct trax_figure *figure), void *context) {
  static const struct trax_stats no_stats = {0};
  static const struct trax_config no_config = TRAX_CONFIG_DEFAULT;
  const struct visitor visitor = {visit, context};
  if (!tm) {
    visit_run(&visitor, stats ? stats : &no_stats, config ? config : &no_config);
    visit_memory(&visitor, stats ? &stats->memory : &no_stats.memory,
                 !config || config->memory.model == TRAX_MEMORY_DRAM);
    tm = stats ? &stats->total : &no_stats.total;
  } else {
    visit_tm_shares(&visitor, stats ? stats : &no_stats, tm, config ? config : &no_config);
  }
#define COUNTER(ID, NAME, UNIT, MEANING)                                                                               \
  emit(&visitor, TRAX_GROUP_COUNTER, "", NAME, UNIT, MEANING, (long double)tm->ID);
  TRAX_TM_COUNTERS(COUNTER)
#undef COUNTER
  double sum = 0;
  for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; ++cause)
    sum += (double)tm->cycles[cause];
  for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; ++cause)
    emit(&visitor, TRAX_GROUP_CAUSE, "causes.", trax_cause_names[cause], "thread-cycles", trax_cause_meanings[cause],
         (long double)tm->cycles[cause]);
  for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; ++cause)
    emit(&visitor, TRAX_GROUP_SHARE, "cause_percent.", trax_cause_names[cause], "per cent", trax_cause_meanings[cause],
         100 * (double)tm->cycles[cause] / sum);
  visit_instructions(&visitor, tm);
}

bool trax_stats_identity(const struct trax_stats *stats) {
  uint64_t sum = 0;
  for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; ++cause)
    sum += stats->total.cycles[cause];
  return sum == stats->threads * stats->cycles;
}

const char *trax_ending_name(const struct trax_machine *machine) {
  switch (machine->status) {
  case TRAX_OK:
    return "finished";
  case TRAX_FAULT:
    return "fault";
  case TRAX_INTERRUPTED:
    return "interrupted";
  case TRAX_STUCK:
    return machine->at_limit ? "limit" : "stuck";
  case TRAX_ERROR:
    break;
  }
  return "error";
}

const char *trax_stats_cause(unsigned number) {
  return number < TRAX_CAUSE_COUNT ? trax_cause_names[number] : NULL;
}

/* --- by name --- */

struct search {
  const char *name;
  double *value;
  bool found;
};

static void match(void *context, const struct trax_figure *figure) {
  struct search *search = context;
  if (strcmp(figure->name, search->name) == 0) {
    *search->value = figure->value;
    search->found = true;
  }
}

static bool match_sampled(const struct trax_sampling_stats *sampling, const char *name, double *value) {
  const struct {
    const char *name;
    double value;
  } figures[] = {{"cycles_low", sampling->low},
                 {"cycles_high", sampling->high},
                 {"windows", (double)sampling->windows},
                 {"slots", sampling->asked.slots},
                 {"detailed_slots", (double)sampling->detailed_slots},
                 {"predicted_cycles", sampling->predicted}};
  static const char level[] = "sampled.";
  if (!sampling->is_sampled || strncmp(name, level, sizeof level - 1) != 0)
    return false;
  for (size_t i = 0; i < sizeof figures / sizeof *figures; i++)
    if (strcmp(name + sizeof level - 1, figures[i].name) == 0) {
      *value = figures[i].value;
      return true;
    }
  return false;
}

bool trax_stats_get(const trax_machine *machine, const char *name, double *value) {
  if (match_sampled(&machine->stats.sampling, name, value))
    return true;
  struct search search = {name, value, false};
  struct trax_stats stats = machine->stats;
  if (machine->run) { /* between cycles: the counts so far */
    trax_run_settle(machine->run, stats.cycles);
    trax_stats_sum(machine, &stats);
  }
  trax_figures_visit(&stats, NULL, &machine->config, match, &search);
  return search.found;
}

/* --- text --- */

const char *const trax_cause_heads[TRAX_CAUSE_COUNT] = {
#define HEAD(ID, NAME, HEAD, MEANING) HEAD,
    TRAX_CAUSES(HEAD)
#undef HEAD
};

struct listing {
  FILE *out;
  enum trax_figure_group group; /* only figures of this group */
  bool hide_zero;
  const struct trax_stats *stats;
};

static void print_value(FILE *out, const struct trax_figure *figure) {
  if (figure->whole)
    fprintf(out, "%20" PRIu64, figure->count);
  else
    fprintf(out, "%20.6g", figure->value);
}

static void print_figure(void *context, const struct trax_figure *figure) {
  const struct listing *listing = context;
  if (figure->group != listing->group || (listing->hide_zero && figure->value == 0))
    return;
  const char *name = strrchr(figure->name, '.');
  if (figure->group == TRAX_GROUP_RUN || figure->group == TRAX_GROUP_COUNTER || figure->group == TRAX_GROUP_MEMORY ||
      !name)
    name = figure->name;
  else
    ++name;
  fprintf(listing->out, "  %-30s", name);
  print_value(listing->out, figure);
  if (figure->group == TRAX_GROUP_CAUSE)
    fprintf(listing->out, " %6.2f %%  %s\n",
            100 * figure->value / fmax(1, (double)listing->stats->threads * (double)listing->stats->cycles),
            figure->meaning);
  else if (figure->group == TRAX_GROUP_OPERATION || figure->group == TRAX_GROUP_UNIT)
    fprintf(listing->out, " %6.2f %%%s%s\n", 100 * figure->value / fmax(1, (double)listing->stats->instructions),
            figure->group == TRAX_GROUP_UNIT ? "  " : "", figure->group == TRAX_GROUP_UNIT ? figure->meaning : "");
  else
    fprintf(listing->out, "  %s%s%s\n", figure->unit, *figure->unit ? ": " : "", figure->meaning);
}

static void print_group(const trax_machine *machine, FILE *out, const char *title, enum trax_figure_group group,
                        bool hide_zero) {
  struct listing listing = {out, group, hide_zero, &machine->stats};
  fprintf(out, "\n%s\n", title);
  trax_figures_visit(&machine->stats, NULL, &machine->config, print_figure, &listing);
}

/* The columns of the table of TMs that are shares, in per cent. */
static const char *const tm_shares[] = {"issue.utilisation",   "fp_add.utilisation", "fp_mul.utilisation",
                                        "special.utilisation", "icache.hit_rate",    "dcache.hit_rate"};
enum { TM_SHARES = sizeof tm_shares / sizeof *tm_shares };

static void collect_share(void *context, const struct trax_figure *figure) {
  double *shares = context;
  for (unsigned i = 0; i < TM_SHARES; ++i)
    if (strcmp(figure->name, tm_shares[i]) == 0)
      shares[i] = figure->value;
}

static void print_tms(const trax_machine *machine, FILE *out) {
  fprintf(out, "\nTMs\n  %4s %16s %9s %9s %9s %9s %9s %9s %16s %12s\n", "TM", "instructions", "issued %", "adders %",
          "mults %", "div %", "i-hit %", "d-hit %", "memory bytes", "rays");
  for (uint32_t i = 0; i < machine->config.chip.tms; ++i) {
    const struct trax_tm_stats *tm = &machine->tm_stats[i];
    double shares[TM_SHARES] = {0};
    trax_figures_visit(&machine->stats, tm, &machine->config, collect_share, shares);
    fprintf(out, "  %4u %16" PRIu64, i, tm->cycles[TRAX_CAUSE_ISSUED]);
    for (unsigned share = 0; share < TM_SHARES; ++share)
      fprintf(out, " %9.2f", 100 * shares[share]);
    fprintf(out, " %16" PRIu64 " %12" PRIu64 "\n",
            tm->data_read_bytes + tm->instruction_read_bytes + tm->nontemporal_read_bytes + tm->written_bytes +
                tm->atomic_bytes,
            tm->rays);
  }
}

static void print_cause_heads(FILE *out, const struct trax_stats *stats) {
  for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; ++cause)
    if (stats->total.cycles[cause])
      fprintf(out, " %6s", trax_cause_heads[cause]);
  fprintf(out, "\n");
}

static void print_causes(FILE *out, const struct trax_stats *stats, const uint64_t *cycles, double thread_cycles) {
  for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; ++cause)
    if (stats->total.cycles[cause])
      fprintf(out, " %6.2f", 100 * (double)cycles[cause] / fmax(1, thread_cycles));
  fprintf(out, "\n");
}

static void print_shares(const trax_machine *machine, FILE *out) {
  const struct trax_stats *stats = &machine->stats;
  const uint32_t tms = machine->config.chip.tms, tps = machine->config.chip.tps_per_tm;
  if (!stats->cycles)
    return;
  fprintf(out, "\nThread-cycles of each TM by cause, per cent (-c: a conflict at the shared unit)\n    TM");
  print_cause_heads(out, stats);
  for (uint32_t tm = 0; tm < tms; ++tm) {
    fprintf(out, "  %4u", tm);
    print_causes(out, stats, machine->tm_stats[tm].cycles, (double)tps * (double)stats->cycles);
  }
  fprintf(out, "\nCycles of each TP by cause, per cent\n  TM.TP");
  print_cause_heads(out, stats);
  for (uint32_t thread = 0; thread < stats->threads; ++thread) {
    fprintf(out, "  %2u.%-2u", thread / tps, thread % tps);
    print_causes(out, stats, machine->tp_stats[thread].cycles, (double)stats->cycles);
  }
}

double trax_stats_channel_utilisation(const trax_machine *machine, uint32_t channel) {
  const struct trax_config *config = &machine->config;
  const double share = 1e9 * trax_memory_gbps(config) / config->memory.channels; /* bytes/s */
  const double seconds = TRAX_SECONDS(&machine->stats, config);
  return seconds > 0 ? (double)machine->stats.memory.channel[channel].bytes / seconds / share : 0;
}

static void print_channels(const trax_machine *machine, FILE *out) {
  fprintf(out, "\nChannels\n  %7s %16s %16s %12s\n", "channel", "transfers", "bytes", "utilisation");
  for (uint32_t i = 0; i < machine->config.memory.channels; ++i)
    fprintf(out, "  %7u %16" PRIu64 " %16" PRIu64 " %12.6g\n", i, machine->stats.memory.channel[i].transfers,
            machine->stats.memory.channel[i].bytes, trax_stats_channel_utilisation(machine, i));
}

static void print_sampling(const struct trax_sampling_stats *sampling, FILE *out) {
  if (!sampling->is_sampled)
    return;
  fprintf(out, "sampled  %" PRIu64 " windows, %" PRIu64 " cycles simulated; ", sampling->windows,
          sampling->detailed_cycles);
  fprintf(out, "the run takes %.0f to %.0f cycles with 95 %% confidence\n", sampling->low, sampling->high);
  fprintf(out, "         all figures are estimates but those of rays and items\n");
}

static void print_ending(const trax_machine *machine, FILE *out) {
  if (machine->status == TRAX_OK)
    fprintf(out, "run      finished, exit status %d\n", trax_machine_exit_status(machine));
  else if (machine->status == TRAX_STUCK)
    fprintf(out, "run      stopped %s, before the program ended (partial)\n",
            machine->at_limit ? "at its limit (--max-cycles)" : "by the watchdog");
  else
    fprintf(out, "run      %s (partial)\n", trax_ending_name(machine));
}

void trax_stats_print(const trax_machine *machine, FILE *out) {
  const struct trax_loaded *loaded = trax_loaded_of(machine);
  fprintf(out, "program  %s\n", loaded ? trax_image_path(loaded->image) : "(none)");
  fprintf(out, "chip     %ux%u at %u MHz, %.12g GB/s\n", machine->config.chip.tms, machine->config.chip.tps_per_tm,
          machine->config.chip.clock_mhz, trax_memory_gbps(&machine->config));
  print_ending(machine, out);
  print_sampling(&machine->stats.sampling, out);
  trax_hints_print(&machine->stats, &machine->config, out);
  print_group(machine, out, "Run", TRAX_GROUP_RUN, false);
  print_group(machine, out, "Thread-cycles by cause", TRAX_GROUP_CAUSE, false);
  fprintf(out, "  %-30s%20.0f %6.2f %%  %s\n", "sum", (double)machine->stats.threads * (double)machine->stats.cycles,
          100.0, trax_stats_identity(&machine->stats) ? "threads x cycles, as it must be" : "NOT threads x cycles");
  print_group(machine, out, "Counts", TRAX_GROUP_COUNTER, false);
  print_group(machine, out, "Instructions by unit", TRAX_GROUP_UNIT, false);
  print_group(machine, out, "Instructions by operation (those that occur)", TRAX_GROUP_OPERATION, true);
  print_tms(machine, out);
  print_shares(machine, out);
  print_group(machine, out, "Beyond the TMs", TRAX_GROUP_MEMORY, !machine->config.l2.bytes);
  print_channels(machine, out);
  trax_slow_paths_print(machine, out);
  fprintf(out, "\nConfiguration\n");
  trax_config_print(&machine->config, out);
}

static void describe_row(FILE *out, const char *name, const char *unit, const char *meaning) {
  fprintf(out, "%-32s %-22s %s\n", name, unit, meaning);
}

struct description {
  FILE *out;
  size_t column; /* of the list of operations; 0 before it */
};

/* A group with the same members as another one takes one row. */
static void describe(void *context, const struct trax_figure *figure) {
  struct description *description = context;
  FILE *out = description->out;
  const char *last = strrchr(figure->name, '.');
  if (figure->group == TRAX_GROUP_SHARE) {
    if (strcmp(figure->name, "cause_percent.issued") == 0)
      describe_row(out, "cause_percent.<cause>", figure->unit, "the same, as a share of all thread-cycles");
  } else if (figure->group != TRAX_GROUP_OPERATION) {
    describe_row(out, figure->name, figure->unit, figure->meaning);
  } else {
    if (!description->column)
      describe_row(out, "instructions_by_operation.<op>", figure->unit, "instructions issued; <op> is one of:");
    if (description->column + strlen(last) > 100 || !description->column) {
      fprintf(out, "%s   ", description->column ? "\n" : "");
      description->column = 3;
    }
    description->column += (size_t)fprintf(out, " %s", last + 1);
  }
}

void trax_stats_describe(FILE *out) {
  struct description description = {out, 0};
  fprintf(out, "Members of the JSON file: name, unit, meaning. A dot in a name is a level.\n\n");
  trax_stats_describe_members(out);
  fprintf(out, "\nFigures; the public interface finds them by the same names.\n\n");
  trax_figures_visit(NULL, NULL, NULL, describe, &description);
  fprintf(out, "\n");
}
