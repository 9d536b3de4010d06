//===- TraxCombines.cpp - Target-specific DAG combines -------------------===//
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

/// A word whose address need not be a multiple of its size is loaded in pieces. If two such words are only compared, or
/// only combined by xor, the pieces are combined first, so words are put together once instead of twice, or not at all.

/// A plain load that takes several instructions, of a value with one use.
static LoadSDNode *loadInPieces(SDValue Value) {
  auto *Load = dyn_cast<LoadSDNode>(Value);
  if (!Load || !Load->isSimple() || !ISD::isNormalLoad(Load) || !Value.hasOneUse() || Load->isNonTemporal())
    return nullptr;
  EVT VT = Value.getValueType();
  if (VT != MVT::i16 && VT != MVT::i32 && VT != MVT::i64)
    return nullptr;
  return Load->getAlign().value() < std::min<uint64_t>(VT.getStoreSize(), 4) ? Load : nullptr;
}

/// The xor of each piece of one load with that of the other, lowest first; empty if the operands are not such loads.
static SmallVector<SDValue, 8> xorOfPieces(SDValue A, SDValue B, SelectionDAG &DAG, unsigned &Bytes) {
  LoadSDNode *Loads[] = {loadInPieces(A), loadInPieces(B)};
  SmallVector<SDValue, 8> Pieces;
  if (!Loads[0] || !Loads[1] || Loads[0] == Loads[1])
    return Pieces;
  SDLoc DL(A);
  Bytes = std::min(Loads[0]->getAlign(), Loads[1]->getAlign()).value();
  const EVT PieceVT = EVT::getIntegerVT(*DAG.getContext(), 8 * Bytes);
  for (unsigned Offset = 0; Offset < A.getValueType().getStoreSize(); Offset += Bytes) {
    SDValue Parts[2];
    for (unsigned I : {0, 1}) {
      LoadSDNode *Load = Loads[I];
      SDValue Address = DAG.getObjectPtrOffset(DL, Load->getBasePtr(), TypeSize::getFixed(Offset));
      Parts[I] = DAG.getExtLoad(ISD::ZEXTLOAD, SDLoc(Load), MVT::i32, Load->getChain(), Address,
                                Load->getPointerInfo().getWithOffset(Offset), PieceVT, Align(Bytes),
                                Load->getMemOperand()->getFlags(), Load->getAAInfo());
    }
    Pieces.push_back(DAG.getNode(ISD::XOR, DL, MVT::i32, Parts[0], Parts[1]));
    for (unsigned I : {0, 1})
      DAG.makeEquivalentMemoryOrdering(Loads[I], Parts[I]);
  }
  return Pieces;
}

/// The values combined by or.
static SDValue anyOf(ArrayRef<SDValue> Values, const SDLoc &DL, SelectionDAG &DAG) {
  if (Values.size() == 1)
    return Values.front();
  const size_t Half = Values.size() / 2;
  return DAG.getNode(ISD::OR, DL, MVT::i32, anyOf(Values.take_front(Half), DL, DAG),
                     anyOf(Values.drop_front(Half), DL, DAG));
}

SDValue TraxTargetLowering::performUnalignedCombine(SDNode *N, DAGCombinerInfo &DCI) const {
  if (!DCI.isBeforeLegalize())
    return SDValue();
  SelectionDAG &DAG = DCI.DAG;
  SDLoc DL(N);
  unsigned Bytes;
  if (N->getOpcode() == ISD::XOR) {
    if (N->getValueType(0) == MVT::i16)
      return SDValue();
    SmallVector<SDValue, 8> Pieces = xorOfPieces(N->getOperand(0), N->getOperand(1), DAG, Bytes);
    if (Pieces.empty())
      return SDValue();
    SmallVector<SDValue, 2> Words;
    for (unsigned First = 0; First < Pieces.size(); First += 4 / Bytes) {
      SmallVector<SDValue, 4> Parts;
      for (unsigned I = 0; I < 4 / Bytes; ++I)
        Parts.push_back(
            DAG.getNode(ISD::SHL, DL, MVT::i32, Pieces[First + I], DAG.getConstant(8 * Bytes * I, DL, MVT::i32)));
      Words.push_back(anyOf(Parts, DL, DAG));
    }
    return Words.size() == 1 ? Words.front() : DAG.getNode(ISD::BUILD_PAIR, DL, MVT::i64, Words);
  }
  const bool Branches = N->getOpcode() == ISD::BR_CC;
  ISD::CondCode CC = cast<CondCodeSDNode>(N->getOperand(Branches ? 1 : 2))->get();
  if (CC != ISD::SETEQ && CC != ISD::SETNE)
    return SDValue();
  SmallVector<SDValue, 8> Pieces =
      xorOfPieces(N->getOperand(Branches ? 2 : 0), N->getOperand(Branches ? 3 : 1), DAG, Bytes);
  if (Pieces.empty())
    return SDValue();
  SDValue Differ = anyOf(Pieces, DL, DAG), Zero = DAG.getConstant(0, DL, MVT::i32);
  if (Branches)
    return DAG.getNode(ISD::BR_CC, DL, MVT::Other, N->getOperand(0), DAG.getCondCode(CC), Differ, Zero,
                       N->getOperand(4));
  return DAG.getSetCC(DL, N->getValueType(0), Differ, Zero, CC);
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
