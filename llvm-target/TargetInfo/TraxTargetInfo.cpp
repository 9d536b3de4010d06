//===- TraxTargetInfo.cpp - The target's registration --------------------===//
#include "TargetInfo/TraxTargetInfo.h"
#include "LLVMTrax.h"
#include "llvm/MC/TargetRegistry.h"
#include "llvm/TargetParser/Triple.h"

using namespace llvm;

Target &llvm::getTheTraxTarget() {
  static Target TheTraxTarget;
  return TheTraxTarget;
}

bool llvm::isTraxTriple(const Triple &TT) {
  return TT.getArchName() == "trax";
}

void LLVMInitializeTraxTargetInfo() {
  RegisterTarget<Triple::UnknownArch> X(getTheTraxTarget(), "trax", "TRaX ray-tracing accelerator", "Trax");
}
