//===- TraxTargetTransformInfo.cpp - Costs, for the IR optimizer ---------===//
#include "TraxTargetTransformInfo.h"
#include "TraxBuiltins.h"
#include "llvm/Analysis/LoopInfo.h"
#include "llvm/Analysis/ScalarEvolutionExpressions.h"
#include "llvm/IR/Function.h"
#include "llvm/IR/InstrTypes.h"
#include "llvm/Support/MathExtras.h"

using namespace llvm;

using TTI = TargetTransformInfo;

bool TraxTTIImpl::isLoweredToCall(const Function *F) const {
  if (F->hasName() && TraxBuiltin::find(F->getName()))
    return false;
  return BaseT::isLoweredToCall(F);
}

/// Whether a value takes a step with each round of a loop.
static bool advancesIn(const Loop &L, const SCEV *Value) {
  return SCEVExprContains(Value, [&](const SCEV *Part) {
    const auto *Recurrence = dyn_cast<SCEVAddRecExpr>(Part);
    return Recurrence && Recurrence->getLoop() == &L;
  });
}

/// Of the loads in the only, innermost loop in this one: how many vary with this one for each that does not; 0 if none
/// is of the latter kind. Copies of the inner loop, run as one, load these once.
static unsigned loadsPerSharedLoad(const Loop &Outer, ScalarEvolution &SE) {
  if (Outer.getSubLoops().size() != 1 || Outer.getSubLoops().front()->getNumBlocks() != 1)
    return 0;
  SmallPtrSet<const SCEV *, 8> Shared, Varying; // copies load from the same address until they are merged
  for (Instruction &I : *Outer.getSubLoops().front()->getHeader())
    if (auto *Load = dyn_cast<LoadInst>(&I)) {
      const SCEV *Address = SE.getSCEV(Load->getPointerOperand());
      (advancesIn(Outer, Address) ? Varying : Shared).insert(Address);
    }
  return Shared.empty() ? 0 : Varying.size() / Shared.size();
}

// The instruction cache holds 1,024 instructions, shared by all. At -O2 unrolling must pay by turning a small array's
// indices into constants, or be of a loop of a few instructions, which it saves most of its counting. At -O3 an
// innermost loop may be longer, and be copied more often where the number of its rounds is known; a loop around it may
// save some of its loads.
void TraxTTIImpl::getUnrollingPreferences(Loop *L, ScalarEvolution &SE, TTI::UnrollingPreferences &UP,
                                          OptimizationRemarkEmitter *ORE) {
  // The unroller comes with a larger threshold at -O3; nothing else tells the level.
  bool Aggressive = UP.Threshold > 150;
  BaseT::getUnrollingPreferences(L, SE, UP, ORE);
  UP.Threshold = Aggressive ? 350 : 120;
  UP.PartialThreshold = 0;
  UP.OptSizeThreshold = 0;
  UP.PartialOptSizeThreshold = 0;
  UP.Partial = false;
  UP.Runtime = false;
  UP.UpperBound = false;
  if (L->getNumBlocks() > (Aggressive ? 4 : 1) || L->getHeader()->getParent()->hasOptSize())
    return;
  const unsigned EnoughPerSharedLoad = 4;
  unsigned PerSharedLoad = Aggressive ? loadsPerSharedLoad(*L, SE) : 0;
  UP.UnrollAndJam = PerSharedLoad != 0 && PerSharedLoad < EnoughPerSharedLoad;
  // Before the loop around it is copied: leave room. Afterwards: the copies count once again.
  bool IsJammed = false;
  if (const Loop *Parent = L->getParentLoop(); Aggressive && L->isInnermost() && Parent)
    if (unsigned OfParent = loadsPerSharedLoad(*Parent, SE)) {
      UP.Threshold = 80;
      IsJammed = OfParent >= EnoughPerSharedLoad;
    }
  if (!UP.UnrollAndJam && !L->isInnermost())
    return;
  SmallVector<BasicBlock *, 4> Exiting;
  L->getExitingBlocks(Exiting);
  if (Exiting.size() > 2)
    return;
  InstructionCost Cost = 0;
  bool AccessesMemory = false, StepsThroughArray = false;
  for (const BasicBlock *Block : L->blocks())
    for (const Instruction &I : *Block) {
      if (const auto *Call = dyn_cast<CallBase>(&I))
        if (const Function *Callee = Call->getCalledFunction(); !Callee || isLoweredToCall(Callee))
          return;
      AccessesMemory |= I.mayReadOrWriteMemory();
      if (const Value *Pointer = getLoadStorePointerOperand(&I))
        StepsThroughArray |= advancesIn(*L, SE.getSCEV(const_cast<Value *>(Pointer)));
      Cost += getInstructionCost(&I, SmallVector<const Value *, 4>(I.operand_values()), TTI::TCK_SizeAndLatency);
    }
  // Copies of a search have all its tests. Before copies of another loop, a dozen instructions compute how many rounds
  // are left over: a long loop does not make up for them in a few rounds, nor does one that steps through no array. One
  // that only computes does, since copies save moves. A search through arrays with a second end, as in the comparison
  // of two strings, usually ends early.
  const int LongestUncounted = 12;
  const bool IsCounted = SE.getSmallConstantTripCount(L) != 0;
  const bool Searches =
      any_of(Exiting, [&](BasicBlock *Block) { return isa<SCEVCouldNotCompute>(SE.getExitCount(L, Block)); });
  if (Aggressive && !IsCounted && !IsJammed && !UP.UnrollAndJam && AccessesMemory &&
      (Cost > LongestUncounted || !(StepsThroughArray || Searches)))
    return;
  const bool IsShortSearch = Searches && StepsThroughArray && Exiting.size() == 2;
  UP.PartialThreshold = !Aggressive ? 40 : UP.UnrollAndJam ? 160 : IsJammed || IsCounted ? 240 : 80;
  UP.UnrollAndJamInnerLoopThreshold = 100;
  UP.MaxCount = UP.DefaultUnrollRuntimeCount = !Aggressive ? 4 : IsShortSearch ? 2 : 8;
  UP.Partial = UP.Runtime = true;
  UP.Force = L->isInnermost() && Cost < 12;
}

