//===- TraxInstructions.td - every instruction, once ---------------------===//
//
// Encoding, operands, unit, semantics in C and sentence for the manual. Assembler, disassembler, decoder, emulator and
// docs/isa.md are generated from here. To add an instruction: add a def, and, if the compiler should choose it by itself, a
// pattern in llvm-target/TraxPatterns.td.

//--- integer, register-register: opcode 1 -----------------------------------
def ADD  : InstR<1, 0, "add", UnitInt, [{ RD = RA + RB; }], "Sum modulo 2^32.">;
def SUB  : InstR<1, 1, "sub", UnitInt, [{ RD = RA - RB; }], "Difference modulo 2^32.">;
def AND  : InstR<1, 2, "and", UnitInt, [{ RD = RA & RB; }], "Bitwise and.">;
def OR   : InstR<1, 3, "or", UnitInt, [{ RD = RA | RB; }], "Bitwise or.">;
def XOR  : InstR<1, 4, "xor", UnitInt, [{ RD = RA ^ RB; }], "Bitwise exclusive or.">;
def SLL  : InstR<1, 5, "sll", UnitInt, [{ RD = RA << (RB & 31); }], "Shift left by the low five bits of rb.">;
def SRL  : InstR<1, 6, "srl", UnitInt, [{ RD = RA >> (RB & 31); }], "Shift right by the low five bits of rb, zeros in.">;
def SRA  : InstR<1, 7, "sra", UnitInt, [{ RD = trax_sra(RA, RB & 31); }],
                 "Shift right by the low five bits of rb, copies of the sign bit in.">;
def SLT  : InstR<1, 8, "slt", UnitInt, [{ RD = trax_signed(RA) < trax_signed(RB); }],
                 "1 if ra is less than rb as signed numbers, else 0.">;
def SLTU : InstR<1, 9, "sltu", UnitInt, [{ RD = RA < RB; }], "1 if ra is less than rb as unsigned numbers, else 0.">;
def CMOVNZ : InstCMov<1, 10, "cmovnz", [{ if (RB != 0) RD = RA; }], "rd becomes ra if rb is not zero, else it keeps its value.">;
def CMOVZ  : InstCMov<1, 11, "cmovz", [{ if (RB == 0) RD = RA; }], "rd becomes ra if rb is zero, else it keeps its value.">;
def MIN  : InstR<1, 12, "min", UnitInt, [{ RD = trax_signed(RA) < trax_signed(RB) ? RA : RB; }], "The lesser operand, as signed numbers.">;
def MAX  : InstR<1, 13, "max", UnitInt, [{ RD = trax_signed(RA) < trax_signed(RB) ? RB : RA; }], "The greater operand, as signed numbers.">;
def MINU : InstR<1, 14, "minu", UnitInt, [{ RD = RA < RB ? RA : RB; }], "The lesser operand, as unsigned numbers.">;
def MAXU : InstR<1, 15, "maxu", UnitInt, [{ RD = RA < RB ? RB : RA; }], "The greater operand, as unsigned numbers.">;

//--- integer multiply: opcode 2 ---------------------------------------------
def MUL   : InstR<2, 0, "mul", UnitIntMul, [{ RD = RA * RB; }], "Low word of the product.">;
def MULH  : InstR<2, 1, "mulh", UnitIntMul, [{ RD = trax_mulh(RA, RB); }], "High word of the signed product.">;
def MULHU : InstR<2, 2, "mulhu", UnitIntMul, [{ RD = (uint32_t)(((uint64_t)RA * RB) >> 32); }],
                  "High word of the unsigned product.">;

