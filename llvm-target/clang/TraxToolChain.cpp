//===- TraxToolChain.cpp - how clang's driver compiles and links for Trax ===//

#include "TraxToolChain.h"
#include "PrivateMember.h"
#include "TraxOptions.h"
#include "TraxRefused.h"
#include "clang/Basic/DiagnosticDriver.h"
#include "clang/Driver/Compilation.h"
#include "clang/Driver/Driver.h"
#include "clang/Driver/InputInfo.h"
#include "clang/Driver/Job.h"
#include "llvm/Support/FileSystem.h"
#include "llvm/Support/Path.h"

using namespace clang::driver;
using namespace clang::driver::options;
using namespace trax::options;
using llvm::StringRef;
using llvm::opt::Arg;
using llvm::opt::ArgList;
using llvm::opt::ArgStringList;

namespace {

/// A number of bytes, 1 to 2^30, with k or M for 1024 or 1024^2 of them, rounded up to whole cache lines; 0 if Text is
/// none.
unsigned parseSize(StringRef Text) {
  const StringRef Digits = Text.rtrim("kKM").size() + 1 >= Text.size() ? Text.rtrim("kKM") : Text;
  const uint64_t Unit = Digits.size() == Text.size() ? 1 : Text.back() == 'M' ? 1024 * 1024 : 1024;
  constexpr uint64_t Limit = 1 << 30;
  uint64_t Number;
  if (Digits.getAsInteger(0, Number) || Number > Limit / Unit)
    return 0;
  return unsigned(llvm::alignTo(Number * Unit, 64));
}

StringRef stack(const ArgList &Args) {
  return Args.getLastArgValue(OPT_mstack_EQ, "local");
}

/// Not claimed: without stacks in global memory it is unused.
StringRef stackSize(const ArgList &Args) {
  const Arg *Given = Args.getLastArgNoClaim(OPT_mstack_size_EQ);
  return Given ? Given->getValue() : "64k";
}

/// Corrects the command of clang's own tool, which decides these options by its list of architectures.
class Compiler final : public Tool {
  const Tool &Clang;

  static void adjust(const ArgList &Args, ArgStringList &CC1Args) {
    const bool KeepsFramePointer = !Args.hasFlag(OPT_fomit_frame_pointer, OPT_fno_omit_frame_pointer, true);
    const bool HasContraction = Args.hasArg(OPT_ffp_contract), HasAddrsig = Args.hasArg(OPT_faddrsig);
    ArgStringList Adjusted;
    for (const char *Given : CC1Args) {
      const StringRef Option = Given;
      if (Option == "-fcxx-exceptions" || Option == "-fexceptions") // there is no unwinder
        continue;
      if (Option == "-faddrsig" && !HasAddrsig) // trax-ld has no use for it
        continue;
      if (Option.starts_with("-mframe-pointer=") && !KeepsFramePointer) // 512 bytes of stack
        Given = "-mframe-pointer=none";
      if (Option == "-ffp-contract=on" && !HasContraction) // there is no fused multiply-add
        Given = "-ffp-contract=off";
      Adjusted.push_back(Given);
      // No library prints the finding of a check. The check ends in a fault report.
      if (Option.starts_with("-fsanitize="))
        Adjusted.push_back(Args.MakeArgString("-fsanitize-trap=" + Option.split('=').second));
      if (Option == "-fopenmp") // no loop becomes vectors, whatever the clause simd asks for
        Adjusted.push_back("-Wno-pass-failed");
    }
    CC1Args = std::move(Adjusted);
  }

public:
  explicit Compiler(const Tool &Clang) : Tool("trax::Compiler", "clang", Clang.getToolChain()), Clang(Clang) {}

  bool hasIntegratedAssembler() const override { return Clang.hasIntegratedAssembler(); }
  bool hasIntegratedBackend() const override { return Clang.hasIntegratedBackend(); }
  bool hasIntegratedCPP() const override { return Clang.hasIntegratedCPP(); }
  bool hasGoodDiagnostics() const override { return Clang.hasGoodDiagnostics(); }
  bool canEmitIR() const override { return Clang.canEmitIR(); }

