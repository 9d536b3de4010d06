//===- TraxInstrInfo.cpp - Target hooks for instructions ------------------===//
#include "TraxInstrInfo.h"
#include "Trax.h"
#include "TraxSubtarget.h"
#include "llvm/CodeGen/MachineFrameInfo.h"
#include "llvm/CodeGen/MachineInstrBuilder.h"
#include "llvm/CodeGen/MachineMemOperand.h"
#include "llvm/CodeGen/MachineRegisterInfo.h"
#include "llvm/CodeGen/RegisterScavenging.h"
#include "llvm/IR/DiagnosticInfo.h"
#include "llvm/MC/MCAsmInfo.h"
#include "llvm/Target/TargetMachine.h"

using namespace llvm;

#define GET_INSTRINFO_CTOR_DTOR
#define GET_INSTRMAP_INFO
#include "TraxGenInstrInfo.inc"

TraxInstrInfo::TraxInstrInfo() : TraxGenInstrInfo(Trax::ADJCALLSTACKDOWN, Trax::ADJCALLSTACKUP) {}

//--- moves and stack slots ----------------------------------------------------

/// The number of registers of a group; 1 for a register.
static unsigned registersOf(const TargetRegisterClass &Class, const TargetRegisterInfo &TRI) {
  return TRI.getRegSizeInBits(Class) / 32;
}

/// Copies a group to one that may overlap it, in the order that reads each register before it is written.
static void copyGroup(MachineBasicBlock &MBB, MachineBasicBlock::iterator I, const DebugLoc &DL, MCRegister Dest,
                      MCRegister Source, const TraxInstrInfo &TII) {
  const TargetRegisterInfo &TRI = TII.getRegisterInfo();
  const unsigned Count = registersOf(*TRI.getMinimalPhysRegClass(Dest), TRI);
  const bool Upwards = TRI.getEncodingValue(TRI.getSubReg(Dest, Trax::group0)) <
                       TRI.getEncodingValue(TRI.getSubReg(Source, Trax::group0));
  for (unsigned N = 0; N < Count; ++N) {
    const unsigned Index = Trax::group0 + (Upwards ? N : Count - 1 - N);
    BuildMI(MBB, I, DL, TII.get(Trax::ADDI), TRI.getSubReg(Dest, Index)).addReg(TRI.getSubReg(Source, Index)).addImm(0);
  }
}

void TraxInstrInfo::copyPhysReg(MachineBasicBlock &MBB, MachineBasicBlock::iterator I, const DebugLoc &DL,
                                MCRegister Dest, MCRegister Source, bool KillSource) const {
  if (!Trax::GPRRegClass.contains(Dest))
    return copyGroup(MBB, I, DL, Dest, Source, *this);
  BuildMI(MBB, I, DL, get(Trax::ADDI), Dest).addReg(Source, getKillRegState(KillSource)).addImm(0);
}

static MachineMemOperand *frameMemOperand(MachineFunction &MF, int FrameIndex, MachineMemOperand::Flags Flags) {
  const MachineFrameInfo &MFI = MF.getFrameInfo();
  return MF.getMachineMemOperand(MachinePointerInfo::getFixedStack(MF, FrameIndex), Flags,
                                 MFI.getObjectSize(FrameIndex), MFI.getObjectAlign(FrameIndex));
}

void TraxInstrInfo::storeRegToStackSlot(MachineBasicBlock &MBB, MachineBasicBlock::iterator I, Register Source,
                                        bool IsKill, int FrameIndex, const TargetRegisterClass *Class,
                                        const TargetRegisterInfo *TRI, Register) const {
  const unsigned Opcodes[] = {Trax::SW, Trax::PseudoSpillGroup6, Trax::PseudoSpillGroup9};
  BuildMI(MBB, I, DebugLoc(), get(Opcodes[registersOf(*Class, *TRI) / 4]))
      .addReg(Source, getKillRegState(IsKill))
      .addFrameIndex(FrameIndex)
      .addImm(0)
      .addMemOperand(frameMemOperand(*MBB.getParent(), FrameIndex, MachineMemOperand::MOStore));
}

void TraxInstrInfo::loadRegFromStackSlot(MachineBasicBlock &MBB, MachineBasicBlock::iterator I, Register Dest,
                                         int FrameIndex, const TargetRegisterClass *Class,
                                         const TargetRegisterInfo *TRI, Register) const {
  const unsigned Opcodes[] = {Trax::LW, Trax::PseudoReloadGroup6, Trax::PseudoReloadGroup9};
  BuildMI(MBB, I, DebugLoc(), get(Opcodes[registersOf(*Class, *TRI) / 4]), Dest)
      .addFrameIndex(FrameIndex)
      .addImm(0)
      .addMemOperand(frameMemOperand(*MBB.getParent(), FrameIndex, MachineMemOperand::MOLoad));
}

