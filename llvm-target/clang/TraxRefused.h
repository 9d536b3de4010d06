//===- TraxRefused.h - options that the machine cannot obey --------------===//
#ifndef TRAX_CLANG_TRAXREFUSED_H
#define TRAX_CLANG_TRAXREFUSED_H

#include "llvm/ADT/SmallVector.h"
#include "llvm/Option/ArgList.h"
#include "llvm/TargetParser/Triple.h"

namespace clang::driver {
class Driver;
}

namespace trax {

/// Reports options that clang accepts for any target and this machine cannot support, and wrong values of its own
/// options. Claims options that request the only behaviour that this target has.
void refuseOptions(const clang::driver::Driver &D, const llvm::Triple &Triple, const llvm::opt::ArgList &Args);

/// The registers of -ffixed-rN that can be kept free.
llvm::SmallVector<unsigned, 4> fixedRegisters(const llvm::opt::ArgList &Args);

} // namespace trax

#endif
