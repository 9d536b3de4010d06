//===- Trax.td - The TRaX target -----------------------------------------===//
//
// The instructions themselves are described in isa/; this folder adds what a compiler needs beyond their meaning.

include "llvm/Target/Target.td"

// isa/
include "TraxRegisters.td"
include "TraxUnits.td"
include "TraxFormats.td"
include "TraxInstructions.td"
include "TraxAliases.td"

// here
include "TraxSchedule.td"
include "TraxCallingConv.td"
include "TraxPseudos.td"
include "TraxPatterns.td"

def TraxInstrInfo : InstrInfo;

// The inverse of a conditional branch.
class InverseBranch<string from, string to> : InstrMapping {
  let FilterClass = "InstB";
  let RowFields = ["Condition"];
  let ColFields = ["Sense"];
  let KeyCol = [from];
  let ValueCols = [[to]];
}
def inverseOfIf : InverseBranch<"if", "unless">;
def inverseOfUnless : InverseBranch<"unless", "if">;

def TraxAsmParser : AsmParser;

def TraxAsmWriter : AsmWriter {
  let PassSubtarget = 1;
}

// Code for programs linked with -mstack=global (docs/abi.md, "Program start").
def FeatureGlobalStack
    : SubtargetFeature<"global-stack", "HasGlobalStack", "true", "The stack is in global memory">;
// Code for stacks in either memory.
def FeatureEitherStack
    : SubtargetFeature<"either-stack", "HasEitherStack", "true", "The stack may be in local or in global memory">;

// -ffixed-rN.
foreach i = 4-31 in
  def FeatureReserveR#i
      : SubtargetFeature<"reserve-r"#i, "ReservedRegisters["#i#"]", "true", "Generated code does not use r"#i>;

def : ProcessorModel<"generic", TraxModel, []>;

def Trax : Target {
  let InstructionSet = TraxInstrInfo;
  let AssemblyParsers = [TraxAsmParser];
  let AssemblyWriters = [TraxAsmWriter];
  let AllowRegisterRenaming = true; // else copies are not propagated after register allocation
}
