//===- TraxISelLowering.cpp - Operations that the machine lacks ----------===//
#include "TraxISelLowering.h"
#include "Trax.h"
#include "TraxMachineFunctionInfo.h"
#include "TraxSubtarget.h"
#include "llvm/CodeGen/MachineFrameInfo.h"
#include "llvm/CodeGen/MachineJumpTableInfo.h"
#include "llvm/CodeGen/MachineRegisterInfo.h"
#include "llvm/IR/DiagnosticInfo.h"
#include "llvm/IR/GlobalVariable.h"

using namespace llvm;

#define DEBUG_TYPE "trax-lower"

TraxTargetLowering::TraxTargetLowering(const TargetMachine &TM, const TraxSubtarget &STI)
    : TargetLowering(TM), Subtarget(STI) {
  addRegisterClass(MVT::i32, &Trax::GPRRegClass);
  addRegisterClass(MVT::f32, &Trax::GPRRegClass);
  computeRegisterProperties(Subtarget.getRegisterInfo());

  setStackPointerRegisterToSaveRestore(Trax::R2);
  setBooleanContents(ZeroOrOneBooleanContent);
  setMinFunctionAlignment(Align(4));
  setSchedulingPreference(Sched::RegPressure);

  // Integers. i64 is two registers: no carry, but both halves of a product.
  setOperationAction({ISD::SDIV, ISD::UDIV, ISD::SREM, ISD::UREM, ISD::SDIVREM, ISD::UDIVREM}, MVT::i32, Expand);
  setOperationAction({ISD::SMUL_LOHI, ISD::UMUL_LOHI}, MVT::i32, Expand);
  setOperationAction({ISD::MULHS, ISD::MULHU}, MVT::i32, Legal);
  setOperationAction({ISD::SHL_PARTS, ISD::SRL_PARTS, ISD::SRA_PARTS}, MVT::i32, Custom);
  setOperationAction({ISD::ROTL, ISD::ROTR, ISD::BSWAP, ISD::BITREVERSE, ISD::CTPOP, ISD::CTLZ, ISD::CTTZ,
                      ISD::CTLZ_ZERO_UNDEF, ISD::CTTZ_ZERO_UNDEF, ISD::ABS},
                     MVT::i32, Expand);
  setOperationAction({ISD::SMIN, ISD::SMAX, ISD::UMIN, ISD::UMAX}, MVT::i32, Legal);
  setOperationAction(ISD::SIGN_EXTEND_INREG, MVT::i1, Expand);
  setOperationAction(ISD::SELECT_CC, {MVT::i32, MVT::f32}, Expand);
  for (MVT VT : {MVT::i8, MVT::i16, MVT::i32})
    setLoadExtAction({ISD::EXTLOAD, ISD::SEXTLOAD, ISD::ZEXTLOAD}, VT, MVT::i1, Promote);

  // Overflow checks of i64 compute with i128, which has no library functions here: the code is inline.
  for (RTLIB::Libcall Call : {RTLIB::MULO_I32, RTLIB::MULO_I64, RTLIB::MULO_I128, RTLIB::MUL_I128, RTLIB::SHL_I128,
                              RTLIB::SRL_I128, RTLIB::SRA_I128})
    setLibcallName(Call, nullptr);

  // Control.
  setOperationAction({ISD::BR_JT, ISD::BRCOND}, MVT::Other, Expand);
  setOperationAction({ISD::TRAP, ISD::DEBUGTRAP}, MVT::Other, Legal);
  setOperationAction({ISD::STACKSAVE, ISD::STACKRESTORE}, MVT::Other, Expand);
  setOperationAction(ISD::DYNAMIC_STACKALLOC, MVT::i32, Expand);
  setOperationAction(ISD::VASTART, MVT::Other, Custom);
  setOperationAction({ISD::VAARG, ISD::VACOPY, ISD::VAEND}, MVT::Other, Expand);
  setOperationAction({ISD::FRAMEADDR, ISD::RETURNADDR}, MVT::i32, Custom);
  setOperationAction(ISD::READCYCLECOUNTER, MVT::i64, Custom);
  setOperationAction(ISD::PREFETCH, MVT::Other, Expand);
  setOperationAction(ISD::EH_RETURN, MVT::Other, Custom);
  setOperationAction(ISD::EH_SJLJ_SETJMP, MVT::i32, Custom);
  setOperationAction(ISD::EH_SJLJ_LONGJMP, MVT::Other, Custom);
  setMinimumJumpTableEntries(6);

  // Addresses.
  setOperationAction({ISD::GlobalAddress, ISD::GlobalTLSAddress, ISD::BlockAddress, ISD::JumpTable, ISD::ConstantPool},
                     MVT::i32, Custom);

  // Floats. Missing operations are expanded to integer operations, or to calls of the library.
  setOperationAction({ISD::FMINNUM, ISD::FMAXNUM}, MVT::f32, Legal);
  setOperationAction({ISD::FMINIMUM, ISD::FMAXIMUM, ISD::FCOPYSIGN, ISD::FMA,       ISD::FMAD, ISD::FREM,
                      ISD::FSQRT,    ISD::FSIN,     ISD::FCOS,      ISD::FSINCOS,   ISD::FTAN, ISD::FPOW,
                      ISD::FPOWI,    ISD::FEXP,     ISD::FEXP2,     ISD::FEXP10,    ISD::FLOG, ISD::FLOG2,
                      ISD::FLOG10,   ISD::FLDEXP,   ISD::FFREXP,    ISD::IS_FPCLASS},
                     MVT::f32, Expand);
  setOperationAction({ISD::FFLOOR, ISD::FCEIL, ISD::FTRUNC, ISD::FRINT, ISD::FNEARBYINT, ISD::FROUND, ISD::FROUNDEVEN,
                      ISD::LROUND, ISD::LLROUND, ISD::LRINT, ISD::LLRINT},
                     MVT::f32, Expand);
  setOperationAction({ISD::FP_TO_SINT_SAT, ISD::FP_TO_UINT_SAT}, MVT::i32, Custom);
  setOperationAction(ISD::FCANONICALIZE, MVT::f32, Custom); // a part of conversions to bfloat
  for (MVT VT : {MVT::f16, MVT::bf16}) {
    setLoadExtAction(ISD::EXTLOAD, MVT::f32, VT, Expand);
    setTruncStoreAction(MVT::f32, VT, Expand);
  }
  setOperationAction({ISD::FP16_TO_FP, ISD::FP_TO_FP16, ISD::BF16_TO_FP, ISD::FP_TO_BF16}, MVT::f32, Expand);

  // Atomics: words and less are done by the machine; wider ones are calls of the library.
  setMaxAtomicSizeInBitsSupported(32);
  setMinCmpXchgSizeInBits(8);
  setOperationAction(ISD::ATOMIC_FENCE, MVT::Other, Custom);
  setOperationAction(ISD::ATOMIC_LOAD, MVT::i32, Custom);
  setOperationAction({ISD::ATOMIC_LOAD_ADD, ISD::ATOMIC_LOAD_SUB}, MVT::i32, Custom);

  // Inline copies of up to eight words; longer ones are loops in the library.
  MaxStoresPerMemset = 8;
  MaxStoresPerMemcpy = MaxStoresPerMemmove = 8;
  MaxStoresPerMemsetOptSize = MaxStoresPerMemcpyOptSize = MaxStoresPerMemmoveOptSize = 4;

  setTargetDAGCombine({ISD::ADD, ISD::SELECT, ISD::XOR, ISD::SETCC, ISD::BR_CC});
}

