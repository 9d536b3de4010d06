//===- TraxFormats.td - instruction formats ------------------------------===//
//
// Every instruction is one 32-bit little-endian word. The major opcode is in bits 31..26; register fields are five bits
// wide. Bits that no field covers are zero: a word with another value there is illegal.
//
// The assembler's operand order is the destination first; memory operands are written imm(ra).

include "TraxNumbers.td"

//--- operands ---------------------------------------------------------------

class TraxImmAsmOperand<string name, string diagnostic, string parser = ""> : AsmOperandClass {
  let Name = name;
  let ParserMethod = parser; // for operands that may be written by name
  let RenderMethod = "addImmOperands";
  let DiagnosticString = diagnostic;
}

def simm16 : Operand<i32>, ImmLeaf<i32, [{ return isInt<16>(Imm); }]> {
  let ParserMatchClass = TraxImmAsmOperand<"SImm16",
      "immediate must be an integer in the range [-32768, 32767], %lo(symbol) or %abs(symbol)">;
  let EncoderMethod = "encodeImm16";
  let DecoderMethod = "decodeSImm16";
}
// The upper half of a constant; written as an unsigned number.
def uimm16 : Operand<i32>, ImmLeaf<i32, [{ return isUInt<16>(Imm); }]> {
  let ParserMatchClass = TraxImmAsmOperand<"UImm16",
      "immediate must be an integer in the range [0, 65535] or %hi(symbol)">;
  let EncoderMethod = "encodeImm16";
}
def uimm5 : Operand<i32>, ImmLeaf<i32, [{ return isUInt<5>(Imm); }]> {
  let ParserMatchClass = TraxImmAsmOperand<"UImm5", "shift amount must be an integer in the range [0, 31]">;
}
// A number of a list, written by its name.
class TraxNamed<TraxNumbers numbers, string name, string what, string suffix>
    : Operand<i32>, ImmLeaf<i32, "return Imm >= " # numbers.First # " && Imm < " # numbers.Limit # ";"> {
  let ParserMatchClass = TraxImmAsmOperand<name,
      what # " must be " # !interleave(numbers.Names, ", ") # " or a number in the range [" # numbers.First # ", "
          # !add(numbers.Limit, -1) # "]",
      "parse" # suffix>;
  let PrintMethod = "print" # suffix;
  let DecoderMethod = "decode" # suffix;
}
def srnum : TraxNamed<SpecialRegisters, "SRNum", "special register", "SpecialRegister">;
def trapcode : TraxNamed<Traps, "TrapCode", "trap code", "TrapCode">;
def fencekind : TraxNamed<Fences, "FenceKind", "fence", "FenceKind">;
def brtarget : Operand<OtherVT> {
  let ParserMatchClass = TraxImmAsmOperand<"BrTarget",
      "branch target must be a symbol or a multiple of 4 in the range [-131072, 131068]">;
  let EncoderMethod = "encodeBrTarget";
  let DecoderMethod = "decodeBrTarget";
  let PrintMethod = "printPCRelOperand";
  let OperandType = "OPERAND_PCREL";
}
def jaltarget : Operand<OtherVT> {
  let ParserMatchClass = TraxImmAsmOperand<"JalTarget",
      "jump target must be a symbol or a multiple of 4 in the range [-4194304, 4194300]">;
  let EncoderMethod = "encodeJalTarget";
  let DecoderMethod = "decodeJalTarget";
  let PrintMethod = "printPCRelOperand";
  let OperandType = "OPERAND_PCREL";
}

//--- formats ----------------------------------------------------------------

class TraxFormat<string name, string what> {
  string FormatName = name;
  string Description = what;
}
def FormatR  : TraxFormat<"R", "register-register">;
def FormatR1 : TraxFormat<"R1", "one operand">;
def FormatI  : TraxFormat<"I", "immediate, load, jalr">;
def FormatSH : TraxFormat<"SH", "shift by a constant">;
def FormatU  : TraxFormat<"U", "upper immediate, special register">;
def FormatS  : TraxFormat<"S", "store">;
def FormatB  : TraxFormat<"B", "conditional branch">;
def FormatJ  : TraxFormat<"J", "jump and link">;
def FormatT  : TraxFormat<"T", "trap">;
def FormatF  : TraxFormat<"F", "fence">;
def FormatN  : TraxFormat<"N", "no operand">;

