//===- TraxAsmBackend.cpp - Fixups that the layout resolves --------------===//
#include "TraxAsmGuard.h"
#include "TraxFixupKinds.h"
#include "TraxMCTargetDesc.h"
#include "trax/abi.h"
#include "llvm/ADT/StringSwitch.h"
#include "llvm/MC/MCAsmBackend.h"
#include "llvm/MC/MCAssembler.h"
#include "llvm/MC/MCContext.h"
#include "llvm/MC/MCELFObjectWriter.h"
#include "llvm/MC/MCFixupKindInfo.h"
#include "llvm/MC/MCValue.h"
#include "llvm/Support/MathExtras.h"
#include "llvm/Support/raw_ostream.h"

#include <algorithm>

using namespace llvm;

namespace {

class TraxAsmBackend : public MCAsmBackend {
public:
  TraxAsmBackend() : MCAsmBackend(endianness::little) {}

  unsigned getNumFixupKinds() const override { return Trax::NumTargetFixupKinds; }
  std::optional<MCFixupKind> getFixupKind(StringRef Name) const override;
  const MCFixupKindInfo &getFixupKindInfo(MCFixupKind Kind) const override;
  std::unique_ptr<MCObjectTargetWriter> createObjectTargetWriter() const override {
    return createTraxELFObjectWriter();
  }
  void applyFixup(const MCAssembler &Asm, const MCFixup &Fixup, const MCValue &Target, MutableArrayRef<char> Data,
                  uint64_t Value, bool IsResolved, const MCSubtargetInfo *STI) const override;
  bool shouldForceRelocation(const MCAssembler &, const MCFixup &Fixup, const MCValue &,
                             const MCSubtargetInfo *) override {
    return Fixup.getKind() >= FirstLiteralRelocationKind;
  }
  bool writeNopData(raw_ostream &OS, uint64_t Count, const MCSubtargetInfo *STI) const override;
  void finishLayout(const MCAssembler &Asm) const override;
};

} // namespace

/// Limits the bytes that .skip, .org and alignment fill. Their number is known now, and they are written next.
void TraxAsmBackend::finishLayout(const MCAssembler &Asm) const {
  constexpr uint64_t Most = 256 << 20;
  MCContext &Context = Asm.getContext();
  const SourceMgr *Sources = Context.getSourceManager() ? Context.getSourceManager() : Context.getInlineSourceManager();
  uint64_t Filled = 0;
  for (const MCSection &Section : Asm) {
    const bool Written = !Section.isVirtualSection();
    uint64_t Rest = Asm.getSectionFileSize(Section); // the padding of bundles of instructions
    for (const MCFragment &Fragment : Section) {
      SMLoc Place;
      const uint64_t Size = Asm.computeFragmentSize(Fragment);
      Rest -= Size;
      if (const auto *Fill = dyn_cast<MCFillFragment>(&Fragment))
        Place = Fill->getLoc();
      else if (const auto *Org = dyn_cast<MCOrgFragment>(&Fragment))
        Place = Org->getLoc();
      else if (!isa<MCAlignFragment>(Fragment))
        continue;
      Filled += Written ? std::min(Size, Most + 1) : 0;
      if (Written ? Filled > Most : Size > UINT32_MAX)
        trax::stopAssembly(Sources, Place,
                           Written ? "more than 256 MB of an object are filled" : "is larger than the address space");
    }
    if (Written && Rest > Most)
      trax::stopAssembly(Sources, SMLoc(), "more than 256 MB of an object are filled");
  }
}

/// The relocation that .reloc names. LLVM itself uses BFD_RELOC_NONE for call-graph profiles.
std::optional<MCFixupKind> TraxAsmBackend::getFixupKind(StringRef Name) const {
#define TRAX_RELOCATION(NAME, NUMBER) .Case(#NAME, NUMBER)
  const unsigned Type = StringSwitch<unsigned>(Name) TRAX_RELOCATIONS(TRAX_RELOCATION)
                            .Case("BFD_RELOC_NONE", 0) // R_TRAX_NONE
                            .Default(~0u);
#undef TRAX_RELOCATION
  if (Type == ~0u)
    return std::nullopt;
  return MCFixupKind(FirstLiteralRelocationKind + Type);
}

