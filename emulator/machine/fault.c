#include "machine/fault.h"

const char *trax_fault_text(trax_fault_kind kind) {
  static const char *const texts[TRAX_FAULT_COUNT] = {
#define TEXT(ID, NAME, WORDS) WORDS,
      TRAX_FAULTS(TEXT)
#undef TEXT
  };
  return texts[kind];
}

const char *trax_fault_name(trax_fault_kind kind) {
  static const char *const names[TRAX_FAULT_COUNT] = {
#define NAME(ID, WORD, WORDS) WORD,
      TRAX_FAULTS(NAME)
#undef NAME
  };
  return names[kind];
}
