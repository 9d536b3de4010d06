//===- Isa.td - the ISA alone, as the generator reads it -----------------===//
include "llvm/Target/Target.td"
include "TraxRegisters.td"
include "TraxUnits.td"
include "TraxFormats.td"
include "TraxInstructions.td"
include "TraxAliases.td"

def TraxInstrInfo : InstrInfo;
def Trax : Target { let InstructionSet = TraxInstrInfo; }
