//===- Main.cpp - the clang that also compiles for Trax ------------------===//
//
// Clang's driver and front end come from its shared library; this program adds a target that the library does not have.
// `clang --target=trax` compiles, assembles and links for the machine; any other target behaves as in clang.
//
//===----------------------------------------------------------------------===//

#include "CC1.h"
#include "FileCalls.h"
#include "LLVMTrax.h"
#include "TraxOptions.h"
#include "TraxTargetInfo.h"
#include "TraxToolChain.h"
#include "trax/files.h"
#include "trax/reads.h"
#include "trax/signals.h"
#include "trax/version.h"
#include "clang/Basic/DiagnosticDriver.h"
#include "clang/Basic/DiagnosticOptions.h"
#include "clang/Driver/Compilation.h"
#include "clang/Driver/Driver.h"
#include "clang/Driver/Options.h"
#include "clang/Driver/ToolChain.h"
#include "clang/Frontend/CompilerInvocation.h"
#include "clang/Frontend/TextDiagnosticPrinter.h"
#include "llvm/ADT/StringSet.h"
#include "llvm/Support/CommandLine.h"
#include "llvm/Support/CrashRecoveryContext.h"
#include "llvm/Support/FileSystem.h"
#include "llvm/Support/InitLLVM.h"
#include "llvm/Support/Path.h"
#include "llvm/Support/Process.h"
#include "llvm/Support/Signals.h"
#include "llvm/Support/TargetSelect.h"
#include "llvm/Support/Timer.h"
#include "llvm/Support/VirtualFileSystem.h"
#include "llvm/TargetParser/Host.h"

#include <csignal>
#include <cstdlib>
#include <string>
#include <unistd.h>

using namespace clang;
using namespace clang::driver;
using llvm::StringRef;

namespace {

using ArgVector = llvm::SmallVector<const char *, 256>;

void initializeTargets() {
  llvm::InitializeAllTargets();
  llvm::InitializeAllTargetMCs();
  llvm::InitializeAllAsmPrinters();
  llvm::InitializeAllAsmParsers();
  LLVMInitializeTrax();
}

/// The folders of the installation, found from the program's own place.
struct Installation {
  std::string Program;     // this executable
  std::string RuntimeDir;  // crt0.o, libc.a, include/
  std::string ResourceDir; // clang's own headers

