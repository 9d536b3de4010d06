//===- trax-llc.cpp - Compiles LLVM IR -----------------------------------===//
//
//   trax-llc -O2 -filetype=obj -o a.o a.ll
//
// LLVM's own llc, for one target; it takes the same options of the code generator.
//
//===----------------------------------------------------------------------===//
#include "ToolSupport.h"
#include "llvm/CodeGen/CommandFlags.h"
#include "llvm/IR/DiagnosticInfo.h"
#include "llvm/IR/DiagnosticPrinter.h"
#include "llvm/IR/LLVMContext.h"
#include "llvm/IR/LegacyPassManager.h"
#include "llvm/IR/Module.h"
#include "llvm/IR/Verifier.h"
#include "llvm/IRReader/IRReader.h"
#include "llvm/InitializePasses.h"
#include "llvm/MC/TargetRegistry.h"
#include "llvm/PassRegistry.h"
#include "llvm/Support/CommandLine.h"
#include "llvm/Support/SourceMgr.h"
#include "llvm/Support/WithColor.h"
#include "llvm/Support/raw_ostream.h"
#include "llvm/Target/TargetMachine.h"

using namespace llvm;

static codegen::RegisterCodeGenFlags CodeGenFlags;
static cl::opt<std::string> Input(cl::Positional, cl::desc("<input IR>"), cl::init("-"));
static cl::opt<std::string> Output("o", cl::desc("Output file"), cl::value_desc("file"), cl::init("-"));
static cl::opt<char> OptLevel("O", cl::desc("Optimization level: 0 to 3 (default 2)"), cl::Prefix, cl::init('2'));
// Named as in llc, so that tests read alike. There is no other target.
static cl::opt<std::string> TargetTriple("mtriple", cl::desc("Target: trax"), cl::init("trax"));

namespace {

/// Counts errors, so that they fail the run without ending it at the first.
struct Diagnostics : public DiagnosticHandler {
  bool *HasErrors;
  explicit Diagnostics(bool *HasErrors) : HasErrors(HasErrors) {}

  bool handleDiagnostics(const DiagnosticInfo &DI) override {
    if (DI.getSeverity() == DS_Remark)
      return true;
    if (DI.getSeverity() == DS_Error)
      *HasErrors = true;
    raw_ostream &OS = DI.getSeverity() == DS_Error  ? WithColor::error()
                      : DI.getSeverity() == DS_Note ? WithColor::note()
                                                    : WithColor::warning();
    DiagnosticPrinterRawOStream Printer(OS);
    DI.print(Printer);
    OS << '\n';
    return true;
  }
};

} // namespace

int main(int Argc, char **Argv) {
  PassRegistry &Registry = *PassRegistry::getPassRegistry();
  initializeCore(Registry);
  initializeCodeGen(Registry);
  const Target &T = trax::startTool(Argc, Argv, "TRaX code generator for LLVM IR\n");
  if (Triple(TargetTriple).getArchName() != "trax")
    trax::fail("unknown target triple '" + TargetTriple + "'");
  std::optional<CodeGenOptLevel> Level = CodeGenOpt::parseLevel(OptLevel);
  if (!Level)
    trax::fail(Twine("invalid optimization level -O") + Twine(OptLevel));

  trax::checkFiles({Input}, Output);
  LLVMContext Context;
  bool HasErrors = false;
  Context.setDiagnosticHandler(std::make_unique<Diagnostics>(&HasErrors));
  Triple TT("trax");
  std::unique_ptr<TargetMachine> TM(T.createTargetMachine(
      TT.str(), codegen::getCPUStr(), codegen::getFeaturesStr(), codegen::InitTargetOptionsFromCodeGenFlags(TT),
      codegen::getExplicitRelocModel(), codegen::getExplicitCodeModel(), *Level));

  SMDiagnostic Problem;
  std::unique_ptr<Module> M =
      parseIRFile(Input, Problem, Context, ParserCallbacks([&](StringRef, StringRef) -> std::optional<std::string> {
                    return TM->createDataLayout().getStringRepresentation();
                  }));
  if (!M) {
    Problem.print(Argv[0], WithColor::error(errs(), Argv[0]));
    return 1;
  }
  if (verifyModule(*M, &errs()))
    trax::fail("'" + Input + "': the module is broken");
  M->setTargetTriple(TT.str());
  codegen::setFunctionAttributes(TM->getTargetCPU(), TM->getTargetFeatureString(), *M);

  SmallString<0> Bytes;
  raw_svector_ostream OS(Bytes);
  legacy::PassManager Passes;
  if (TM->addPassesToEmitFile(Passes, OS, nullptr, codegen::getFileType()))
    trax::fail("this kind of output is not supported");
  Passes.run(*M);
  if (HasErrors)
    return 1;
  trax::writeOutput(Output, Bytes);
  return trax::endTool(0);
}
