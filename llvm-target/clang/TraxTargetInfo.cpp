//===- TraxTargetInfo.cpp - what clang's front end knows of the machine --===//

#include "TraxTargetInfo.h"
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

// TargetInfo::TargetOpts is private and set by clang's own factory alone, which knows no Trax. An explicit
// instantiation may name private members; this one hands out the member.
namespace {
std::shared_ptr<TargetOptions> &targetOptsOf(TargetInfo &Info);
template <auto Member> struct TargetOptsAccess {
  friend std::shared_ptr<TargetOptions> &targetOptsOf(TargetInfo &Info) { return Info.*Member; }
};
template struct TargetOptsAccess<&TargetInfo::TargetOpts>;
} // namespace

namespace {

const char *const RegisterNames[] = {"r0",  "r1",  "r2",  "r3",  "r4",  "r5",  "r6",  "r7",  "r8",  "r9",  "r10",
                                     "r11", "r12", "r13", "r14", "r15", "r16", "r17", "r18", "r19", "r20", "r21",
                                     "r22", "r23", "r24", "r25", "r26", "r27", "r28", "r29", "r30", "r31"};

const TargetInfo::GCCRegAlias RegisterAliases[] = {
    {{"zero"}, "r0"}, {{"ra"}, "r1"},  {{"sp"}, "r2"},  {{"fp"}, "r3"},  {{"a0"}, "r4"},  {{"a1"}, "r5"},
    {{"a2"}, "r6"},   {{"a3"}, "r7"},  {{"a4"}, "r8"},  {{"a5"}, "r9"},  {{"a6"}, "r10"}, {{"a7"}, "r11"},
    {{"t0"}, "r12"},  {{"t1"}, "r13"}, {{"t2"}, "r14"}, {{"t3"}, "r15"}, {{"t4"}, "r16"}, {{"t5"}, "r17"},
    {{"t6"}, "r18"},  {{"t7"}, "r19"}, {{"s0"}, "r20"}, {{"s1"}, "r21"}, {{"s2"}, "r22"}, {{"s3"}, "r23"},
    {{"s4"}, "r24"},  {{"s5"}, "r25"}, {{"s6"}, "r26"}, {{"s7"}, "r27"}, {{"s8"}, "r28"}, {{"s9"}, "r29"},
    {{"s10"}, "r30"}, {{"s11"}, "r31"}};

// Attribute letters as in clang/Basic/Builtins.def: n nothrow, c const, r noreturn, F a call of a library function.
const Builtin::Info Builtins[] = {
#define BUILTIN(NAME, TYPE, ATTRIBUTES) {#NAME, TYPE, ATTRIBUTES "F", nullptr, HeaderDesc::NO_HEADER, ALL_LANGUAGES},
#include "TraxBuiltins.def"
};

class TraxTargetInfo final : public TargetInfo {
public:
  explicit TraxTargetInfo(const llvm::Triple &Triple) : TargetInfo(Triple) {
    resetDataLayout("e-m:e-p:32:32-i64:32-f64:32-n32-S32");
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
    case 's': // a symbol, gcc's for all machines
      return true;
    default:
      return false;
    }
  }

  // __builtin_setjmp and __builtin_longjmp: TraxSjLj.cpp.
  bool hasSjLjLowering() const override { return true; }

  // A double word is no better aligned for being one.
  bool allowsLargerPreferedTypeAlignment() const override { return false; }

  // Wider ones would need library functions for multiplication and division.
  bool hasBitIntType() const override { return true; }
  size_t getMaxBitIntWidth() const override { return 64; }

  bool isValidCPUName(StringRef Name) const override { return Name == "generic"; }
  void fillValidCPUList(SmallVectorImpl<StringRef> &Values) const override { Values.push_back("generic"); }
  bool setCPU(const std::string &Name) override { return isValidCPUName(Name); }
  bool isValidFeatureName(StringRef Name) const override { return Name == "global-stack"; }
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
  targetOptsOf(*Target) = Opts;

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