void TraxTTIImpl::getPeelingPreferences(Loop *L, ScalarEvolution &SE, TTI::PeelingPreferences &PP) {
  BaseT::getPeelingPreferences(L, SE, PP);
}

// Instructions first: 27 registers are rarely short, and every instruction takes an issue slot. A sum of two registers
// takes one more while it is an address, so pointers of their own win over a base and an offset.
bool TraxTTIImpl::isLSRCostLess(const TTI::LSRCost &A, const TTI::LSRCost &B) const {
  auto Key = [](const TTI::LSRCost &C) {
    return std::make_tuple(C.Insns, C.NumRegs + (C.NumBaseAdds != 0), C.AddRecCost, C.NumIVMuls, C.NumBaseAdds,
                           C.ScaleCost, C.ImmCost, C.SetupCost);
  };
  return Key(A) < Key(B);
}

InstructionCost TraxTTIImpl::getIntImmCost(const APInt &Imm, Type *Ty, TTI::TargetCostKind) {
  if (Imm == 0)
    return TTI::TCC_Free;
  unsigned Instructions = 0;
  APInt Value = Imm.sext(alignTo(std::max(Imm.getBitWidth(), Ty->getIntegerBitWidth()), 32));
  for (unsigned Bit = 0; Bit < Value.getBitWidth(); Bit += 32) {
    int64_t Word = Value.extractBits(32, Bit).getSExtValue();
    Instructions += Word == 0 ? 0 : isInt<16>(Word) || (Word & 0xFFFF) == 0 ? 1 : 2;
  }
  return std::max(1u, Instructions) * TTI::TCC_Basic;
}

InstructionCost TraxTTIImpl::getIntImmCostInst(unsigned Opcode, unsigned Idx, const APInt &Imm, Type *Ty,
                                               TTI::TargetCostKind CostKind, Instruction *Inst) {
  bool Fits = Imm.getSignificantBits() <= 16;
  bool Encoded = false;
  switch (Opcode) {
  case Instruction::GetElementPtr: // split and folded by other passes
    return TTI::TCC_Free;
  case Instruction::And:
    Encoded = Fits || Imm.isMask();
    break;
  case Instruction::Add:
  case Instruction::Or:
  case Instruction::Xor:
    Encoded = Fits;
    break;
  case Instruction::ICmp: // whether a word is less than a power of two is a shift
    Encoded = Fits || (isa_and_nonnull<ICmpInst>(Inst) && cast<ICmpInst>(Inst)->isUnsigned() &&
                       (Imm.isPowerOf2() || (Imm + 1).isPowerOf2()));
    break;
  case Instruction::Sub:
    Encoded = Idx == 1 && (-Imm).getSignificantBits() <= 16;
    break;
  case Instruction::Shl:
  case Instruction::LShr:
  case Instruction::AShr:
    Encoded = Idx == 1;
    break;
  case Instruction::Mul: // shifts and adds, perhaps
    Encoded = Idx == 1 && (Imm.isPowerOf2() || Imm.isNegatedPowerOf2());
    break;
  case Instruction::Store:
    break;
  default: // a constant elsewhere is not worth hoisting
    return TTI::TCC_Free;
  }
  return Encoded && Idx <= 1 ? InstructionCost(TTI::TCC_Free) : getIntImmCost(Imm, Ty, CostKind);
}

InstructionCost TraxTTIImpl::getIntImmCostIntrin(Intrinsic::ID, unsigned, const APInt &, Type *, TTI::TargetCostKind) {
  return TTI::TCC_Free;
}
