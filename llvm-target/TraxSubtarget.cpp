//===- TraxSubtarget.cpp - The machine as code generation sees it --------===//
#include "TraxSubtarget.h"
#include "TraxTargetMachine.h"
#include "llvm/ADT/StringRef.h"
#include "llvm/MC/MCSchedule.h"

using namespace llvm;

#define DEBUG_TYPE "trax-subtarget"

#define GET_SUBTARGETINFO_TARGET_DESC
#define GET_SUBTARGETINFO_CTOR
#include "TraxGenSubtargetInfo.inc"

static std::string cpuOrDefault(const std::string &CPU) {
  return CPU.empty() ? "generic" : CPU;
}

TraxSubtarget::TraxSubtarget(const Triple &TT, const std::string &CPU, const std::string &FS,
                             const TraxTargetMachine &TM)
    : TraxGenSubtargetInfo(TT, cpuOrDefault(CPU), /*TuneCPU=*/cpuOrDefault(CPU), FS), TLInfo(TM, *this) {
  ParseSubtargetFeatures(cpuOrDefault(CPU), cpuOrDefault(CPU), FS);
}
