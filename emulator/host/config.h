/* Between config.c (values and text) and config_file.c (libconfig files). */
#ifndef TRAX_HOST_CONFIG_H
#define TRAX_HOST_CONFIG_H

#include "machine/config.h"

/* The key of that name, or NULL with a message that suggests the nearest one. */
const struct trax_config_key *trax_config_find(const char *name, trax_error *error);
/* Stores a value that was checked or is checked here. */
trax_status trax_config_store(struct trax_config *config, const struct trax_config_key *key, double value,
                              trax_error *error);
/* "; allowed are ...": what the key may have. Points into *message, which it overwrites. */
const char *trax_config_allowed(const struct trax_config_key *key, trax_error *message);
/* Reads a libconfig file over *config, which stays as it was on an error. The message names file and line. */
trax_status trax_config_read_file(struct trax_config *config, const char *path, trax_error *error);

#endif
