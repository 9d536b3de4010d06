//===- TraxAtomics.cpp - Fences, atomic loads and increments -------------===//
#include "Trax.h"
#include "TraxISelLowering.h"
#include "trax/abi.h"

using namespace llvm;

SDValue TraxTargetLowering::lowerAtomicFence(SDValue Op, SelectionDAG &DAG) const {
  SDLoc DL(Op);
  SDValue Chain = Op.getOperand(0);
  if (Op.getConstantOperandVal(2) == SyncScope::SingleThread) // the thread itself sees its accesses in their order
    return DAG.getNode(ISD::MEMBARRIER, DL, MVT::Other, Chain);
  const auto Ordering = AtomicOrdering(Op.getConstantOperandVal(1));
  const unsigned Kind = Ordering == AtomicOrdering::Acquire   ? TRAX_FENCE_R
                        : Ordering == AtomicOrdering::Release ? TRAX_FENCE_W
                                                              : TRAX_FENCE_RW;
  return DAG.getNode(TraxISD::FENCE, DL, MVT::Other, Chain, DAG.getTargetConstant(Kind, DL, MVT::i32));
}

/// Caches of different TMs are not coherent, so an atomic load must go to memory. TraxLowerAtomics has replaced those
/// of local memory by plain loads. Bytes and halves are taken from their word.
SDValue TraxTargetLowering::lowerAtomicLoad(SDValue Op, SelectionDAG &DAG) const {
  auto *Load = cast<AtomicSDNode>(Op);
  SDLoc DL(Op);
  EVT MemVT = Load->getMemoryVT();
  SDValue Address = Load->getBasePtr();
  MachineFunction &MF = DAG.getMachineFunction();
  MachineMemOperand *MMO = Load->getMemOperand();
  auto LoadWord = [&](SDValue WordAddress, MachineMemOperand *WordMMO) {
    return DAG.getMemIntrinsicNode(TraxISD::LWNT, DL, DAG.getVTList(MVT::i32, MVT::Other),
                                   {Load->getChain(), WordAddress}, MVT::i32, WordMMO);
  };
  if (MemVT == MVT::i32)
    return LoadWord(Address, MMO);

  MMO = MF.getMachineMemOperand(MachinePointerInfo(MMO->getAddrSpace()), MMO->getFlags(), LLT::scalar(32), Align(4),
                                AAMDNodes(), nullptr, MMO->getSyncScopeID(), MMO->getSuccessOrdering());
  SDValue Word = LoadWord(DAG.getNode(ISD::AND, DL, MVT::i32, Address, DAG.getConstant(-4, DL, MVT::i32)), MMO);
  SDValue Shift = DAG.getNode(ISD::SHL, DL, MVT::i32,
                              DAG.getNode(ISD::AND, DL, MVT::i32, Address, DAG.getConstant(3, DL, MVT::i32)),
                              DAG.getConstant(3, DL, MVT::i32));
  SDValue Value = DAG.getNode(ISD::SRL, DL, MVT::i32, Word, Shift);
  // The legalizer asked for these upper bits.
  if (Load->getExtensionType() == ISD::SEXTLOAD)
    Value = DAG.getNode(ISD::SIGN_EXTEND_INREG, DL, MVT::i32, Value, DAG.getValueType(MemVT));
  else
    Value = DAG.getZeroExtendInReg(Value, DL, MemVT);
  return DAG.getMergeValues({Value, Word.getValue(1)}, DL);
}

/// The increment is the machine's only read-modify-write; TraxLowerAtomics has replaced the others by calls. The
/// thread's later accesses may overtake it, except those after an instruction that needs its result (docs/isa.md,
/// "Order").
SDValue TraxTargetLowering::lowerAtomicRMW(SDValue Op, SelectionDAG &DAG) const {
  auto *N = cast<AtomicSDNode>(Op);
  SDLoc DL(Op);
  SDValue Old = DAG.getMemIntrinsicNode(TraxISD::AINC, DL, DAG.getVTList(MVT::i32, MVT::Other),
                                        {N->getChain(), N->getBasePtr()}, MVT::i32, N->getMemOperand());
  // For every ordering: the thread's later accesses to the word come after the increment.
  SDValue Chain = DAG.getNode(TraxISD::WAIT, DL, MVT::Other, Old.getValue(1), Old);
  return DAG.getMergeValues({Old, Chain}, DL);
}

TargetLowering::AtomicExpansionKind TraxTargetLowering::shouldExpandAtomicRMWInIR(AtomicRMWInst *RMW) const {
  bool HasFunction = !getTraxAtomicFunction(RMW->getOperation()).empty() && RMW->getType()->isIntegerTy();
  return HasFunction ? AtomicExpansionKind::None : AtomicExpansionKind::CmpXChg;
}