const char *TraxTargetLowering::getTargetNodeName(unsigned Opcode) const {
  switch (Opcode) {
#define NODE(NAME)                                                                                                     \
  case TraxISD::NAME:                                                                                                  \
    return "TraxISD::" #NAME;
    NODE(CALL)
    NODE(TAIL)
    NODE(RET)
    NODE(HI)
    NODE(ADD_LO)
    NODE(ABS_ADDR)
    NODE(RSQRT)
    NODE(GROUPS)
    NODE(OPAQUE)
    NODE(RDSR_CONST)
    NODE(RDSR)
    NODE(TRAP)
    NODE(HALT)
    NODE(COPY_LOOP)
    NODE(SETJMP)
    NODE(LONGJMP)
    NODE(WAIT)
    NODE(FENCE)
    NODE(AINC)
    NODE(LWNT)
#undef NODE
  default:
    return nullptr;
  }
}

SDValue TraxTargetLowering::LowerOperation(SDValue Op, SelectionDAG &DAG) const {
  switch (Op.getOpcode()) {
  case ISD::GlobalAddress:
  case ISD::GlobalTLSAddress:
    return lowerGlobalAddress(Op, DAG);
  case ISD::BlockAddress:
    return lowerAddress(cast<BlockAddressSDNode>(Op), DAG);
  case ISD::JumpTable:
    return lowerAddress(cast<JumpTableSDNode>(Op), DAG);
  case ISD::ConstantPool:
    return lowerAddress(cast<ConstantPoolSDNode>(Op), DAG);
  case ISD::SHL_PARTS:
  case ISD::SRL_PARTS:
  case ISD::SRA_PARTS: {
    SDValue Low, High;
    expandShiftParts(Op.getNode(), Low, High, DAG);
    return DAG.getMergeValues({Low, High}, SDLoc(Op));
  }
  case ISD::FP_TO_SINT_SAT:
  case ISD::FP_TO_UINT_SAT:
    return lowerFPToIntSat(Op, DAG);
  case ISD::FCANONICALIZE:
    return DAG.getNode(ISD::FMINNUM, SDLoc(Op), MVT::f32, Op.getOperand(0), Op.getOperand(0));
  case ISD::VASTART:
    return lowerVAStart(Op, DAG);
  case ISD::FRAMEADDR:
    return lowerFrameAddr(Op, DAG);
  case ISD::RETURNADDR:
    return lowerReturnAddr(Op, DAG);
  case ISD::EH_RETURN: {
    const Function &F = DAG.getMachineFunction().getFunction();
    DAG.getContext()->diagnose(DiagnosticInfoUnsupported(F, "there is no unwinder to return from", Op.getDebugLoc()));
    return Op.getOperand(0);
  }
  case ISD::EH_SJLJ_SETJMP:
    return lowerSetJmp(Op, DAG);
  case ISD::EH_SJLJ_LONGJMP:
    return lowerLongJmp(Op, DAG);
  case ISD::ATOMIC_FENCE:
    return lowerAtomicFence(Op, DAG);
  case ISD::ATOMIC_LOAD:
    return lowerAtomicLoad(Op, DAG);
  case ISD::ATOMIC_LOAD_ADD:
  case ISD::ATOMIC_LOAD_SUB:
    return lowerAtomicRMW(Op, DAG);
  default:
    return SDValue();
  }
}

