//===- TraxTargetMachine.cpp - Subtargets and the order of passes --------===//
#include "TraxTargetMachine.h"
#include "LLVMTrax.h"
#include "TargetInfo/TraxTargetInfo.h"
#include "Trax.h"
#include "TraxBuiltins.h"
#include "TraxMachineFunctionInfo.h"
#include "TraxNontemporal.h"
#include "TraxTargetTransformInfo.h"
#include "trax/abi.h"
#include "llvm/CodeGen/Passes.h"
#include "llvm/CodeGen/TargetLoweringObjectFileImpl.h"
#include "llvm/CodeGen/TargetPassConfig.h"
#include "llvm/MC/TargetRegistry.h"
#include "llvm/Passes/PassBuilder.h"
#include "llvm/Transforms/Scalar/LoopPassManager.h"
#include "llvm/Transforms/Scalar/LoopUnrollAndJamPass.h"

using namespace llvm;

void LLVMInitializeTraxTarget() {
  RegisterTargetMachine<TraxTargetMachine> X(getTheTraxTarget());
  PassRegistry &PR = *PassRegistry::getPassRegistry();
  initializeTraxBranchesPass(PR);
  initializeTraxDAGToDAGISelLegacyPass(PR);
  initializeTraxDivisionPass(PR);
  initializeTraxLoopsPass(PR);
  initializeTraxLowerAtomicsPass(PR);
  initializeTraxLowerFloatsPass(PR);
  initializeTraxLowerVAArgPass(PR);
}

TraxTargetMachine::TraxTargetMachine(const Target &T, const Triple &TT, StringRef CPU, StringRef FS,
                                     const TargetOptions &Options, std::optional<Reloc::Model>,
                                     std::optional<CodeModel::Model> CM, CodeGenOptLevel OL, bool)
    // Programs are linked statically at fixed addresses: position independence is accepted and without effect.
    : LLVMTargetMachine(T, TRAX_DATA_LAYOUT, TT, CPU, FS, Options, Reloc::Static,
                        getEffectiveCodeModel(CM, CodeModel::Small), OL),
      TLOF(std::make_unique<TargetLoweringObjectFileELF>()) {
  initAsmInfo();
  setCFIFixup(true);
}

TraxTargetMachine::~TraxTargetMachine() = default;

// A function's attributes may name its stack mode. Other functions have the command line's.
const TraxSubtarget *TraxTargetMachine::getSubtargetImpl(const Function &F) const {
  auto OwnOr = [&](StringRef Name, const std::string &Default) {
    const Attribute Own = F.getFnAttribute(Name);
    return Own.isValid() ? Own.getValueAsString().str() : Default;
  };
  const std::string CPU = OwnOr("target-cpu", TargetCPU), FS = OwnOr("target-features", TargetFS);
  std::unique_ptr<TraxSubtarget> &Found = Subtargets[CPU + "/" + FS];
  if (!Found)
    Found = std::make_unique<TraxSubtarget>(TargetTriple, CPU, FS, *this);
  return Found.get();
}

TargetTransformInfo TraxTargetMachine::getTargetTransformInfo(const Function &F) const {
  return TargetTransformInfo(TraxTTIImpl(this, F));
}

MachineFunctionInfo *TraxTargetMachine::createMachineFunctionInfo(BumpPtrAllocator &Allocator, const Function &F,
                                                                  const TargetSubtargetInfo *STI) const {
  return TraxMachineFunctionInfo::create<TraxMachineFunctionInfo>(Allocator, F, STI);
}

void TraxTargetMachine::registerPassBuilderCallbacks(PassBuilder &PB) {
  PB.registerPipelineStartEPCallback(
      [](ModulePassManager &MPM, OptimizationLevel) { MPM.addPass(TraxBuiltinsPass()); });
  TraxNontemporalPass::registerWith(PB);
  PB.registerVectorizerStartEPCallback([](FunctionPassManager &FPM, OptimizationLevel Level) {
    if (Level == OptimizationLevel::O3)
      FPM.addPass(createFunctionToLoopPassAdaptor(LoopUnrollAndJamPass(Level.getSpeedupLevel())));
  });
}

namespace {

class TraxPassConfig : public TargetPassConfig {
public:
  TraxPassConfig(TraxTargetMachine &TM, PassManagerBase &PM) : TargetPassConfig(TM, PM) {}

  TraxTargetMachine &getTraxTargetMachine() const { return getTM<TraxTargetMachine>(); }

  void addIRPasses() override {
    addPass(createTraxLowerFloatsPass());
    addPass(createTraxLowerVAArgPass());
    addPass(createAtomicExpandLegacyPass());
    addPass(createTraxLowerAtomicsPass());
    TargetPassConfig::addIRPasses();
    if (getOptLevel() == CodeGenOptLevel::Default)
      addPass(createTraxLoopsPass());
  }

  void addCodeGenPrepare() override {
    // Loops over bytes and halves keep them as words: no extension at each comparison.
    if (getOptLevel() != CodeGenOptLevel::None)
      addPass(createTypePromotionLegacyPass());
    TargetPassConfig::addCodeGenPrepare();
  }

  bool addPreISel() override {
    if (getOptLevel() >= CodeGenOptLevel::Default)
      addPass(createTraxDivisionPass());
    if (getOptLevel() != CodeGenOptLevel::None)
      addPass(createTraxBranchesPass());
    return false;
  }

  bool addInstSelector() override {
    addPass(createTraxISelDag(getTraxTargetMachine(), getOptLevel()));
    return false;
  }

  void addPreEmitPass() override {
    // Copies are addi at this point. Removes those that block placement moved next to their uses.
    if (getOptLevel() >= CodeGenOptLevel::Default)
      addPass(createMachineCopyPropagationPass(/*UseCopyInstr=*/true));
    addPass(&BranchRelaxationPassID);
  }

  // Runs last, when the order of blocks is final. Repeats the frame's CFI for a block that follows an epilogue.
  void addPreEmitPass2() override { addPass(createCFIInstrInserter()); }
};

} // namespace

TargetPassConfig *TraxTargetMachine::createPassConfig(PassManagerBase &PM) {
  return new TraxPassConfig(*this, PM);
}
