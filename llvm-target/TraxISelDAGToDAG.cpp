//===- TraxISelDAGToDAG.cpp - Instruction selection ----------------------===//
//
// Selection that the patterns of TraxPatterns.td cannot express: constants and addresses.
//
//===----------------------------------------------------------------------===//
#include "Trax.h"
#include "TraxSubtarget.h"
#include "TraxTargetMachine.h"
#include "llvm/Analysis/LoopInfo.h"
#include "llvm/CodeGen/FunctionLoweringInfo.h"
#include "llvm/CodeGen/SelectionDAGISel.h"

using namespace llvm;

#define DEBUG_TYPE "trax-isel"
#define PASS_NAME "TRaX instruction selection"

namespace {

class TraxDAGToDAGISel : public SelectionDAGISel {
public:
  TraxDAGToDAGISel(TraxTargetMachine &TM, CodeGenOptLevel OptLevel) : SelectionDAGISel(TM, OptLevel) {}

  void Select(SDNode *N) override;
  bool SelectInlineAsmMemoryOperand(const SDValue &Op, InlineAsm::ConstraintCode Constraint,
                                    std::vector<SDValue> &OutOps) override;

  const LoopInfo *Loops = nullptr; // none without optimization

private:
  SDValue selectConstant(uint32_t Bits, const SDLoc &DL, EVT VT);
  bool selectAddrFrame(SDValue Addr, SDValue &Base, SDValue &Offset);
  bool selectAddrRegImm(SDValue Addr, SDValue &Base, SDValue &Offset);
  bool selectShiftAmount(SDValue Amount, SDValue &Result);
  bool selectMask(SDNode *N);
  void selectGroups(SDNode *N);

#include "TraxGenDAGISel.inc"
};

class TraxDAGToDAGISelLegacy : public SelectionDAGISelLegacy {
public:
  static char ID;
  TraxDAGToDAGISelLegacy(TraxTargetMachine &TM, CodeGenOptLevel OptLevel)
      : TraxDAGToDAGISelLegacy(new TraxDAGToDAGISel(TM, OptLevel)) {}

  void getAnalysisUsage(AnalysisUsage &AU) const override {
    if (Selector->OptLevel != CodeGenOptLevel::None)
      AU.addRequired<LoopInfoWrapperPass>();
    SelectionDAGISelLegacy::getAnalysisUsage(AU);
  }

  bool runOnMachineFunction(MachineFunction &MF) override {
    auto *Loops = getAnalysisIfAvailable<LoopInfoWrapperPass>();
    Selector->Loops = Loops ? &Loops->getLoopInfo() : nullptr;
    return SelectionDAGISelLegacy::runOnMachineFunction(MF);
  }

private:
  explicit TraxDAGToDAGISelLegacy(TraxDAGToDAGISel *S)
      : SelectionDAGISelLegacy(ID, std::unique_ptr<SelectionDAGISel>(S)), Selector(S) {}

  TraxDAGToDAGISel *Selector; // owned by the base class, which gives no access
};

} // namespace

char TraxDAGToDAGISelLegacy::ID = 0;

INITIALIZE_PASS(TraxDAGToDAGISelLegacy, DEBUG_TYPE, PASS_NAME, false, false)

FunctionPass *llvm::createTraxISelDag(TraxTargetMachine &TM, CodeGenOptLevel OptLevel) {
  return new TraxDAGToDAGISelLegacy(TM, OptLevel);
}

/// A constant in a register: none, one or two instructions. Floats too, whose usual values have zeros in the lower
/// half.
SDValue TraxDAGToDAGISel::selectConstant(uint32_t Bits, const SDLoc &DL, EVT VT) {
  int32_t Value = Bits;
  SDValue Zero = CurDAG->getRegister(Trax::R0, MVT::i32);
  if (Bits == 0)
    return CurDAG->getCopyFromReg(CurDAG->getEntryNode(), DL, Trax::R0, VT);
  auto Imm = [&](int64_t V) { return CurDAG->getTargetConstant(V, DL, MVT::i32); };
  if (isInt<16>(Value))
    return SDValue(CurDAG->getMachineNode(Trax::ADDI, DL, VT, Zero, Imm(Value)), 0);
  int64_t Lower = SignExtend64<16>(Bits);
  SDValue Upper = Imm((Bits - uint32_t(Lower)) >> 16);
  if (Lower == 0)
    return SDValue(CurDAG->getMachineNode(Trax::LUI, DL, VT, Upper), 0);
  SDValue High = SDValue(CurDAG->getMachineNode(Trax::LUI, DL, MVT::i32, Upper), 0);
  return SDValue(CurDAG->getMachineNode(Trax::ADDI, DL, VT, High, Imm(Lower)), 0);
}

