//===- TraxNontemporal.cpp - Loops of nontemporal loads ------------------===//
#include "TraxNontemporal.h"
#include "llvm/IR/Function.h"
#include "llvm/IR/InstIterator.h"
#include "llvm/IR/Instructions.h"
#include "llvm/IR/Metadata.h"
#include "llvm/Passes/PassBuilder.h"

using namespace llvm;

static constexpr const char *const Mark = "trax.temporal";

/// Whether I is a temporal store of the value of a nontemporal load.
static bool isCopy(const Instruction &I) {
  const auto *Store = dyn_cast<StoreInst>(&I);
  const auto *Load = Store ? dyn_cast<LoadInst>(Store->getValueOperand()) : nullptr;
  return Load && Load->hasMetadata(LLVMContext::MD_nontemporal) && !Store->hasMetadata(LLVMContext::MD_nontemporal);
}

PreservedAnalyses TraxNontemporalPass::run(Function &F, FunctionAnalysisManager &) {
  LLVMContext &Context = F.getContext();
  for (Instruction &I : instructions(F)) {
    if (Marks && isCopy(I)) {
      MDNode *const One = MDNode::get(Context, ConstantAsMetadata::get(ConstantInt::get(Type::getInt32Ty(Context), 1)));
      I.setMetadata(LLVMContext::MD_nontemporal, One);
      I.setMetadata(Mark, MDNode::get(Context, {}));
    } else if (!Marks && I.hasMetadata(Mark)) {
      I.setMetadata(LLVMContext::MD_nontemporal, nullptr);
      I.setMetadata(Mark, nullptr);
    }
  }
  return PreservedAnalyses::all();
}

void TraxNontemporalPass::registerWith(PassBuilder &PB) {
  // Marks before the loop passes. Removes the marks after them, and at the end from functions that skipped those
  // passes.
  PB.registerPeepholeEPCallback(
      [](FunctionPassManager &FPM, OptimizationLevel) { FPM.addPass(TraxNontemporalPass(true)); });
  PB.registerScalarOptimizerLateEPCallback(
      [](FunctionPassManager &FPM, OptimizationLevel) { FPM.addPass(TraxNontemporalPass(false)); });
  PB.registerOptimizerLastEPCallback([](ModulePassManager &MPM, OptimizationLevel) {
    MPM.addPass(createModuleToFunctionPassAdaptor(TraxNontemporalPass(false)));
  });
}
