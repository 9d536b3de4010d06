//===- TraxMachineFunctionInfo.h - State of a function's code generation --===//
#ifndef TRAX_TRAXMACHINEFUNCTIONINFO_H
#define TRAX_TRAXMACHINEFUNCTIONINFO_H

#include "llvm/CodeGen/MachineFunction.h"

namespace llvm {

class TraxMachineFunctionInfo : public MachineFunctionInfo {
  int VarArgsFrameIndex = 0;

public:
  TraxMachineFunctionInfo(const Function &, const TargetSubtargetInfo *) {}

  MachineFunctionInfo *clone(BumpPtrAllocator &, MachineFunction &DestMF,
                             const DenseMap<MachineBasicBlock *, MachineBasicBlock *> &) const override {
    return DestMF.cloneInfo<TraxMachineFunctionInfo>(*this);
  }

  /// The first unnamed argument of a variadic function.
  int getVarArgsFrameIndex() const { return VarArgsFrameIndex; }
  void setVarArgsFrameIndex(int Index) { VarArgsFrameIndex = Index; }
};

} // namespace llvm

#endif
