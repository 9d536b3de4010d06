//===- TraxCombines.cpp - What nodes become before selection -------------===//
//
// Comparisons of words that may be unaligned are in TraxUnaligned.cpp.
//
//===----------------------------------------------------------------------===//
#include "Trax.h"
#include "TraxISelLowering.h"
#include "llvm/Support/MathExtras.h"

using namespace llvm;

/// (symbol + constant) becomes a symbol with an offset where nothing else needs the symbol: it saves the addition.
/// Other uses share the symbol's address and put the constant into their own immediate.
SDValue TraxTargetLowering::performAddCombine(SDNode *N, DAGCombinerInfo &DCI) const {
  auto *Constant = dyn_cast<ConstantSDNode>(N->getOperand(1));
  SDValue Address = N->getOperand(0);
  if (!Constant || (Address.getOpcode() != TraxISD::ADD_LO && Address.getOpcode() != TraxISD::ABS_ADDR))
    return SDValue();
  bool IsAbsolute = Address.getOpcode() == TraxISD::ABS_ADDR;
  auto *Symbol = dyn_cast<GlobalAddressSDNode>(Address.getOperand(IsAbsolute ? 0 : 1));
  if (!Symbol || (!IsAbsolute && !Address.hasOneUse()))
    return SDValue();
  SelectionDAG &DAG = DCI.DAG;
  SDLoc DL(N);
  int64_t Offset = Symbol->getOffset() + Constant->getSExtValue();
  if (!isInt<16>(Offset))
    return SDValue();
  auto WithOffset = [&](unsigned Flag) {
    return DAG.getTargetGlobalAddress(Symbol->getGlobal(), DL, MVT::i32, Offset, Flag);
  };
  if (IsAbsolute)
    return DAG.getNode(TraxISD::ABS_ADDR, DL, MVT::i32, WithOffset(TraxII::MO_ABS));
  SDValue Hi = DAG.getNode(TraxISD::HI, DL, MVT::i32, WithOffset(TraxII::MO_HI));
  return DAG.getNode(TraxISD::ADD_LO, DL, MVT::i32, Hi, WithOffset(TraxII::MO_LO));
}

/// A choice between two floats by a comparison of their words is the lesser or the greater word.
static SDValue lesserOrGreaterWord(SDNode *N, SelectionDAG &DAG) {
  SDValue Condition = N->getOperand(0), True = N->getOperand(1), False = N->getOperand(2);
  if (N->getValueType(0) != MVT::f32 || Condition.getOpcode() != ISD::SETCC)
    return SDValue();
  SDValue A = Condition.getOperand(0), B = Condition.getOperand(1);
  if (A.getOpcode() != ISD::BITCAST || B.getOpcode() != ISD::BITCAST || A.getValueType() != MVT::i32)
    return SDValue();
  ISD::CondCode CC = cast<CondCodeSDNode>(Condition.getOperand(2))->get();
  if (A.getOperand(0) == False && B.getOperand(0) == True)
    CC = ISD::getSetCCSwappedOperands(CC);
  else if (A.getOperand(0) != True || B.getOperand(0) != False)
    return SDValue();
  unsigned Opcode;
  switch (CC) {
  case ISD::SETLT:
  case ISD::SETLE:
    Opcode = ISD::SMIN;
    break;
  case ISD::SETGT:
  case ISD::SETGE:
    Opcode = ISD::SMAX;
    break;
  case ISD::SETULT:
  case ISD::SETULE:
    Opcode = ISD::UMIN;
    break;
  case ISD::SETUGT:
  case ISD::SETUGE:
    Opcode = ISD::UMAX;
    break;
  default:
    return SDValue();
  }
  return DAG.getBitcast(MVT::f32, DAG.getNode(Opcode, SDLoc(N), MVT::i32, A, B));
}

/// A choice between two constants that differ by a power of two is a shifted comparison: a conditional move would need
/// both in registers, and destroy one.
SDValue TraxTargetLowering::performSelectCombine(SDNode *N, DAGCombinerInfo &DCI) const {
  SDValue Condition = N->getOperand(0);
  auto *True = dyn_cast<ConstantSDNode>(N->getOperand(1)), *False = dyn_cast<ConstantSDNode>(N->getOperand(2));
  if (DCI.isBeforeLegalize() || N->getValueType(0) != MVT::i32 || !True || !False ||
      Condition.getOpcode() != ISD::SETCC || Condition.getOperand(0).getValueType() != MVT::i32)
    return SDValue();
  // Comparisons that the machine has, one way or the other.
  ISD::CondCode CC = cast<CondCodeSDNode>(Condition.getOperand(2))->get();
  uint32_t IfTrue = True->getZExtValue(), IfFalse = False->getZExtValue();
  SelectionDAG &DAG = DCI.DAG;
  SDLoc DL(N);
  if (CC == ISD::SETGE || CC == ISD::SETLE || CC == ISD::SETUGE || CC == ISD::SETULE) {
    CC = ISD::getSetCCInverse(CC, MVT::i32);
    Condition = DAG.getSetCC(DL, MVT::i32, Condition.getOperand(0), Condition.getOperand(1), CC);
    std::swap(IfTrue, IfFalse);
  }
  bool Adds = isPowerOf2_32(IfTrue - IfFalse);
  if (!Adds && !isPowerOf2_32(IfFalse - IfTrue))
    return SDValue();
  SDValue Amount = DAG.getConstant(Log2_32(Adds ? IfTrue - IfFalse : IfFalse - IfTrue), DL, MVT::i32);
  SDValue Difference = DAG.getNode(ISD::SHL, DL, MVT::i32, Condition, Amount);
  SDValue Base = DAG.getConstant(IfFalse, DL, MVT::i32);
  return Adds ? DAG.getNode(ISD::ADD, DL, MVT::i32, Difference, Base)
              : DAG.getNode(ISD::SUB, DL, MVT::i32, Base, Difference);
}

SDValue TraxTargetLowering::PerformDAGCombine(SDNode *N, DAGCombinerInfo &DCI) const {
  switch (N->getOpcode()) {
  case ISD::ADD:
    return performAddCombine(N, DCI);
  case ISD::SELECT:
    if (SDValue Word = lesserOrGreaterWord(N, DCI.DAG))
      return Word;
    return performSelectCombine(N, DCI);
  case ISD::XOR:
  case ISD::SETCC:
  case ISD::BR_CC:
    return performUnalignedCombine(N, DCI);
  default:
    return SDValue();
  }
}
