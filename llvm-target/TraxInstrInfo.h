//===- TraxInstrInfo.h - Target hooks for instructions --------------------===//
#ifndef TRAX_TRAXINSTRINFO_H
#define TRAX_TRAXINSTRINFO_H

#include "TraxRegisterInfo.h"
#include "llvm/CodeGen/TargetInstrInfo.h"

#define GET_INSTRINFO_HEADER
#include "TraxGenInstrInfo.inc"

namespace llvm {

class TraxInstrInfo : public TraxGenInstrInfo {
  const TraxRegisterInfo RegisterInfo;

public:
  TraxInstrInfo();

  const TraxRegisterInfo &getRegisterInfo() const { return RegisterInfo; }

  void copyPhysReg(MachineBasicBlock &MBB, MachineBasicBlock::iterator I, const DebugLoc &DL, MCRegister Dest,
                   MCRegister Source, bool KillSource) const override;
  void storeRegToStackSlot(MachineBasicBlock &MBB, MachineBasicBlock::iterator I, Register Source, bool IsKill,
                           int FrameIndex, const TargetRegisterClass *RC, const TargetRegisterInfo *TRI,
                           Register VReg) const override;
  void loadRegFromStackSlot(MachineBasicBlock &MBB, MachineBasicBlock::iterator I, Register Dest, int FrameIndex,
                            const TargetRegisterClass *RC, const TargetRegisterInfo *TRI, Register VReg) const override;
  Register isLoadFromStackSlot(const MachineInstr &MI, int &FrameIndex) const override;
  Register isStoreToStackSlot(const MachineInstr &MI, int &FrameIndex) const override;

  bool isAsCheapAsAMove(const MachineInstr &MI) const override;
  std::optional<DestSourcePair> isCopyInstrImpl(const MachineInstr &MI) const override;
  MachineInstr *commuteInstructionImpl(MachineInstr &MI, bool NewMI, unsigned OpIdx1, unsigned OpIdx2) const override;
  bool expandPostRAPseudo(MachineInstr &MI) const override;
  unsigned getInstSizeInBytes(const MachineInstr &MI) const override;

  bool getMemOperandsWithOffsetWidth(const MachineInstr &MI, SmallVectorImpl<const MachineOperand *> &BaseOps,
                                     int64_t &Offset, bool &OffsetIsScalable, LocationSize &Width,
                                     const TargetRegisterInfo *TRI) const override;
  bool areMemAccessesTriviallyDisjoint(const MachineInstr &A, const MachineInstr &B) const override;

  // Branches. A condition is the branch's opcode and its two registers.
  bool analyzeBranch(MachineBasicBlock &MBB, MachineBasicBlock *&TBB, MachineBasicBlock *&FBB,
                     SmallVectorImpl<MachineOperand> &Cond, bool AllowModify) const override;
  unsigned removeBranch(MachineBasicBlock &MBB, int *BytesRemoved) const override;
  unsigned insertBranch(MachineBasicBlock &MBB, MachineBasicBlock *TBB, MachineBasicBlock *FBB,
                        ArrayRef<MachineOperand> Cond, const DebugLoc &DL, int *BytesAdded) const override;
  void insertIndirectBranch(MachineBasicBlock &MBB, MachineBasicBlock &Dest, MachineBasicBlock &Restore,
                            const DebugLoc &DL, int64_t Offset, RegScavenger *RS) const override;
  bool reverseBranchCondition(SmallVectorImpl<MachineOperand> &Cond) const override;
  MachineBasicBlock *getBranchDestBlock(const MachineInstr &MI) const override;
  bool isBranchOffsetInRange(unsigned Opcode, int64_t Offset) const override;

  std::pair<unsigned, unsigned> decomposeMachineOperandsTargetFlags(unsigned Flags) const override;
  ArrayRef<std::pair<unsigned, const char *>> getSerializableDirectMachineOperandTargetFlags() const override;
};

} // namespace llvm

#endif
