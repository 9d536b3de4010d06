//===- TraxBuiltins.cpp - The machine's own operations, as calls ---------===//
#include "TraxBuiltins.h"
#include "trax/abi.h"
#include "llvm/ADT/StringSwitch.h"
#include "llvm/IR/Constants.h"
#include "llvm/IR/Function.h"
#include "llvm/IR/InstrTypes.h"
#include "llvm/IR/Instructions.h"
#include "llvm/IR/Module.h"
#include "llvm/Support/ModRef.h"

using namespace llvm;

std::optional<TraxBuiltin::ID> TraxBuiltin::find(StringRef Name) {
  if (!Name.consume_front("__builtin_trax_") && !Name.consume_front("__trax_"))
    return std::nullopt;
  return StringSwitch<std::optional<ID>>(Name)
      .Case("rsqrt", Rsqrt)
      .Case("rdsr", Rdsr)
      .Case("trap", Trap)
      .Case("halt", Halt)
      .Case("ainc", Ainc)
      .Case("lwnt", Lwnt)
      .Default(std::nullopt);
}

/// Special registers other than the cycle counter hold the same value as long as the thread runs.
static void markConstantReads(Function &Rdsr) {
  for (User *U : Rdsr.users()) {
    auto *Call = dyn_cast<CallInst>(U);
    if (!Call || Call->getCalledFunction() != &Rdsr || Call->arg_size() != 1)
      continue;
    auto *Number = dyn_cast<ConstantInt>(Call->getArgOperand(0));
    if (!Number || Number->getZExtValue() > TRAX_SR_THREADS)
      continue;
    Call->setDoesNotAccessMemory();
    Call->addFnAttr(Attribute::WillReturn);
    Call->addFnAttr(Attribute::NoSync);
  }
}

PreservedAnalyses TraxBuiltinsPass::run(Module &M, ModuleAnalysisManager &) {
  bool Changed = false;
  for (Function &F : M) {
    std::optional<TraxBuiltin::ID> Builtin = TraxBuiltin::find(F.getName());
    if (!Builtin || !F.isDeclaration())
      continue;
    Changed = true;
    F.setDoesNotThrow();
    switch (*Builtin) {
    case TraxBuiltin::Rsqrt: // total: may be computed where the source would not have
      F.setDoesNotAccessMemory();
      F.setWillReturn();
      F.addFnAttr(Attribute::NoSync);
      F.addFnAttr(Attribute::NoFree);
      F.setSpeculatable();
      break;
    case TraxBuiltin::Rdsr: // may read the cycle counter: not to be merged, or moved over one another
      F.addFnAttr(Attribute::NoFree);
      markConstantReads(F);
      break;
    case TraxBuiltin::Trap:
      F.addFnAttr(Attribute::NoFree);
      break;
    case TraxBuiltin::Halt:
      F.setDoesNotReturn();
      break;
    case TraxBuiltin::Ainc:
    case TraxBuiltin::Lwnt:
      F.setWillReturn();
      F.addFnAttr(Attribute::NoFree);
      break;
    }
  }
  return Changed ? PreservedAnalyses::none() : PreservedAnalyses::all();
}
