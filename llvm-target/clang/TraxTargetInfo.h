//===- TraxTargetInfo.h - the machine for clang's front end --------------===//
//
// Sizes, alignments, registers, inline-assembly constraints, predefined macros and builtins (docs/abi.md).
//
//===----------------------------------------------------------------------===//
#ifndef TRAX_CLANG_TRAXTARGETINFO_H
#define TRAX_CLANG_TRAXTARGETINFO_H

#include "clang/Basic/TargetInfo.h"
#include "llvm/ADT/IntrusiveRefCntPtr.h"
#include <memory>

namespace clang {
class DiagnosticsEngine;
class TargetOptions;
} // namespace clang

namespace trax {

/// Whether the triple names this machine: architecture `trax`, no operating system. LLVM parses the architecture of
/// such a triple as unknown, so the name is all there is to go by.
bool isTraxTriple(const llvm::Triple &Triple);

/// Makes the target for the options, checking the CPU, ABI and features they name as clang does for its own targets.
/// Returns null after a diagnostic if one is unknown.
llvm::IntrusiveRefCntPtr<clang::TargetInfo> createTargetInfo(clang::DiagnosticsEngine &Diags,
                                                             std::shared_ptr<clang::TargetOptions> Opts);

} // namespace trax

#endif
