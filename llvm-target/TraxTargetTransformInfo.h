//===- TraxTargetTransformInfo.h - Costs, for the IR optimizer -----------===//
#ifndef TRAX_TRAXTARGETTRANSFORMINFO_H
#define TRAX_TRAXTARGETTRANSFORMINFO_H

#include "TraxTargetMachine.h"
#include "llvm/Analysis/TargetTransformInfo.h"
#include "llvm/CodeGen/BasicTTIImpl.h"

namespace llvm {

class TraxTTIImpl : public BasicTTIImplBase<TraxTTIImpl> {
  using BaseT = BasicTTIImplBase<TraxTTIImpl>;
  using TTI = TargetTransformInfo;
  friend BaseT;

  const TraxSubtarget *ST;
  const TraxTargetLowering *TLI;

  const TraxSubtarget *getST() const { return ST; }
  const TraxTargetLowering *getTLI() const { return TLI; }

public:
  TraxTTIImpl(const TraxTargetMachine *TM, const Function &F)
      : BaseT(TM, F.getDataLayout()), ST(TM->getSubtargetImpl(F)), TLI(ST->getTargetLowering()) {}

  bool isLoweredToCall(const Function *F) const;
  // A call takes a jump there and back, moves, and saved registers on both sides.
  unsigned adjustInliningThreshold(const CallBase *Call) const { return Call->getFunction()->hasOptSize() ? 0 : 100; }
  void getUnrollingPreferences(Loop *L, ScalarEvolution &SE, TTI::UnrollingPreferences &UP,
                               OptimizationRemarkEmitter *ORE);
  void getPeelingPreferences(Loop *L, ScalarEvolution &SE, TTI::PeelingPreferences &PP);

  InstructionCost getArithmeticInstrCost(unsigned Opcode, Type *Ty, TTI::TargetCostKind CostKind,
                                         TTI::OperandValueInfo X = {TTI::OK_AnyValue, TTI::OP_None},
                                         TTI::OperandValueInfo Y = {TTI::OK_AnyValue, TTI::OP_None},
                                         ArrayRef<const Value *> Args = {}, const Instruction *Context = nullptr);
  // Constants: instructions to put one in a register, and none where the instruction takes it.
  InstructionCost getIntImmCost(const APInt &Imm, Type *Ty, TTI::TargetCostKind CostKind);
  InstructionCost getIntImmCostInst(unsigned Opcode, unsigned Idx, const APInt &Imm, Type *Ty,
                                    TTI::TargetCostKind CostKind, Instruction *Inst = nullptr);
  InstructionCost getIntImmCostIntrin(Intrinsic::ID IID, unsigned Idx, const APInt &Imm, Type *Ty,
                                      TTI::TargetCostKind CostKind);
  // Loops: a branch compares two registers, so an end pointer costs no more than a counter that runs to 0.
  bool isLSRCostLess(const TTI::LSRCost &A, const TTI::LSRCost &B) const;
  bool canMacroFuseCmp() const { return true; }
  bool shouldFoldTerminatingConditionAfterLSR() const { return true; }

  TTI::PopcntSupportKind getPopcntSupport(unsigned) { return TTI::PSK_Software; }

  // There are no vectors: nothing to vectorize for.
  unsigned getNumberOfRegisters(unsigned ClassID) const { return ClassID == 1 ? 0 : 27; }
  TypeSize getRegisterBitWidth(TTI::RegisterKind K) const { return TypeSize::getFixed(K == TTI::RGK_Scalar ? 32 : 0); }
  unsigned getMaxInterleaveFactor(ElementCount) const { return 1; }
};

} // namespace llvm

#endif
