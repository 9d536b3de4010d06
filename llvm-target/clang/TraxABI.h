//===- TraxABI.h - how aggregates are passed -----------------------------===//
#ifndef TRAX_CLANG_TRAXABI_H
#define TRAX_CLANG_TRAXABI_H

namespace trax {

/// Replaces the calling convention that clang has for architectures it does not know (aggregates always through memory)
/// by that of docs/abi.md (up to four words in registers). For the rest of the process; call it before code is
/// generated, and only when compiling for Trax.
void installABI();

} // namespace trax

#endif
