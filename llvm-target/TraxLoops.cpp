//===- TraxLoops.cpp - Addresses and loads of outer loops -----------------===//
//
// After LLVM's strength reduction, which changes innermost loops only:
//
// - If a loop around others computes an address from its counter in each iteration, a pointer steps instead. Starts and
//   ends of the inner loops are such addresses, too.
// - A counter that only ends the loop is compared after its increment, which needs no second register.
// - A load leaves a loop whose stores go to addresses beyond it: a[i][i] while a[j][i] is stored for j > i.
//
//===----------------------------------------------------------------------===//
#include "Trax.h"
#include "llvm/ADT/SmallPtrSet.h"
#include "llvm/Analysis/AliasAnalysis.h"
#include "llvm/Analysis/LoopInfo.h"
#include "llvm/Analysis/MemoryLocation.h"
#include "llvm/Analysis/MustExecute.h"
#include "llvm/Analysis/ScalarEvolution.h"
#include "llvm/Analysis/ScalarEvolutionExpressions.h"
#include "llvm/IR/Dominators.h"
#include "llvm/IR/GetElementPtrTypeIterator.h"
#include "llvm/IR/IRBuilder.h"
#include "llvm/IR/PatternMatch.h"
#include "llvm/InitializePasses.h"
#include "llvm/Pass.h"
#include "llvm/Transforms/Utils/BasicBlockUtils.h"
#include "llvm/Transforms/Utils/Local.h"
#include "llvm/Transforms/Utils/ScalarEvolutionExpander.h"

using namespace llvm;
using namespace llvm::PatternMatch;

#define DEBUG_TYPE "trax-loops"

namespace {

class TraxLoops : public FunctionPass {
  LoopInfo *LI;
  ScalarEvolution *SE;
  DominatorTree *DT;
  AAResults *AA;

  const SCEVAddRecExpr *steppingAddress(const SCEV *Address, const Loop *L = nullptr);
  bool isComputedFromCounter(Instruction &I, const Loop &L);
  unsigned costOf(Instruction &I, const Loop &L, SmallPtrSetImpl<Instruction *> &Seen);
  Value *expand(const SCEV *Address, Instruction *Place, SCEVExpander &Expander);
  bool stepAddresses(Loop &L);
  bool compareIncremented(Loop &L);
  bool isBeyond(const StoreInst &Store, const LoadInst &Load, const Loop &L);
  bool hoistLoads(Loop &L);

public:
  static char ID;
  TraxLoops() : FunctionPass(ID) {}

  StringRef getPassName() const override { return "TRaX outer loops"; }
  void getAnalysisUsage(AnalysisUsage &AU) const override {
    AU.addRequired<AAResultsWrapperPass>();
    AU.addRequired<DominatorTreeWrapperPass>();
    AU.addRequired<LoopInfoWrapperPass>();
    AU.addRequired<ScalarEvolutionWrapperPass>();
    AU.setPreservesCFG();
  }
  bool runOnFunction(Function &F) override;
};

} // namespace

// --- addresses ---------------------------------------------------------------

/// Returns the address as a start and a constant step of loop L, or of any loop if L is null; null if it is no such
/// sum.
const SCEVAddRecExpr *TraxLoops::steppingAddress(const SCEV *Address, const Loop *L) {
  const auto *Recurrence = dyn_cast<SCEVAddRecExpr>(Address);
  return Recurrence && Recurrence->getType()->isPointerTy() && (!L || Recurrence->getLoop() == L) &&
                 Recurrence->isAffine() && isa<SCEVConstant>(Recurrence->getStepRecurrence(*SE))
             ? Recurrence
             : nullptr;
}

/// Whether each iteration of this loop, but not of one within it, computes I. A counter's own step does not count.
bool TraxLoops::isComputedFromCounter(Instruction &I, const Loop &L) {
  if (!isa<GetElementPtrInst, BinaryOperator, CastInst>(I) || LI->getLoopFor(I.getParent()) != &L ||
      !SE->isSCEVable(I.getType()) || SE->isLoopInvariant(SE->getSCEV(&I), &L))
    return false;
  return none_of(I.users(), [&](User *U) { return isa<PHINode>(U) && cast<PHINode>(U)->getParent() == L.getHeader(); });
}

/// The instructions that compute the value in an iteration.
unsigned TraxLoops::costOf(Instruction &I, const Loop &L, SmallPtrSetImpl<Instruction *> &Seen) {
  if (!Seen.insert(&I).second || !isComputedFromCounter(I, L))
    return 0;
  unsigned Cost = isa<BinaryOperator>(I);
  if (const auto *GEP = dyn_cast<GetElementPtrInst>(&I))
    for (auto Type = gep_type_begin(GEP), End = gep_type_end(GEP); Type != End; ++Type)
      if (!isa<Constant>(Type.getOperand()))
        Cost += Type.getSequentialElementStride(I.getDataLayout()) == 1 ? 1 : 2;
  for (Value *Operand : I.operands())
    if (auto *From = dyn_cast<Instruction>(Operand))
      Cost += costOf(*From, L, Seen);
  return Cost;
}

