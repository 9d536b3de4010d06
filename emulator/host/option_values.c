#include "host/option_values.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "control/engines.h"

enum { MOST_PIXELS = 16384 }; /* of a side of a picture */

trax_status trax_options_append(struct trax_options *options, struct trax_assignment assignment, const char *name,
                                size_t length, const char *value, trax_error *error) {
  struct trax_assignment *grown =
      realloc(options->assignments, (options->assignment_count + 1) * sizeof *options->assignments);
  if (!grown)
    return trax_fail(error, "out of memory");
  options->assignments = grown;
  assignment.name = malloc(length + strlen(value) + 2);
  if (!assignment.name)
    return trax_fail(error, "out of memory");
  memcpy(assignment.name, name, length);
  assignment.name[length] = 0;
  assignment.value = strcpy(assignment.name + length + 1, value);
  options->assignments[options->assignment_count++] = assignment;
  return TRAX_OK;
}

static trax_status add_assignment(struct trax_options *options, const trax_option *option,
                                  struct trax_assignment assignment, const char *text, trax_error *error) {
  const char *equals = strchr(text, '=');
  if (!equals || equals == text || !equals[1])
    return trax_option_refuse(option, text, error, "is not of the form %s", option->argument);
  uint64_t bytes = 0;
  if (assignment.kind == TRAX_ASSIGN_ALLOC && trax_option_number(option, equals + 1, 0, UINT32_MAX, &bytes, error))
    return TRAX_ERROR;
  assignment.bytes = (uint32_t)bytes;
  return trax_options_append(options, assignment, text, (size_t)(equals - text), equals + 1, error);
}

#define ASSIGNMENT_PARSER(function, what)                                                                              \
  trax_status function(void *target, const trax_option *option, const char *value, trax_error *error) {                \
    return add_assignment(target, option, (struct trax_assignment){.kind = what}, value, error);                       \
  }
ASSIGNMENT_PARSER(trax_parse_set, TRAX_ASSIGN_SET)
ASSIGNMENT_PARSER(trax_parse_bind, TRAX_ASSIGN_BIND)
ASSIGNMENT_PARSER(trax_parse_alloc, TRAX_ASSIGN_ALLOC)

/* SYMBOL=FILE, or SYMBOL=FILE.png:WIDTHxHEIGHT. */
trax_status trax_parse_dump(void *target, const trax_option *option, const char *value, trax_error *error) {
  struct trax_assignment dump = {.kind = TRAX_ASSIGN_DUMP};
  const char *colon = strrchr(value, ':'), *end = colon ? colon : value + strlen(value);
  unsigned across, down;
  char rest;
  if (end - value < 4 || strncasecmp(end - 4, ".png", 4) != 0)
    return colon && sscanf(colon, ":%ux%u%c", &across, &down, &rest) == 2
               ? trax_option_refuse(option, value, error,
                                    "has no writer for such pictures: a PNG is SYMBOL=FILE.png:WIDTHxHEIGHT")
               : add_assignment(target, option, dump, value, error);
  char *after = NULL;
  const unsigned long width = colon && isdigit((unsigned char)colon[1]) ? strtoul(colon + 1, &after, 10) : 0;
  const bool has_height = after && after[0] == 'x' && isdigit((unsigned char)after[1]);
  const unsigned long height = has_height ? strtoul(after + 1, &after, 10) : 0;
  if (width < 1 || width > MOST_PIXELS || height < 1 || height > MOST_PIXELS || *after)
    return trax_option_refuse(option, value, error,
                              "has no size of the picture: a PNG is SYMBOL=FILE.png:WIDTHxHEIGHT");
  dump.width = (uint32_t)width;
  dump.height = (uint32_t)height;
  char *text = strndup(value, (size_t)(end - value));
  if (!text)
    return trax_fail(error, "out of memory");
  const trax_status status = add_assignment(target, option, dump, text, error);
  free(text);
  return status;
}