void TraxDAGToDAGISel::Select(SDNode *N) {
  if (N->isMachineOpcode()) {
    N->setNodeId(-1);
    return;
  }
  if (auto *C = dyn_cast<ConstantSDNode>(N); C && N->getOpcode() == ISD::Constant && N->getValueType(0) == MVT::i32) {
    ReplaceNode(N, selectConstant(C->getZExtValue(), SDLoc(N), MVT::i32).getNode());
    return;
  }
  if (auto *C = dyn_cast<ConstantFPSDNode>(N); C && N->getOpcode() == ISD::ConstantFP) {
    ReplaceNode(N, selectConstant(C->getValueAPF().bitcastToAPInt().getZExtValue(), SDLoc(N), MVT::f32).getNode());
    return;
  }
  if (N->getOpcode() == TraxISD::GROUPS)
    return selectGroups(N);
  // An address, unless loads and stores share its upper half.
  if (N->getOpcode() == TraxISD::ADD_LO && N->getOperand(0).getOpcode() == TraxISD::HI &&
      N->getOperand(0).hasOneUse()) {
    ReplaceNode(N, CurDAG->getMachineNode(Trax::PseudoLUIADDI, SDLoc(N), MVT::i32, N->getOperand(0).getOperand(0),
                                          N->getOperand(1)));
    return;
  }
  if (selectMask(N))
    return;
  SelectCode(N);
}

/// Makes a group of registers of the values that an instruction reads by one field.
void TraxDAGToDAGISel::selectGroups(SDNode *N) {
  SDLoc DL(N);
  const unsigned Opcode = N->getConstantOperandVal(0);
  const TraxSubtarget &Subtarget = MF->getSubtarget<TraxSubtarget>();
  const MCInstrDesc &Desc = Subtarget.getInstrInfo()->get(Opcode);
  SmallVector<SDValue, 3> Operands = {N->getOperand(1)};
  unsigned Next = 2;
  for (unsigned Index : {2, 3}) { // after rd and its old value
    const unsigned Class = Desc.operands()[Index].RegClass;
    const TargetRegisterInfo &TRI = *Subtarget.getRegisterInfo();
    const unsigned Count = TRI.getRegSizeInBits(*TRI.getRegClass(Class)) / 32;
    SmallVector<SDValue, 20> Parts = {CurDAG->getTargetConstant(Class, DL, MVT::i32)};
    for (unsigned I = 0; I < Count; ++I) {
      Parts.push_back(N->getOperand(Next++));
      Parts.push_back(CurDAG->getTargetConstant(Trax::group0 + I, DL, MVT::i32));
    }
    Operands.push_back(SDValue(CurDAG->getMachineNode(TargetOpcode::REG_SEQUENCE, DL, MVT::Untyped, Parts), 0));
  }
  ReplaceNode(N, CurDAG->getMachineNode(Opcode, DL, N->getValueType(0), Operands));
}

/// A mask of low bits, as of a float's magnitude, becomes two shifts outside of loops. In a loop it becomes one
/// instruction with a mask that stays in a register.
bool TraxDAGToDAGISel::selectMask(SDNode *N) {
  uint32_t Mask = 0x7FFFFFFF;
  if (N->getOpcode() == ISD::AND) {
    auto *C = dyn_cast<ConstantSDNode>(N->getOperand(1));
    Mask = C ? C->getZExtValue() : 0;
  } else if (N->getOpcode() != ISD::FABS) {
    return false;
  }
  if (!isMask_32(Mask) || isInt<16>(int32_t(Mask)) || MF->getFunction().hasOptSize() || !Loops ||
      !Loops->getLoopFor(FuncInfo->MBB->getBasicBlock()))
    return false;
  SDLoc DL(N);
  SDValue Bits = selectConstant(Mask, DL, MVT::i32);
  ReplaceNode(N, CurDAG->getMachineNode(Trax::AND, DL, N->getValueType(0), N->getOperand(0), Bits));
  return true;
}

/// An object of the frame, perhaps with an offset.
bool TraxDAGToDAGISel::selectAddrFrame(SDValue Addr, SDValue &Base, SDValue &Offset) {
  int64_t Value = 0;
  auto *Frame = dyn_cast<FrameIndexSDNode>(Addr);
  if (!Frame && CurDAG->isBaseWithConstantOffset(Addr)) {
    Frame = dyn_cast<FrameIndexSDNode>(Addr.getOperand(0));
    Value = cast<ConstantSDNode>(Addr.getOperand(1))->getSExtValue();
  }
  if (!Frame || Frame->getOpcode() != ISD::FrameIndex || !isInt<16>(Value))
    return false;
  Base = CurDAG->getTargetFrameIndex(Frame->getIndex(), MVT::i32);
  Offset = CurDAG->getTargetConstant(Value, SDLoc(Addr), MVT::i32);
  return true;
}

