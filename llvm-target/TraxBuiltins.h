//===- TraxBuiltins.h - The machine's own operations, as calls -----------===//
//
// The prebuilt LLVM cannot be given intrinsics of a new target. Clang's builtins for this machine therefore reach the
// code generator as calls of functions that are recognised by name and become single instructions.
//
//===----------------------------------------------------------------------===//
#ifndef TRAX_TRAXBUILTINS_H
#define TRAX_TRAXBUILTINS_H

#include "llvm/ADT/StringRef.h"
#include "llvm/IR/PassManager.h"
#include <optional>

namespace llvm {

class Function;
class Module;

namespace TraxBuiltin {

enum ID { Rsqrt, Rdsr, Trap, Halt, Ainc, Lwnt };

/// The builtin that a function of this name stands for: __builtin_trax_x, or __trax_x as clang calls the library
/// function behind the builtin __builtin___trax_x.
std::optional<ID> find(StringRef Name);

} // namespace TraxBuiltin

/// Tells the optimizer, before anything else runs, what the builtins do and do not do.
class TraxBuiltinsPass : public PassInfoMixin<TraxBuiltinsPass> {
public:
  PreservedAnalyses run(Module &M, ModuleAnalysisManager &AM);
  static bool isRequired() { return true; }
};

} // namespace llvm

#endif