/// The register of "opcode reg, 0(frame index)".
static Register stackSlotAccess(const MachineInstr &MI, unsigned Opcode, int &FrameIndex) {
  if (MI.getOpcode() != Opcode || !MI.getOperand(1).isFI() || !MI.getOperand(2).isImm() ||
      MI.getOperand(2).getImm() != 0)
    return Register();
  FrameIndex = MI.getOperand(1).getIndex();
  return MI.getOperand(0).getReg();
}

Register TraxInstrInfo::isLoadFromStackSlot(const MachineInstr &MI, int &FrameIndex) const {
  return stackSlotAccess(MI, Trax::LW, FrameIndex);
}

Register TraxInstrInfo::isStoreToStackSlot(const MachineInstr &MI, int &FrameIndex) const {
  return stackSlotAccess(MI, Trax::SW, FrameIndex);
}

bool TraxInstrInfo::isAsCheapAsAMove(const MachineInstr &MI) const {
  // addi is a move, a constant or a frame address; a sum of a register and a constant is worth sharing.
  if (MI.getOpcode() == Trax::ADDI)
    return !MI.getOperand(1).isReg() || MI.getOperand(1).getReg() == Trax::R0 ||
           (MI.getOperand(2).isImm() && MI.getOperand(2).getImm() == 0);
  return MI.isAsCheapAsAMove();
}

std::optional<DestSourcePair> TraxInstrInfo::isCopyInstrImpl(const MachineInstr &MI) const {
  if (MI.getOpcode() == Trax::ADDI && MI.getOperand(1).isReg() && MI.getOperand(2).isImm() &&
      MI.getOperand(2).getImm() == 0)
    return DestSourcePair{MI.getOperand(0), MI.getOperand(1)};
  return std::nullopt;
}

/// "a if c, else b" is "b if not c, else a".
MachineInstr *TraxInstrInfo::commuteInstructionImpl(MachineInstr &MI, bool NewMI, unsigned OpIdx1,
                                                    unsigned OpIdx2) const {
  unsigned Opcode = MI.getOpcode();
  if (Opcode != Trax::CMOVNZ && Opcode != Trax::CMOVZ)
    return TargetInstrInfo::commuteInstructionImpl(MI, NewMI, OpIdx1, OpIdx2);
  MachineInstr &Result = NewMI ? *MI.getParent()->getParent()->CloneMachineInstr(&MI) : MI;
  Result.setDesc(get(Opcode == Trax::CMOVNZ ? Trax::CMOVZ : Trax::CMOVNZ));
  return TargetInstrInfo::commuteInstructionImpl(Result, /*NewMI=*/false, OpIdx1, OpIdx2);
}

/// Stores or loads the registers of a group one by one.
static void accessGroup(MachineInstr &MI, const TraxInstrInfo &TII) {
  const TargetRegisterInfo &TRI = TII.getRegisterInfo();
  const MachineOperand &Group = MI.getOperand(0), &Base = MI.getOperand(1);
  const unsigned Count = registersOf(*TRI.getMinimalPhysRegClass(Group.getReg()), TRI);
  for (unsigned N = 0; N < Count; ++N)
    BuildMI(*MI.getParent(), MI, MI.getDebugLoc(), TII.get(Group.isDef() ? Trax::LW : Trax::SW))
        .addReg(TRI.getSubReg(Group.getReg(), Trax::group0 + N), getDefRegState(Group.isDef()))
        .addReg(Base.getReg())
        .addImm(MI.getOperand(2).getImm() + 4 * N)
        .cloneMemRefs(MI);
  MI.eraseFromParent();
}

bool TraxInstrInfo::expandPostRAPseudo(MachineInstr &MI) const {
  switch (MI.getOpcode()) {
  case Trax::PseudoSpillGroup6:
  case Trax::PseudoSpillGroup9:
  case Trax::PseudoReloadGroup6:
  case Trax::PseudoReloadGroup9:
    accessGroup(MI, *this);
    return true;
  case Trax::PseudoLUIADDI: {
    const Register Rd = MI.getOperand(0).getReg();
    BuildMI(*MI.getParent(), MI, MI.getDebugLoc(), get(Trax::LUI), Rd).add(MI.getOperand(1));
    BuildMI(*MI.getParent(), MI, MI.getDebugLoc(), get(Trax::ADDI), Rd).addReg(Rd).add(MI.getOperand(2));
    MI.eraseFromParent();
    return true;
  }
  case Trax::PseudoLONGJMP:
    expandTraxLongJmp(MI, *this);
    return true;
  default:
    return false;
  }
}

