//===- CC1As.cpp - clang -cc1as ------------------------------------------===//
//
// Assembles one file with LLVM's integrated assembler. Clang has this in its program only, in no library.
//
//===----------------------------------------------------------------------===//

#include "CC1.h"
#include "TraxAsmGuard.h"
#include "TraxTargetInfo.h"
#include "trax/output.h"
#include "clang/Basic/Diagnostic.h"
#include "clang/Basic/DiagnosticDriver.h"
#include "clang/Basic/DiagnosticFrontend.h"
#include "clang/Driver/Options.h"
#include "clang/Frontend/TextDiagnosticPrinter.h"
#include "clang/Frontend/Utils.h"
#include "llvm/ADT/StringSwitch.h"
#include "llvm/MC/MCAsmBackend.h"
#include "llvm/MC/MCAsmInfo.h"
#include "llvm/MC/MCCodeEmitter.h"
#include "llvm/MC/MCContext.h"
#include "llvm/MC/MCInstPrinter.h"
#include "llvm/MC/MCInstrInfo.h"
#include "llvm/MC/MCObjectFileInfo.h"
#include "llvm/MC/MCObjectWriter.h"
#include "llvm/MC/MCParser/MCAsmParser.h"
#include "llvm/MC/MCParser/MCTargetAsmParser.h"
#include "llvm/MC/MCRegisterInfo.h"
#include "llvm/MC/MCStreamer.h"
#include "llvm/MC/MCSubtargetInfo.h"
#include "llvm/MC/TargetRegistry.h"
#include "llvm/Option/ArgList.h"
#include "llvm/Option/OptTable.h"
#include "llvm/Support/CommandLine.h"
#include "llvm/Support/ErrorHandling.h"
#include "llvm/Support/FileSystem.h"
#include "llvm/Support/FormattedStream.h"
#include "llvm/Support/MemoryBuffer.h"
#include "llvm/Support/SourceMgr.h"
#include "llvm/TargetParser/Host.h"

using namespace clang;
using namespace clang::driver;
using llvm::StringRef;

