//===- TraxPseudos.td - Pseudo-instructions of code generation -----------===//
//
// Code generation distinguishes operations that are one instruction to the machine: a jump, a call, a return and a tail
// call are all jal or jalr. The assembler's shorthands are in isa/TraxAliases.td.

class TraxPseudo<dag outs, dag ins, list<dag> pattern = []> : Instruction {
  let Namespace = "Trax";
  let OutOperandList = outs;
  let InOperandList = ins;
  let Pattern = pattern;
  let isPseudo = true;
  let isCodeGenOnly = true;
  let hasSideEffects = false;
  let mayLoad = false;
  let mayStore = false;
  let Size = 4;
  let SchedRW = [UnitControl];
}

// The callee of an indirect tail call must survive the epilogue, which restores the saved registers.
def GPRTC : RegisterClass<"Trax", [i32, f32], 32, (add (sequence "R%u", 12, 19), (sequence "R%u", 11, 4))>;

let isBranch = true, isTerminator = true, isBarrier = true in {
def PseudoBR : TraxPseudo<(outs), (ins jaltarget:$offset), [(br bb:$offset)]>,
               PseudoInstExpansion<(JAL R0, jaltarget:$offset)>;
let isIndirectBranch = true in
def PseudoBRIND : TraxPseudo<(outs), (ins GPR:$ra, simm16:$imm)>; // jalr r0, marked by TraxAsmPrinter
}

// An address, where jaltarget is a block; TraxAsmPrinter makes the one from the other.
def calltarget : Operand<i32>;

let isCall = true, Defs = [R1], Uses = [R2] in {
def PseudoCALL : TraxPseudo<(outs), (ins calltarget:$callee, variable_ops)>; // jal r1
def PseudoCALLIndirect : TraxPseudo<(outs), (ins GPR:$ra, variable_ops)>,
                         PseudoInstExpansion<(JALR R1, GPR:$ra, 0)>;
}

let isReturn = true, isTerminator = true, isBarrier = true in {
// Reads ra, which every function counts among the saved registers.
def PseudoRET : TraxPseudo<(outs), (ins variable_ops)>, PseudoInstExpansion<(JALR R0, R1, 0)>;
let isCall = true, Uses = [R2] in {
def PseudoTAIL : TraxPseudo<(outs), (ins calltarget:$callee, variable_ops)>; // jal r0
def PseudoTAILIndirect : TraxPseudo<(outs), (ins GPRTC:$ra, variable_ops)>; // jalr r0
}
}

// Special registers that never change while a thread runs (thread, tm, tp, threads) can be read again anywhere.
let isReMaterializable = true, isAsCheapAsAMove = true in
def PseudoRDSRConst : TraxPseudo<(outs GPR:$rd), (ins srnum:$imm)>, PseudoInstExpansion<(RDSR GPR:$rd, srnum:$imm)>;

// An address: computed again rather than kept in memory where registers are short.
let isReMaterializable = true, Size = 8, SchedRW = [UnitInt] in
def PseudoLUIADDI : TraxPseudo<(outs GPR:$rd), (ins uimm16:$upper, simm16:$lower)>;

// halt in the middle of a block: the code after it may not be marked as unreachable.
let hasSideEffects = true in
def PseudoHALT : TraxPseudo<(outs), (ins)>, PseudoInstExpansion<(HALT)>;

// Waits until the register can be used.
let hasSideEffects = true in
def PseudoWAIT : TraxPseudo<(outs), (ins GPR:$ra)>, PseudoInstExpansion<(ADDI R0, GPR:$ra, 0)>;

// Copies a long argument to where it is passed.
let mayLoad = true, mayStore = true, usesCustomInserter = true, hasNoSchedulingInfo = true in
def PseudoCopyLoop : TraxPseudo<(outs), (ins GPR:$to, GPR:$from, i32imm:$bytes, i32imm:$unit)>;

// __builtin_setjmp and __builtin_longjmp, see TraxSjLj.cpp. The setup emits no code: it
// marks where all registers may have other values.
let hasSideEffects = true, hasNoSchedulingInfo = true in {
let usesCustomInserter = true in
def PseudoSETJMP : TraxPseudo<(outs GPR:$rd), (ins GPR:$buffer)>;
let isTerminator = true, Size = 0 in
def PseudoSjLjSetup : TraxPseudo<(outs), (ins jaltarget:$again)>;
let isTerminator = true, isBarrier = true, Defs = [R1], Size = 20 in
def PseudoLONGJMP : TraxPseudo<(outs), (ins GPRTC:$buffer)>;
}

// Groups of registers to and from the stack.
foreach n = [6, 9] in {
let mayStore = true, Size = !mul(4, n) in
def PseudoSpillGroup#n : TraxPseudo<(outs), (ins !cast<RegisterClass>("Group"#n):$group, GPR:$ra, simm16:$imm)>;
let mayLoad = true, Size = !mul(4, n) in
def PseudoReloadGroup#n : TraxPseudo<(outs !cast<RegisterClass>("Group"#n):$group), (ins GPR:$ra, simm16:$imm)>;
}

let Defs = [R2], Uses = [R2], hasNoSchedulingInfo = true, Size = 0 in {
def ADJCALLSTACKDOWN : TraxPseudo<(outs), (ins i32imm:$size, i32imm:$unused)>;
def ADJCALLSTACKUP : TraxPseudo<(outs), (ins i32imm:$size, i32imm:$unused)>;
}
