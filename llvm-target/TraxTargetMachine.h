//===- TraxTargetMachine.h - The parts of the target ------------------===//
#ifndef TRAX_TRAXTARGETMACHINE_H
#define TRAX_TRAXTARGETMACHINE_H

#include "TraxSubtarget.h"
#include "llvm/ADT/StringMap.h"
#include "llvm/Target/TargetLoweringObjectFile.h"
#include "llvm/Target/TargetMachine.h"
#include <optional>

namespace llvm {

class TraxTargetMachine : public LLVMTargetMachine {
  std::unique_ptr<TargetLoweringObjectFile> TLOF;
  mutable StringMap<std::unique_ptr<TraxSubtarget>> Subtargets; // by processor and features

public:
  TraxTargetMachine(const Target &T, const Triple &TT, StringRef CPU, StringRef FS, const TargetOptions &Options,
                    std::optional<Reloc::Model> RM, std::optional<CodeModel::Model> CM, CodeGenOptLevel OL, bool JIT);
  ~TraxTargetMachine() override;

  const TraxSubtarget *getSubtargetImpl(const Function &F) const override;
  // Without a function there is no subtarget.
  const TraxSubtarget *getSubtargetImpl() const = delete;
  TargetLoweringObjectFile *getObjFileLowering() const override { return TLOF.get(); }
  TargetPassConfig *createPassConfig(PassManagerBase &PM) override;
  TargetTransformInfo getTargetTransformInfo(const Function &F) const override;
  MachineFunctionInfo *createMachineFunctionInfo(BumpPtrAllocator &Allocator, const Function &F,
                                                 const TargetSubtargetInfo *STI) const override;
  void registerPassBuilderCallbacks(PassBuilder &PB) override;
  bool isNoopAddrSpaceCast(unsigned, unsigned) const override { return true; } // there is one address space
};

} // namespace llvm

#endif
