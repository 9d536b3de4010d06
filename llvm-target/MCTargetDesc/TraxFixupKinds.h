//===- TraxFixupKinds.h - Places that the linker or the layout fills -----===//
#ifndef TRAX_MCTARGETDESC_TRAXFIXUPKINDS_H
#define TRAX_MCTARGETDESC_TRAXFIXUPKINDS_H

#include "llvm/MC/MCFixup.h"

namespace llvm::Trax {

/// One for each instruction relocation of docs/abi.md, in the order of TraxAsmBackend's table.
enum Fixups : unsigned {
  fixup_hi16 = FirstTargetFixupKind,
  fixup_lo16,
  fixup_imm16,
  fixup_br16,
  fixup_jal21,
  LastTargetFixupKind,
  NumTargetFixupKinds = LastTargetFixupKind - FirstTargetFixupKind
};

} // namespace llvm::Trax

#endif
