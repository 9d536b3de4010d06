//===- CC1.h - the compiler and the assembler that the driver starts -----===//
#ifndef TRAX_CLANG_CC1_H
#define TRAX_CLANG_CC1_H

#include "llvm/ADT/ArrayRef.h"

namespace trax {

/// `clang -cc1`: compiles one file. The arguments follow `-cc1`. Returns the exit status.
int runCC1(llvm::ArrayRef<const char *> Args, const char *Argv0);

/// `clang -cc1as`: assembles one file. The arguments follow `-cc1as`. Returns the exit status.
int runCC1As(llvm::ArrayRef<const char *> Args, const char *Argv0);

/// For llvm::ScopedFatalErrorHandler, with a DiagnosticsEngine: a fatal error of LLVM's becomes a diagnostic like any
/// other.
void reportFatalError(void *Diags, const char *Message, bool GenCrashDiag);

} // namespace trax

#endif
