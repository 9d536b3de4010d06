//===- TraxBranches.cpp - Simpler conditions of branches ------------------===//
//
// Before instruction selection, which sees one block at a time:
//
// - A branch on a comparison of double words becomes branches on comparisons of their halves. As a value, the
//   comparison of 64 bits takes up to five instructions.
// - Where a branch has found that a value equals a constant, a phi takes the value instead of the constant: it may be
//   in the phi's register already.
//
//===----------------------------------------------------------------------===//
#include "Trax.h"
#include "llvm/Analysis/ValueTracking.h"
#include "llvm/IR/IRBuilder.h"
#include "llvm/IR/Module.h"
#include "llvm/IR/PatternMatch.h"
#include "llvm/IR/ProfDataUtils.h"
#include "llvm/InitializePasses.h"
#include "llvm/Pass.h"
#include "llvm/Support/KnownBits.h"

using namespace llvm;
using namespace llvm::PatternMatch;

#define DEBUG_TYPE "trax-branches"

namespace {

class TraxBranches : public FunctionPass {
public:
  static char ID;
  TraxBranches() : FunctionPass(ID) {}

  StringRef getPassName() const override { return "TRaX branch conditions"; }
  bool runOnFunction(Function &F) override;

private:
  bool splitTree(BranchInst *Branch);
  bool splitComparison(BranchInst *Branch);
  SmallVector<BranchInst *, 16> Worklist;
};

} // namespace

/// The conditional branch of a new block.
static BranchInst *branchIn(BasicBlock *Block, Value *Condition, BasicBlock *True, BasicBlock *False) {
  return IRBuilder<>(Block).CreateCondBr(Condition, True, False);
}

static BasicBlock *blockBehind(BranchInst *Branch) {
  BasicBlock *Block = Branch->getParent();
  return BasicBlock::Create(Block->getContext(), Block->getName(), Block->getParent(), Block->getNextNode());
}

/// How often a branch is taken and not taken, if that is known.
struct Weights {
  uint64_t True = 1, False = 1;
  explicit Weights(const BranchInst &Branch) : IsKnown(extractBranchWeights(Branch, True, False)) {}
  void set(BranchInst *Branch, uint64_t IfTrue, uint64_t IfFalse) const {
    if (!IsKnown)
      return;
    const unsigned Excess = Log2_64(IfTrue | IfFalse | 1) > 31 ? Log2_64(IfTrue | IfFalse) - 31 : 0;
    setBranchWeights(*Branch, {uint32_t(IfTrue >> Excess), uint32_t(IfFalse >> Excess)}, /*IsExpected=*/false);
  }

private:
  bool IsKnown;
};

/// The phis of a block have the same values from New as from Old, or instead of those.
static void addPredecessor(BasicBlock *Block, BasicBlock *Old, BasicBlock *New, bool Instead) {
  for (PHINode &Phi : Block->phis()) {
    if (Instead)
      Phi.replaceIncomingBlockWith(Old, New);
    else
      Phi.addIncoming(Phi.getIncomingValueForBlock(Old), New);
  }
}

static bool isDoubleWordComparison(const Value *Condition, const BasicBlock *Block) {
  const auto *Compare = dyn_cast<ICmpInst>(Condition);
  if (!Compare || !Compare->hasOneUse() || Compare->getParent() != Block ||
      !Compare->getOperand(0)->getType()->isIntegerTy(64))
    return false;
  // Words that may be unaligned are compared in pieces (performUnalignedCombine).
  if (Compare->isEquality() && any_of(Compare->operands(), [](const Use &Operand) {
        const auto *Load = dyn_cast<LoadInst>(Operand);
        return Load && Load->getAlign() < 4;
      }))
    return false;
  const APInt *C;
  if (!match(Compare->getOperand(1), m_APInt(C)))
    return true;
  // Comparisons that need only one half, or both halves combined in one word.
  switch (Compare->getPredicate()) {
  case ICmpInst::ICMP_SLT:
  case ICmpInst::ICMP_SGE:
  case ICmpInst::ICMP_ULT:
  case ICmpInst::ICMP_UGE:
    return C->trunc(32) != 0;
  case ICmpInst::ICMP_SGT:
  case ICmpInst::ICMP_SLE:
  case ICmpInst::ICMP_UGT:
  case ICmpInst::ICMP_ULE:
    return !C->trunc(32).isAllOnes();
  default:
    return C->trunc(32) != 0 && C->lshr(32) != 0;
  }
}

