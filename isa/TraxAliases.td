//===- TraxAliases.td - shorthands of the assembler ----------------------===//
//
// Other names for instructions, and pseudo-instructions that put a constant or an address in a register.

// Pseudo-instructions without an encoding: the assembler chooses instructions. The manual shows Expansion.
class TraxAsmPseudo<dag ins, string asm, string expansion> : Instruction {
  string Expansion = expansion;
  let Namespace = "Trax";
  let OutOperandList = (outs GPR:$rd);
  let InOperandList = ins;
  let AsmString = asm;
  let Pattern = [];
  let isPseudo = true;
  let isAsmParserOnly = true;
  let hasNoSchedulingInfo = true;
  let hasSideEffects = false;
  let mayLoad = false;
  let mayStore = false;
}

def imm32 : Operand<i32> {
  let ParserMatchClass = TraxImmAsmOperand<"Imm32", "immediate must be an integer of 32 bits">;
}
def symbol : Operand<i32> {
  let ParserMatchClass = TraxImmAsmOperand<"Symbol", "operand must be a symbol">;
}

def PseudoLI : TraxAsmPseudo<(ins imm32:$imm), "li\t$rd, $imm",
    "if imm does not fit 16 bits: `lui rd, %hi(imm)`; `addi rd, rd, %lo(imm)`, the latter unless %lo(imm) is 0">;
def PseudoLA : TraxAsmPseudo<(ins symbol:$imm), "la\t$rd, $imm", "`lui rd, %hi(imm)`; `addi rd, rd, %lo(imm)`">;

// The last argument: whether the disassembler prefers the alias.
def : InstAlias<"nop", (ADDI R0, R0, 0), 3>;
def : InstAlias<"li\t$rd, $imm", (ADDI GPR:$rd, R0, simm16:$imm), 2>;
def : InstAlias<"mv\t$rd, $ra", (ADDI GPR:$rd, GPR:$ra, 0), 1>;
def : InstAlias<"not\t$rd, $ra", (XORI GPR:$rd, GPR:$ra, -1)>;
def : InstAlias<"neg\t$rd, $rb", (SUB GPR:$rd, R0, GPR:$rb)>;
def : InstAlias<"seqz\t$rd, $ra", (SLTIU GPR:$rd, GPR:$ra, 1)>;
def : InstAlias<"snez\t$rd, $rb", (SLTU GPR:$rd, R0, GPR:$rb)>;
def : InstAlias<"sltz\t$rd, $ra", (SLT GPR:$rd, GPR:$ra, R0)>;
def : InstAlias<"sgtz\t$rd, $rb", (SLT GPR:$rd, R0, GPR:$rb)>;
def : InstAlias<"sgt\t$rd, $ra, $rb", (SLT GPR:$rd, GPR:$rb, GPR:$ra), 0>;
def : InstAlias<"sgtu\t$rd, $ra, $rb", (SLTU GPR:$rd, GPR:$rb, GPR:$ra), 0>;
def : InstAlias<"fgt\t$rd, $ra, $rb", (FLT GPR:$rd, GPR:$rb, GPR:$ra), 0>;
def : InstAlias<"fge\t$rd, $ra, $rb", (FLE GPR:$rd, GPR:$rb, GPR:$ra), 0>;

def : InstAlias<"beqz\t$ra, $offset", (BEQ GPR:$ra, R0, brtarget:$offset)>;
def : InstAlias<"bnez\t$ra, $offset", (BNE GPR:$ra, R0, brtarget:$offset)>;
def : InstAlias<"bltz\t$ra, $offset", (BLT GPR:$ra, R0, brtarget:$offset)>;
def : InstAlias<"bgez\t$ra, $offset", (BGE GPR:$ra, R0, brtarget:$offset)>;
def : InstAlias<"bgtz\t$rb, $offset", (BLT R0, GPR:$rb, brtarget:$offset)>;
def : InstAlias<"blez\t$rb, $offset", (BGE R0, GPR:$rb, brtarget:$offset)>;
def : InstAlias<"bgt\t$ra, $rb, $offset", (BLT GPR:$rb, GPR:$ra, brtarget:$offset), 0>;
def : InstAlias<"ble\t$ra, $rb, $offset", (BGE GPR:$rb, GPR:$ra, brtarget:$offset), 0>;
def : InstAlias<"bgtu\t$ra, $rb, $offset", (BLTU GPR:$rb, GPR:$ra, brtarget:$offset), 0>;
def : InstAlias<"bleu\t$ra, $rb, $offset", (BGEU GPR:$rb, GPR:$ra, brtarget:$offset), 0>;

def : InstAlias<"j\t$offset", (JAL R0, jaltarget:$offset)>;
def : InstAlias<"call\t$offset", (JAL R1, jaltarget:$offset)>;
def : InstAlias<"jal\t$offset", (JAL R1, jaltarget:$offset), 0>;
def : InstAlias<"ret", (JALR R0, R1, 0), 2>;
def : InstAlias<"jr\t$ra", (JALR R0, GPR:$ra, 0)>;
def : InstAlias<"jalr\t$ra", (JALR R1, GPR:$ra, 0)>;
