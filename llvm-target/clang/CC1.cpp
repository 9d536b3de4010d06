//===- CC1.cpp - clang -cc1 ----------------------------------------------===//
//
// For Trax the target is ours, which clang's own CompilerInstance::ExecuteAction cannot create; its steps are done here
// around createTargetInfo. Every other target goes to clang's library unchanged.
//
//===----------------------------------------------------------------------===//

#include "CC1.h"
#include "FileCalls.h"
#include "TraxABI.h"
#include "TraxAsmGuard.h"
#include "TraxTargetInfo.h"
#include "clang/Basic/DiagnosticFrontend.h"
#include "clang/Basic/FileManager.h"
#include "clang/Basic/TargetOptions.h"
#include "clang/CodeGen/ObjectFilePCHContainerOperations.h"
#include "clang/Frontend/CompilerInstance.h"
#include "clang/Frontend/CompilerInvocation.h"
#include "clang/Frontend/FrontendAction.h"
#include "clang/Frontend/TextDiagnosticBuffer.h"
#include "clang/FrontendTool/Utils.h"
#include "llvm/ADT/ScopeExit.h"
#include "llvm/ADT/Statistic.h"
#include "llvm/MC/TargetRegistry.h"
#include "llvm/Support/BuryPointer.h"
#include "llvm/Support/CommandLine.h"
#include "llvm/Support/ErrorHandling.h"
#include "llvm/Support/ManagedStatic.h"
#include "llvm/Support/Process.h"
#include "llvm/Support/Signals.h"
#include "llvm/Support/TimeProfiler.h"
#include "llvm/Support/Timer.h"
#include "llvm/Target/TargetMachine.h"

#include <unistd.h>

using namespace clang;
using llvm::StringRef;

namespace {

void parseBackendOptions(llvm::ArrayRef<std::string> Options) {
  if (Options.empty())
    return;
  llvm::SmallVector<const char *, 16> Args{"clang (LLVM option parsing)"};
  for (const std::string &Option : Options)
    Args.push_back(Option.c_str());
  Args.push_back(nullptr);
  llvm::cl::ParseCommandLineOptions(Args.size() - 1, Args.data());
}

bool createTarget(CompilerInstance &CI) {
  DiagnosticsEngine &Diags = CI.getDiagnostics();
  CI.setTarget(trax::createTargetInfo(Diags, CI.getInvocation().TargetOpts).get());
  if (!CI.hasTarget())
    return false;

  LangOptions &Lang = CI.getLangOpts();
  if (!CI.getTarget().hasStrictFP() && !Lang.ExpStrictFP) {
    if (Lang.RoundingMath) {
      Diags.Report(diag::warn_fe_backend_unsupported_fp_rounding);
      Lang.RoundingMath = false;
    }
    const auto Exceptions = Lang.getFPExceptionMode();
    if (Exceptions != LangOptions::FPE_Default && Exceptions != LangOptions::FPE_Ignore) {
      Diags.Report(diag::warn_fe_backend_unsupported_fp_exceptions);
      Lang.setFPExceptionMode(LangOptions::FPE_Ignore);
    }
  }
  CI.getTarget().adjust(Diags, Lang);
  return true;
}

void writeStatistics(CompilerInstance &CI) {
  if (CI.getFrontendOpts().ShowStats) {
    CI.getFileManager().PrintStats();
    llvm::errs() << '\n';
  }
  const StringRef Path = CI.getFrontendOpts().StatsFile;
  if (Path.empty())
    return;
  std::error_code Error;
  const auto Flags = CI.getFrontendOpts().AppendStats ? llvm::sys::fs::OF_Append : llvm::sys::fs::OF_None;
  llvm::raw_fd_ostream Out(Path, Error, Flags | llvm::sys::fs::OF_Text);
  if (Error)
    CI.getDiagnostics().Report(diag::warn_fe_unable_to_open_stats_file) << Path << Error.message();
  else
    llvm::PrintStatisticsJSON(Out);
}

bool compileForTrax(CompilerInstance &CI) {
  CI.LoadRequestedPlugins();
  parseBackendOptions(CI.getFrontendOpts().LLVMArgs);
  std::unique_ptr<FrontendAction> Action = CreateFrontendAction(CI);
  if (CI.getDiagnostics().hasErrorOccurred() || !Action)
    return false;

  auto FinishDiagnostics = llvm::make_scope_exit([&] { CI.getDiagnosticClient().finish(); });
  if (!Action->PrepareToExecute(CI) || !createTarget(CI))
    return false;
  trax::installABI();

  if (CI.getHeaderSearchOpts().Verbose)
    llvm::errs() << "clang -cc1 for " << CI.getTarget().getTriple().str() << '\n';
  if (CI.getCodeGenOpts().TimePasses)
    CI.createFrontendTimer();
  if (CI.getFrontendOpts().ShowStats || !CI.getFrontendOpts().StatsFile.empty())
    llvm::EnableStatistics(/*DoPrintOnExit=*/false);

  for (const FrontendInputFile &Input : CI.getFrontendOpts().Inputs) {
    if (Input.getKind().getFormat() == InputKind::Precompiled) { // the library would create its target itself
      CI.getDiagnostics().Report(CI.getDiagnostics().getCustomDiagID(
          DiagnosticsEngine::Error, "%0: compiled modules and syntax trees are not supported for the target 'trax'"))
          << Input.getFile();
      continue;
    }
    if (CI.hasSourceManager() && !Action->isModelParsingAction())
      CI.getSourceManager().clearIDTables();
    if (!Action->BeginSourceFile(CI, Input))
      continue;
    if (llvm::Error Error = Action->Execute())
      llvm::consumeError(std::move(Error)); // diagnosed already
    Action->EndSourceFile();
  }
  CI.printDiagnosticStats();
  writeStatistics(CI);

  const bool Success = !CI.getDiagnostics().getClient()->getNumErrors();
  if (CI.getFrontendOpts().DisableFree)
    llvm::BuryPointer(std::move(Action));
  return Success;
}

/// -print-supported-cpus. A target machine prints them when its features ask for help; ours has one processor and does
/// not.
int printSupportedCPUs(StringRef Triple) {
  if (trax::isTraxTriple(llvm::Triple(Triple))) {
    llvm::errs() << "Available CPUs for this target:\n\n\tgeneric\n";
    return 0;
  }
  std::string Error;
  const llvm::Target *Target = llvm::TargetRegistry::lookupTarget(Triple, Error);
  if (!Target) {
    llvm::errs() << Error << '\n';
    return 1;
  }
  delete Target->createTargetMachine(Triple, "", "+cpuhelp", llvm::TargetOptions(), std::nullopt);
  return 0;
}

bool writeTimeTrace(CompilerInstance &CI) {
  llvm::SmallString<128> Path(CI.getFrontendOpts().TimeTracePath);
  // Diagnostics have ended here, but this step may still fail, and createOutputFile must report it.
  auto Out = CI.createOutputFile(Path, /*Binary=*/false, /*RemoveFileOnSignal=*/false, /*UseTemporary=*/false);
  if (Out)
    llvm::timeTraceProfilerWrite(*Out);
  llvm::timeTraceProfilerCleanup();
  CI.clearOutputFiles(/*EraseFiles=*/false);
  return Out != nullptr;
}

} // namespace

