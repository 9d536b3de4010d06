/* Parsers of option values, for rows of trax-render's table (trax/options.h). */
#ifndef TRAX_RENDER_VALUES_H
#define TRAX_RENDER_VALUES_H

#include "trax/options.h"

#define PARSER(name) trax_status name(void *target, const trax_option *option, const char *value, trax_error *error)
PARSER(take_size);          /* struct trax_frame_options */
PARSER(take_point);         /* struct point */
PARSER(take_light);         /* struct camera_options */
PARSER(take_fov);           /* float, degrees */
PARSER(take_orbit);         /* float[2], degrees */
PARSER(take_fraction);      /* float, 0 to 1 */
PARSER(take_strength);      /* float, 0 to 1e6 */
PARSER(take_turn);          /* double, degrees */
PARSER(take_share);         /* double, above 0 to 1 */
PARSER(take_percent);       /* the same, from per cent */
PARSER(take_colour);        /* uint32_t, a pixel */
PARSER(take_pixel);         /* struct pixels */
PARSER(take_source_folder); /* struct trax_explain_options */
PARSER(take_cost);          /* const char * that trax_cost_find knows */
/* These set several members of struct options. */
PARSER(take_setting);
PARSER(take_queues);
PARSER(take_moments); /* whose offset is that of import */
PARSER(take_prepare);
#undef PARSER

#endif
