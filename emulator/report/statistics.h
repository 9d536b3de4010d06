/* All statistics as one list of figures, made from the tables of machine/stats.h. trax_stats_get, the reports and
   docs/trax-sim.md use this list. */
#ifndef TRAX_REPORT_STATISTICS_H
#define TRAX_REPORT_STATISTICS_H

#include <stdint.h>

#include "machine/machine.h"

/* The part of the reports that a figure belongs to. */
enum trax_figure_group {
  TRAX_GROUP_RUN,      /* figures computed from counters */
  TRAX_GROUP_COUNTER,  /* counters of each TM */
  TRAX_GROUP_MEMORY,   /* counters of second-level cache and memory controller */
  TRAX_GROUP_CAUSE,    /* thread-cycles by cause: "causes.<cause>" */
  TRAX_GROUP_SHARE,    /* the same in per cent: "cause_percent.<cause>" */
  TRAX_GROUP_UNIT,     /* instructions by unit: "instructions_by_unit.<unit>" */
  TRAX_GROUP_OPERATION /* instructions by operation: "instructions_by_operation.<mnemonic>" */
};

struct trax_figure {
  char name[80]; /* dots separate the levels of the JSON */
  const char *unit, *meaning;
  enum trax_figure_group group;
  bool whole; /* an integer */
  double value;
  uint64_t count; /* if it is whole: the value, also above 2^53 */
};

/* Calls visit for every figure in the order of the reports. If stats and config are NULL, the values are 0. tm NULL:
   the figures of the whole chip; else those of one TM, without TRAX_GROUP_MEMORY, and of TRAX_GROUP_RUN only the TM's
   own utilisations and hit rates. */
void trax_figures_visit(const struct trax_stats *stats, const struct trax_tm_stats *tm,
                        const struct trax_config *config,
                        void (*visit)(void *context, const struct trax_figure *figure), void *context);

/* Names of causes, as in "causes.<cause>", their meanings, and heads of narrow columns. */
extern const char *const trax_cause_names[TRAX_CAUSE_COUNT];
extern const char *const trax_cause_meanings[TRAX_CAUSE_COUNT];
extern const char *const trax_cause_heads[TRAX_CAUSE_COUNT];

/* Checks the rule of accounting on the reported figures: the causes add up to threads x cycles. */
bool trax_stats_identity(const struct trax_stats *stats);

/* Prints the members of the JSON that are not figures, one row each. */
void trax_stats_describe_members(FILE *out);

/* Prints what the figures say for sure about what limits the run; nothing if they say nothing. */
void trax_hints_print(const struct trax_stats *S, const struct trax_config *C, FILE *out);

/* How the run ended: "finished", "fault", "interrupted", "limit", "stuck", "error". */
const char *trax_ending_name(const struct trax_machine *machine);

/* Makes a JSON object (jansson) of the configuration, an object for each section. NULL: out of memory. */
struct json_t *trax_config_json(const struct trax_config *config);

/* The share of the cycles in which a channel's bus was busy. */
double trax_stats_channel_utilisation(const trax_machine *machine, uint32_t channel);

/* Prints the slow paths of a run, if its engine reports them. */
void trax_slow_paths_print(const struct trax_machine *machine, FILE *out);

#endif