unsigned TraxInstrInfo::getInstSizeInBytes(const MachineInstr &MI) const {
  if (MI.isInlineAsm()) {
    const MachineFunction *MF = MI.getParent()->getParent();
    return getInlineAsmLength(MI.getOperand(0).getSymbolName(), *MF->getTarget().getMCAsmInfo());
  }
  if (MI.isMetaInstruction())
    return 0;
  return MI.getDesc().getSize();
}

//--- memory -------------------------------------------------------------------

bool TraxInstrInfo::getMemOperandsWithOffsetWidth(const MachineInstr &MI,
                                                  SmallVectorImpl<const MachineOperand *> &BaseOps, int64_t &Offset,
                                                  bool &OffsetIsScalable, LocationSize &Width,
                                                  const TargetRegisterInfo *) const {
  if (!MI.mayLoadOrStore() || MI.getNumExplicitOperands() != 3 || !MI.hasOneMemOperand())
    return false;
  const MachineOperand &Base = MI.getOperand(1), &Imm = MI.getOperand(2);
  if (!(Base.isReg() || Base.isFI()) || !Imm.isImm())
    return false;
  BaseOps.push_back(&Base);
  Offset = Imm.getImm();
  OffsetIsScalable = false;
  Width = (*MI.memoperands_begin())->getSize();
  return Width.hasValue();
}

bool TraxInstrInfo::areMemAccessesTriviallyDisjoint(const MachineInstr &A, const MachineInstr &B) const {
  if (A.hasUnmodeledSideEffects() || B.hasUnmodeledSideEffects() || A.hasOrderedMemoryRef() || B.hasOrderedMemoryRef())
    return false;
  const TargetRegisterInfo *TRI = &RegisterInfo;
  SmallVector<const MachineOperand *, 1> BaseA, BaseB;
  int64_t OffsetA, OffsetB;
  bool Scalable;
  LocationSize WidthA = LocationSize::precise(0), WidthB = LocationSize::precise(0);
  if (!getMemOperandsWithOffsetWidth(A, BaseA, OffsetA, Scalable, WidthA, TRI) ||
      !getMemOperandsWithOffsetWidth(B, BaseB, OffsetB, Scalable, WidthB, TRI) || !BaseA[0]->isIdenticalTo(*BaseB[0]))
    return false;
  return OffsetA <= OffsetB ? OffsetA + int64_t(WidthA.getValue()) <= OffsetB
                            : OffsetB + int64_t(WidthB.getValue()) <= OffsetA;
}

//--- branches -----------------------------------------------------------------

/// The inverse of a conditional branch; -1 of other instructions.
static int inverseBranch(unsigned Opcode) {
  int Inverse = Trax::inverseOfIf(Opcode);
  return Inverse < 0 ? Trax::inverseOfUnless(Opcode) : Inverse;
}

static bool isConditionalBranch(const MachineInstr &MI) {
  return inverseBranch(MI.getOpcode()) >= 0;
}

static void parseConditionalBranch(MachineInstr &MI, MachineBasicBlock *&Target,
                                   SmallVectorImpl<MachineOperand> &Cond) {
  Target = MI.getOperand(2).getMBB();
  Cond.push_back(MachineOperand::CreateImm(MI.getOpcode()));
  Cond.push_back(MI.getOperand(0));
  Cond.push_back(MI.getOperand(1));
}

