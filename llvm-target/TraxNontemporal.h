//===- TraxNontemporal.h - Loops of nontemporal loads --------------------===//
#ifndef LLVM_LIB_TARGET_TRAX_TRAXNONTEMPORAL_H
#define LLVM_LIB_TARGET_TRAX_TRAXNONTEMPORAL_H

#include "llvm/IR/PassManager.h"

namespace llvm {

class PassBuilder;

/// Keeps loops that copy by nontemporal loads. LLVM's loop idioms replace such a loop by memcpy, which loads through
/// the cache, unless the stores are nontemporal, too. So these stores are marked nontemporal before that pass, and the
/// mark is removed after it.
class TraxNontemporalPass : public PassInfoMixin<TraxNontemporalPass> {
  bool Marks;

public:
  explicit TraxNontemporalPass(bool Marks) : Marks(Marks) {}
  PreservedAnalyses run(Function &F, FunctionAnalysisManager &FAM);
  static bool isRequired() { return true; }
  static void registerWith(PassBuilder &PB);
};

} // namespace llvm

#endif
