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
#include "llvm/Support/FileSystem.h"
#include "llvm/Support/Path.h"

using namespace clang;
using namespace clang::driver;
using llvm::StringRef;
using llvm::opt::Arg;
using llvm::opt::ArgStringList;

trax::StackOptions::StackOptions(llvm::SmallVectorImpl<const char *> &Args) {
  llvm::erase_if(Args, [&](const char *Given) {
    StringRef Value = Given ? Given : "";
    if (Value.consume_front("-mstack="))
      Place = Value;
    else if (Value.consume_front("-mstack-size="))
      Size = Value;
    else
      return false;
    return true;
  });
}

/// A number of bytes, 1 to 2^30, with k or M for 1024 or 1024^2 of them, rounded up to whole cache lines.
static std::optional<unsigned> parseSize(StringRef Text) {
  const StringRef Digits = Text.rtrim("kKM").size() + 1 >= Text.size() ? Text.rtrim("kKM") : Text;
  const uint64_t Unit = Digits.size() == Text.size() ? 1 : Text.back() == 'M' ? 1024 * 1024 : 1024;
  constexpr uint64_t Limit = 1 << 30;
  uint64_t Number;
  if (Digits.getAsInteger(0, Number) || Number == 0 || Number > Limit / Unit)
    return std::nullopt;
  return unsigned(llvm::alignTo(Number * Unit, 64));
}

void trax::StackOptions::check(const Compilation &C, bool ForTrax) {
  const Driver &D = C.getDriver();
  for (const auto &[Name, Value] : {std::pair<StringRef, StringRef>("-mstack=", Place), {"-mstack-size=", Size}})
    if (!ForTrax && Value.data())
      D.Diag(diag::err_drv_unsupported_opt_for_target)
          << (Name + Value).str() << C.getDefaultToolChain().getTripleString();
  if (!ForTrax)
    return;
  if (Place.data() && Place != "local" && Place != "global")
    D.Diag(diag::err_drv_unsupported_option_argument) << "-mstack=" << Place;
  if (!Size.data())
    return;
  if (const auto Given = parseSize(Size))
    Bytes = *Given;
  else
    D.Diag(diag::err_drv_invalid_value) << "-mstack-size=" << Size;
  if (!isGlobal())
    D.Diag(diag::warn_drv_unused_argument) << ("-mstack-size=" + Size).str();
}

