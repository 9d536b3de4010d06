//===- Trax.h - The target's passes --------------------------------------===//
#ifndef TRAX_TRAX_H
#define TRAX_TRAX_H

#include "MCTargetDesc/TraxBaseInfo.h"
#include "MCTargetDesc/TraxMCTargetDesc.h"
#include "llvm/Support/CodeGen.h"

namespace llvm {

class FunctionPass;
class PassRegistry;
class TraxTargetMachine;

/// Selects machine instructions.
FunctionPass *createTraxISelDag(TraxTargetMachine &TM, CodeGenOptLevel OptLevel);
/// Writes va_arg instructions out as loads, for every type.
FunctionPass *createTraxLowerVAArgPass();

void initializeTraxDAGToDAGISelLegacyPass(PassRegistry &);
void initializeTraxLowerVAArgPass(PassRegistry &);

} // namespace llvm

#endif
