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

/// Whether a value changes by a step in each iteration of the loop.
static bool advancesIn(const Loop &L, const SCEV *Value) {
  return SCEVExprContains(Value, [&](const SCEV *Part) {
    const auto *Recurrence = dyn_cast<SCEVAddRecExpr>(Part);
    return Recurrence && Recurrence->getLoop() == &L;
  });
}

/// Whether a value changes in each iteration of a loop around this one.
static bool advancesOutside(const Loop &L, const SCEV *Value) {
  for (const Loop *Outer = L.getParentLoop(); Outer; Outer = Outer->getParentLoop())
    if (advancesIn(*Outer, Value))
      return true;
  return false;
}

/// The limits of unrolling. Sizes count instructions, as getInstructionCost does. The instruction cache holds 1,024
/// instructions, shared by all threads.
struct UnrollingLimits {
  int FullSize;   ///< of a loop that is replaced by its iterations
  int CopiesSize; ///< of all copies of a loop together
  int Copies;     ///< of a loop
  int Blocks;     ///< of a loop that is copied
};

// At -O2 unrolling must turn a small array's indices into constants, or save most of the counting of a short loop.
constexpr UnrollingLimits UnrollingO2 = {/*FullSize=*/120, /*CopiesSize=*/40, /*Copies=*/4, /*Blocks=*/1};
constexpr UnrollingLimits UnrollingO3 = {/*FullSize=*/350, /*CopiesSize=*/80, /*Copies=*/8, /*Blocks=*/4};

constexpr int MostExits = 2;     // copies of a search have all its tests
constexpr int AlwaysCopied = 11; // size of a loop that is copied although it is not known to pay
constexpr int DivisionSize = 24; // of a division that TraxDivision writes out

// The following limits hold at -O3.
constexpr int CountedCopiesSize = 240; // if the number of iterations is known, or the outer loop was copied first
constexpr int SearchCopies = 2;        // of a search through arrays with two exits, which usually ends early
constexpr int LongestUncounted = 12;   // size of a loop that pays for computing the number of iterations left over
constexpr int JammedCopiesSize = 160;  // unroll-and-jam: of the outer loop, of the inner loop
constexpr int JammedInnerSize = 100;
constexpr int FullSizeBeforeJam = 80;
constexpr int EnoughLoadsPerShared = 4; // with more varying loads for each shared one, jamming saves too little

/// The loads of the only loop in this one, if that is innermost: how many vary with the outer loop for each one that
/// does not; 0 if all vary. Unroll-and-jam executes those that do not vary once for all copies.
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

namespace {
/// The properties of a loop's body that decide about copies.
struct LoopBody {
  InstructionCost Size = 0;
  bool Calls = false, AccessesMemory = false, StepsThroughArray = false;
};
} // namespace

static LoopBody inspectBody(const Loop &L, ScalarEvolution &SE, TraxTTIImpl &Costs) {
  LoopBody Body;
  for (const BasicBlock *Block : L.blocks())
    for (const Instruction &I : *Block) {
      if (const auto *Call = dyn_cast<CallBase>(&I))
        Body.Calls |= !Call->getCalledFunction() || Costs.isLoweredToCall(Call->getCalledFunction());
      Body.AccessesMemory |= I.mayReadOrWriteMemory();
      if (const Value *Pointer = getLoadStorePointerOperand(&I))
        Body.StepsThroughArray |= advancesIn(L, SE.getSCEV(const_cast<Value *>(Pointer)));
      Body.Size +=
          Costs.getInstructionCost(&I, SmallVector<const Value *, 4>(I.operand_values()), TTI::TCK_SizeAndLatency);
    }
  return Body;
}