bool TraxInstrInfo::analyzeBranch(MachineBasicBlock &MBB, MachineBasicBlock *&TBB, MachineBasicBlock *&FBB,
                                  SmallVectorImpl<MachineOperand> &Cond, bool AllowModify) const {
  TBB = FBB = nullptr;
  Cond.clear();
  MachineBasicBlock::iterator I = MBB.getLastNonDebugInstr();
  if (I == MBB.end() || !isUnpredicatedTerminator(*I))
    return false; // falls through

  // Count the terminators, and find the first that leaves the block for good.
  MachineBasicBlock::iterator FirstBarrier = MBB.end();
  int NumTerminators = 0;
  for (auto J = I.getReverse(); J != MBB.rend() && isUnpredicatedTerminator(*J); ++J) {
    ++NumTerminators;
    if (J->getDesc().isUnconditionalBranch() || J->getDesc().isIndirectBranch())
      FirstBarrier = J.getReverse();
  }
  if (AllowModify && FirstBarrier != MBB.end())
    while (std::next(FirstBarrier) != MBB.end()) {
      std::next(FirstBarrier)->eraseFromParent();
      --NumTerminators;
      I = FirstBarrier;
    }

  if (I->getDesc().isIndirectBranch() || I->isReturn() || NumTerminators > 2)
    return true;
  if (NumTerminators == 1) {
    if (I->getOpcode() == Trax::PseudoBR) {
      TBB = I->getOperand(0).getMBB();
      return false;
    }
    if (!isConditionalBranch(*I))
      return true;
    parseConditionalBranch(*I, TBB, Cond);
    return false;
  }
  MachineBasicBlock::iterator First = std::prev(I);
  while (First->isDebugInstr())
    --First;
  if (!isConditionalBranch(*First) || I->getOpcode() != Trax::PseudoBR)
    return true;
  parseConditionalBranch(*First, TBB, Cond);
  FBB = I->getOperand(0).getMBB();
  return false;
}

unsigned TraxInstrInfo::removeBranch(MachineBasicBlock &MBB, int *BytesRemoved) const {
  unsigned Removed = 0;
  for (auto I = MBB.getLastNonDebugInstr(); I != MBB.end() && Removed < 2; I = MBB.getLastNonDebugInstr()) {
    if (I->getOpcode() != Trax::PseudoBR && !isConditionalBranch(*I))
      break;
    bool Conditional = isConditionalBranch(*I);
    I->eraseFromParent();
    ++Removed;
    if (Conditional)
      break;
  }
  if (BytesRemoved)
    *BytesRemoved = Removed * 4;
  return Removed;
}

unsigned TraxInstrInfo::insertBranch(MachineBasicBlock &MBB, MachineBasicBlock *TBB, MachineBasicBlock *FBB,
                                     ArrayRef<MachineOperand> Cond, const DebugLoc &DL, int *BytesAdded) const {
  assert(TBB && "a fall-through needs no branch");
  unsigned Added = 0;
  MachineBasicBlock *Otherwise = Cond.empty() ? TBB : FBB;
  if (!Cond.empty()) {
    BuildMI(&MBB, DL, get(Cond[0].getImm())).add(Cond[1]).add(Cond[2]).addMBB(TBB);
    ++Added;
  }
  if (Otherwise) {
    BuildMI(&MBB, DL, get(Trax::PseudoBR)).addMBB(Otherwise);
    ++Added;
  }
  if (BytesAdded)
    *BytesAdded = Added * 4;
  return Added;
}

void TraxInstrInfo::insertIndirectBranch(MachineBasicBlock &MBB, MachineBasicBlock &, MachineBasicBlock &,
                                         const DebugLoc &, int64_t, RegScavenger *) const {
  // A jump reaches 4 MB either way. A longer function is an error, since no program needs an indirect jump here.
  const Function &F = MBB.getParent()->getFunction();
  F.getContext().diagnose(DiagnosticInfoUnsupported(F, "functions of more than 4 MB of code are not supported"));
}

bool TraxInstrInfo::reverseBranchCondition(SmallVectorImpl<MachineOperand> &Cond) const {
  Cond[0].setImm(inverseBranch(Cond[0].getImm()));
  return false;
}

MachineBasicBlock *TraxInstrInfo::getBranchDestBlock(const MachineInstr &MI) const {
  return MI.getOperand(MI.getNumExplicitOperands() - 1).getMBB();
}

bool TraxInstrInfo::isBranchOffsetInRange(unsigned Opcode, int64_t Offset) const {
  return Opcode == Trax::PseudoBR ? isInt<23>(Offset) : isInt<18>(Offset);
}

//--- textual machine code -----------------------------------------------------

std::pair<unsigned, unsigned> TraxInstrInfo::decomposeMachineOperandsTargetFlags(unsigned Flags) const {
  return {Flags, 0u};
}

ArrayRef<std::pair<unsigned, const char *>> TraxInstrInfo::getSerializableDirectMachineOperandTargetFlags() const {
  static const std::pair<unsigned, const char *> Flags[] = {
      {TraxII::MO_HI, "trax-hi"}, {TraxII::MO_LO, "trax-lo"}, {TraxII::MO_ABS, "trax-abs"}};
  return Flags;
}
