//===- TraxOutliner.cpp - Sequences that become functions ----------------===//
//
// The machine outliner gives repeated sequences of instructions functions of their own, at -Oz and where -moutline asks
// for it: the instruction cache holds 1,024 instructions. A sequence is called in one of three ways, one jump each:
//
// - it ends with a return or a tail call: it is jumped to;
// - it ends with a call: it is called, and its own last call becomes a jump;
// - otherwise jal puts the return address into any register that is free wherever the sequence stands. Since that need
// not
//   be ra, leaf functions call outlined ones, too, and nothing is saved.
//
//===----------------------------------------------------------------------===//
#include "Trax.h"
#include "TraxInstrInfo.h"
#include "llvm/CodeGen/MachineInstrBuilder.h"
#include "llvm/CodeGen/MachineModuleInfo.h"
#include "llvm/IR/Function.h"
#include "llvm/IR/Module.h"

using namespace llvm;

namespace {

constexpr unsigned JumpBytes = 4;

// How an outlined function is called: one of these, or else the number of the register with the return address.
constexpr unsigned CalledInTailPosition = Trax::NoRegister;
constexpr unsigned EndsWithCall = Trax::NUM_TARGET_REGS;

} // namespace

/// Whether every instruction but the last leaves ra alone.
static bool keepsReturnAddress(outliner::Candidate &C, const TargetRegisterInfo &TRI) {
  return all_of(make_range(C.begin(), std::prev(C.end())), [&](const MachineInstr &MI) {
    return !MI.modifiesRegister(Trax::R1, &TRI) && !MI.readsRegister(Trax::R1, &TRI);
  });
}

/// The register that can hold the return address at the most places, at which it is neither live nor touched by the
/// sequence. ra first, since its return is everybody's; it is free where it has been saved.
static MCRegister chooseLinkRegister(std::vector<outliner::Candidate> &Candidates, const TargetRegisterInfo &TRI) {
  static const MCPhysReg Registers[] = {Trax::R1,  Trax::R19, Trax::R18, Trax::R17, Trax::R16, Trax::R15,
                                        Trax::R14, Trax::R13, Trax::R12, Trax::R11, Trax::R10, Trax::R9,
                                        Trax::R8,  Trax::R7,  Trax::R6,  Trax::R5,  Trax::R4};
  auto IsFree = [&](outliner::Candidate &C, MCRegister Reg) {
    return C.isAvailableInsideSeq(Reg, TRI) && C.isAvailableAcrossAndOutOfSeq(Reg, TRI);
  };
  MCRegister Best;
  size_t Most = 1; // a sequence is worth a function from two places on
  for (MCRegister Reg : Registers) {
    const size_t Places = count_if(Candidates, [&](outliner::Candidate &C) { return IsFree(C, Reg); });
    if (Places > Most) {
      Most = Places;
      Best = Reg;
    }
  }
  erase_if(Candidates, [&](outliner::Candidate &C) { return !Best || !IsFree(C, Best); });
  return Best;
}

std::optional<outliner::OutlinedFunction>
TraxInstrInfo::getOutliningCandidateInfo(std::vector<outliner::Candidate> &RepeatedSequenceLocs) const {
  const MachineInstr &Last = RepeatedSequenceLocs.front().back();
  unsigned Kind, FrameBytes = 0;
  if (Last.isReturn()) {
    Kind = CalledInTailPosition;
  } else if (Last.isCall()) {
    Kind = EndsWithCall;
    erase_if(RepeatedSequenceLocs, [&](outliner::Candidate &C) { return !keepsReturnAddress(C, RegisterInfo); });
  } else {
    Kind = chooseLinkRegister(RepeatedSequenceLocs, RegisterInfo);
    FrameBytes = JumpBytes; // the return
  }
  if (RepeatedSequenceLocs.size() < 2)
    return std::nullopt;

  unsigned SequenceBytes = 0;
  for (const MachineInstr &MI : RepeatedSequenceLocs.front())
    SequenceBytes += getInstSizeInBytes(MI);
  for (outliner::Candidate &C : RepeatedSequenceLocs)
    C.setCallInfo(Kind, JumpBytes);
  return outliner::OutlinedFunction(RepeatedSequenceLocs, SequenceBytes, FrameBytes, Kind);
}