void TraxTTIImpl::getUnrollingPreferences(Loop *L, ScalarEvolution &SE, TTI::UnrollingPreferences &UP,
                                          OptimizationRemarkEmitter *ORE) {
  const bool IsO3 = UP.Threshold > 150; // the unroller's own threshold is larger at -O3; nothing else tells the level
  const UnrollingLimits &Limits = IsO3 ? UnrollingO3 : UnrollingO2;
  BaseT::getUnrollingPreferences(L, SE, UP, ORE);
  UP.Threshold = Limits.FullSize;
  UP.PartialThreshold = UP.OptSizeThreshold = UP.PartialOptSizeThreshold = 0;
  UP.Partial = UP.Runtime = UP.UpperBound = false;
  if (int(L->getNumBlocks()) > Limits.Blocks || L->getHeader()->getParent()->hasOptSize())
    return;
  const unsigned PerSharedLoad = IsO3 ? loadsPerSharedLoad(*L, SE) : 0;
  UP.UnrollAndJam = PerSharedLoad != 0 && PerSharedLoad < EnoughLoadsPerShared;
  // Unrolling runs twice: before the outer loop is copied it leaves room, and afterwards it may copy the copies.
  bool IsJammed = false;
  if (const Loop *Parent = L->getParentLoop(); IsO3 && L->isInnermost() && Parent)
    if (const unsigned OfParent = loadsPerSharedLoad(*Parent, SE)) {
      UP.Threshold = FullSizeBeforeJam;
      IsJammed = OfParent >= EnoughLoadsPerShared;
    }
  if (!UP.UnrollAndJam && !L->isInnermost())
    return;
  SmallVector<BasicBlock *, 4> Exiting;
  L->getExitingBlocks(Exiting);
  if (Exiting.size() > MostExits)
    return;
  const LoopBody Body = inspectBody(*L, SE, *this);
  if (Body.Calls)
    return;
  // About twelve instructions before the copies compute how many iterations are left over. In a few iterations a long
  // loop does not make up for them, nor does one that steps through no array. One that only computes does, because
  // copies save moves.
  const bool IsCounted = SE.getSmallConstantTripCount(L) != 0;
  const bool Searches =
      any_of(Exiting, [&](BasicBlock *Block) { return isa<SCEVCouldNotCompute>(SE.getExitCount(L, Block)); });
  if (IsO3 && !IsCounted && !IsJammed && !UP.UnrollAndJam && Body.AccessesMemory &&
      (Body.Size > LongestUncounted || !(Body.StepsThroughArray || Searches)))
    return;
  // The inner loop of a triangular nest begins with few iterations, and often never has many.
  if (!IsO3 && !IsCounted && advancesOutside(*L, SE.getBackedgeTakenCount(L)))
    return;
  const bool IsShortSearch = Searches && Body.StepsThroughArray && Exiting.size() == 2;
  UP.PartialThreshold = UP.UnrollAndJam                   ? JammedCopiesSize
                        : IsJammed || (IsO3 && IsCounted) ? CountedCopiesSize
                                                          : Limits.CopiesSize;
  UP.UnrollAndJamInnerLoopThreshold = JammedInnerSize;
  UP.MaxCount = UP.DefaultUnrollRuntimeCount = IsO3 && IsShortSearch ? SearchCopies : Limits.Copies;
  UP.Partial = UP.Runtime = true;
  UP.Force = L->isInnermost() && Body.Size <= AlwaysCopied;
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

InstructionCost TraxTTIImpl::getArithmeticInstrCost(unsigned Opcode, Type *Ty, TTI::TargetCostKind CostKind,
                                                    TTI::OperandValueInfo X, TTI::OperandValueInfo Y,
                                                    ArrayRef<const Value *> Args, const Instruction *Context) {
  if (Instruction::isIntDivRem(Opcode) && Ty->isIntegerTy() && Ty->getIntegerBitWidth() <= 32 && !Y.isConstant())
    return DivisionSize * TTI::TCC_Basic;
  return BaseT::getArithmeticInstrCost(Opcode, Ty, CostKind, X, Y, Args, Context);
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
