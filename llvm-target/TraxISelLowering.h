//===- TraxISelLowering.h - Operations that the machine has or lacks -----===//
#ifndef TRAX_TRAXISELLOWERING_H
#define TRAX_TRAXISELLOWERING_H

#include "llvm/CodeGen/SelectionDAG.h"
#include "llvm/CodeGen/TargetLowering.h"

namespace llvm {

class TraxSubtarget;

namespace TraxISD {
enum NodeType : unsigned {
  FIRST_NUMBER = ISD::BUILTIN_OP_END,
  CALL,
  TAIL,
  RET,
  HI,         // upper half of a symbol's address, in place
  ADD_LO,     // sum of that and the lower half
  ABS_ADDR,   // a thread-local symbol's address, which fits an immediate
  RSQRT,      // reciprocal square root
  OPAQUE,     // the operand, hidden
  RDSR_CONST, // special register that does not change
  RDSR,       // any special register; chained
  TRAP,
  HALT,
  COPY_LOOP, // of a long argument
  SETJMP,    // __builtin_setjmp: 0, and 1 when it is jumped to
  LONGJMP,   // __builtin_longjmp
  FENCE,     // its kind; chained
  WAIT,      // until a value has arrived; chained
  GROUPS,    // an instruction on groups of registers: its opcode, rd's old value, the groups' values
  FIRST_MEMORY = ISD::FIRST_TARGET_MEMORY_OPCODE,
  AINC, // atomic increment; the value before it
  LWNT, // atomic load of a word, past the cache
};
} // namespace TraxISD

class TraxTargetLowering : public TargetLowering {
  const TraxSubtarget &Subtarget;

public:
  TraxTargetLowering(const TargetMachine &TM, const TraxSubtarget &STI);

  const char *getTargetNodeName(unsigned Opcode) const override;
  EVT getSetCCResultType(const DataLayout &, LLVMContext &, EVT VT) const override {
    return VT.isVector() ? VT.changeVectorElementTypeToInteger() : EVT(MVT::i32);
  }
  MVT getScalarShiftAmountTy(const DataLayout &, EVT) const override { return MVT::i32; }
  SDValue LowerOperation(SDValue Op, SelectionDAG &DAG) const override;
  void ReplaceNodeResults(SDNode *N, SmallVectorImpl<SDValue> &Results, SelectionDAG &DAG) const override;
  MachineBasicBlock *EmitInstrWithCustomInserter(MachineInstr &MI, MachineBasicBlock *MBB) const override;
  SDValue PerformDAGCombine(SDNode *N, DAGCombinerInfo &DCI) const override;

  // Addresses and immediates.
  bool isLegalAddressingMode(const DataLayout &DL, const AddrMode &AM, Type *Ty, unsigned AS,
                             Instruction *I = nullptr) const override;
  bool isLegalICmpImmediate(int64_t Imm) const override { return isInt<16>(Imm); }
  bool isLegalAddImmediate(int64_t Imm) const override { return isInt<16>(Imm); }
  bool isOffsetFoldingLegal(const GlobalAddressSDNode *) const override { return false; } // see performAddCombine
  bool isFPImmLegal(const APFloat &, EVT VT, bool) const override { return VT == MVT::f32; }
  bool shouldConvertConstantLoadToIntImm(const APInt &, Type *) const override { return true; }

  // Costs.
  bool convertSelectOfConstantsToMath(EVT VT) const override { return VT == MVT::i32; }
  ShiftLegalizationStrategy preferredShiftLegalizationStrategy(SelectionDAG &DAG, SDNode *N,
                                                               unsigned ExpansionFactor) const override;
  bool isTruncateFree(Type *From, Type *To) const override;
  bool isTruncateFree(EVT From, EVT To) const override;
  bool isZExtFree(SDValue Value, EVT To) const override;
  bool isFMAFasterThanFMulAndFAdd(const MachineFunction &, EVT) const override { return false; }
  bool softPromoteHalfType() const override { return true; }
  bool convertSetCCLogicToBitwiseLogic(EVT VT) const override { return VT.isScalarInteger(); }
  bool hasAndNotCompare(SDValue) const override { return false; }
  bool shouldExpandBuildVectorWithShuffles(EVT, unsigned) const override { return false; }
  bool shouldNormalizeToSelectSequence(LLVMContext &, EVT) const override { return false; }
  bool isSExtCheaperThanZExt(EVT From, EVT) const override { return From == MVT::i16; }
  MachineMemOperand::Flags getTargetMMOFlags(const Instruction &) const override { return MachineMemOperand::MONone; }

