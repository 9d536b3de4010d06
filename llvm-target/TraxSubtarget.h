//===- TraxSubtarget.h - The machine as code generation sees it ----------===//
#ifndef TRAX_TRAXSUBTARGET_H
#define TRAX_TRAXSUBTARGET_H

#include "TraxFrameLowering.h"
#include "TraxISelLowering.h"
#include "TraxInstrInfo.h"
#include "TraxRegisterInfo.h"
#include "trax/abi.h"
#include "llvm/CodeGen/SelectionDAGTargetInfo.h"
#include "llvm/CodeGen/TargetSubtargetInfo.h"
#include <bitset>

#define GET_SUBTARGETINFO_HEADER
#include "TraxGenSubtargetInfo.inc"

namespace llvm {

class TraxTargetMachine;

class TraxSubtarget : public TraxGenSubtargetInfo {
  TraxFrameLowering FrameLowering;
  TraxInstrInfo InstrInfo;
  TraxTargetLowering TLInfo;
  SelectionDAGTargetInfo TSInfo;
  bool HasGlobalStack = false, HasEitherStack = false;
  std::bitset<32> ReservedRegisters;

public:
  TraxSubtarget(const Triple &TT, const std::string &CPU, const std::string &FS, const TraxTargetMachine &TM);

  // Generated from the instruction tables.
  void ParseSubtargetFeatures(StringRef CPU, StringRef TuneCPU, StringRef FS);

  const TraxFrameLowering *getFrameLowering() const override { return &FrameLowering; }
  const TraxInstrInfo *getInstrInfo() const override { return &InstrInfo; }
  const TraxRegisterInfo *getRegisterInfo() const override { return &InstrInfo.getRegisterInfo(); }
  const TraxTargetLowering *getTargetLowering() const override { return &TLInfo; }
  const SelectionDAGTargetInfo *getSelectionDAGInfo() const override { return &TSInfo; }

  /// The place of automatic objects: TRAX_EF_STACK_LOCAL; TRAX_EF_STACK_GLOBAL, where other threads can reach them; or
  /// 0 for either.
  unsigned getStack() const { return HasEitherStack ? 0 : HasGlobalStack ? TRAX_EF_STACK_GLOBAL : TRAX_EF_STACK_LOCAL; }

  /// Whether -ffixed-rN reserves the register for the program.
  bool isReserved(MCRegister Register) const {
    return ReservedRegisters[InstrInfo.getRegisterInfo().getEncodingValue(Register)];
  }

  bool enableMachineScheduler() const override { return true; }
  bool enableSpillageCopyElimination() const override { return true; }
};

} // namespace llvm

#endif