/// Reads the upper word before and after the lower one. If they differ, the counter carried in between: the lower word
/// is taken as 0.
void TraxTargetLowering::ReplaceNodeResults(SDNode *N, SmallVectorImpl<SDValue> &Results, SelectionDAG &DAG) const {
  if (N->getOpcode() != ISD::READCYCLECOUNTER)
    return;
  SDLoc DL(N);
  SDVTList VTs = DAG.getVTList(MVT::i32, MVT::Other);
  SDValue Low = DAG.getTargetConstant(TRAX_SR_CYCLE, DL, MVT::i32);
  SDValue High = DAG.getTargetConstant(TRAX_SR_CYCLEH, DL, MVT::i32);
  SDValue Before = DAG.getNode(TraxISD::RDSR, DL, VTs, N->getOperand(0), High);
  SDValue Cycle = DAG.getNode(TraxISD::RDSR, DL, VTs, Before.getValue(1), Low);
  SDValue After = DAG.getNode(TraxISD::RDSR, DL, VTs, Cycle.getValue(1), High);
  SDValue Carried = DAG.getSetCC(DL, MVT::i32, Before, After, ISD::SETNE);
  SDValue Word = DAG.getSelect(DL, MVT::i32, Carried, DAG.getConstant(0, DL, MVT::i32), Cycle);
  Results.push_back(DAG.getNode(ISD::BUILD_PAIR, DL, MVT::i64, Word, After));
  Results.push_back(After.getValue(1));
}

//--- addresses ----------------------------------------------------------------

