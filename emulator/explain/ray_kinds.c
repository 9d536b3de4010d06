/* The cost of the rays of each kind: the thread-cycles, instructions and requests of the threads while they work for a
   ray of that kind (explain/ray_kinds.h). The rows add up to the run's statistics. The row `none` has the work for no
   ray, the row `rest` what belongs to no instruction: lines of the instruction cache, and transfers of stores, which
   are combined. */
#include "explain/ray_kinds.h"
#include "explain/page.h"
#include "explain/places.h"
#include "report/energy.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

enum { KINDS = TRAX_RAY_KIND_COUNT + 1 };

struct ray_kinds {
  struct trax_reader reader;
  struct trax_tm_stats kinds[KINDS];
  struct ray_thread {
    uint64_t cycles[TRAX_CAUSE_COUNT];        /* that are charged to kinds */
    uint8_t working;                          /* the kind of ray that the thread works for */
  } *threads;                                 /* [threads] */
  uint64_t outcomes[KINDS][2][TRAX_OUTCOMES]; /* of accesses through the data cache: of loads, of stores */
};

/* --- the counters, as the engines count them --- */

static uint64_t transfer_bytes(const struct trax_config *config, uint32_t address, uint32_t bytes) {
  if (config->memory.model == TRAX_MEMORY_DRAM)
    return trax_dram_bytes(config, address, bytes);
  return bytes < config->memory.min_transfer_bytes ? config->memory.min_transfer_bytes : bytes;
}

static uint64_t with(const uint64_t *outcomes, unsigned outcome) {
  uint64_t sum = 0;
  for (unsigned i = 0; i < TRAX_OUTCOMES; i++)
    sum += i & outcome ? outcomes[i] : 0;
  return sum;
}

static uint64_t sum_of(const uint64_t *outcomes) {
  uint64_t sum = 0;
  for (unsigned i = 0; i < TRAX_OUTCOMES; i++)
    sum += outcomes[i];
  return sum;
}

/* Accesses to global memory are taken off those to local memory, to which count_instructions adds all. */
static void count_outcomes(struct trax_tm_stats *to, const struct trax_config *config, const uint64_t *loads,
                           const uint64_t *stores) {
  const uint64_t misses = with(loads, TRAX_OUTCOME_MISS);
  to->local_loads -= sum_of(loads);
  to->dcache_hits += with(loads, TRAX_OUTCOME_HIT);
  to->dcache_merged += with(loads, TRAX_OUTCOME_MERGED);
  to->dcache_misses += misses;
  to->data_read_bytes +=
      misses * (config->memory.model == TRAX_MEMORY_DRAM ? trax_dram_bytes(config, 0, config->dcache.line_bytes)
                                                         : config->dcache.line_bytes);
  to->local_stores -= sum_of(stores);
  to->combined_stores += with(stores, TRAX_OUTCOME_COMBINED);
  to->store_hits += with(stores, TRAX_OUTCOME_HIT);
  to->store_misses += sum_of(stores) - with(stores, TRAX_OUTCOME_HIT);
}

static void count_past_cache(struct trax_tm_stats *to, const struct trax_config *config,
                             const struct trax_accessed *accessed, unsigned flags) {
  --*(flags & TRAX_IS_STORE ? &to->local_stores : &to->local_loads);
  if (flags & TRAX_IS_ATOMIC) {
    to->atomic_bytes += config->memory.model == TRAX_MEMORY_DRAM
                            ? 0
                            : transfer_bytes(config, accessed->address, config->memory.atomic_bytes);
  } else if (flags & TRAX_IS_STORE) {
    to->nontemporal_stores++;
    to->combined_stores += (accessed->outcome & TRAX_OUTCOME_COMBINED) != 0;
  } else {
    to->nontemporal_loads++;
    to->nontemporal_read_bytes += transfer_bytes(config, accessed->address, 4);
  }
}

