//===- TraxRefused.cpp - options that the machine cannot obey ------------===//

#include "TraxRefused.h"
#include "TraxOptions.h"
#include "clang/Basic/DiagnosticDriver.h"
#include "clang/Driver/Driver.h"

using namespace clang::driver;
using namespace clang::driver::options;
using namespace trax::options;
using llvm::StringRef;
using llvm::opt::Arg;
using llvm::opt::ArgList;

namespace {

/// Options that the machine cannot support, and those that revoke them. The last of a group decides.
struct Group {
  std::initializer_list<unsigned> Refused, Harmless;
};

const Group Groups[] = {
    {{OPT_fPIC, OPT_fpic, OPT_fPIE, OPT_fpie}, {OPT_fno_PIC, OPT_fno_pic, OPT_fno_PIE, OPT_fno_pie}},
    {{OPT_pie, OPT_static_pie}, {OPT_no_pie}},
    {{OPT_shared, OPT_emit_static_lib}, {}},
    {{OPT_flto, OPT_flto_EQ}, {OPT_fno_lto}},
    {{OPT_fopenmp_targets_EQ}, {}},
    {{OPT_fstack_protector, OPT_fstack_protector_strong, OPT_fstack_protector_all}, {OPT_fno_stack_protector}},
    {{OPT_fsplit_stack}, {OPT_fno_split_stack}},
    {{OPT_femulated_tls}, {OPT_fno_emulated_tls}},
    {{OPT_fprofile_generate, OPT_fprofile_generate_EQ}, {OPT_fno_profile_generate}},
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
    {{OPT_m64, OPT_m16, OPT_mx32}, {OPT_m32}},
    {{OPT_pg, OPT_coverage}, {}},
    {{OPT_gsplit_dwarf, OPT_gsplit_dwarf_EQ}, {OPT_gno_split_dwarf}},
};

bool isOneOf(const Arg &Given, std::initializer_list<unsigned> Ids) {
  return llvm::any_of(Ids, [&](unsigned Id) { return Given.getOption().matches(Id); });
}

/// The values that an option may have where there is nothing to choose.
struct Choice {
  unsigned Option;
  StringRef Only;
};
const Choice Choices[] = {{OPT_mcpu_EQ, "generic"},  {OPT_march_EQ, "generic"},   {OPT_mtune_EQ, "generic"},
                          {OPT_stdlib_EQ, "libc++"}, {OPT_fuse_ld_EQ, "trax-ld"}, {OPT_fopenmp_EQ, "libomp"}};

bool isOpenCL(const Arg &Given) {
  const StringRef Value = Given.getNumValues() ? Given.getValue() : "";
  return Given.getOption().matches(OPT_x)
             ? Value == "cl" || Value == "clcpp"
             : Given.getOption().matches(OPT_INPUT) && (Value.ends_with(".cl") || Value.ends_with(".clcpp"));
}

bool isFixedRegister(const Arg &Given) {
  return isOneOf(Given, {OPT_ffixed_r, OPT_ffixed_r9, OPT_ffixed_r19});
}

/// N of -ffixed-rN. 0 for registers that cannot be kept free: r0, and those that every call uses.
unsigned fixedRegister(const Arg &Given) {
  if (Given.getOption().matches(OPT_ffixed_r9))
    return 9;
  if (Given.getOption().matches(OPT_ffixed_r19))
    return 19;
  unsigned Number;
  const StringRef Digits = Given.getValue();
  return Digits.getAsInteger(10, Number) || Number < 4 || Number > 31 || Digits.starts_with("0") ? 0 : Number;
}

} // namespace

llvm::SmallVector<unsigned, 4> trax::fixedRegisters(const ArgList &Args) {
  llvm::SmallVector<unsigned, 4> Registers;
  for (const Arg *Given : Args)
    if (isFixedRegister(*Given) && fixedRegister(*Given))
      Registers.push_back(fixedRegister(*Given));
  return Registers;
}

void trax::refuseOptions(const Driver &D, const llvm::Triple &Triple, const ArgList &Args) {
  for (const Group &G : Groups) {
    const Arg *Last = nullptr;
    for (const Arg *Given : Args)
      if (isOneOf(*Given, G.Refused) || isOneOf(*Given, G.Harmless))
        Last = Given;
    if (Last && isOneOf(*Last, G.Refused))
      D.Diag(clang::diag::err_drv_unsupported_opt_for_target) << Last->getAsString(Args) << Triple.str();
  }

  auto RefuseValue = [&](const Arg &Given, StringRef Valid) {
    clang::DiagnosticsEngine &Diags = D.getDiags();
    Diags.Report(Diags.getCustomDiagID(clang::DiagnosticsEngine::Error,
                                       "unsupported argument '%0' to option '%1' for target '%2': there %3"))
        << Given.getValue() << Given.getSpelling() << Triple.str() << Valid;
  };
  for (const auto &[Option, Only] : Choices)
    for (const Arg *Given : Args.filtered(Option)) {
      Given->claim();
      if (Given->getValue() != Only)
        RefuseValue(*Given, ("is '" + Only + "' only").str());
    }
  for (const Arg *Given : Args)
    if (isOpenCL(*Given)) {
      D.getDiags().Report(D.getDiags().getCustomDiagID(
          clang::DiagnosticsEngine::Error,
          "OpenCL is not supported for target 'trax': write the kernel in C and pass it to trax_parallel_for"));
      break;
    }
  if (const Arg *Stack = Args.getLastArg(OPT_mstack_EQ))
    if (!llvm::is_contained({StringRef("local"), StringRef("global"), StringRef("either")}, Stack->getValue()))
      RefuseValue(*Stack, "are 'local', 'global' and 'either'");
  // Threads read variables on the stack of the thread that started them.
  if (Args.hasFlag(OPT_fopenmp, OPT_fopenmp_EQ, OPT_fno_openmp, false) &&
      Args.getLastArgValue(OPT_mstack_EQ) != "global")
    D.Diag(D.getDiags().getCustomDiagID(clang::DiagnosticsEngine::Error,
                                        "'-fopenmp' needs '-mstack=global' for target '%0'"))
        << Triple.str();
  for (const Arg *Given : Args)
    if (isFixedRegister(*Given)) {
      Given->claim();
      if (!fixedRegister(*Given))
        RefuseValue(*Given, "are 4 to 31");
    }
  Args.ClaimAllArgs(OPT_nolibc);
}
