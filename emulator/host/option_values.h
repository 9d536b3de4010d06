/* Parsers of option values, for rows of trax-sim's table (trax/options.h). */
#ifndef TRAX_HOST_OPTION_VALUES_H
#define TRAX_HOST_OPTION_VALUES_H

#include "host/options.h"

typedef trax_status trax_option_parser(void *target, const trax_option *option, const char *value, trax_error *error);

/* These add to struct trax_options.assignments. */
trax_option_parser trax_parse_set;
trax_option_parser trax_parse_bind;
trax_option_parser trax_parse_alloc;
trax_option_parser trax_parse_dump;
trax_option_parser trax_parse_scene;
trax_option_parser trax_parse_dir;
/* The others set members. */
trax_option_parser trax_parse_main_on;
trax_option_parser trax_parse_engine;
trax_option_parser trax_parse_window;
trax_option_parser trax_parse_list;
trax_option_parser trax_parse_source_folder;
trax_option_parser trax_parse_gdb;

/* Adds an assignment: `length` characters of the name, and the value. */
trax_status trax_options_append(struct trax_options *options, struct trax_assignment assignment, const char *name,
                                size_t length, const char *value, trax_error *error);

#endif
