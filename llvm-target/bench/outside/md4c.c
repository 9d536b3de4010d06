#include "outside.h"
#include <md4c-html.h>

enum { SIZE = 24000 };
static char text[SIZE + 200];
static uint32_t sum;

void kernel_setup(void) {
  static const char part[] =
      "# Title\n\nSome *emphasis*, **strong**, `code` and [a link](http://example.org \"t\").\n\n1. one\n2. two\n   - "
      "nested\n\n"
      "> quote\n\n| a | b |\n| - | - |\n| 1 | 2 |\n\n```c\nint main(void) { return 0; }\n```\n\n";
  outside_begin();
  for (uint32_t at = 0; at < SIZE; at += sizeof part - 1 + 400) {
    memcpy(text + at, part, sizeof part - 1 < SIZE + 200 - at ? sizeof part - 1 : 0);
    if (at + sizeof part + 400 < SIZE)
      outside_text(text + at + sizeof part - 1, 400);
  }
}

static void process(const MD_CHAR *output, MD_SIZE size, void *unused) {
  (void)unused;
  sum = mix(sum, outside_sum(output, size));
}

struct result kernel_run(void) {
  sum = 0;
  md_html(text, SIZE, process, NULL, MD_DIALECT_GITHUB, 0);
  return (struct result){sum, 0};
}
