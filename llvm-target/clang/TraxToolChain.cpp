//===- TraxToolChain.cpp - how the driver compiles and links for Trax ----===//

#include "TraxToolChain.h"
#include "clang/Basic/DiagnosticDriver.h"
#include "clang/Driver/Action.h"
#include "clang/Driver/Compilation.h"
#include "clang/Driver/Driver.h"
#include "clang/Driver/InputInfo.h"
#include "clang/Driver/Job.h"
#include "clang/Driver/Options.h"
#include "clang/Driver/ToolChain.h"
#include "llvm/Option/ArgList.h"
#include "llvm/Support/Path.h"

using namespace clang;
using namespace clang::driver;
using llvm::StringRef;
using llvm::opt::Arg;
using llvm::opt::ArgStringList;

void trax::insertDefaults(llvm::SmallVectorImpl<const char *> &Args, StringRef RuntimeDir, llvm::StringSaver &Strings) {
  static const char *const Defaults[] = {
      "-fintegrated-as",
      "-nostdlibinc",         // the host's headers are not the machine's
      "-fno-pic",             // addresses are absolute
      "-fomit-frame-pointer", // 512 bytes of stack
      "-ffunction-sections",  // a 4 kB instruction cache: the linker drops what is not called
      "-fdata-sections",
      "-fno-addrsig",
      "-fno-math-errno",
      "-ffp-contract=off",      // there is no fused multiply-add
      "-ftls-model=local-exec", // thread-local data has absolute addresses
      "-fdebug-default-version=4",
      "-fno-exceptions", // C++: no unwinder, no type information, no start-up races
      "-fno-rtti",
      "-fno-threadsafe-statics",
  };
  bool NoHeaders = false;
  for (const char *Given : llvm::drop_begin(Args))
    NoHeaders |= Given && (StringRef(Given) == "-nostdinc" || StringRef(Given) == "-nostdlibinc");

  llvm::SmallVector<const char *, 32> Inserted{"--start-no-unused-arguments"};
  Inserted.append(std::begin(Defaults), std::end(Defaults));
  if (!NoHeaders) {
    // Like a system's /usr/include: behind clang's own headers, which include_next it, and C even when C++ includes it.
    const char *Directory = Strings.save(RuntimeDir + "/include").data();
    for (const char *Part : {"-Xclang", "-internal-externc-isystem", "-Xclang", Directory})
      Inserted.push_back(Part);
  }
  Inserted.push_back("--end-no-unused-arguments");
  Args.insert(Args.begin() + 1, Inserted.begin(), Inserted.end());
}

void trax::checkOptions(const Compilation &C) {
  const llvm::opt::ArgList &Args = C.getArgs();
  const std::string &Triple = C.getDefaultToolChain().getTripleString();
  auto Refuse = [&](const Arg *Given) {
    C.getDriver().Diag(diag::err_drv_unsupported_opt_for_target) << Given->getAsString(Args) << Triple;
  };
  using namespace options;
  // The last of each pair decides; the first names what the machine cannot do.
  static const std::pair<unsigned, unsigned> Impossible[] = {
      {OPT_fPIC, OPT_fno_PIC},
      {OPT_fpic, OPT_fno_pic},
      {OPT_fPIE, OPT_fno_PIE},
      {OPT_fpie, OPT_fno_pie},
      {OPT_pie, OPT_no_pie},
      {OPT_shared, OPT_shared},
      {OPT_static_pie, OPT_static_pie},
      {OPT_fopenmp, OPT_fno_openmp},
      {OPT_fopenmp_EQ, OPT_fno_openmp},
      {OPT_pg, OPT_pg},
      {OPT_coverage, OPT_coverage},
      {OPT_fprofile_generate, OPT_fno_profile_generate},
      {OPT_fprofile_instr_generate, OPT_fno_profile_instr_generate},
      {OPT_fstack_protector, OPT_fno_stack_protector},
      {OPT_fstack_protector_strong, OPT_fno_stack_protector},
      {OPT_fstack_protector_all, OPT_fno_stack_protector},
      {OPT_fsplit_stack, OPT_fno_split_stack},
      {OPT_femulated_tls, OPT_fno_emulated_tls},
      {OPT_flto, OPT_fno_lto},
      {OPT_flto_EQ, OPT_fno_lto},
      {OPT_gsplit_dwarf, OPT_gno_split_dwarf},
      {OPT_gsplit_dwarf_EQ, OPT_gno_split_dwarf},
  };
  for (const auto &[Positive, Negative] : Impossible)
    if (const Arg *Given = Args.getLastArg(Positive, Negative))
      if (Positive == Negative || !Given->getOption().matches(Negative))
        Refuse(Given);
  if (const Arg *Given = Args.getLastArg(OPT_fuse_ld_EQ))
    if (StringRef(Given->getValue()) != "trax-ld")
      Refuse(Given);
}

