//===- TraxLowerVAArg.cpp - va_arg as loads ------------------------------===//
//
// A va_list is a pointer to the next unnamed argument; each takes whole words (docs/abi.md). Instruction selection
// cannot expand a va_arg of an aggregate, so all are written out here.
//
//===----------------------------------------------------------------------===//
#include "Trax.h"
#include "llvm/IR/DataLayout.h"
#include "llvm/IR/IRBuilder.h"
#include "llvm/IR/InstIterator.h"
#include "llvm/IR/Instructions.h"
#include "llvm/IR/Module.h"
#include "llvm/InitializePasses.h"
#include "llvm/Pass.h"

using namespace llvm;

#define DEBUG_TYPE "trax-lower-va-arg"

namespace {

class TraxLowerVAArg : public FunctionPass {
public:
  static char ID;
  TraxLowerVAArg() : FunctionPass(ID) {}

  StringRef getPassName() const override { return "TRaX va_arg lowering"; }

  bool runOnFunction(Function &F) override {
    SmallVector<VAArgInst *, 8> Worklist;
    for (Instruction &I : instructions(F))
      if (auto *VA = dyn_cast<VAArgInst>(&I))
        Worklist.push_back(VA);
    for (VAArgInst *VA : Worklist)
      lower(*VA);
    return !Worklist.empty();
  }

  void getAnalysisUsage(AnalysisUsage &AU) const override { AU.setPreservesCFG(); }

private:
  static void lower(VAArgInst &VA) {
    const DataLayout &DL = VA.getModule()->getDataLayout();
    IRBuilder<> Builder(&VA);
    Type *Ty = VA.getType();
    const Align WordAlign(4);
    Value *Argument = Builder.CreateAlignedLoad(Builder.getPtrTy(), VA.getPointerOperand(), WordAlign, "va.arg");
    uint64_t Size = alignTo(DL.getTypeAllocSize(Ty), WordAlign);
    Value *Next = Builder.CreatePtrAdd(Argument, Builder.getInt32(Size), "va.next");
    Builder.CreateAlignedStore(Next, VA.getPointerOperand(), WordAlign);
    Value *Result = Builder.CreateAlignedLoad(Ty, Argument, std::min(WordAlign, DL.getABITypeAlign(Ty)));
    Result->takeName(&VA);
    VA.replaceAllUsesWith(Result);
    VA.eraseFromParent();
  }
};

} // namespace

char TraxLowerVAArg::ID = 0;

INITIALIZE_PASS(TraxLowerVAArg, DEBUG_TYPE, "TRaX va_arg lowering", false, false)

FunctionPass *llvm::createTraxLowerVAArgPass() {
  return new TraxLowerVAArg();
}
