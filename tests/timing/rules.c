#include "rules.h"

#define LOCKSTEP "icache.ports_per_bank=64 icache.tps_per_cache=64"

/* chapter, rule, base, settings, cycles, fault, issues, charges, words */
#define RULE(CHAPTER, NAME, BASE, SET, CYCLES, FAULT, ISSUES, CHARGES, ...)                                            \
  rules[n++] = (struct rule) {                                                                                         \
    CHAPTER, NAME, BASE, SET, CYCLES, TRAX_FAULT_##FAULT, ISSUES, CHARGES, NULL, false,                                \
        sizeof((uint32_t[]){__VA_ARGS__}) / 4, {                                                                       \
      __VA_ARGS__                                                                                                      \
    }                                                                                                                  \
  }

/* A further program for the rules of the chapter, which the page does not have. */
#define CASE(...)                                                                                                      \
  RULE(__VA_ARGS__);                                                                                                   \
  rules[n - 1].is_unlisted = true

/* Counters of the chip, and words of memory at DATA + n as word<n>, after the rule before it. */
#define COUNTS(TEXT) rules[n - 1].counts = TEXT

/* bench_near: the only instruction line is asked for in cycle 0 and there in cycle 1. Data asked for in t is there in
   t + 1.

   bench_far: the first instruction line (16 instructions) takes the bus in 0..3 and is there in 104. A data line asked
   for in t is there in t + 104, a word past the cache or an atomic increment in t + 101. */
