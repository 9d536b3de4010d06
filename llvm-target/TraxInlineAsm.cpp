//===- TraxInlineAsm.cpp - Constraints and names of registers ------------===//
#include "TraxISelLowering.h"
#include "TraxSubtarget.h"
#include "llvm/CodeGen/SelectionDAG.h"
#include "llvm/IR/DiagnosticInfo.h"

using namespace llvm;

/// A register by its number or its name in the ABI.
static MCRegister findRegister(StringRef Name) {
#define MATCH(NUMBERED, BY_ROLE, NUMBER)                                                                               \
  if (Name == NUMBERED || Name == BY_ROLE)                                                                             \
    return Trax::R##NUMBER;
  TRAX_REGISTERS(MATCH)
#undef MATCH
  return MCRegister();
}

/// Global register variables may only name registers that nothing else uses.
Register TraxTargetLowering::getRegisterByName(const char *Name, LLT, const MachineFunction &MF) const {
  MCRegister Reg = findRegister(Name);
  if (Reg && !Subtarget.getRegisterInfo()->getReservedRegs(MF).test(Reg)) {
    DiagnosticInfoUnsupported Diag(MF.getFunction(), "global register variable needs a reserved register: zero or sp");
    MF.getFunction().getContext().diagnose(Diag);
    return Trax::R0;
  }
  if (!Reg) {
    DiagnosticInfoUnsupported Diag(MF.getFunction(), Twine("no register is called '") + Name + "'");
    MF.getFunction().getContext().diagnose(Diag);
  }
  return Reg ? Register(Reg) : Register(Trax::R0);
}

TargetLowering::ConstraintType TraxTargetLowering::getConstraintType(StringRef Constraint) const {
  if (Constraint.size() == 1)
    switch (Constraint[0]) {
    case 'f': // a float, in a register as any
      return C_RegisterClass;
    case 'I': // signed 16-bit immediate
    case 'J': // 0
    case 'K': // unsigned 16-bit immediate
      return C_Immediate;
    default:
      break;
    }
  return TargetLowering::getConstraintType(Constraint);
}

std::pair<unsigned, const TargetRegisterClass *>
TraxTargetLowering::getRegForInlineAsmConstraint(const TargetRegisterInfo *TRI, StringRef Constraint, MVT VT) const {
  if (Constraint == "r" || Constraint == "f") {
    // A double word takes two: %0 names the lower word's, %H0 the upper word's.
    if (VT != MVT::Other && VT.getSizeInBits() > 64)
      return {0U, nullptr};
    return {0U, &Trax::GPRRegClass};
  }
  if (Constraint.size() > 2 && Constraint.front() == '{' && Constraint.back() == '}' &&
      (VT == MVT::Other || VT.getSizeInBits() <= 32))
    if (MCRegister Reg = findRegister(Constraint.drop_front().drop_back()))
      return {Reg, &Trax::GPRRegClass};
  return TargetLowering::getRegForInlineAsmConstraint(TRI, Constraint, VT);
}

void TraxTargetLowering::LowerAsmOperandForConstraint(SDValue Op, StringRef Constraint, std::vector<SDValue> &Ops,
                                                      SelectionDAG &DAG) const {
  if (Constraint.size() == 1 && StringRef("IJK").contains(Constraint[0])) {
    auto *C = dyn_cast<ConstantSDNode>(Op);
    if (!C)
      return;
    int64_t Value = C->getSExtValue();
    bool Fits = Constraint[0] == 'I' ? isInt<16>(Value) : Constraint[0] == 'J' ? Value == 0 : isUInt<16>(Value);
    if (Fits)
      Ops.push_back(DAG.getTargetConstant(Value, SDLoc(Op), MVT::i32));
    return;
  }
  TargetLowering::LowerAsmOperandForConstraint(Op, Constraint, Ops, DAG);
}
