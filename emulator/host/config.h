/* The interface between config.c (values and text) and config_file.c (libconfig files). */
#ifndef TRAX_HOST_CONFIG_H
#define TRAX_HOST_CONFIG_H

#include "machine/config.h"

/* Finds a key by name. NULL: there is none; the message suggests the nearest one. */
const struct trax_config_key *trax_config_find(const char *name, trax_error *error);
/* Finds a value that is a word: a policy, a model of memory, a mapping of DRAM. */
trax_status trax_config_parse_word(const struct trax_config_key *key, const char *word, double *value,
                                   trax_error *error);
/* Checks and stores a value. */
trax_status trax_config_store(struct trax_config *config, const struct trax_config_key *key, double value,
                              trax_error *error);
/* Reads a libconfig file into *config, which is unchanged after an error. The message names file and line. */
trax_status trax_config_read_file(struct trax_config *config, const char *path, trax_error *error);

#endif