trax_status trax_parse_scene(void *target, const trax_option *option, const char *value, trax_error *error) {
  (void)option;
  return trax_options_append(target, (struct trax_assignment){.kind = TRAX_ASSIGN_BIND}, "scene", strlen("scene"),
                             value, error);
}

trax_status trax_parse_dir(void *target, const trax_option *option, const char *value, trax_error *error) {
  const char *colons = strstr(value, "::");
  const size_t length = colons ? (size_t)(colons - value) : strlen(value);
  if (length == 0 || (colons && !colons[2]))
    return trax_option_refuse(option, value, error, "is not of the form %s", option->argument);
  return trax_options_append(target, (struct trax_assignment){.kind = TRAX_ASSIGN_DIR}, value, length,
                             colons ? colons + 2 : value, error);
}

trax_status trax_parse_main_on(void *target, const trax_option *option, const char *value, trax_error *error) {
  struct trax_options *options = target;
  options->main_on_thread_0 = strcmp(value, "0") == 0;
  return options->main_on_thread_0 || strcmp(value, "all") == 0
             ? TRAX_OK
             : trax_option_refuse(option, value, error, "is neither 0 nor all");
}

trax_status trax_parse_engine(void *target, const trax_option *option, const char *value, trax_error *error) {
  struct trax_options *options = target;
  trax_error reason;
  if (trax_engine_find(value, &options->engine, &reason) != TRAX_OK)
    return trax_option_refuse(option, value, error, "%s", reason.message);
  options->engine_is_named = true;
  return TRAX_OK;
}

trax_status trax_parse_window(void *target, const trax_option *option, const char *value, trax_error *error) {
  struct trax_explain_options *explain = &((struct trax_options *)target)->explain;
  const char *colon = strchr(value, ':');
  char begin[32];
  if (!colon || colon - value >= (int)sizeof begin)
    return trax_option_refuse(option, value, error, "is not of the form BEGIN:END");
  snprintf(begin, sizeof begin, "%.*s", (int)(colon - value), value);
  if (trax_option_number(option, begin, 0, UINT64_MAX / 2, &explain->window_begin, error) != TRAX_OK)
    return TRAX_ERROR;
  return trax_option_number(option, colon + 1, explain->window_begin + 1, UINT64_MAX / 2, &explain->window_end, error);
}

/* Parses a list of numbers from 0 to 63 and ranges, such as 0,2-3, to a mask. */
trax_status trax_parse_list(void *target, const trax_option *option, const char *value, trax_error *error) {
  uint64_t *mask = (uint64_t *)((char *)target + option->offset);
  *mask = 0;
  for (const char *text = value;; text++) {
    char *end = NULL;
    unsigned long first = isdigit((unsigned char)*text) ? strtoul(text, &end, 10) : 64, last = first;
    if (end && *end == '-' && isdigit((unsigned char)end[1]))
      last = strtoul(end + 1, &end, 10);
    if (!end || first > last || last > 63 || (*end && *end != ','))
      return trax_option_refuse(option, value, error, "is no list of numbers from 0 to 63 as in 0,2-3");
    for (; first <= last; first++)
      *mask |= (uint64_t)1 << first;
    if (!*end)
      return TRAX_OK;
    text = end;
  }
}

trax_status trax_parse_source_folder(void *target, const trax_option *option, const char *value, trax_error *error) {
  trax_error reason;
  return trax_explain_add_source_folder(&((struct trax_options *)target)->explain, value, &reason) == TRAX_OK
             ? TRAX_OK
             : trax_fail(error, "--%s: %s", option->name, reason.message);
}

trax_status trax_parse_gdb(void *target, const trax_option *option, const char *value, trax_error *error) {
  struct trax_options *options = target;
  options->gdb = true;
  return trax_option_number(option, value, 0, UINT16_MAX, &options->gdb_port, error);
}
