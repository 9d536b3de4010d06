// The compiler's builtins as functions, for uses that take their address. If the instruction contains a number that is an
// argument of the function, a jump table has the instruction and a return for each number. Other numbers fault as there.
#include <trax/numbers.h>

#define READ(CONSTANT, NAME, NUMBER) rdsr r4, NUMBER; jalr r0, 0(r1);
#define CALL(CONSTANT, NAME, NUMBER) trap r4, NUMBER; jalr r0, 0(r1);

.macro function name
  .section .text.\name, "ax", @progbits
  .globl \name
  .type \name, @function
\name:
.endm

// No frame: docs/abi.md, "Stack sizes".
.macro end name
  .size \name, . - \name
  .section .stack_sizes, "o", @progbits, .text.\name
  .long \name
  .uleb128 0
.endm

function __builtin_trax_rsqrt
  frsqrt r4, r4
  jalr r0, 0(r1)
  end __builtin_trax_rsqrt

function __builtin_trax_ainc
  ainc r4, 0(r4)
  jalr r0, 0(r1)
  end __builtin_trax_ainc

function __builtin_trax_opaque
  jalr r0, 0(r1)
  end __builtin_trax_opaque

// Arguments are in r4 to r11 and on the stack.
function __builtin_trax_box
  lw r12, 0(r2)
  lw r13, 4(r2)
  lw r14, 8(r2)
  lw r15, 12(r2)
  lw r16, 16(r2)
  fbox r4, r5, r11
  jalr r0, 0(r1)
  end __builtin_trax_box

function __builtin_trax_triangle
  lw r12, 0(r2)
  lw r13, 4(r2)
  lw r14, 8(r2)
  lw r15, 12(r2)
  lw r16, 16(r2)
  lw r17, 20(r2)
  lw r18, 24(r2)
  lw r19, 28(r2)
  ftri r4, r5, r11
  jalr r0, 0(r1)
  end __builtin_trax_triangle

function __builtin_trax_halt
  halt
  end __builtin_trax_halt

function __builtin_trax_rdsr
  addi r12, r0, TRAX_SR_COUNT
  bgeu r4, r12, .Lillegal_register
  slli r4, r4, 3
  lui r12, %hi(.Lregisters)
  add r12, r12, r4
  jalr r0, %lo(.Lregisters)(r12)
.Lregisters:
  TRAX_SPECIAL_REGISTERS(READ)
.Lillegal_register:
  .word 0
  end __builtin_trax_rdsr

function __builtin_trax_trap
  addi r12, r0, TRAX_TRAP_COUNT
  bgeu r5, r12, .Lillegal_code
  slli r5, r5, 3
  lui r12, %hi(.Lcodes)
  add r12, r12, r5
  jalr r0, %lo(.Lcodes)(r12)
.Lcodes:
  TRAX_TRAPS(CALL)
.Lillegal_code:
  .word 0
  end __builtin_trax_trap
