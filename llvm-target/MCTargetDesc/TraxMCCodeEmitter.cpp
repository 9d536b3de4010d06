//===- TraxMCCodeEmitter.cpp - MCInst to bits ----------------------------===//
#include "TraxFixupKinds.h"
#include "TraxMCExpr.h"
#include "TraxMCTargetDesc.h"
#include "llvm/MC/MCCodeEmitter.h"
#include "llvm/MC/MCContext.h"
#include "llvm/MC/MCInst.h"
#include "llvm/MC/MCInstrInfo.h"
#include "llvm/MC/MCRegisterInfo.h"
#include "llvm/MC/MCSubtargetInfo.h"
#include "llvm/Support/Casting.h"
#include "llvm/Support/EndianStream.h"

using namespace llvm;

namespace {

class TraxMCCodeEmitter : public MCCodeEmitter {
  MCContext &Ctx;

public:
  explicit TraxMCCodeEmitter(MCContext &Ctx) : Ctx(Ctx) {}

  void encodeInstruction(const MCInst &MI, SmallVectorImpl<char> &CB, SmallVectorImpl<MCFixup> &Fixups,
                         const MCSubtargetInfo &STI) const override {
    support::endian::write<uint32_t>(CB, getBinaryCodeForInstr(MI, Fixups, STI), endianness::little);
  }

  // Generated from the instruction tables; calls the functions below for operands.
  uint64_t getBinaryCodeForInstr(const MCInst &MI, SmallVectorImpl<MCFixup> &Fixups, const MCSubtargetInfo &STI) const;

  unsigned getMachineOpValue(const MCInst &MI, const MCOperand &MO, SmallVectorImpl<MCFixup> &,
                             const MCSubtargetInfo &) const {
    if (MO.isReg())
      return Ctx.getRegisterInfo()->getEncodingValue(MO.getReg());
    if (MO.isImm())
      return MO.getImm();
    Ctx.reportError(MI.getLoc(), "operand must be a constant");
    return 0;
  }

  unsigned encodeImm16(const MCInst &MI, unsigned OpNo, SmallVectorImpl<MCFixup> &Fixups,
                       const MCSubtargetInfo &) const {
    const MCOperand &MO = MI.getOperand(OpNo);
    if (MO.isImm())
      return MO.getImm() & 0xFFFF;
    const MCExpr *Expr = MO.getExpr();
    const auto *Part = dyn_cast<TraxMCExpr>(Expr);
    if (!Part) {
      Ctx.reportError(MI.getLoc(), "symbolic immediate needs %hi(), %lo() or %abs()");
      return 0;
    }
    static const Trax::Fixups Kinds[] = {Trax::fixup_hi16, Trax::fixup_lo16, Trax::fixup_imm16};
    Fixups.push_back(MCFixup::create(0, Expr, MCFixupKind(Kinds[Part->getSpecifier()]), MI.getLoc()));
    return 0;
  }

  unsigned encodeTarget(const MCInst &MI, unsigned OpNo, SmallVectorImpl<MCFixup> &Fixups, Trax::Fixups Kind) const {
    const MCOperand &MO = MI.getOperand(OpNo);
    if (MO.isImm())
      return unsigned(MO.getImm()) >> 2;
    Fixups.push_back(MCFixup::create(0, MO.getExpr(), MCFixupKind(Kind), MI.getLoc()));
    return 0;
  }

  unsigned encodeBrTarget(const MCInst &MI, unsigned OpNo, SmallVectorImpl<MCFixup> &Fixups,
                          const MCSubtargetInfo &) const {
    return encodeTarget(MI, OpNo, Fixups, Trax::fixup_br16) & 0xFFFF;
  }

  unsigned encodeJalTarget(const MCInst &MI, unsigned OpNo, SmallVectorImpl<MCFixup> &Fixups,
                           const MCSubtargetInfo &) const {
    return encodeTarget(MI, OpNo, Fixups, Trax::fixup_jal21) & 0x1FFFFF;
  }
};

} // namespace

MCCodeEmitter *llvm::createTraxMCCodeEmitter(const MCInstrInfo &, MCContext &Ctx) {
  return new TraxMCCodeEmitter(Ctx);
}

#include "TraxGenMCCodeEmitter.inc"
