/* All statistics as one list, made from the tables of machine/stats.h: what trax_stats_get finds, the reports print,
   and docs/emulator.md lists. */
#ifndef TRAX_REPORT_STATISTICS_H
#define TRAX_REPORT_STATISTICS_H

#include "machine/machine.h"

/* Where a figure stands in the reports. */
enum trax_figure_group {
  TRAX_GROUP_RUN,      /* figures made from counts */
  TRAX_GROUP_COUNTER,  /* counted in every TM */
  TRAX_GROUP_MEMORY,   /* counted beyond the TMs */
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
};

/* Calls visit for every figure in the order of the reports. stats and config may be NULL (values are then 0), and tm
   chooses what is counted: NULL is the whole chip; for one TM those of TRAX_GROUP_MEMORY are left out,
   and of TRAX_GROUP_RUN all but the shares of what is the TM's own (utilisations, hit rates). */
void trax_figures_visit(const struct trax_stats *stats, const struct trax_tm_stats *tm,
                        const struct trax_config *config,
                        void (*visit)(void *context, const struct trax_figure *figure), void *context);

/* Names of causes, as in "causes.<cause>", and for the heads of narrow columns. */
extern const char *const trax_cause_names[TRAX_CAUSE_COUNT];
extern const char *const trax_cause_heads[TRAX_CAUSE_COUNT];

/* The rule of accounting, checked again on what is reported: the causes add up to threads x cycles. */
bool trax_stats_identity(const struct trax_stats *stats);

/* The JSON's members that are not figures, one row each. */
void trax_stats_describe_members(FILE *out);

/* How the run ended: "finished", "fault", "interrupted", "limit", "stuck", "error". */
const char *trax_ending_name(const struct trax_machine *machine);

/* Share of the cycles in which a channel's bus was taken. */
double trax_stats_channel_utilisation(const trax_machine *machine, uint32_t channel);

/* Which parts of a run of the fast engine took a slow way, and why. */
void trax_fast_path_print(const struct trax_machine *machine, FILE *out);

#endif
