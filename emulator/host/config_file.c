/* Configuration files (libconfig): components with keys, and optionally the preset that they modify.

     preset = "4x32";
     memory: { bandwidth_gbps = 16.0; };
*/
#include <ctype.h>
#include <libconfig.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/config.h"
#include "host/dram_presets.h"
#include "trax/input.h"
#include "trax/names.h"

/* Rejects what libconfig 1.5 accepts: integers beyond 32 bits, which it wraps, @include, by which a directory makes it
   end the process, and a NUL. */
static trax_status check_text(const char *path, const char *text, size_t size, trax_error *error) {
  unsigned line = 1;
  const char *end = text + size, *name = text; /* name: the latest one, for messages */
  int name_length = 0;
  for (const char *p = text; p < end;) {
    if (*p == 0)
      return trax_fail(error, "%s:%u: not a text file", path, line);
    if (*p == '\n') {
      ++line;
      ++p;
    } else if (*p == '#' || (p[0] == '/' && p[1] == '/')) {
      while (p < end && *p != '\n')
        ++p;
    } else if (p[0] == '/' && p[1] == '*') {
      for (p += 2; p < end && !(p[0] == '*' && p[1] == '/'); ++p)
        line += *p == '\n';
      p = p < end ? p + 2 : end;
    } else if (*p == '"') {
      for (++p; p < end && *p != '"'; ++p) {
        if (*p == '\\' && p + 1 < end)
          ++p;
        line += *p == '\n';
      }
      ++p;
    } else if (*p == '@') {
      return trax_fail(error, "%s:%u: directives such as @include are not supported", path, line);
    } else if (isalpha((unsigned char)*p) || *p == '*') {
      for (name = p; isalnum((unsigned char)*p) || (*p && strchr("-_*", *p)); ++p)
        ;
      name_length = (int)(p - name);
    } else if (isdigit((unsigned char)*p)) {
      char *number_end;
      double value = strtod(p, &number_end);
      if (!(value <= INT_MAX))
        return trax_fail(error, "%s:%u: %.*s is %.*s, larger than any key allows", path, line, name_length, name,
                         (int)(number_end - p), p);
      p = number_end;
    } else {
      ++p;
    }
  }
  return TRAX_OK;
}

static bool number_value(const config_setting_t *setting, double *value) {
  switch (config_setting_type(setting)) {
  case CONFIG_TYPE_INT:
    *value = config_setting_get_int(setting);
    return true;
  case CONFIG_TYPE_INT64:
    *value = (double)config_setting_get_int64(setting);
    return true;
  case CONFIG_TYPE_FLOAT:
    *value = config_setting_get_float(setting);
    return true;
  default:
    return false;
  }
}

/* A setting's value or type as text, for messages. */
struct value_text {
  char text[80];
};
static struct value_text describe(const config_setting_t *setting) {
  struct value_text value;
  double number;
  if (number_value(setting, &number)) {
    snprintf(value.text, sizeof value.text, "%.12g", number);
    return value;
  }
  switch (config_setting_type(setting)) {
  case CONFIG_TYPE_STRING:
    snprintf(value.text, sizeof value.text, "\"%.48s\", a string", config_setting_get_string(setting));
    break;
  case CONFIG_TYPE_BOOL:
    snprintf(value.text, sizeof value.text, "%s", config_setting_get_bool(setting) ? "true" : "false");
    break;
  case CONFIG_TYPE_GROUP:
    snprintf(value.text, sizeof value.text, "a component");
    break;
  default:
    snprintf(value.text, sizeof value.text, "a list");
    break;
  }
  return value;
}

static trax_status apply_setting(struct trax_config *config, const char *component, const config_setting_t *setting,
                                 trax_error *error) {
  char name[256];
  snprintf(name, sizeof name, "%s%s%s", component, *component ? "." : "", config_setting_name(setting));
  if (strcmp(name, TRAX_DRAM_PRESET) == 0) {
    const char *preset = config_setting_get_string(setting);
    return trax_dram_preset_apply(config, preset ? preset : describe(setting).text, error);
  }
  const struct trax_config_key *key = trax_config_find(name, error);
  if (!key)
    return TRAX_ERROR;
  double value = 0;
  const bool flag = config_setting_type(setting) == CONFIG_TYPE_BOOL;
  const char *word = config_setting_get_string(setting);
  if (trax_config_has_words(key) && word) {
    if (trax_config_parse_word(key, word, &value, error))
      return TRAX_ERROR;
  } else if (key->kind == TRAX_KIND_FLAG ? !flag : trax_config_has_words(key) || !number_value(setting, &value)) {
    char allowed[TRAX_CONFIG_ALLOWED];
    trax_config_allowed(key, allowed);
    return trax_fail(error, "%s is %s; allowed are %s", name, describe(setting).text, allowed);
  } else if (flag) {
    value = config_setting_get_bool(setting);
  }
  return trax_config_store(config, key, value, error);
}