// The root of every real instruction. Semantics is a C statement over RD (an lvalue), RA, RB, IMM (sign extended where
// the operand is signed; branch offsets in bytes), PC (address of the instruction), NEXT_PC (an lvalue, PC + 4 on
// entry), GROUP_A and GROUP_B (the registers that follow ra and rb) and the functions of isa/include/trax/semantics.h;
// `uint32_t x = ...;` names a value. Manual is the sentence of docs/isa.md.
class TraxInst<TraxFormat format, bits<6> opcode, dag outs, dag ins, string asm, TraxUnit unit, code semantics,
               string manual> : Instruction {
  field bits<32> Inst;
  field bits<32> SoftFail = 0;
  let Namespace = "Trax";
  let DecoderNamespace = "Trax";
  let Size = 4;
  let Inst{31-26} = opcode;
  let OutOperandList = outs;
  let InOperandList = ins;
  let AsmString = asm;
  let Pattern = [];
  let SchedRW = [unit];
  let hasSideEffects = false;
  let mayLoad = false;
  let mayStore = false;

  TraxFormat Format = format;
  TraxUnit Unit = unit;
  code Semantics = semantics;
  string Manual = manual;
  bit IsFlop = false;       // counts in the paper's GFLOPS (adds and multiplies)
  bit IsCompare = false;    // floating-point comparison, minimum or maximum
  bit IsConversion = false; // between integers and floats
  bit IsRoot = false;       // reciprocal square root
  int ImmFirst = 0;         // immediates below are illegal
  int ImmLimit = -1;        // immediates from here on are illegal; -1: no limit
  int AccessBytes = 0;      // memory access size
  bit IsNontemporal = false;
  bit IsAtomic = false;
  bit ReadsRD = false;      // RD is an input too (conditional moves)
  int GroupA = 1;           // registers that are read from ra on
  int GroupB = 1;           // registers that are read from rb on
}