void trax::insertDefaults(llvm::SmallVectorImpl<const char *> &Args, const StackOptions &Stack, StringRef RuntimeDir,
                          llvm::StringSaver &Strings) {
  static const char *const Defaults[] = {
      "-fintegrated-as",
      "-nostdlibinc",         // the host's headers are not the machine's
      "-fno-pic",             // addresses are absolute
      "-fomit-frame-pointer", // 512 bytes of stack
      "-ffunction-sections",  // a 4 kB instruction cache: the linker drops what is not called
      "-fdata-sections",
      "-fno-addrsig",
      "-fstack-size-section", // the linker checks the worst depth of the stack
      "-fno-math-errno",
      "-ffp-contract=off",      // there is no fused multiply-add
      "-ftls-model=local-exec", // thread-local data has absolute addresses
      "-fdebug-default-version=4",
      "-fno-exceptions", // C++: no unwinder, no type information
      "-fno-rtti",
      "-fsanitize-trap=all", // checks of undefined behaviour end in a fault report: there is no run-time library for
                             // them
  };
  // What says nothing new here, and what clang does not expect of a linker other than its own.
  llvm::erase_if(Args, [](const char *Given) {
    return Given && llvm::is_contained({"-mcpu=generic", "-mtune=generic", "-stdlib=libc++"}, StringRef(Given));
  });
  for (const char *&Given : llvm::drop_begin(Args))
    if (Given && StringRef(Given) == "-nolibc")
      Given = "-nodefaultlibs";
  // Clang passes these on for the targets that it knows to outline.
  const char *Outline = nullptr;
  llvm::erase_if(Args, [&](const char *Given) {
    const StringRef Option = Given ? Given : "";
    if (Option == "-moutline")
      Outline = "-enable-machine-outliner=always";
    else if (Option == "-mno-outline")
      Outline = "-enable-machine-outliner=never";
    else
      return false;
    return true;
  });

  bool NoHeaders = false, NoCXXHeaders = false;
  for (const char *Given : llvm::drop_begin(Args)) {
    const StringRef Option = Given ? Given : "";
    NoHeaders |= Option == "-nostdinc" || Option == "--no-standard-includes" || Option == "-nostdlibinc";
    NoCXXHeaders |= Option == "-nostdinc++";
  }

  llvm::SmallVector<const char *, 32> Inserted{"--start-no-unused-arguments"};
  Inserted.append(std::begin(Defaults), std::end(Defaults));
  if (Outline)
    Inserted.append({"-mllvm", Outline});
  if (Stack.isGlobal())
    for (const char *Part : {"-Xclang", "-target-feature", "-Xclang", "+global-stack"})
      Inserted.push_back(Part);
  if (!NoHeaders && !NoCXXHeaders) {
    // libc++ as Debian has it, behind our description of what it can rely on, before clang's own headers.
    std::string Headers = (RuntimeDir + "/include/c++/v1").str();
    if (!llvm::sys::fs::exists(Headers + "/vector"))
      Headers = TRAX_LIBCXX_DIR;
    for (const std::string &Directory : {(RuntimeDir + "/include/c++").str(), Headers}) {
      Inserted.push_back("-cxx-isystem");
      Inserted.push_back(Strings.save(Directory).data());
    }
  }
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
  // What the machine cannot do, and what takes it back: the last of a group decides.
  struct Group {
    std::initializer_list<unsigned> Refused, Harmless;
  };
  static const Group Groups[] = {
      {{OPT_fPIC, OPT_fpic, OPT_fPIE, OPT_fpie}, {OPT_fno_PIC, OPT_fno_pic, OPT_fno_PIE, OPT_fno_pie}},
      {{OPT_pie, OPT_static_pie}, {OPT_no_pie}},
      {{OPT_shared}, {}},
      {{OPT_flto, OPT_flto_EQ}, {OPT_fno_lto}},
      {{OPT_fopenmp, OPT_fopenmp_EQ}, {OPT_fno_openmp}},
      {{OPT_fstack_protector, OPT_fstack_protector_strong, OPT_fstack_protector_all}, {OPT_fno_stack_protector}},
      {{OPT_fsplit_stack}, {OPT_fno_split_stack}},
      {{OPT_femulated_tls}, {OPT_fno_emulated_tls}},
      {{OPT_fprofile_generate, OPT_fprofile_generate_EQ}, {OPT_fno_profile_generate}},
      {{OPT_fprofile_instr_generate, OPT_fprofile_instr_generate_EQ}, {OPT_fno_profile_instr_generate}},
      {{OPT_fprofile_arcs}, {OPT_fno_profile_arcs}},
      {{OPT_ftest_coverage}, {OPT_fno_test_coverage}},
      {{OPT_fsanitize_coverage}, {}},
      {{OPT_fno_sanitize_trap, OPT_fno_sanitize_trap_EQ}, {OPT_fsanitize_trap, OPT_fsanitize_trap_EQ}},
      {{OPT_fsanitize_minimal_runtime}, {OPT_fno_sanitize_minimal_runtime}},
      {{OPT_fexceptions, OPT_fcxx_exceptions}, {OPT_fno_exceptions, OPT_fno_cxx_exceptions}},
      {{OPT_frtti}, {OPT_fno_rtti}},
      {{OPT_fmodules}, {OPT_fno_modules}},
      {{OPT_fmodule_file, OPT_fmodule_output, OPT_fmodule_output_EQ, OPT__precompile}, {}},
      {{OPT_fno_integrated_as}, {OPT_fintegrated_as}},
      {{OPT_fno_use_init_array}, {OPT_fuse_init_array}},
      {{OPT_mtune_EQ}, {}},
      {{OPT_m64, OPT_m16, OPT_mx32}, {OPT_m32}},
      {{OPT_pg, OPT_coverage}, {}},
      {{OPT_gsplit_dwarf, OPT_gsplit_dwarf_EQ}, {OPT_gno_split_dwarf}},
  };
  for (const Group &G : Groups) {
    const Arg *Last = nullptr;
    bool IsRefused = false;
    auto Matches = [](const Arg *Given, const std::initializer_list<unsigned> &Ids) {
      return llvm::any_of(Ids, [&](unsigned Id) { return Given->getOption().matches(Id); });
    };
    for (const Arg *Given : Args)
      if (const bool Refused = Matches(Given, G.Refused); Refused || Matches(Given, G.Harmless)) {
        Last = Given;
        IsRefused = Refused;
      }
    if (IsRefused)
      Refuse(Last);
  }
  if (const Arg *Given = Args.getLastArg(OPT_fuse_ld_EQ))
    if (StringRef(Given->getValue()) != "trax-ld")
      Refuse(Given);
  if (const Arg *Given = Args.getLastArg(OPT_stdlib_EQ)) // libc++ is no longer among them
    Refuse(Given);
}