namespace {

enum class OutputKind { Assembly, Null, Object };

OutputKind outputKind(const llvm::opt::ArgList &Args, DiagnosticsEngine &Diags) {
  const StringRef Name = Args.getLastArgValue(options::OPT_filetype, "asm");
  const auto Kind = llvm::StringSwitch<std::optional<OutputKind>>(Name)
                        .Case("asm", OutputKind::Assembly)
                        .Case("null", OutputKind::Null)
                        .Case("obj", OutputKind::Object)
                        .Default(std::nullopt);
  if (!Kind)
    Diags.Report(diag::err_drv_invalid_value) << "-filetype" << Name;
  return Kind.value_or(OutputKind::Null);
}

void checkArguments(const llvm::opt::InputArgList &Args, unsigned MissingIndex, unsigned MissingCount,
                    DiagnosticsEngine &Diags) {
  if (MissingCount)
    Diags.Report(diag::err_drv_missing_argument) << Args.getArgString(MissingIndex) << MissingCount;
  for (const llvm::opt::Arg *Unknown : Args.filtered(options::OPT_UNKNOWN))
    Diags.Report(diag::err_drv_unknown_argument) << Unknown->getAsString(Args);
  bool HasInput = false;
  for (const llvm::opt::Arg *Input : Args.filtered(options::OPT_INPUT)) {
    if (HasInput)
      Diags.Report(diag::err_drv_unknown_argument) << Input->getAsString(Args);
    HasInput = true;
  }
}

/// Applies `-g` and related options to an assembly file.
void setUpDebugInfo(llvm::MCContext &Context, const llvm::opt::ArgList &Args, StringRef InputPath, StringRef Source,
                    DiagnosticsEngine &Diags) {
  Context.setGenDwarfForAssembly(Args.hasArg(options::OPT_debug_info_kind_EQ));
  Context.setDwarfVersion(getLastArgIntValue(Args, options::OPT_dwarf_version_EQ, 4, Diags));
  Context.setDwarfFormat(Args.hasArg(options::OPT_gdwarf64) ? llvm::dwarf::DWARF64 : llvm::dwarf::DWARF32);
  const StringRef Flags = Args.getLastArgValue(options::OPT_dwarf_debug_flags);
  if (!Flags.empty())
    Context.setDwarfDebugFlags(Flags);
  const StringRef Producer = Args.getLastArgValue(options::OPT_dwarf_debug_producer);
  if (!Producer.empty())
    Context.setDwarfDebugProducer(Producer);
  if (const auto *Directory =
          Args.getLastArg(options::OPT_ffile_compilation_dir_EQ, options::OPT_fdebug_compilation_dir_EQ))
    Context.setCompilationDir(Directory->getValue());
  else if (llvm::SmallString<128> Current; !llvm::sys::fs::current_path(Current))
    Context.setCompilationDir(Current);
  for (const std::string &Map : Args.getAllArgValues(options::OPT_fdebug_prefix_map_EQ)) {
    const auto [From, To] = StringRef(Map).split('=');
    Context.addDebugPrefixMapEntry(From.str(), To.str());
  }
  const StringRef MainFile = Args.getLastArgValue(options::OPT_main_file_name);
  if (!MainFile.empty())
    Context.setMainFileName(MainFile);
  if (Context.getGenDwarfForAssembly())
    Context.setGenDwarfRootFile(InputPath, Source);
}

/// -Wa,--defsym,NAME=VALUE
void defineSymbols(llvm::MCContext &Context, llvm::MCStreamer &Streamer, const llvm::opt::ArgList &Args,
                   DiagnosticsEngine &Diags) {
  for (const std::string &Definition : Args.getAllArgValues(options::OPT_defsym)) {
    const auto [Name, Text] = StringRef(Definition).split('=');
    int64_t Value;
    if (Text.getAsInteger(0, Value))
      Diags.Report(diag::err_drv_invalid_value) << "--defsym" << Definition;
    else
      Streamer.emitAssignment(Context.getOrCreateSymbol(Name), llvm::MCConstantExpr::create(Value, Context));
  }
}

llvm::MCTargetOptions targetOptions(const llvm::opt::ArgList &Args) {
  llvm::MCTargetOptions Options;
  Options.MCRelaxAll = Args.hasArg(options::OPT_mrelax_all);
  Options.MCSaveTempLabels = Args.hasArg(options::OPT_msave_temp_labels);
  Options.MCFatalWarnings = Args.hasArg(options::OPT_massembler_fatal_warnings);
  Options.MCNoWarn = Args.hasArg(options::OPT_massembler_no_warn);
  if (const auto *Compress = Args.getLastArg(options::OPT_compress_debug_sections_EQ))
    Options.CompressDebugSections = llvm::StringSwitch<llvm::DebugCompressionType>(Compress->getValue())
                                        .Case("zlib", llvm::DebugCompressionType::Zlib)
                                        .Case("zstd", llvm::DebugCompressionType::Zstd)
                                        .Default(llvm::DebugCompressionType::None);
  return Options;
}

bool assemble(const llvm::opt::InputArgList &Args, DiagnosticsEngine &Diags) {
  std::string TripleName = Args.getLastArgValue(options::OPT_triple).str();
  if (TripleName.empty())
    TripleName = llvm::sys::getDefaultTargetTriple();
  const llvm::Triple Triple(llvm::Triple::normalize(TripleName));
  std::string Error;
  const llvm::Target *Target = llvm::TargetRegistry::lookupTarget(Triple.str(), Error);
  // Our target answers to every architecture that LLVM does not know.
  if (!Target || !Target->hasMCAsmParser() ||
      (Triple.getArch() == llvm::Triple::UnknownArch && !trax::isTraxTriple(Triple)))
    return Diags.Report(diag::err_target_unknown_triple) << Triple.str(), false;

  const std::string InputPath = Args.getLastArgValue(options::OPT_INPUT, "-").str();
  auto Buffer = llvm::MemoryBuffer::getFileOrSTDIN(InputPath, /*IsText=*/true);
  if (!Buffer)
    return Diags.Report(diag::err_fe_error_reading) << InputPath << Buffer.getError().message(), false;
  llvm::SourceMgr Sources;
  trax::limitAssembly(Sources);
  const unsigned Source = Sources.AddNewSourceBuffer(std::move(*Buffer), llvm::SMLoc());
  Sources.setIncludeDirs(Args.getAllArgValues(options::OPT_I));

  const llvm::MCTargetOptions Options = targetOptions(Args);
  const std::unique_ptr<llvm::MCRegisterInfo> Registers(Target->createMCRegInfo(Triple.str()));
  const std::unique_ptr<llvm::MCAsmInfo> AsmInfo(Target->createMCAsmInfo(*Registers, Triple.str(), Options));
  const std::unique_ptr<llvm::MCInstrInfo> Instructions(Target->createMCInstrInfo());
  std::string Features;
  for (const std::string &Feature : Args.getAllArgValues(options::OPT_target_feature))
    Features += (Features.empty() ? "" : ",") + Feature;
  const std::unique_ptr<llvm::MCSubtargetInfo> Subtarget(
      Target->createMCSubtargetInfo(Triple.str(), Args.getLastArgValue(options::OPT_target_cpu), Features));

  llvm::MCContext Context(Triple, AsmInfo.get(), Registers.get(), Subtarget.get(), &Sources, &Options);
  trax::limitMessages(Context);
  const bool PIC = Args.getLastArgValue(options::OPT_mrelocation_model, "static") == "pic";
  const std::unique_ptr<llvm::MCObjectFileInfo> ObjectFile(Target->createMCObjectFileInfo(Context, PIC));
  Context.setObjectFileInfo(ObjectFile.get());
  setUpDebugInfo(Context, Args, InputPath, Sources.getMemoryBuffer(Source)->getBuffer(), Diags);

  const OutputKind Kind = outputKind(Args, Diags);
  llvm::SmallString<0> Bytes;
  llvm::raw_svector_ostream Out(Bytes);
  std::unique_ptr<llvm::MCStreamer> Streamer;
  if (Kind == OutputKind::Object) {
    std::unique_ptr<llvm::MCCodeEmitter> Emitter(Target->createMCCodeEmitter(*Instructions, Context));
    std::unique_ptr<llvm::MCAsmBackend> Backend(Target->createMCAsmBackend(*Subtarget, *Registers, Options));
    std::unique_ptr<llvm::MCObjectWriter> Writer = Backend->createObjectWriter(Out);
    Streamer.reset(Target->createMCObjectStreamer(Triple, Context, std::move(Backend), std::move(Writer),
                                                  std::move(Emitter), *Subtarget));
    Streamer->initSections(Args.hasArg(options::OPT_mno_exec_stack), *Subtarget);
    Streamer->emitVersionForTarget(Triple, {}, nullptr, {});
  } else if (Kind == OutputKind::Assembly) {
    llvm::MCInstPrinter *Printer = Target->createMCInstPrinter(Triple, 0, *AsmInfo, *Instructions, *Registers);
    Streamer.reset(Target->createAsmStreamer(Context, std::make_unique<llvm::formatted_raw_ostream>(Out), Printer,
                                             nullptr, nullptr));
  } else {
    Streamer.reset(Target->createNullStreamer(Context));
  }

  const std::unique_ptr<llvm::MCAsmParser> Parser(llvm::createMCAsmParser(Sources, Context, *Streamer, *AsmInfo));
  const std::unique_ptr<llvm::MCTargetAsmParser> TargetParser(
      Target->createMCAsmParser(*Subtarget, *Parser, *Instructions, Options));
  Parser->setTargetParser(*TargetParser);
  defineSymbols(Context, *Streamer, Args, Diags);

  const bool Success = !Diags.hasErrorOccurred() && !Parser->Run(Args.hasArg(options::OPT_n)) && !Context.hadError();
  Streamer.reset(); // flushes
  trax_error Reason;
  if (!Success || Kind == OutputKind::Null ||
      trax_write_file(Args.getLastArgValue(options::OPT_o, "-").str().c_str(), Bytes.data(), Bytes.size(), &Reason) ==
          TRAX_OK)
    return Success;
  Diags.Report(Diags.getCustomDiagID(DiagnosticsEngine::Error, "%0")) << Reason.message;
  return false;
}

} // namespace