  void ConstructJob(Compilation &C, const JobAction &JA, const InputInfo &Output, const InputInfoList &Inputs,
                    const ArgList &Args, const char *LinkingOutput) const override {
    const size_t Before = C.getJobs().size();
    Clang.ConstructJob(C, JA, Output, Inputs, Args, LinkingOutput);
    for (const auto &Job : llvm::drop_begin(C.getJobs().getJobs(), Before)) {
      ArgStringList CC1Args = Job->getArguments();
      adjust(Args, CC1Args);
      Job->replaceArguments(std::move(CC1Args));
    }
  }
};

/// trax-ld.
class Linker final : public Tool {
  /// The file of that name in the directories of -B, else the one of the runtime.
  static const char *findFile(const Compilation &C, const clang::driver::ToolChain &TC, const char *Name) {
    const std::string Found = C.getDriver().GetFilePath(Name, TC);
    return C.getArgs().MakeArgString(Found != Name ? Found : TC.computeSysRoot() + "/" + Name);
  }

public:
  explicit Linker(const clang::driver::ToolChain &TC) : Tool("trax::Linker", "linker", TC) {}

  bool hasIntegratedCPP() const override { return false; }
  bool isLinkJob() const override { return true; }

  void ConstructJob(Compilation &C, const JobAction &Link, const InputInfo &Output, const InputInfoList &Inputs,
                    const ArgList &Args, const char *) const override {
    const clang::driver::ToolChain &TC = getToolChain();
    const bool NoLibraries = Args.hasArg(OPT_nostdlib, OPT_nodefaultlibs, OPT_nolibc);
    const bool NoStartFile = Args.hasArg(OPT_nostdlib, OPT_nostartfiles);
    const bool GlobalStack = stack(Args) == "global";
    ArgStringList Out{"-o", Output.getFilename(), "--gc-sections"};
    if (Args.hasArg(OPT_Z_Xlinker__no_demangle)) // clang's form of -Wl,--no-demangle
      Out.push_back("--no-demangle");
    if (!NoStartFile)
      Out.push_back(findFile(C, TC, GlobalStack ? "crt0-global-stack.o" : "crt0.o"));
    if (GlobalStack) {
      Args.ClaimAllArgs(OPT_mstack_size_EQ);
      Out.push_back(Args.MakeArgString("--defsym=__trax_stack_size=" + llvm::Twine(parseSize(stackSize(Args)))));
    }
    for (const auto Id : {OPT_L, OPT_u, OPT_s, OPT_t})
      Args.AddAllArgs(Out, Id);
    for (const Arg *Address : Args.filtered(OPT_T_Group)) { // clang parses -Ttext=ADDRESS as -T
      Address->claim();
      Out.push_back(Args.MakeArgString(Address->getSpelling() + Address->getValue()));
    }
    Out.push_back(Args.MakeArgString("-L" + TC.computeSysRoot()));

    for (const InputInfo &Input : Inputs) {
      if (Input.isFilename()) {
        Out.push_back(Input.getFilename());
        continue;
      }
      // libc.a has the functions of <math.h> and what C++ needs.
      const Arg &Option = Input.getInputArg();
      static constexpr StringRef Contained[] = {"m", "c++", "c++abi", "supc++"};
      if (Option.getOption().matches(OPT_Z_reserved_lib_stdcxx)) // clang's form of -lstdc++
        continue;
      if (NoLibraries || !Option.getOption().matches(OPT_l) || !llvm::is_contained(Contained, Option.getValue()))
        Option.renderAsInput(Args, Out);
    }
    if (!NoLibraries)
      Out.push_back("-lc");
    const Arg *Path = Args.getLastArg(OPT_ld_path_EQ);
    const char *Executable = Args.MakeArgString(Path ? Path->getValue() : TC.GetProgramPath("trax-ld"));
    C.addCommand(
        std::make_unique<Command>(Link, *this, ResponseFileSupport::AtFileUTF8(), Executable, Out, Inputs, Output));
  }
};

/// The arguments for the base class's constructor, which decides about RTTI before the command line is known.
const ArgList &ownArguments() {
  static const char *const Own[] = {"-fno-rtti"};
  unsigned Index, Count;
  static const llvm::opt::InputArgList Parsed = getDriverOptTable().ParseArgs(Own, Index, Count);
  return Parsed;
}

} // namespace

namespace trax {
struct ToolChains {
  using Type = llvm::StringMap<std::unique_ptr<clang::driver::ToolChain>> Driver::*;
  friend Type addressOf(ToolChains);
};
template struct Publish<ToolChains, &Driver::ToolChains>;
} // namespace trax