// bits<5> fields are filled from the operand of the same name.
class InstR<bits<6> op, bits<6> func, string mnemonic, TraxUnit unit, code semantics, string manual>
    : TraxInst<FormatR, op, (outs GPR:$rd), (ins GPR:$ra, GPR:$rb), mnemonic#"\t$rd, $ra, $rb", unit, semantics, manual> {
  bits<5> rd; bits<5> ra; bits<5> rb;
  let Inst{25-21} = rd; let Inst{20-16} = ra; let Inst{15-11} = rb; let Inst{10-6} = 0; let Inst{5-0} = func;
}
class InstR1<bits<6> op, bits<6> func, string mnemonic, TraxUnit unit, code semantics, string manual>
    : TraxInst<FormatR1, op, (outs GPR:$rd), (ins GPR:$ra), mnemonic#"\t$rd, $ra", unit, semantics, manual> {
  bits<5> rd; bits<5> ra;
  let Inst{25-21} = rd; let Inst{20-16} = ra; let Inst{15-6} = 0; let Inst{5-0} = func;
}
// Conditional move: rd keeps its value where the condition does not hold.
class InstCMov<bits<6> op, bits<6> func, string mnemonic, code semantics, string manual>
    : TraxInst<FormatR, op, (outs GPR:$rd), (ins GPR:$old, GPR:$ra, GPR:$rb), mnemonic#"\t$rd, $ra, $rb", UnitInt, semantics,
               manual> {
  bits<5> rd; bits<5> ra; bits<5> rb;
  let Inst{25-21} = rd; let Inst{20-16} = ra; let Inst{15-11} = rb; let Inst{10-6} = 0; let Inst{5-0} = func;
  let Constraints = "$rd = $old";
  let isCommutable = true; // the other conditional move, with rd's old value and ra exchanged
  let ReadsRD = true;
}
// Reads rd, a registers from ra on and b from rb on; r31 is followed by r0, r1 and so on.
class InstGroups<bits<6> op, bits<6> func, string mnemonic, TraxUnit unit, int a, int b, code semantics, string manual>
    : TraxInst<FormatR, op, (outs GPR:$rd), (ins GPR:$old, GPR:$ra, GPR:$rb), mnemonic#"\t$rd, $ra, $rb", unit, semantics,
               manual> {
  bits<5> rd; bits<5> ra; bits<5> rb;
  let Inst{25-21} = rd; let Inst{20-16} = ra; let Inst{15-11} = rb; let Inst{10-6} = 0; let Inst{5-0} = func;
  let Constraints = "$rd = $old";
  let ReadsRD = true;
  let GroupA = a;
  let GroupB = b;
}
// The same for the compiler: ra and rb are groups (TraxRegisters.td). The encoding has the first register of each.
class InstOfGroups<bits<6> op, bits<6> func, string mnemonic, TraxUnit unit, int a, int b> : Instruction {
  field bits<32> Inst;
  bits<5> rd; bits<5> ra; bits<5> rb;
  let Inst{31-26} = op; let Inst{25-21} = rd; let Inst{20-16} = ra; let Inst{15-11} = rb; let Inst{10-6} = 0;
  let Inst{5-0} = func;
  let Namespace = "Trax";
  let Size = 4;
  let OutOperandList = (outs GPR:$rd);
  let InOperandList = (ins GPR:$old, !cast<RegisterClass>("Group"#a):$ra, !cast<RegisterClass>("Group"#b):$rb);
  let AsmString = mnemonic#"\t$rd, $ra, $rb";
  let Constraints = "$rd = $old";
  let isCodeGenOnly = true;
  let hasSideEffects = false;
  let mayLoad = false;
  let mayStore = false;
  let SchedRW = [unit];
}
multiclass TraxGroups<bits<6> op, bits<6> func, string mnemonic, TraxUnit unit, int a, int b, code semantics, string manual> {
  def "" : InstGroups<op, func, mnemonic, unit, a, b, semantics, manual>;
  def OfGroups : InstOfGroups<op, func, mnemonic, unit, a, b>;
}
class InstI<bits<6> op, string mnemonic, code semantics, string manual>
    : TraxInst<FormatI, op, (outs GPR:$rd), (ins GPR:$ra, simm16:$imm), mnemonic#"\t$rd, $ra, $imm", UnitInt, semantics, manual> {
  bits<5> rd; bits<5> ra; bits<16> imm;
  let Inst{25-21} = rd; let Inst{20-16} = ra; let Inst{15-0} = imm;
}
class InstSH<bits<6> op, string mnemonic, code semantics, string manual>
    : TraxInst<FormatSH, op, (outs GPR:$rd), (ins GPR:$ra, uimm5:$imm), mnemonic#"\t$rd, $ra, $imm", UnitInt, semantics, manual> {
  bits<5> rd; bits<5> ra; bits<5> imm;
  let Inst{25-21} = rd; let Inst{20-16} = ra; let Inst{15-5} = 0; let Inst{4-0} = imm;
}
class InstU<bits<6> op, string mnemonic, Operand operand, TraxUnit unit, code semantics, string manual>
    : TraxInst<FormatU, op, (outs GPR:$rd), (ins operand:$imm), mnemonic#"\t$rd, $imm", unit, semantics, manual> {
  bits<5> rd; bits<16> imm;
  let Inst{25-21} = rd; let Inst{20-16} = 0; let Inst{15-0} = imm;
}
class InstLoad<bits<6> op, int bytes, string mnemonic, code semantics, string manual>
    : TraxInst<FormatI, op, (outs GPR:$rd), (ins GPR:$ra, simm16:$imm), mnemonic#"\t$rd, ${imm}(${ra})", UnitMemory, semantics,
               manual> {
  bits<5> rd; bits<5> ra; bits<16> imm;
  let Inst{25-21} = rd; let Inst{20-16} = ra; let Inst{15-0} = imm;
  let mayLoad = true;
  let AccessBytes = bytes;
}
class InstStore<bits<6> op, int bytes, string mnemonic, code semantics, string manual>
    : TraxInst<FormatS, op, (outs), (ins GPR:$rb, GPR:$ra, simm16:$imm), mnemonic#"\t$rb, ${imm}(${ra})", UnitMemory, semantics,
               manual> {
  bits<5> rb; bits<5> ra; bits<16> imm;
  let Inst{25-21} = rb; let Inst{20-16} = ra; let Inst{15-0} = imm;
  let mayStore = true;
  let AccessBytes = bytes;
}
// A branch if a condition holds, or unless it does: two of the same condition are each other's inverse.
class InstB<bits<6> op, string mnemonic, string condition, string sense, code semantics, string manual>
    : TraxInst<FormatB, op, (outs), (ins GPR:$ra, GPR:$rb, brtarget:$offset), mnemonic#"\t$ra, $rb, $offset", UnitControl,
               semantics, manual> {
  bits<5> ra; bits<5> rb; bits<16> offset;
  let Inst{25-21} = ra; let Inst{20-16} = rb; let Inst{15-0} = offset;
  let isBranch = true;
  let isTerminator = true;
  string Condition = condition;
  string Sense = sense; // "if" or "unless"
}
