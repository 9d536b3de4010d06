#include "outside.h"
#include <yaml.h>

enum { SIZE = 12000 };
static char text[SIZE];
static uint32_t used;

void kernel_setup(void) {
  static const char part[] = "- name: \"trax\"\n  list: [1, 2.5, -3e10, true, null]\n  nested: {a: {b: [c, d]}, e: 'f "
                             "g'}\n  text: |\n    several\n    lines\n";
  outside_begin();
  for (used = 0; used + sizeof part < SIZE; used += sizeof part - 1)
    memcpy(text + used, part, sizeof part - 1);
}

struct result kernel_run(void) {
  yaml_parser_t parser;
  yaml_event_t event;
  uint32_t sum = 0;
  yaml_parser_initialize(&parser);
  yaml_parser_set_input_string(&parser, (const unsigned char *)text, used);
  for (int last = 0; !last && yaml_parser_parse(&parser, &event);) {
    sum = mix(sum, (uint32_t)event.type);
    if (event.type == YAML_SCALAR_EVENT)
      sum = mix(sum, outside_sum(event.data.scalar.value, (uint32_t)event.data.scalar.length));
    last = event.type == YAML_STREAM_END_EVENT;
    yaml_event_delete(&event);
  }
  yaml_parser_delete(&parser);
  return (struct result){sum, 0};
}
