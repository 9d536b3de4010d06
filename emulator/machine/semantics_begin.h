/* Defines the names that the instructions' semantics use (isa/TraxFormats.td). It is included before
   trax/semantics.inc; machine/semantics_end.h, included after it, undefines them. The including function has `reg`, the
   thread's registers, `inst`, a pointer to the decoded instruction, and `next_pc`. It defines the other names itself:
   PC, LOAD(ADDRESS, BYTES), STORE(ADDRESS, VALUE, BYTES), ATOMIC_INC, SPECIAL_REGISTER, TRAP, FENCE, HALT, and
   PRECISION, the bits of the special unit's results. */
#define RD reg[inst->rd]
#define RA reg[inst->ra]
#define RB reg[inst->rb]
#define GROUP_A(N) reg[(inst->ra + (N)) & 31]
#define GROUP_B(N) reg[(inst->rb + (N)) & 31]
#define IMM ((uint32_t)inst->imm)
#define NEXT_PC next_pc
#define LOAD8(ADDRESS) LOAD(ADDRESS, 1u)
#define LOAD16(ADDRESS) LOAD(ADDRESS, 2u)
#define LOAD32(ADDRESS) LOAD(ADDRESS, 4u)
#define LOAD32_NONTEMPORAL(ADDRESS) LOAD32(ADDRESS)
#define STORE8(ADDRESS, VALUE) STORE(ADDRESS, VALUE, 1u)
#define STORE16(ADDRESS, VALUE) STORE(ADDRESS, VALUE, 2u)
#define STORE32(ADDRESS, VALUE) STORE(ADDRESS, VALUE, 4u)
#define STORE32_NONTEMPORAL(ADDRESS, VALUE) STORE32(ADDRESS, VALUE)
#define FPDIV(A, B) trax_reduce_precision(trax_fdiv(A, B), PRECISION)
#define ISQRT(A) trax_reduce_precision(trax_frsqrt(A), PRECISION)
