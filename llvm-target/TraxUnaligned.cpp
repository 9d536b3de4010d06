//===- TraxUnaligned.cpp - Comparing words that may lie anywhere ---------===//
//
// A word whose address need not be a multiple of its size is loaded in pieces. Where two such words are only compared,
// or only combined by xor, their pieces are, before they are put together: once instead of twice, or not at all.
#include "TraxISelLowering.h"

using namespace llvm;

/// A plain load that the machine cannot do at once, of a value that nothing else uses.
static LoadSDNode *loadInPieces(SDValue Value) {
  auto *Load = dyn_cast<LoadSDNode>(Value);
  if (!Load || !Load->isSimple() || !ISD::isNormalLoad(Load) || !Value.hasOneUse() || Load->isNonTemporal())
    return nullptr;
  EVT VT = Value.getValueType();
  if (VT != MVT::i16 && VT != MVT::i32 && VT != MVT::i64)
    return nullptr;
  return Load->getAlign().value() < std::min<uint64_t>(VT.getStoreSize(), 4) ? Load : nullptr;
}

/// The pieces of both loads, combined by xor, lowest first; none if these are no such loads.
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

/// Not 0 if one of the values is not.
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