const struct rule *timing_rules(size_t *count) {
  static struct rule rules[200];
  size_t n = 0;

  /* --- Words --- */
  RULE("Words", "a result of latency 1 can be used in the next cycle", NEAR, "", 4, NONE, "1 2 3", "icache_miss=1",
       I(ADDI, 1, 0, 7), R(ADD, 2, 1, 1), HALT);
  COUNTS("icache_hits=2 icache_misses=1");
  /* Cycle 1: all ask, TP 0 wins. It asks again from 2 on: TP 1's turn, TP 2's, its own. */
  RULE("Words", "round robin: the winner goes to the back", NEAR, "chip.tps_per_tm=3 " LOCKSTEP, 11, NONE,
       "1 4 7 8 / 2 5 8 9 / 3 6 9 10", "icache_miss=3 fp_add_conflict=15", R(FADD, 1, 0, 0), R(FSUB, 2, 0, 0),
       R(FADD, 3, 0, 0), HALT);
  /* rdsr 1, bne 2. TP 0 alone has the adder in 3, nobody in 4. In 5 both ask: it is TP 1's turn. */
  RULE("Words", "round robin: the pointer stays when nobody asks", NEAR, "chip.tps_per_tm=2 " LOCKSTEP, 8, NONE,
       "1 2 3 4 6 7 / 1 2 3 4 5 6", "icache_miss=2 fp_add_conflict=1", U(RDSR, 1, TRAX_SR_TP), B(BNE, 1, 0, 12),
       R(FADD, 2, 0, 0), J(0, 12), NOP, NOP, R(FADD, 3, 0, 0), HALT);

  /* --- Start and end --- */
  RULE("Start and end", "the run ends with the first cycle in which every thread has ended", NEAR, "", 2, NONE, "1",
       "icache_miss=1", HALT);
  /* 0.1 bytes a cycle: the line is through in 640, there in 740. The run of 4 bytes is written by halt: 742..781. */
  RULE("Start and end", "the last stores are part of the run", FAR, "memory.bandwidth_gbps=0.05", 782, NONE,
       "740 741 742", "icache_miss=740 halted=39", U(LUI, 1, 1), S(SW, 1, 1, 0), HALT);

  /* --- A cycle --- */
  RULE("A cycle", "what arrives in t can be used by an instruction issued in t", NEAR, "", 5, NONE, "1 2 3 4",
       "icache_miss=1", U(LUI, 1, 1), I(LW, 2, 1, 0), R(ADD, 3, 2, 2), HALT);
  /* In 5 TP 0 stores 7 and TP 1 loads it; what it got is there in 6, and the branch goes past the nop. */
  RULE("A cycle", "a load sees what a lower TP stored in its cycle", NEAR, "chip.tps_per_tm=2 " LOCKSTEP, 8, NONE,
       "1 2 3 4 5 6 / 1 2 3 4 5 6 7", "icache_miss=2", U(RDSR, 1, TRAX_SR_TP), U(LUI, 2, 1), I(ADDI, 4, 0, 7),
       B(BNE, 1, 0, 12), S(SWNT, 4, 2, 0), HALT, I(LWNT, 3, 2, 0), B(BNE, 3, 0, 8), NOP, HALT);
  /* The other way round: TP 0 gets 0. */
  RULE("A cycle", "a load does not see what a higher TP stores in its cycle", NEAR, "chip.tps_per_tm=2 " LOCKSTEP, 9,
       NONE, "1 2 3 4 5 6 7 8 / 1 2 3 4 5 6", "icache_miss=2", U(RDSR, 1, TRAX_SR_TP), U(LUI, 2, 1), I(ADDI, 4, 0, 7),
       B(BEQ, 1, 0, 12), S(SWNT, 4, 2, 0), HALT, I(LWNT, 3, 2, 0), B(BNE, 3, 0, 8), NOP, HALT);
  /* In 5 TP 0 increments and TP 1 stores 5: TP 1 loads 6 in 6 and takes the branch. */
  RULE("A cycle", "atomic increments follow all stores of their cycle", NEAR, "chip.tps_per_tm=2 " LOCKSTEP, 10, NONE,
       "1 2 3 4 5 6 / 1 2 3 4 5 6 7 8 9", "icache_miss=2", U(RDSR, 1, TRAX_SR_TP), U(LUI, 2, 1), I(ADDI, 4, 0, 5),
       B(BNE, 1, 0, 12), I(AINC, 6, 2, 0), HALT, S(SWNT, 4, 2, 0), I(LWNT, 3, 2, 0), I(ADDI, 5, 3, -6), B(BEQ, 5, 0, 8),
       NOP, HALT);
  /* One bank. TPs fetch by turns: TP 0 rdsr 1, bne 2, fdiv 4; TP 1 rdsr 1, bne 3, nop 5. TP 0 fetches its second fdiv
     in 6 and keeps it to 12, when the unit is free; TP 1 has the bank from 7 on. */
  RULE("A cycle", "an instruction that was refused is not fetched again", NEAR,
       "chip.tps_per_tm=2 icache.banks=1 special.pipelined=false", 14, NONE, "1 2 4 12 13 / 1 3 5 7 8 9 10",
       "icache_miss=1 icache_bank_conflict=6 special_conflict=6", U(RDSR, 1, TRAX_SR_TP), B(BNE, 1, 0, 16),
       R(FDIV, 2, 0, 0), R(FDIV, 3, 0, 0), HALT, NOP, NOP, NOP, NOP, HALT);

  /* --- Fetch --- */
  /* Cycle 0: TP 0 wins bank 0. 1: TP 0 by the line, TP 1 by the bank. 2: both want bank 1. Then TP 1 follows. */
  RULE("Fetch", "a bank serves one fetch a cycle", NEAR, "chip.tps_per_tm=2", 7, NONE, "1 2 3 4 5 / 1 3 4 5 6",
       "icache_miss=1 icache_bank_conflict=2", NOP, NOP, NOP, NOP, HALT);
  RULE("Fetch", "a bank's losers wait for their turn", NEAR, "chip.tps_per_tm=8", 8, NONE,
       "1 / 1 / 2 / 3 / 4 / 5 / 6 / 7", "icache_miss=1 icache_bank_conflict=28", HALT);
  /* Cycle 1: TP 0 by the line, TP 1 by the bank, whose pointer is then at 2. */
  RULE("Fetch", "turns go on when all have been served", NEAR, "chip.tps_per_tm=4 icache.banks=1", 12, NONE,
       "1 4 8 / 1 5 9 / 2 6 10 / 3 7 11", "icache_miss=1 icache_bank_conflict=29", NOP, NOP, HALT);
  /* TP 0 branches in 2 to index 4, TP 1 goes on to 2: other banks. */
  RULE("Fetch", "neighbouring instructions are in neighbouring banks", NEAR, "chip.tps_per_tm=2", 6, NONE,
       "1 2 3 / 1 3 4 5", "icache_miss=1 icache_bank_conflict=2", U(RDSR, 1, TRAX_SR_TP), B(BEQ, 1, 0, 12), NOP, HALT,
       HALT);
  RULE("Fetch", "the banks are icache.banks", NEAR, "chip.tps_per_tm=2 icache.banks=1", 7, NONE, "1 2 4 / 1 3 5 6",
       "icache_miss=1 icache_bank_conflict=4", U(RDSR, 1, TRAX_SR_TP), B(BEQ, 1, 0, 12), NOP, HALT, HALT);
  /* Cycle 0: TP 0 misses, TP 1 merges, TP 2 is refused; 2: bank 1 serves TPs 0 and 1. */
  RULE("Fetch", "a bank serves icache.ports_per_bank", NEAR, "chip.tps_per_tm=3 icache.ports_per_bank=2", 5, NONE,
       "1 2 3 / 1 2 3 / 1 3 4", "icache_miss=2 icache_bank_conflict=2", NOP, NOP, HALT);
  COUNTS("icache_misses=1 icache_merged=1");
  RULE("Fetch", "each group has a cache of its own", NEAR, "chip.tps_per_tm=4 icache.tps_per_cache=2", 5, NONE,
       "1 2 3 / 1 3 4 / 1 2 3 / 1 3 4", "icache_miss=2 icache_bank_conflict=4", NOP, NOP, HALT);
  COUNTS("icache_misses=2 instruction_read_bytes=2048");
  RULE("Fetch", "a line serves all that wait for it when it arrives, without a bank", NEAR, "chip.tps_per_tm=2", 2,
       NONE, "1 / 1", "icache_miss=1 icache_bank_conflict=1", HALT);
  /* Lines of 8 instructions and 2 cycles: there in 102; the second is asked for in 110. */
  RULE("Fetch", "a line that is not present comes from memory", FAR, "icache.line_bytes=32", 214, NONE,
       "102 103 104 105 106 107 108 109 212 213", "icache_miss=204", NOP, NOP, NOP, NOP, NOP, NOP, NOP, NOP, NOP, HALT);
  COUNTS("instruction_read_bytes=64");
  RULE("Fetch", "a line that is on its way is not asked for again", FAR, "chip.tps_per_tm=2", 105, NONE, "104 / 104",
       "icache_miss=208", HALT);
  /* The same line for the second cache comes 4 cycles later. */
  RULE("Fetch", "a line serves the TPs of the cache that asked for it", FAR, "chip.tps_per_tm=2 icache.tps_per_cache=1",
       109, NONE, "104 / 108", "icache_miss=212", HALT);
  /* TP 0's line has the only place in 0..103. */
  RULE("Fetch", "a miss needs a place in the memory queue", FAR,
       "chip.tps_per_tm=2 icache.tps_per_cache=1 memory.queue_depth=1", 209, NONE, "104 / 208",
       "icache_miss=208 memory_queue_full=104", HALT);
  /* In 107 TP 1 misses index 16 and TP 0 wants the place for lwnt; it gets it when the line is there, in 211. */
  RULE("Fetch", "fetches take their places before loads and stores", FAR, "chip.tps_per_tm=2 memory.queue_depth=1", 213,
       NONE, "104 105 106 211 212 / 104 105 106 211", "icache_miss=312 memory_queue_full=104", U(LUI, 2, 1),
       U(RDSR, 1, TRAX_SR_TP), B(BNE, 1, 0, 56), I(LWNT, 3, 2, 0), HALT, NOP, NOP, NOP, NOP, NOP, NOP, NOP, NOP, NOP,
       NOP, NOP, HALT);
  /* Lines 0, 2 and again 0 of 16 instructions, in a cache for two: in one of two sets, then in one set of two. */
  RULE("Fetch", "a line has its set by its number", FAR, "icache.bytes=128", 315, NONE, "104 209 314",
       "icache_miss=312", J(1, 128), HALT, NOP, NOP, NOP, NOP, NOP, NOP, NOP, NOP, NOP, NOP, NOP, NOP, NOP, NOP, NOP,
       NOP, NOP, NOP, NOP, NOP, NOP, NOP, NOP, NOP, NOP, NOP, NOP, NOP, NOP, NOP, I(JALR, 0, 1, 0));
  RULE("Fetch", "a set has icache.ways places", FAR, "icache.bytes=128 icache.ways=2", 211, NONE, "104 209 210",
       "icache_miss=208", J(1, 128), HALT, NOP, NOP, NOP, NOP, NOP, NOP, NOP, NOP, NOP, NOP, NOP, NOP, NOP, NOP, NOP,
       NOP, NOP, NOP, NOP, NOP, NOP, NOP, NOP, NOP, NOP, NOP, NOP, NOP, NOP, NOP, I(JALR, 0, 1, 0));
  RULE("Fetch", "a pc outside the text faults without a bank", NEAR, "", 3, EXECUTE, "1", "icache_miss=1", NOP);
  RULE("Fetch", "a pc that is not a multiple of 4 faults", NEAR, "", 3, MISALIGNED_PC, "1", "icache_miss=1",
       I(JALR, 0, 0, TEXT + 2), HALT);

  /* --- Operands --- */
  RULE("Operands", "instructions stall on use", NEAR, "", 11, NONE, "1 2 3 9 10", "icache_miss=1 wait_special=5",
       R(FDIV, 1, 0, 0), NOP, NOP, R(ADD, 2, 0, 1), HALT);
  RULE("Operands", "results do not overtake one another", NEAR, "", 13, NONE, "1 9 10 11 12",
       "icache_miss=1 wait_special=7", R(FDIV, 1, 0, 0), I(ADDI, 1, 0, 5), U(LUI, 2, 1), S(SW, 1, 2, 0), HALT);
  COUNTS("word0=5");
  RULE("Operands", "nobody waits for the sources of an earlier instruction", NEAR, "", 5, NONE, "1 2 3 4",
       "icache_miss=1", R(FDIV, 1, 2, 3), I(ADDI, 2, 0, 1), I(ADDI, 3, 0, 1), HALT);
  RULE("Operands", "r0 is always usable", NEAR, "", 4, NONE, "1 2 3", "icache_miss=1", R(FDIV, 0, 2, 3),
       R(ADD, 4, 0, 0), HALT);
  /* fdiv 1, usable 9; fmul 2, usable 14: for ra in 3..8, for rb in 9..13. */
  RULE("Operands", "the first register is blamed: ra before rb", NEAR, "fpu.mul_latency_cycles=12", 16, NONE,
       "1 2 14 15", "icache_miss=1 wait_special=6 wait_other=5", R(FDIV, 1, 0, 0), R(FMUL, 2, 0, 0), R(ADD, 3, 1, 2),
       HALT);
  RULE("Operands", "ra alone is blamed if it is usable last", NEAR, "fpu.mul_latency_cycles=12", 16, NONE, "1 2 14 15",
       "icache_miss=1 wait_other=11", R(FDIV, 1, 0, 0), R(FMUL, 2, 0, 0), R(ADD, 3, 2, 1), HALT);
  RULE("Operands", "the first register is blamed: rb before rd", NEAR, "fpu.mul_latency_cycles=12", 16, NONE,
       "1 2 14 15", "icache_miss=1 wait_special=6 wait_other=5", R(FDIV, 1, 0, 0), R(FMUL, 2, 0, 0), R(ADD, 2, 0, 1),
       HALT);
  RULE("Operands", "a conditional move reads its destination", NEAR, "", 11, NONE, "1 9 10",
       "icache_miss=1 wait_special=7", R(FDIV, 1, 0, 0), R(CMOVNZ, 1, 0, 0), HALT);
  RULE("Operands", "a group of registers is waited for", NEAR, "ray.units_per_group=1", 11, NONE, "1 9 10",
       "icache_miss=1 wait_special=7", R(FDIV, 9, 0, 0), R(FBOX, 1, 4, 12), HALT);
  RULE("Operands", "behind r31 it has r0, r1 and so on", NEAR, "ray.units_per_group=1", 11, NONE, "1 9 10",
       "icache_miss=1 wait_special=7", R(FDIV, 3, 0, 0), R(FBOX, 10, 4, 30), HALT);
  RULE("Operands", "but no register behind its last", NEAR, "ray.units_per_group=1", 4, NONE, "1 2 3", "icache_miss=1",
       R(FDIV, 10, 0, 0), R(FBOX, 1, 4, 11), HALT);
  RULE("Operands", "wait for local memory", NEAR, "tp.local_latency_cycles=4", 7, NONE, "1 5 6",
       "icache_miss=1 wait_local=3", I(LBU, 1, 0, -512), R(ADD, 2, 1, 1), HALT);
  /* lw 105 there 209; lw 210 usable 213. */
  RULE("Operands", "wait for memory and for the data cache", FAR, "dcache.hit_latency_cycles=3", 215, NONE,
       "104 105 209 210 213 214", "icache_miss=104 wait_memory=103 wait_dcache_hit=2", U(LUI, 1, 1), I(LW, 2, 1, 0),
       R(ADD, 3, 2, 2), I(LW, 4, 1, 60), R(ADD, 5, 4, 4), HALT);
  RULE("Operands", "a hit of two cycles costs its next user one", FAR, "dcache.hit_latency_cycles=2", 214, NONE,
       "104 105 209 210 212 213", "icache_miss=104 wait_memory=103 wait_dcache_hit=1", U(LUI, 1, 1), I(LW, 2, 1, 0),
       R(ADD, 3, 2, 2), I(LW, 4, 1, 60), R(ADD, 5, 4, 4), HALT);
  COUNTS("dcache_misses=1 dcache_hits=1 data_read_bytes=64");
  RULE("Operands", "wait for an atomic increment", FAR, "", 208, NONE, "104 105 206 207",
       "icache_miss=104 wait_atomic=100", U(LUI, 1, 1), I(AINC, 2, 1, 0), R(ADD, 3, 2, 2), HALT);
  RULE("Operands", "an illegal instruction faults before its operands are looked at", NEAR, "", 3, ILLEGAL, "1",
       "icache_miss=1", R(FDIV, 1, 0, 0), U(RDSR, 1, 0) | TRAX_SR_COUNT, HALT);
  /* 0 / 0 is 0x7FC00000, usable in 9. */
  RULE("Operands", "a fence of another number is illegal", NEAR, "", 3, ILLEGAL, "1", "icache_miss=1", NOP,
       FENCE(RW) + 1, HALT);
  RULE("Operands", "an access that is not allowed faults when its operands are usable", NEAR, "", 10, UNMAPPED, "1",
       "icache_miss=1 wait_special=7", R(FDIV, 1, 0, 0), I(LW, 2, 1, 0), HALT);

  /* --- Units --- */
  /* fadd 1, use 4; fmul, use 8; feq, use 10; mul, use 15; add, use 21. */
  RULE("Units", "each unit has its latency", NEAR,
       "fpu.add_latency_cycles=3 fpu.mul_latency_cycles=4 fpu.compare_latency_cycles=2 int_mul.latency_cycles=5 "
       "tp.int_latency_cycles=6",
       23, NONE, "1 4 8 10 15 21 22", "icache_miss=1 wait_other=15", R(FADD, 1, 0, 0), R(FMUL, 2, 1, 1),
       R(FEQ, 3, 2, 2), R(MUL, 4, 3, 3), R(ADD, 5, 4, 4), R(ADD, 6, 5, 5), HALT);
  RULE("Units", "a latency may be long", NEAR, "fpu.add_latency_cycles=1000", 1003, NONE, "1 1001 1002",
       "icache_miss=1 wait_other=999", R(FADD, 1, 0, 0), R(ADD, 2, 1, 1), HALT);
  RULE("Units", "a unit accepts one instruction a cycle, whatever its latency", NEAR, "fpu.add_latency_cycles=5", 4,
       NONE, "1 2 3", "icache_miss=1", R(FADD, 1, 0, 0), R(FADD, 2, 0, 0), HALT);
  RULE("Units", "8 TPs share an adder", NEAR, "chip.tps_per_tm=9 " LOCKSTEP, 10, NONE,
       "1 2 / 2 3 / 3 4 / 4 5 / 5 6 / 6 7 / 7 8 / 8 9 / 1 2", "icache_miss=9 fp_add_conflict=28", R(FADD, 1, 0, 0),
       HALT);
  COUNTS("fp_add_ops=9 flops=9");
  RULE("Units", "8 TPs share a multiplier", NEAR, "chip.tps_per_tm=16 " LOCKSTEP, 10, NONE, NULL,
       "icache_miss=16 fp_mul_conflict=56", R(FMUL, 1, 0, 0), HALT);
  RULE("Units", "or fpu.tps_per_cluster", NEAR, "chip.tps_per_tm=8 fpu.tps_per_cluster=4 " LOCKSTEP, 6, NONE,
       "1 2 / 2 3 / 3 4 / 4 5 / 1 2 / 2 3 / 3 4 / 4 5", "icache_miss=8 fp_add_conflict=12", R(FADD, 1, 0, 0), HALT);
  /* TPs 0..3 add and 4..7 multiply in 4. */
  RULE("Units", "adder and multiplier are two", NEAR, "chip.tps_per_tm=8 " LOCKSTEP, 9, NONE,
       "1 2 3 4 5 / 1 2 3 5 6 / 1 2 3 6 7 / 1 2 3 7 8 / 1 2 3 4 5 / 1 2 3 5 6 / 1 2 3 6 7 / 1 2 3 7 8",
       "icache_miss=8 fp_add_conflict=6 fp_mul_conflict=6", U(RDSR, 1, TRAX_SR_TP), I(SLTI, 2, 1, 4), B(BNE, 2, 0, 12),
       R(FMUL, 3, 0, 0), HALT, R(FADD, 3, 0, 0), HALT);
  RULE("Units", "16 TPs share an integer multiplier", NEAR, "chip.tps_per_tm=32 " LOCKSTEP, 18, NONE, NULL,
       "icache_miss=32 int_mul_conflict=240", R(MULH, 1, 0, 0), HALT);
  RULE("Units", "comparisons and conversions execute on the adder", NEAR, "chip.tps_per_tm=2 " LOCKSTEP, 6, NONE,
       "1 3 4 / 2 4 5", "icache_miss=2 fp_add_conflict=3", R(FMIN, 1, 0, 0), R1(FCVT_W_S, 2, 0), HALT);
  RULE("Units", "or, with fpu.compare_units, on the TP's own units, but additions do not", NEAR,
       "chip.tps_per_tm=2 fpu.compare_units=true " LOCKSTEP, 6, NONE, "1 2 3 4 / 1 2 4 5",
       "icache_miss=2 fp_add_conflict=1", R(FMIN, 1, 0, 0), R1(FCVT_W_S, 2, 0), R(FADD, 3, 0, 0), HALT);
  RULE("Units", "a comparison has its latency there, too", NEAR,
       "fpu.compare_units=true fpu.add_latency_cycles=3 fpu.compare_latency_cycles=2", 8, NONE, "1 2 3 4 6 7",
       "icache_miss=1 wait_other=1", R(FLT, 1, 0, 0), R(FADD, 2, 0, 0), R(FADD, 3, 0, 0), R(XOR, 4, 1, 1),
       R(XOR, 5, 3, 3), HALT);
  COUNTS("fp_add_ops=2");
  RULE("Units", "the TM's FPDIV/iSQRT unit accepts an instruction a cycle", NEAR, "chip.tps_per_tm=4 " LOCKSTEP, 6,
       NONE, "1 2 / 2 3 / 3 4 / 4 5", "icache_miss=4 special_conflict=6", R(FDIV, 1, 0, 0), HALT);
  RULE("Units", "or is taken for its latency", NEAR, "chip.tps_per_tm=4 special.pipelined=false " LOCKSTEP, 27, NONE,
       "1 2 / 9 10 / 17 18 / 25 26", "icache_miss=4 special_conflict=48", R(FDIV, 1, 0, 0), HALT);
  COUNTS("icache_hits=4 icache_misses=1 icache_merged=3");
  RULE("Units", "as many are served as there are free units", NEAR,
       "chip.tps_per_tm=4 special.units_per_tm=2 special.pipelined=false " LOCKSTEP, 11, NONE,
       "1 2 / 1 2 / 9 10 / 9 10", "icache_miss=4 special_conflict=16", R1(FRSQRT, 1, 0), HALT);
  RULE("Units", "each of two units accepts an instruction a cycle", NEAR,
       "chip.tps_per_tm=4 special.units_per_tm=2 " LOCKSTEP, 4, NONE, "1 2 / 1 2 / 2 3 / 2 3",
       "icache_miss=4 special_conflict=2", R(FDIV, 1, 0, 0), HALT);
  /* 1 / 3 is 0x3EAAAAAB, of 8 bits 0x3EAB0000. */
  RULE("Units", "a result has 24 bits", NEAR, "", 13, NONE, "1 2 3 4 11 12", "icache_miss=1 wait_special=6",
       U(LUI, 1, 0x3F80), U(LUI, 2, 0x4040), R(FDIV, 3, 1, 2), U(LUI, 4, 1), S(SW, 3, 4, 0), HALT);
  COUNTS("word0=0x3EAAAAAB");
  RULE("Units", "or special.precision_bits", NEAR, "special.precision_bits=8", 13, NONE, "1 2 3 4 11 12",
       "icache_miss=1 wait_special=6", U(LUI, 1, 0x3F80), U(LUI, 2, 0x4040), R(FDIV, 3, 1, 2), U(LUI, 4, 1),
       S(SW, 3, 4, 0), HALT);
  COUNTS("word0=0x3EAB0000");
  RULE("Units", "a group may have several adders", NEAR, "chip.tps_per_tm=4 fpu.adders_per_cluster=2 " LOCKSTEP, 4,
       NONE, "1 2 / 1 2 / 2 3 / 2 3", "icache_miss=4 fp_add_conflict=2", R(FADD, 1, 0, 0), HALT);
  RULE("Units", "multipliers may have groups of their own", NEAR,
       "chip.tps_per_tm=4 fpu.mul_tps_per_cluster=2 " LOCKSTEP, 4, NONE, "1 2 / 2 3 / 1 2 / 2 3",
       "icache_miss=4 fp_mul_conflict=2", R(FMUL, 1, 0, 0), HALT);
  RULE("Units", "a group may have several integer multipliers", NEAR,
       "chip.tps_per_tm=3 int_mul.units_per_group=2 " LOCKSTEP, 4, NONE, "1 2 / 1 2 / 2 3",
       "icache_miss=3 int_mul_conflict=1", R(MUL, 1, 0, 0), HALT);
  RULE("Units", "conversions have their latency", NEAR, "fpu.convert_latency_cycles=4", 7, NONE, "1 5 6",
       "icache_miss=1 wait_other=3", R1(FCVT_S_W, 1, 0), R(ADD, 2, 1, 1), HALT);
  /* The unit is taken in 1..3, 4..11 and 12..14. */
  RULE("Units", "then for the latency of the instruction", NEAR,
       "special.pipelined=false special.rsqrt_latency_cycles=3", 17, NONE, "1 4 12 15 16",
       "icache_miss=1 special_conflict=9 wait_special=2", R1(FRSQRT, 1, 0), R(FDIV, 2, 0, 0), R1(FRSQRT, 3, 0),
       R(ADD, 4, 3, 3), HALT);
  RULE("Units", "a ray unit is taken for the test's interval", NEAR,
       "chip.tps_per_tm=2 ray.units_per_group=1 ray.triangle_interval_cycles=3 " LOCKSTEP, 6, NONE, "1 2 / 4 5",
       "icache_miss=2 ray_conflict=3", R(FTRI, 1, 4, 12), HALT);
  /* Taken in 1..2 and 3; the box's distance is usable in 3 + 5. */
  RULE("Units", "boxes and triangles have latencies of their own", NEAR,
       "ray.units_per_group=1 ray.triangle_interval_cycles=2 ray.box_latency_cycles=5 ray.triangle_latency_cycles=9",
       12, NONE, "1 3 8 10 11", "icache_miss=1 ray_conflict=1 wait_other=5", R(FTRI, 1, 4, 12), R(FBOX, 2, 4, 12),
       R(ADD, 3, 2, 2), R(ADD, 3, 1, 1), HALT);
  RULE("Units", "what needs a unit of which there is none is illegal", NEAR, "", 3, ILLEGAL, "1", "icache_miss=1",
       R(FDIV, 4, 0, 0), R(FBOX, 1, 4, 12), HALT);
  RULE("Units", "local memory is the TP's own", NEAR, "chip.tps_per_tm=3 " LOCKSTEP, 4, NONE, "1 2 3 / 1 2 3 / 1 2 3",
       "icache_miss=3", S(SW, 0, 0, -4), I(LW, 1, 0, -4), HALT);
  COUNTS("local_loads=3 local_stores=3 dcache_misses=0");
  RULE("Units", "lwnt and swnt of local memory are no other loads and stores", NEAR, "tp.local_latency_cycles=4", 8,
       NONE, "1 2 6 7", "icache_miss=1 wait_local=3", S(SWNT, 0, 0, -4), I(LWNT, 1, 0, -4), R(ADD, 2, 1, 1), HALT);
  RULE("Units", "a bubble follows an instruction whose next pc is not pc + 4", NEAR, "tp.branch_bubble_cycles=3", 11,
       NONE, "1 5 6 10", "icache_miss=1 branch_bubble=6", J(1, 12), NOP, NOP, B(BNE, 0, 0, 8), B(BEQ, 0, 0, 8), NOP,
       HALT);
  COUNTS("taken_branches=2");
  RULE("Units", "a branch to the next instruction is not taken", NEAR, "tp.branch_bubble_cycles=3", 3, NONE, "1 2",
       "icache_miss=1", B(BEQ, 0, 0, 4), HALT);
  COUNTS("taken_branches=0");

  /* --- Data cache --- */
  RULE("Data cache", "a bank serves one access a cycle", FAR, "chip.tps_per_tm=4", 211, NONE,
       "104 105 209 210 / 104 106 209 210 / 104 107 209 210 / 104 108 209 210",
       "icache_miss=416 dcache_bank_conflict=6 wait_memory=406", U(LUI, 1, 1), I(LW, 2, 1, 0), R(ADD, 3, 2, 2), HALT);
  COUNTS("dcache_misses=1 dcache_merged=3");
  /* The line is on the bus in 108..111. */
  RULE(
      "Data cache", "neighbouring words are in neighbouring banks", FAR, "chip.tps_per_tm=4 dcache.tps_per_bank=1", 112,
      NONE, "104 105 106 107 108 109 / 104 105 106 107 108 109 / 104 105 106 107 108 109 / 104 105 106 107 108 109",
      "icache_miss=416", U(LUI, 1, 1), U(RDSR, 2, TRAX_SR_TP), I(SLLI, 2, 2, 2), R(ADD, 1, 1, 2), I(LW, 3, 1, 0), HALT);
  COUNTS("dcache_misses=1");
  RULE("Data cache", "words 4 apart are in one of 4 banks", FAR, "chip.tps_per_tm=4 dcache.tps_per_bank=1", 113, NONE,
       "104 105 106 107 108 109 / 104 105 106 107 109 110 / 104 105 106 107 110 111 / 104 105 106 107 111 112",
       "icache_miss=416 dcache_bank_conflict=6", U(LUI, 1, 1), U(RDSR, 2, TRAX_SR_TP), I(SLLI, 2, 2, 4),
       R(ADD, 1, 1, 2), I(LW, 3, 1, 0), HALT);
  RULE("Data cache", "and each in another of 3", FAR, "chip.tps_per_tm=3 dcache.tps_per_bank=1", 112, NONE,
       "104 105 106 107 108 109 / 104 105 106 107 108 109 / 104 105 106 107 108 109", "icache_miss=312", U(LUI, 1, 1),
       U(RDSR, 2, TRAX_SR_TP), I(SLLI, 2, 2, 4), R(ADD, 1, 1, 2), I(LW, 3, 1, 0), HALT);
  /* 105 misses, there 209; 106 merges; 107 misses, on the bus in 109..112, there 213. */
  RULE("Data cache", "a miss does not stop the next one; a line on its way is merged with", FAR, "", 215, NONE,
       "104 105 106 107 209 210 213 214", "icache_miss=104 wait_memory=103", U(LUI, 1, 1), I(LW, 2, 1, 0),
       I(LW, 3, 1, 4), I(LW, 4, 1, 64), R(ADD, 5, 3, 3), R(ADD, 6, 2, 2), R(ADD, 7, 4, 4), HALT);
  COUNTS("dcache_misses=2 dcache_merged=1 data_read_bytes=128");
  RULE("Data cache", "who writes the target waits for the line, but not if it is r0", FAR, "", 211, NONE,
       "104 105 106 107 209 210", "icache_miss=104 wait_memory=101", U(LUI, 1, 1), I(LW, 0, 1, 0), R(ADD, 2, 0, 0),
       I(LW, 3, 1, 4), I(ADDI, 3, 0, 1), HALT);
  RULE("Data cache", "a miss needs a miss register", FAR, "dcache.mshrs=1", 315, NONE, "104 105 209 313 314",
       "icache_miss=104 memory_queue_full=103 wait_memory=103", U(LUI, 1, 1), I(LW, 2, 1, 0), I(LW, 3, 1, 64),
       R(ADD, 4, 3, 3), HALT);
  /* TP 0 misses in 109. From 110 on TP 1 (even cycles) and TP 0 (odd ones) have the bank by turns and are refused; in
     213 the register is free and it is TP 0's turn. TP 1 has it in 317; that line is on the bus in 317..320. */
  RULE("Data cache", "a load that is refused has used its bank, and the bank's pointer moved", FAR,
       "chip.tps_per_tm=2 dcache.mshrs=1", 321, NONE, "104 105 106 107 108 109 213 214 / 104 105 106 107 108 317 318",
       "icache_miss=208 dcache_bank_conflict=105 memory_queue_full=206", U(LUI, 1, 1), U(RDSR, 2, TRAX_SR_TP),
       I(SLLI, 3, 2, 6), R(ADD, 1, 1, 3), B(BNE, 2, 0, 16), I(LW, 3, 1, 0), I(LW, 4, 1, 128), HALT, I(LW, 3, 1, 0),
       HALT);
  /* Loads of A, of B 16 KiB on, and of A. */
  RULE("Data cache", "a line replaces another of its set", FAR, "", 423, NONE,
       "104 105 106 107 211 212 316 317 421 422", "icache_miss=104 wait_memory=309", U(LUI, 1, 1), U(LUI, 2, 1),
       I(ADDI, 2, 2, 0x4000), I(LW, 3, 1, 0), R(ADD, 4, 3, 3), I(LW, 3, 2, 0), R(ADD, 4, 3, 3), I(LW, 3, 1, 4),
       R(ADD, 4, 3, 3), HALT);
  RULE("Data cache", "unless the set has another place", FAR, "dcache.ways=2", 320, NONE,
       "104 105 106 107 211 212 316 317 318 319", "icache_miss=104 wait_memory=206", U(LUI, 1, 1), U(LUI, 2, 1),
       I(ADDI, 2, 2, 0x4000), I(LW, 3, 1, 0), R(ADD, 4, 3, 3), I(LW, 3, 2, 0), R(ADD, 4, 3, 3), I(LW, 3, 1, 4),
       R(ADD, 4, 3, 3), HALT);
  /* One set of two: A 105, B 210, A hits, C 317 takes A's place, B hits, A 424. */
  RULE("Data cache", "first in, first out", FAR, "dcache.bytes=128 dcache.ways=2", 530, NONE,
       "104 105 209 210 314 315 316 317 421 422 423 424 528 529", "icache_miss=104 wait_memory=412", U(LUI, 1, 1),
       I(LW, 2, 1, 0), R(ADD, 0, 2, 2), I(LW, 2, 1, 64), R(ADD, 0, 2, 2), I(LW, 2, 1, 4), R(ADD, 0, 2, 2),
       I(LW, 2, 1, 128), R(ADD, 0, 2, 2), I(LW, 2, 1, 68), R(ADD, 0, 2, 2), I(LW, 2, 1, 0), R(ADD, 0, 2, 2), HALT);
  COUNTS("dcache_misses=4 dcache_hits=2");
  /* Two sets of two: lines 0, 2 and 4 are in one. */
  RULE("Data cache", "a line has its set by its number", FAR, "dcache.bytes=256 dcache.ways=2", 526, NONE,
       "104 105 209 210 314 315 419 420 524 525", "icache_miss=104 wait_memory=412", U(LUI, 1, 1), I(LW, 2, 1, 0),
       R(ADD, 0, 2, 2), I(LW, 2, 1, 128), R(ADD, 0, 2, 2), I(LW, 2, 1, 256), R(ADD, 0, 2, 2), I(LW, 2, 1, 0),
       R(ADD, 0, 2, 2), HALT);
  /* A 105, B 210, A hits, C 317 takes B's place, A hits. */
  RULE("Data cache", "or the least recently used line is replaced", FAR,
       "dcache.bytes=128 dcache.ways=2 dcache.replacement=lru", 425, NONE,
       "104 105 209 210 314 315 316 317 421 422 423 424", "icache_miss=104 wait_memory=309", U(LUI, 1, 1),
       I(LW, 2, 1, 0), R(ADD, 0, 2, 2), I(LW, 2, 1, 64), R(ADD, 0, 2, 2), I(LW, 2, 1, 4), R(ADD, 0, 2, 2),
       I(LW, 2, 1, 128), R(ADD, 0, 2, 2), I(LW, 2, 1, 0), R(ADD, 0, 2, 2), HALT);
  RULE("Data cache", "a store uses the line it finds", FAR, "dcache.bytes=128 dcache.ways=2 dcache.replacement=lru",
       424, NONE, "104 105 209 210 314 315 316 420 421 422 423", "icache_miss=104 wait_memory=309", U(LUI, 1, 1),
       I(LW, 2, 1, 0), R(ADD, 0, 2, 2), I(LW, 2, 1, 64), R(ADD, 0, 2, 2), S(SW, 1, 1, 4), I(LW, 2, 1, 128),
       R(ADD, 0, 2, 2), I(LW, 2, 1, 0), R(ADD, 0, 2, 2), HALT);
  /* The load after the first store misses (106, there 210); the second store updates the line: the load of 213 hits and
     gets 9. */
  RULE("Data cache", "a store goes around the cache and updates a line in place", FAR, "", 217, NONE,
       "104 105 106 210 211 212 213 214 215 216", "icache_miss=104 wait_memory=103", U(LUI, 1, 1), S(SW, 1, 1, 0),
       I(LW, 2, 1, 0), R(ADD, 0, 2, 2), I(ADDI, 3, 0, 9), S(SW, 3, 1, 0), I(LW, 4, 1, 0), I(ADDI, 5, 4, -9),
       B(BEQ, 5, 0, 8), NOP, HALT);
  COUNTS("store_misses=1 store_hits=1");
  /* The line of 105 is there in 209 and takes its banks in 209..211; the word is usable in 209. */
  RULE("Data cache", "a line takes its banks for dcache.fill_cycles", FAR, "dcache.fill_cycles=3", 215, NONE,
       "104 105 209 212 213 214", "icache_miss=104 wait_memory=103 dcache_bank_conflict=2", U(LUI, 1, 1),
       I(LW, 2, 1, 0), R(ADD, 0, 2, 2), I(LW, 3, 1, 4), R(ADD, 0, 3, 3), HALT);
  RULE("Data cache", "loads past the cache ask for no bank", FAR, "chip.tps_per_tm=4", 107, NONE,
       "104 105 106 / 104 105 106 / 104 105 106 / 104 105 106", "icache_miss=416", U(LUI, 1, 1), I(LWNT, 2, 1, 0),
       HALT);
  RULE("Data cache", "and leave no line", FAR, "", 209, NONE, "104 105 106 206 207 208",
       "icache_miss=104 wait_memory=99", U(LUI, 1, 1), I(LWNT, 2, 1, 0), I(LWNT, 3, 1, 0), R(ADD, 0, 2, 2),
       R(ADD, 0, 3, 3), HALT);
  COUNTS("nontemporal_read_bytes=8 dcache_misses=0");

  /* --- Stores and write combining: 0.1 bytes a cycle; the first instruction in 740 --- */
  RULE("Stores", "stores that touch become one write", FAR, "memory.bandwidth_gbps=0.05", 905, NONE,
       "740 741 742 743 744 745", "icache_miss=740", U(LUI, 1, 1), S(SWNT, 1, 1, 0), S(SWNT, 1, 1, 4), S(SW, 1, 1, 8),
       S(SWNT, 1, 1, 12), HALT);
  COUNTS("write_requests=1 written_bytes=16 combined_stores=3");
  RULE("Stores", "also downwards", FAR, "memory.bandwidth_gbps=0.05", 823, NONE, "740 741 742 743", "icache_miss=740",
       U(LUI, 1, 1), S(SWNT, 1, 1, 4), S(SWNT, 1, 1, 0), HALT);
  COUNTS("write_requests=1 written_bytes=8 combined_stores=1");
  RULE("Stores", "what overlaps the run joins it", FAR, "memory.bandwidth_gbps=0.05", 783, NONE, "740 741 742 743",
       "icache_miss=740", U(LUI, 1, 1), S(SW, 1, 1, 0), S(SB, 1, 1, 2), HALT);
  COUNTS("write_requests=1 written_bytes=4 combined_stores=1");
  RULE("Stores", "whatever their sizes", FAR, "memory.bandwidth_gbps=0.05", 793, NONE, "740 741 742 743",
       "icache_miss=740", U(LUI, 1, 1), S(SB, 1, 1, 4), S(SW, 1, 1, 0), HALT);
  COUNTS("write_requests=1 written_bytes=5 combined_stores=1");
  /* 742..781 and 782..821. */
  RULE("Stores", "a gap ends the run", FAR, "memory.bandwidth_gbps=0.05", 822, NONE, "740 741 742 743",
       "icache_miss=740", U(LUI, 1, 1), S(SWNT, 1, 1, 0), S(SWNT, 1, 1, 8), HALT);
  COUNTS("write_requests=2 written_bytes=8 combined_stores=0");
  /* 742..781 and 782..861. */
  RULE("Stores", "a store joins the latest run only", FAR, "memory.bandwidth_gbps=0.05", 862, NONE,
       "740 741 742 743 744", "icache_miss=740", U(LUI, 1, 1), S(SWNT, 1, 1, 0), S(SWNT, 1, 1, 8), S(SWNT, 1, 1, 4),
       HALT);
  COUNTS("write_requests=2 written_bytes=12 combined_stores=1");
  RULE("Stores", "the end of a block of 64 bytes ends the run", FAR, "memory.bandwidth_gbps=0.05", 822, NONE,
       "740 741 742 743", "icache_miss=740", U(LUI, 1, 1), S(SWNT, 1, 1, 60), S(SWNT, 1, 1, 64), HALT);
  COUNTS("write_requests=2 written_bytes=8 combined_stores=0");
  RULE("Stores", "without write combining each is written by itself", FAR,
       "memory.bandwidth_gbps=0.05 memory.write_combining=false", 901, NONE, "740 741 742 743 744 745",
       "icache_miss=740", U(LUI, 1, 1), S(SWNT, 1, 1, 0), S(SWNT, 1, 1, 4), S(SW, 1, 1, 8), S(SWNT, 1, 1, 12), HALT);
  COUNTS("write_requests=4 written_bytes=16 combined_stores=0");
  /* The write of 106 is back in 207. */
  RULE("Stores", "halt needs a place for what the buffer holds", FAR, "memory.queue_depth=1", 208, NONE,
       "104 105 106 207", "icache_miss=104 memory_queue_full=100", U(LUI, 1, 1), S(SW, 1, 1, 0), S(SW, 1, 1, 8), HALT);
  RULE("Stores", "the exit trap writes it too", FAR, "memory.bandwidth_gbps=0.05", 782, NONE, "740 741 742",
       "icache_miss=740", U(LUI, 1, 1), S(SW, 1, 1, 0), T(0, TRAX_TRAP_EXIT));
  /* TP 0's write of 105 has the place to 206. */
  RULE("Stores", "a store that gets no place waits for it", FAR,
       "chip.tps_per_tm=2 memory.queue_depth=1 memory.write_combining=false", 208, NONE, "104 105 106 / 104 206 207",
       "icache_miss=208 dcache_bank_conflict=1 memory_queue_full=100", U(LUI, 1, 1), S(SW, 1, 1, 0), HALT);

  /* --- Memory queue --- */
  /* Three lines, three banks, one place: TP k in 108 + 104 k, then all again. The last line is on the bus in 628..631.
   */
  RULE("Memory queue", "places go round", FAR, "chip.tps_per_tm=3 memory.queue_depth=1 dcache.tps_per_bank=1", 632,
       NONE, "104 105 106 107 108 420 421 / 104 105 106 107 212 524 525 / 104 105 106 107 316 628 629",
       "icache_miss=312 memory_queue_full=1245", U(LUI, 1, 1), U(RDSR, 2, TRAX_SR_TP), I(SLLI, 2, 2, 6),
       R(ADD, 1, 1, 2), I(LW, 3, 1, 0), I(LW, 4, 1, 192), HALT);
  /* TP 2 has the place in 108..208. TPs 0 and 1 ask from 109 on; TP 0 comes behind TP 2. */
  RULE("Memory queue", "the turn goes on behind the last TP that took a place", FAR,
       "chip.tps_per_tm=3 memory.queue_depth=1", 312, NONE,
       "104 105 106 107 108 209 210 / 104 105 106 107 108 310 311 / 104 105 106 107 108 109",
       "icache_miss=312 memory_queue_full=301", U(LUI, 1, 1), U(RDSR, 2, TRAX_SR_TP), I(ADDI, 3, 2, -2),
       B(BEQ, 3, 0, 8), NOP, I(LWNT, 4, 1, 0), HALT);
  /* A word is there after 101 cycles. */
  RULE("Memory queue", "places go round for words past the cache", FAR, "chip.tps_per_tm=3 memory.queue_depth=1", 612,
       NONE, "104 105 408 409 / 104 206 509 510 / 104 307 610 611", "icache_miss=312 memory_queue_full=1209",
       U(LUI, 1, 1), I(LWNT, 2, 1, 0), I(LWNT, 3, 1, 0), HALT);
  RULE("Memory queue", "the second of two that miss a line in one cycle merges", FAR,
       "chip.tps_per_tm=2 dcache.tps_per_bank=1", 214, NONE,
       "104 105 106 107 108 212 213 / 104 105 106 107 108 212 213", "icache_miss=208 wait_memory=206", U(LUI, 1, 1),
       U(RDSR, 2, TRAX_SR_TP), I(SLLI, 2, 2, 2), R(ADD, 1, 1, 2), I(LW, 3, 1, 0), R(ADD, 4, 3, 3), HALT);
  /* 105 is back in 206, the next in 307; halt has nothing to write. */
  RULE("Memory queue", "a write has its place until its completion", FAR,
       "memory.queue_depth=1 memory.write_combining=false", 309, NONE, "104 105 206 307 308",
       "icache_miss=104 memory_queue_full=200", U(LUI, 1, 1), S(SW, 1, 1, 0), S(SW, 1, 1, 4), S(SW, 1, 1, 8), HALT);
  /* The line has the bus in 105..108, the word from 109 on. */
  RULE("Memory queue", "requests are served in the order in which they were made", FAR, "", 212, NONE,
       "104 105 106 210 211", "icache_miss=104 wait_memory=103", U(LUI, 1, 1), I(LW, 2, 1, 0), I(LWNT, 3, 1, 0),
       R(ADD, 0, 3, 3), HALT);
  /* Two cycles each: 105..106 and 107..108. */
  RULE("Memory queue", "a short transfer costs memory.min_transfer_bytes", FAR, "memory.min_transfer_bytes=32", 211,
       NONE, "104 105 106 207 209 210", "icache_miss=104 wait_memory=101", U(LUI, 1, 1), I(LWNT, 2, 1, 0),
       I(LWNT, 3, 1, 0), R(ADD, 0, 2, 2), R(ADD, 0, 3, 3), HALT);
  COUNTS("nontemporal_read_bytes=64");
  /* 742..1061. */
  RULE("Memory queue", "so does a short write", FAR, "memory.bandwidth_gbps=0.05 memory.min_transfer_bytes=32", 1062,
       NONE, "740 741 742", "icache_miss=740", U(LUI, 1, 1), S(SB, 1, 1, 0), HALT);
  COUNTS("write_requests=1 written_bytes=32");

  /* --- Fences --- */
  RULE("Fences", "a fence that waits for nothing is issued in the next cycle", FAR, "", 107, NONE, "104 105 106",
       "icache_miss=104", U(LUI, 1, 1), FENCE(R), HALT);
  /* r9 is usable in 13, r7 in 10: r7 is blamed in 3..9, r9 in 10..12. */
  RULE("Fences", "a fence needs all registers, and the first is blamed", NEAR, "fpu.mul_latency_cycles=12", 15, NONE,
       "1 2 13 14", "icache_miss=1 wait_special=7 wait_other=3", R(FMUL, 9, 0, 0), R(FDIV, 7, 0, 0), FENCE(W), HALT);
  /* There in 209; again in 210, there in 314. */
  RULE("Fences", "fence r drops the data cache's lines", FAR, "", 316, NONE, "104 105 209 210 314 315",
       "icache_miss=104 wait_memory=206", U(LUI, 1, 1), I(LW, 2, 1, 0), FENCE(R), I(LW, 3, 1, 0), R(ADD, 4, 3, 3),
       HALT);
  RULE("Fences", "fence w does not", FAR, "", 213, NONE, "104 105 209 210 211 212", "icache_miss=104 wait_memory=103",
       U(LUI, 1, 1), I(LW, 2, 1, 0), FENCE(W), I(LW, 3, 1, 0), R(ADD, 4, 3, 3), HALT);
  /* Written in 106, complete in 207. */
  RULE("Fences", "fence w writes the run and waits until it is complete", FAR, "", 209, NONE, "104 105 207 208",
       "icache_miss=104 wait_memory=101", U(LUI, 1, 1), S(SW, 1, 1, 0), FENCE(W), HALT);
  /* The run has the bus in 107. */
  RULE("Fences", "fence r does not", FAR, "", 108, NONE, "104 105 106 107", "icache_miss=104", U(LUI, 1, 1),
       S(SW, 1, 1, 0), FENCE(R), HALT);
  /* Written in 105. */
  RULE("Fences", "fence w waits for writes that are under way", FAR, "memory.write_combining=false", 208, NONE,
       "104 105 206 207", "icache_miss=104 wait_memory=100", U(LUI, 1, 1), S(SW, 1, 1, 0), FENCE(W), HALT);
  RULE("Fences", "fence r does not wait for those either", FAR, "memory.write_combining=false", 108, NONE,
       "104 105 106 107", "icache_miss=104", U(LUI, 1, 1), S(SW, 1, 1, 0), FENCE(R), HALT);
  RULE("Fences", "nor fence w for those of other TPs", FAR, "chip.tps_per_tm=2 memory.write_combining=false", 110, NONE,
       "104 105 106 107 108 109 / 104 105 106 107 108", "icache_miss=208", U(LUI, 1, 1), U(RDSR, 2, TRAX_SR_TP),
       B(BNE, 2, 0, 16), NOP, FENCE(RW), HALT, S(SW, 1, 1, 0), HALT);
  /* The word has the place in 106..206. The run is written in 207 and complete in 308. */
  RULE("Fences", "fence w needs a place for the run", FAR, "memory.queue_depth=1", 310, NONE, "104 105 106 308 309",
       "icache_miss=104 memory_queue_full=100 wait_memory=101", U(LUI, 1, 1), S(SW, 1, 1, 0), I(LWNT, 0, 1, 64),
       FENCE(W), HALT);
  RULE("Fences", "every fence waits for increments, also without a destination", FAR, "", 208, NONE, "104 105 206 207",
       "icache_miss=104 wait_memory=100", U(LUI, 1, 1), I(AINC, 0, 1, 0), FENCE(R), HALT);
  RULE("Fences", "but not for a load without one", FAR, "", 108, NONE, "104 105 106 107", "icache_miss=104",
       U(LUI, 1, 1), I(LWNT, 0, 1, 0), FENCE(RW), HALT);
  /* The line is there in 209, when the run is written; complete in 310. Missed in 311, there in 415. */
  RULE("Fences", "fence rw is both", FAR, "", 417, NONE, "104 105 106 310 311 415 416",
       "icache_miss=104 wait_memory=306", U(LUI, 1, 1), I(LW, 2, 1, 0), S(SW, 1, 1, 0), FENCE(RW), I(LW, 3, 1, 0),
       R(ADD, 4, 3, 3), HALT);
  /* TP 0's fence is issued in 108. TP 1's line, missed in 107, is there in 211; missed again in 212, there in 316. */
  RULE("Fences", "a line on its way serves those who wait for it and passes", FAR, "chip.tps_per_tm=2", 318, NONE,
       "104 105 106 107 108 109 / 104 105 106 107 211 212 316 317", "icache_miss=208 wait_memory=206",
       U(RDSR, 1, TRAX_SR_TP), U(LUI, 2, 1), B(BNE, 1, 0, 16), NOP, FENCE(R), HALT, I(LW, 3, 2, 0), R(ADD, 4, 3, 3),
       I(LW, 5, 2, 4), R(ADD, 6, 5, 5), HALT);
  /* TP 1 asks for the bank in 109..211. */
  RULE("Fences", "a load whose line passes is refused until it has passed", FAR, "chip.tps_per_tm=2", 317, NONE,
       "104 105 106 107 108 109 / 104 105 106 107 108 211 315 316",
       "icache_miss=208 memory_queue_full=102 wait_memory=103", U(RDSR, 1, TRAX_SR_TP), U(LUI, 2, 1), B(BNE, 1, 0, 16),
       NOP, FENCE(R), HALT, I(LW, 3, 2, 0), NOP, I(LW, 5, 2, 4), R(ADD, 6, 5, 5), HALT);
  RULE("Fences", "a load of the fence's cycle comes before it", FAR, "chip.tps_per_tm=2", 213, NONE,
       "104 105 106 107 108 109 / 104 105 106 107 108 211 212", "icache_miss=208 wait_memory=102",
       U(RDSR, 1, TRAX_SR_TP), U(LUI, 2, 1), B(BNE, 1, 0, 16), NOP, FENCE(R), HALT, I(LW, 3, 2, 0), I(LW, 5, 2, 4),
       R(ADD, 6, 5, 5), HALT);
  /* Missed in 108, there in 212. */
  RULE("Fences", "a line requested in the fence's cycle passes too", FAR, "chip.tps_per_tm=2", 318, NONE,
       "104 105 106 107 108 109 / 104 105 106 107 108 212 316 317",
       "icache_miss=208 memory_queue_full=103 wait_memory=103", U(RDSR, 1, TRAX_SR_TP), U(LUI, 2, 1), B(BNE, 1, 0, 16),
       NOP, FENCE(R), HALT, NOP, I(LW, 3, 2, 0), I(LW, 5, 2, 4), R(ADD, 6, 5, 5), HALT);
  /* TM 0's line, missed in 107, is there in 211. TM 1's fence is issued in 110. */
  RULE("Fences", "other TMs keep their lines", FAR, "chip.tms=2", 215, NONE,
       "104 105 106 107 211 212 213 214 / 108 109 110 111", "icache_miss=212 wait_memory=103", U(RDSR, 1, TRAX_SR_TM),
       B(BNE, 1, 0, 28), U(LUI, 2, 1), I(LW, 3, 2, 0), R(ADD, 4, 3, 3), I(LW, 5, 2, 4), R(ADD, 6, 5, 5), HALT, FENCE(R),
       HALT);

  /* --- Second-level cache: the first instruction line is there in 104, and in 124 at the TM --- */
  RULE("Second-level cache", "a miss has its latency besides", FAR, "l2.bytes=4096", 125, NONE, "124",
       "icache_miss=124", HALT);
  /* A data cache of one line. A 125, there 249; B 250, there 374; A again 375, there 395. */
  RULE("Second-level cache", "a hit has l2.latency_cycles", FAR, "l2.bytes=4096 dcache.bytes=64", 397, NONE,
       "124 125 249 250 374 375 395 396", "icache_miss=124 wait_memory=265", U(LUI, 1, 1), I(LW, 2, 1, 0),
       R(ADD, 0, 2, 2), I(LW, 2, 1, 64), R(ADD, 0, 2, 2), I(LW, 2, 1, 0), R(ADD, 0, 2, 2), HALT);
  /* TM 1 is looked up in 1. */
  RULE("Second-level cache", "a line that is on its way is merged with", FAR, "l2.bytes=4096 chip.tms=2", 125, NONE,
       "124 / 124", "icache_miss=248", HALT);
  /* As above; in 375 the bank serves TM 0, in 376 TM 1. */
  RULE("Second-level cache", "a bank takes one request a cycle", FAR, "l2.bytes=4096 dcache.bytes=64 chip.tms=2", 398,
       NONE, "124 125 249 250 374 375 395 396 / 124 125 249 250 374 375 396 397", "icache_miss=248 wait_memory=531",
       U(LUI, 1, 1), I(LW, 2, 1, 0), R(ADD, 0, 2, 2), I(LW, 2, 1, 64), R(ADD, 0, 2, 2), I(LW, 2, 1, 0), R(ADD, 0, 2, 2),
       HALT);
  /* Through in 126, there in 126 + 120. */
  RULE("Second-level cache", "a lwnt that finds no line passes", FAR, "l2.bytes=4096", 248, NONE, "124 125 246 247",
       "icache_miss=124 wait_memory=120", U(LUI, 1, 1), I(LWNT, 2, 1, 0), R(ADD, 0, 2, 2), HALT);
  RULE("Second-level cache", "a lwnt hits", FAR, "l2.bytes=4096", 272, NONE, "124 125 249 250 270 271",
       "icache_miss=124 wait_memory=142", U(LUI, 1, 1), I(LW, 2, 1, 0), R(ADD, 0, 2, 2), I(LWNT, 3, 1, 0),
       R(ADD, 0, 3, 3), HALT);
  RULE("Second-level cache", "a write allocates no line", FAR, "l2.bytes=4096 memory.write_combining=false", 249, NONE,
       "124 125 126 247 248", "icache_miss=124 wait_memory=120", U(LUI, 1, 1), S(SWNT, 1, 1, 0), I(LWNT, 2, 1, 0),
       R(ADD, 0, 2, 2), HALT);
  /* B is refused from 126 on; A enters the cache in 229, before B is looked up again: there in 229 + 4 + 120. */
  RULE("Second-level cache", "a miss needs a miss register", FAR, "l2.bytes=4096 l2.mshrs=1", 355, NONE,
       "124 125 126 353 354", "icache_miss=124 wait_memory=226", U(LUI, 1, 1), I(LW, 2, 1, 0), I(LW, 3, 1, 64),
       R(ADD, 4, 3, 3), HALT);
  /* Lines of 8 cycles: 128, and 129 + 8 + 120. */
  RULE("Second-level cache", "its own lines are transferred whole", FAR, "l2.bytes=4096 l2.line_bytes=128", 259, NONE,
       "128 129 130 257 258", "icache_miss=128 wait_memory=126", U(LUI, 1, 1), I(LW, 2, 1, 0), I(LW, 3, 1, 64),
       R(ADD, 4, 3, 3), HALT);

  /* --- Memory controller --- */
  /* 3 bytes a cycle: the line is through after 21 1/3, there in 122. 36 bytes from 123 on take 12 cycles. */
  RULE("Memory controller", "the bandwidth is an exact fraction", FAR,
       "memory.bandwidth_gbps=1.5 memory.write_combining=false", 135, NONE,
       "122 123 124 125 126 127 128 129 130 131 132", "icache_miss=122", U(LUI, 1, 1), S(SW, 1, 1, 0), S(SW, 1, 1, 4),
       S(SW, 1, 1, 8), S(SW, 1, 1, 12), S(SW, 1, 1, 16), S(SW, 1, 1, 20), S(SW, 1, 1, 24), S(SW, 1, 1, 28),
       S(SW, 1, 1, 32), HALT);
  /* Four words fill 105; the fifth has 106. */
  RULE("Memory controller", "a cycle serves as many requests as begin in it", FAR, "chip.tps_per_tm=5", 209, NONE,
       "104 105 206 207 / 104 105 206 207 / 104 105 206 207 / 104 105 206 207 / 104 105 207 208",
       "icache_miss=520 wait_memory=501", U(LUI, 1, 1), I(LWNT, 2, 1, 0), R(ADD, 3, 2, 2), HALT);
  /* Lines there in 104, 108, 112. Increments of 64 cycles, the first from 105: TMs 0, 1, 2, 0, 1, 2; the k-th is usable
     in 269 + 64 k. */
  RULE("Memory controller", "TMs take turns", FAR, "chip.tms=3 chip.tps_per_tm=2 memory.atomic_bytes=1024", 591, NONE,
       "104 105 269 270 / 104 105 461 462 / 108 109 333 334 / 108 109 525 526 / 112 113 397 398 / 112 113 589 590",
       "icache_miss=648 wait_atomic=1914", U(LUI, 1, 1), I(AINC, 2, 1, 0), R(ADD, 3, 2, 2), HALT);
  /* 105 takes half a cycle, 106 as well: there in 206 and 207. The second got 1. */
  /* The unit takes them in 106 and 116. */
  RULE("Memory controller", "a channel's increments are memory.atomic_interval_cycles apart", FAR,
       "memory.atomic_interval_cycles=10", 218, NONE, "104 105 106 216 217", "icache_miss=104 wait_atomic=109",
       U(LUI, 1, 1), I(AINC, 2, 1, 0), I(AINC, 3, 1, 0), B(BNE, 3, 0, 8), NOP, HALT);
  RULE("Memory controller", "increments happen in the order of service", FAR, "", 209, NONE, "104 105 106 207 208",
       "icache_miss=104 wait_atomic=100", U(LUI, 1, 1), I(AINC, 2, 1, 0), I(AINC, 3, 1, 0), B(BNE, 3, 0, 8), NOP, HALT);
  COUNTS("atomics=2 atomic_bytes=16 word0=2");

  RULE("Memory controller", "an atomic increment may take longer", FAR, "memory.atomic_latency_cycles=50", 258, NONE,
       "104 105 256 257", "icache_miss=104 wait_atomic=150", U(LUI, 1, 1), I(AINC, 2, 1, 0), R(ADD, 3, 2, 2), HALT);
  /* 5 becomes 6. The load is on the bus in 108..111. */
  RULE("Memory controller", "an increment follows earlier stores, and a load sees it at once", FAR, "", 214, NONE,
       "104 105 106 107 108 208 212 213", "icache_miss=104 wait_atomic=99 wait_memory=3", U(LUI, 1, 1),
       I(ADDI, 2, 0, 5), S(SW, 2, 1, 0), I(AINC, 3, 1, 0), I(LW, 4, 1, 0), S(SW, 3, 1, 4), S(SW, 4, 1, 8), HALT);
  COUNTS("word0=6 word4=5 word8=6");
  RULE("Memory controller", "an increment without a destination increments", FAR, "chip.tps_per_tm=2", 110, NONE,
       "104 105 106 107 108 / 104 105 106 108 109", "icache_miss=208 dcache_bank_conflict=1", U(LUI, 1, 1),
       I(AINC, 0, 1, 0), R(ADD, 2, 0, 0), S(SW, 0, 1, 4), HALT);
  COUNTS("word0=2 word4=0");
  /* 8 bytes a cycle each. Channel 0: 0..7, 109..116, 117..124; channel 1: 110..117. */
  RULE("Memory controller", "channels share the bandwidth, each with a bus of its own", FAR, "memory.channels=2", 227,
       NONE, "108 109 110 111 217 218 225 226", "icache_miss=108 wait_memory=111", U(LUI, 1, 1), I(LW, 2, 1, 0),
       I(LW, 3, 1, 256), I(LW, 4, 1, 64), R(ADD, 5, 2, 2), R(ADD, 6, 3, 3), R(ADD, 7, 4, 4), HALT);
  /* The third, on channel 1, is there in 219, the second in 225. */
  RULE("Memory controller", "requests for different channels do not wait for each other", FAR, "memory.channels=2", 227,
       NONE, "108 109 110 111 219 225 226", "icache_miss=108 wait_memory=112", U(LUI, 1, 1), I(LW, 2, 1, 0),
       I(LW, 3, 1, 64), I(LW, 4, 1, 256), R(ADD, 5, 4, 4), R(ADD, 6, 3, 3), HALT);

  /* --- DRAM: a tick is a cycle; a line takes trcd + tcl + 8 = 35, and 100 --- */
  RULE("DRAM", "a line comes after activation, access and data", FAR, "memory.model=dram dram.mtps=1000 dram.trefi=0",
       273, NONE, "135 136 271 272", "icache_miss=135 wait_memory=134", U(LUI, 1, 1), I(LW, 2, 1, 0), R(ADD, 0, 2, 2),
       HALT);
  /* The row is open: 20 after the request of 272, and 100. */
  RULE("DRAM", "of an open row it comes without the activation", FAR, "memory.model=dram dram.mtps=1000 dram.trefi=0",
       394, NONE, "135 136 271 272 392 393", "icache_miss=135 wait_memory=253", U(LUI, 1, 1), I(LW, 2, 1, 0),
       R(ADD, 0, 2, 2), I(LW, 3, 1, 64), R(ADD, 0, 3, 3), HALT);
  /* Taken in 137 and 138. */
  RULE("DRAM", "an increment needs no burst", FAR, "memory.model=dram dram.mtps=1000 dram.trefi=0", 240, NONE,
       "135 136 137 238 239", "icache_miss=135 wait_atomic=100", U(LUI, 1, 1), I(AINC, 2, 1, 0), I(AINC, 3, 1, 0),
       B(BNE, 3, 0, 8), NOP, HALT);
  /* The bus is free in 187 when the fourth load is taken in 139, which is 42 before. So it has the only place until
   * 145. */
  RULE("DRAM", "an increment needs no place", FAR, "memory.model=dram dram.mtps=1000 dram.trefi=0 dram.reads=1", 243,
       NONE, "135 136 137 138 139 140 241 242", "icache_miss=135 wait_atomic=100", U(LUI, 1, 1), I(LW, 2, 1, 0),
       I(LW, 3, 1, 64), I(LW, 4, 1, 128), I(LW, 5, 1, 192), I(AINC, 6, 1, 256), R(ADD, 0, 6, 6), HALT);
  /* A word takes a burst: 4 + 4 after the other. */
  RULE("DRAM", "a word takes a burst", FAR, "memory.model=dram dram.mtps=1000 dram.trefi=0", 274, NONE,
       "135 136 137 271 272 273", "icache_miss=135 wait_memory=133", U(LUI, 1, 1), I(LWNT, 2, 1, 0), I(LWNT, 3, 1, 4),
       R(ADD, 0, 3, 3), R(ADD, 0, 2, 2), HALT);

  /* --- Faults --- */
  RULE("Faults", "the rest of the cycle happens", NEAR, "chip.tps_per_tm=2 " LOCKSTEP, 4, NULL_PAGE, "1 2 / 1 2 3",
       "icache_miss=2", U(RDSR, 1, TRAX_SR_TP), B(BNE, 1, 0, 8), I(LW, 2, 0, 0), NOP, HALT);
  /* In 3 TP 0 is illegal (step 2), and TP 1 aborts (step 5); then the other way round. */
  RULE("Faults", "the first in (TM, TP) order is reported", NEAR, "chip.tps_per_tm=2 " LOCKSTEP, 4, ILLEGAL,
       "1 2 / 1 2", "icache_miss=2", U(RDSR, 1, TRAX_SR_TP), B(BEQ, 1, 0, 8), T(0, TRAX_TRAP_ABORT), 0);
  RULE("Faults", "also if a higher one came in an earlier step", NEAR, "chip.tps_per_tm=2 " LOCKSTEP, 4, ABORT,
       "1 2 / 1 2", "icache_miss=2", U(RDSR, 1, TRAX_SR_TP), B(BNE, 1, 0, 8), T(0, TRAX_TRAP_ABORT), 0);
  RULE("Faults", "the null page comes before misalignment", NEAR, "", 2, NULL_PAGE, "", "icache_miss=1 halted=1",
       I(LW, 1, 0, 2), HALT);

  /* --- Accounting --- */
  RULE("Accounting", "a thread is halted from the cycle after its end", NEAR, "chip.tps_per_tm=2 " LOCKSTEP, 6, NONE,
       "1 2 3 / 1 2 3 4 5", "icache_miss=2 halted=2", U(RDSR, 1, TRAX_SR_TP), B(BNE, 1, 0, 8), HALT, NOP, NOP, HALT);
  RULE("Accounting", "a program reads the cycle in which it does", NEAR, "", 10, NONE, "1 2 3 4 5 6 7 8 9",
       "icache_miss=1", U(LUI, 1, 1), NOP, U(RDSR, 2, TRAX_SR_CYCLE), S(SW, 2, 1, 0), U(RDSR, 3, TRAX_SR_THREADS),
       S(SW, 3, 1, 4), U(RDSR, 4, TRAX_SR_CYCLEH), S(SW, 4, 1, 8), HALT);
  COUNTS("word0=3 word4=1 word8=0");
  /* --- Further programs --- */
  CASE("Second-level cache", "lines and bytes of hits and misses", FAR, "l2.bytes=4096 dcache.bytes=64", 397, NONE,
       "124 125 249 250 374 375 395 396", "icache_miss=124 wait_memory=265", U(LUI, 1, 1), I(LW, 2, 1, 0),
       R(ADD, 0, 2, 2), I(LW, 2, 1, 64), R(ADD, 0, 2, 2), I(LW, 2, 1, 0), R(ADD, 0, 2, 2), HALT);
  COUNTS("l2_misses=3 l2_hits=1 l2_served_bytes=64 memory_bytes=192 data_read_bytes=192");
  /* The program's line has the bus in 0..15, A with B in 137..152. */
  CASE("Second-level cache", "a long line", FAR, "l2.bytes=4096 dcache.bytes=64 l2.line_bytes=256", 296, NONE,
       "136 137 273 274 294 295", "icache_miss=136 wait_memory=154", U(LUI, 1, 1), I(LW, 2, 1, 0), R(ADD, 0, 2, 2),
       I(LW, 2, 1, 64), R(ADD, 0, 2, 2), HALT);
  COUNTS("l2_read_bytes=512");
  CASE("Second-level cache", "two TMs miss, merge and hit", FAR, "l2.bytes=4096 dcache.bytes=64 chip.tms=2", 398, NONE,
       "124 125 249 250 374 375 395 396 / 124 125 249 250 374 375 396 397", "icache_miss=248 wait_memory=531",
       U(LUI, 1, 1), I(LW, 2, 1, 0), R(ADD, 0, 2, 2), I(LW, 2, 1, 64), R(ADD, 0, 2, 2), I(LW, 2, 1, 0), R(ADD, 0, 2, 2),
       HALT);
  COUNTS("l2_misses=3 l2_merged=3 l2_hits=2 memory_bytes=192");
  CASE("Second-level cache", "a read is refused in each cycle", FAR, "l2.bytes=4096 l2.mshrs=1 dcache.bytes=128", 355,
       NONE, "124 125 126 249 353 354", "icache_miss=124 wait_memory=225", U(LUI, 1, 1), I(LW, 2, 1, 0),
       I(LW, 3, 1, 64), R(ADD, 0, 2, 2), R(ADD, 0, 3, 3), HALT);
  COUNTS("l2_refused=103");
  CASE("Second-level cache", "a refused read lets the other TM pass", FAR,
       "l2.bytes=4096 l2.mshrs=1 l2.banks=1 dcache.bytes=128 chip.tms=2", 357, NONE,
       "124 125 126 127 128 129 251 252 355 356 / 124 125 126 127 128 253 355 356", "icache_miss=248 wait_memory=448",
       U(LUI, 1, 1), U(RDSR, 4, TRAX_SR_TM), B(BNE, 4, 0, 24), I(LW, 2, 1, 0), NOP, I(LW, 3, 1, 64), R(ADD, 0, 2, 2),
       J(0, 16), I(LW, 3, 1, 64), I(LW, 2, 1, 0), R(ADD, 0, 2, 2), R(ADD, 0, 3, 3), HALT);
  CASE("Second-level cache", "lwnt passes, allocates nothing, and hits", FAR, "l2.bytes=4096 dcache.bytes=64", 394,
       NONE, "124 125 246 247 371 372 392 393", "icache_miss=124 wait_memory=262", U(LUI, 1, 1), I(LWNT, 2, 1, 0),
       R(ADD, 0, 2, 2), I(LW, 3, 1, 0), R(ADD, 0, 3, 3), I(LWNT, 4, 1, 0), R(ADD, 0, 4, 4), HALT);
  COUNTS("l2_passed=1 l2_misses=2 l2_hits=1 memory_bytes=132");
  /* The store of 125 has its place to 246, that of 371 to 492. */
  CASE("Second-level cache", "stores are written through", FAR,
       "l2.bytes=4096 dcache.bytes=64 memory.write_combining=false memory.queue_depth=1", 618, NONE,
       "124 125 246 370 371 492 616 617", "icache_miss=124 memory_queue_full=240 wait_memory=246", U(LUI, 1, 1),
       S(SW, 1, 1, 0), I(LW, 2, 1, 0), R(ADD, 0, 2, 2), S(SW, 1, 1, 0), I(LW, 3, 1, 64), R(ADD, 0, 3, 3), HALT);
  COUNTS("l2_store_misses=1 l2_store_hits=1 memory_bytes=200");
  CASE("Second-level cache", "increments pass", FAR, "l2.bytes=4096 dcache.bytes=64 memory.atomic_latency_cycles=7",
       255, NONE, "124 125 253 254", "icache_miss=124 wait_atomic=127", U(LUI, 1, 1), I(AINC, 2, 1, 0), R(ADD, 0, 2, 2),
       HALT);
  COUNTS("word0=1 l2_store_misses=1");
  /* The program's line, A, B in its place, A hits, C in B's place, A hits. */
  CASE("Second-level cache", "the least recently used line of a set is replaced", FAR,
       "l2.bytes=128 l2.ways=2 dcache.bytes=64", 543, NONE, "124 125 249 250 374 375 395 396 520 521 541 542",
       "icache_miss=124 wait_memory=407", U(LUI, 1, 1), I(LW, 2, 1, 0), R(ADD, 0, 2, 2), I(LW, 2, 1, 64),
       R(ADD, 0, 2, 2), I(LW, 2, 1, 0), R(ADD, 0, 2, 2), I(LW, 2, 1, 128), R(ADD, 0, 2, 2), I(LW, 2, 1, 0),
       R(ADD, 0, 2, 2), HALT);
  CASE("Second-level cache", "or the first", FAR, "l2.bytes=128 l2.ways=2 l2.replacement=fifo dcache.bytes=64", 647,
       NONE, "124 125 249 250 374 375 395 396 520 521 645 646", "icache_miss=124 wait_memory=511", U(LUI, 1, 1),
       I(LW, 2, 1, 0), R(ADD, 0, 2, 2), I(LW, 2, 1, 64), R(ADD, 0, 2, 2), I(LW, 2, 1, 0), R(ADD, 0, 2, 2),
       I(LW, 2, 1, 128), R(ADD, 0, 2, 2), I(LW, 2, 1, 0), R(ADD, 0, 2, 2), HALT);
  CASE("Second-level cache", "a write uses the line that it finds", FAR,
       "l2.bytes=128 l2.ways=2 dcache.bytes=64 memory.write_combining=false", 523, NONE,
       "124 125 249 250 374 375 376 500 501 521 522", "icache_miss=124 wait_memory=388", U(LUI, 1, 1), I(LW, 2, 1, 0),
       R(ADD, 0, 2, 2), I(LW, 2, 1, 64), R(ADD, 0, 2, 2), S(SWNT, 1, 1, 0), I(LW, 2, 1, 128), R(ADD, 0, 2, 2),
       I(LW, 2, 1, 0), R(ADD, 0, 2, 2), HALT);
  /* A cycle has 500 ticks: A, B and C of 128, one of each TM, are there in 229, and at the TMs in 249. C is transferred
     before B, since A and C are in one row. The cache's two places hold the program's line, A; C in the first's place;
     B in A's. D comes to C's place, and B hits in 373. In the order of the requests it would have come to B's. */
  CASE(
      "Second-level cache", "lines of one cycle arrive in the order of their transfers", FAR,
      "memory.model=dram dram.mtps=1000 chip.clock_mhz=1 dram.banks=1 dram.trefi=0 l2.bytes=128 l2.ways=2 l2.banks=4 "
      "l2.replacement=fifo dcache.bytes=64 chip.tms=3",
      395, NONE,
      "121 122 123 124 125 126 127 128 249 250 251 372 373 393 394 / 121 122 123 124 125 126 127 128 249 250 251 / 121 "
      "122 123 124 125 126 127 128 249 250 251",
      "icache_miss=363 wait_memory=499", U(RDSR, 2, TRAX_SR_TM), U(LUI, 1, 1), I(SLLI, 3, 2, 6), R(ADD, 1, 1, 3),
      I(ANDI, 3, 2, 1), I(SLLI, 3, 3, 12), R(ADD, 1, 1, 3), I(LW, 4, 1, 0), R(ADD, 0, 4, 4), B(BNE, 2, 0, 20),
      I(LW, 4, 1, 0xC0), R(ADD, 0, 4, 4), I(LW, 4, 1, 0x1040), R(ADD, 0, 4, 4), HALT);
  COUNTS("l2_misses=5 l2_merged=2 l2_hits=1");
  CASE("Memory controller", "one bus", FAR, "", 220, NONE, "104 105 106 107 217 218 219",
       "icache_miss=104 wait_memory=109", U(LUI, 1, 1), I(LW, 2, 1, 0), I(LW, 3, 1, 128), I(LW, 4, 1, 64),
       R(ADD, 0, 4, 4), R(ADD, 0, 3, 3), HALT);
  /* B on the second, in 107..110. */
  CASE("Memory controller", "two buses", FAR, "memory.channels=2 memory.bandwidth_gbps=16 memory.interleave_bytes=64",
       215, NONE, "104 105 106 107 211 213 214", "icache_miss=104 wait_memory=104", U(LUI, 1, 1), I(LW, 2, 1, 0),
       I(LW, 3, 1, 128), I(LW, 4, 1, 64), R(ADD, 0, 4, 4), R(ADD, 0, 3, 3), HALT);
  COUNTS("channel0_bytes=192 channel1_bytes=64 channel1_transfers=1");
  CASE("Memory controller", "two buses of half the width", FAR, "memory.channels=2 memory.interleave_bytes=64", 227,
       NONE, "108 109 110 111 219 225 226", "icache_miss=108 wait_memory=112", U(LUI, 1, 1), I(LW, 2, 1, 0),
       I(LW, 3, 1, 128), I(LW, 4, 1, 64), R(ADD, 0, 4, 4), R(ADD, 0, 3, 3), HALT);
  CASE("Memory controller", "a block of a channel", FAR, "memory.channels=2", 236, NONE, "108 109 110 111 233 234 235",
       "icache_miss=108 wait_memory=121", U(LUI, 1, 1), I(LW, 2, 1, 0), I(LW, 3, 1, 128), I(LW, 4, 1, 64),
       R(ADD, 0, 4, 4), R(ADD, 0, 3, 3), HALT);
  COUNTS("channel0_bytes=256");
  /* The store has the other bus in 229..236. */
  CASE("Memory controller", "the run ends with the last bus", FAR,
       "memory.channels=2 memory.bandwidth_gbps=0.5 memory.interleave_bytes=64 memory.write_combining=false", 237, NONE,
       "228 229 230", "icache_miss=228", U(LUI, 1, 1), S(SW, 1, 1, 64), HALT);
  CASE("Memory controller", "a load overtakes an increment", FAR, "memory.atomic_latency_cycles=50", 258, NONE,
       "104 105 106 207 256 257", "icache_miss=104 wait_memory=100 wait_atomic=48", U(LUI, 1, 1), I(AINC, 2, 1, 0),
       I(LWNT, 3, 1, 4), R(ADD, 0, 3, 3), R(ADD, 0, 2, 2), HALT);
  CASE("Memory controller", "and frees its place before it", FAR,
       "memory.atomic_latency_cycles=50 memory.queue_depth=2", 310, NONE, "104 105 106 207 308 309",
       "icache_miss=104 memory_queue_full=100 wait_memory=100", U(LUI, 1, 1), I(AINC, 2, 1, 0), I(LWNT, 3, 1, 4),
       I(LWNT, 4, 1, 8), R(ADD, 0, 4, 4), HALT);
  CASE("Units", "two adders of eight TPs", NEAR, "chip.tps_per_tm=16 fpu.adders_per_cluster=2 " LOCKSTEP, 6, NONE,
       "1 2 / 1 2 / 2 3 / 2 3 / 3 4 / 3 4 / 4 5 / 4 5 / 1 2 / 1 2 / 2 3 / 2 3 / 3 4 / 3 4 / 4 5 / 4 5",
       "icache_miss=16 fp_add_conflict=24", R(FADD, 1, 0, 0), HALT);
  CASE("Units", "three multipliers of eight TPs", NEAR, "chip.tps_per_tm=16 fpu.multipliers_per_cluster=3 " LOCKSTEP, 5,
       NONE, "1 2 / 1 2 / 1 2 / 2 3 / 2 3 / 2 3 / 3 4 / 3 4 / 1 2 / 1 2 / 1 2 / 2 3 / 2 3 / 2 3 / 3 4 / 3 4",
       "icache_miss=16 fp_mul_conflict=14", R(FMUL, 1, 0, 0), HALT);
  CASE("Units", "four integer multipliers of sixteen TPs", NEAR,
       "chip.tps_per_tm=16 int_mul.units_per_group=4 " LOCKSTEP, 6, NONE,
       "1 2 / 1 2 / 1 2 / 1 2 / 2 3 / 2 3 / 2 3 / 2 3 / 3 4 / 3 4 / 3 4 / 3 4 / 4 5 / 4 5 / 4 5 / 4 5",
       "icache_miss=16 int_mul_conflict=24", R(MUL, 1, 0, 0), HALT);
  CASE("Units", "the winners of two adders go to the back", NEAR,
       "chip.tps_per_tm=3 fpu.adders_per_cluster=2 " LOCKSTEP, 5, NONE, "1 2 3 / 1 3 4 / 2 3 4",
       "icache_miss=3 fp_add_conflict=2", R(FADD, 1, 0, 0), R(FADD, 2, 0, 0), HALT);
  CASE("Units", "so do those of groups of four", NEAR, "chip.tps_per_tm=8 fpu.tps_per_cluster=4 " LOCKSTEP, 10, NONE,
       "1 5 6 / 2 6 7 / 3 7 8 / 4 8 9 / 1 5 6 / 2 6 7 / 3 7 8 / 4 8 9", "icache_miss=8 fp_add_conflict=36",
       R(FADD, 1, 0, 0), R(FADD, 2, 0, 0), HALT);
  CASE("Units", "adders keep their groups", NEAR, "chip.tps_per_tm=8 fpu.mul_tps_per_cluster=4 " LOCKSTEP, 10, NONE,
       "1 2 / 2 3 / 3 4 / 4 5 / 5 6 / 6 7 / 7 8 / 8 9", "icache_miss=8 fp_add_conflict=28", R(FADD, 1, 0, 0), HALT);
  CASE("Units", "a root of its own latency, then a division", NEAR,
       "special.pipelined=false special.rsqrt_latency_cycles=3", 14, NONE, "1 4 5 12 13",
       "icache_miss=1 special_conflict=2 wait_special=6", R1(FRSQRT, 1, 0), R(FDIV, 2, 0, 0), R(ADD, 0, 1, 1),
       R(ADD, 0, 2, 2), HALT);
  CASE("Units", "each of two units is taken for its latency", NEAR,
       "special.pipelined=false special.rsqrt_latency_cycles=3 special.units_per_tm=2", 11, NONE, "1 2 5 8 9 10",
       "icache_miss=1 special_conflict=4", R(FDIV, 1, 0, 0), R1(FRSQRT, 2, 0), R1(FRSQRT, 3, 0), R1(FRSQRT, 4, 0),
       R(FDIV, 5, 0, 0), HALT);
  CASE("Units", "a root of its own latency in a pipeline", NEAR, "special.rsqrt_latency_cycles=3", 12, NONE,
       "1 2 4 10 11", "icache_miss=1 wait_special=6", R1(FRSQRT, 1, 0), R(FDIV, 2, 0, 0), R(ADD, 0, 1, 1),
       R(ADD, 0, 2, 2), HALT);
  CASE("Units", "conversions and comparisons, fpu.compare_units=false", NEAR,
       "fpu.convert_latency_cycles=3 fpu.compare_latency_cycles=5 fpu.compare_units=false", 12, NONE, "1 4 5 10 11",
       "icache_miss=1 wait_other=6", R1(FCVT_S_W, 1, 0), R(ADD, 0, 1, 1), R(FMAX, 2, 0, 0), R(ADD, 0, 2, 2), HALT);
  CASE("Units", "conversions and comparisons, fpu.compare_units=true", NEAR,
       "fpu.convert_latency_cycles=3 fpu.compare_latency_cycles=5 fpu.compare_units=true", 12, NONE, "1 4 5 10 11",
       "icache_miss=1 wait_other=6", R1(FCVT_S_W, 1, 0), R(ADD, 0, 1, 1), R(FMAX, 2, 0, 0), R(ADD, 0, 2, 2), HALT);
  *count = n;
  return rules;
}
