/* Counts the instructions of a program. It reads the log of qemu's user emulation (-d in_asm,exec,nochain) from
   standard input: a translated block is listed before its first execution, and each execution is a line with its
   address. */
#include <inttypes.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SLOTS = 1 << 16 }; /* more than the blocks of a kernel */

static struct block {
  uint64_t address, instructions;
} blocks[SLOTS];

static struct block *find(uint64_t address) {
  for (size_t i = 0; i < SLOTS; i++) {
    struct block *block = &blocks[((address >> 6) + i) % SLOTS];
    if (block->address == 0)
      block->address = address;
    if (block->address == address)
      return block;
  }
  exit(1);
}

int main(void) {
  static char line[4096];
  uint64_t executed = 0, listed = 0;
  while (fgets(line, sizeof line, stdin)) {
    if (strncmp(line, "0x", 2) == 0) {
      listed++;
    } else if (strncmp(line, "Trace ", 6) == 0) {
      struct block *block = find(strtoull(strchr(line, ':') + 1, NULL, 16));
      if (listed)
        block->instructions = listed;
      listed = 0;
      executed += block->instructions;
    }
  }
  printf("instructions %" PRIu64 "\n", executed);
  return 0;
}
