/* Standards of DRAM by name, which the setting dram.preset gives to the keys of `dram` and to memory.channels. */
#ifndef TRAX_HOST_DRAM_PRESETS_H
#define TRAX_HOST_DRAM_PRESETS_H

#include "machine/config.h"

#include <stdio.h>

/* The setting's name. It is no key: a configuration has the values that it sets. */
#define TRAX_DRAM_PRESET "dram.preset"

/* Sets the keys. An unknown name fails with the nearest one. */
trax_status trax_dram_preset_apply(struct trax_config *config, const char *name, trax_error *error);
/* Prints the presets, a line each. */
void trax_dram_presets_describe(FILE *out);

#endif
