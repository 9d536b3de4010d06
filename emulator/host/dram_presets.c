#include "host/dram_presets.h"

#include "trax/names.h"

#include <string.h>

/* Times in ticks, rounded up from the data sheets' ns; of parts without bank groups, for one rank and the temperatures
   up to 85 degrees.

   - LPDDR2-1066: JESD209-2 and Micron MT42L128M32D1, 4 Gbit, x32: tRCD 15, tRP 15, tRAS 42, tRRD 10, tFAW 50, tWTR 7.5,
     tWR 15, tRTP 7.5, tRFCab 130 ns, tREFI 3.9 us, RL 8, WL 4.
   - LPDDR3-1600: JESD209-3 and Micron EDF8132A1MC, 4 Gbit, x32: tRCD 18, tRP 18, tRAS 42, tRRD 10, tFAW 50, tWTR 7.5,
     tWR 15, tRTP 7.5, tRFCab 130 ns, tREFI 3.9 us, RL 12, WL 6.
   - LPDDR4-3200: JESD209-4 and Micron's 6 Gbit channel, x16: tRCD 18, tRP 18, tRAS 42, tRRD 10, tFAW 40, tWTR 10, tWR
   18, tRTP 7.5, tRFCab 280 ns, tREFI 3.904 us, RL 28, WL 14.

   Two ticks between data in different directions or of different ranks are a choice of ours. The read latency is
   without tDQSCK.

   Energies follow from the parts' supply currents, summed over VDD1 and VDD2, without the interface (VDDQ):
     activate    IDD0 tRC - (IDD3N tRAS + IDD2N tRP)
     read, write (IDD4R, IDD4W - IDD3N) for a burst
     refresh     (IDD5 - IDD3N) tRFCab
     background  IDD3N, as if a row was always open
   in mA, VDD1 (1.8 V) / VDD2 (1.2, 1.2, 1.1 V): IDD0 15/70, 8/60, 3.5/45; IDD2N 2/30, 0.8/26, 2/27; IDD3N 2.5/30, 2/34,
   2.25/30; IDD4W 10/190, 2/190, 2.25/210; IDD4R 3/220, 2/230, 2.25/275; IDD5 40/150, 28/150, 10/90. */
/* clang-format off */
static const struct preset {
  const char *name, *meaning;
  uint32_t channels, mtps, bus_bits, burst_length, banks, row_bytes;
  uint32_t trcd, trp, tcl, tcwl, tras, trrd, tfaw, twtr, twr, trtp, trefi, trfc;
  double activate_nj, read_nj, write_nj, refresh_nj, background_mw;
} presets[] = {
  {"lpddr2-1066", "two channels of 32 bits, 8.528 GB/s",
   2, 1066, 32, 8, 8, 4096,   8,  8,  8,  4, 23,  6, 27,  4,  8,  4, 2078,  70, 4.032, 1.717, 1.541, 27.495, 40.5},
  {"lpddr3-1600", "two channels of 32 bits, 12.8 GB/s",
   2, 1600, 32, 8, 8, 4096,  15, 15, 12,  6, 34,  8, 40,  6, 12,  6, 3120, 104, 2.732, 1.176, 0.936, 24.18, 44.4},
  {"lpddr4-3200", "four channels of 16 bits, 25.6 GB/s",
   4, 3200, 16, 16, 8, 2048, 29, 29, 28, 14, 68, 16, 64, 16, 29, 12, 6246, 448, 1.193, 1.348, 0.99, 22.386, 37.05},
};
/* clang-format on */
enum { PRESETS = sizeof presets / sizeof *presets };

static const char *preset_name(const void *context, size_t i) {
  (void)context;
  return presets[i].name;
}

trax_status trax_dram_preset_apply(struct trax_config *config, const char *name, trax_error *error) {
  const struct preset *preset = NULL;
  for (size_t i = 0; i < PRESETS; i++)
    if (strcmp(presets[i].name, name) == 0)
      preset = &presets[i];
  if (!preset) {
    char names[256] = "";
    size_t length = 0;
    for (size_t i = 0; i < PRESETS && length < sizeof names; i++)
      length += (size_t)snprintf(names + length, sizeof names - length, "%s%s",
                                 i == 0            ? ""
                                 : i + 1 < PRESETS ? ", "
                                                   : " and ",
                                 presets[i].name);
    const char *nearest = trax_nearest_name(name, PRESETS, preset_name, NULL);
    return trax_fail(error, "%s is \"%.80s\"%s%s%s; allowed are %s", TRAX_DRAM_PRESET, name,
                     nearest ? " (did you mean " : "", nearest ? nearest : "", nearest ? "?)" : "", names);
  }
  static const struct trax_config initial = TRAX_CONFIG_DEFAULT;
  config->dram = initial.dram;
  config->memory.channels = preset->channels;
#define SET(KEY) config->dram.KEY = preset->KEY
  SET(mtps), SET(bus_bits), SET(burst_length), SET(banks), SET(row_bytes);
  SET(trcd), SET(trp), SET(tcl), SET(tcwl), SET(tras), SET(trrd), SET(tfaw), SET(twtr), SET(twr), SET(trtp);
  SET(trefi), SET(trfc);
  SET(activate_nj), SET(read_nj), SET(write_nj), SET(refresh_nj), SET(background_mw);
#undef SET
  return TRAX_OK;
}

void trax_dram_presets_describe(FILE *out) {
  for (size_t i = 0; i < PRESETS; i++)
    fprintf(out, "  %-12s %s\n", presets[i].name, presets[i].meaning);
}
