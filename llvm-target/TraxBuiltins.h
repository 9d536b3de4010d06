//===- TraxBuiltins.h - The machine's own operations, as calls -----------===//
//
// The prebuilt LLVM cannot be given intrinsics of a new target. Clang's builtins for this machine therefore reach the
// code generator as calls of functions that are recognised by name and become single instructions.
//
//===----------------------------------------------------------------------===//
#ifndef TRAX_TRAXBUILTINS_H
#define TRAX_TRAXBUILTINS_H

#include "llvm/ADT/SmallVector.h"
#include "llvm/ADT/StringRef.h"
#include "llvm/CodeGenTypes/MachineValueType.h"
#include "llvm/IR/PassManager.h"
#include <optional>

namespace llvm {

class Function;
class Module;

namespace TraxBuiltin {

enum ID {
#define BUILTIN(ID, NAME, TYPE, ATTRIBUTES) ID,
#include "TraxBuiltins.def"
};

/// The builtin that a function with this name represents.
std::optional<ID> find(StringRef Name);

/// The types of its result, if it has one, and of its arguments, as the code generator sees them.
struct Signature {
  SmallVector<MVT, 1> Results;
  SmallVector<MVT, 2> Arguments;
};
Signature signature(ID Builtin);

} // namespace TraxBuiltin

/// Tells the optimizer, before anything else runs, what the builtins do and do not do.
class TraxBuiltinsPass : public PassInfoMixin<TraxBuiltinsPass> {
public:
  PreservedAnalyses run(Module &M, ModuleAnalysisManager &AM);
  static bool isRequired() { return true; }
};

} // namespace llvm

#endif
