//===- TraxMCInstLower.h - MachineInstr to MCInst ------------------------===//
#ifndef TRAX_TRAXMCINSTLOWER_H
#define TRAX_TRAXMCINSTLOWER_H

namespace llvm {

class AsmPrinter;
class MCInst;
class MCOperand;
class MachineInstr;
class MachineOperand;

/// False if the operand has no counterpart (implicit registers, masks).
bool lowerTraxOperand(const MachineOperand &MO, MCOperand &MCOp, AsmPrinter &AP);
void lowerTraxInstruction(const MachineInstr &MI, MCInst &Inst, AsmPrinter &AP);

} // namespace llvm

#endif
