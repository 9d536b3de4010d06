//===- TraxSjLj.cpp - __builtin_setjmp and __builtin_longjmp -------------===//
//
// The buffer has five words. The front end stores the frame address into the first and sp into the third; the address
// to continue at goes into the second and r31 into the fourth, which a function that needs a base pointer has there. No
// other register outlives the jump, so the function saves and reloads all others that it needs.
//
//===----------------------------------------------------------------------===//
#include "Trax.h"
#include "TraxFrameLowering.h"
#include "TraxISelLowering.h"
#include "TraxSubtarget.h"
#include "llvm/CodeGen/MachineFunction.h"
#include "llvm/CodeGen/MachineInstrBuilder.h"
#include "llvm/CodeGen/MachineRegisterInfo.h"

using namespace llvm;

namespace {
enum BufferOffset { FramePointer = 0, Address = 4, StackPointer = 8, BasePointer = 12 };
}

SDValue TraxTargetLowering::lowerSetJmp(SDValue Op, SelectionDAG &DAG) const {
  return DAG.getNode(TraxISD::SETJMP, SDLoc(Op), DAG.getVTList(MVT::i32, MVT::Other), Op.getOperand(0),
                     Op.getOperand(1));
}

SDValue TraxTargetLowering::lowerLongJmp(SDValue Op, SelectionDAG &DAG) const {
  return DAG.getNode(TraxISD::LONGJMP, SDLoc(Op), MVT::Other, Op.getOperand(0), Op.getOperand(1));
}

///   this:     buffer: address of again; r31      main: zero = 0        again: one = 1
///             PseudoSjLjSetup again                                           jump to rest
///             falls through to main              rest: result = phi zero, one
MachineBasicBlock *TraxTargetLowering::emitSetJmp(MachineInstr &MI, MachineBasicBlock *This) const {
  MachineFunction &MF = *This->getParent();
  MachineRegisterInfo &MRI = MF.getRegInfo();
  const TargetInstrInfo &TII = *MF.getSubtarget().getInstrInfo();
  const DebugLoc DL = MI.getDebugLoc();
  const Register Result = MI.getOperand(0).getReg(), Buffer = MI.getOperand(1).getReg();
  auto NewRegister = [&] { return MRI.createVirtualRegister(&Trax::GPRRegClass); };

  MachineBasicBlock *Main = MF.CreateMachineBasicBlock(This->getBasicBlock());
  MachineBasicBlock *Rest = MF.CreateMachineBasicBlock(This->getBasicBlock());
  MachineBasicBlock *Again = MF.CreateMachineBasicBlock(This->getBasicBlock());
  MF.insert(std::next(This->getIterator()), Main);
  MF.insert(std::next(Main->getIterator()), Rest);
  MF.push_back(Again);
  Again->setMachineBlockAddressTaken();
  Again->setLabelMustBeEmitted();
  Rest->splice(Rest->begin(), This, std::next(MI.getIterator()), This->end());
  Rest->transferSuccessorsAndUpdatePHIs(This);

  const Register Upper = NewRegister(), Place = NewRegister(), Zero = NewRegister(), One = NewRegister();
  BuildMI(This, DL, TII.get(Trax::LUI), Upper).addMBB(Again, TraxII::MO_HI);
  BuildMI(This, DL, TII.get(Trax::ADDI), Place).addReg(Upper).addMBB(Again, TraxII::MO_LO);
  BuildMI(This, DL, TII.get(Trax::SW)).addReg(Place).addReg(Buffer).addImm(Address);
  BuildMI(This, DL, TII.get(Trax::SW))
      .addReg(TraxFrameLowering::BasePointer, RegState::Undef)
      .addReg(Buffer)
      .addImm(BasePointer);
  BuildMI(This, DL, TII.get(Trax::PseudoSjLjSetup))
      .addMBB(Again)
      .addRegMask(MF.getSubtarget().getRegisterInfo()->getNoPreservedMask());
  This->addSuccessor(Main);
  This->addSuccessor(Again);

  BuildMI(Main, DL, TII.get(Trax::ADDI), Zero).addReg(Trax::R0).addImm(0);
  Main->addSuccessor(Rest);
  BuildMI(Again, DL, TII.get(Trax::ADDI), One).addReg(Trax::R0).addImm(1);
  BuildMI(Again, DL, TII.get(Trax::PseudoBR)).addMBB(Rest);
  Again->addSuccessor(Rest);
  BuildMI(*Rest, Rest->begin(), DL, TII.get(TargetOpcode::PHI), Result)
      .addReg(Zero)
      .addMBB(Main)
      .addReg(One)
      .addMBB(Again);
  MI.eraseFromParent();
  return Rest;
}

/// Expands the pseudo after register allocation: nothing may be reloaded from the stack once sp and fp are another
/// function's. ra is free because it has been saved. The buffer's register is not among those that are loaded.
void llvm::expandTraxLongJmp(MachineInstr &MI, const TargetInstrInfo &TII) {
  MachineBasicBlock &MBB = *MI.getParent();
  const DebugLoc &DL = MI.getDebugLoc();
  const Register Buffer = MI.getOperand(0).getReg();
  const std::pair<MCPhysReg, int> Loads[] = {{Trax::R1, Address},
                                             {TraxFrameLowering::BasePointer, BasePointer},
                                             {Trax::R2, StackPointer},
                                             {Trax::R3, FramePointer}};
  for (const auto &[Register, Offset] : Loads)
    BuildMI(MBB, MI, DL, TII.get(Trax::LW), Register).addReg(Buffer).addImm(Offset);
  BuildMI(MBB, MI, DL, TII.get(Trax::PseudoBRIND)).addReg(Trax::R1, RegState::Kill).addImm(0);
  MI.eraseFromParent();
}