//--- floating point: opcodes 3 to 6 -----------------------------------------
let IsFlop = true in {
def FADD : InstR<3, 0, "fadd", UnitFPAdd, [{ RD = trax_fadd(RA, RB); }], "Sum, rounded to nearest even.">;
def FSUB : InstR<3, 1, "fsub", UnitFPAdd, [{ RD = trax_fsub(RA, RB); }], "Difference, rounded to nearest even.">;
def FMUL : InstR<4, 0, "fmul", UnitFPMul, [{ RD = trax_fmul(RA, RB); }], "Product, rounded to nearest even.">;
}
let IsCompare = true in {
def FMIN : InstR<3, 2, "fmin", UnitFPAdd, [{ RD = trax_fmin(RA, RB); }],
                 "The lesser operand (-0 is less than +0); the number if one operand is a NaN (IEEE 754-2019 minimumNumber).">;
def FMAX : InstR<3, 3, "fmax", UnitFPAdd, [{ RD = trax_fmax(RA, RB); }],
                 "The greater operand (+0 is greater than -0); the number if one operand is a NaN (IEEE 754-2019 maximumNumber).">;
def FEQ  : InstR<3, 4, "feq", UnitFPAdd, [{ RD = trax_feq(RA, RB); }], "1 if ra equals rb, else 0; 0 if either is a NaN.">;
def FLT  : InstR<3, 5, "flt", UnitFPAdd, [{ RD = trax_flt(RA, RB); }], "1 if ra is less than rb, else 0; 0 if either is a NaN.">;
def FLE  : InstR<3, 6, "fle", UnitFPAdd, [{ RD = trax_fle(RA, RB); }],
                 "1 if ra is less than or equal to rb, else 0; 0 if either is a NaN.">;
}
let IsConversion = true in {
def FCVT_W_S  : InstR1<5, 0, "fcvt.w.s", UnitFPAdd, [{ RD = trax_fcvt_w_s(RA); }],
                       "Float to signed integer, towards zero; saturates, NaN gives 0.">;
def FCVT_WU_S : InstR1<5, 1, "fcvt.wu.s", UnitFPAdd, [{ RD = trax_fcvt_wu_s(RA); }],
                       "Float to unsigned integer, towards zero; saturates (negative gives 0), NaN gives 0.">;
def FCVT_S_W  : InstR1<5, 2, "fcvt.s.w", UnitFPAdd, [{ RD = trax_fcvt_s_w(RA); }],
                       "Signed integer to float, rounded to nearest even.">;
def FCVT_S_WU : InstR1<5, 3, "fcvt.s.wu", UnitFPAdd, [{ RD = trax_fcvt_s_wu(RA); }],
                       "Unsigned integer to float, rounded to nearest even.">;
}
def FDIV   : InstR<6, 0, "fdiv", UnitSpecial, [{ RD = FPDIV(RA, RB); }],
                   "Quotient, rounded to nearest even (the paper's FPDIV); to the unit's precision where the configuration reduces it.">;
let IsRoot = true in
def FRSQRT : InstR1<6, 1, "frsqrt", UnitSpecial, [{ RD = ISQRT(RA); }],
                    "Reciprocal square root, correctly rounded (IEEE 754-2019 rSqrt, the paper's iSQRT): +-0 gives +-infinity, +infinity gives +0, a negative number gives NaN.">;

//--- ray unit: opcode 7 --------------------------------------------------------
// A ray has a factor and an offset for each axis: the reciprocal of its direction, and the origin times that. The distance
// of a plane is the plane times the factor, minus the offset.
defm FBOX : TraxGroups<7, 0, "fbox", UnitRayBox, 6, 6, [{
  uint32_t x0 = trax_fsub(trax_fmul(GROUP_B(0), GROUP_A(0)), GROUP_A(3));
  uint32_t y0 = trax_fsub(trax_fmul(GROUP_B(1), GROUP_A(1)), GROUP_A(4));
  uint32_t z0 = trax_fsub(trax_fmul(GROUP_B(2), GROUP_A(2)), GROUP_A(5));
  uint32_t x1 = trax_fsub(trax_fmul(GROUP_B(3), GROUP_A(0)), GROUP_A(3));
  uint32_t y1 = trax_fsub(trax_fmul(GROUP_B(4), GROUP_A(1)), GROUP_A(4));
  uint32_t z1 = trax_fsub(trax_fmul(GROUP_B(5), GROUP_A(2)), GROUP_A(5));
  uint32_t enter = trax_fmax(trax_fmax(trax_fmin(x0, x1), trax_fmin(y0, y1)), trax_fmax(trax_fmin(z0, z1), 0));
  uint32_t leave = trax_fmin(trax_fmin(trax_fmax(x0, x1), trax_fmax(y0, y1)), trax_fmin(trax_fmax(z0, z1), RD));
  RD = trax_fle(enter, leave) ? enter : 0x7F800000;
}], "Where a ray enters a box: rd becomes the distance, or infinity if the ray misses the box or enters it behind the old rd.">;
defm FTRI : TraxGroups<7, 1, "ftri", UnitRayTriangle, 6, 9, [{
  uint32_t ex = trax_fsub(GROUP_B(3), GROUP_B(0));
  uint32_t ey = trax_fsub(GROUP_B(4), GROUP_B(1));
  uint32_t ez = trax_fsub(GROUP_B(5), GROUP_B(2));
  uint32_t fx = trax_fsub(GROUP_B(6), GROUP_B(0));
  uint32_t fy = trax_fsub(GROUP_B(7), GROUP_B(1));
  uint32_t fz = trax_fsub(GROUP_B(8), GROUP_B(2));
  uint32_t tx = trax_fsub(GROUP_A(0), GROUP_B(0));
  uint32_t ty = trax_fsub(GROUP_A(1), GROUP_B(1));
  uint32_t tz = trax_fsub(GROUP_A(2), GROUP_B(2));
  uint32_t px = trax_fsub(trax_fmul(GROUP_A(4), fz), trax_fmul(GROUP_A(5), fy));
  uint32_t py = trax_fsub(trax_fmul(GROUP_A(5), fx), trax_fmul(GROUP_A(3), fz));
  uint32_t pz = trax_fsub(trax_fmul(GROUP_A(3), fy), trax_fmul(GROUP_A(4), fx));
  uint32_t qx = trax_fsub(trax_fmul(ty, ez), trax_fmul(tz, ey));
  uint32_t qy = trax_fsub(trax_fmul(tz, ex), trax_fmul(tx, ez));
  uint32_t qz = trax_fsub(trax_fmul(tx, ey), trax_fmul(ty, ex));
  uint32_t d = trax_fadd(trax_fadd(trax_fmul(ex, px), trax_fmul(ey, py)), trax_fmul(ez, pz));
  uint32_t u = trax_fadd(trax_fadd(trax_fmul(tx, px), trax_fmul(ty, py)), trax_fmul(tz, pz));
  uint32_t v = trax_fadd(trax_fadd(trax_fmul(GROUP_A(3), qx), trax_fmul(GROUP_A(4), qy)), trax_fmul(GROUP_A(5), qz));
  uint32_t s = trax_fadd(trax_fadd(trax_fmul(fx, qx), trax_fmul(fy, qy)), trax_fmul(fz, qz));
  uint32_t sign = d & 0x80000000;
  uint32_t distance = FPDIV(s, d);
  if (trax_fle(0, u ^ sign) && trax_fle(0, v ^ sign) && trax_fle(trax_fadd(u, v) ^ sign, d ^ sign) && trax_flt(0, distance))
    RD = trax_fmin(distance, RD);
}], "Where a ray hits a triangle: rd becomes the distance if that is before the old rd, else it keeps its value.">;