int trax::runCC1As(llvm::ArrayRef<const char *> RawArgs, const char *) {
  IntrusiveRefCntPtr<DiagnosticOptions> Options(new DiagnosticOptions());
  DiagnosticsEngine Diags(new DiagnosticIDs(), &*Options, new TextDiagnosticPrinter(llvm::errs(), &*Options));

  // If LLVM's assembler gives up, the source is wrong, not the compiler.
  const llvm::ScopedFatalErrorHandler FatalErrors(
      [](void *Engine, const char *Message, bool) { reportFatalError(Engine, Message, /*GenCrashDiag=*/false); },
      &Diags);
  guardCrashes("clang", /*Always=*/true);

  unsigned MissingIndex, MissingCount;
  const llvm::opt::InputArgList Args =
      getDriverOptTable().ParseArgs(RawArgs, MissingIndex, MissingCount, llvm::opt::Visibility(options::CC1AsOption));
  checkArguments(Args, MissingIndex, MissingCount, Diags);
  if (Diags.hasErrorOccurred())
    return 1;
  if (Args.hasArg(options::OPT_help)) {
    getDriverOptTable().printHelp(llvm::outs(), "clang -cc1as [options] file...", "Clang Integrated Assembler",
                                  /*ShowHidden=*/false, /*ShowAllAliases=*/false,
                                  llvm::opt::Visibility(options::CC1AsOption));
    return 0;
  }
  if (Args.hasArg(options::OPT_version)) {
    llvm::cl::PrintVersionMessage();
    return 0;
  }
  const std::vector<std::string> BackendOptions = Args.getAllArgValues(options::OPT_mllvm);
  if (!BackendOptions.empty()) {
    llvm::SmallVector<const char *, 8> Argv{"clang -cc1as (LLVM option parsing)"};
    for (const std::string &Option : BackendOptions)
      Argv.push_back(Option.c_str());
    llvm::cl::ParseCommandLineOptions(Argv.size(), Argv.data());
  }
  return !assemble(Args, Diags);
}