namespace {

/// The file of that name in the directories of -B, else the one of the runtime.
const char *findStartFile(const Compilation &C, StringRef Name, StringRef RuntimeDir) {
  const std::string Found = C.getDriver().GetFilePath(Name, C.getDefaultToolChain());
  return C.getArgs().MakeArgString(StringRef(Found) != Name ? Found : (RuntimeDir + "/" + Name).str());
}

const char *findLinker(const Compilation &C) {
  if (const Arg *Path = C.getArgs().getLastArg(options::OPT_ld_path_EQ))
    return Path->getValue();
  return C.getArgs().MakeArgString(C.getDriver().GetProgramPath("trax-ld", C.getDefaultToolChain()));
}

/// Objects, libraries and -Wl, in the order of the command line, which archives depend on. A job lists its files only;
/// its action has an input for every argument, so that the two together give the order.
InputInfoList orderedInputs(const Command &Job) {
  InputInfoList Inputs;
  auto NextFile = Job.getInputInfos().begin();
  for (const Action *Input : Job.getSource().getInputs()) {
    const auto *Given = dyn_cast<InputAction>(Input);
    if (Given && !Given->getInputArg().getOption().matches(options::OPT_INPUT))
      Inputs.push_back(InputInfo(Given, &Given->getInputArg(), nullptr));
    else
      Inputs.push_back(*NextFile++);
  }
  return Inputs;
}

} // namespace

std::unique_ptr<Command> trax::Linker::makeCommand(const Compilation &C, const Action &Link, const InputInfo &Output,
                                                   const InputInfoList &Inputs) const {
  using namespace options;
  const llvm::opt::DerivedArgList &Args = C.getArgs();
  const bool Relocatable = Args.hasArg(OPT_r);
  const bool NoLibraries = Relocatable || Args.hasArg(OPT_nostdlib, OPT_nodefaultlibs, OPT_nolibc);
  ArgStringList Out{"-o", Output.getFilename()};
  if (!Relocatable)
    Out.push_back("--gc-sections");
  if (!Relocatable && !Args.hasArg(OPT_nostdlib, OPT_nostartfiles))
    Out.push_back(findStartFile(C, Stack.isGlobal() ? "crt0-global-stack.o" : "crt0.o", RuntimeDir));
  if (!Relocatable && Stack.isGlobal())
    Out.push_back(Args.MakeArgString("--defsym=__trax_stack_size=" + llvm::Twine(Stack.bytes())));
  for (const auto Id : {OPT_L, OPT_u, OPT_s, OPT_t})
    Args.AddAllArgs(Out, Id);
  for (const Arg *Address : Args.filtered(OPT_T_Group)) // -Ttext=ADDRESS is the option -T to clang
    Out.push_back(Args.MakeArgString(Address->getSpelling() + Address->getValue()));
  Out.push_back(Args.MakeArgString("-L" + RuntimeDir));

  for (const InputInfo &Input : Inputs) {
    if (Input.isFilename()) {
      Out.push_back(Input.getFilename());
      continue;
    }
    // libc.a has the functions of <math.h> and what C++ needs.
    const Arg &Option = Input.getInputArg();
    static constexpr StringRef Contained[] = {"m", "c++", "c++abi", "supc++"};
    if (Option.getOption().matches(OPT_Z_reserved_lib_stdcxx)) // what clang makes of -lstdc++
      continue;
    if (NoLibraries || !Option.getOption().matches(OPT_l) || !llvm::is_contained(Contained, Option.getValue()))
      Option.renderAsInput(Args, Out);
  }
  if (!NoLibraries)
    Out.push_back("-lc");
  return std::make_unique<Command>(Link, *this, ResponseFileSupport::AtFileUTF8(), findLinker(C), Out, Inputs, Output);
}

void trax::Linker::ConstructJob(Compilation &C, const JobAction &Link, const InputInfo &Output,
                                const InputInfoList &Inputs, const llvm::opt::ArgList &, const char *) const {
  C.addCommand(makeCommand(C, Link, Output, Inputs));
}

void trax::Linker::replaceJobs(Compilation &C) const {
  // The list can only be added to, but it is the compilation's own and not constant.
  for (std::unique_ptr<Command> &Job : const_cast<JobList::list_type &>(C.getJobs().getJobs())) {
    if (!isa<LinkJobAction>(Job->getSource()))
      continue;
    const InputInfo Output(types::TY_Image, C.getArgs().MakeArgString(Job->getOutputFilenames().front()), "");
    Job = makeCommand(C, Job->getSource(), Output, orderedInputs(*Job));
  }
}
