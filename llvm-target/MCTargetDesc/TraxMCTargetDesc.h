//===- TraxMCTargetDesc.h - The machine-code layer -----------------------===//
#ifndef TRAX_MCTARGETDESC_TRAXMCTARGETDESC_H
#define TRAX_MCTARGETDESC_TRAXMCTARGETDESC_H

#include <cstdint>
#include <memory>

namespace llvm {

class MCAsmBackend;
class MCCodeEmitter;
class MCContext;
class MCInstrInfo;
class MCObjectTargetWriter;
class MCRegisterInfo;
class MCSubtargetInfo;
class MCTargetOptions;
class Target;

MCCodeEmitter *createTraxMCCodeEmitter(const MCInstrInfo &MCII, MCContext &Ctx);
MCAsmBackend *createTraxAsmBackend(const Target &T, const MCSubtargetInfo &STI, const MCRegisterInfo &MRI,
                                   const MCTargetOptions &Options);
std::unique_ptr<MCObjectTargetWriter> createTraxELFObjectWriter();

} // namespace llvm

#define GET_REGINFO_ENUM
#include "TraxGenRegisterInfo.inc"

#define GET_INSTRINFO_ENUM
#include "TraxGenInstrInfo.inc"

#define GET_SUBTARGETINFO_ENUM
#include "TraxGenSubtargetInfo.inc"

#endif