/// What is not to be moved whatever the target is has been refused already.
outliner::InstrType TraxInstrInfo::getOutliningTypeImpl(MachineBasicBlock::iterator &MIT, unsigned) const {
  const MachineInstr &MI = *MIT;
  // How to find the caller's frame is known where frames are unwound, or else only to debuggers.
  if (MI.isCFIInstruction())
    return MI.getMF()->getFunction().needsUnwindTableEntry() ? outliner::Illegal : outliner::Invisible;
  switch (MI.getOpcode()) {
  case Trax::PseudoRET:
  case Trax::PseudoTAIL:
  case Trax::PseudoTAILIndirect:
    return outliner::Legal;
  case Trax::PseudoCALL:
    return outliner::LegalTerminator;
  case Trax::PseudoCALLIndirect: // must be possible as a tail call
    return Trax::GPRTCRegClass.contains(MI.getOperand(0).getReg()) ? outliner::LegalTerminator : outliner::Illegal;
  default:
    return MI.isTerminator() || MI.isCall() ? outliner::Illegal : outliner::Legal;
  }
}

bool TraxInstrInfo::isFunctionSafeToOutlineFrom(MachineFunction &MF, bool OutlineFromLinkOnceODRs) const {
  const Function &F = MF.getFunction();
  // The linker keeps one copy of a linkonce_odr function: what was outlined from the others would stay.
  if (F.hasLinkOnceODRLinkage() && !OutlineFromLinkOnceODRs)
    return false;
  // Who names a section wants all of the function there; a naked function is not the compiler's.
  return !F.hasSection() && !F.hasFnAttribute(Attribute::Naked);
}

bool TraxInstrInfo::shouldOutlineFromFunctionByDefault(MachineFunction &MF) const {
  return MF.getFunction().hasMinSize();
}

void TraxInstrInfo::buildOutlinedFrame(MachineBasicBlock &MBB, MachineFunction &,
                                       const outliner::OutlinedFunction &OF) const {
  for (MachineInstr &MI : make_early_inc_range(MBB)) // of the functions that it came from
    if (MI.isCFIInstruction())
      MI.eraseFromParent();
  switch (OF.FrameConstructionID) {
  case CalledInTailPosition:
    return;
  case EndsWithCall: {
    MachineInstr &Call = MBB.back();
    const unsigned Tail = Call.getOpcode() == Trax::PseudoCALL ? Trax::PseudoTAIL : Trax::PseudoTAILIndirect;
    MachineInstrBuilder Jump = BuildMI(MBB, MBB.end(), Call.getDebugLoc(), get(Tail)).add(Call.getOperand(0));
    for (const MachineOperand &Operand : Call.implicit_operands()) // the arguments
      if (Operand.isReg() && Operand.isUse() && Operand.getReg() != Trax::R2)
        Jump.add(Operand);
    if (!MBB.isLiveIn(Trax::R1))
      MBB.addLiveIn(Trax::R1);
    Jump.addReg(Trax::R1, RegState::Implicit);
    Call.eraseFromParent();
    return;
  }
  default:
    const MCRegister Link = OF.FrameConstructionID;
    if (!MBB.isLiveIn(Link))
      MBB.addLiveIn(Link);
    BuildMI(MBB, MBB.end(), DebugLoc(), get(Trax::PseudoRETOutlined)).addReg(Link);
  }
}

MachineBasicBlock::iterator TraxInstrInfo::insertOutlinedCall(Module &M, MachineBasicBlock &MBB,
                                                              MachineBasicBlock::iterator &It, MachineFunction &MF,
                                                              outliner::Candidate &C) const {
  const GlobalValue *Callee = M.getNamedValue(MF.getName());
  MachineInstrBuilder Call;
  switch (C.CallConstructionID) {
  case CalledInTailPosition:
    Call = BuildMI(MF, DebugLoc(), get(Trax::PseudoTAIL)).addGlobalAddress(Callee);
    break;
  case EndsWithCall:
    Call = BuildMI(MF, DebugLoc(), get(Trax::PseudoCALL)).addGlobalAddress(Callee);
    break;
  default:
    Call = BuildMI(MF, DebugLoc(), get(Trax::PseudoCALLOutlined), C.CallConstructionID).addGlobalAddress(Callee);
  }
  It = MBB.insert(It, Call);
  return It;
}
