//===- TraxMCAsmInfo.h - Assembly syntax ---------------------------------===//
#ifndef TRAX_MCTARGETDESC_TRAXMCASMINFO_H
#define TRAX_MCTARGETDESC_TRAXMCASMINFO_H

#include "llvm/MC/MCAsmInfoELF.h"

namespace llvm {

class Triple;

class TraxMCAsmInfo : public MCAsmInfoELF {
public:
  explicit TraxMCAsmInfo(const Triple &TT);
};

} // namespace llvm

#endif
