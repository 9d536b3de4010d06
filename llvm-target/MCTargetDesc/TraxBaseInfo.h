//===- TraxBaseInfo.h - What code generation and MC share ----------------===//
#ifndef TRAX_MCTARGETDESC_TRAXBASEINFO_H
#define TRAX_MCTARGETDESC_TRAXBASEINFO_H

#include "llvm/ADT/StringRef.h"
#include <optional>

namespace llvm::TraxII {

/// Target flags of symbolic machine operands: which part of the address the instruction takes.
enum TargetFlag : unsigned { MO_None = 0, MO_HI, MO_LO, MO_ABS };

/// Names of special registers (rdsr) and of traps, by number; empty beyond the last one.
StringRef getSpecialRegisterName(unsigned Number);
StringRef getTrapName(unsigned Code);
std::optional<unsigned> findSpecialRegister(StringRef Name);
std::optional<unsigned> findTrap(StringRef Name);

} // namespace llvm::TraxII

#endif