/// The address where an instruction is: a pointer of the loop that steps in the same way, with an offset; a new one if
/// there is none.
Value *TraxLoops::expand(const SCEV *Address, Instruction *Place, SCEVExpander &Expander) {
  const SCEVAddRecExpr *Recurrence = steppingAddress(Address);
  if (!Recurrence)
    return Expander.expandCodeFor(Address, Address->getType(), Place);
  const Loop *L = Recurrence->getLoop();
  for (PHINode &Phi : L->getHeader()->phis()) {
    if (!Phi.getType()->isPointerTy() || !SE->isSCEVable(Phi.getType()))
      continue;
    if (const auto *Offset = dyn_cast<SCEVConstant>(SE->getMinusSCEV(Address, SE->getSCEV(&Phi)))) {
      IRBuilder<> Builder(Place);
      return Offset->isZero() ? &Phi : Builder.CreatePtrAdd(&Phi, Offset->getValue());
    }
  }
  Value *Start = expand(Recurrence->getStart(), L->getLoopPreheader()->getTerminator(), Expander);
  const auto *Step = cast<SCEVConstant>(Recurrence->getStepRecurrence(*SE));
  IRBuilder<> Builder(L->getHeader(), L->getHeader()->begin());
  PHINode *Phi = Builder.CreatePHI(Address->getType(), 2, "address");
  Builder.SetInsertPoint(L->getLoopLatch()->getTerminator());
  Phi->addIncoming(Start, L->getLoopPreheader());
  Phi->addIncoming(Builder.CreatePtrAdd(Phi, Step->getValue()), L->getLoopLatch());
  return Phi;
}

bool TraxLoops::stepAddresses(Loop &L) {
  SCEVExpander Expander(*SE, L.getHeader()->getDataLayout(), "step");
  SmallVector<WeakTrackingVH, 8> Replaced;
  for (BasicBlock *Block : L.blocks()) {
    if (LI->getLoopFor(Block) != &L || !DT->dominates(Block, L.getLoopLatch()))
      continue;
    for (Instruction &I : *Block) {
      SmallPtrSet<Instruction *, 8> Seen;
      if (!I.getType()->isPointerTy() || costOf(I, L, Seen) < 2)
        continue;
      const SCEVAddRecExpr *Address = steppingAddress(SE->getSCEV(&I), &L);
      bool CanExpand = Address != nullptr; // all the loops around have a place for a start and a step
      for (const SCEV *Start = Address; CanExpand;) {
        const SCEVAddRecExpr *Recurrence = steppingAddress(Start);
        if (!Recurrence) {
          CanExpand = Expander.isSafeToExpand(Start);
          break;
        }
        CanExpand = Recurrence->getLoop()->isLoopSimplifyForm();
        Start = Recurrence->getStart();
      }
      if (!CanExpand)
        continue;
      I.replaceAllUsesWith(expand(Address, &I, Expander));
      Replaced.push_back(&I);
    }
  }
  const bool Changed = !Replaced.empty();
  RecursivelyDeleteTriviallyDeadInstructionsPermissive(Replaced);
  return Changed;
}

// --- counters ----------------------------------------------------------------

/// i != n is i + 1 != n + 1, with overflow too.
bool TraxLoops::compareIncremented(Loop &L) {
  auto *Branch = dyn_cast<BranchInst>(L.getLoopLatch()->getTerminator());
  ICmpInst::Predicate Predicate;
  Value *Counter, *End, *Step;
  if (!Branch || !Branch->isConditional() ||
      !match(Branch->getCondition(), m_OneUse(m_ICmp(Predicate, m_Value(Counter), m_Value(End)))) ||
      !ICmpInst::isEquality(Predicate) || !Counter->getType()->isIntegerTy(32) || !L.isLoopInvariant(End))
    return false;
  auto *Phi = dyn_cast<PHINode>(Counter);
  if (!Phi || Phi->getParent() != L.getHeader())
    return false;
  auto *Next = dyn_cast<Instruction>(Phi->getIncomingValueForBlock(L.getLoopLatch()));
  if (!Next || !match(Next, m_Add(m_Specific(Phi), m_Value(Step))) || !isa<ConstantInt>(Step))
    return false;
  const Loop *Outermost = &L;
  for (const Loop *Outer = L.getParentLoop(); Outer && Outer->isLoopInvariant(End) && Outer->getLoopPreheader();
       Outer = Outer->getParentLoop())
    Outermost = Outer;
  Next->dropPoisonGeneratingFlags();
  auto *Compare = cast<ICmpInst>(Branch->getCondition());
  IRBuilder<> Builder(Outermost->getLoopPreheader()->getTerminator());
  Value *NextEnd = Builder.CreateAdd(End, Step);
  Builder.SetInsertPoint(Branch);
  Branch->setCondition(Builder.CreateICmp(Predicate, Next, NextEnd));
  SE->forgetLoop(&L);
  Compare->eraseFromParent();
  return true;
}

