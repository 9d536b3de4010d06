//===- TraxTargetInfo.cpp - the machine for clang's front end ------------===//

#include "TraxTargetInfo.h"
#include "PrivateMember.h"
#include "trax/abi.h"
#include "clang/Basic/Builtins.h"
#include "clang/Basic/DiagnosticFrontend.h"
#include "clang/Basic/MacroBuilder.h"
#include "clang/Basic/TargetBuiltins.h"
#include "clang/Basic/TargetOptions.h"
#include "llvm/ADT/APFloat.h"
#include "llvm/ADT/STLExtras.h"
#include "llvm/ADT/StringMap.h"

using namespace clang;
using llvm::ArrayRef;
using llvm::StringRef;

namespace trax {
// Set by clang's own factory of targets alone, which knows no Trax.
struct TargetOpts {
  using Type = std::shared_ptr<TargetOptions> TargetInfo::*;
  friend Type addressOf(TargetOpts);
};
template struct Publish<TargetOpts, &TargetInfo::TargetOpts>;
} // namespace trax

namespace {

#define NAME(NUMBERED, BY_ROLE, NUMBER) NUMBERED,
const char *const RegisterNames[] = {TRAX_REGISTERS(NAME)};
#undef NAME
#define NAME(NUMBERED, BY_ROLE, NUMBER) {{BY_ROLE}, NUMBERED},
const TargetInfo::GCCRegAlias RegisterAliases[] = {TRAX_REGISTERS(NAME)};
#undef NAME

// Attribute letters as in clang/Basic/Builtins.def: n nothrow, c const, r noreturn, F a call of a library function.
const Builtin::Info Builtins[] = {
#define BUILTIN(ID, NAME, TYPE, ATTRIBUTES)                                                                            \
  {"__builtin_trax_" #NAME, TYPE, ATTRIBUTES "F", nullptr, HeaderDesc::NO_HEADER, ALL_LANGUAGES},
#include "TraxBuiltins.def"
    // Clang looks up the intrinsics of generic builtins by an architecture that it knows. This row replaces clang's: it
    // is a call of a function to which TraxDeclarations.cpp gives the intrinsic's name.
    {"__builtin_debugtrap", "v", "nF", nullptr, HeaderDesc::NO_HEADER, ALL_LANGUAGES},
};

class TraxTargetInfo final : public TargetInfo {
public:
  explicit TraxTargetInfo(const llvm::Triple &Triple) : TargetInfo(Triple) {
    resetDataLayout(TRAX_DATA_LAYOUT);
    BigEndian = false; // the triple does not say
    SizeType = UnsignedInt;
    PtrDiffType = SignedInt;
    IntPtrType = SignedInt;
    WCharType = SignedInt;
    WIntType = UnsignedInt;
    // Nothing is aligned beyond a word: 512 bytes of stack have no room for padding.
    LongLongAlign = DoubleAlign = LongDoubleAlign = 32;
    LongDoubleWidth = 64;
    LongDoubleFormat = &llvm::APFloat::IEEEdouble();
    SuitableAlign = DefaultAlignForAttributeAligned = 32;
    MaxAtomicPromoteWidth = MaxAtomicInlineWidth = 32;
    TLSSupported = true;
    NoAsmVariants = true;
  }

  void getTargetDefines(const LangOptions &, MacroBuilder &Builder) const override {
    Builder.defineMacro("__trax__");
    Builder.defineMacro("__TRAX__");
    Builder.defineMacro("__ELF__");
    if (HasGlobalStack)
      Builder.defineMacro("__trax_global_stack__");
  }

  ArrayRef<Builtin::Info> getTargetBuiltins() const override { return Builtins; }
  BuiltinVaListKind getBuiltinVaListKind() const override { return VoidPtrBuiltinVaList; }
  std::string_view getClobbers() const override { return ""; }
  ArrayRef<const char *> getGCCRegNames() const override { return RegisterNames; }
  ArrayRef<GCCRegAlias> getGCCRegAliases() const override { return RegisterAliases; }

  bool validateAsmConstraint(const char *&Name, ConstraintInfo &Info) const override {
    switch (*Name) {
    case 'I': // as addi takes it
      Info.setRequiresImmediate(-32768, 32767);
      return true;
    case 'J': // r0
      Info.setRequiresImmediate(0);
      return true;
    case 'K': // as lui takes it
      Info.setRequiresImmediate(0, 65535);
      return true;
    case 'f': // floats have no registers of their own
      Info.setAllowsRegister();
      return true;
    case 's': // a symbol, as in gcc for all machines
      return true;
    default:
      return false;
    }
  }

  // __builtin_setjmp and __builtin_longjmp: TraxSjLj.cpp.
  bool hasSjLjLowering() const override { return true; }

  // No object is aligned beyond a word, whatever its type.
  bool allowsLargerPreferedTypeAlignment() const override { return false; }

  // Wider ones would need library functions for multiplication and division.
  bool hasBitIntType() const override { return true; }
  size_t getMaxBitIntWidth() const override { return 64; }

  bool isValidCPUName(StringRef Name) const override { return Name == "generic"; }
  void fillValidCPUList(SmallVectorImpl<StringRef> &Values) const override { Values.push_back("generic"); }
  bool setCPU(const std::string &Name) override { return isValidCPUName(Name); }
  bool isValidFeatureName(StringRef Name) const override {
    unsigned Register;
    return Name == "global-stack" || Name == "either-stack" ||
           (Name.consume_front("reserve-r") && !Name.getAsInteger(10, Register) && Register >= 4 && Register < 32);
  }
  bool hasFeature(StringRef Name) const override { return Name == "global-stack" && HasGlobalStack; }
  bool handleTargetFeatures(std::vector<std::string> &Features, DiagnosticsEngine &) override {
    HasGlobalStack = llvm::is_contained(Features, "+global-stack");
    return true;
  }

private:
  bool HasGlobalStack = false; // -mstack=global
};

} // namespace

bool trax::isTraxTriple(const llvm::Triple &Triple) {
  return Triple.getArchName() == "trax" && Triple.getOS() == llvm::Triple::UnknownOS && Triple.isOSBinFormatELF();
}

llvm::IntrusiveRefCntPtr<TargetInfo> trax::createTargetInfo(DiagnosticsEngine &Diags,
                                                            std::shared_ptr<TargetOptions> Opts) {
  llvm::IntrusiveRefCntPtr<TargetInfo> Target(new TraxTargetInfo(llvm::Triple(Opts->Triple)));
  (*Target).*addressOf(TargetOpts()) = Opts;

  if (!Opts->CPU.empty() && !Target->setCPU(Opts->CPU)) {
    Diags.Report(diag::err_target_unknown_cpu) << Opts->CPU;
    Diags.Report(diag::note_valid_options) << "generic";
    return nullptr;
  }
  if (!Opts->ABI.empty() && !Target->setABI(Opts->ABI)) {
    Diags.Report(diag::err_target_unknown_abi) << Opts->ABI;
    return nullptr;
  }
  if (!Opts->FPMath.empty() && !Target->setFPMath(Opts->FPMath)) {
    Diags.Report(diag::err_target_unknown_fpmath) << Opts->FPMath;
    return nullptr;
  }

  if (!Target->initFeatureMap(Opts->FeatureMap, Diags, Opts->CPU, Opts->FeaturesAsWritten))
    return nullptr;
  Opts->Features.clear();
  for (const auto &Feature : Opts->FeatureMap)
    Opts->Features.push_back((Feature.getValue() ? "+" : "-") + Feature.getKey().str());
  llvm::sort(Opts->Features);
  if (!Target->handleTargetFeatures(Opts->Features, Diags))
    return nullptr;

  Target->setSupportedOpenCLOpts();
  Target->setCommandLineOpenCLOpts();
  Target->setMaxAtomicWidth();
  return Target->validateTarget(Diags) ? Target : nullptr;
}
