//===- TraxRegisterInfo.cpp - Registers and frame references -------------===//
#include "TraxRegisterInfo.h"
#include "Trax.h"
#include "TraxFrameLowering.h"
#include "TraxInstrInfo.h"
#include "TraxSubtarget.h"
#include "llvm/CodeGen/MachineFrameInfo.h"
#include "llvm/CodeGen/MachineInstrBuilder.h"
#include "llvm/CodeGen/MachineRegisterInfo.h"
#include "llvm/CodeGen/RegisterScavenging.h"
#include "llvm/CodeGen/TargetFrameLowering.h"

using namespace llvm;

#define GET_REGINFO_TARGET_DESC
#include "TraxGenRegisterInfo.inc"

TraxRegisterInfo::TraxRegisterInfo() : TraxGenRegisterInfo(Trax::R1) {}

const MCPhysReg *TraxRegisterInfo::getCalleeSavedRegs(const MachineFunction *) const {
  return CSR_SaveList;
}

const uint32_t *TraxRegisterInfo::getCallPreservedMask(const MachineFunction &, CallingConv::ID) const {
  return CSR_RegMask;
}

const uint32_t *TraxRegisterInfo::getNoPreservedMask() const {
  return CSR_None_RegMask;
}

BitVector TraxRegisterInfo::getReservedRegs(const MachineFunction &MF) const {
  const TraxFrameLowering &TFL = *MF.getSubtarget<TraxSubtarget>().getFrameLowering();
  BitVector Reserved(getNumRegs());
  markSuperRegs(Reserved, Trax::R0);
  markSuperRegs(Reserved, Trax::R2);
  for (MCPhysReg Register : Trax::GPRRegClass)
    if (MF.getSubtarget<TraxSubtarget>().isReserved(Register))
      markSuperRegs(Reserved, Register);
  if (TFL.hasFP(MF))
    markSuperRegs(Reserved, Trax::R3);
  if (TFL.hasBP(MF))
    markSuperRegs(Reserved, TraxFrameLowering::BasePointer);
  return Reserved;
}

const TargetRegisterClass *TraxRegisterInfo::getPointerRegClass(const MachineFunction &, unsigned) const {
  return &Trax::GPRRegClass;
}

Register TraxRegisterInfo::getFrameRegister(const MachineFunction &MF) const {
  return MF.getSubtarget().getFrameLowering()->hasFP(MF) ? Trax::R3 : Trax::R2;
}

/// An instruction with a frame index is addi, a load or a store: the immediate is the next operand.
bool TraxRegisterInfo::eliminateFrameIndex(MachineBasicBlock::iterator II, int, unsigned FIOperandNum,
                                           RegScavenger *) const {
  MachineInstr &MI = *II;
  MachineBasicBlock &MBB = *MI.getParent();
  MachineFunction &MF = *MBB.getParent();
  const TraxSubtarget &STI = MF.getSubtarget<TraxSubtarget>();
  const DebugLoc &DL = MI.getDebugLoc();

  Register FrameReg;
  int FrameIndex = MI.getOperand(FIOperandNum).getIndex();
  int64_t Offset = STI.getFrameLowering()->getFrameIndexReference(MF, FrameIndex, FrameReg).getFixed();
  MachineOperand &Imm = MI.getOperand(FIOperandNum + 1);
  Offset += Imm.getImm();

  bool Kill = false;
  if (!isInt<16>(Offset)) {
    // lui and add make the upper part; the instruction's immediate is the lower part.
    const TraxInstrInfo &TII = *STI.getInstrInfo();
    MachineRegisterInfo &MRI = MF.getRegInfo();
    Register Upper = MRI.createVirtualRegister(&Trax::GPRRegClass);
    Register Base = MRI.createVirtualRegister(&Trax::GPRRegClass);
    BuildMI(MBB, II, DL, TII.get(Trax::LUI), Upper).addImm(((Offset + 0x8000) >> 16) & 0xFFFF);
    BuildMI(MBB, II, DL, TII.get(Trax::ADD), Base).addReg(Upper, RegState::Kill).addReg(FrameReg);
    FrameReg = Base;
    Kill = true;
    Offset = SignExtend64<16>(Offset);
  }
  MI.getOperand(FIOperandNum).ChangeToRegister(FrameReg, /*isDef=*/false, /*isImp=*/false, Kill);
  Imm.ChangeToImmediate(Offset);
  return false;
}