//--- immediates --------------------------------------------------------------
let isReMaterializable = true, isAsCheapAsAMove = true in
def ADDI  : InstI<8, "addi", [{ RD = RA + IMM; }], "Sum modulo 2^32 with a sign-extended immediate.">;
def ANDI  : InstI<9, "andi", [{ RD = RA & IMM; }], "Bitwise and with a sign-extended immediate.">;
def ORI   : InstI<10, "ori", [{ RD = RA | IMM; }], "Bitwise or with a sign-extended immediate.">;
def XORI  : InstI<11, "xori", [{ RD = RA ^ IMM; }], "Bitwise exclusive or with a sign-extended immediate.">;
def SLTI  : InstI<12, "slti", [{ RD = trax_signed(RA) < trax_signed(IMM); }],
                  "1 if ra is less than the sign-extended immediate as signed numbers, else 0.">;
def SLTIU : InstI<13, "sltiu", [{ RD = RA < IMM; }],
                  "1 if ra is less than the sign-extended immediate as unsigned numbers, else 0.">;
def SLLI  : InstSH<14, "slli", [{ RD = RA << IMM; }], "Shift left by a constant.">;
def SRLI  : InstSH<15, "srli", [{ RD = RA >> IMM; }], "Shift right by a constant, zeros in.">;
def SRAI  : InstSH<16, "srai", [{ RD = trax_sra(RA, IMM); }], "Shift right by a constant, copies of the sign bit in.">;
let isReMaterializable = true, isAsCheapAsAMove = true in
def LUI   : InstU<17, "lui", uimm16, UnitInt, [{ RD = IMM << 16; }],
                  "The immediate in the upper half, zeros in the lower.">;

//--- memory ------------------------------------------------------------------
def LB  : InstLoad<20, 1, "lb", [{ RD = trax_sext8(LOAD8(RA + IMM)); }], "Load a byte, sign extended.">;
def LBU : InstLoad<21, 1, "lbu", [{ RD = LOAD8(RA + IMM); }], "Load a byte, zero extended.">;
def LH  : InstLoad<22, 2, "lh", [{ RD = trax_sext16(LOAD16(RA + IMM)); }],
                   "Load a half word, sign extended; the address must be a multiple of 2.">;
def LHU : InstLoad<23, 2, "lhu", [{ RD = LOAD16(RA + IMM); }], "Load a half word, zero extended; the address must be a multiple of 2.">;
def LW  : InstLoad<24, 4, "lw", [{ RD = LOAD32(RA + IMM); }], "Load a word; the address must be a multiple of 4.">;
let IsNontemporal = true in
def LWNT : InstLoad<25, 4, "lwnt", [{ RD = LOAD32_NONTEMPORAL(RA + IMM); }],
                    "Load a word past the data cache; the address must be a multiple of 4.">;