static SDValue targetSymbol(GlobalAddressSDNode *N, EVT VT, SelectionDAG &DAG, unsigned Flag) {
  return DAG.getTargetGlobalAddress(N->getGlobal(), SDLoc(N), VT, N->getOffset(), Flag);
}
static SDValue targetSymbol(BlockAddressSDNode *N, EVT VT, SelectionDAG &DAG, unsigned Flag) {
  return DAG.getTargetBlockAddress(N->getBlockAddress(), VT, N->getOffset(), Flag);
}
static SDValue targetSymbol(JumpTableSDNode *N, EVT VT, SelectionDAG &DAG, unsigned Flag) {
  return DAG.getTargetJumpTable(N->getIndex(), VT, Flag);
}
static SDValue targetSymbol(ConstantPoolSDNode *N, EVT VT, SelectionDAG &DAG, unsigned Flag) {
  return DAG.getTargetConstantPool(N->getConstVal(), VT, N->getAlign(), N->getOffset(), Flag);
}

template <class NodeTy> SDValue TraxTargetLowering::lowerAddress(NodeTy *N, SelectionDAG &DAG) const {
  SDLoc DL(N);
  SDValue Hi = DAG.getNode(TraxISD::HI, DL, MVT::i32, targetSymbol(N, MVT::i32, DAG, TraxII::MO_HI));
  return DAG.getNode(TraxISD::ADD_LO, DL, MVT::i32, Hi, targetSymbol(N, MVT::i32, DAG, TraxII::MO_LO));
}

SDValue TraxTargetLowering::lowerGlobalAddress(SDValue Op, SelectionDAG &DAG) const {
  auto *N = cast<GlobalAddressSDNode>(Op);
  if (!N->getGlobal()->isThreadLocal())
    return lowerAddress(N, DAG);
  // Thread-local objects have the same addresses in every thread's local memory. Any immediate reaches them.
  SDLoc DL(N);
  SDValue Symbol = DAG.getTargetGlobalAddress(N->getGlobal(), DL, MVT::i32, N->getOffset(), TraxII::MO_ABS);
  return DAG.getNode(TraxISD::ABS_ADDR, DL, MVT::i32, Symbol);
}

bool TraxTargetLowering::isLegalAddressingMode(const DataLayout &, const AddrMode &AM, Type *, unsigned,
                                               Instruction *) const {
  if (AM.BaseGV || AM.ScalableOffset || !isInt<16>(AM.BaseOffs))
    return false;
  return AM.Scale == 0 || (AM.Scale == 1 && !AM.HasBaseReg);
}

//--- conversion ----------------------------------------------------------------

/// The machine saturates at 32 bits; narrower ranges are clamped first.
SDValue TraxTargetLowering::lowerFPToIntSat(SDValue Op, SelectionDAG &) const {
  if (cast<VTSDNode>(Op.getOperand(1))->getVT() == MVT::i32 && Op.getOperand(0).getValueType() == MVT::f32)
    return Op;
  return SDValue();
}

//--- square roots -------------------------------------------------------------

/// Called where flags allow an approximation. The machine's instruction needs no refinement: 1/sqrt(x) is one
/// instruction, sqrt(x) is x * rsqrt(x).
SDValue TraxTargetLowering::getSqrtEstimate(SDValue Operand, SelectionDAG &DAG, int Enabled, int &RefinementSteps,
                                            bool &UseOneConstNR, bool Reciprocal) const {
  if (Operand.getValueType() != MVT::f32 || Enabled == ReciprocalEstimate::Disabled)
    return SDValue();
  RefinementSteps = 0;
  UseOneConstNR = false;
  SDLoc DL(Operand);
  SDValue Result = DAG.getNode(TraxISD::RSQRT, DL, MVT::f32, Operand);
  return Reciprocal ? Result : DAG.getNode(ISD::FMUL, DL, MVT::f32, Operand, Result);
}

/// Finds +0 and -0, for which x * rsqrt(x) is 0 * infinity. An integer test does not need the shared adder.
SDValue TraxTargetLowering::getSqrtInputTest(SDValue Operand, SelectionDAG &DAG, const DenormalMode &) const {
  SDLoc DL(Operand);
  SDValue Bits =
      DAG.getNode(ISD::SHL, DL, MVT::i32, DAG.getBitcast(MVT::i32, Operand), DAG.getConstant(1, DL, MVT::i32));
  return DAG.getSetCC(DL, MVT::i32, Bits, DAG.getConstant(0, DL, MVT::i32), ISD::SETEQ);
}