static bool containsDoubleWordComparison(const Value *Condition, const BasicBlock *Block) {
  const Value *A, *B;
  if (Condition->hasOneUse() &&
      (match(Condition, m_LogicalAnd(m_Value(A), m_Value(B))) || match(Condition, m_LogicalOr(m_Value(A), m_Value(B)))))
    return containsDoubleWordComparison(A, Block) || containsDoubleWordComparison(B, Block);
  return isDoubleWordComparison(Condition, Block);
}

/// Moves a tree of conditions to the branch that needs them: values of one bit that live across blocks take registers.
static void moveConditions(Value *Condition, BranchInst *Branch) {
  auto *I = dyn_cast<Instruction>(Condition);
  if (!I || !I->hasOneUse() || isa<PHINode>(I) || I->getParent() == Branch->getParent())
    return;
  Value *A, *B;
  const bool IsTree = match(I, m_LogicalAnd(m_Value(A), m_Value(B))) || match(I, m_LogicalOr(m_Value(A), m_Value(B)));
  if (!IsTree && !isa<CmpInst>(I))
    return;
  if (IsTree) {
    moveConditions(A, Branch);
    moveConditions(B, Branch);
  }
  I->moveBefore(Branch);
}

/// A branch on two conditions with a comparison of double words becomes two branches.
bool TraxBranches::splitTree(BranchInst *Branch) {
  Value *Condition = Branch->getCondition(), *A, *B;
  BasicBlock *Block = Branch->getParent(), *True = Branch->getSuccessor(0), *False = Branch->getSuccessor(1);
  const bool IsAnd = match(Condition, m_LogicalAnd(m_Value(A), m_Value(B)));
  if (!IsAnd && !match(Condition, m_LogicalOr(m_Value(A), m_Value(B))))
    return false;
  const Weights Whole(*Branch);
  BasicBlock *Second = blockBehind(Branch);
  BranchInst *OnSecond = branchIn(Second, B, True, False);
  Worklist.push_back(OnSecond);
  addPredecessor(IsAnd ? True : False, Block, Second, /*Instead=*/true);
  addPredecessor(IsAnd ? False : True, Block, Second, /*Instead=*/false);
  Branch->setCondition(A);
  Branch->setSuccessor(IsAnd ? 0 : 1, Second);
  Branch->setMetadata(LLVMContext::MD_prof, nullptr);
  // If one of two conditions suffices, each of them decides in half of the cases.
  if (IsAnd) {
    Whole.set(Branch, 2 * Whole.True + Whole.False, Whole.False);
    Whole.set(OnSecond, 2 * Whole.True, Whole.False);
  } else {
    Whole.set(Branch, Whole.True, 2 * Whole.False + Whole.True);
    Whole.set(OnSecond, Whole.True, 2 * Whole.False);
  }
  Worklist.push_back(Branch);
  cast<Instruction>(Condition)->eraseFromParent();
  moveConditions(B, OnSecond);
  return true;
}

