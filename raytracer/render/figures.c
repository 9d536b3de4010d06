#include "figures.h"

#include <jansson.h>
#include <math.h>
#include <stdlib.h>

void figures_print(FILE *out, const struct figure *figures, size_t count) {
  json_t *object = json_object();
  for (size_t i = 0; i < count; i++)
    json_object_set_new(object, figures[i].key,
                        figures[i].value == floor(figures[i].value) && fabs(figures[i].value) < 0x1p53
                            ? json_integer((json_int_t)figures[i].value)
                            : json_real(figures[i].value));
  json_dumpf(object, out, JSON_INDENT(2));
  fputc('\n', out);
  json_decref(object);
}
