#include "values.h"

#include "options.h"
#include "trax/scene_options.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

static void *member(void *target, const trax_option *option) {
  return (char *)target + option->offset;
}

/* Parses an unsigned decimal number without sign or space at *text, which moves behind it. */
static bool parse_side(const char **text, unsigned *value) {
  if (**text < '0' || **text > '9')
    return false;
  char *end;
  errno = 0;
  const unsigned long number = strtoul(*text, &end, 10);
  *text = end;
  *value = (unsigned)number;
  return errno == 0 && number > 0 && number <= TRAX_RENDER_MAX_SIDE;
}

trax_status take_size(void *target, const trax_option *option, const char *value, trax_error *error) {
  struct trax_frame_options *frame = member(target, option);
  const char *text = value;
  if (parse_side(&text, &frame->width) && *text++ == 'x' && parse_side(&text, &frame->height) && *text == '\0')
    return TRAX_OK;
  return trax_option_refuse(option, value, error, "is not of the form WIDTHxHEIGHT, each 1 to %u",
                            TRAX_RENDER_MAX_SIDE);
}

/* Parses up to `count` numbers between commas, none beyond `most`. Returns how many, 0 for any other text. */
static unsigned parse_floats(const char *text, float *values, unsigned count, float most) {
  for (unsigned i = 0; i < count; i++) {
    char *end;
    values[i] = strtof(text, &end);
    if (end == text || !(values[i] >= -most && values[i] <= most))
      return 0;
    if (*end == '\0')
      return i + 1;
    if (*end != ',')
      return 0;
    text = end + 1;
  }
  return 0;
}

trax_status take_point(void *target, const trax_option *option, const char *value, trax_error *error) {
  struct point *point = member(target, option);
  point->given = true;
  return parse_floats(value, point->at, 3, 1e18f) == 3
             ? TRAX_OK
             : trax_option_refuse(option, value, error, "is not of the form X,Y,Z");
}

trax_status take_light(void *target, const trax_option *option, const char *value, trax_error *error) {
  struct camera_options *camera = member(target, option);
  if (camera->light_count == TRAX_VIEW_MAX_LIGHTS)
    return trax_fail(error, "--light: there may be at most %d lights", TRAX_VIEW_MAX_LIGHTS);
  return parse_floats(value, camera->lights[camera->light_count++], 3, 1e18f) == 3
             ? TRAX_OK
             : trax_option_refuse(option, value, error, "is not of the form X,Y,Z");
}

trax_status take_fov(void *target, const trax_option *option, const char *value, trax_error *error) {
  float *fov = member(target, option);
  if (parse_floats(value, fov, 1, 179.9f) != 1 || *fov < 0.01f)
    return trax_option_refuse(option, value, error, "is not a number of degrees from 0.01 to 179.9");
  return TRAX_OK;
}

trax_status take_orbit(void *target, const trax_option *option, const char *value, trax_error *error) {
  return parse_floats(value, member(target, option), 2, 36000) > 0
             ? TRAX_OK
             : trax_option_refuse(option, value, error, "is not of the form ANGLE or ANGLE,ELEVATION, in degrees");
}

trax_status take_fraction(void *target, const trax_option *option, const char *value, trax_error *error) {
  float *fraction = member(target, option);
  if (parse_floats(value, fraction, 1, 1) != 1 || *fraction < 0)
    return trax_option_refuse(option, value, error, "is not a number from 0 to 1");
  return TRAX_OK;
}

trax_status take_strength(void *target, const trax_option *option, const char *value, trax_error *error) {
  float *strength = member(target, option);
  if (parse_floats(value, strength, 1, 1e6f) != 1 || *strength < 0)
    return trax_option_refuse(option, value, error, "is not a number from 0 to 1e6");
  return TRAX_OK;
}

trax_status take_turn(void *target, const trax_option *option, const char *value, trax_error *error) {
  float degrees;
  if (parse_floats(value, &degrees, 1, 360) != 1)
    return trax_option_refuse(option, value, error, "is not an angle from -360 to 360 degrees");
  *(double *)member(target, option) = (double)degrees;
  return TRAX_OK;
}

/* Parses a number above 0 and up to `most`. */
static bool parse_share(const char *text, double most, double *value) {
  char *end;
  *value = strtod(text, &end);
  return end != text && *end == '\0' && *value > 0 && *value <= most;
}