/// If the upper halves are equal, the lower ones decide.
bool TraxBranches::splitComparison(BranchInst *Branch) {
  auto *Compare = cast<ICmpInst>(Branch->getCondition());
  const DataLayout &DL = Branch->getModule()->getDataLayout();
  BasicBlock *Block = Branch->getParent(), *True = Branch->getSuccessor(0), *False = Branch->getSuccessor(1);
  IRBuilder<> Builder(Branch);
  auto Lower = [&](Value *V) {
    Value *Word;
    return match(V, m_ZExtOrSExt(m_Value(Word))) && Word->getType()->isIntegerTy(32)
               ? Word
               : Builder.CreateTrunc(V, Builder.getInt32Ty());
  };
  auto Upper = [&](Value *V) { return Builder.CreateTrunc(Builder.CreateLShr(V, 32), Builder.getInt32Ty()); };
  Value *A = Compare->getOperand(0), *B = Compare->getOperand(1);
  auto IsWord = [&](Value *V) { return computeKnownBits(V, DL).countMinLeadingZeros() >= 32; };
  const ICmpInst::Predicate Predicate = Compare->getPredicate();
  Value *UpperA = Upper(A), *UpperB = IsWord(B) ? Builder.getInt32(0) : Upper(B);
  Value *AreUpperEqual = Builder.CreateICmpEQ(UpperA, UpperB);
  Value *LowerA = Lower(A), *LowerB = Lower(B);
  BasicBlock *LowerBlock = blockBehind(Branch), *UpperBlock = nullptr;
  if (Compare->isEquality())
    UpperBlock = Predicate == ICmpInst::ICMP_EQ ? False : True;
  else if (ICmpInst::isUnsigned(Predicate) && IsWord(B)) // the upper half of A is greater than 0
    UpperBlock = ICmpInst::isLT(Predicate) || ICmpInst::isLE(Predicate) ? False : True;
  const Weights Whole(*Branch);
  BranchInst *OnUpper = branchIn(Block, AreUpperEqual, LowerBlock, UpperBlock ? UpperBlock : LowerBlock);
  OnUpper->setDebugLoc(Branch->getDebugLoc());
  Builder.SetInsertPoint(LowerBlock);
  BranchInst *OnLower =
      Builder.CreateCondBr(Builder.CreateICmp(ICmpInst::getUnsignedPredicate(Predicate), LowerA, LowerB), True, False);
  if (!UpperBlock) {
    UpperBlock = blockBehind(Branch);
    OnUpper->setSuccessor(1, UpperBlock);
    Builder.SetInsertPoint(UpperBlock);
    BranchInst *OnUnequal = Builder.CreateCondBr(Builder.CreateICmp(Predicate, UpperA, UpperB), True, False);
    Whole.set(OnLower, Whole.True, Whole.False);
    Whole.set(OnUnequal, Whole.True, Whole.False);
    for (BasicBlock *Successor : {True, False}) {
      addPredecessor(Successor, Block, LowerBlock, /*Instead=*/false);
      addPredecessor(Successor, Block, UpperBlock, /*Instead=*/true);
    }
  } else {
    // The upper halves decide half of what either half can.
    const bool UpperIsTrue = UpperBlock == True;
    const uint64_t Either = UpperIsTrue ? Whole.True : Whole.False, Other = UpperIsTrue ? Whole.False : Whole.True;
    Whole.set(OnUpper, 2 * Other + Either, Either);
    Whole.set(OnLower, UpperIsTrue ? Either : 2 * Other, UpperIsTrue ? 2 * Other : Either);
    addPredecessor(UpperBlock, Block, LowerBlock, /*Instead=*/false);
    addPredecessor(UpperIsTrue ? False : True, Block, LowerBlock, /*Instead=*/true);
  }
  Branch->eraseFromParent();
  Compare->eraseFromParent();
  return true;
}

/// On the edge where a value is equal to a constant, phis take the value.
static bool forwardKnownValue(BranchInst *Branch) {
  CmpInst::Predicate Predicate;
  Value *V;
  Constant *C;
  if (!match(Branch->getCondition(), m_ICmp(Predicate, m_Value(V), m_Constant(C))) ||
      !ICmpInst::isEquality(Predicate) || !V->getType()->isIntegerTy(32) ||
      Branch->getSuccessor(0) == Branch->getSuccessor(1))
    return false;
  bool Changed = false;
  for (PHINode &Phi : Branch->getSuccessor(Predicate == ICmpInst::ICMP_EQ ? 0 : 1)->phis()) {
    const int Index = Phi.getBasicBlockIndex(Branch->getParent());
    if (Phi.getIncomingValue(Index) != C)
      continue;
    Phi.setIncomingValue(Index, V);
    Changed = true;
  }
  return Changed;
}

bool TraxBranches::runOnFunction(Function &F) {
  if (skipFunction(F))
    return false;
  bool Changed = false;
  SmallVector<BranchInst *, 32> Branches;
  for (BasicBlock &Block : F)
    if (auto *Branch = dyn_cast<BranchInst>(Block.getTerminator()); Branch && Branch->isConditional())
      Branches.push_back(Branch);
  for (BranchInst *Branch : Branches)
    Changed |= forwardKnownValue(Branch);
  for (BranchInst *Branch : Branches)
    if (auto *Condition = dyn_cast<Instruction>(Branch->getCondition());
        Condition && Condition->getParent() == Branch->getParent())
      Worklist.push_back(Branch);
  while (!Worklist.empty()) {
    BranchInst *Branch = Worklist.pop_back_val();
    Value *Condition = Branch->getCondition();
    if (Branch->getSuccessor(0) != Branch->getSuccessor(1) &&
        containsDoubleWordComparison(Condition, Branch->getParent()))
      Changed |= isa<ICmpInst>(Condition) ? splitComparison(Branch) : splitTree(Branch);
  }
  return Changed;
}

char TraxBranches::ID = 0;

INITIALIZE_PASS(TraxBranches, DEBUG_TYPE, "TRaX branch conditions", false, false)

FunctionPass *llvm::createTraxBranchesPass() {
  return new TraxBranches();
}