void trax::addToolChains(Driver &D, const std::string &RuntimeDir) {
  for (StringRef Name : {"trax", "trax-unknown-elf", "trax-none-elf", "trax-unknown-unknown"}) {
    const llvm::Triple Triple(llvm::Triple::normalize(Name));
    (D.*addressOf(ToolChains()))[Triple.str()] = std::make_unique<ToolChain>(D, Triple, RuntimeDir);
  }
}

trax::ToolChain::ToolChain(const Driver &D, const llvm::Triple &Triple, std::string RuntimeDir)
    : clang::driver::ToolChain(D, Triple, ownArguments()), RuntimeDir(std::move(RuntimeDir)) {
  getProgramPaths().push_back(D.Dir);
  getFilePaths().push_back(computeSysRoot());
}

std::string trax::ToolChain::computeSysRoot() const {
  return getDriver().SysRoot.empty() ? RuntimeDir : getDriver().SysRoot;
}

void trax::ToolChain::AddClangSystemIncludeArgs(const ArgList &Args, ArgStringList &CC1Args) const {
  if (Args.hasArg(OPT_nostdinc))
    return;
  if (!Args.hasArg(OPT_nobuiltininc))
    addSystemInclude(Args, CC1Args, getDriver().ResourceDir + "/include");
  if (!Args.hasArg(OPT_nostdlibinc)) // after clang's headers, which include_next it; extern "C" for C++
    addExternCSystemInclude(Args, CC1Args, computeSysRoot() + "/include");
}

void trax::ToolChain::AddClangCXXStdlibIncludeArgs(const ArgList &Args, ArgStringList &CC1Args) const {
  if (Args.hasArg(OPT_nostdinc, OPT_nostdlibinc, OPT_nostdincxx))
    return;
  // Our configuration of libc++ goes before Debian's libc++.
  addSystemInclude(Args, CC1Args, computeSysRoot() + "/include/c++");
  const std::string Own = computeSysRoot() + "/include/c++/v1";
  addSystemInclude(Args, CC1Args, llvm::sys::fs::exists(Own + "/vector") ? Own : TRAX_LIBCXX_DIR);
}

void trax::ToolChain::addClangTargetOptions(const ArgList &Args, ArgStringList &CC1Args, Action::OffloadKind) const {
  CC1Args.push_back("-nostdsysteminc"); // the host's headers are not the machine's
  // A 4 kB instruction cache: the linker drops what is not called, and checks the worst depth of the stack.
  auto Default = [&](unsigned Yes, unsigned No, const char *Option) {
    if (Args.hasFlag(Yes, No, true))
      CC1Args.push_back(Option);
  };
  Default(OPT_ffunction_sections, OPT_fno_function_sections, "-ffunction-sections");
  Default(OPT_fdata_sections, OPT_fno_data_sections, "-fdata-sections");
  Default(OPT_fstack_size_section, OPT_fno_stack_size_section, "-fstack-size-section");
  if (!Args.hasArg(OPT_ftlsmodel_EQ)) // thread-local data has absolute addresses
    CC1Args.push_back("-ftls-model=local-exec");

  auto AddFeature = [&](const llvm::Twine &Feature) {
    CC1Args.append({"-target-feature", Args.MakeArgString("+" + Feature)});
  };
  if (stack(Args) != "local")
    AddFeature(stack(Args) + "-stack");
  if (stack(Args) == "global")
    Args.ClaimAllArgs(OPT_mstack_size_EQ);
  for (const unsigned Number : fixedRegisters(Args))
    AddFeature("reserve-r" + llvm::Twine(Number));
}

llvm::opt::DerivedArgList *trax::ToolChain::TranslateArgs(const llvm::opt::DerivedArgList &Args, StringRef,
                                                          Action::OffloadKind) const {
  refuseOptions(getDriver(), getTriple(), Args);
  if (parseSize(stackSize(Args)) == 0)
    getDriver().Diag(clang::diag::err_drv_invalid_value) << "-mstack-size=" << stackSize(Args);
  return nullptr;
}

Tool *trax::ToolChain::SelectTool(const JobAction &JA) const {
  Tool *Selected = clang::driver::ToolChain::SelectTool(JA);
  if (!Selected->canEmitIR())
    return Selected;
  if (!Compiler)
    Compiler = std::make_unique<::Compiler>(*Selected);
  return Compiler.get();
}

Tool *trax::ToolChain::buildLinker() const {
  return new Linker(*this);
}