trax_status take_share(void *target, const trax_option *option, const char *value, trax_error *error) {
  return parse_share(value, 1, member(target, option))
             ? TRAX_OK
             : trax_option_refuse(option, value, error, "is not a number above 0 to 1");
}

trax_status take_percent(void *target, const trax_option *option, const char *value, trax_error *error) {
  double *share = member(target, option);
  if (!parse_share(value, 50, share))
    return trax_option_refuse(option, value, error, "is not per cent, above 0 to 50");
  *share /= 100;
  return TRAX_OK;
}

trax_status take_colour(void *target, const trax_option *option, const char *value, trax_error *error) {
  if (strlen(value) != 6 || strspn(value, "0123456789abcdefABCDEF") != 6)
    return trax_option_refuse(option, value, error, "is not of the form RRGGBB, six hexadecimal digits");
  const uint32_t rgb = (uint32_t)strtoul(value, NULL, 16);
  *(uint32_t *)member(target, option) = 0xFF000000u | (rgb & 0xFF) << 16 | (rgb & 0xFF00) | rgb >> 16;
  return TRAX_OK;
}

trax_status take_setting(void *target, const trax_option *option, const char *value, trax_error *error) {
  struct options *options = target;
  const char *equals = strchr(value, '=');
  if (!equals || equals == value)
    return trax_option_refuse(option, value, error, "is not of the form KEY=VALUE");
  struct setting *settings = realloc(options->settings, (options->setting_count + 1) * sizeof *settings);
  if (settings)
    options->settings = settings;
  char *key = strndup(value, (size_t)(equals - value));
  if (!settings || !key) {
    free(key);
    return trax_fail(error, "out of memory");
  }
  settings[options->setting_count++] = (struct setting){key, equals + 1};
  return TRAX_OK;
}

trax_status take_pixel(void *target, const trax_option *option, const char *value, trax_error *error) {
  struct pixels *pixels = member(target, option);
  unsigned x, y;
  char rest;
  if (sscanf(value, "%5u,%5u%c", &x, &y, &rest) != 2 || value[strspn(value, "0123456789,")])
    return trax_option_refuse(option, value, error, "is not of the form X,Y, numbers from 0");
  if (pixels->count == MOST_PIXELS)
    return trax_fail(error, "--pixel %s is one too many: %d pixels are possible", value, MOST_PIXELS);
  pixels->at[pixels->count][0] = x;
  pixels->at[pixels->count++][1] = y;
  return TRAX_OK;
}

trax_status take_source_folder(void *target, const trax_option *option, const char *value, trax_error *error) {
  trax_error reason;
  return trax_explain_add_source_folder(member(target, option), value, &reason) == TRAX_OK
             ? TRAX_OK
             : trax_fail(error, "--%s: %s", option->name, reason.message);
}

trax_status take_cost(void *target, const trax_option *option, const char *value, trax_error *error) {
  unsigned what;
  *(const char **)member(target, option) = value;
  return trax_cost_find(value, &what, error);
}

trax_status take_queues(void *target, const trax_option *option, const char *value, trax_error *error) {
  struct options *options = target;
  uint64_t queues = 0;
  options->choose_queues = true;
  if (strcmp(value, "tms") != 0 && trax_option_number(option, value, 1, TRAX_MAX_QUEUES, &queues, error) != TRAX_OK)
    return trax_option_refuse(option, value, error, "is neither tms nor a whole number from 1 to %d", TRAX_MAX_QUEUES);
  options->queues = (unsigned)queues;
  return TRAX_OK;
}

trax_status take_moments(void *target, const trax_option *option, const char *value, trax_error *error) {
  struct options *options = target;
  char first[64];
  const char *colon = strchr(value, ':');
  options->sequence = colon != NULL;
  if (!colon)
    return trax_take_at(target, option, value, error);
  if ((size_t)(colon - value) >= sizeof first)
    return trax_option_refuse(option, value, error, "is too long");
  snprintf(first, sizeof first, "%.*s", (int)(colon - value), value);
  return trax_take_at(target, option, colon + 1, error) == TRAX_OK ? trax_take_at(target, option, first, error)
                                                                   : TRAX_ERROR;
}

trax_status take_prepare(void *target, const trax_option *option, const char *value, trax_error *error) {
  struct options *options = target;
  (void)option, (void)error;
  options->prepare = true;
  options->keep = value;
  return TRAX_OK;
}
