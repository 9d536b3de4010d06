/* The state of an engine as sections, for rollback and checkpoints.

   A structure has one list of the fields that the rest of a run depends on. The list expands to the definition of the
   fields and to the table of fields of its sections:

     #define TRAX_THING_STATE(X, S) X(S, uint32_t, count, ) X(S, uint64_t, since, [4])
     struct trax_thing { TRAX_THING_STATE(TRAX_FIELD, ) uint32_t size; };
     TRAX_VISIT_ALL(trax_thing, TRAX_THING_STATE, things, count);

   Fields outside the list are set when the structure is created, or follow from the others between cycles. */
#ifndef TRAX_MACHINE_SECTION_H
#define TRAX_MACHINE_SECTION_H

#include <stdbool.h>
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
  bool within; /* the bytes are also those of another section */
};

typedef void trax_section_visitor(void *context, const struct trax_section *section);

struct trax_visitor {
  trax_section_visitor *visit;
  void *context;
};

#define TRAX_FIELD(S, TYPE, NAME, ARRAY) TYPE NAME ARRAY;
#define TRAX_FIELD_ROW(S, TYPE, NAME, ARRAY) {#TYPE, #NAME, offsetof(S, NAME), sizeof(((S *)0)->NAME)},

/* For a function with a parameter `visitor`: visit an array of structures with the list of their fields; one within
   another section; no structure, but the fields of one that is only a field of others are in the layout; an array of
   numbers; structures of statistics, each as one field, whose counters are part of the layout's sources; data that
   follow from the rest, which are part of a snapshot, but not of a checkpoint. */
#define TRAX_VISIT(...) visitor->visit(visitor->context, &(struct trax_section){__VA_ARGS__})
#define TRAX_VISIT_STRUCTS(NAME, LIST, POINTER, COUNT, WITHIN)                                                         \
  do {                                                                                                                 \
    static const struct trax_field fields_[] = {LIST(TRAX_FIELD_ROW, struct NAME)};                                    \
    TRAX_VISIT(#NAME, fields_, sizeof fields_ / sizeof *fields_, POINTER, sizeof(struct NAME), COUNT, WITHIN);         \
  } while (0)
#define TRAX_VISIT_ALL(NAME, LIST, POINTER, COUNT) TRAX_VISIT_STRUCTS(NAME, LIST, POINTER, COUNT, false)
#define TRAX_VISIT_WITHIN(NAME, LIST, POINTER, COUNT) TRAX_VISIT_STRUCTS(NAME, LIST, POINTER, COUNT, true)
#define TRAX_VISIT_NONE(NAME, LIST) TRAX_VISIT_ALL(NAME, LIST, NULL, 0)
#define TRAX_VISIT_NUMBERS(TYPE, POINTER, COUNT)                                                                       \
  TRAX_VISIT(#POINTER, &(const struct trax_field){#TYPE, "", 0, sizeof(TYPE)}, 1, 1 ? (POINTER) : (TYPE *)NULL,        \
             sizeof(TYPE), COUNT, false)
#define TRAX_VISIT_COUNTERS(NAME, POINTER, COUNT)                                                                      \
  TRAX_VISIT(#NAME, &(const struct trax_field){"uint64_t", "", 0, sizeof(struct NAME)}, 1, POINTER,                    \
             sizeof(struct NAME), COUNT, false)
#define TRAX_VISIT_DERIVED(POINTER, COUNT) TRAX_VISIT(#POINTER, NULL, 0, POINTER, sizeof *(POINTER), COUNT, false)

#endif
