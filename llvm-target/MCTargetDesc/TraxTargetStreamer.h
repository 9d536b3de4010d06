//===- TraxTargetStreamer.h - The directive .stack; limits of symbols ----===//
#ifndef TRAX_MCTARGETDESC_TRAXTARGETSTREAMER_H
#define TRAX_MCTARGETDESC_TRAXTARGETSTREAMER_H

#include "llvm/ADT/DenseMap.h"
#include "llvm/MC/MCStreamer.h"

namespace llvm {

class Target;

/// Keeps where the code of the file expects the stack: TRAX_EF_STACK_LOCAL, TRAX_EF_STACK_GLOBAL, or 0 if it does not
/// depend on it (docs/abi.md, "ELF").
class TraxTargetStreamer : public MCTargetStreamer {
  unsigned Stack = 0;
  DenseMap<const MCSymbol *, uint64_t> Steps; // references that the evaluation of a symbol follows
  uint64_t AllSteps = 0;

  uint64_t stepsOf(const MCExpr &Value) const;

public:
  using MCTargetStreamer::MCTargetStreamer;
  void emitAssignment(MCSymbol *Symbol, const MCExpr *Value) override;

  /// False if an earlier directive of the file differs.
  bool setStack(unsigned Place);

protected:
  virtual void emitStack(unsigned) {}
};

void registerTraxTargetStreamers(Target &T);

} // namespace llvm

#endif