static void count_instructions(struct trax_tm_stats *to, trax_op op, uint64_t times) {
  const trax_op_info *info = &trax_op_table[op];
  to->cycles[TRAX_CAUSE_ISSUED] += times;
  to->instructions[op] += times;
  to->icache_hits += times; /* one fetch, for the energy */
  if (info->access_bytes)
    *(info->flags & TRAX_IS_STORE ? &to->local_stores : &to->local_loads) += times;
}

/* Charges the thread's cycles since the latest charge to the kind that it works for. */
static void charge(struct ray_kinds *rays, const struct trax_passage *passage) {
  struct ray_thread *thread = &rays->threads[passage->thread];
  for (unsigned cause = TRAX_CAUSE_ISSUED + 1; cause < TRAX_CAUSE_COUNT; cause++)
    rays->kinds[thread->working].cycles[cause] += passage->cycles[cause] - thread->cycles[cause];
  memcpy(thread->cycles, passage->cycles, sizeof thread->cycles);
}

static void follow(void *self, struct trax_passage *passage) {
  struct ray_kinds *rays = self;
  struct ray_thread *thread = &rays->threads[passage->thread];
  const unsigned kind = trax_counted_kind(passage);
  const bool ends_item = trax_ends_item(passage);
  if (!passage->count || ends_item || kind != TRAX_NO_RAY)
    charge(rays, passage);
  if (kind != TRAX_NO_RAY)
    thread->working = (uint8_t)kind;
  passage->kind = thread->working;
  if (!passage->count)
    return;
  struct trax_tm_stats *to = &rays->kinds[thread->working];
  const struct trax_piece *last = &passage->piece[passage->pieces - 1];
  to->taken_branches += passage->pieces - 1 + (passage->next_pc != last->pc + 4 * last->count);
  const unsigned flags = trax_op_table[passage->inst.op].flags;
  if (passage->accessed_count && flags & (TRAX_IS_NONTEMPORAL | TRAX_IS_ATOMIC)) /* a passage of its own */
    count_past_cache(to, &rays->reader.explain->machine->config, passage->accessed, flags);
  if (ends_item) {
    rays->kinds[TRAX_NO_RAY].items += passage->result;
    thread->working = TRAX_NO_RAY;
  }
}

static void add_counts(void *self, const struct trax_counts *counts) {
  struct ray_kinds *rays = self;
  const struct trax_places *places = rays->reader.explain->places;
  const uint8_t access = trax_places_accesses(places)[counts->index];
  count_instructions(&rays->kinds[counts->kind], trax_places_inst(places, counts->index)->op, counts->executed);
  if (access == TRAX_ACCESS_LOAD || access == TRAX_ACCESS_STORE)
    for (unsigned i = 0; i < TRAX_OUTCOMES; i++)
      rays->outcomes[counts->kind][access == TRAX_ACCESS_STORE][i] += counts->outcomes[i];
}

static trax_status end_counts(void *self, trax_error *error) {
  struct ray_kinds *rays = self;
  (void)error;
  for (unsigned kind = 0; kind < KINDS; kind++)
    count_outcomes(&rays->kinds[kind], &rays->reader.explain->machine->config, rays->outcomes[kind][0],
                   rays->outcomes[kind][1]);
  return TRAX_OK;
}

/* --- the table --- */

static bool has_column(const char *counter) {
  return strncmp(counter, "rays", 4) != 0 && strncmp(counter, "icache.", 7) != 0 &&
         strcmp(counter, "memory.queue_peak") != 0 && strcmp(counter, "memory.requests") != 0 &&
         strcmp(counter, "memory.write_requests") != 0;
}