static bool is_component(const char *name) {
  for (size_t i = 0; i < trax_config_key_count; ++i)
    if (strcmp(trax_config_keys[i].component, name) == 0)
      return true;
  return false;
}

static const char *key_component(const void *context, size_t i) {
  (void)context;
  return trax_config_keys[i].component;
}

static trax_status located(const char *path, const config_setting_t *setting, const trax_error *reason,
                           trax_error *error) {
  return trax_fail(error, "%s:%u: %.800s", path, config_setting_source_line(setting), reason->message);
}

static trax_status apply_component(struct trax_config *config, const char *path, const config_setting_t *component,
                                   trax_error *error) {
  const char *name = config_setting_name(component);
  trax_error reason = {.message = ""};
  if (!is_component(name)) {
    const char *nearest = trax_nearest_name(name, trax_config_key_count, key_component, NULL);
    trax_fail(&reason, "unknown component \"%s\"%s%s%s", name, nearest ? "; did you mean " : "", nearest ? nearest : "",
              nearest ? "?" : "");
    return located(path, component, &reason, error);
  }
  for (int i = 0; i < config_setting_length(component); ++i) {
    const config_setting_t *setting = config_setting_get_elem(component, (unsigned)i);
    if (apply_setting(config, name, setting, &reason) != TRAX_OK)
      return located(path, setting, &reason, error);
  }
  return TRAX_OK;
}

static trax_status apply_all(struct trax_config *config, const char *path, const config_t *file, trax_error *error) {
  trax_error reason = {.message = ""};
  *config = (struct trax_config)TRAX_CONFIG_DEFAULT;
  const config_setting_t *preset = config_lookup(file, "preset");
  if (preset) {
    const char *name = config_setting_get_string(preset);
    if (!name) {
      trax_fail(&reason, "preset is %s; it must be a string such as \"4x32\"", describe(preset).text);
      return located(path, preset, &reason, error);
    }
    if (trax_config_preset(config, name, &reason) != TRAX_OK)
      return located(path, preset, &reason, error);
  }
  const config_setting_t *root = config_root_setting(file);
  for (int i = 0; i < config_setting_length(root); ++i) {
    const config_setting_t *setting = config_setting_get_elem(root, (unsigned)i);
    if (setting == preset)
      continue;
    if (config_setting_type(setting) == CONFIG_TYPE_GROUP) {
      if (apply_component(config, path, setting, error) != TRAX_OK)
        return TRAX_ERROR;
      continue;
    }
    if (is_component(config_setting_name(setting)))
      trax_fail(&reason, "%s is %s; it must be a component: %s: { ... };", config_setting_name(setting),
                describe(setting).text, config_setting_name(setting));
    else /* no key is outside a component: this fails with a message that names the component */
      apply_setting(config, "", setting, &reason);
    return located(path, setting, &reason, error);
  }
  return TRAX_OK;
}

trax_status trax_config_read_file(struct trax_config *config, const char *path, trax_error *error) {
  uint8_t *bytes;
  size_t size;
  if (trax_read_file(path, TRAX_TEXT_LIMIT, &bytes, &size, error) != TRAX_OK)
    return TRAX_ERROR;
  const char *text = (const char *)bytes;
  trax_status status = check_text(path, text, size, error);
  if (status == TRAX_OK) {
    config_t file;
    config_init(&file);
    struct trax_config result;
    if (config_read_string(&file, text) != CONFIG_TRUE) {
      const char *reason = config_error_text(&file);
      if (reason && strcmp(reason, "memory exhausted") == 0) /* the parser's stack is full */
        reason = "components are nested too deeply";
      status = trax_fail(error, "%s:%d: %s", path, config_error_line(&file), reason);
    } else
      status = apply_all(&result, path, &file, error);
    config_destroy(&file);
    if (status == TRAX_OK)
      *config = result;
  }
  free(bytes);
  return status;
}