/// Any address, as the register and the immediate of a load or store.
bool TraxDAGToDAGISel::selectAddrRegImm(SDValue Addr, SDValue &Base, SDValue &Offset) {
  if (selectAddrFrame(Addr, Base, Offset))
    return true;
  SDLoc DL(Addr);
  if (Addr.getOpcode() == TraxISD::ADD_LO) {
    Base = Addr.getOperand(0);
    Offset = Addr.getOperand(1);
    return true;
  }
  if (Addr.getOpcode() == TraxISD::ABS_ADDR) {
    Base = CurDAG->getRegister(Trax::R0, MVT::i32);
    Offset = Addr.getOperand(0);
    return true;
  }
  if (auto *C = dyn_cast<ConstantSDNode>(Addr)) { // an absolute address: what lui leaves goes to the immediate
    int64_t Lower = SignExtend64<16>(C->getZExtValue());
    Base = selectConstant(uint32_t(C->getZExtValue() - Lower), DL, MVT::i32);
    Offset = CurDAG->getTargetConstant(Lower, DL, MVT::i32);
    return true;
  }
  if (CurDAG->isBaseWithConstantOffset(Addr)) {
    int64_t Value = cast<ConstantSDNode>(Addr.getOperand(1))->getSExtValue();
    Base = Addr.getOperand(0);
    // Fields within a global's alignment share its upper half, but none across a multiple of 32 KiB: the lower half is
    // signed.
    constexpr uint64_t Shared = 0x8000;
    if (Base.getOpcode() == TraxISD::ADD_LO)
      if (auto *Symbol = dyn_cast<GlobalAddressSDNode>(Base.getOperand(1))) {
        int64_t Inside = Symbol->getOffset() + Value;
        Align Alignment = Symbol->getGlobal()->getPointerAlignment(CurDAG->getDataLayout());
        if (Symbol->getOffset() == 0 && Inside >= 0 && uint64_t(Inside) < std::min(Alignment.value(), Shared)) {
          Offset = CurDAG->getTargetGlobalAddress(Symbol->getGlobal(), DL, MVT::i32, Inside, TraxII::MO_LO);
          Base = Base.getOperand(0);
          return true;
        }
      }
    if (isInt<16>(Value)) {
      Offset = CurDAG->getTargetConstant(Value, DL, MVT::i32);
      return true;
    }
    // A sum beyond the immediate: its lower half stays there, and several accesses share the rest.
    int64_t Lower = SignExtend64<16>(Value);
    SDValue Upper = selectConstant(uint32_t(Value - Lower), DL, MVT::i32);
    Base = SDValue(CurDAG->getMachineNode(Trax::ADD, DL, MVT::i32, Base, Upper), 0);
    Offset = CurDAG->getTargetConstant(Lower, DL, MVT::i32);
    return true;
  }
  // An element of a global array: the lower half of the array's address needs no addition of its own.
  if (Addr.getOpcode() == ISD::ADD && Addr.hasOneUse())
    for (unsigned I : {0, 1}) {
      SDValue Array = Addr.getOperand(I);
      if (Array.getOpcode() != TraxISD::ADD_LO || !Array.hasOneUse())
        continue;
      Base = SDValue(CurDAG->getMachineNode(Trax::ADD, DL, MVT::i32, Array.getOperand(0), Addr.getOperand(1 - I)), 0);
      Offset = Array.getOperand(1);
      return true;
    }
  Base = Addr;
  Offset = CurDAG->getTargetConstant(0, DL, MVT::i32);
  return true;
}

/// Shifts look at five bits: a mask that keeps those changes nothing, nor does the subtraction from a multiple of 32,
/// which is a negation.
bool TraxDAGToDAGISel::selectShiftAmount(SDValue Amount, SDValue &Result) {
  Result = Amount;
  if (Result.getOpcode() == ISD::AND)
    if (auto *Mask = dyn_cast<ConstantSDNode>(Result.getOperand(1)); Mask && (Mask->getZExtValue() & 31) == 31)
      Result = Result.getOperand(0);
  if (Result.getOpcode() == ISD::SUB)
    if (auto *C = dyn_cast<ConstantSDNode>(Result.getOperand(0)); C && C->getZExtValue() % 32 == 0) {
      SDValue Zero = CurDAG->getRegister(Trax::R0, MVT::i32);
      Result = SDValue(CurDAG->getMachineNode(Trax::SUB, SDLoc(Amount), MVT::i32, Zero, Result.getOperand(1)), 0);
    }
  return true;
}

bool TraxDAGToDAGISel::SelectInlineAsmMemoryOperand(const SDValue &Op, InlineAsm::ConstraintCode,
                                                    std::vector<SDValue> &OutOps) {
  SDValue Base, Offset;
  selectAddrRegImm(Op, Base, Offset);
  OutOps.push_back(Base);
  OutOps.push_back(Offset);
  return false;
}