namespace {

/// Writes the arguments of one call of trax-ld.
class LinkCommand {
public:
  LinkCommand(Compilation &C, StringRef RuntimeDir) : C(C), Args(C.getArgs()), RuntimeDir(RuntimeDir) {}

  ArgStringList build(const Command &Job) {
    using namespace options;
    const bool Relocatable = Args.hasArg(OPT_r);
    const bool NoLibraries = Relocatable || Args.hasArg(OPT_nostdlib, OPT_nodefaultlibs, OPT_nolibc);
    Out.push_back("-o");
    Out.push_back(Args.MakeArgString(Job.getOutputFilenames().front()));
    if (!Relocatable)
      Out.push_back("--gc-sections");
    if (!Relocatable && !Args.hasArg(OPT_nostdlib, OPT_nostartfiles))
      Out.push_back(startFile());
    for (const auto Id : {OPT_L, OPT_u, OPT_s, OPT_t})
      Args.AddAllArgs(Out, Id);
    Args.AddAllArgs(Out, OPT_T_Group);
    Out.push_back(Args.MakeArgString("-L" + RuntimeDir));
    addInputs(Job, NoLibraries);
    if (!NoLibraries)
      Out.push_back("-lc");
    return Out;
  }

  const char *linker() const {
    if (const Arg *Path = Args.getLastArg(options::OPT_ld_path_EQ))
      return Path->getValue();
    return Args.MakeArgString(C.getDriver().GetProgramPath("trax-ld", C.getDefaultToolChain()));
  }

private:
  Compilation &C;
  const llvm::opt::DerivedArgList &Args;
  const StringRef RuntimeDir;
  ArgStringList Out;

  const char *startFile() const {
    const std::string Found = C.getDriver().GetFilePath("crt0.o", C.getDefaultToolChain());
    return Args.MakeArgString(Found != "crt0.o" ? Found : (RuntimeDir + "/crt0.o").str());
  }

  /// Objects, libraries and -Wl, in the order of the command line, which archives depend on. The job lists its files
  /// only; its action has an input for every argument, so that the two together give the order.
  void addInputs(const Command &Job, bool NoLibraries) {
    auto NextFile = Job.getInputInfos().begin();
    for (const Action *Input : Job.getSource().getInputs()) {
      const auto *Given = dyn_cast<InputAction>(Input);
      if (!Given || Given->getInputArg().getOption().matches(options::OPT_INPUT)) {
        Out.push_back(Args.MakeArgString((NextFile++)->getFilename()));
        continue;
      }
      const Arg &Option = Given->getInputArg();
      // The functions of <math.h> are in libc.a.
      if (!NoLibraries && Option.getOption().matches(options::OPT_l) && StringRef(Option.getValue()) == "m")
        continue;
      Option.renderAsInput(Args, Out);
    }
  }
};

} // namespace

void trax::replaceLinkJobs(Compilation &C, StringRef RuntimeDir) {
  for (Command &Job : C.getJobs()) {
    if (!isa<LinkJobAction>(Job.getSource()))
      continue;
    LinkCommand Link(C, RuntimeDir);
    Job.replaceArguments(Link.build(Job));
    Job.replaceExecutable(Link.linker());
  }
}
