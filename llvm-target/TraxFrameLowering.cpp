//===- TraxFrameLowering.cpp - Stack frames ------------------------------===//
#include "TraxFrameLowering.h"
#include "TraxInstrInfo.h"
#include "TraxSubtarget.h"
#include "trax/abi.h"
#include "llvm/CodeGen/MachineFrameInfo.h"
#include "llvm/CodeGen/MachineFunction.h"
#include "llvm/CodeGen/MachineInstrBuilder.h"
#include "llvm/CodeGen/MachineModuleInfo.h"
#include "llvm/CodeGen/MachineRegisterInfo.h"
#include "llvm/CodeGen/RegisterScavenging.h"
#include "llvm/IR/DiagnosticInfo.h"
#include "llvm/IR/DiagnosticPrinter.h"
#include "llvm/MC/MCDwarf.h"
#include "llvm/Target/TargetMachine.h"
#include "llvm/Target/TargetOptions.h"

using namespace llvm;

TraxFrameLowering::TraxFrameLowering()
    : TargetFrameLowering(StackGrowsDown, /*StackAl=*/Align(4), /*LAO=*/0, /*TransAl=*/Align(4)) {}

bool TraxFrameLowering::needsRealignment(const MachineFunction &MF) const {
  return MF.getSubtarget().getRegisterInfo()->hasStackRealignment(MF);
}

bool TraxFrameLowering::hasFP(const MachineFunction &MF) const {
  const MachineFrameInfo &MFI = MF.getFrameInfo();
  return MF.getTarget().Options.DisableFramePointerElim(MF) || MFI.hasVarSizedObjects() || MFI.isFrameAddressTaken() ||
         needsRealignment(MF);
}

bool TraxFrameLowering::hasBP(const MachineFunction &MF) const {
  return MF.getFrameInfo().hasVarSizedObjects() && needsRealignment(MF);
}

// The frame reserves the space of outgoing arguments unless sp moves.
bool TraxFrameLowering::hasReservedCallFrame(const MachineFunction &MF) const {
  return !MF.getFrameInfo().hasVarSizedObjects();
}

/// A function that never returns need not save its caller's registers: twelve words are a lot of 512 bytes. A function
/// that calls others saves them, because otherwise it loses its return address, and a debugger the callers.
bool TraxFrameLowering::enableCalleeSaveSkip(const MachineFunction &MF) const {
  return !MF.getFrameInfo().hasCalls();
}

bool TraxFrameLowering::leavesSPAlone(const MachineFunction &MF) const {
  const MachineFrameInfo &MFI = MF.getFrameInfo();
  return !MFI.hasCalls() && !MFI.adjustsStack() && !hasFP(MF);
}

/// Dest = Source + Amount. Amounts that one addi does not reach are beyond the local memory, but must compile.
void TraxFrameLowering::adjustReg(MachineBasicBlock &MBB, MachineBasicBlock::iterator I, const DebugLoc &DL,
                                  Register Dest, Register Source, int64_t Amount, MachineInstr::MIFlag Flag) const {
  const TargetInstrInfo &TII = *MBB.getParent()->getSubtarget().getInstrInfo();
  do {
    int64_t Step = std::clamp<int64_t>(Amount, -0x8000, 0x7FFC);
    BuildMI(MBB, I, DL, TII.get(Trax::ADDI), Dest).addReg(Source).addImm(Step).setMIFlag(Flag);
    Source = Dest;
    Amount -= Step;
  } while (Amount != 0);
}

namespace {

/// The text after the warning of a large frame.
class StackAnswer : public DiagnosticInfo {
  static int kind() {
    static const int Kind = getNextAvailablePluginDiagnosticKind();
    return Kind;
  }

public:
  StackAnswer() : DiagnosticInfo(kind(), DS_Note) {}
  void print(DiagnosticPrinter &DP) const override { DP << "-mstack=global puts the stack into global memory"; }
};

} // namespace

/// The scheduler moves nothing across these directives. They are emitted also without -g, so that -g changes no code;
/// the printer then leaves them out.
static void emitCFI(MachineBasicBlock &MBB, MachineBasicBlock::iterator I, const DebugLoc &DL,
                    const MCCFIInstruction &CFI, MachineInstr::MIFlag Flag) {
  MachineFunction &MF = *MBB.getParent();
  BuildMI(MBB, I, DL, MF.getSubtarget().getInstrInfo()->get(TargetOpcode::CFI_INSTRUCTION))
      .addCFIIndex(MF.addFrameInst(CFI))
      .setMIFlag(Flag);
}

