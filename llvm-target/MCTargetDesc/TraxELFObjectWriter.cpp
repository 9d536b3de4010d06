//===- TraxELFObjectWriter.cpp - Fixups to relocations -------------------===//
#include "TraxFixupKinds.h"
#include "TraxMCTargetDesc.h"
#include "trax/abi.h"
#include "llvm/BinaryFormat/ELF.h"
#include "llvm/MC/MCContext.h"
#include "llvm/MC/MCELFObjectWriter.h"
#include "llvm/MC/MCValue.h"

using namespace llvm;

namespace {

#define TRAX_RELOCATION(NAME, NUMBER) NAME = NUMBER,
enum : unsigned { TRAX_RELOCATIONS(TRAX_RELOCATION) };
#undef TRAX_RELOCATION

class TraxELFObjectWriter : public MCELFObjectTargetWriter {
public:
  TraxELFObjectWriter()
      : MCELFObjectTargetWriter(/*Is64Bit=*/false, ELF::ELFOSABI_NONE, TRAX_EM, /*HasRelocationAddend=*/true) {}

protected:
  unsigned getRelocType(MCContext &Ctx, const MCValue &, const MCFixup &Fixup, bool IsPCRel) const override;

  bool needsRelocateWithSymbol(const MCValue &, const MCSymbol &, unsigned) const override { return false; }
};

} // namespace

unsigned TraxELFObjectWriter::getRelocType(MCContext &Ctx, const MCValue &, const MCFixup &Fixup, bool IsPCRel) const {
  unsigned Kind = Fixup.getTargetKind();
  if (Kind >= FirstLiteralRelocationKind)
    return Kind - FirstLiteralRelocationKind;
  switch (Kind) {
  case FK_NONE:
    return R_TRAX_NONE;
  case FK_Data_4:
    return IsPCRel ? R_TRAX_PC32 : R_TRAX_32;
  case FK_PCRel_4:
    return R_TRAX_PC32;
  case FK_Data_2:
    if (!IsPCRel)
      return R_TRAX_16;
    break;
  case FK_Data_1:
    if (!IsPCRel)
      return R_TRAX_8;
    break;
  case Trax::fixup_hi16:
  case Trax::fixup_lo16:
  case Trax::fixup_imm16:
    if (IsPCRel)
      break;
    return Kind == Trax::fixup_hi16 ? R_TRAX_HI16 : Kind == Trax::fixup_lo16 ? R_TRAX_LO16 : R_TRAX_IMM16;
  case Trax::fixup_br16:
    return R_TRAX_BR16;
  case Trax::fixup_jal21:
    return R_TRAX_JAL21;
  default:
    break;
  }
  Ctx.reportError(Fixup.getLoc(), "no relocation exists for this kind of expression");
  return R_TRAX_NONE;
}

std::unique_ptr<MCObjectTargetWriter> llvm::createTraxELFObjectWriter() {
  return std::make_unique<TraxELFObjectWriter>();
}