SDValue TraxTargetLowering::getSqrtResultForDenormInput(SDValue Operand, SelectionDAG &) const {
  return Operand;
}

//--- costs --------------------------------------------------------------------

/// Nine instructions shift a double word by any amount. A call is fewer, but it clobbers caller-saved registers, and
/// saving their values takes more instructions. So only code compiled for size calls.
TargetLowering::ShiftLegalizationStrategy
TraxTargetLowering::preferredShiftLegalizationStrategy(SelectionDAG &DAG, SDNode *N, unsigned ExpansionFactor) const {
  if (DAG.getMachineFunction().getFunction().hasMinSize())
    return ShiftLegalizationStrategy::LowerToLibcall;
  return TargetLowering::preferredShiftLegalizationStrategy(DAG, N, ExpansionFactor);
}

bool TraxTargetLowering::isTruncateFree(Type *From, Type *To) const {
  return From->isIntegerTy() && To->isIntegerTy() && From->getPrimitiveSizeInBits() > To->getPrimitiveSizeInBits();
}

bool TraxTargetLowering::isTruncateFree(EVT From, EVT To) const {
  return From.isScalarInteger() && To.isScalarInteger() && From.getSizeInBits() > To.getSizeInBits();
}

bool TraxTargetLowering::isZExtFree(SDValue Value, EVT To) const {
  if (auto *Load = dyn_cast<LoadSDNode>(Value)) {
    EVT VT = Load->getMemoryVT();
    if ((VT == MVT::i8 || VT == MVT::i16) &&
        (Load->getExtensionType() == ISD::NON_EXTLOAD || Load->getExtensionType() == ISD::ZEXTLOAD))
      return true;
  }
  return TargetLowering::isZExtFree(Value, To);
}

//--- stack --------------------------------------------------------------------

SDValue TraxTargetLowering::lowerVAStart(SDValue Op, SelectionDAG &DAG) const {
  SDLoc DL(Op);
  const auto *Info = DAG.getMachineFunction().getInfo<TraxMachineFunctionInfo>();
  SDValue First = DAG.getFrameIndex(Info->getVarArgsFrameIndex(), MVT::i32);
  const Value *List = cast<SrcValueSDNode>(Op.getOperand(2))->getValue();
  return DAG.getStore(Op.getOperand(0), DL, First, Op.getOperand(1), MachinePointerInfo(List));
}

/// fp is the caller's sp; the caller's fp is saved below it and the return address, if both are.
SDValue TraxTargetLowering::lowerFrameAddr(SDValue Op, SelectionDAG &DAG) const {
  DAG.getMachineFunction().getFrameInfo().setFrameAddressIsTaken(true);
  SDLoc DL(Op);
  SDValue Frame = DAG.getCopyFromReg(DAG.getEntryNode(), DL, Trax::R3, MVT::i32);
  for (unsigned Depth = Op.getConstantOperandVal(0); Depth != 0; --Depth)
    Frame = DAG.getLoad(MVT::i32, DL, DAG.getEntryNode(),
                        DAG.getNode(ISD::ADD, DL, MVT::i32, Frame, DAG.getConstant(-8, DL, MVT::i32)),
                        MachinePointerInfo());
  return Frame;
}

SDValue TraxTargetLowering::lowerReturnAddr(SDValue Op, SelectionDAG &DAG) const {
  MachineFunction &MF = DAG.getMachineFunction();
  MF.getFrameInfo().setReturnAddressIsTaken(true);
  if (verifyReturnAddressArgumentIsConstant(Op, DAG))
    return SDValue();
  SDLoc DL(Op);
  if (Op.getConstantOperandVal(0) != 0) {
    SDValue Frame = lowerFrameAddr(Op, DAG);
    return DAG.getLoad(MVT::i32, DL, DAG.getEntryNode(),
                       DAG.getNode(ISD::ADD, DL, MVT::i32, Frame, DAG.getConstant(-4, DL, MVT::i32)),
                       MachinePointerInfo());
  }
  Register Reg = MF.addLiveIn(Trax::R1, &Trax::GPRRegClass);
  return DAG.getCopyFromReg(DAG.getEntryNode(), DL, Reg, MVT::i32);
}
