//===- TraxFrameLowering.h - Stack frames --------------------------------===//
//
//   CFA ->  arguments that found no register            (caller's frame)
//           ra                                          if saved
//           fp                                          if saved
//           s0..s11                                     those saved
//           locals and spills
//   sp ->   arguments of calls
//
// A function that calls nothing leaves sp alone and keeps its frame below it: nothing interrupts a thread.
//
//===----------------------------------------------------------------------===//
#ifndef TRAX_TRAXFRAMELOWERING_H
#define TRAX_TRAXFRAMELOWERING_H

#include "MCTargetDesc/TraxMCTargetDesc.h"
#include "llvm/CodeGen/TargetFrameLowering.h"

namespace llvm {

class TraxFrameLowering : public TargetFrameLowering {
public:
  /// Addresses locals where sp moves and the frame is over-aligned.
  static constexpr MCPhysReg BasePointer = Trax::R31;

  TraxFrameLowering();

  bool hasFP(const MachineFunction &MF) const override;
  bool hasBP(const MachineFunction &MF) const;
  bool hasReservedCallFrame(const MachineFunction &MF) const override;
  int getInitialCFAOffset(const MachineFunction &) const override { return 0; }
  Register getInitialCFARegister(const MachineFunction &) const override { return Trax::R2; }
  /// CFIInstrInserter does this. It also handles prologues in the middle of a function.
  bool enableCFIFixup(MachineFunction &) const override { return false; }
  bool enableCalleeSaveSkip(const MachineFunction &MF) const override;
  bool enableShrinkWrapping(const MachineFunction &) const override { return true; }

  void emitPrologue(MachineFunction &MF, MachineBasicBlock &MBB) const override;
  void emitEpilogue(MachineFunction &MF, MachineBasicBlock &MBB) const override;
  StackOffset getFrameIndexReference(const MachineFunction &MF, int FI, Register &FrameReg) const override;
  bool spillCalleeSavedRegisters(MachineBasicBlock &MBB, MachineBasicBlock::iterator MI, ArrayRef<CalleeSavedInfo> CSI,
                                 const TargetRegisterInfo *TRI) const override;
  void determineCalleeSaves(MachineFunction &MF, BitVector &SavedRegs, RegScavenger *RS) const override;
  void processFunctionBeforeFrameFinalized(MachineFunction &MF, RegScavenger *RS) const override;
  MachineBasicBlock::iterator eliminateCallFramePseudoInstr(MachineFunction &MF, MachineBasicBlock &MBB,
                                                            MachineBasicBlock::iterator MI) const override;

private:
  bool leavesSPAlone(const MachineFunction &MF) const;
  bool needsRealignment(const MachineFunction &MF) const;
  void adjustReg(MachineBasicBlock &MBB, MachineBasicBlock::iterator I, const DebugLoc &DL, Register Dest,
                 Register Source, int64_t Amount, MachineInstr::MIFlag Flag) const;
};

} // namespace llvm

#endif
