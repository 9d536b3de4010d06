/* The figures are those of SimTRaX, the simulator of the paper's group: for 65 nm and 1 GHz, as far as documented. */
#include "report/energy.h"

#include "machine/timing.h"
#include "trax/isa.h"

/* nJ per operation. */
static const double integer_nj = 0.000572; /* of the TPs' own units; machine/units.h has those of the others */
static const double register_nj = 0.00789613, local_nj = 0.00692867; /* per access */

/* Off-chip memory: the middle of 1.3 to 2.6 nJ for 64 bits of DRAM (Horowitz, "Computing's energy problem", ISSCC
   2014). SimTRaX has no figure. */
static const double off_chip_nj_per_byte = 1.95 / 8;

/* nJ per access to a data cache of 1 kB << row and 1 << column banks, with lines of 64 bytes (32 where SimTRaX has none
   of 64); 0: SimTRaX has no figure. */
enum { SIZES = 14, BANKS = 7 };
static const double cache_nj[SIZES][BANKS] = {
    {0.057617, 0.105809},
    {0.062554, 0.111004, 0.105809},
    {0.072368, 0.119011, 0.111004, 0.135063},
    {0.091666, 0.134656, 0.118944, 0.143666, 0.259035},
    {0.126381, 0.16519, 0.134578, 0.204198, 0.268276, 0.35423},
    {0.168217, 0.225524, 0.16519, 0.220453, 0.283138, 0.369611, 0.590784},
    {0.235799, 0.299171, 0.225524, 0.251421, 0.310722, 0.493617, 0.607378},
    {0.321923, 0.425117, 0.298784, 0.306706, 0.364071, 0.522638, 0.637147},
    {0.457809, 0.579593, 0.424648, 0.434881, 0.469011, 0.577081, 0.688835},
    {0.64164, 0.811431, 0.579593, 0.559878, 0.611974, 0.682989, 0.787669},
    {0.904345, 1.151285, 0.811431, 0.799263, 0.828002, 0.897012, 0.981988},
    {1.165629, 1.600608, 1.150048, 1.107668, 1.126519, 1.162931, 1.264126},
    {1.644951, 2.188559, 1.598681, 1.559834, 1.554774, 1.604445, 1.655899},
    {2.171381, 3.059984, 2.188559, 2.174519, 2.169675, 2.166975, 2.227535},
};

/* nJ per word fetched from an instruction cache of 4 kB and 1 << column banks. */
static const double icache_nj[BANKS] = {0.013130, 0.013451, 0.013606, 0.013110, 0.013490, 0.015138, 0.016584};

/* Interpolates between the powers of two; above the last known one, that one counts. */
static double at_banks(const double *row, uint32_t banks) {
  unsigned column = 0;
  while (column + 1 < BANKS && row[column + 1] > 0 && 2u << column <= banks)
    column++;
  if (column + 1 == BANKS || row[column + 1] <= 0)
    return row[column];
  const double low = (double)(1u << column);
  return row[column] + (row[column + 1] - row[column]) * ((double)banks - low) / low;
}

double trax_energy_of_cache(uint32_t bytes, uint32_t banks) {
  unsigned row = 0;
  while (row + 1 < SIZES && 2048u << row <= bytes)
    row++;
  return at_banks(cache_nj[row], banks);
}

/* SimTRaX has only instruction caches of 4 kB. Other sizes scale as data caches of one bank. */
static double of_icache(const struct trax_config *config) {
  return at_banks(icache_nj, config->icache.banks) * trax_energy_of_cache(config->icache.bytes, 1) /
         trax_energy_of_cache(4096, 1);
}

static void add_operations(struct trax_energy *energy, unsigned op, double count) {
  const unsigned flags = trax_op_table[op].flags;
  const unsigned registers =
      trax_group_a(flags) + trax_group_b(flags) + ((flags & TRAX_READS_RD) != 0) + ((flags & TRAX_WRITES_RD) != 0);
  energy->registers += count * registers * register_nj;
  switch (trax_class_of((trax_op)op)) {
#define ADD(ID, UNIT, FLAG, ASKS, WORDS, LATENCY, INTERVAL, CAUSE, NJ, ENERGY)                                         \
  case TRAX_CLASS_##ID:                                                                                                \
    energy->ENERGY += count * NJ;                                                                                      \
    break;
    TRAX_CLASSES(ADD)
#undef ADD
  default: /* the TP's own units, which also compute the addresses of memory accesses */
    energy->integer += count * integer_nj;
    break;
  }
}

/* Commands, and the power of the ranks without them. */
static double of_dram(const struct trax_stats *stats, const struct trax_config *config) {
  const struct trax_dram_stats *dram = &stats->memory.dram;
  const double nanoseconds = (double)stats->cycles * 1e3 / config->chip.clock_mhz;
  return (double)dram->activates * config->dram.activate_nj + (double)dram->reads * config->dram.read_nj +
         (double)dram->writes * config->dram.write_nj + (double)dram->refreshes * config->dram.refresh_nj +
         config->dram.background_mw / 1e3 * config->dram.ranks * config->memory.channels * nanoseconds;
}

struct trax_energy trax_energy_of(const struct trax_stats *stats, const struct trax_config *config) {
  const struct trax_tm_stats *count = &stats->total;
  struct trax_energy energy = {0};
  for (unsigned op = 0; op < TRAX_OP_COUNT; op++)
    add_operations(&energy, op, (double)count->instructions[op]);
  energy.local_memory = (double)(count->local_loads + count->local_stores) * local_nj;

  /* An arriving line is written word by word into an instruction cache, and by one access into a data cache. */
  const double fetches = (double)trax_fetches(count);
  energy.icache = (fetches + (double)count->icache_misses * config->icache.line_bytes / 4) * of_icache(config);
  const uint32_t banks = (config->chip.tps_per_tm + config->dcache.tps_per_bank - 1) / config->dcache.tps_per_bank;
  const double accesses = (double)(count->dcache_hits + 2 * count->dcache_misses + count->dcache_merged -
                                   count->broadcast_loads + count->store_hits + count->store_misses);
  energy.dcache = accesses * trax_energy_of_cache(config->dcache.bytes, banks);

  if (config->l2.bytes) {
    const struct trax_memory_stats *memory = &stats->memory;
    const double requests = (double)(memory->l2_hits + 2 * memory->l2_misses + memory->l2_merged + memory->l2_passed +
                                     memory->l2_store_hits + memory->l2_store_misses);
    energy.l2 = requests * trax_energy_of_cache(config->l2.bytes, config->l2.banks);
  }

  energy.off_chip = config->memory.model == TRAX_MEMORY_DRAM ? of_dram(stats, config)
                                                             : off_chip_nj_per_byte * (double)stats->memory.bytes;
  energy.off_chip *= 1e-9;
#define ADD(X, ID, MEANING)                                                                                            \
  energy.ID *= 1e-9;                                                                                                   \
  energy.total += energy.ID;
  TRAX_ENERGIES(ADD, )
#undef ADD
  return energy;
}
