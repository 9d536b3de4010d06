//===- TraxBranches.cpp - Phis take values that branches have compared ----===//
//
// Before instruction selection: where a branch has found that a value equals a constant, a phi takes the value instead
// of the constant. The value may be in the phi's register already.
//
//===----------------------------------------------------------------------===//
#include "Trax.h"
#include "llvm/IR/Instructions.h"
#include "llvm/IR/PatternMatch.h"
#include "llvm/InitializePasses.h"
#include "llvm/Pass.h"

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
};

} // namespace

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
  for (BasicBlock &Block : F)
    if (auto *Branch = dyn_cast<BranchInst>(Block.getTerminator()); Branch && Branch->isConditional())
      Changed |= forwardKnownValue(Branch);
  return Changed;
}

char TraxBranches::ID = 0;

INITIALIZE_PASS(TraxBranches, DEBUG_TYPE, "TRaX branch conditions", false, false)

FunctionPass *llvm::createTraxBranchesPass() {
  return new TraxBranches();
}
