#include "report.h"

#include "trax/output.h"

#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>

/* The rows: text, key in JSON, value. */
#define ROWS                                                                                                           \
  ROW("instructions of code", "code_instructions", (double)(figures->size.code_bytes / 4))                             \
  ROW("bytes of code", "code_bytes", (double)figures->size.code_bytes)                                                 \
  ROW("bytes of stack", "stack_bytes", (double)figures->size.stack_bytes)                                              \
  ROW("bytes of scene", "scene_bytes", figures->scene_bytes)                                                           \
  ROW("instructions run", "instructions", figures->instructions)                                                       \
  ROW("cycles", "cycles", figures->cycles)                                                                             \
  ROW("bytes from and to memory", "memory_bytes", figures->memory_bytes)

static const struct {
  const char *text, *key;
} rows[] = {
#define ROW(TEXT, KEY, VALUE) {TEXT, KEY},
    ROWS
#undef ROW
};
enum { ROW_COUNT = sizeof rows / sizeof *rows };

static void values_of(double values[ROW_COUNT], const struct program_figures *figures) {
  const double all[] = {
#define ROW(TEXT, KEY, VALUE) VALUE,
      ROWS
#undef ROW
  };
  for (int i = 0; i < ROW_COUNT; i++)
    values[i] = all[i];
}

void report_print(const struct program_figures *general, const struct program_figures *specialised, uint32_t features) {
  double before[ROW_COUNT], after[ROW_COUNT];
  values_of(before, general);
  values_of(after, specialised);
  printf("features                               all ");
  for (unsigned feature = 0; feature < TRAX_FEATURE_COUNT; feature++)
    if (features >> feature & 1)
      printf(" %s", trax_feature_name(feature));
  printf("\nprogram                            general     specialised    change\n");
  for (int i = 0; i < ROW_COUNT; i++)
    printf("%-26s %15.0f %15.0f  %+6.2f %%\n", rows[i].text, before[i], after[i],
           before[i] > 0 ? 100 * (after[i] / before[i] - 1) : 0);
}

static json_t *json_of(const struct program_figures *figures) {
  double values[ROW_COUNT];
  json_t *object = json_object();
  values_of(values, figures);
  for (int i = 0; i < ROW_COUNT; i++)
    json_object_set_new(object, rows[i].key, json_integer((json_int_t)values[i]));
  return object;
}

trax_status report_add_json(const char *path, const struct program_figures *general,
                            const struct program_figures *specialised, uint32_t features, bool identical,
                            trax_error *error) {
  json_error_t reason;
  json_t *root = json_load_file(path, 0, &reason), *report = json_object(), *names = json_array();
  for (unsigned feature = 0; feature < TRAX_FEATURE_COUNT; feature++)
    if (features >> feature & 1)
      json_array_append_new(names, json_string(trax_feature_name(feature)));
  json_object_set_new(report, "features", names);
  json_object_set_new(report, "general", json_of(general));
  json_object_set_new(report, "specialised", json_of(specialised));
  json_object_set_new(report, "identical", json_boolean(identical));
  char *text = NULL;
  if (root && json_object_set(root, "report", report) == 0)
    text = json_dumps(root, JSON_INDENT(2) | JSON_REAL_PRECISION(15));
  json_decref(report);
  json_decref(root);
  if (!text)
    return trax_fail(error, "%s: the report cannot be added: %s", path, root ? "out of memory" : reason.text);
  trax_output output;
  trax_status status = trax_output_open(&output, path, error);
  if (status == TRAX_OK) {
    fputs(text, output.file);
    fputc('\n', output.file);
    status = trax_output_commit(&output, error); /* which notices what could not be written */
  }
  free(text);
  return status;
}