void TraxFrameLowering::emitPrologue(MachineFunction &MF, MachineBasicBlock &MBB) const {
  MachineFrameInfo &MFI = MF.getFrameInfo();
  const TraxRegisterInfo &TRI = *MF.getSubtarget<TraxSubtarget>().getRegisterInfo();
  const TraxInstrInfo &TII = *MF.getSubtarget<TraxSubtarget>().getInstrInfo();
  const std::vector<CalleeSavedInfo> &CSI = MFI.getCalleeSavedInfo();
  MachineBasicBlock::iterator MBBI = MBB.begin();
  DebugLoc DL; // none: the debugger uses the first line after the prologue
  uint64_t StackSize = MFI.getStackSize();
  if (StackSize > TRAX_LOCAL_SIZE && MF.getSubtarget<TraxSubtarget>().getStack() != TRAX_EF_STACK_GLOBAL) {
    DiagnosticInfoStackSize Diag(MF.getFunction(), StackSize, TRAX_LOCAL_SIZE, DS_Warning);
    MF.getFunction().getContext().diagnose(Diag);
    MF.getFunction().getContext().diagnose(StackAnswer());
  }

  bool Adjusts = StackSize != 0 && !leavesSPAlone(MF);
  if (Adjusts) {
    adjustReg(MBB, MBBI, DL, Trax::R2, Trax::R2, -int64_t(StackSize), MachineInstr::FrameSetup);
    emitCFI(MBB, MBBI, DL, MCCFIInstruction::cfiDefCfaOffset(nullptr, StackSize), MachineInstr::FrameSetup);
  }

  // After the stores of the saved registers.
  std::advance(MBBI, CSI.size());
  for (const CalleeSavedInfo &Saved : CSI)
    emitCFI(MBB, MBBI, DL,
            MCCFIInstruction::createOffset(nullptr, TRI.getDwarfRegNum(Saved.getReg(), true),
                                           MFI.getObjectOffset(Saved.getFrameIdx())),
            MachineInstr::FrameSetup);

  if (!hasFP(MF))
    return;
  adjustReg(MBB, MBBI, DL, Trax::R3, Trax::R2, StackSize, MachineInstr::FrameSetup);
  emitCFI(MBB, MBBI, DL, MCCFIInstruction::cfiDefCfa(nullptr, TRI.getDwarfRegNum(Trax::R3, true), 0),
          MachineInstr::FrameSetup);
  if (needsRealignment(MF)) {
    // .stack_sizes counts this, because it must bound the frame.
    MFI.setUnsafeStackSize(MFI.getMaxAlign().value() - getStackAlign().value());
    unsigned Shift = Log2(MFI.getMaxAlign());
    if (Shift <= 15) {
      BuildMI(MBB, MBBI, DL, TII.get(Trax::ANDI), Trax::R2)
          .addReg(Trax::R2)
          .addImm(-(int64_t(1) << Shift))
          .setMIFlag(MachineInstr::FrameSetup);
    } else {
      BuildMI(MBB, MBBI, DL, TII.get(Trax::SRLI), Trax::R2)
          .addReg(Trax::R2)
          .addImm(Shift)
          .setMIFlag(MachineInstr::FrameSetup);
      BuildMI(MBB, MBBI, DL, TII.get(Trax::SLLI), Trax::R2)
          .addReg(Trax::R2)
          .addImm(Shift)
          .setMIFlag(MachineInstr::FrameSetup);
    }
    if (hasBP(MF))
      adjustReg(MBB, MBBI, DL, BasePointer, Trax::R2, 0, MachineInstr::FrameSetup);
  }
}

void TraxFrameLowering::emitEpilogue(MachineFunction &MF, MachineBasicBlock &MBB) const {
  MachineFrameInfo &MFI = MF.getFrameInfo();
  const TraxRegisterInfo &TRI = *MF.getSubtarget<TraxSubtarget>().getRegisterInfo();
  const std::vector<CalleeSavedInfo> &CSI = MFI.getCalleeSavedInfo();
  MachineBasicBlock::iterator MBBI = MBB.getFirstTerminator();
  DebugLoc DL = MBBI != MBB.end() ? MBBI->getDebugLoc() : DebugLoc();
  uint64_t StackSize = MFI.getStackSize();

  // sp may have moved since the prologue; the reloads before MBBI are relative to it.
  if (MFI.hasVarSizedObjects() || needsRealignment(MF)) {
    auto Reloads = std::prev(MBBI, CSI.size());
    adjustReg(MBB, Reloads, DL, Trax::R2, Trax::R3, -int64_t(StackSize), MachineInstr::FrameDestroy);
  }
  if (hasFP(MF)) // fp is reloaded: the frame is known by sp again
    emitCFI(MBB, std::prev(MBBI, CSI.size()), DL,
            MCCFIInstruction::cfiDefCfa(nullptr, TRI.getDwarfRegNum(Trax::R2, true), StackSize),
            MachineInstr::FrameDestroy);

  bool Adjusts = StackSize != 0 && !leavesSPAlone(MF);
  if (Adjusts)
    adjustReg(MBB, MBBI, DL, Trax::R2, Trax::R2, StackSize, MachineInstr::FrameDestroy);
  if (Adjusts)
    emitCFI(MBB, MBBI, DL, MCCFIInstruction::cfiDefCfaOffset(nullptr, 0), MachineInstr::FrameDestroy);
  for (const CalleeSavedInfo &Saved : CSI)
    emitCFI(MBB, MBBI, DL, MCCFIInstruction::createRestore(nullptr, TRI.getDwarfRegNum(Saved.getReg(), true)),
            MachineInstr::FrameDestroy);
}

