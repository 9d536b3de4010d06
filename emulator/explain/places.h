/* The place of each instruction in the program's source, looked up once. */
#ifndef TRAX_EXPLAIN_PLACES_H
#define TRAX_EXPLAIN_PLACES_H

#include "machine/machine.h"

/* A function that contains an instruction: [0] is the innermost, which is inlined into [1], and so on. */
struct trax_frame_place {
  uint32_t function; /* of trax_places_name */
  uint32_t line;     /* of trax_places_name: "file:line", or 0: unknown */
};

struct trax_place {
  const struct trax_frame_place *frames;
  uint32_t frame_count; /* at least 1 */
  const char *symbol;   /* NULL: none */
  uint32_t offset;      /* from the symbol */
};

struct trax_places;

struct trax_places *trax_places_create(const trax_machine *machine); /* NULL: out of memory */
void trax_places_destroy(struct trax_places *places);

/* Instructions are numbered through all executable segments. Two more indices follow: the place of a halted thread, and
   every address that is no text. */
uint32_t trax_places_count(const struct trax_places *places); /* without these two */
uint32_t trax_places_index(const struct trax_places *places, uint32_t pc);
uint32_t trax_places_pc(const struct trax_places *places, uint32_t index);
/* Neighbouring instructions. */
struct trax_places_range {
  uint32_t address, count;
  uint32_t first; /* the index of the first one */
};
/* The range that contains a pc; NULL: none. */
const struct trax_places_range *trax_places_range(const struct trax_places *places, uint32_t pc);
/* The index of a pc, if it is probably in the range in which the latest one was. */
static inline uint32_t trax_places_index_again(const struct trax_places *places, uint32_t pc,
                                               const struct trax_places_range **latest) {
  if (!*latest || (pc - (*latest)->address) / 4 >= (*latest)->count)
    *latest = trax_places_range(places, pc);
  return *latest ? (*latest)->first + (pc - (*latest)->address) / 4 : trax_places_count(places) + 1;
}
const trax_inst *trax_places_inst(const struct trax_places *places, uint32_t index);
/* [count + 2]: how the instruction accesses memory. */
enum trax_access_class { TRAX_ACCESS_NONE, TRAX_ACCESS_LOAD, TRAX_ACCESS_STORE, TRAX_ACCESS_PAST_CACHE };
const uint8_t *trax_places_accesses(const struct trax_places *places);
/* [count + 2]: the trax_cause of its refusals after its fetch: of its unit, or of a bank of the data cache. */
const uint8_t *trax_places_refusals(const struct trax_places *places);
static inline uint32_t trax_places_halted(const struct trax_places *places) {
  return trax_places_count(places);
}

/* Valid until the places are destroyed. */
const struct trax_place *trax_places_at(struct trax_places *places, uint32_t index);
/* Names are numbered from 1; equal names have the same number. 0 is "". */
const char *trax_places_name(const struct trax_places *places, uint32_t name);
uint32_t trax_places_names(const struct trax_places *places);
/* "symbol+0x10", "symbol" or "0x00001234". */
const char *trax_places_symbol(struct trax_places *places, uint32_t pc, char *text, size_t size);

#endif