def SB  : InstStore<26, 1, "sb", [{ STORE8(RA + IMM, RB); }], "Store the low byte.">;
def SH  : InstStore<27, 2, "sh", [{ STORE16(RA + IMM, RB); }], "Store the low half word; the address must be a multiple of 2.">;
def SW  : InstStore<28, 4, "sw", [{ STORE32(RA + IMM, RB); }], "Store a word; the address must be a multiple of 4.">;
let IsNontemporal = true in
def SWNT : InstStore<29, 4, "swnt", [{ STORE32_NONTEMPORAL(RA + IMM, RB); }],
                     "Store a word past the data cache; the address must be a multiple of 4.">;
let IsAtomic = true, mayStore = true, hasSideEffects = true in
def AINC : InstLoad<30, 4, "ainc", [{ RD = ATOMIC_INC(RA + IMM); }],
                    "Atomic increment of a word of global memory: rd receives the value before it; the address must be a multiple of 4.">;

//--- control -----------------------------------------------------------------
def BEQ  : InstB<32, "beq", "eq", "if", [{ if (RA == RB) NEXT_PC = PC + IMM; }], "Branch if equal.">;
def BNE  : InstB<33, "bne", "eq", "unless", [{ if (RA != RB) NEXT_PC = PC + IMM; }], "Branch if not equal.">;
def BLT  : InstB<34, "blt", "lt", "if", [{ if (trax_signed(RA) < trax_signed(RB)) NEXT_PC = PC + IMM; }],
                 "Branch if less, as signed numbers.">;
def BGE  : InstB<35, "bge", "lt", "unless", [{ if (trax_signed(RA) >= trax_signed(RB)) NEXT_PC = PC + IMM; }],
                 "Branch if greater or equal, as signed numbers.">;
def BLTU : InstB<36, "bltu", "ltu", "if", [{ if (RA < RB) NEXT_PC = PC + IMM; }], "Branch if less, as unsigned numbers.">;
def BGEU : InstB<37, "bgeu", "ltu", "unless", [{ if (RA >= RB) NEXT_PC = PC + IMM; }], "Branch if greater or equal, as unsigned numbers.">;

let isBranch = true in
def JAL : TraxInst<FormatJ, 38, (outs GPR:$rd), (ins jaltarget:$offset), "jal\t$rd, $offset", UnitControl,
                   [{ NEXT_PC = PC + IMM; RD = PC + 4; }], "Jump; rd receives the address of the next instruction."> {
  bits<5> rd; bits<21> offset;
  let Inst{25-21} = rd; let Inst{20-0} = offset;
}
let isBranch = true, isIndirectBranch = true in
def JALR : TraxInst<FormatI, 39, (outs GPR:$rd), (ins GPR:$ra, simm16:$imm), "jalr\t$rd, ${imm}(${ra})", UnitControl,
                    [{ NEXT_PC = RA + IMM; RD = PC + 4; }],
                    "Jump to ra plus the immediate, which must be a multiple of 4; rd receives the address of the next instruction."> {
  bits<5> rd; bits<5> ra; bits<16> imm;
  let Inst{25-21} = rd; let Inst{20-16} = ra; let Inst{15-0} = imm;
}

//--- system ------------------------------------------------------------------
let hasSideEffects = true in {
let ImmLimit = SpecialRegisters.Limit in
def RDSR : InstU<40, "rdsr", srnum, UnitControl, [{ RD = SPECIAL_REGISTER(IMM); }],
                 "Read a special register; an unknown one is an illegal instruction.">;
let ImmLimit = Traps.Limit in
def TRAP : TraxInst<FormatT, 41, (outs), (ins GPR:$ra, trapcode:$imm), "trap\t$ra, $imm", UnitControl, [{ TRAP(RA, IMM); }],
                    "Call the host; an unknown code is an illegal instruction."> {
  bits<5> ra; bits<16> imm;
  let Inst{25-21} = 0; let Inst{20-16} = ra; let Inst{15-0} = imm;
}
// To the compiler an access to all of memory; the machine accesses none.
let ImmFirst = Fences.First, ImmLimit = Fences.Limit, mayLoad = true, mayStore = true in
def FENCE : TraxInst<FormatF, 43, (outs), (ins fencekind:$imm), "fence\t$imm", UnitControl, [{ FENCE(IMM); }],
                     "Order memory accesses: r waits for earlier loads and empties the TM's data cache, w waits until earlier stores are performed, rw does both; another number is an illegal instruction."> {
  bits<16> imm;
  let Inst{25-16} = 0; let Inst{15-0} = imm;
}
let isTerminator = true, isBarrier = true in
def HALT : TraxInst<FormatN, 42, (outs), (ins), "halt", UnitControl, [{ HALT(); }], "End the thread with status 0."> {
  let Inst{25-0} = 0;
}
}
