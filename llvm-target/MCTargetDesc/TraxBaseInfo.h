//===- TraxBaseInfo.h - Names for code generation and MC -----------------===//
#ifndef TRAX_MCTARGETDESC_TRAXBASEINFO_H
#define TRAX_MCTARGETDESC_TRAXBASEINFO_H

#include "llvm/ADT/StringRef.h"
#include <optional>

namespace llvm::TraxII {

/// Target flags of symbolic machine operands: which part of the address the instruction takes.
enum TargetFlag : unsigned { MO_None = 0, MO_HI, MO_LO, MO_ABS };

/// Names of special registers (rdsr), of traps and of fences, by number; empty where nothing has that number.
StringRef getSpecialRegisterName(unsigned Number);
StringRef getTrapName(unsigned Code);
StringRef getFenceName(unsigned Kind);
std::optional<unsigned> findSpecialRegister(StringRef Name);
std::optional<unsigned> findTrap(StringRef Name);
std::optional<unsigned> findFence(StringRef Name);

} // namespace llvm::TraxII

#endif
