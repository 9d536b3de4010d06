/* isa-oracle: answers lines of standard input, each an instruction's name and its operands in hexadecimal digits ("fadd
   3f800000 1"), with a line of eight such digits each. Exit status 1 at the first line that is not so. */
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "oracle.h"

static const struct {
  const char *name;
  uint32_t (*of_one)(uint32_t);
  uint32_t (*of_two)(uint32_t, uint32_t);
} functions[] = {
    {"fadd", NULL, oracle_fadd},
    {"fsub", NULL, oracle_fsub},
    {"fmul", NULL, oracle_fmul},
    {"fdiv", NULL, oracle_fdiv},
    {"fmin", NULL, oracle_fmin},
    {"fmax", NULL, oracle_fmax},
    {"feq", NULL, oracle_feq},
    {"flt", NULL, oracle_flt},
    {"fle", NULL, oracle_fle},
    {"frsqrt", oracle_frsqrt, NULL},
    {"sqrtf", oracle_fsqrt_rounded, NULL},
    {"fcvt.w.s", oracle_fcvt_w_s, NULL},
    {"fcvt.wu.s", oracle_fcvt_wu_s, NULL},
    {"fcvt.s.w", oracle_fcvt_s_w, NULL},
    {"fcvt.s.wu", oracle_fcvt_s_wu, NULL},
};

/* Returns whether the line is one, and its answer. */
static int answer(const char *line, uint32_t *result) {
  char name[16], rest[2];
  uint32_t a, b;
  int operands = sscanf(line, "%15s %8" SCNx32 " %8" SCNx32 " %1s", name, &a, &b, rest) - 1;
  for (size_t i = 0; i < sizeof functions / sizeof functions[0]; i++)
    if (strcmp(functions[i].name, operands >= 0 ? name : "") == 0) {
      if (operands != (functions[i].of_one ? 1 : 2))
        return 0;
      *result = functions[i].of_one ? functions[i].of_one(a) : functions[i].of_two(a, b);
      return 1;
    }
  return 0;
}

int main(void) {
  char line[128];
  for (unsigned long number = 1; fgets(line, sizeof line, stdin); number++) {
    uint32_t result;
    if (!answer(line, &result)) {
      fprintf(stderr, "isa-oracle: line %lu is not an instruction's name and its operands: %s\n", number, line);
      return 1;
    }
    printf("%08" PRIx32 "\n", result);
  }
  return ferror(stdin) || fflush(stdout) == EOF;
}
