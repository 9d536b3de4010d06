/* The templates of translated code, as data that a test can change. They take the place of the library's. */
#define const
#include "templates.c"

/* A compiler may ignore a change of what it was told to be constant. */
struct trax_template *mutable_templates(unsigned op), *mutable_burst_templates(unsigned op);
struct trax_template *mutable_templates(unsigned op) {
  return trax_templates[op];
}
struct trax_template *mutable_burst_templates(unsigned op) {
  return trax_burst_templates[op];
}
