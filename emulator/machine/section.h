/* The state of an engine as sections, for rollback and checkpoints.

   A structure has one list of the fields that the rest of a run depends on. The list expands to the definition of the
   fields and to the table of fields of its sections:

     #define TRAX_THING_STATE(X, S) X(S, uint32_t, count, ) X(S, uint64_t, since, [4])
     struct trax_thing { TRAX_THING_STATE(TRAX_FIELD, ) uint32_t size; };
     static const struct trax_field thing_fields[] = {TRAX_THING_STATE(TRAX_FIELD_ROW, struct trax_thing)};

   Fields outside the list are set when the structure is created, or follow from the others between cycles. */
#ifndef TRAX_MACHINE_SECTION_H
#define TRAX_MACHINE_SECTION_H

#include <stddef.h>
#include <stdint.h>

struct trax_field {
  const char *type, *name; /* as in the source; the name is "" for an array of numbers */
  size_t offset, size;     /* bytes */
};

/* An array of structures or numbers. */
struct trax_section {
  const char *name;                /* of the structure, or of the pointer to the numbers */
  const struct trax_field *fields; /* [field_count]: those that a checkpoint stores; none if the data are derived */
  size_t field_count;
  void *bytes; /* [count][size] */
  size_t size, count;
};

typedef void trax_section_visitor(void *context, const struct trax_section *section);

#define TRAX_FIELD(S, TYPE, NAME, ARRAY) TYPE NAME ARRAY;
#define TRAX_FIELD_ROW(S, TYPE, NAME, ARRAY) {#TYPE, #NAME, offsetof(S, NAME), sizeof(((S *)0)->NAME)},

#endif