  Installation(const char *Argv0, bool Canonical) {
    static int Anchor; // an address within this executable
    Program = Canonical ? llvm::sys::fs::getMainExecutable(Argv0, &Anchor) : Argv0;
    if (!Canonical && !llvm::sys::fs::exists(Program))
      if (llvm::ErrorOr<std::string> Found = llvm::sys::findProgramByName(Program))
        Program = *Found;
    llvm::SmallString<128> Prefix(Program);
    llvm::sys::fs::make_absolute(Prefix);
    const StringRef Root = llvm::sys::path::parent_path(llvm::sys::path::parent_path(Prefix));
    RuntimeDir = (Root + "/lib/trax").str();
    ResourceDir = (Root + "/lib/clang/" TRAX_CLANG_MAJOR).str();
    if (!llvm::sys::fs::exists(ResourceDir + "/include/stddef.h"))
      ResourceDir = TRAX_CLANG_RESOURCE_DIR; // Debian's, as found when this was built
  }
};

bool hasArgument(llvm::ArrayRef<const char *> Args, StringRef Name) {
  return llvm::any_of(Args.drop_front(), [&](const char *Given) { return Given && Name == Given; });
}

/// Runs a -cc1 or -cc1as command line in this process.
int runTool(llvm::SmallVectorImpl<const char *> &Args) {
  llvm::cl::ResetAllOptionOccurrences(); // -mllvm options of an earlier compilation in this process
  llvm::BumpPtrAllocator Allocator;
  if (llvm::Error Error = expandResponseFiles(Args, /*ClangCLMode=*/false, Allocator)) {
    llvm::errs() << toString(std::move(Error)) << '\n';
    return 1;
  }
  const StringRef Tool = Args[1];
  const auto Rest = llvm::ArrayRef(Args).drop_front(2);
  if (Tool == "-cc1" || Tool == "-cc1as") {
    const void *const Before = trax::outputsSoFar(); // of the driver, if it is this process
    const int Result = Tool == "-cc1" ? trax::runCC1(Rest, Args[0]) : trax::runCC1As(Rest, Args[0]);
    // After errors, too: diagnostics may be an output.
    return trax::commitOutputs("clang", /*Keep=*/true, Before) ? Result : 1;
  }
  llvm::errs() << "error: unknown integrated tool '" << Tool << "'. Valid tools include '-cc1' and '-cc1as'.\n";
  return 1;
}

/// A single compilation runs within this process when a link follows it, too: the driver starts a second process then,
/// for which the libraries are loaded and relocated again, and that takes longer than to compile a small file. Only a
/// process of its own can be measured, though.
void compileInProcess(Driver &TheDriver, Compilation &C) {
  const auto IsCompilation = [](const Command &Job) { return StringRef(Job.getCreator().getName()) == "clang"; };
  const bool IsMeasured = TheDriver.CCPrintProcessStats ||
                          C.getArgs().hasArg(options::OPT_fproc_stat_report, options::OPT_fproc_stat_report_EQ);
  if (TheDriver.CC1Main && !IsMeasured && llvm::count_if(C.getJobs(), IsCompilation) == 1)
    for (Command &Job : C.getJobs())
      Job.InProcess |= IsCompilation(Job);
}

/// Runs the jobs. After a crash the files that reproduce it remain, as clang leaves them.
int execute(Driver &TheDriver, Compilation &C, bool &Crashed) {
  for (const char *Temporary : C.getTempFiles()) // the driver removes them itself only if it ends by itself
    llvm::sys::RemoveFileOnSignal(Temporary);
  trax_reads_share();                                                       // what one job reads, no other may write
  setenv("TRAX_PARENT", std::to_string(getpid()).c_str(), /*overwrite=*/1); // what is started ends with this process
  if (trax::isTraxTriple(C.getDefaultToolChain().getTriple())) // no job leaves a partial file, so none is removed
    for (const ArgStringMap *Files : {&C.getResultFiles(), &C.getFailureResultFiles()})
      const_cast<ArgStringMap *>(Files)->clear();
  compileInProcess(TheDriver, C);
  llvm::SmallVector<std::pair<int, const Command *>, 4> Failures;
  int Result = TheDriver.ExecuteCompilation(C, Failures);
  for (const auto &[Status, Failed] : Failures) {
    if (!Result)
      Result = Status;
    constexpr int FatalError = 70; // EX_SOFTWARE, which -cc1 exits with after an internal error
    if (Status < 0 || Status == FatalError || Status > 128) {
      Crashed = true;
      TheDriver.maybeGenerateCompilationDiagnostics(Driver::CommandStatus::Crash, Driver::ReproLevel::OnCrash, C,
                                                    *Failed);
      break;
    }
  }
  return Result;
}

/// Reports an output that is an input or is written by two jobs, before anything runs. Included files, and the outputs
/// of other options, are compared when they are written (FileCalls.h).
void checkFiles(Compilation &C, DiagnosticsEngine &Diags) {
  trax_files Files = {};
  trax_error Reason;
  for (const std::string &Input : C.getArgs().getAllArgValues(options::OPT_INPUT))
    trax_files_input(&Files, nullptr, Input.c_str());
  for (const unsigned Id : {options::OPT_fprofile_sample_use_EQ, options::OPT_fprofile_instr_use_EQ,
                            options::OPT_fprofile_use_EQ, options::OPT_include, options::OPT_imacros})
    for (const std::string &Input : C.getArgs().getAllArgValues(Id)) // some are read only with other options
      trax_files_input(&Files, nullptr, Input.c_str());
  for (const Command &Job : C.getJobs())
    for (const std::string &Output : Job.getOutputFilenames())
      if (!Output.empty() && !llvm::is_contained(C.getTempFiles(), Output))
        trax_files_output(&Files, "-o", Output.c_str());
  for (const unsigned Id :
       {options::OPT_MF, options::OPT_MJ, options::OPT__serialize_diags, options::OPT_ftime_trace_EQ,
        options::OPT_fproc_stat_report_EQ, options::OPT_foptimization_record_file_EQ})
    if (const llvm::opt::Arg *Other = C.getArgs().getLastArgNoClaim(Id))
      trax_files_output(&Files, Other->getSpelling().str().c_str(), Other->getValue());
  if (trax_files_check(&Files, &Reason) != TRAX_OK)
    Diags.Report(Diags.getCustomDiagID(DiagnosticsEngine::Error, "%0")) << Reason.message;
  trax_files_release(&Files);
}

/// The value of --sysroot, from the command line or a configuration file. Needed for -print-search-dirs, because the
/// driver prints the folders before it asks a tool chain.
std::string findSysRoot(const Installation &Installed, const ParsedClangName &Name, ArgVector Args) {
  llvm::erase_if(Args, [](StringRef Given) { return Given.ltrim('-') == "print-search-dirs"; });
  DiagnosticsEngine Silent(new DiagnosticIDs(), new DiagnosticOptions(), new IgnoringDiagConsumer());
  Driver Probe(Installed.Program, llvm::sys::getDefaultTargetTriple(), Silent);
  Probe.ResourceDir = Installed.ResourceDir;
  Probe.setTargetAndMode(Name);
  trax::addToolChains(Probe, Installed.RuntimeDir);
  std::unique_ptr<Compilation> Unused(Probe.BuildCompilation(Args));
  return Probe.SysRoot;
}

/// Runs the driver. Executed: whether its jobs ran.
int drive(ArgVector Args, llvm::StringSaver &Strings, bool &Executed) {
  const Installation Installed(Args[0], !hasArgument(Args, "-no-canonical-prefixes"));

  ParsedClangName Name = ToolChain::getTargetAndModeFromProgramName(Args[0]);
  // Our target answers to every architecture that LLVM does not know, but `my-clang` is no target.
  const llvm::Triple Prefix(llvm::Triple::normalize(Name.TargetPrefix));
  if (Prefix.getArch() == llvm::Triple::UnknownArch && !trax::isTraxTriple(Prefix))
    Name.TargetIsValid = false;
  if (Name.DriverMode) // clang++
    Args.insert(Args.begin() + 1, Name.DriverMode);
  if (Name.TargetIsValid)
    Args.insert(Args.begin() + 1, Strings.save("--target=" + Name.TargetPrefix).data());

  IntrusiveRefCntPtr<DiagnosticOptions> DiagOptions(CreateAndPopulateDiagOpts(Args));
  auto *Printer = new TextDiagnosticPrinter(llvm::errs(), &*DiagOptions);
  Printer->setPrefix(llvm::sys::path::stem(Args[0]).str());
  DiagnosticsEngine Diags(new DiagnosticIDs(), &*DiagOptions, Printer);
  ProcessWarningOptions(Diags, *DiagOptions, /*ReportDiags=*/false);

  Driver TheDriver(Installed.Program, llvm::sys::getDefaultTargetTriple(), Diags);
  TheDriver.ResourceDir = Installed.ResourceDir;
  TheDriver.setTargetAndMode(Name);
  trax::addOptions();
  if (hasArgument(Args, "-print-search-dirs") || hasArgument(Args, "--print-search-dirs"))
    TheDriver.SysRoot = findSysRoot(Installed, Name, Args);
  trax::addToolChains(TheDriver, Installed.RuntimeDir);
  auto CC1 = [](llvm::SmallVectorImpl<const char *> &ToolArgs) { return runTool(ToolArgs); };
  if (!hasArgument(Args, "-fno-integrated-cc1")) {
    TheDriver.CC1Main = CC1;
    llvm::CrashRecoveryContext::Enable(); // a crash within this process must not end the driver
  }

  std::unique_ptr<Compilation> C(TheDriver.BuildCompilation(Args));
  if (hasArgument(Args, "--version"))
    llvm::outs() << "TRaX " TRAX_VERSION ", with the target trax\n";
  if (C && trax::isTraxTriple(C->getDefaultToolChain().getTriple()))
    checkFiles(*C, Diags);
  int Result = 1;
  bool Crashed = false;
  Executed = C && !C->containsError() && !Diags.hasErrorOccurred();
  if (Executed)
    Result = execute(TheDriver, *C, Crashed);
  Diags.getClient()->finish();
  // After a crash, LLVM's list still has timers of the lost stack. Going through it may never end.
  if (Crashed) {
    C.reset(); // and its temporary files
    llvm::outs().flush();
    llvm::sys::Process::Exit(Result, /*NoCleanup=*/true);
  }
  llvm::TimerGroup::printAll(llvm::errs());
  return Result;
}

} // namespace