void trax::reportFatalError(void *Diags, const char *Message, bool GenCrashDiag) {
  auto &Engine = *static_cast<DiagnosticsEngine *>(Diags);
  Engine.Report(GenCrashDiag ? unsigned(diag::err_fe_error_backend)
                             : Engine.getCustomDiagID(DiagnosticsEngine::Error, "%0"))
      << Message;
  llvm::sys::RunInterruptHandlers(); // removes outputs half written
  if (!GenCrashDiag)                 // as of a full disk; Process::Exit would print a trace within the driver's process
    _exit(1);
  llvm::sys::Process::Exit(70, /*NoCleanup=*/true);
}

int trax::runCC1(llvm::ArrayRef<const char *> Args, const char *Argv0) {
  auto CI = std::make_unique<CompilerInstance>();
  CI->getPCHContainerOperations()->registerWriter(std::make_unique<ObjectFilePCHContainerWriter>());
  CI->getPCHContainerOperations()->registerReader(std::make_unique<ObjectFilePCHContainerReader>());

  // Errors in the arguments wait until the arguments say how to print them.
  IntrusiveRefCntPtr<DiagnosticOptions> BufferOptions(new DiagnosticOptions());
  auto *Buffer = new TextDiagnosticBuffer;
  DiagnosticsEngine BufferedDiags(new DiagnosticIDs(), &*BufferOptions, Buffer);
  bool Success = CompilerInvocation::CreateFromArgs(CI->getInvocation(), Args, BufferedDiags, Argv0);

  FrontendOptions &Options = CI->getFrontendOpts();
  if (!Options.TimeTracePath.empty())
    llvm::timeTraceProfilerInitialize(Options.TimeTraceGranularity, Argv0);
  const StringRef Triple = CI->getTargetOpts().Triple;
  if (Options.PrintSupportedCPUs)
    return printSupportedCPUs(Triple);

  CI->createDiagnostics();
  if (!CI->hasDiagnostics())
    return 1;
  llvm::ScopedFatalErrorHandler FatalErrors(trax::reportFatalError, &CI->getDiagnostics());
  Buffer->FlushDiagnostics(CI->getDiagnostics());
  if (!Success) {
    CI->getDiagnosticClient().finish();
    return 1;
  }

  followRule(isTraxTriple(llvm::Triple(Triple)));
  // For a source the driver keeps what reproduces a crash. Bitcode is guarded, because LLVM does not check all of it.
  const bool FromIR = llvm::any_of(Options.Inputs, [](const FrontendInputFile &Input) {
    return Input.getKind().getLanguage() == Language::LLVM_IR;
  });
  if (isTraxTriple(llvm::Triple(Triple)))
    guardCrashes("clang", FromIR);
  const bool NeedsTarget = !Options.ShowHelp && !Options.ShowVersion;
  if (NeedsTarget && isTraxTriple(llvm::Triple(Triple)))
    Success = compileForTrax(*CI);
  else
    Success = ExecuteCompilerInvocation(CI.get());

  llvm::TimerGroup::printAll(llvm::errs());
  llvm::TimerGroup::clearAll();
  if (llvm::timeTraceProfilerEnabled())
    Success = writeTimeTrace(*CI) && Success;
  if (CI->getFrontendOpts().DisableFree)
    llvm::BuryPointer(std::move(CI)); // the process is about to end
  return !Success;
}
