//===- TraxRegisterInfo.h - Registers and frame references ---------------===//
#ifndef TRAX_TRAXREGISTERINFO_H
#define TRAX_TRAXREGISTERINFO_H

#include "llvm/CodeGen/TargetRegisterInfo.h"

#define GET_REGINFO_HEADER
#include "TraxGenRegisterInfo.inc"

namespace llvm {

class TraxRegisterInfo : public TraxGenRegisterInfo {
public:
  TraxRegisterInfo();

  const MCPhysReg *getCalleeSavedRegs(const MachineFunction *MF) const override;
  const uint32_t *getCallPreservedMask(const MachineFunction &MF, CallingConv::ID CC) const override;
  const uint32_t *getNoPreservedMask() const override;
  BitVector getReservedRegs(const MachineFunction &MF) const override;
  const TargetRegisterClass *getPointerRegClass(const MachineFunction &MF, unsigned Kind) const override;
  // In units of 1/2^14 of the entry's frequency. Even this small cost keeps a value that only an early return needs in
  // its argument's register, so that registers are saved after that return.
  unsigned getCSRFirstUseCost() const override { return 5; }
  Register getFrameRegister(const MachineFunction &MF) const override;

  bool requiresRegisterScavenging(const MachineFunction &) const override { return true; }
  bool requiresFrameIndexScavenging(const MachineFunction &) const override { return true; }
  bool eliminateFrameIndex(MachineBasicBlock::iterator MI, int SPAdj, unsigned FIOperandNum,
                           RegScavenger *RS = nullptr) const override;
};

} // namespace llvm

#endif