const MCFixupKindInfo &TraxAsmBackend::getFixupKindInfo(MCFixupKind Kind) const {
  static const MCFixupKindInfo Infos[Trax::NumTargetFixupKinds] = {
      // name, first bit, bits, flags
      {"fixup_hi16", 0, 16, 0},
      {"fixup_lo16", 0, 16, 0},
      {"fixup_imm16", 0, 16, 0},
      {"fixup_br16", 0, 16, MCFixupKindInfo::FKF_IsPCRel},
      {"fixup_jal21", 0, 21, MCFixupKindInfo::FKF_IsPCRel},
  };
  if (Kind >= FirstLiteralRelocationKind)
    return MCAsmBackend::getFixupKindInfo(FK_NONE);
  if (Kind < FirstTargetFixupKind || Kind >= FirstTargetFixupKind + Trax::NumTargetFixupKinds)
    return MCAsmBackend::getFixupKindInfo(Kind);
  return Infos[Kind - FirstTargetFixupKind];
}

/// The bits to put in the field, as docs/abi.md defines the relocation of the same name.
static uint64_t adjustValue(const MCFixup &Fixup, int64_t Value, MCContext &Ctx) {
  auto PCRelative = [&](unsigned Bits) -> uint64_t {
    if (Value & 3)
      Ctx.reportError(Fixup.getLoc(), "branch target is not a multiple of 4");
    else if (!isIntN(Bits + 2, Value))
      Ctx.reportError(Fixup.getLoc(), "branch target is out of range");
    return (uint64_t(Value) >> 2) & maskTrailingOnes<uint64_t>(Bits);
  };
  switch (Fixup.getTargetKind()) {
  case Trax::fixup_hi16:
    return ((Value + 0x8000) >> 16) & 0xFFFF;
  case Trax::fixup_lo16:
    return Value & 0xFFFF;
  case Trax::fixup_imm16:
    if (!isInt<16>(SignExtend64<32>(Value)) || !(isInt<32>(Value) || isUInt<32>(Value)))
      Ctx.reportError(Fixup.getLoc(), "value does not fit a signed 16-bit immediate");
    return Value & 0xFFFF;
  case Trax::fixup_br16:
    return PCRelative(16);
  case Trax::fixup_jal21:
    return PCRelative(21);
  default:
    return Value;
  }
}

void TraxAsmBackend::applyFixup(const MCAssembler &Asm, const MCFixup &Fixup, const MCValue &,
                                MutableArrayRef<char> Data, uint64_t Value, bool IsResolved,
                                const MCSubtargetInfo *) const {
  // RELA: what the linker fills stays zero.
  if (!IsResolved)
    return;
  MCFixupKind Kind = Fixup.getKind();
  if (Kind >= FirstLiteralRelocationKind)
    return;
  const MCFixupKindInfo &Info = getFixupKindInfo(Kind);
  Value = adjustValue(Fixup, Value, Asm.getContext());
  unsigned Bytes = alignTo(Info.TargetSize + Info.TargetOffset, 8) / 8;
  for (unsigned I = 0; I != Bytes; ++I)
    Data[Fixup.getOffset() + I] |= uint8_t(Value >> (8 * I));
}

bool TraxAsmBackend::writeNopData(raw_ostream &OS, uint64_t Count, const MCSubtargetInfo *) const {
  if (Count % 4 != 0)
    return false;
  for (; Count != 0; Count -= 4)
    OS.write("\0\0\0\x20", 4); // addi r0, r0, 0
  return true;
}

MCAsmBackend *llvm::createTraxAsmBackend(const Target &, const MCSubtargetInfo &, const MCRegisterInfo &,
                                         const MCTargetOptions &) {
  return new TraxAsmBackend();
}