// --- loads -------------------------------------------------------------------

/// Whether the store of each iteration is after the load's word, or before it, and moves away from it. The store cannot
/// wrap around the address space: it would leave the object first.
bool TraxLoops::isBeyond(const StoreInst &Store, const LoadInst &Load, const Loop &L) {
  if (!DT->dominates(Store.getParent(), L.getLoopLatch()))
    return false;
  const SCEV *To = SE->getSCEV(const_cast<Value *>(Store.getPointerOperand()));
  const SCEV *From = SE->getSCEV(const_cast<Value *>(Load.getPointerOperand()));
  if (SE->getPointerBase(To) != SE->getPointerBase(From))
    return false;
  const auto *Distance = dyn_cast<SCEVAddRecExpr>(SE->getMinusSCEV(To, From));
  if (!Distance || Distance->getLoop() != &L || !Distance->isAffine())
    return false;
  const auto *Start = dyn_cast<SCEVConstant>(Distance->getStart());
  const auto *Step = dyn_cast<SCEVConstant>(Distance->getStepRecurrence(*SE));
  if (!Start || !Step)
    return false;
  const DataLayout &DL = Load.getDataLayout();
  const APInt &First = Start->getAPInt(), &Further = Step->getAPInt();
  return Further.isNonNegative() ? First.sge(DL.getTypeStoreSize(Load.getType()).getFixedValue())
                                 : First.sle(-int64_t(DL.getTypeStoreSize(Store.getValueOperand()->getType())));
}

bool TraxLoops::hoistLoads(Loop &L) {
  SmallVector<StoreInst *, 8> Stores;
  SmallVector<LoadInst *, 8> Loads;
  for (BasicBlock *Block : L.blocks())
    for (Instruction &I : *Block) {
      if (auto *Store = dyn_cast<StoreInst>(&I); Store && Store->isSimple())
        Stores.push_back(Store);
      else if (I.mayWriteToMemory() || I.mayThrow())
        return false;
      if (auto *Load = dyn_cast<LoadInst>(&I);
          Load && Load->isSimple() && LI->getLoopFor(Block) == &L && L.isLoopInvariant(Load->getPointerOperand()))
        Loads.push_back(Load);
    }
  SimpleLoopSafetyInfo Safety;
  Safety.computeLoopSafetyInfo(&L);
  bool Changed = false;
  for (LoadInst *Load : Loads)
    if (Safety.isGuaranteedToExecute(*Load, DT, &L) && all_of(Stores, [&](StoreInst *Store) {
          return AA->isNoAlias(MemoryLocation::get(Store), MemoryLocation::get(Load)) || isBeyond(*Store, *Load, L);
        })) {
      Load->moveBefore(L.getLoopPreheader()->getTerminator());
      Changed = true;
    }
  return Changed;
}

bool TraxLoops::runOnFunction(Function &F) {
  if (skipFunction(F) || F.hasOptSize())
    return false;
  LI = &getAnalysis<LoopInfoWrapperPass>().getLoopInfo();
  SE = &getAnalysis<ScalarEvolutionWrapperPass>().getSE();
  DT = &getAnalysis<DominatorTreeWrapperPass>().getDomTree();
  AA = &getAnalysis<AAResultsWrapperPass>().getAAResults();
  bool Changed = false;
  SmallVector<Loop *, 4> Loops = LI->getLoopsInPreorder();
  for (Loop *L : reverse(Loops)) { // an inner loop's starts are addresses of the loop around it
    if (!L->isLoopSimplifyForm())
      continue;
    if (!L->isInnermost()) {
      Changed |= stepAddresses(*L);
      for (BasicBlock *Block : L->blocks())
        if (LI->isLoopHeader(Block))
          Changed |= DeleteDeadPHIs(Block);
      Changed |= compareIncremented(*L);
    }
    Changed |= hoistLoads(*L);
  }
  return Changed;
}

char TraxLoops::ID = 0;

INITIALIZE_PASS_BEGIN(TraxLoops, DEBUG_TYPE, "TRaX outer loops", false, false)
INITIALIZE_PASS_DEPENDENCY(AAResultsWrapperPass)
INITIALIZE_PASS_DEPENDENCY(DominatorTreeWrapperPass)
INITIALIZE_PASS_DEPENDENCY(LoopInfoWrapperPass)
INITIALIZE_PASS_DEPENDENCY(ScalarEvolutionWrapperPass)
INITIALIZE_PASS_END(TraxLoops, DEBUG_TYPE, "TRaX outer loops", false, false)

FunctionPass *llvm::createTraxLoopsPass() {
  return new TraxLoops();
}
