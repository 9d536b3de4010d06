//===- TraxToolChain.h - how the driver compiles and links for Trax ------===//
//
// Clang's driver picks its generic ELF tool chain for an architecture it does not know. These functions give that tool
// chain the machine's defaults, refuse what the machine cannot do, and make its link job ours.
//
//===----------------------------------------------------------------------===//
#ifndef TRAX_CLANG_TRAXTOOLCHAIN_H
#define TRAX_CLANG_TRAXTOOLCHAIN_H

#include "llvm/ADT/ArrayRef.h"
#include "llvm/ADT/SmallVector.h"
#include "llvm/ADT/StringRef.h"
#include "llvm/Support/StringSaver.h"

namespace clang::driver {
class Compilation;
class Driver;
} // namespace clang::driver

namespace trax {

/// Puts the machine's defaults behind the program's name, so that the user's own options come later and win.
/// RuntimeDir holds crt0.o, libc.a and include/.
void insertDefaults(llvm::SmallVectorImpl<const char *> &Args, llvm::StringRef RuntimeDir, llvm::StringSaver &Strings);

/// Reports options that clang accepts for any target and this machine cannot obey.
void checkOptions(const clang::driver::Compilation &C);

/// Replaces the generic tool chain's link jobs, which call gcc, by calls of trax-ld.
void replaceLinkJobs(clang::driver::Compilation &C, llvm::StringRef RuntimeDir);

} // namespace trax

#endif