StackOffset TraxFrameLowering::getFrameIndexReference(const MachineFunction &MF, int FI, Register &FrameReg) const {
  const MachineFrameInfo &MFI = MF.getFrameInfo();
  int64_t FromCFA = MFI.getObjectOffset(FI);
  int64_t FromSP = FromCFA + int64_t(leavesSPAlone(MF) ? 0 : MFI.getStackSize());

  // Prologue and epilogue access saved registers while sp is at the bottom of the fixed frame, with or without fp. In
  // an over-aligned frame sp differs later, and nothing else refers to them.
  const std::vector<CalleeSavedInfo> &CSI = MFI.getCalleeSavedInfo();
  bool IsSaved = any_of(CSI, [FI](const CalleeSavedInfo &Saved) { return Saved.getFrameIdx() == FI; });
  if (!IsSaved && needsRealignment(MF)) {
    if (MFI.isFixedObjectIndex(FI)) {
      FrameReg = Trax::R3;
      return StackOffset::getFixed(FromCFA);
    }
    FrameReg = hasBP(MF) ? BasePointer : MCPhysReg(Trax::R2);
    return StackOffset::getFixed(FromSP);
  }
  if (!IsSaved && MFI.hasVarSizedObjects()) {
    FrameReg = Trax::R3;
    return StackOffset::getFixed(FromCFA);
  }
  FrameReg = Trax::R2;
  return StackOffset::getFixed(FromSP);
}

bool TraxFrameLowering::spillCalleeSavedRegisters(MachineBasicBlock &MBB, MachineBasicBlock::iterator MI,
                                                  ArrayRef<CalleeSavedInfo> CSI, const TargetRegisterInfo *TRI) const {
  const TargetInstrInfo &TII = *MBB.getParent()->getSubtarget().getInstrInfo();
  for (const CalleeSavedInfo &Saved : CSI) {
    MCRegister Reg = Saved.getReg();
    // A function that reads its return address still needs ra.
    bool IsKill = !MBB.isLiveIn(Reg);
    TII.storeRegToStackSlot(MBB, MI, Reg, IsKill, Saved.getFrameIdx(), TRI->getMinimalPhysRegClass(Reg), TRI,
                            Register());
    std::prev(MI)->setFlag(MachineInstr::FrameSetup);
  }
  return true;
}

void TraxFrameLowering::determineCalleeSaves(MachineFunction &MF, BitVector &SavedRegs, RegScavenger *RS) const {
  TargetFrameLowering::determineCalleeSaves(MF, SavedRegs, RS);
  if (hasFP(MF)) { // both, so that a chain of frames can be followed
    SavedRegs.set(Trax::R1);
    SavedRegs.set(Trax::R3);
  }
  if (hasBP(MF))
    SavedRegs.set(BasePointer);
}

void TraxFrameLowering::processFunctionBeforeFrameFinalized(MachineFunction &MF, RegScavenger *RS) const {
  // Offsets beyond an immediate need two scratch registers, one at a time; give them a slot in case all are in use.
  MachineFrameInfo &MFI = MF.getFrameInfo();
  if (MFI.estimateStackSize(MF) < 0x7000)
    return;
  const TargetRegisterClass &RC = Trax::GPRRegClass;
  const TargetRegisterInfo &TRI = *MF.getSubtarget().getRegisterInfo();
  for (int I = 0; I != 2; ++I)
    RS->addScavengingFrameIndex(MFI.CreateStackObject(TRI.getSpillSize(RC), TRI.getSpillAlign(RC), false));
}

MachineBasicBlock::iterator TraxFrameLowering::eliminateCallFramePseudoInstr(MachineFunction &MF,
                                                                             MachineBasicBlock &MBB,
                                                                             MachineBasicBlock::iterator MI) const {
  if (!hasReservedCallFrame(MF)) {
    int64_t Amount = alignSPAdjust(MI->getOperand(0).getImm());
    if (MI->getOpcode() == Trax::ADJCALLSTACKDOWN)
      Amount = -Amount;
    if (Amount != 0)
      adjustReg(MBB, MI, MI->getDebugLoc(), Trax::R2, Trax::R2, Amount, MachineInstr::NoFlags);
  }
  return MBB.erase(MI);
}