int main(int Argc, char **Argv) {
  const llvm::InitLLVM Init(Argc, Argv);
  signal(SIGXFSZ, SIG_IGN); // LLVM takes the signal of a file beyond the size limit for a crash
  llvm::setBugReportMsg("PLEASE attach the command line, the preprocessed source and this trace to a bug report.\n");
  if (llvm::sys::Process::FixupStandardFileDescriptors())
    return 1;
  initializeTargets();

  ArgVector Args(Argv, Argv + Argc);
  if (Args.size() > 1 && StringRef(Args[1]).starts_with("-cc1"))
    trax_end_with_parent(); // the driver that waits for it
  if (Args.size() > 1 && StringRef(Args[1]).starts_with("-cc1"))
    return runTool(Args);

  llvm::BumpPtrAllocator Allocator;
  llvm::StringSaver Strings(Allocator);
  if (llvm::Error Error = expandResponseFiles(Args, /*ClangCLMode=*/false, Allocator)) {
    llvm::errs() << llvm::sys::path::stem(Args[0]) << ": error: " << toString(std::move(Error)) << '\n';
    return 1;
  }
  llvm::StringSet<> Overrides;
  if (const char *Edits = std::getenv("CCC_OVERRIDE_OPTIONS"))
    applyOverrideOptions(Args, Edits, Overrides, &llvm::errs());
  bool Executed = false;
  const int Result = drive(Args, Strings, Executed);
  return trax::commitOutputs("clang", Executed) ? Result : 1;
}
