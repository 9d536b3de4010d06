//===- TraxMCTargetDesc.cpp - The machine-code layer ---------------------===//
#include "TraxMCTargetDesc.h"
#include "LLVMTrax.h"
#include "TargetInfo/TraxTargetInfo.h"
#include "TraxInstPrinter.h"
#include "TraxMCAsmInfo.h"
#include "TraxTargetStreamer.h"
#include "llvm/MC/MCDwarf.h"
#include "llvm/MC/MCInstrAnalysis.h"
#include "llvm/MC/MCInstrInfo.h"
#include "llvm/MC/MCRegisterInfo.h"
#include "llvm/MC/MCStreamer.h"
#include "llvm/MC/MCSubtargetInfo.h"
#include "llvm/MC/TargetRegistry.h"

using namespace llvm;

#define GET_INSTRINFO_MC_DESC
#include "TraxGenInstrInfo.inc"

#define GET_SUBTARGETINFO_MC_DESC
#include "TraxGenSubtargetInfo.inc"

#define GET_REGINFO_MC_DESC
#include "TraxGenRegisterInfo.inc"

static MCInstrInfo *createTraxMCInstrInfo() {
  auto *MII = new MCInstrInfo();
  InitTraxMCInstrInfo(MII);
  return MII;
}

static MCRegisterInfo *createTraxMCRegisterInfo(const Triple &) {
  auto *MRI = new MCRegisterInfo();
  InitTraxMCRegisterInfo(MRI, Trax::R1);
  return MRI;
}

static MCSubtargetInfo *createTraxMCSubtargetInfo(const Triple &TT, StringRef CPU, StringRef FS) {
  if (CPU.empty())
    CPU = "generic";
  return createTraxMCSubtargetInfoImpl(TT, CPU, /*TuneCPU=*/CPU, FS);
}

static MCAsmInfo *createTraxMCAsmInfo(const MCRegisterInfo &MRI, const Triple &TT, const MCTargetOptions &) {
  auto *MAI = new TraxMCAsmInfo(TT);
  MAI->addInitialFrameState(MCCFIInstruction::cfiDefCfa(nullptr, MRI.getDwarfRegNum(Trax::R2, true), 0));
  return MAI;
}

static MCInstPrinter *createTraxMCInstPrinter(const Triple &, unsigned, const MCAsmInfo &MAI, const MCInstrInfo &MII,
                                              const MCRegisterInfo &MRI) {
  return new TraxInstPrinter(MAI, MII, MRI);
}

namespace {

/// Finds the targets of branches, for the disassembler's labels.
class TraxMCInstrAnalysis : public MCInstrAnalysis {
public:
  explicit TraxMCInstrAnalysis(const MCInstrInfo *Info) : MCInstrAnalysis(Info) {}

  bool evaluateBranch(const MCInst &Inst, uint64_t Addr, uint64_t, uint64_t &Target) const override {
    const MCInstrDesc &Desc = Info->get(Inst.getOpcode());
    for (unsigned I = 0, E = std::min<unsigned>(Inst.getNumOperands(), Desc.getNumOperands()); I != E; ++I) {
      if (Desc.operands()[I].OperandType != MCOI::OPERAND_PCREL || !Inst.getOperand(I).isImm())
        continue;
      Target = uint32_t(Addr + Inst.getOperand(I).getImm());
      return true;
    }
    return false;
  }
};

} // namespace

static MCInstrAnalysis *createTraxMCInstrAnalysis(const MCInstrInfo *Info) {
  return new TraxMCInstrAnalysis(Info);
}

void LLVMInitializeTraxTargetMC() {
  Target &T = getTheTraxTarget();
  TargetRegistry::RegisterMCAsmInfo(T, createTraxMCAsmInfo);
  TargetRegistry::RegisterMCInstrInfo(T, createTraxMCInstrInfo);
  TargetRegistry::RegisterMCRegInfo(T, createTraxMCRegisterInfo);
  TargetRegistry::RegisterMCSubtargetInfo(T, createTraxMCSubtargetInfo);
  TargetRegistry::RegisterMCInstPrinter(T, createTraxMCInstPrinter);
  TargetRegistry::RegisterMCInstrAnalysis(T, createTraxMCInstrAnalysis);
  TargetRegistry::RegisterMCCodeEmitter(T, createTraxMCCodeEmitter);
  TargetRegistry::RegisterMCAsmBackend(T, createTraxAsmBackend);
  registerTraxTargetStreamers(T);
}