static void write_head(FILE *out) {
  fprintf(out, "kind,rays,mrps,thread_cycles,utilisation,bytes,bytes_per_ray,energy,energy_per_ray");
#define HEAD(ID, NAME, ...) fprintf(out, "," NAME);
  TRAX_CAUSES(HEAD)
#undef HEAD
#define HEAD(ID, NAME, UNIT, MEANING)                                                                                  \
  if (has_column(NAME))                                                                                                \
    fprintf(out, "," NAME);
  TRAX_TM_COUNTERS(HEAD)
#undef HEAD
  fputc('\n', out);
}

static double share(double a, double b) {
  return b > 0 ? a / b : 0;
}

static void write_row(const struct ray_kinds *rays, FILE *out, const char *name, const struct trax_tm_stats *row,
                      uint64_t count, double joules) {
  const struct trax_machine *machine = rays->reader.explain->machine;
  uint64_t cycles = 0;
  for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++)
    cycles += row->cycles[cause];
  const uint64_t bytes = row->data_read_bytes + row->instruction_read_bytes + row->nontemporal_read_bytes +
                         row->written_bytes + row->atomic_bytes;
  fprintf(out, "%s,%" PRIu64 ",%.6f,%" PRIu64 ",%.6f,%" PRIu64 ",%.6f,%.9g,%.9g", name, count,
          share((double)count * machine->config.chip.clock_mhz * (double)machine->stats.threads, (double)cycles),
          cycles, share((double)row->cycles[TRAX_CAUSE_ISSUED], (double)cycles), bytes,
          share((double)bytes, (double)count), joules, share(joules, (double)count));
  for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++)
    fprintf(out, ",%" PRIu64, row->cycles[cause]);
#define COUNT(ID, NAME, UNIT, MEANING)                                                                                 \
  if (has_column(NAME))                                                                                                \
    fprintf(out, ",%" PRIu64, row->ID);
  TRAX_TM_COUNTERS(COUNT)
#undef COUNT
  fputc('\n', out);
}

static trax_status put_table(void *self, FILE *out, trax_error *error) {
  const struct ray_kinds *rays = self;
  (void)error;
  const struct trax_machine *machine = rays->reader.explain->machine;
  const struct trax_config *config = &machine->config;
  const struct trax_tm_stats *total = &machine->stats.total;
  const uint64_t *counted = &total->rays_primary;
  const double all = trax_energy_of(&machine->stats, config).total;
  struct trax_tm_stats rest = *total;
  double rest_energy = all;
  write_head(out);
  for (unsigned kind = 0; kind < KINDS; kind++) {
    struct trax_stats row = {.total = rays->kinds[kind]};
    trax_stats_derive(&row.total, config);
    const double joules = trax_energy_of(&row, config).total;
    trax_counters_add(&rest, &row.total, sizeof rest, -1);
    rest_energy -= joules;
    write_row(rays, out, trax_ray_kind_names[kind], &row.total, kind == TRAX_NO_RAY ? 0 : counted[kind], joules);
  }
  write_row(rays, out, "rest", &rest, 0, rest_energy);
  write_row(rays, out, "all", total, total->rays, all);
  return TRAX_OK;
}

static trax_status open_ray_kinds(void *self, trax_error *error) {
  struct ray_kinds *rays = self;
  const size_t threads = rays->reader.explain->machine->stats.threads;
  if (!(rays->threads = trax_explain_array(threads, sizeof *rays->threads, error)))
    return TRAX_ERROR;
  for (size_t i = 0; i < threads; i++)
    rays->threads[i].working = TRAX_NO_RAY;
  return TRAX_OK;
}

static void close_ray_kinds(void *self) {
  struct ray_kinds *rays = self;
  free(rays->threads);
}

const struct trax_reader_kind trax_ray_kinds_reader = {
    .bytes = sizeof(struct ray_kinds),
    .files = {{.path = TRAX_EXPLAIN_PATH(ray_kinds), .put = put_table, .member = "ray_kinds"}},
    .in_page = true,
    .open = open_ray_kinds,
    .follow = follow,
    .counts = add_counts,
    .end = end_counts,
    .close = close_ray_kinds};