  // Square roots under fast-math.
  SDValue getSqrtEstimate(SDValue Operand, SelectionDAG &DAG, int Enabled, int &RefinementSteps, bool &UseOneConstNR,
                          bool Reciprocal) const override;
  SDValue getSqrtInputTest(SDValue Operand, SelectionDAG &DAG, const DenormalMode &Mode) const override;
  SDValue getSqrtResultForDenormInput(SDValue Operand, SelectionDAG &DAG) const override;

  // Atomics.
  bool shouldInsertFencesForAtomic(const Instruction *) const override { return false; }
  AtomicExpansionKind shouldExpandAtomicRMWInIR(AtomicRMWInst *RMW) const override;

  // Inline assembly.
  ConstraintType getConstraintType(StringRef Constraint) const override;
  std::pair<unsigned, const TargetRegisterClass *>
  getRegForInlineAsmConstraint(const TargetRegisterInfo *TRI, StringRef Constraint, MVT VT) const override;
  void LowerAsmOperandForConstraint(SDValue Op, StringRef Constraint, std::vector<SDValue> &Ops,
                                    SelectionDAG &DAG) const override;
  Register getRegisterByName(const char *Name, LLT Ty, const MachineFunction &MF) const override;

  // Calls: TraxCallLowering.cpp.
  bool CanLowerReturn(CallingConv::ID CC, MachineFunction &MF, bool IsVarArg,
                      const SmallVectorImpl<ISD::OutputArg> &Outs, LLVMContext &Context) const override;
  SDValue LowerFormalArguments(SDValue Chain, CallingConv::ID CC, bool IsVarArg,
                               const SmallVectorImpl<ISD::InputArg> &Ins, const SDLoc &DL, SelectionDAG &DAG,
                               SmallVectorImpl<SDValue> &InVals) const override;
  SDValue LowerReturn(SDValue Chain, CallingConv::ID CC, bool IsVarArg, const SmallVectorImpl<ISD::OutputArg> &Outs,
                      const SmallVectorImpl<SDValue> &OutVals, const SDLoc &DL, SelectionDAG &DAG) const override;
  SDValue LowerCall(CallLoweringInfo &CLI, SmallVectorImpl<SDValue> &InVals) const override;
  bool mayBeEmittedAsTailCall(const CallInst *CI) const override { return CI->isTailCall(); }

private:
  SDValue lowerBuiltinCall(CallLoweringInfo &CLI, SmallVectorImpl<SDValue> &InVals) const;
  bool isTailCallPossible(const CallLoweringInfo &CLI, const CCState &Info) const;

  template <class NodeTy> SDValue lowerAddress(NodeTy *N, SelectionDAG &DAG) const;
  SDValue lowerGlobalAddress(SDValue Op, SelectionDAG &DAG) const;
  SDValue lowerFPToIntSat(SDValue Op, SelectionDAG &DAG) const;
  SDValue lowerVAStart(SDValue Op, SelectionDAG &DAG) const;
  SDValue lowerFrameAddr(SDValue Op, SelectionDAG &DAG) const;
  SDValue lowerReturnAddr(SDValue Op, SelectionDAG &DAG) const;
  SDValue lowerSetJmp(SDValue Op, SelectionDAG &DAG) const;
  SDValue lowerLongJmp(SDValue Op, SelectionDAG &DAG) const;
  MachineBasicBlock *emitCopyLoop(MachineInstr &MI, MachineBasicBlock *This) const;
  MachineBasicBlock *emitSetJmp(MachineInstr &MI, MachineBasicBlock *This) const;
  SDValue lowerAtomicFence(SDValue Op, SelectionDAG &DAG) const;
  SDValue lowerAtomicLoad(SDValue Op, SelectionDAG &DAG) const;
  SDValue lowerAtomicRMW(SDValue Op, SelectionDAG &DAG) const;
  SDValue performAddCombine(SDNode *N, DAGCombinerInfo &DCI) const;
  SDValue performSelectCombine(SDNode *N, DAGCombinerInfo &DCI) const;
  SDValue performUnalignedCombine(SDNode *N, DAGCombinerInfo &DCI) const;
};

} // namespace llvm

#endif
